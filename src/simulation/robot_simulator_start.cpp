// How a simulator comes to its start, and which starts it refuses.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/short_text.h"
#include "hires/simulation/robot_simulator.h"
#include "hires/world/floor.h"
#include "simulation/frozen_robot.h"
#include "simulation/head_camera.h"
#include "simulation/loose_objects.h"
#include "simulation/moving_base.h"
#include "simulation/planar_robot.h"
#include "simulation/robot_sensors.h"
#include "simulation/start/overlap.h"
#include "simulation/start_checks.h"
#include "simulation/varied.h"

namespace hires::simulation {
namespace {

using geometry::Pose3;

std::unique_ptr<physics::PhysicsWorld> MakeRoom(const world::World& world,
                                                physics::PhysicsParams params) {
  params.gravity = world.gravity;
  return std::make_unique<physics::PhysicsWorld>(params);
}

void AddFurniture(const world::World& world, physics::PhysicsWorld* physics) {
  physics->AddFloor(world.floor_friction);
  for (const world::StaticBody& body : world.statics) {
    physics->AddStatic(body.collisions, body.X_MB);
  }
}

}  // namespace

RobotSimulator::RobotSimulator(std::shared_ptr<const Scene> scene, const Variation& variation,
                               const world::WorldState& world_state,
                               const robot::RobotState& robot_state, base::Rng rng,
                               const physics::PhysicsParams& params, LevelOfDetail level)
    : scene_(std::move(scene)), variation_(variation), physics_(MakeRoom(scene_->world, params)) {
  const robot::Robot& robot = scene_->robot;
  RefuseStiff(Varied(robot.profile.base_controller, variation), time_step());
  RefusePose("the robot", geometry::Lift(robot_state.X_MB));
  RefuseUnknownJoints(robot_state.joints, robot.model);
  base_ = std::make_unique<MovingBase>(robot.profile, scene_->floor, variation,
                                       robot_state.X_MB * variation.start_offset, time_step(), rng);
  frozen_ = std::make_unique<FrozenRobot>(scene_, robot_state.joints);
  sensors_ = std::make_unique<RobotSensors>(scene_, variation, base().X_MB, rng);
  AddFurniture(scene_->world, physics_.get());
  AddObjects(world_state.objects, geometry::Lift(robot_state.X_MB), level);
  if (level == LevelOfDetail::kTray) {
    frozen_->AddBody(X_MB(), objects_->RigidShapes_B(), physics_.get());
  } else {
    AddPlanarRobot();
    if (scene_->has_camera()) AddCamera(rng.Fork(5));
  }
  RefuseBadStart();
  objects_->TakeOut(X_MB());
}

void RobotSimulator::AddObjects(const std::vector<world::ObjectState>& objects,
                                const Pose3& X_MBnominal, LevelOfDetail level) {
  for (const world::ObjectState& object : objects) RefuseObject(object);
  objects_ = std::make_unique<LooseObjects>(scene_->world, variation_, physics_.get());
  for (const world::ObjectState& object : objects) {
    AddObject(object, X_MBnominal.Inverse() * object.X_MO, level);
  }
}

/// @param X_BO  where the base would be nominally. What it carries and holds moves along with it.
void RobotSimulator::AddObject(world::ObjectState object, Pose3 X_BO, LevelOfDetail level) {
  const auto model = scene_->world.ModelOf(object);
  RefuseUnknownHolder(object, scene_->robot.model);
  const bool is_held = !object.attached_to.empty();
  const bool is_carried = !is_held && StandsOn(frozen_->shapes_B(), model->collisions, X_BO);
  if (is_carried) X_BO.translation.head<2>() += variation_.object_offset;
  if (is_held) {
    const Pose3 X_BL = X_MB().Inverse() * frozen_->X_MLink(X_MB(), object.attached_to);
    X_BO = VariedGrasp(X_BL, X_BO, variation_);
  }
  if (is_carried || is_held) object.X_MO = X_MB() * X_BO;
  if (is_held && level == LevelOfDetail::kTray) {
    objects_->AddRigid(object, X_BO);
  } else {
    objects_->AddLoose(object, X_BO, is_carried);
  }
}

void RobotSimulator::AddPlanarRobot() {
  if (!scene_->robot.profile.upper_body) {
    throw base::ConfigError(
        fmt::format("robot '{}' has no upper body, so it can be simulated at level 'tray' alone; "
                    "add 'upper_body' to its profile",
                    scene_->robot.model.name));
  }
  std::vector<std::string> fixed_names{"floor"};
  for (const world::StaticBody& body : scene_->world.statics) fixed_names.push_back(body.name);
  planar_ = std::make_unique<PlanarRobot>(*scene_, frozen_->joints(), X_MB(), objects_->Graspable(),
                                          std::move(fixed_names), physics_.get());
  for (int i = 0; i < objects_->size(); ++i) {
    const std::string& link = objects_->AtStart(i).attached_to;
    if (!link.empty()) planar_->Attach(i, link, objects_->FrictionOf(i));
  }
}

/// What hands hold at the start the robot knows.
void RobotSimulator::AddCamera(const base::Rng& rng) {
  camera_ = std::make_unique<HeadCamera>(scene_, variation_, planar_.get(), rng);
  for (int i = 0; i < objects_->size(); ++i) {
    const std::string link = HolderOf(i);
    if (link.empty()) continue;
    const world::ObjectState& object = objects_->AtStart(i);
    camera_->KnowHeld(object.name, object.model, link, X_MLink(link).Inverse() * PoseOf(i));
  }
}

/// All that is wrong at once. Things that stand in each other in the world's file are none of it:
/// HoldWhatIsStuck has seen to them.
void RobotSimulator::RefuseBadStart() {
  std::vector<std::string> problems;
  if (const auto contact = FindContact()) {
    const std::string in_floor =
        world::WhyInFloor(scene_->world, contact->obstacle, base().X_MB.position());
    problems.push_back(fmt::format(
        "robot starts in collision: its '{}' touches '{}'{}, where it stands at x {:.3f} m, y "
        "{:.3f} m, yaw {:.3f} rad; {}",
        contact->robot_part, contact->obstacle, PlaceText(*contact), base().X_MB.x, base().X_MB.y,
        base().X_MB.yaw, in_floor.empty() ? "move the start" : in_floor));
  }
  const std::vector<world::ObjectState> objects = GetWorldState().objects;
  RefuseSameNames(objects);
  std::vector<bool> is_of_world;
  for (const world::ObjectState& object : objects) {
    is_of_world.push_back(IsOfWorld(object, scene_->world));
  }
  const std::vector<physics::Touch> touches =
      planar_ ? physics_->FindTouches() : std::vector<physics::Touch>();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const world::ObjectState& object = objects[i];
    for (std::size_t j = 0; j < i; ++j) {
      if (is_of_world[i] && is_of_world[j]) continue;
      problems.push_back(WhyInOther(object, objects[j], scene_->world));
    }
    if (!object.attached_to.empty()) continue;
    problems.push_back(WhyInsideRobot(object, objects_->BodyOf(static_cast<int>(i)), touches));
    if (!is_of_world[i]) problems.push_back(WhyInStatics(object, scene_->world));
  }
  problems.erase(std::remove(problems.begin(), problems.end(), ""), problems.end());
  if (!problems.empty()) throw base::ConfigError(base::AllThatIsWrong("the start", problems));
}

std::string RobotSimulator::WhyInsideRobot(const world::ObjectState& object, physics::BodyId body,
                                           const std::vector<physics::Touch>& touches) const {
  std::optional<Inside> inside;
  if (planar_) {  // exactly: an arm may reach over an object
    for (const physics::Touch& touch : touches) {
      const std::string link = planar_->LinkOfBody(touch.other);
      const double deepest = inside ? inside->depth : kStartSlack;
      if (touch.loose == body && touch.depth > deepest && !link.empty()) {
        inside = Inside{link, touch.depth, touch.depth};
      }
    }
  } else {
    const auto model = scene_->world.RequireModel(object.model);
    inside = FindInside(model->collisions, object.X_MO, frozen_->shapes_B(), X_MB());
  }
  return inside ? simulation::WhyInsideRobot(object, *scene_, X_MB(), *inside) : "";
}

}  // namespace hires::simulation
