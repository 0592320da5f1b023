#pragma once

#include <vector>

#include "reports/episode/episode_steps.h"

namespace hires::reports {

/// Drives and motions of arms and torso that an episode shows by itself, by begin. A drive is taken
/// for move_base_blind where it is short and straight, else for move_base_param with the slowest
/// motion set that allows its peak speed; it goes to the area at which it ended. Motions of arms
/// are taken for tuck_arms, move_arm_to_side or move_arms_to_carryposture, those of the torso for
/// move_torso, by the postures in which they ended. Their starts are not filled in.
std::vector<EpisodeStep> MotionsOf(const Episode& episode,
                                   const imagination::ImaginationSetup& setup,
                                   const MotionParams& params);

/// The state of a sample, to imagine from.
imagination::StartState StartOf(const Episode& episode, const EpisodeSample& sample);

}  // namespace hires::reports
