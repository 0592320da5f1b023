#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "hires/planning/domain.h"

namespace hires::planning {

/// A protection stands among the atoms of a step as (:protection atom).
constexpr std::string_view kProtectionWord = ":protection";

/// What the deletes or the adds of an operator come to, in the order of the file. The one place
/// that says so: the search asks with terms, whoever checks, explains or carries out a plan with
/// data. A variable stands for one atom or protection where its value begins with a name, else for
/// each item of its value; a forall for its effects under each binding of its condition.
/// @param values  Knows the values of variables and takes the atoms:
///   Instantiate(effect)            the value of the effect's term
///   Protection(value)              (:protection value)
///   IsAtom(value)                  it is a list that begins with a name
///   ForEachItem(value, visit)      the items of a list; none of anything else
///   ForEachBinding(effect, visit)  visit() under each binding of a forall's condition
///   Take(value)                    the next atom; a value of a variable may be none
template <typename AnyEffect, typename Values>
void CollectAtoms(const std::vector<AnyEffect>& effects, Values* values) {
  for (const AnyEffect& effect : effects) {
    if (effect.kind == Effect::Kind::kForall) {
      values->ForEachBinding(effect, [&] { CollectAtoms(effect.effects, values); });
      continue;
    }
    const auto value = values->Instantiate(effect);
    if (effect.kind == Effect::Kind::kProtection) {
      values->Take(values->Protection(value));
    } else if (effect.kind == Effect::Kind::kAtom || values->IsAtom(value)) {
      values->Take(value);
    } else {
      values->ForEachItem(value, [&](const auto& item) { values->Take(item); });
    }
  }
}

/// What CollectAtoms asks about values, for those who keep them as data.
struct DatumAtoms {
  static bool IsAtom(const Datum& value);
  static Datum Protection(const Datum& atom);
  template <typename Visit>
  static void ForEachItem(const Datum& value, const Visit& visit) {
    for (const Datum& item : value.items) visit(item);
  }
};

bool IsProtection(const Datum& atom);  ///< (:protection x)
bool IsFact(const Datum& atom);        ///< (predicate arguments...) without variables

/// Predicates of atoms that effects name. `is_open`: a variable stands among them, so that there
/// may be any others.
struct PredicateSet {
  std::set<std::string> names;
  bool is_open{false};

  bool MayHave(const std::string& name) const { return is_open || names.count(name) > 0; }
};
void CollectPredicates(const std::vector<Effect>& effects, PredicateSet* predicates);
/// Of all deletes and adds of a domain.
PredicateSet ChangingPredicates(const Domain& domain);

}  // namespace hires::planning
