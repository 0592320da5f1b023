#pragma once

#include <vector>

#include "knowledge/sparql/sparql_query.h"

namespace hires::knowledge::sparql {

struct Step;
/// A group in the order in which it is worked through.
using Plan = std::vector<Step>;

struct Step {
  const Pattern* pattern{nullptr};  ///< of the query; null: the alternatives count
  std::vector<Plan> alternatives;
};

/// The most selective elements first, as far as their shape tells: what is bound is looked up
/// before what is searched, what joins on before what does not; ties in the order of the text.
/// @param root_is_known  Whether the first selected variable has a value beforehand.
/// @param query          Must outlive the plan.
Plan MakePlan(const Query& query, bool root_is_known);

}  // namespace hires::knowledge::sparql
