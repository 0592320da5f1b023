#include "hires/planning/step_replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "hires/planning/domain.h"

namespace hires::planning {
namespace {

Substitution ToSubstitution(const ValueMap& values) {
  Substitution result;
  for (const auto& [variable, value] : values) result.Unify(MakeVariable(variable), value);
  return result;
}

ValueMap GroundValues(const std::vector<std::pair<std::string, Datum>>& bindings) {
  ValueMap values;
  for (const auto& [variable, value] : bindings) {
    if (IsGround(value)) values[variable] = value;
  }
  return values;
}

bool Contains(const std::vector<Datum>& atoms, const Datum& atom) {
  return std::find(atoms.begin(), atoms.end(), atom) != atoms.end();
}

/// The fact that excludes a step, with its name as given.
Datum ExclusionOf(const Datum& task, const std::string& name) {
  std::vector<Datum> items = {MakeSymbol("imagined_failure"), MakeSymbol(name)};
  items.insert(items.end(), task.items.begin() + 1, task.items.end());
  return MakeList(std::move(items));
}

Datum Marked(const char* mark, const Datum& atom) { return MakeList({MakeSymbol(mark), atom}); }

}  // namespace

/// What CollectAtoms asks, answered with data.
class StepReplay::EffectValues : public DatumAtoms {
 public:
  EffectValues(StepReplay* replay, ReplayedStep* taken, Changes* changes)
      : replay_(*replay), taken_(*taken), changes_(*changes) {
    SetValues(taken->values);
  }

  Datum Instantiate(const Effect& effect) {
    return replay_.prover_.evaluator().Instantiate(effect.term, substitution_);
  }

  /// The condition's bindings are all found in the state the step comes to.
  template <typename Visit>
  void ForEachBinding(const Effect& effect, const Visit& visit) {
    const ValueMap outer = values_;
    ProofQuestion question{effect.condition, replay_.facts_, replay_.moment_};
    question.known = outer;
    question.explain = replay_.explain_;
    question.reads_all = true;
    for (const Proof& proof : replay_.prover_.AllProofs(question, &taken_.reads)) {
      ValueMap inner = outer;
      inner.insert(proof.values.begin(), proof.values.end());
      SetValues(std::move(inner));
      visit();
    }
    SetValues(outer);
  }

  void Take(const Datum& atom) {
    if (IsProtection(atom)) {
      changes_.protections.push_back(atom.items[1]);
    } else {
      changes_.atoms.push_back(atom);
    }
  }

 private:
  void SetValues(ValueMap values) {
    values_ = std::move(values);
    substitution_ = ToSubstitution(values_);
  }

