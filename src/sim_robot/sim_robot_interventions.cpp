#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "sim_robot/sim_robot_world.h"

namespace hires::sim_robot {
namespace {

using base::ToLower;
using geometry::Pose2;
using geometry::Pose3;
using world::ObjectState;
using world::WorldState;

constexpr double kDropDistance = 0.75;  // [m] from the base to where things fall to the floor
constexpr double kDropHeight = 0.4;     // [m]
constexpr double kDropTilt = 1.2;       // [rad]
constexpr int kDropBearings = 16;
constexpr double kLowestLoad = 0.1;  // [m] above the floor: what lies lower is not carried
constexpr std::uint64_t kFirstRebuilt = 1000;  // stream of chance

void Erase(const std::string& object, WorldState* state) {
  auto& objects = state->objects;
  objects.erase(std::remove_if(objects.begin(), objects.end(),
                               [&](const ObjectState& other) {
                                 return ToLower(other.name) == ToLower(object);
                               }),
                objects.end());
}

std::string Unknown(const WorldState& state, const std::string& object) {
  std::vector<std::string> names;
  for (const ObjectState& known : state.objects) names.push_back(known.name);
  return base::UnknownName("object", object, names);
}

}  // namespace

/// What joints and empty hands have been told and have not done yet, from now on.
robot::Command SimRobotWorld::RestOfMotions(const WorldState& world) const {
  robot::Command rest;
  for (const auto& [group, sent] : trajectories_) {
    robot::JointTrajectory left{sent.trajectory.joints, {}};
    for (robot::TrajectoryPoint point : sent.trajectory.points) {
      point.time -= time() - sent.time;
      if (point.time > 0.0) left.points.push_back(std::move(point));
    }
    if (!left.points.empty()) rest.trajectories[group] = std::move(left);
  }
  for (const auto& [arm, gripper] : grippers_) {
    const std::string& palm = setup_->scene->robot.profile.upper_body->arms.at(arm).palm_link;
    const bool holds = std::any_of(world.objects.begin(), world.objects.end(),
                                   [&](const ObjectState& o) { return o.attached_to == palm; });
    if (!holds) rest.grippers[arm] = gripper;
  }
  return rest;
}

/// A simulator cannot be changed from outside, so another one goes on from its state: at rest, from
/// where base and joints take up their motions again.
std::string SimRobotWorld::Rebuild(WorldState world, const robot::RobotState& robot) {
  simulation::Variation variation = variation_;
  variation.start_offset = {};  // robot and objects stand where they are, no further draw
  variation.object_offset = {0.0, 0.0};
  variation.grasp_offset = {0.0, 0.0};
  variation.grasp_turn = 0.0;
  for (ObjectState& object : world.objects) {
    if (RidesAlong(object, robot.X_MB)) object.V_MO = {};  // as its carrier
  }
  try {
    auto simulator = std::make_unique<simulation::RobotSimulator>(
        setup_->scene, variation, world, robot, simulator_rng_.Fork(kFirstRebuilt + num_rebuilt_),
        setup_->physics, LevelFor(*setup_->scene));
    simulator->Send(RestOfMotions(world));
    simulator->BelieveAs(*simulator_);
    simulator_ = std::move(simulator);
    if (motion_) motion_->PutAt(simulator_->base().X_MB);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  ++num_rebuilt_;
  last_delivery_ = late_until_ = -1e9;
  held_back_.reset();
  return "";
}

/// In a hand, or over the base.
bool SimRobotWorld::RidesAlong(const ObjectState& object, const Pose2& X_MB) const {
  if (!object.attached_to.empty()) return true;
  const Pose3 X_BO = geometry::Lift(X_MB).Inverse() * object.X_MO;
  return X_BO.translation.z() > kLowestLoad &&
         geometry::Contains(setup_->scene->robot.profile.footprint, X_BO.translation.head<2>());
}

std::string SimRobotWorld::Push(const Pose2& offset) {
  if (!offset.IsFinite()) return "the offset is not finite; give numbers";
  robot::RobotState robot = simulator_->GetRobotState();
  const Pose2 X_MBold = robot.X_MB;
  robot.X_MB = robot.X_MB * offset;
  WorldState world = simulator_->GetWorldState();
  for (ObjectState& object : world.objects) {
    if (!RidesAlong(object, X_MBold)) continue;
    object.X_MO = geometry::Lift(robot.X_MB) * geometry::Lift(X_MBold).Inverse() * object.X_MO;
  }
  return Rebuild(std::move(world), robot);
}

std::string SimRobotWorld::Remove(const std::string& object) {
  WorldState world = simulator_->GetWorldState();
  if (world.Find(object) == nullptr) return Unknown(world, object);
  Erase(object, &world);
  return Rebuild(world, simulator_->GetRobotState());
}

std::string SimRobotWorld::Place(const std::string& object, const std::string& model,
                                 const Pose3& X_MO) {
  WorldState world = simulator_->GetWorldState();
  ObjectState placed;
  if (const ObjectState* known = world.Find(object)) placed = *known;
  placed.name = ToLower(object);
  placed.X_MO = X_MO;
  placed.V_MO = {};
  placed.attached_to.clear();
  try {
    if (!model.empty()) placed.model = setup_->ModelOf(model);
    if (placed.model.empty()) placed.model = setup_->ModelOf(object);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  Erase(object, &world);
  world.objects.push_back(placed);
  return Rebuild(world, simulator_->GetRobotState());
}

/// Beside the robot, tilted and above the floor, at the first bearing where nothing is in the way.
std::string SimRobotWorld::Drop(const std::string& object) {
  const WorldState world = simulator_->GetWorldState();
  if (world.Find(object) == nullptr) return Unknown(world, object);
  const Pose2 X_MB = simulator_->base().X_MB;
  std::string refusal;
  for (int i = 0; i < kDropBearings; ++i) {
    const double bearing = 2.0 * M_PI * i / kDropBearings;
    Pose3 X_MO = geometry::Lift(
        X_MB * Pose2{kDropDistance * std::cos(bearing), kDropDistance * std::sin(bearing), 0.0},
        kDropHeight);
    X_MO.rotation = X_MO.rotation * geometry::RotationFromRpy(kDropTilt, 0.0, 0.0);
    refusal = Place(object, "", X_MO);
    if (refusal.empty()) return "";
  }
  return "there is no free floor around the robot: " + refusal;
}

}  // namespace hires::sim_robot
