// How a simulator comes to its start, and which starts it refuses.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/robot/posture.h"
#include "hires/simulation/robot_simulator.h"
#include "simulation/start_checks.h"

namespace hires::simulation {
namespace {

using geometry::Pose3;

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

RobotSimulator::State::State(BaseDrive drive_at_start, const base::Rng& rng)
    : drive(std::move(drive_at_start)),
      slip_rng(rng.Fork(1)),
      sense_rng(rng.Fork(2)),
      ghosts(rng.Fork(3)),
      encoder_rng(rng.Fork(4)),
      detection_rng(rng.Fork(5)) {}

RobotSimulator::RobotSimulator(std::shared_ptr<const Scene> scene, const Variation& variation,
                               const world::WorldState& world_state,
                               const robot::RobotState& robot_state, base::Rng rng,
                               const physics::PhysicsParams& params, LevelOfDetail level)
    : scene_(std::move(scene)),
      variation_(variation),
      floor_(variation.floor_roughness, rng.Fork(0)),
      state_(BaseDrive(Varied(scene_->robot.profile.base_controller, variation),
                       robot_state.X_MB * variation.start_offset),
             rng) {
  physics::PhysicsParams physics_params = params;
  physics_params.gravity = scene_->world.gravity;
  physics_ = std::make_unique<physics::PhysicsWorld>(physics_params);
  RefuseStiff(Varied(scene_->robot.profile.base_controller, variation), time_step());
  RefusePose("the robot", geometry::Lift(robot_state.X_MB));
  RefuseUnknownJoints(robot_state.joints, scene_->robot.model);
  Freeze(robot_state.joints);
  state_.X_MB = LeaningPose(state_.drive.motion());
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
    if (is_carried || !object.attached_to.empty()) object.X_MO = state_.X_MB * X_BO_start_[i];
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

bool RobotSimulator::StandsOnRobot(int object) const {
  const auto& parts_B = planar_ ? scene_->base_shapes_B : robot_shapes_B();
  const world::ObjectModel& model = *scene_->world.models.at(objects_.at(object).model);
  return StandsOn(parts_B, model.collisions, state_.X_MB.Inverse() * PoseOf(object));
}

/// The grasp that led to the start was a little off.
void RobotSimulator::MoveInHand(const std::string& link, Pose3* X_BO) const {
  const Pose3 X_BL = state_.X_MB.Inverse() * X_MLink(link);
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
  robot_body_ = physics_->AddDriven(shapes, state_.X_MB);
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
  planar_ = std::make_unique<PlanarRobot>(*scene_, joints_, state_.X_MB, std::move(graspable),
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
  if (scene_->surroundings) {
    state_.memory.emplace(scene_->surroundings,
                          std::shared_ptr<const robot::Robot>(scene_, &scene_->robot),
                          scene_->memory);
    BelieveHands();
  }
}

void RobotSimulator::RefuseBadStart(const world::WorldState& state) {
  if (const auto contact = FindContact()) {
    throw base::ConfigError(fmt::format(
        "robot starts in collision: its '{}' touches '{}' at x {:.3f} m, y {:.3f} m, yaw {:.3f} "
        "rad; move the start",
        contact->robot_part, contact->obstacle, state_.drive.motion().X_MB.x,
        state_.drive.motion().X_MB.y, state_.drive.motion().X_MB.yaw));
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
    is_inside = Overlap(shapes, object.X_MO, robot_shapes_B(), state_.X_MB);
  }
  if (!is_inside) return;
  throw base::ConfigError(
      fmt::format("object '{}' starts inside the robot; put it on a free place", object.name));
}

}  // namespace hires::simulation
