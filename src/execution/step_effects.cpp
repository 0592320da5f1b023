#include "execution/step_effects.h"

#include <algorithm>

#include "hires/planning/domain.h"
#include "hires/planning/substitution.h"

namespace hires::execution {
namespace {

/// Effects as the arguments of a step tell them; other variables may stand for anything.
class EffectPatterns : public planning::DatumAtoms {
 public:
  EffectPatterns(const planning::Substitution& arguments, std::vector<Datum>* patterns)
      : arguments_(arguments), patterns_(*patterns) {}

  Datum Instantiate(const planning::Effect& effect) const { return arguments_.Apply(effect.term); }
  template <typename Visit>
  void ForEachBinding(const planning::Effect&, const Visit& visit) const {
    visit();
  }
  void Take(const Datum& atom) {
    if (!IsProtection(atom)) patterns_.push_back(atom);
  }

 private:
  const planning::Substitution& arguments_;
  std::vector<Datum>& patterns_;
};

void RemoveDisturbed(const Disturbance& disturbance, Facts* facts) {
  facts->RemoveMatches(disturbance.effects);
  facts->RemoveMatches(disturbance.passing);
}

}  // namespace

const planning::Operator* OperatorOf(const planning::Domain& domain, const Datum& task) {
  for (const planning::Operator& op : domain.operators) {
    if (op.head.Head() == task.Head() && planning::Substitution().Unify(op.head, task)) return &op;
  }
  return nullptr;
}

Disturbance DisturbanceOf(const planning::Domain& domain, const planning::OperatorData& operators,
                          const planning::PlanStep& step) {
  Disturbance disturbance;
  disturbance.effects = step.adds;
  disturbance.effects.insert(disturbance.effects.end(), step.deletes.begin(), step.deletes.end());
  const planning::Operator* op = OperatorOf(domain, step.task);
  planning::Substitution arguments;
  if (op == nullptr || !arguments.Unify(op->head, step.task)) return disturbance;
  EffectPatterns patterns(arguments, &disturbance.effects);
  CollectAtoms(op->deletes, &patterns);
  for (const Datum& pattern : EntryOf(operators, step.task.Head()).disturbs) {
    disturbance.passing.push_back(arguments.Apply(pattern));
  }
  return disturbance;
}

std::vector<Datum> TouchedBy(const Disturbance& disturbance, const Facts& facts) {
  std::vector<Datum> touched;
  for (const auto& [text, atom] : facts.all()) {
    if (disturbance.Touches(atom)) touched.push_back(atom);
  }
  return touched;
}

void ApplyEffects(const planning::PlanStep& step, Facts* facts) {
  for (const Datum& atom : step.deletes) facts->Remove(atom);
  for (const Datum& atom : step.adds) facts->Add(atom);
}

void ApplyEffects(const planning::PlanStep& step, const Disturbance& disturbance, Facts* facts) {
  const bool is_foreseen =
      std::all_of(step.deletes.begin(), step.deletes.end(),
                  [&](const Datum& atom) { return facts->HoldsText(ToString(atom)); });
  if (!is_foreseen) facts->RemoveMatches(disturbance.effects);
  ApplyEffects(step, facts);
}

void ApplyEffects(const planning::PlanStep& step, const Disturbance& disturbance,
                  const std::vector<Datum>& before, Facts* facts) {
  RemoveDisturbed(disturbance, facts);
  for (const Datum& atom : before) {
    if (CanMatchAny(disturbance.passing, atom)) facts->Add(atom);
  }
  ApplyEffects(step, facts);
}

void TakeBack(const Disturbance& disturbance, const std::vector<Datum>& before, Facts* facts) {
  RemoveDisturbed(disturbance, facts);
  for (const Datum& atom : before) facts->Add(atom);
}

}  // namespace hires::execution
