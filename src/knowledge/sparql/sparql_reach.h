#pragma once

#include <string>
#include <vector>

#include "knowledge/sparql/sparql_query.h"

namespace hires::knowledge::sparql {

/// An instance that a query looks at besides the root.
struct Part {
  int variable{kNoVariable};
  std::string key;  ///< where it is no variable: the instance, in lower case
  /// Relations that the instance needs; one of these sets of them.
  std::vector<std::vector<std::string>> roles;
};

/// Which other instances decide whether an instance is accepted.
struct Reach {
  bool is_local{false};  ///< none: its own concept and properties do
  /// Whether each of them is linked to from it, over one of `chains`, in every solution. Then a
  /// change of one concerns the instances found by going back over the links.
  bool is_traceable{false};
  std::vector<std::vector<std::string>> chains;  ///< roles, from the root outwards; sorted
  std::vector<Part> parts;                       ///< if not traceable
  std::vector<std::string> joined_roles;         ///< see Sparql::joined_roles; sorted
};

Reach FindReach(const Query& query);

}  // namespace hires::knowledge::sparql
