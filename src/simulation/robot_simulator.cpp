#include "hires/simulation/robot_simulator.h"

#include <algorithm>
#include <utility>

#include "hires/base/check.h"
#include "hires/simulation/laser_scanner.h"
#include "simulation/frozen_robot.h"
#include "simulation/head_camera.h"
#include "simulation/loose_objects.h"
#include "simulation/moving_base.h"
#include "simulation/planar_robot.h"
#include "simulation/robot_sensors.h"
#include "simulation/start_checks.h"

namespace hires::simulation {
namespace {

using geometry::Pose3;

constexpr int kSlowSteps = 10;  // slip, contacts, senses: every tenth step

/// What a part that may be missing keeps.
template <typename Part>
auto SaveOf(const std::unique_ptr<Part>& part) {
  return part ? std::make_optional(part->Save()) : std::nullopt;
}

}  // namespace

struct RobotSimulator::Snapshot {
  State state;
  MovingBase::State base;
  RobotSensors::State sensors;
  physics::PhysicsState physics;
  std::optional<PlanarRobot::State> planar;
  std::optional<HeadCamera::State> camera;
};

RobotSimulator::~RobotSimulator() = default;

void RobotSimulator::Send(const robot::Command& command) {
  if (command.base_velocity) base_->Send(*command.base_velocity, state_.time);
  if (planar_) planar_->Send(command, state_.time);
}

void RobotSimulator::Remember(const std::vector<robot::SeenObject>& objects) {
  for (const robot::SeenObject& object : objects) {
    scene_->world.ModelOf({object.name, object.model, object.X_MO, {}, ""});
    RefusePose("remembered object '" + object.name + "'", object.X_MO);
  }
  if (camera_) camera_->Remember(objects, Believed());
}

void RobotSimulator::Push(const std::optional<geometry::Twist2>& acceleration) {
  base_->Push(acceleration);
}

void RobotSimulator::Step() {
  if (state_.steps % kSlowSteps == 0) {
    base_->DrawSlip(kSlowSteps * time_step());
    if (!state_.contact) state_.contact = FindContact();
    if (camera_) Sense();
  }
  const double next_time = (state_.steps + 1) * time_step();
  const Pose3 X_MB = base_->X_MB();
  base_->Step(state_.time, next_time);
  planar_ ? planar_->Move(state_.time, base_->X_MB()) : frozen_->Move(X_MB, base_->X_MB());
  physics_->Step();
  ++state_.steps;
  state_.time = next_time;
  if (planar_) planar_->React();
}

/// What makes the robot know more of objects.
void RobotSimulator::Sense() {
  camera_->Feel(state_.time, Believed());
  if (!camera_->MayLook(state_.time)) return;
  camera_->Look(state_.time, base().X_MB, place_error(), GetWorldState().objects);
}

geometry::Pose2 RobotSimulator::Believed() const {
  return base().X_MB * place_error().value_or(variation_.localisation_bias);
}

robot::Observation RobotSimulator::Observe(double action_start) {
  robot::Observation observation;
  observation.time = state_.time - action_start;
  FindPlace();
  sensors_->ReadBase(state_.time, base(), &observation);
  if (base::Rng* noise = sensors_->ScanDue(state_.time)) Scan(noise, &observation);
  if (planar_) sensors_->ReadJoints(*planar_, &observation);
  if (!camera_) return observation;
  observation.objects = camera_->Known(state_.time, observation.X_MB);
  observation.num_newcomers = camera_->num_newcomers();
  for (robot::SeenObject& seen : observation.objects) seen.time -= action_start;
  return observation;
}

void RobotSimulator::Scan(base::Rng* noise, robot::Observation* observation) {
  LaserParams laser = scene_->sight.scans->laser;
  laser.link = scene_->robot.profile.laser_link;
  laser.noise = variation_.scan_noise;
  LevelScan scan = ScanLevel(*this, laser, noise);
  sensors_->ReadScan(state_.time, std::move(scan.reading), scan.X_BL, observation);
}

/// Wheels and inertial unit tell of all ways, the laser where a scan is of use.
void RobotSimulator::FindPlace() {
  SelfLocaliser* localiser = sensors_->localiser();
  if (localiser == nullptr) return;
  localiser->Drive(state_.time, base().X_MB);
  if (!localiser->wants_scan()) return;
  LaserParams laser = localiser->params().laser;
  laser.link = scene_->robot.profile.laser_link;
  const LevelScan scan = ScanLevel(*this, laser, localiser->scan_rng());
  localiser->Hear(scan.reading, scan.X_BL);
}

const SelfLocaliser* RobotSimulator::self_localiser() const { return sensors_->localiser(); }

std::optional<geometry::Pose2> RobotSimulator::place_error() const {
  return sensors_->place_error();
}

void RobotSimulator::BelieveAs(const RobotSimulator& before) {
  SelfLocaliser* localiser = sensors_->localiser();
  if (localiser == nullptr) return;
  *localiser = *before.self_localiser();
  localiser->PutAt(state_.time, base().X_MB);
}

std::optional<RobotContact> RobotSimulator::FindContact() const {
  if (planar_) return planar_->FindContact(base().X_MB, objects_->names());
  return frozen_->FindContact(base().X_MB);
}

const BaseMotion& RobotSimulator::base() const { return base_->motion(); }

Pose3 RobotSimulator::X_MB() const { return base_->X_MB(); }

const Disturbances& RobotSimulator::disturbances() const { return base_->disturbances(); }

Pose3 RobotSimulator::X_MLink(const std::string& link) const {
  return planar_ ? planar_->X_MLink(link) : frozen_->X_MLink(X_MB(), link);
}

robot::RobotState RobotSimulator::GetRobotState() const {
  return {base().X_MB, base().V_B, planar_ ? planar_->Joints() : frozen_->joints()};
}

std::map<std::string, int> RobotSimulator::held() const {
  return planar_ ? planar_->Held() : std::map<std::string, int>();
}

const std::vector<int>& RobotSimulator::carried() const { return objects_->carried(); }

Pose3 RobotSimulator::PoseOf(int object) const { return objects_->PoseOf(object, X_MB()); }

geometry::Twist3 RobotSimulator::VelocityOf(int object) const {
  return objects_->VelocityOf(object);
}

std::string RobotSimulator::HolderOf(int object) const {
  return planar_ ? planar_->HolderOf(object) : objects_->AtStart(object).attached_to;
}

std::optional<int> RobotSimulator::broken_object() const {
  const std::optional<physics::BodyId> body = physics_->broken();
  if (!body) return std::nullopt;
  const std::optional<int> object = objects_->WithBody(*body);
  HIRES_CHECK(object, "what broke is no object");
  return object;
}

bool RobotSimulator::IsTouched(int object) const {
  if (!HolderOf(object).empty()) return true;
  const physics::BodyId body = objects_->BodyOf(object);
  if (physics_->IsResting(body)) return true;
  const std::vector<physics::Touch>& touches = physics_->touches();
  return std::any_of(touches.begin(), touches.end(), [&](const physics::Touch& touch) {
    return touch.loose == body || touch.other == body;
  });
}

bool RobotSimulator::IsReached(int object) const {
  return !objects_->IsLoose(object) || physics_->IsReached(objects_->BodyOf(object));
}

bool RobotSimulator::IsBall(int object) const {
  return objects_->RollingOf(object) == geometry::Rolling::kAllWays;
}

bool RobotSimulator::StandsOnRobot(int object) const {
  const auto& parts_B = planar_ ? scene_->base_shapes_B : frozen_->shapes_B();
  return StandsOn(parts_B, objects_->ModelOf(object).collisions, X_MB().Inverse() * PoseOf(object));
}

world::WorldState RobotSimulator::GetWorldState() const {
  world::WorldState state;
  for (int i = 0; i < objects_->size(); ++i) {
    world::ObjectState object = objects_->AtStart(i);
    object.X_MO = PoseOf(i);
    object.attached_to = HolderOf(i);
    if (objects_->IsLoose(i)) object.V_MO = VelocityOf(i);
    state.objects.push_back(std::move(object));
  }
  return state;
}

void RobotSimulator::PutBack(int object) {
  const Pose3 X_MO = X_MB() * objects_->X_BOstart(object);
  objects_->Put(object, {X_MO, base_->VelocityAt(X_MO.translation)});
}

std::shared_ptr<const RobotSimulator::Snapshot> RobotSimulator::Save() {
  return std::make_shared<const Snapshot>(Snapshot{
      state_, base_->Save(), sensors_->Save(), physics_->Save(), SaveOf(planar_), SaveOf(camera_)});
}

void RobotSimulator::Restore(const Snapshot& snapshot) {
  HIRES_CHECK(snapshot.planar.has_value() == (planar_ != nullptr),
              "a simulator is restored from one of the same level of detail");
  state_ = snapshot.state;
  base_->Restore(snapshot.base);
  sensors_->Restore(snapshot.sensors);
  physics_->Restore(snapshot.physics);
  if (planar_) planar_->Restore(*snapshot.planar);
  if (camera_) camera_->Restore(*snapshot.camera);
}

}  // namespace hires::simulation
