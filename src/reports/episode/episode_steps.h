#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/imagination/start_state.h"
#include "reports/episode/episode.h"
#include "reports/episode/episode_topics.h"

namespace hires::reports {

/// One action of an episode: what was done, from which state, and how it ended.
struct EpisodeStep {
  base::ActionCall action;  ///< without a name: a motion that no action describes
  std::string motion;  ///< for people, of a motion that was found: "drove 3.21 m, at most 0.55 m/s"
  double begin{0.0};   ///< [s] on the robot's clock
  double duration{0.0};  ///< [s] that it took
  ActionFate fate{ActionFate::kUnknown};
  base::Failure failure;
  imagination::StartState start;
  /// Where a drive ended that ended at no area of the world; its action names an area that
  /// WithGoals adds.
  std::optional<geometry::Pose2> goal;
  std::string why_not;  ///< why it cannot be imagined or compared; empty: it can
};

/// The steps of an episode: the actions that were asked for, or where there are none, drives and
/// motions of arms and torso that it shows by itself, each taken for the action that ends so. In
/// the order of their begins.
std::vector<EpisodeStep> StepsOf(const Episode& episode, const imagination::ImaginationSetup& setup,
                                 const EpisodeConfig& config);

/// The same world with an area at the end of each drive that ended at none. Imagination clients do
/// not know such areas.
imagination::ImaginationSetup WithGoals(imagination::ImaginationSetup setup,
                                        const std::vector<EpisodeStep>& steps);

}  // namespace hires::reports
