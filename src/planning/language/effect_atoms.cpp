#include "hires/planning/domain.h"

namespace hires::planning {

bool DatumAtoms::IsAtom(const Datum& value) {
  return !value.Head().empty() && !value.items[0].IsNil();
}

Datum DatumAtoms::Protection(const Datum& atom) {
  return MakeList({MakeSymbol(kProtectionWord), atom});
}

bool IsProtection(const Datum& atom) {
  return atom.Head() == kProtectionWord && atom.items.size() == 2 && atom.tail.empty();
}

bool IsFact(const Datum& atom) {
  return DatumAtoms::IsAtom(atom) && atom.Head() != kProtectionWord && IsGround(atom);
}

void CollectPredicates(const std::vector<Effect>& effects, PredicateSet* predicates) {
  for (const Effect& effect : effects) {
    if (effect.kind == Effect::Kind::kAtom) predicates->names.emplace(effect.term.Head());
    if (effect.kind == Effect::Kind::kList) predicates->is_open = true;
    CollectPredicates(effect.effects, predicates);
  }
}

PredicateSet ChangingPredicates(const Domain& domain) {
  PredicateSet predicates;
  for (const Operator& op : domain.operators) {
    CollectPredicates(op.deletes, &predicates);
    CollectPredicates(op.adds, &predicates);
  }
  return predicates;
}

}  // namespace hires::planning
