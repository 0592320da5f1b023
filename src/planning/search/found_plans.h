#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <unordered_set>
#include <utility>
#include <vector>

#include "hires/planning/planner.h"
#include "planning/search/plan_extractor.h"
#include "planning/search/search_path.h"

namespace hires::planning {

/// The plans found so far: the first, all that differ, or the cheapest, as the request says.
class FoundPlans {
 public:
  FoundPlans(const PlanRequest& request, SearchPath* path)
      : request_(request), path_(*path), extractor_(path) {}

  /// What an earlier search found. @param plans  as Take() gave them.
  void TakeOver(FoundPlans* earlier, std::vector<Plan> plans);
  /// The plan at the end of the path, unless there is one as good.
  void Offer();
  /// No other plan is wanted.
  bool enough() const { return enough_; }
  /// A path of this cost cannot become the cheapest, which is all that is wanted.
  bool IsTooDear(double cost) const { return request_.which == Which::kBest && cost >= best_cost_; }

  std::size_t size() const { return plans_.size(); }
  double best_cost() const { return best_cost_; }  ///< infinite while there is none
  std::vector<Plan> Take() { return std::move(plans_); }

 private:
  const PlanRequest& request_;
  SearchPath& path_;
  PlanExtractor extractor_;
  std::vector<Plan> plans_;
  std::unordered_set<std::uint64_t> keys_;
  double best_cost_{std::numeric_limits<double>::infinity()};
  bool enough_{false};
};

}  // namespace hires::planning
