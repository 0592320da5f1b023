#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/planning/datum.h"
#include "hires/planning/plan.h"

namespace hires::execution {

using planning::Datum;

/// In the planner's terms: lower case, arguments as Lisp reads them.
/// @throws base::ConfigError naming the atom where that cannot be.
Datum DatumOf(const base::Atom& atom);
base::Atom AtomOf(const Datum& atom);
base::ActionCall CallOf(const Datum& task);  ///< without `!`

/// Whether both can be the same atom; variables on either side stand for anything.
bool CanMatch(const Datum& a, const Datum& b);
bool CanMatchAny(const std::vector<Datum>& patterns, const Datum& atom);

/// Ground atoms that hold, in the order of their text.
class Facts {
 public:
  Facts() = default;
  explicit Facts(const std::vector<base::Atom>& atoms);

  bool HoldsText(const std::string& atom) const { return atoms_.count(atom) > 0; }
  /// A negative literal with variables holds where nothing matches.
  bool Holds(const planning::Literal& literal, const std::string& text) const;
  bool HasMatch(const Datum& pattern) const;

  void Add(const Datum& atom) { atoms_.emplace(ToString(atom), atom); }
  void Remove(const Datum& atom) { atoms_.erase(ToString(atom)); }
  void RemoveMatches(const std::vector<Datum>& patterns);

  std::vector<base::Atom> Atoms() const;
  std::vector<Datum> Data() const;
  /// By text.
  const std::map<std::string, Datum>& all() const { return atoms_; }

 private:
  std::map<std::string, Datum> atoms_;
};

}  // namespace hires::execution
