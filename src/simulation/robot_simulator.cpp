#include "hires/simulation/robot_simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "start_checks.h"

namespace hires::simulation {
namespace {

using geometry::Pose2;
using geometry::Pose3;

constexpr int kSlowSteps = 10;             // slip, contacts: every tenth step
constexpr double kSlipCorrelation = 0.1;   // [s]
constexpr double kGhostLifetime = 4.6;     // [s] persistence of ground objects (navigation.md, 4)
constexpr double kGhostSize = 0.10;        // [m] edge: a voxel of the obstacle filter
constexpr double kLookPeriod = 0.5;        // [s] between two looks of the camera
constexpr physics::BodyId kFloorBody = 0;  // statics follow in their order
constexpr double kStillHead = 0.02;        // [rad/s] faster than this pictures blur

robot::BaseControllerParams Varied(robot::BaseControllerParams params, const Variation& variation) {
  params.command_lag += variation.command_delay;
  params.loop_damping *= variation.loop_damping_factor;
  params.sway_compliance *= variation.sway_factor;
  return params;
}

geometry::MassProperties Varied(geometry::MassProperties properties, const Variation& variation) {
  properties.mass *= variation.mass_factor;
  properties.I_BBcm *= variation.mass_factor;
  properties.p_BBcm.z() *= variation.com_height_factor;
  properties.p_BBcm.head<2>() += variation.com_offset;
  return properties;
}

std::vector<geometry::Collision> Varied(std::vector<geometry::Collision> shapes,
                                        const Variation& variation) {
  for (geometry::Collision& shape : shapes) {
    shape.friction *= variation.friction_factor;
    if (auto* cylinder = std::get_if<geometry::Cylinder>(&shape.shape)) {
      cylinder->radius *= variation.radius_factor;
    }
  }
  return shapes;
}

}  // namespace

struct RobotSimulator::Snapshot {
  physics::PhysicsState physics;
  double time;
  long steps;
  BaseDrive drive;
  Pose3 X_MB;
  double slip;
  base::Rng slip_rng, sense_rng, ghost_rng;
  double last_observation;
  std::deque<Ghost> ghosts;
  std::optional<RobotContact> contact;
  Disturbances disturbances;
  std::optional<PlanarRobot::State> planar;
  base::Rng encoder_rng, detection_rng;
  ObjectMemory memory;
  double last_look;
  std::vector<std::string> known_grips;
};

RobotSimulator::RobotSimulator(std::shared_ptr<const Scene> scene, const Variation& variation,
                               const world::WorldState& world_state,
                               const robot::RobotState& robot_state, base::Rng rng,
                               const physics::PhysicsParams& params, LevelOfDetail level)
    : scene_(std::move(scene)),
      variation_(variation),
      floor_(variation.floor_roughness, rng.Fork(0)),
      drive_(Varied(scene_->robot.profile.base_controller, variation),
             robot_state.X_MB * variation.start_offset),
      slip_rng_(rng.Fork(1)),
      sense_rng_(rng.Fork(2)),
      ghost_rng_(rng.Fork(3)),
      encoder_rng_(rng.Fork(4)),
      detection_rng_(rng.Fork(5)) {
  physics::PhysicsParams physics_params = params;
  physics_params.gravity = scene_->world.gravity;
  physics_ = std::make_unique<physics::PhysicsWorld>(physics_params);
  RefuseStiff(Varied(scene_->robot.profile.base_controller, variation), time_step());
  RefusePose("the robot", geometry::Lift(robot_state.X_MB));
  RefuseUnknownJoints(robot_state.joints, scene_->robot.model);
  Freeze(robot_state.joints);
  X_MB_ = LeaningPose(drive_.motion());
  physics_->AddFloor(scene_->world.floor_friction);
  for (const world::StaticBody& body : scene_->world.statics) {
    physics_->AddStatic(body.collisions, body.X_MB);
  }
  for (const world::ObjectState& object : world_state.objects) {
    RefuseObject(object);
    X_BO_start_.push_back(geometry::Lift(robot_state.X_MB).Inverse() * object.X_MO);
  }
  AddObjects(world_state, level);
  level == LevelOfDetail::kTray ? AddRobot() : AddPlanarRobot();
  RefuseBadStart(GetWorldState());
}

/// Shapes are the scene's wherever the posture is the driving one.
void RobotSimulator::Freeze(const robot::JointPositions& joints) {
  const robot::Robot& robot = scene_->robot;
  joints_ = PostureOf(robot, joints);
  if (joints_ == PostureOf(robot, {})) return;
  shapes_B_ = FrozenShapes(robot, joints_);
}

const std::vector<geometry::Collision>& RobotSimulator::robot_shapes_B() const {
  return shapes_B_ ? *shapes_B_ : scene_->robot_shapes_B;
}

void RobotSimulator::AddObjects(const world::WorldState& state, LevelOfDetail level) {
  for (std::size_t i = 0; i < state.objects.size(); ++i) {
    world::ObjectState object = state.objects[i];
    RefuseUnknownModel(object, scene_->world);
    RefuseUnknownHolder(object, scene_->robot.model);
    const world::ObjectModel& model = *scene_->world.models.at(object.model);
    const bool is_carried = StandsOn(robot_shapes_B(), model.collisions, X_BO_start_[i]);
    if (is_carried && object.attached_to.empty()) {
      X_BO_start_[i].translation.head<2>() += variation_.object_offset;
      carried_.push_back(static_cast<int>(i));
    }
    if (!object.attached_to.empty()) MoveInHand(object.attached_to, &X_BO_start_[i]);
    if (is_carried || !object.attached_to.empty()) object.X_MO = X_MB_ * X_BO_start_[i];
    objects_.push_back(object);
    object_names_.push_back(object.name);
    if (!object.attached_to.empty() && level == LevelOfDetail::kTray) {
      object_bodies_.push_back(-1);  // becomes part of the robot
      continue;
    }
    object_bodies_.push_back(physics_->AddLoose(Varied(model.mass_properties, variation_),
                                                Varied(model.collisions, variation_),
                                                {object.X_MO, object.V_MO}));
  }
}

/// The grasp that led to the start was a little off.
void RobotSimulator::MoveInHand(const std::string& link, Pose3* X_BO) const {
  const Pose3 X_BL = X_MB_.Inverse() * X_MLink(link);
  Pose3 X_LO = X_BL.Inverse() * *X_BO;
  X_LO.translation.x() += variation_.grasp_offset.x();
  X_LO.translation.z() += variation_.grasp_offset.y();
  X_LO.rotation = geometry::RotationFromRpy(0.0, variation_.grasp_turn, 0.0) * X_LO.rotation;
  const bool is_exact = variation_.grasp_offset.isZero(0.0) && variation_.grasp_turn == 0.0;
  if (!is_exact) *X_BO = X_BL * X_LO;
}

void RobotSimulator::AddRobot() {
  std::vector<geometry::Collision> shapes = robot_shapes_B();
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (objects_[i].attached_to.empty()) continue;
    for (geometry::Collision shape : scene_->world.models.at(objects_[i].model)->collisions) {
      shape.name = objects_[i].name;
      shape.X_BS = X_BO_start_[i] * shape.X_BS;
      shapes.push_back(std::move(shape));
    }
  }
  robot_body_ = physics_->AddDriven(shapes, X_MB_);
  if (!shapes_B_) return;
  clearance_.emplace(shapes, scene_->world);
  for (const geometry::Collision& shape : shapes) shape_names_.push_back(shape.name);
}

