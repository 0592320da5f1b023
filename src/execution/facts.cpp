#include "execution/facts.h"

#include <algorithm>

#include "hires/base/text.h"
#include "hires/planning/task_text.h"

namespace hires::execution {

Datum DatumOf(const base::Atom& atom) {
  const std::string where = "atom " + base::ToString(atom);
  std::vector<Datum> items{planning::ReadGroundTerm(atom.predicate, where)};
  for (const std::string& argument : atom.arguments) {
    items.push_back(planning::ReadGroundTerm(argument, where));
  }
  return planning::MakeList(std::move(items));
}

base::Atom AtomOf(const Datum& atom) {
  base::Atom result{std::string(atom.Head()), {}};
  for (std::size_t i = 1; i < atom.items.size(); ++i) {
    result.arguments.push_back(ToString(atom.items[i]));
  }
  return result;
}

base::ActionCall CallOf(const Datum& task) {
  base::Atom atom = AtomOf(task);
  atom.predicate.erase(0, atom.predicate.find_first_not_of('!'));
  return {std::move(atom.predicate), std::move(atom.arguments)};
}

bool CanMatch(const Datum& a, const Datum& b) {
  if (a.kind == Datum::Kind::kVariable || b.kind == Datum::Kind::kVariable) return true;
  if (!a.IsList() || !b.IsList()) return a == b;
  return std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(), CanMatch);
}

bool CanMatchAny(const std::vector<Datum>& patterns, const Datum& atom) {
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const Datum& pattern) { return CanMatch(pattern, atom); });
}

Facts::Facts(const std::vector<base::Atom>& atoms) {
  for (const base::Atom& atom : atoms) Add(DatumOf(atom));
}

bool Facts::HasMatch(const Datum& pattern) const {
  return std::any_of(atoms_.begin(), atoms_.end(),
                     [&](const auto& entry) { return CanMatch(pattern, entry.second); });
}

bool Facts::Holds(const planning::Literal& literal, const std::string& text) const {
  return literal.holds ? HoldsText(text) : !HasMatch(literal.atom);
}

void Facts::RemoveMatches(const std::vector<Datum>& patterns) {
  for (auto atom = atoms_.begin(); atom != atoms_.end();) {
    atom = CanMatchAny(patterns, atom->second) ? atoms_.erase(atom) : std::next(atom);
  }
}

std::vector<base::Atom> Facts::Atoms() const {
  std::vector<base::Atom> atoms;
  for (const auto& [text, atom] : atoms_) atoms.push_back(AtomOf(atom));
  return atoms;
}

std::vector<Datum> Facts::Data() const {
  std::vector<Datum> data;
  for (const auto& [text, atom] : atoms_) data.push_back(atom);
  return data;
}

}  // namespace hires::execution
