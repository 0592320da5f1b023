#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "hires/base/action.h"
#include "hires/base/param_reader.h"
#include "hires/imagination/rollout_result.h"
#include "hires/imagination/uncertainty.h"
#include "hires/physics/physics_world.h"
#include "hires/simulation/robot_simulator.h"
#include "hires/simulation/scene.h"
#include "hires/skills/skill_factory.h"
#include "hires/world/standing.h"

namespace hires::imagination {

/// How a rollout is played and counted. Defaults from the dissertation (sections 5.2, 5.6).
struct RolloutParams {
  double settling_time{0.5};   ///< [s] before the action begins; not counted
  double time_limit{300.0};    ///< [s] simulated, for the action
  double sample_period{0.05};  ///< [s] 20 Hz
  /// [rad] alpha_n and alpha_t of Eq. 5.1. They sort samples of how far the load leans, for
  /// Eq. 6.1; whether something fell is an event and the world::StandingCriterion's to say.
  double shaking_tilt{0.01}, topple_tilt{0.5};
  double aftermath{2.0};  ///< [s] at most, to see whether what still shakes will fall
  bool put_back{false};   ///< a fallen object is put back, as in the original's experiments
  /// [rad] from which on a fallen object is put back: it has come to lie. That it fell was counted
  /// before.
  double put_back_tilt{1.56};
};
RolloutParams ReadRolloutParams(base::ParamReader in);

/// One sample of an object that leans by `tilt` [rad], sorted by Eq. 5.1.
OutcomeCounts SampleOf(double tilt, const RolloutParams& params);

/// Everything that the rollouts of one ground action have in common; constant, shared by threads.
struct RolloutSetup {
  std::shared_ptr<const simulation::Scene> scene;
  std::shared_ptr<const skills::SkillSet> skills;
  std::shared_ptr<const Uncertainty> uncertainty;
  world::WorldState world_state;
  robot::RobotState robot_state;  ///< rollouts begin at rest: its velocity is not used
  std::uint64_t seed{0};
  RolloutParams params;
  physics::PhysicsParams physics;
  world::StandingCriterion standing;
};

/// Refuses what could not be played: unknown action, area, motion set, model; poses that make no
/// sense; a nominal start in collision.  @throws base::ConfigError saying what.
void CheckSetup(const RolloutSetup& setup, const base::ActionCall& action);
/// The same for alternatives of one request: their common start is looked at once.
void CheckSetupForAll(const RolloutSetup& setup, const std::vector<base::ActionCall>& actions);

/// What a caller may want to know while a rollout is played; each may be empty.
struct RolloutHooks {
  std::function<bool()> cancelled;  ///< asked 20 times per simulated second, or more often
  /// Called with every 20 Hz sample; must not change anything.
  std::function<void(const simulation::RobotSimulator&, double tilt)> on_sample;
  /// Called when the load has settled and the action begins, before all below; once more where the
  /// rollout begins again (PlayRollout): what was told before does not count. Must not change
  /// anything.
  std::function<void(const simulation::RobotSimulator&)> on_begin{};
  /// Called once, when it is over, with the names (lower case) of what the action was about and
  /// the robot carried that is down, as world::FallDetector says.
  std::function<void(const std::vector<std::string>& down)> on_end{};
  /// For those who watch: every world::kFallLookInterval once the load has settled, until physics
  /// stops. Must not change anything.
  std::function<void(const simulation::RobotSimulator&)> on_look{};
  /// A control cycle will come late by `delay` [s].
  std::function<void(const simulation::RobotSimulator&, double delay)> on_late_cycle{};
  /// [s] for which physics plays on after everything was counted, so that one sees how what falls
  /// comes to lie; nothing of that counts. With it on_sample is called until the very end (with the
  /// tilt that was last counted), without it until the action ends.
  double epilogue{0.0};
  /// The action ran out of time, or gave up going to and fro: from `time` [s, simulator's clock] on
  /// it came no further. `text` says what it did instead.
  std::function<void(double time, const std::string& text)> on_stall{};
};

/// Plays rollout `index` of an action: samples a truth (the same for every action that is played
/// with this seed and index), lets the load settle, runs the skill in lockstep with physics,
/// counts. Gives up early, with nothing, when it is cancelled.
///
/// What stands about is left out of physics until something comes near it, or it comes within what
/// the base's laser is of use for (some 4 m); then the rollout begins again with it, and its hooks
/// are called anew, on_begin first. So what was left out stands to the last bit as it
/// did at the start and has changed nothing: what is far away does not settle, and a step that the
/// solver has to repeat is not repeated for it. Actions that move arms or head, which look at
/// objects, are played with everything, and so are starts in which something moves or that cannot
/// be.
/// @pre CheckSetup; then what stands about stands apart from each other and from furniture.
std::optional<RolloutResult> PlayRollout(const RolloutSetup& setup, const base::ActionCall& action,
                                         int index, const RolloutHooks& hooks = {});

}  // namespace hires::imagination