GraspableObject RobotSimulator::Graspable(std::size_t object) const {
  const geometry::MassProperties mass =
      Varied(scene_->world.models.at(objects_[object].model)->mass_properties, variation_);
  return {object_bodies_[object], mass.mass, mass.p_BBcm};
}

void RobotSimulator::AddPlanarRobot() {
  if (!scene_->robot.profile.upper_body) {
    throw base::ConfigError(
        fmt::format("robot '{}' has no upper body, so it can be simulated at level 'tray' alone; "
                    "add 'upper_body' to its profile",
                    scene_->robot.model.name));
  }
  std::vector<GraspableObject> graspable;
  for (std::size_t i = 0; i < objects_.size(); ++i) graspable.push_back(Graspable(i));
  std::vector<std::string> fixed_names{"floor"};
  for (const world::StaticBody& body : scene_->world.statics) fixed_names.push_back(body.name);
  planar_ = std::make_unique<PlanarRobot>(*scene_, joints_, X_MB_, std::move(graspable),
                                          std::move(fixed_names), physics_.get());
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    if (objects_[i].attached_to.empty()) continue;
    const auto& shapes = scene_->world.models.at(objects_[i].model)->collisions;
    double friction = HUGE_VAL;
    for (const auto& shape : Varied(shapes, variation_)) {
      friction = std::min(friction, shape.friction);
    }
    planar_->Attach(static_cast<int>(i), objects_[i].attached_to, friction);
  }
  known_grips_.resize(objects_.size());
  NoteGrips();
}

