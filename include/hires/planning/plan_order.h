#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "hires/planning/plan.h"

namespace hires::planning {

/// Which steps have to wait for which others so that the plan still does what it does: pairs
/// (before, after) of step indices, without those that follow from others, sorted. Steps that are
/// not ordered by it, directly or through others, may be carried out in any order or side by side;
/// each order that keeps it leads to the same facts in the end.
///
/// Two steps keep the order they have in the plan where
/// - one produces a literal of a causal link of the other,
/// - one adds or deletes an atom that a link or the reads (PlanStep::reads) of the other mention:
///   whatever would break a link stays on its side of it,
/// - one adds and the other deletes the same atom,
/// - one protects an atom and the other ends a protection of it,
/// - methods or problem order the tasks that they are part of (Plan::subtask_order).
/// Steps of bookkeeping (`!!`) are steps like others.
/// @pre AddReasons has seen the plan.
std::vector<std::pair<int, int>> PartialOrder(const Plan& plan);

/// Calls `visit` with each total order of the steps 0 .. num_steps - 1 that keeps `order`, in
/// lexicographic order, until it returns false. There may be as many as num_steps!: for tests and
/// small plans.
void ForEachLinearExtension(int num_steps, const std::vector<std::pair<int, int>>& order,
                            const std::function<bool(const std::vector<int>&)>& visit);

}  // namespace hires::planning
