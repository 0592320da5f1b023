#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "hires/planning/plan.h"
#include "planning/search/search_path.h"

namespace hires::planning {

/// Writes down the plan at the end of a path.
class PlanExtractor {
 public:
  explicit PlanExtractor(SearchPath* path) : path_(*path) {}

  /// Equal for plans with the same steps in the same order and the same decomposition: those that
  /// differ only in when a task was found to need no step are one plan.
  std::uint64_t Key();
  /// @param decomposition  With its nodes; without, steps say node -1.
  Plan Extract(bool decomposition);

 private:
  using Numbers = std::vector<int>;  ///< node of the network -> of the plan, or -1

  void AddSteps(const Numbers& numbers, Plan* plan);
  void AddNodes(Plan* plan, Numbers* numbers);
  int AddNode(std::uint32_t node, int parent, Plan* plan, Numbers* numbers);
  void AddDecompositions(const Numbers& numbers, Plan* plan);
  std::vector<std::pair<std::string, Datum>> Values(const std::vector<std::string>& names,
                                                    std::uint32_t first, std::uint32_t variables);

  SearchPath& path_;
};

}  // namespace hires::planning