std::optional<RobotContact> RobotSimulator::FindContact() const {
  if (planar_) return planar_->FindContact(drive_.motion().X_MB, object_names_);
  if (!clearance_) return scene_->clearance.FindContact(drive_.motion().X_MB);
  const auto contact = clearance_->FindContact(drive_.motion().X_MB);
  if (!contact) return contact;
  // A raised arm's prism reaches down to where the arm is not: look exactly.
  const auto touch = physics_->FindFixedTouch(robot_body_, kFloorBody);
  if (!touch) return std::nullopt;
  return RobotContact{shape_names_[touch->shape],
                      scene_->world.statics[touch->fixed - kFloorBody - 1].name};
}

void RobotSimulator::RefuseBadStart(const world::WorldState& state) {
  if (const auto contact = FindContact()) {
    throw base::ConfigError(fmt::format(
        "robot starts in collision: its '{}' touches '{}' at x {:.3f} m, y {:.3f} m, yaw {:.3f} "
        "rad; move the start",
        contact->robot_part, contact->obstacle, drive_.motion().X_MB.x, drive_.motion().X_MB.y,
        drive_.motion().X_MB.yaw));
  }
  for (std::size_t i = 0; i < state.objects.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      RefuseTogether(state.objects[i], state.objects[j], scene_->world);
    }
    if (!state.objects[i].attached_to.empty()) continue;
    RefuseInsideRobot(state.objects[i], object_bodies_[i]);
    RefuseInStatics(state.objects[i], scene_->world);
  }
}

void RobotSimulator::RefuseInsideRobot(const world::ObjectState& object, physics::BodyId body) {
  bool is_inside = false;
  if (planar_) {  // exactly: an arm may reach over an object
    for (const physics::Touch& touch : physics_->FindTouches()) {
      is_inside = is_inside || (touch.loose == body && touch.depth > kStartSlack &&
                                !planar_->LinkOfBody(touch.other).empty());
    }
  } else {
    const auto& shapes = scene_->world.models.at(object.model)->collisions;
    is_inside = Overlap(shapes, object.X_MO, robot_shapes_B(), X_MB_);
  }
  if (!is_inside) return;
  throw base::ConfigError(
      fmt::format("object '{}' starts inside the robot; put it on a free place", object.name));
}

geometry::Pose3 RobotSimulator::LeaningPose(const BaseMotion& motion) const {
  double height = 0.0, pitch = motion.pitch, roll = motion.roll;
  if (!floor_.is_flat()) {
    // Four wheels at the corners of a square within the footprint carry the base.
    const double arm = 0.7 * geometry::InscribedRadius(scene_->robot.profile.footprint);
    double front = 0.0, left = 0.0;
    for (const double x : {arm, -arm}) {
      for (const double y : {arm, -arm}) {
        const double h = floor_.HeightAt(motion.X_MB * Eigen::Vector2d(x, y));
        height += h / 4.0;
        front += h / 2.0 * (x > 0.0 ? 1.0 : -1.0);
        left += h / 2.0 * (y > 0.0 ? 1.0 : -1.0);
      }
    }
    pitch -= front / (2.0 * arm);
    roll += left / (2.0 * arm);
  }
  return {{motion.X_MB.x, motion.X_MB.y, height},
          geometry::RotationFromRpy(roll, pitch, motion.X_MB.yaw)};
}

