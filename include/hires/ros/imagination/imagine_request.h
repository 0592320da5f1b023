#pragma once

#include <hires/ImagineGoal.h>
#include <hires/ImagineResult.h>

#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/imagination/report.h"
#include "hires/imagination/rollout.h"
#include "hires/imagination/scheduler.h"

/// What a goal of the action `imagine` means: the same for the node that spreads it over workers
/// and for a program that plays it in one process.
namespace hires_ros {

/// One request, checked and ready to be played.
struct ImagineRequest {
  std::vector<hires::base::ActionCall> actions;  ///< all combinations, never empty
  hires::imagination::RolloutSetup setup;        ///< start, seed and uncertainty are the request's
  hires::imagination::SchedulerParams params;
};

/// @param defaults  what a goal does not say itself.
/// @throws hires::base::ConfigError naming what cannot be understood or played: unknown names,
/// ranking or uncertainty, a start that belongs to another world, a start in collision.
ImagineRequest RequestOf(const hires::ImagineGoal& goal,
                         const hires::imagination::ImaginationSetup& setup,
                         const hires::imagination::SchedulerParams& defaults);

/// The result of a request that was played. Its references to rollouts are enough to play these
/// again.
hires::ImagineResult AnswerTo(const hires::ImagineGoal& goal, const ImagineRequest& request,
                              const hires::imagination::ImaginationSetup& setup,
                              const hires::imagination::Report& report);

/// The result INVALID of a request that cannot be played.
hires::ImagineResult RefusalOf(const hires::ImagineGoal& goal, const std::string& why);

}  // namespace hires_ros
