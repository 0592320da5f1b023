#include "planning/search/search_limits.h"

#include <algorithm>

namespace hires::planning {

bool SearchLimits::Ask(const Progress& progress) {
  most_bytes_ = std::max(most_bytes_, progress.bytes);
  if (request_.stop && stop_ == Stop::kContinue) stop_ = request_.stop(progress);
  is_spent_ = is_spent_ || expansions_ >= budget_;
  return stopped();
}

bool SearchLimits::IsTooDeep(int depth) {
  if (depth < request_.max_depth) return false;
  too_deep_ = true;
  return true;
}

bool SearchLimits::IsTooDear(double cost) {
  if (cost <= request_.max_cost) return false;
  too_dear_ = true;
  return true;
}

PlanOutcome SearchLimits::Outcome(bool found) const {
  switch (stop_) {
    case Stop::kTime:
      return PlanOutcome::kLimitTime;
    case Stop::kMemory:
      return PlanOutcome::kLimitMemory;
    case Stop::kCancelled:
      return PlanOutcome::kCancelled;
    case Stop::kContinue:
      break;
  }
  if (found) return PlanOutcome::kFound;
  if (too_deep_) return PlanOutcome::kLimitDepth;
  if (too_dear_) return PlanOutcome::kLimitCost;
  return PlanOutcome::kNoPlan;
}

}  // namespace hires::planning