  StepReplay& replay_;
  ReplayedStep& taken_;
  Changes& changes_;
  ValueMap values_;
  Substitution substitution_;
};

StepReplay::StepReplay(const Domain& domain, const Problem& problem, const Functions& functions,
                       bool explain)
    : domain_(domain), explain_(explain), prover_(domain, functions) {
  for (const Datum& fact : domain.facts) facts_.Add(fact, 0);
  for (const Datum& fact : problem.facts) facts_.Add(fact, 0);
  for (const Datum& atom : problem.protections) {
    auto& [protected_atom, count] = protections_[ToString(atom)];
    protected_atom = atom;
    ++count;
  }
}

const Operator* StepReplay::FindOperator(const Datum& task, ValueMap* known) const {
  for (const Operator& op : domain_.operators) {
    Substitution values;
    if (op.head.Head() != task.Head() || !values.Unify(op.head, task)) continue;
    std::set<std::string> variables;
    CollectVariables(op.head, &variables);
    for (const std::string& variable : variables) {
      (*known)[variable] = values.Apply(MakeVariable(variable));
    }
    return &op;
  }
  return nullptr;
}

ReplayedStep StepReplay::Take(const PlanStep& step) {
  ReplayedStep taken;
  ValueMap known;
  if (!IsGround(step.task)) taken.wrong.push_back("has unbound variables");
  taken.op = FindOperator(step.task, &known);
  if (taken.op == nullptr) {
    taken.wrong.push_back("no operator of the domain has this name and these arguments");
    ++moment_;
    return taken;
  }
  CheckExclusion(step, &taken);
  ProvePrecondition(step, known, &taken);
  taken.cost = prover_.evaluator().EvaluateCost(taken.op->cost, ToSubstitution(taken.values));
  Changes deletes;
  Changes adds;
  Resolve(taken.op->deletes, &taken, &deletes);
  Resolve(taken.op->adds, &taken, &adds);
  ++moment_;
  Change(deletes, adds, &taken);
  ChangeProtections(deletes, adds, &taken);
  CheckProtections(&taken);
  return taken;
}

void StepReplay::CheckExclusion(const PlanStep& step, ReplayedStep* taken) const {
  const std::string name(step.task.Head());
  const std::size_t bare = std::min(name.find_first_not_of('!'), name.size());
  for (std::size_t skipped = 0; skipped <= bare; ++skipped) {
    const Datum exclusion = ExclusionOf(step.task, name.substr(skipped));
    if (!facts_.Holds(exclusion, moment_)) continue;
    taken->wrong.push_back("is excluded by the fact " + ToString(exclusion));
  }
}

void StepReplay::ProvePrecondition(const PlanStep& step, const ValueMap& known,
                                   ReplayedStep* taken) {
  ProofQuestion question{taken->op->precondition.condition, facts_, moment_};
  question.known = known;
  question.expected = GroundValues(step.bindings);
  question.newest_first = step.bindings.empty();  // then the operator's own choice counts
  question.explain = explain_;
  std::optional<Proof> proof = prover_.FirstProof(question);
  if (proof) {
    taken->values = std::move(proof->values);
    taken->support = std::move(proof->support);
    taken->reads = std::move(proof->reads);
    return;
  }
  taken->values = known;
  for (const auto& [variable, value] : question.expected) taken->values.emplace(variable, value);
  taken->wrong.push_back(fmt::format("{}the precondition of its operator does not hold",
                                     At(domain_.source, taken->op->place)));
}

void StepReplay::Resolve(const std::vector<Effect>& effects, ReplayedStep* taken,
                         Changes* changes) {
  EffectValues values(this, taken, changes);
  CollectAtoms(effects, &values);
}

void StepReplay::Change(const Changes& deletes, const Changes& adds, ReplayedStep* taken) {
  for (const Datum& atom : deletes.atoms) {
    if (!IsFact(atom)) continue;  // it never holds
    const bool is_gone = facts_.Remove(atom, moment_);
    if (Contains(adds.atoms, atom) || Contains(taken->deletes, atom)) continue;
    if (is_gone) taken->deletes.push_back(atom);
    if (!is_gone) taken->reads.push_back(atom);
  }
  for (const Datum& atom : adds.atoms) {
    if (!IsFact(atom)) {
      taken->wrong.push_back("adds " + ToString(atom) + ", which " +
                             (IsGround(atom) ? "is no fact" : "has unbound variables"));
    } else if (!Contains(taken->adds, atom)) {
      taken->adds.push_back(atom);
    }
  }
  // The first of the list is the newest fact.
  for (auto atom = adds.atoms.rbegin(); atom != adds.atoms.rend(); ++atom) {
    if (IsFact(*atom)) facts_.Add(*atom, moment_);
  }
}

void StepReplay::ChangeProtections(const Changes& deletes, const Changes& adds,
                                   ReplayedStep* taken) {
  for (const Datum& atom : adds.protections) {
    if (IsFact(atom)) taken->protects.push_back(atom);
    if (!IsFact(atom)) taken->wrong.push_back("protects " + ToString(atom) + ", which is no fact");
  }
  taken->unprotects = deletes.protections;
  for (const Datum& atom : deletes.protections) {
    taken->reads.push_back(atom);
    taken->reads.push_back(Marked(":unprotection", atom));
    const auto found = protections_.find(ToString(atom));
    if (found != protections_.end() && --found->second.second == 0) protections_.erase(found);
  }
  for (const Datum& atom : taken->protects) {
    taken->reads.push_back(atom);
    taken->reads.push_back(DatumAtoms::Protection(atom));
    auto& [protected_atom, count] = protections_[ToString(atom)];
    protected_atom = atom;
    ++count;
  }
}

void StepReplay::CheckProtections(ReplayedStep* taken) {
  for (const auto& [text, protection] : protections_) {
    if (facts_.Holds(protection.first, moment_)) continue;
    const Formula atom = MakeAtom(protection.first);
    if (prover_.Holds({atom, facts_, moment_})) continue;
    taken->wrong.push_back("the protected atom " + text + " does not hold after it");
  }
}

}  // namespace hires::planning
