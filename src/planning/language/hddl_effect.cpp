#include "planning/language/hddl_effect.h"

#include <fmt/format.h>

#include "hires/planning/datum_reader.h"

namespace hires::planning::hddl {
namespace {

bool IsNumber(const Datum& datum) {
  return datum.kind == Datum::Kind::kInteger || datum.kind == Datum::Kind::kReal;
}

bool ChangesNumber(const std::string& word) {
  static const std::set<std::string> words{"increase", "decrease", "assign", "scale-up",
                                           "scale-down"};
  return words.count(word) > 0;
}

/// The effects under the same forall and when.
struct Group {
  std::vector<Formula> type_atoms;  ///< of the variables of every forall around
  std::vector<Formula> conditions;  ///< of every when around
  std::vector<Effect> deletes;
  std::vector<Effect> adds;

  bool IsConditional() const { return !type_atoms.empty() || !conditions.empty(); }
};

class EffectReader {
 public:
  explicit EffectReader(HddlScope* scope) : scope_(scope) {
    for (const auto& variable : scope->variables) parameters_.insert(variable.first);
  }

  HddlEffects Read(const Datum& datum) {
    Group top;
    ReadInto(datum, &top);
    Close(std::move(top));
    return std::move(effects_);
  }

 private:
  void ReadInto(const Datum& datum, Group* group) {
    RequireList(scope_->spot, datum, "an effect such as (near ?a ?b) or (not (near ?a ?b))");
    const std::string head(datum.Head());
    if (datum.items.empty()) return;
    if (head == "and" || LacksAnd(datum)) {
      for (std::size_t i = head == "and" ? 1 : 0; i < datum.items.size(); ++i)
        ReadInto(datum.items[i], group);
    } else if (head == "forall") {
      ReadForall(datum, *group);
    } else if (head == "when") {
      ReadWhen(datum, *group);
    } else if (ChangesNumber(head)) {
      ReadCost(datum, *group);
    } else if (head == "not") {
      RequireSize(datum, 2, "(not (predicate ...))");
      group->deletes.push_back(AtomEffect(datum.items[1]));
    } else {
      group->adds.push_back(AtomEffect(datum));
    }
  }

  void RequireSize(const Datum& datum, std::size_t size, std::string_view wanted) const {
    if (datum.items.size() == size) return;
    scope_->spot.Fail(datum, fmt::format("{} came, wanted {}", Excerpt(datum), wanted));
  }

  Effect AtomEffect(const Datum& datum) const {
    CheckTerm(scope_->spot, datum, "predicate", scope_->vocabulary->predicates, scope_->variables,
              scope_->vocabulary);
    Effect effect;
    effect.term = datum;
    effect.place = datum.place;
    return effect;
  }

  void ReadForall(const Datum& datum, const Group& around) {
    RequireSize(datum, 3, "(forall (?x - type) effect)");
    const HddlVariables outer = scope_->variables;
    const HddlQuantified quantified = DeclareQuantified(datum.items[1], datum.items[2], scope_);
    Group group{around.type_atoms, around.conditions, {}, {}};
    group.type_atoms.insert(group.type_atoms.end(), quantified.type_atoms.begin(),
                            quantified.type_atoms.end());
    ReadInto(quantified.body, &group);
    Close(std::move(group));
    scope_->variables = outer;
  }

  void ReadWhen(const Datum& datum, const Group& around) {
    RequireSize(datum, 3, "(when condition effect)");
    Group group{around.type_atoms, around.conditions, {}, {}};
    group.conditions.push_back(ReadCondition(datum.items[1], scope_));
    ReadInto(datum.items[2], &group);
    Close(std::move(group));
  }

  /// Puts what a group holds where it belongs, under its condition if it has one.
  void Close(Group group) {
    Formula condition;
    if (group.IsConditional()) {
      condition = ArrangeConjunction(group.conditions, group.type_atoms, parameters_);
    }
    const bool wrap = group.IsConditional();
    Move(std::move(group.deletes), wrap, condition, &effects_.deletes);
    Move(std::move(group.adds), wrap, condition, &effects_.adds);
  }

  static void Move(std::vector<Effect> from, bool wrap, const Formula& condition,
                   std::vector<Effect>* to) {
    if (from.empty()) return;
    if (!wrap) {
      to->insert(to->end(), from.begin(), from.end());
      return;
    }
    Effect effect;
    effect.kind = Effect::Kind::kForall;
    effect.condition = condition;
    effect.place = from[0].place;
    effect.effects = std::move(from);
    to->push_back(std::move(effect));
  }

  void ReadCost(const Datum& datum, const Group& group) {
    RequireSize(datum, 3, "(increase (total-cost) amount)");
    const Datum& target = datum.items[1];
    const bool is_cost = target.IsSymbol("total-cost") || target.Head() == "total-cost";
    if (datum.Head() != "increase" || !is_cost) {
      scope_->spot.Fail(datum, fmt::format("{} changes a number; functions keep the values of the "
                                           "initial state, only (increase (total-cost) amount) "
                                           "is possible",
                                           Excerpt(datum)));
    }
    if (!scope_->vocabulary->has_costs) {
      scope_->spot.Fail(datum, "(total-cost) is not declared; add (:functions (total-cost))");
    }
    if (group.IsConditional()) {
      scope_->spot.Fail(datum,
                        "costs under forall or when are not supported; give the action one "
                        "cost, or split it into several");
    }
    ReadAmount(datum.items[2]);
  }

  void ReadAmount(const Datum& datum) {
    if (!datum.IsList()) {
      effects_.costs.push_back(RequireAmount(scope_->spot, datum));
    } else if (datum.Head() == "+") {
      for (std::size_t i = 1; i < datum.items.size(); ++i) ReadAmount(datum.items[i]);
    } else {
      ReadFunctionValue(datum);
    }
  }

  void ReadFunctionValue(const Datum& datum) {
    const HddlVocabulary::Signature& function =
        CheckTerm(scope_->spot, datum, "function", scope_->vocabulary->functions, scope_->variables,
                  scope_->vocabulary);
    const Datum value =
        MakeVariable(fmt::format("?%{}{}", function.name, effects_.value_atoms.size() + 1));
    Datum atom = datum;
    atom.items[0] = MakeSymbol(ValuePredicate(function.name));
    atom.items.push_back(value);
    effects_.value_atoms.push_back(MakeAtom(std::move(atom)));
    effects_.costs.push_back(value);
  }

  HddlScope* scope_;
  std::set<std::string> parameters_;
  HddlEffects effects_;
};

}  // namespace

HddlEffects ReadEffects(const Datum& datum, HddlScope* scope) {
  return EffectReader(scope).Read(datum);
}

Datum CostOf(const HddlEffects& effects, const HddlVocabulary& vocabulary) {
  if (effects.costs.empty()) return MakeInteger(vocabulary.has_costs ? 0 : 1);
  if (effects.costs.size() == 1) return effects.costs[0];
  std::vector<Datum> sum = effects.costs;
  sum.insert(sum.begin(), MakeSymbol("+"));
  return MakeList(std::move(sum));
}

const Datum& RequireAmount(const HddlSpot& spot, const Datum& datum) {
  const double value =
      datum.kind == Datum::Kind::kInteger ? static_cast<double>(datum.integer) : datum.real;
  if (!IsNumber(datum) || !(value >= 0.0)) {
    spot.Fail(datum, fmt::format("{} stands where an amount is wanted; write a number of at least "
                                 "0",
                                 Excerpt(datum)));
  }
  return datum;
}

}  // namespace hires::planning::hddl
