#include "planning/search/found_plans.h"

#include <algorithm>

namespace hires::planning {

void FoundPlans::TakeOver(FoundPlans* earlier, std::vector<Plan> plans) {
  plans_ = std::move(plans);
  keys_ = std::move(earlier->keys_);
  best_cost_ = earlier->best_cost_;
}

void FoundPlans::Offer() {
  if (request_.which == Which::kAll && !keys_.insert(extractor_.Key()).second) return;
  if (IsTooDear(path_.cost())) return;  // the first of the cheapest stays
  if (request_.which == Which::kBest) plans_.clear();
  best_cost_ = std::min(best_cost_, path_.cost());
  plans_.push_back(extractor_.Extract(request_.decomposition));
  enough_ = request_.which == Which::kFirst ||
            (request_.which == Which::kAll && plans_.size() >= request_.max_plans);
}

}  // namespace hires::planning
