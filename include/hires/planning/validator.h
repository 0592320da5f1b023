#pragma once

#include <string>
#include <vector>

#include "hires/planning/domain.h"
#include "hires/planning/functions.h"
#include "hires/planning/plan.h"

namespace hires::planning {

/// Checks a plan against domain and problem without the search, by the definitions alone. Every
/// violation is one sentence that names the step or node (by its index in the plan) and what is
/// wrong; empty means valid. Checked are
/// - the decomposition: nodes form a tree whose leaves are the steps; the problem's tasks at its
///   top; of each other node, head and task agree, the branch's precondition holds with the
///   recorded bindings when it was decomposed, in a SHOP2 domain no earlier branch of the method
///   held then, the children are the branch's subtasks, in its order; immediate tasks of SHOP2 went
///   first;
/// - the execution: each operator's precondition holds, no protection is violated, no step is
///   excluded by a fact (imagined_failure action arguments...), costs are right, the problem's goal
///   holds in the end.
///
/// An HDDL method's precondition may hold at any moment from which on the task could be decomposed,
/// until its first step. Where a plan records no costs at all (all are 0: it comes from another
/// planner) they are not compared, and for SHOP2 any such moment is taken as well. Bindings that
/// are not recorded are found from head and children.
std::vector<std::string> ValidatePlan(const Domain& domain, const Problem& problem,
                                      const Plan& plan,
                                      const Functions& functions = Functions::Standard());

}  // namespace hires::planning
