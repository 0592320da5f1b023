#pragma once

#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include "hires/planning/datum.h"

namespace hires::planning {

/// The facts of every moment of a plan; moment t is the state after t steps. Facts keep the order
/// in which they came: one that is added again while it holds keeps its age, one that was deleted
/// and comes back is new.
class FactHistory {
 public:
  struct Entry {
    Datum atom;  ///< ground
    int from{0};
    int until{std::numeric_limits<int>::max()};  ///< does not hold at this moment any more
    bool HoldsAt(int moment) const { return from <= moment && moment < until; }
  };

  /// `atom` holds from `moment` on. False if it already did.
  /// @pre ground; moments never decrease from change to change.
  bool Add(const Datum& atom, int moment);
  /// `atom` holds until before `moment`. False if it did not hold.
  bool Remove(const Datum& atom, int moment);

  bool Holds(const Datum& atom, int moment) const;
  std::vector<Datum> FactsAt(int moment) const;  ///< oldest first

  const Entry& entry(int index) const { return entries_[index]; }
  /// Indices of all entries, oldest first, that an atom like `pattern` can match, whenever they
  /// hold.
  const std::vector<int>& Candidates(const Datum& pattern) const;

 private:
  std::vector<Entry> entries_;
  std::unordered_map<std::string, int> latest_;  ///< entry of an atom by its text
  std::unordered_map<std::string, std::vector<int>> by_predicate_;
  std::unordered_map<std::string, std::vector<int>> by_first_argument_;
  std::vector<int> all_;
};

}  // namespace hires::planning