void RobotSimulator::Send(const robot::Command& command) {
  if (command.base_velocity) drive_.Send(*command.base_velocity, time_);
  if (!planar_) return;
  planar_->Send(command, time_);
  NoteGrips();
}

void RobotSimulator::Step() {
  if (steps_ % kSlowSteps == 0) {
    MoveSlip();
    if (!contact_) contact_ = FindContact();
    if (planar_) LookIfStill();
  }
  drive_.Step(time_, time_step(), slip_);
  const Pose3 X_next = LeaningPose(drive_.motion());
  if (planar_) {
    planar_->Move(time_, X_next);
  } else {
    physics_->SetMotion(robot_body_, MotionBetween(X_MB_, X_next, time_step()));
  }
  physics_->Step();
  X_MB_ = X_next;
  ++steps_;
  time_ = steps_ * time_step();
  NoteDisturbances();
  if (!planar_) return;
  planar_->React();
  NoteGrips();
}

void RobotSimulator::MoveSlip() {
  if (variation_.wheel_slip == 0.0) return;
  const double keep = std::exp(-kSlowSteps * time_step() / kSlipCorrelation);
  slip_ = keep * slip_ +
          variation_.wheel_slip * std::sqrt(1.0 - keep * keep) * slip_rng_.Normal(0.0, 1.0);
}

void RobotSimulator::NoteDisturbances() {
  const BaseMotion& motion = drive_.motion();
  const robot::MotionSet& limits = scene_->robot.profile.base_controller.limits;
  const double power = motion.A_B.vx * motion.V_B.vx + motion.A_B.vy * motion.V_B.vy;
  if (motion.timed_out) disturbances_.late_command = time_;
  if (std::hypot(motion.A_B.vx, motion.A_B.vy) > 0.5 * limits.max_linear_acceleration) {
    (power < 0.0 ? disturbances_.braking : disturbances_.accelerating) = time_;
  }
  if (std::abs(motion.A_B.wz) > 0.5 * limits.max_angular_acceleration) {
    disturbances_.turning = time_;
  }
}

void RobotSimulator::UpdateGhosts(const Pose2& X_MB, double elapsed) {
  while (!ghosts_.empty() && ghosts_.front().until <= time_) ghosts_.pop_front();
  const double chance = 1.0 - std::exp(-variation_.ghost_rate * elapsed);
  if (variation_.ghost_rate == 0.0 || !ghost_rng_.Bernoulli(chance)) return;
  const double distance = ghost_rng_.Uniform(0.8, 2.5), bearing = ghost_rng_.Uniform(-1.0, 1.0);
  const Pose2 X_MG = X_MB * Pose2{distance * std::cos(bearing), distance * std::sin(bearing), 0.0};
  const double h = kGhostSize / 2;
  ghosts_.push_back(
      {geometry::Transformed(X_MG, {{-h, -h}, {h, -h}, {h, h}, {-h, h}}), time_ + kGhostLifetime});
}

Pose2 RobotSimulator::BelievedBase(base::Rng* rng) const {
  const Pose2 noise{rng->Normal(0.0, variation_.localisation_noise),
                    rng->Normal(0.0, variation_.localisation_noise),
                    rng->Normal(0.0, variation_.localisation_noise_yaw)};
  return drive_.motion().X_MB * variation_.localisation_bias * noise;
}

/// Where a link is in the map when the base is where the robot believes it to be.
Pose3 RobotSimulator::Believed(const Pose3& X_ML, const Pose2& X_MBbelieved) const {
  return geometry::Lift(X_MBbelieved) * X_MB_.Inverse() * X_ML;
}

void RobotSimulator::Remember(const std::vector<robot::SeenObject>& objects) {
  memory_.Remember(objects);
}

