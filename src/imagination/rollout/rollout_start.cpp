#include "imagination/rollout/rollout_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/robot/posture.h"
#include "hires/simulation/free_start.h"

namespace hires::imagination {
namespace {

constexpr double kHandReach = 0.5;  // [m] from a link to the origin of what it holds

/// Manipulation areas are where the robot stands at furniture: it came there by move_base_blind.
Arrival ArrivalAt(const RolloutSetup& setup) {
  constexpr double kAtArea = 0.25;  // [m] farther away it stands nowhere in particular
  std::string nearest;
  double least = kAtArea;
  for (const auto& [name, X_MArea] : setup.skills->areas) {
    const double distance = (X_MArea.position() - setup.robot_state.X_MB.position()).norm();
    const bool is_for_standing = name.find("manipulationarea") != std::string::npos;
    if (!is_for_standing || distance >= least) continue;
    least = distance;
    nearest = name;
  }
  return nearest.rfind("manipulationarea", 0) == 0 ? Arrival::kDocked : Arrival::kDriven;
}

double DistanceFrom(const robot::Robot& robot, const robot::RobotState& state,
                    const world::ObjectState& object) {
  const auto X_RL = robot::ForwardKinematics(robot.model, robot::PostureOf(robot, state.joints));
  const geometry::Pose3& X_RB = X_RL.at(*robot.model.FindLink(robot.profile.base_link));
  const geometry::Pose3& X_RLink = X_RL.at(*robot.model.FindLink(object.attached_to));
  const geometry::Pose3 X_ML = geometry::Lift(state.X_MB) * X_RB.Inverse() * X_RLink;
  return (X_ML.translation - object.X_MO.translation).norm();
}

}  // namespace

simulation::LevelOfDetail LevelFor(const skills::SkillSet& skills, const base::ActionCall& action) {
  return skills::SpecOf(skills, action).detail == actions::Detail::kBase
             ? simulation::LevelOfDetail::kTray
             : simulation::LevelOfDetail::kPlanar;
}

simulation::Variation DrawTruth(const RolloutSetup& setup, const base::Rng& rng) {
  return simulation::WithFreeStart(SampleVariation(*setup.uncertainty, rng, ArrivalAt(setup)),
                                   *setup.scene, setup.robot_state);
}

std::vector<robot::SeenObject> KnownAtStart(const RolloutSetup& setup,
                                            const simulation::Variation& variation,
                                            const simulation::RobotSimulator& simulator) {
  const geometry::Pose2 error = simulator.place_error().value_or(variation.localisation_bias);
  const geometry::Pose3 X_BelievedTrue =
      geometry::Lift(setup.robot_state.X_MB * variation.start_offset * error) *
      geometry::Lift(setup.robot_state.X_MB).Inverse();
  std::vector<robot::SeenObject> known;
  const auto& objects = setup.world_state.objects;
  for (int i = 0; i < static_cast<int>(objects.size()); ++i) {
    if (!objects[i].attached_to.empty()) continue;  // the hand knows
    const bool is_carried =
        std::count(simulator.carried().begin(), simulator.carried().end(), i) > 0;
    known.push_back({base::ToLower(objects[i].name), objects[i].model,
                     is_carried ? X_BelievedTrue * objects[i].X_MO : objects[i].X_MO, 0.0, ""});
  }
  return known;
}

void CheckHands(const RolloutSetup& setup) {
  const robot::Robot& robot = setup.scene->robot;
  std::map<std::string, std::string> holders;  // link -> object
  for (const world::ObjectState& object : setup.world_state.objects) {
    if (object.attached_to.empty()) continue;
    const auto [first, is_new] = holders.emplace(object.attached_to, object.name);
    if (!is_new) {
      throw base::ConfigError(
          fmt::format("objects '{}' and '{}' are both attached to '{}'; a link holds one object",
                      first->second, object.name, object.attached_to));
    }
    const double away = DistanceFrom(robot, setup.robot_state, object);
    if (away > kHandReach) {
      throw base::ConfigError(
          fmt::format("object '{}' is attached to '{}', but {:.2f} m away from it; wanted at most "
                      "{:.2f} m: give the pose that it has in the hand",
                      object.name, object.attached_to, away, kHandReach));
    }
  }
}

}  // namespace hires::imagination
