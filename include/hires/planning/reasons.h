#pragma once

#include <utility>
#include <vector>

#include "hires/planning/domain.h"
#include "hires/planning/functions.h"
#include "hires/planning/plan.h"

namespace hires::planning {

/// Fills in what every step rests on and does: preconditions, deletes, adds, links and reads; and
/// the order of the plan's subtasks where the domain keeps it. The
/// plan is carried out from the problem's facts (and the domain's); a precondition is proven with
/// the step's bindings, by the first proof in the order of the facts where there are several. A
/// quantified precondition is supported by its instances, a negated one by the atoms that nothing
/// matches; a condition that calls a function only needs no support.
///
/// The producer of a literal is the step that made it so: the one that added the atom when it did
/// not hold, or the last one that deleted a match of a negated atom.
/// @throws ConfigError naming the step where the plan cannot be carried out. Its reasons are then
///   filled in up to there.
void AddReasons(const Domain& domain, const Problem& problem, Plan* plan,
                const Functions& functions = Functions::Standard());

/// The order that methods and problem give to the steps of a plan, by way of the tasks that they
/// are part of: pairs (before, after) from which the others follow. `!imagine` needs nothing and
/// changes nothing: nothing waits for it, nor does it wait. A plan that does not say how the
/// problem's tasks broke down is taken in the order of its steps.
std::vector<std::pair<int, int>> OrderOfSubtasks(const Domain& domain, const Problem& problem,
                                                 const Plan& plan);

/// The facts after the first `executed` steps if all goes as the plan expects, oldest first,
/// without the domain's own.
/// @pre 0 <= executed <= steps of the plan.  @throws ConfigError as above.
std::vector<Datum> FactsAfter(const Domain& domain, const Problem& problem, const Plan& plan,
                              int executed, const Functions& functions = Functions::Standard());

}  // namespace hires::planning
