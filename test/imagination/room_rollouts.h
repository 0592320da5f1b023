#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hires/imagination/rollout.h"
#include "support/scenes.h"

namespace hires::test_support {

/// A load that sways a little, starts a little off and slides more or less well.
inline const char* SomeUncertainty() {
  return R"(
object_mass: {distribution: uniform, lower: 0.8, upper: 1.2, unit: factor, source: test}
object_friction: {distribution: uniform, lower: 0.5, upper: 1.0, unit: factor, source: test}
object_x: {distribution: uniform, lower: -0.01, upper: 0.01, unit: m, source: test}
start_x: {distribution: uniform, lower: -0.1, upper: 0.1, unit: m, source: test}
start_y: {distribution: uniform, lower: -0.1, upper: 0.1, unit: m, source: test}
start_yaw: {distribution: uniform, lower: -0.1, upper: 0.1, unit: rad, source: test}
localisation_noise: {distribution: fixed, value: 0.002, unit: m, source: test}
wheel_slip: {distribution: uniform, lower: 0.0, upper: 0.03, unit: share, source: test}
floor_roughness: {distribution: uniform, lower: 0.0, upper: 0.0005, unit: m, source: test}
late_cycle_probability: {distribution: fixed, value: 0.02, unit: share, source: test}
late_cycle_delay: {distribution: uniform, lower: 0.1, upper: 0.5, unit: s, source: test}
)";
}

/// The robot in the west of a room like Room(), with one object of `model` on its tray (none if
/// empty).
inline imagination::RolloutSetup RoomRollouts(world::World room, const std::string& model,
                                              const std::string& uncertainty = "none",
                                              const robot::Robot& robot = TrayRobot()) {
  imagination::RolloutSetup setup;
  setup.skills =
      std::make_shared<const skills::SkillSet>(skills::MakeSkillSet(room, robot, {}, {}));
  setup.robot_state = StandingAt(geometry::Flatten(*room.FindFrame("West")));
  if (!model.empty()) {
    setup.world_state.objects.push_back(OnTray("load", model, setup.robot_state.X_MB));
  }
  setup.scene = simulation::MakeScene(std::move(room), robot);
  setup.uncertainty = std::make_shared<const imagination::Uncertainty>(
      imagination::UncertaintyFromText(uncertainty, "test"));
  setup.seed = 1;
  return setup;
}

}  // namespace hires::test_support
