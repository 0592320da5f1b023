#pragma once

#include <string>
#include <vector>

#include "hires/planning/domain.h"
#include "hires/planning/plan.h"

namespace hires::execution {

/// Gives a step of the plan other arguments. What stands for them in the method that asks for the
/// step changes with them: its bindings, and its later primitive subtasks that have the same
/// variable. Where preconditions or effects depend on them, the plan's reasons are worked out
/// again.
/// @return why the plan cannot be carried out with them, and then `plan` is undefined; else "".
std::string Instantiate(const planning::Domain& domain, const planning::Problem& problem, int step,
                        const std::vector<std::string>& arguments, planning::Plan* plan);

/// The plan with its steps in another order: `order[i]` is the old index of the new step i.
/// @pre `order` keeps the plan's partial order.
planning::Plan Reordered(const planning::Plan& plan, const std::vector<int>& order);

}  // namespace hires::execution
