#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "hires/planning/datum.h"

namespace hires::planning {

/// Values of variables by name, with their `?`.
using ValueMap = std::map<std::string, Datum>;

/// What variables stand for, found by unification of data as they are written. The slow and obvious
/// kind: made for checking plans, not for finding them.
class Substitution {
 public:
  /// What was bound after a mark is undone by going back to it.
  std::size_t Mark() const { return trail_.size(); }
  void Undo(std::size_t mark);

  /// `datum` with all bound variables replaced. A dotted list whose tail became known is a plain
  /// list: (a . ?rest) with ?rest = (b) gives (a b).
  Datum Apply(const Datum& datum) const;

  /// Makes `a` and `b` equal by binding variables on either side. A variable is never bound to a
  /// term that contains it. Where it fails, what it bound so far is undone.
  bool Unify(const Datum& a, const Datum& b);

  bool IsBound(const std::string& variable) const { return values_.count(variable) > 0; }

 private:
  class ListView;

  const Datum& Walk(const Datum& datum) const;
  bool Match(const Datum& a, const Datum& b);
  bool MatchLists(const Datum& a, const Datum& b);
  bool Bind(const std::string& variable, const Datum& value);
  bool Occurs(const std::string& variable, const Datum& datum) const;
  Datum ApplyToList(const Datum& list) const;

  std::unordered_map<std::string, Datum> values_;
  std::vector<std::string> trail_;
};

/// Adds the names of the variables in `datum`.
void CollectVariables(const Datum& datum, std::set<std::string>* names);

/// `datum` with `suffix` behind the name of each of its variables, so that two clauses share none.
Datum RenameVariables(const Datum& datum, const std::string& suffix);

}  // namespace hires::planning
