#pragma once

#include <vector>

#include "hires/planning/domain.h"
#include "hires/planning/functions.h"
#include "hires/planning/plan.h"
#include "hires/planning/planner.h"

namespace hires::planning {

/// What is left to do of a plan when its first `executed` steps are done and the world is `facts`.
///
/// Finished tasks are gone. A task that was begun and stands at most `keep_depth` below the root
/// (the problem's tasks have depth 1) keeps its method: its remaining subtasks stay, with the order
/// between them. A task that was not begun, or that stands deeper, is there as a task again and may
/// be decomposed in any way. A check without steps counts as done only if it was made before the
/// last executed step. Values that only later steps would have bound are open again.
///
/// Protections that executed steps began and did not end are kept (Problem::protections), but for
/// those below tasks that stand again, and for atoms that do not hold any more.
/// @param facts       The whole state, HDDL's objects with their types included; facts
///                    (imagined_failure action arguments...) among them exclude steps.
/// @param keep_depth  0: the problem's own tasks, all of them, from the new state.
/// @pre `plan` is valid for `problem` (validator.h), 0 <= executed <= steps of the plan,
///   keep_depth >= 0.
Problem RemainingProblem(const Domain& domain, const Problem& problem, const Plan& plan,
                         int executed, std::vector<Datum> facts, int keep_depth,
                         const Functions& functions = Functions::Standard());

/// The largest `keep_depth` that makes a difference: the depth of the deepest task that was begun
/// and is not finished, at least 1.
int DeepestKeepDepth(const Plan& plan, int executed);

struct Replanned {
  PlanResult result;  ///< progress: of all tries together
  int kept_depth{0};  ///< of the try that `result` comes from
  Problem problem;    ///< that its plans solve: what was left to do
};

/// Plans the rest of a plan again, changing as little as possible: tries RemainingProblem from the
/// deepest keep_depth to 0 and gives the first plans found. kNoPlan only if every try saw its whole
/// search space; where a caller's limit ends a try, that ends all.
Replanned Replan(const Domain& domain, const Problem& problem, const Plan& plan, int executed,
                 const std::vector<Datum>& facts, const PlanRequest& request = {},
                 const Functions& functions = Functions::Standard());

}  // namespace hires::planning
