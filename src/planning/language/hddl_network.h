#pragma once

#include <string>
#include <vector>

#include "hires/planning/domain.h"
#include "planning/language/hddl_formula.h"

namespace hires::planning::hddl {

/// The tasks of a method or of a problem.
struct HddlNetwork {
  TaskNetwork network;
  std::vector<Formula> conditions;  ///< :constraints, and what its actions need and nothing changes
  /// What else the action needs that comes before all other subtasks, where one does.
  std::vector<Formula> needs_of_first{};
};

/// Names of the fields that ReadNetwork reads.
const std::vector<std::string>& NetworkFields();

/// Reads subtasks, their order and the constraints on their variables. The name of an action gets
/// its `!`.
/// @throws ConfigError for unknown tasks and ids, and for an order that has a circle.
HddlNetwork ReadNetwork(const HddlFields& fields, HddlScope* scope);

}  // namespace hires::planning::hddl
