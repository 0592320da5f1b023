#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "hires/simulation/robot_simulator.h"
#include "support/scenes.h"

/// The PR2 before a table, its right arm stretched out level above it.
namespace hires::simulation::test_arm {

constexpr double kTorso = 0.1;  ///< [m] at the start
constexpr double kToolX = 0.05 + 0.4 * 0.54030230586814 + 0.321 * 0.98006657784124 + 0.18;
constexpr double kToolY = -0.188;
constexpr double kToolZ = 0.790675 + kTorso - 0.4 * 0.84147098480790 - 0.321 * 0.19866933079506;
constexpr double kTableTop = kToolZ - 0.05;  ///< the tool points at the middle of a standing mug
constexpr double kMugRadius = 0.035, kMugHeight = 0.10;

inline const robot::Robot& Pr2() {
  static const robot::Robot robot =
      robot::LoadRobot(std::string(HIRES_SOURCE_DIR) + "/config/robots/pr2.yaml");
  return robot;
}

/// Room with a table before the robot at the origin; models mug, brick (wider than a hand).
inline world::World TableRoom() {
  using test_support::AddModel;
  using test_support::Block;
  world::World room = test_support::Room();
  room.statics = {Block("table1", {0.9, 1.6, kTableTop}, {1.11, 0.0, kTableTop / 2})};
  AddModel(&room, test_support::Mill("mug", kMugHeight, kMugRadius, 0.3));
  world::ObjectModel brick = test_support::Mill("brick", 0.1, 0.03, 1.0);
  brick.collisions = {
      test_support::Shape("body", geometry::Box{{0.06, 0.2, 0.1}}, {0.0, 0.0, 0.05})};
  AddModel(&room, brick);
  room.hash = room.ComputeHash();
  return room;
}

inline std::shared_ptr<const Scene> ArmScene() {
  static const std::shared_ptr<const Scene> scene = MakeScene(TableRoom(), Pr2());
  return scene;
}

/// The right arm level and straight ahead, its hand open.
inline robot::RobotState ReadyState(double gap = 0.09) {
  robot::RobotState state;
  const std::vector<double> joints{0.0, 1.0, 0.0, -0.8, 0.0, -0.2, 0.0};
  const auto& names = Pr2().profile.upper_body->arms.at("rightarm1").joints;
  for (std::size_t i = 0; i < names.size(); ++i) state.joints[names[i]] = joints[i];
  state.joints["torso_lift_joint"] = kTorso;
  state.joints["r_gripper_joint"] = gap;
  return state;
}

/// A mug on the table, `offset` from the tool, or above the table.
inline world::ObjectState MugAt(const Eigen::Vector2d& offset = Eigen::Vector2d::Zero(),
                                const std::string& name = "mug1") {
  world::ObjectState mug;
  mug.name = name;
  mug.model = "mug";
  mug.X_MO.translation = {kToolX + offset.x(), kToolY + offset.y(), kTableTop + 0.0002};
  return mug;
}

inline std::unique_ptr<RobotSimulator> Simulator(std::vector<world::ObjectState> objects,
                                                 const Variation& variation = {},
                                                 const robot::RobotState& state = ReadyState(),
                                                 std::uint64_t seed = 1) {
  return std::make_unique<RobotSimulator>(
      ArmScene(), variation, world::WorldState{std::move(objects)}, state, base::Rng(seed),
      physics::PhysicsParams{}, LevelOfDetail::kPlanar);
}

inline void StepFor(RobotSimulator* simulator, double duration) {
  for (long i = std::lround(duration / simulator->time_step()); i > 0; --i) simulator->Step();
}

inline robot::Command Gripper(double gap, double effort = -1.0) {
  robot::Command command;
  command.grippers["rightarm1"] = {gap, effort};
  return command;
}

/// One joint to a position after `duration` [s], as a straight line.
inline robot::Command JointTo(const std::string& group, const std::string& joint, double position,
                              double duration) {
  robot::Command command;
  command.trajectories[group] = {{joint}, {{duration, {position}, {}}}};
  return command;
}

inline robot::Command TorsoTo(double height) {
  return JointTo("torso", "torso_lift_joint", height, 1.0);
}

}  // namespace hires::simulation::test_arm