/// Hands know at once what they hold and lose.
void RobotSimulator::NoteGrips() {
  if (planar_->num_grips() == num_known_grips_) return;
  num_known_grips_ = planar_->num_grips();
  const Pose2 X_MBbelieved = drive_.motion().X_MB * variation_.localisation_bias;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const std::string link = planar_->HolderOf(static_cast<int>(i));
    if (link == known_grips_[i]) continue;
    const std::string before = std::exchange(known_grips_[i], link);
    const std::string& acting = link.empty() ? before : link;
    const Pose3 X_ML = planar_->X_MLink(acting), X_MLbelieved = Believed(X_ML, X_MBbelieved);
    const Pose3 X_LO = X_ML.Inverse() * PoseOf(static_cast<int>(i));
    if (!before.empty()) memory_.Release(objects_[i].name, X_MLbelieved);
    if (link.empty()) continue;
    memory_.Take(link, X_MLbelieved,
                 {objects_[i].name, objects_[i].model, X_MLbelieved * X_LO, time_, link}, X_LO);
  }
}

void RobotSimulator::LookIfStill() {
  if (time_ - last_look_ < kLookPeriod || planar_->IsHeadFaster(kStillHead)) return;
  last_look_ = time_;
  const robot::Robot& robot = scene_->robot;
  const Pose3 X_MC = planar_->X_MLink(robot.profile.upper_body->camera_link);
  const perception::CameraView view = perception::ViewFrom(robot, X_MC);
  const std::vector<world::ObjectState> objects = GetWorldState().objects;
  const perception::LineOfSight sight(scene_->surroundings, objects, planar_->ShapesInMap());
  perception::DetectorParams params;
  params.position_noise = variation_.detection_noise;
  params.yaw_noise = variation_.detection_noise_yaw;
  const auto detections = perception::Detect(sight, view, objects, params, &detection_rng_);
  const Pose3 X_MCbelieved = Believed(X_MC, BelievedBase(&detection_rng_));
  memory_.Look(detections, sight, view, {X_MC, X_MCbelieved}, params, time_);
}

void RobotSimulator::ObserveUpperBody(double action_start, robot::Observation* observation) {
  observation->joints = planar_->Joints();
  observation->joint_velocities = planar_->JointVelocities();
  if (variation_.encoder_noise > 0.0) {
    for (const auto& [name, velocity] : observation->joint_velocities) {
      observation->joints[name] += encoder_rng_.Normal(0.0, variation_.encoder_noise);
    }
  }
  std::map<std::string, Pose3> X_MLbelieved;
  for (const std::string& link : known_grips_) {
    if (link.empty() || X_MLbelieved.count(link) == 1) continue;
    X_MLbelieved[link] = Believed(planar_->X_MLink(link), observation->X_MB);
  }
  observation->objects = memory_.Known(X_MLbelieved);
  for (robot::SeenObject& seen : observation->objects) {
    seen.time = (seen.attached_to.empty() ? seen.time : time_) - action_start;
  }
}

robot::Observation RobotSimulator::Observe(double action_start) {
  const BaseMotion& motion = drive_.motion();
  robot::Observation observation;
  observation.time = time_ - action_start;
  observation.X_MB = BelievedBase(&sense_rng_);
  observation.V_B = motion.V_B;
  UpdateGhosts(motion.X_MB, time_ - last_observation_);
  last_observation_ = time_;
  for (const Ghost& ghost : ghosts_) observation.obstacles_M.push_back(ghost.outline_M);
  if (planar_) ObserveUpperBody(action_start, &observation);
  return observation;
}

geometry::Pose3 RobotSimulator::X_MB() const { return X_MB_; }

std::map<std::string, int> RobotSimulator::held() const {
  return planar_ ? planar_->Held() : std::map<std::string, int>();
}

