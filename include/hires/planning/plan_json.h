#pragma once

#include <nlohmann/json_fwd.hpp>

#include "hires/planning/plan.h"
#include "hires/planning/planner.h"

namespace hires::planning {

/// What a search took, as its caller measured.
struct SearchCosts {
  double cpu_seconds{0.0};  ///< [s] processor time of the search alone, without reading
  double peak_mb{0.0};      ///< [MB] (1e6 bytes) most memory the process ever held
};

/// (on a b), or (not (on a ?x)).
std::string ToString(const Literal& literal);

/// `{cost, steps: [{operator, arguments, cost, preconditions, deletes, adds, links, path}],
/// order: [[before, after]]}`. Atoms and arguments are text in Lisp's form; `producer` of a link is
/// the index of a step, or -1 for the initial state.
/// @pre AddReasons has seen the plan, or the step's reasons and the order are empty.
nlohmann::ordered_json ToJson(const Plan& plan);

/// `{outcome, exhausted, plans, statistics: {expansions, inferences, cpu_seconds, peak_mb}}`, and
/// `trace` where the result has one. Field order is fixed; equal results and costs give equal text.
nlohmann::ordered_json ToJson(const PlanResult& result, const SearchCosts& costs);

}  // namespace hires::planning
