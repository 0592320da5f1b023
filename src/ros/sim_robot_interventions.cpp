#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/ros/sim_robot_world.h"

namespace hires_ros {
namespace {

using hires::base::ToLower;
using hires::geometry::Pose2;
using hires::geometry::Pose3;
using hires::world::ObjectState;
using hires::world::WorldState;

constexpr double kDropDistance = 0.75;  // [m] from the base to where things fall to the floor
constexpr double kDropHeight = 0.4;     // [m]
constexpr double kDropTilt = 1.2;       // [rad]
constexpr int kDropBearings = 16;

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
  return hires::base::UnknownName("object", object, names);
}

}  // namespace

/// The simulator cannot be changed from outside, so another one goes on from its state.
std::string SimRobotWorld::Rebuild(const WorldState& world, const hires::robot::RobotState& robot) {
  hires::simulation::Variation variation = variation_;
  variation.start_offset = {};  // robot and objects stand where they are, no further draw
  variation.object_offset = {0.0, 0.0};
  variation.grasp_offset = {0.0, 0.0};
  variation.grasp_turn = 0.0;
  try {
    simulator_ = std::make_unique<hires::simulation::RobotSimulator>(
        setup_->scene, variation, world, robot, simulator_rng_.Fork(1000 + num_rebuilt_),
        setup_->physics, LevelFor(*setup_->scene));
    ++num_rebuilt_;
  } catch (const hires::base::ConfigError& error) {
    return error.what();
  }
  last_delivery_ = late_until_ = -1e9;
  held_back_.reset();
  return "";
}

std::string SimRobotWorld::Push(const Pose2& offset) {
  if (!std::isfinite(offset.x) || !std::isfinite(offset.y) || !std::isfinite(offset.yaw)) {
    return "the offset is not finite; give numbers";
  }
  hires::robot::RobotState robot = simulator_->GetRobotState();
  const Pose3 X_MB = hires::geometry::Lift(robot.X_MB);
  robot.X_MB = robot.X_MB * offset;
  WorldState world = simulator_->GetWorldState();
  const auto move = [&](ObjectState* object) {
    object->X_MO = hires::geometry::Lift(robot.X_MB) * X_MB.Inverse() * object->X_MO;
    object->V_MO = {};
  };
  for (std::size_t i = 0; i < world.objects.size(); ++i) {
    const auto& carried = simulator_->carried();
    const bool is_carried =
        std::find(carried.begin(), carried.end(), static_cast<int>(i)) != carried.end();
    if (is_carried || !world.objects[i].attached_to.empty()) move(&world.objects[i]);
  }
  return Rebuild(world, robot);
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
  } catch (const hires::base::ConfigError& error) {
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
    Pose3 X_MO = hires::geometry::Lift(
        X_MB * Pose2{kDropDistance * std::cos(bearing), kDropDistance * std::sin(bearing), 0.0},
        kDropHeight);
    X_MO.rotation = X_MO.rotation * hires::geometry::RotationFromRpy(kDropTilt, 0.0, 0.0);
    refusal = Place(object, "", X_MO);
    if (refusal.empty()) return "";
  }
  return "there is no free floor around the robot: " + refusal;
}

}  // namespace hires_ros