Pose3 RobotSimulator::X_MLink(const std::string& link) const {
  if (planar_) return planar_->X_MLink(link);
  const robot::RobotModel& model = scene_->robot.model;
  const auto index = model.FindLink(link);
  if (!index) {
    throw base::ConfigError("robot: " + base::UnknownName("link", link, model.LinkNames()));
  }
  const std::vector<Pose3> X_R = robot::ForwardKinematics(model, joints_);
  const Pose3& X_RB = X_R[*model.FindLink(scene_->robot.profile.base_link)];
  return X_MB_ * X_RB.Inverse() * X_R[*index];
}

geometry::Pose3 RobotSimulator::PoseOf(int object) const {
  if (object_bodies_[object] < 0) return X_MB_ * X_BO_start_[object];
  return physics_->GetState(object_bodies_[object]).X_WB;
}

geometry::Twist3 RobotSimulator::VelocityOf(int object) const {
  if (object_bodies_[object] < 0) return {};
  return physics_->GetState(object_bodies_[object]).V_WB;
}

std::string RobotSimulator::HolderOf(int object) const {
  return planar_ ? planar_->HolderOf(object) : objects_[object].attached_to;
}

world::WorldState RobotSimulator::GetWorldState() const {
  world::WorldState state;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    world::ObjectState object = objects_[i];
    object.X_MO = PoseOf(static_cast<int>(i));
    object.attached_to = HolderOf(static_cast<int>(i));
    if (object_bodies_[i] >= 0) object.V_MO = physics_->GetState(object_bodies_[i]).V_WB;
    state.objects.push_back(std::move(object));
  }
  return state;
}

robot::RobotState RobotSimulator::GetRobotState() const {
  return {drive_.motion().X_MB, drive_.motion().V_B, planar_ ? planar_->Joints() : joints_};
}

void RobotSimulator::PutBack(int object) {
  HIRES_CHECK(object_bodies_.at(object) >= 0, "an attached object cannot be put back");
  const Pose3 X_MO = X_MB_ * X_BO_start_[object];
  const geometry::Twist2& V_B = drive_.motion().V_B;
  const Eigen::Vector3d w_M(0.0, 0.0, V_B.wz);
  const Eigen::Vector3d v_MB = X_MB_.rotation * Eigen::Vector3d(V_B.vx, V_B.vy, 0.0);
  physics_->SetState(object_bodies_[object],
                     {X_MO, {v_MB + w_M.cross(X_MO.translation - X_MB_.translation), w_M}});
}

std::shared_ptr<const RobotSimulator::Snapshot> RobotSimulator::Save() {
  return std::make_shared<const Snapshot>(
      Snapshot{physics_->Save(), time_, steps_, drive_, X_MB_, slip_, slip_rng_, sense_rng_,
               ghost_rng_, last_observation_, ghosts_, contact_, disturbances_,
               planar_ ? std::make_optional(planar_->Save()) : std::nullopt, encoder_rng_,
               detection_rng_, memory_, last_look_, known_grips_});
}

void RobotSimulator::Restore(const Snapshot& snapshot) {
  physics_->Restore(snapshot.physics);
  time_ = snapshot.time;
  steps_ = snapshot.steps;
  drive_ = snapshot.drive;
  X_MB_ = snapshot.X_MB;
  slip_ = snapshot.slip;
  slip_rng_ = snapshot.slip_rng;
  sense_rng_ = snapshot.sense_rng;
  ghost_rng_ = snapshot.ghost_rng;
  last_observation_ = snapshot.last_observation;
  ghosts_ = snapshot.ghosts;
  contact_ = snapshot.contact;
  disturbances_ = snapshot.disturbances;
  HIRES_CHECK(snapshot.planar.has_value() == (planar_ != nullptr),
              "a simulator is restored from one of the same level of detail");
  if (planar_) planar_->Restore(*snapshot.planar);
  encoder_rng_ = snapshot.encoder_rng;
  detection_rng_ = snapshot.detection_rng;
  memory_ = snapshot.memory;
  last_look_ = snapshot.last_look;
  known_grips_ = snapshot.known_grips;
  num_known_grips_ = planar_ ? planar_->num_grips() : 0;
}

}  // namespace hires::simulation
