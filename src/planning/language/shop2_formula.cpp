#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "hires/planning/datum_reader.h"
#include "planning/language/shop2_parts.h"

namespace hires::planning::shop2 {
namespace {

constexpr std::string_view kGoalWanted =
    "a goal: (predicate arguments...), a logical word such as (not (p ?x)), a variable, or a list "
    "of "
    "goals";

/// Whose goals stand in a list without a word before them.
enum class ListMeans {
  kSequence,    ///< the precondition's own list
  kConjunction  ///< one within a goal, and what axioms and `:op` hold: from two on, as `and`
};

Formula ReadGoal(const Construct& in, const Datum& datum);
Formula ReadGoals(const Construct& in, const Datum& datum, ListMeans means);

Formula Make(Formula::Kind kind, const Datum& from) {
  Formula formula;
  formula.kind = kind;
  formula.place = from.place;
  return formula;
}

void WantArguments(const Construct& in, const Datum& datum, std::size_t at_least,
                   std::size_t at_most, std::string_view form) {
  const std::size_t count = datum.items.size() - 1;
  if (count >= at_least && count <= at_most && datum.tail.empty()) return;
  FailAbout(in, datum, form);
}

void WantVariable(const Construct& in, const Datum& datum, std::string_view form) {
  if (datum.kind == Datum::Kind::kVariable) return;
  FailAbout(in, datum, fmt::format("a variable, as in {}", form));
}

// -------------------------------------------------------------------------------- words of
// formulas

/// How one logical word is read.
using ReadWord = Formula (*)(const Construct& in, const Datum& datum);

template <Formula::Kind kKind>
Formula ReadParts(const Construct& in, const Datum& datum) {
  Formula formula = Make(kKind, datum);
  if (!datum.tail.empty()) FailAbout(in, datum, "a list of goals without a dot");
  std::transform(datum.items.begin() + 1, datum.items.end(), std::back_inserter(formula.parts),
                 [&](const Datum& part) { return ReadGoal(in, part); });
  return formula;
}

Formula ReadNot(const Construct& in, const Datum& datum) {
  WantArguments(in, datum, 1, 1, "(not goal)");
  return ReadParts<Formula::Kind::kNot>(in, datum);
}

Formula ReadImply(const Construct& in, const Datum& datum) {
  WantArguments(in, datum, 2, 2, "(imply condition conclusion)");
  return ReadParts<Formula::Kind::kImply>(in, datum);
}

/// `?x` or `(?x ?y)`.
std::vector<std::string> ReadVariables(const Construct& in, const Datum& datum,
                                       std::string_view form) {
  if (datum.kind == Datum::Kind::kVariable) return {datum.text};
  if (!datum.IsNil() && (!datum.IsList() || !datum.tail.empty())) {
    FailAbout(in, datum, fmt::format("a list of variables, as in {}", form));
  }
  std::vector<std::string> names;
  for (const Datum& item : datum.items) {
    WantVariable(in, item, form);
    names.push_back(item.text);
  }
  return names;
}

template <Formula::Kind kKind>
Formula ReadQuantifier(const Construct& in, const Datum& datum, std::size_t at_least,
                       std::string_view form) {
  WantArguments(in, datum, at_least, 3, form);
  Formula formula = Make(kKind, datum);
  formula.variables = ReadVariables(in, datum.items[1], form);
  for (std::size_t i = 2; i < datum.items.size(); ++i) {
    formula.parts.push_back(ReadGoal(in, datum.items[i]));
  }
  formula.parts.resize(2, Make(Formula::Kind::kSequence, datum));
  return formula;
}

Formula ReadForall(const Construct& in, const Datum& datum) {
  return ReadQuantifier<Formula::Kind::kForall>(in, datum, 3,
                                                "(forall (?variables...) condition conclusion)");
}

Formula ReadExists(const Construct& in, const Datum& datum) {
  return ReadQuantifier<Formula::Kind::kExists>(in, datum, 2,
                                                "(exists (?variables...) condition conclusion)");
}

template <Formula::Kind kKind>
Formula ReadAssignment(const Construct& in, const Datum& datum) {
  constexpr std::string_view kForm = "(assign ?variable expression)";
  WantArguments(in, datum, 2, 2, kForm);
  WantVariable(in, datum.items[1], kForm);
  Formula formula = Make(kKind, datum);
  formula.term = datum.items[1];
  formula.expression = ReadExpression(datum.items[2]);
  return formula;
}

Formula ReadEval(const Construct& in, const Datum& datum) {
  WantArguments(in, datum, 1, 1, "(eval expression)");
  Formula formula = Make(Formula::Kind::kEval, datum);
  formula.expression = ReadExpression(datum.items[1]);
  return formula;
}

Formula ReadCall(const Construct& in, const Datum& datum) {
  if (datum.items.size() < 2 || !datum.tail.empty()) {
    FailAbout(in, datum, "(call function arguments...)");
  }
  Formula formula = Make(Formula::Kind::kEval, datum);
  formula.expression = ReadExpression(datum);
  return formula;
}

template <Formula::Kind kKind>
Formula ReadCollection(const Construct& in, const Datum& datum) {
  constexpr std::string_view kForm = "(setof term goals ?variable)";
  WantArguments(in, datum, 3, 3, kForm);
  WantVariable(in, datum.items[3], kForm);
  Formula formula = Make(kKind, datum);
  formula.term = Unquoted(datum.items[1]);
  formula.parts.push_back(ReadGoal(in, datum.items[2]));
  formula.expression = datum.items[3];
  return formula;
}

struct Word {
  std::string_view name;
  ReadWord read;
};

constexpr std::array kWords{
    Word{"and", ReadParts<Formula::Kind::kAnd>},
    Word{"or", ReadParts<Formula::Kind::kOr>},
    Word{"not", ReadNot},
    Word{"imply", ReadImply},
    Word{"forall", ReadForall},
    Word{"shop-forall", ReadForall},
    Word{"exists", ReadExists},
    Word{"assign", ReadAssignment<Formula::Kind::kAssign>},
    Word{"assign*", ReadAssignment<Formula::Kind::kAssignEach>},
    Word{"eval", ReadEval},
    Word{"call", ReadCall},
    Word{"setof", ReadCollection<Formula::Kind::kSetOf>},
    Word{"bagof", ReadCollection<Formula::Kind::kBagOf>},
};

ReadWord FindWord(std::string_view name) {
  const auto* word = std::find_if(kWords.begin(), kWords.end(),
                                  [&](const Word& known) { return known.name == name; });
  return word == kWords.end() ? nullptr : word->read;
}

// --------------------------------------------------------------------------------------------
// goals

bool IsGoalList(const Datum& datum) {
  if (!datum.IsList() || datum.items.empty()) return false;
  const Datum& first = datum.items[0];
  return first.IsList() || first.kind == Datum::Kind::kVariable;
}

/// (?goal ...) is a list of goals; (?predicate a b), with something that is no goal, is refused.
Formula ReadGoalList(const Construct& in, const Datum& datum, ListMeans means) {
  const bool is_and = means == ListMeans::kConjunction && datum.items.size() > 1;
  if (!datum.tail.empty()) FailAbout(in, datum, "a list of goals without a dot");
  Formula list = Make(is_and ? Formula::Kind::kAnd : Formula::Kind::kSequence, datum);
  std::transform(datum.items.begin(), datum.items.end(), std::back_inserter(list.parts),
                 [&](const Datum& goal) { return ReadGoal(in, goal); });
  return list;
}

Formula ReadTerm(const Datum& datum, Formula::Kind kind) {
  Formula formula = Make(kind, datum);
  formula.term = Unquoted(datum);
  return formula;
}

[[noreturn]] void FailOnKeyword(const Construct& in, const Datum& datum) {
  const std::string_view head = datum.Head();
  if (head == ":first" || head == ":sort-by") {
    Fail(in, datum.place,
         fmt::format("'{}' stands within a goal; it only belongs at the beginning of a whole "
                     "precondition{}",
                     head, head == ":first" ? " or of an axiom's tail" : ""));
  }
  FailAbout(in, datum, kGoalWanted);
}

Formula ReadGoals(const Construct& in, const Datum& datum, ListMeans means) {
  if (datum.IsNil()) return Make(Formula::Kind::kSequence, datum);
  if (datum.kind == Datum::Kind::kVariable) return ReadTerm(datum, Formula::Kind::kGoal);
  if (IsGoalList(datum)) return ReadGoalList(in, datum, means);
  const std::string_view head = datum.Head();
  if (head.empty() || head[0] == ':') FailOnKeyword(in, datum);
  if (head == "quote" || head == "backquote") FailAbout(in, datum, "a goal without a quote");
  if (const ReadWord read = FindWord(head)) return read(in, datum);
  return ReadTerm(datum, Formula::Kind::kAtom);
}

Formula ReadGoal(const Construct& in, const Datum& datum) {
  return ReadGoals(in, datum, ListMeans::kConjunction);
}

// ------------------------------------------------------------------------------------
// preconditions

/// `>`, `'>` or `#'>`.
std::string ReadComparison(const Construct& in, const Datum& datum) {
  const bool is_wrapped =
      (datum.Head() == "function" || datum.Head() == "quote") && datum.items.size() == 2;
  const Datum& name = is_wrapped ? datum.items[1] : datum;
  if (name.kind != Datum::Kind::kSymbol) {
    FailAbout(in, datum, "the name of a function of two values, such as #'<");
  }
  return name.text;
}

Precondition ReadSorted(const Construct& in, const Datum& datum, ListMeans means) {
  WantArguments(in, datum, 2, 3, "(:sort-by key [#'comparison] goals)");
  Precondition precondition;
  precondition.order = Precondition::Order::kSortBy;
  precondition.sort_key = ReadExpression(datum.items[1]);
  if (datum.items.size() == 4) precondition.comparison = ReadComparison(in, datum.items[2]);
  precondition.condition = ReadGoals(in, datum.items.back(), means);
  return precondition;
}

Precondition ReadFirst(const Construct& in, const Datum& datum, ListMeans means) {
  Datum goals = datum;
  goals.items.erase(goals.items.begin());
  Precondition precondition;
  precondition.order = Precondition::Order::kFirst;
  precondition.condition = ReadGoals(in, goals, means);
  return precondition;
}

Precondition ReadAnyPrecondition(const Construct& in, const Datum& datum, ListMeans means) {
  if (datum.Head() == ":first") return ReadFirst(in, datum, means);
  if (datum.Head() == ":sort-by") return ReadSorted(in, datum, means);
  Precondition precondition;
  precondition.condition = ReadGoals(in, datum, means);
  return precondition;
}

// ------------------------------------------------------------------------------------------
// effects

constexpr std::string_view kEffectWanted =
    "an atom (predicate arguments...), (:protection atom), (forall (?variables...) condition "
    "(atoms...)) or a variable";

Effect MakeEffect(Effect::Kind kind, const Datum& from) {
  Effect effect;
  effect.kind = kind;
  effect.place = from.place;
  return effect;
}

Effect ReadProtection(const Construct& in, const Datum& datum) {
  constexpr std::string_view kForm = "(:protection (predicate arguments...))";
  WantArguments(in, datum, 1, 1, kForm);
  Effect effect = MakeEffect(Effect::Kind::kProtection, datum);
  effect.term = Unquoted(datum.items[1]);
  if (effect.term.Head() == "not") {
    Fail(in, datum.place,
         fmt::format(
             "{} protects that an atom does not hold, as SHOP3 can; here atoms that hold are "
             "protected alone; protect another atom, or check in the preconditions of what "
             "adds this one",
             Excerpt(datum)));
  }
  if (effect.term.kind != Datum::Kind::kVariable) CheckAtom(in, effect.term, kForm);
  return effect;
}

Effect ReadForallEffect(const Construct& in, const Datum& datum) {
  constexpr std::string_view kForm = "(forall (?variables...) condition (atoms...))";
  WantArguments(in, datum, 3, 3, kForm);
  ReadVariables(in, datum.items[1], kForm);
  Effect effect = MakeEffect(Effect::Kind::kForall, datum);
  effect.condition = ReadGoal(in, datum.items[2]);
  effect.effects = ReadEffects(in, datum.items[3]);
  return effect;
}

Effect ReadEffect(const Construct& in, const Datum& datum) {
  const std::string_view head = datum.Head();
  if (head == ":protection") return ReadProtection(in, datum);
  if (head == "forall" || head == "shop-forall") return ReadForallEffect(in, datum);
  const bool is_variable = datum.kind == Datum::Kind::kVariable;
  if (!is_variable) CheckAtom(in, datum, kEffectWanted);
  Effect effect = MakeEffect(is_variable ? Effect::Kind::kList : Effect::Kind::kAtom, datum);
  effect.term = Unquoted(datum);
  return effect;
}

}  // namespace

bool IsLogicalWord(std::string_view word) { return FindWord(word) != nullptr; }

Precondition ReadPrecondition(const Construct& in, const Datum& datum) {
  return ReadAnyPrecondition(in, datum, ListMeans::kSequence);
}

Precondition ReadConjunction(const Construct& in, const Datum& datum) {
  Precondition precondition = ReadAnyPrecondition(in, datum, ListMeans::kConjunction);
  Formula& condition = precondition.condition;
  if (condition.kind == Formula::Kind::kSequence && condition.parts.size() == 1) {
    condition = Formula(condition.parts[0]);
  }
  return precondition;
}

std::vector<Effect> ReadEffects(const Construct& in, const Datum& datum) {
  if (datum.IsNil()) return {};
  if (datum.kind == Datum::Kind::kVariable) return {ReadEffect(in, datum)};
  const bool is_list = datum.IsList() && datum.tail.empty();
  if (!is_list || !datum.Head().empty()) {
    FailAbout(in, datum, "a list of effects, as in ((on ?x ?y) (clear ?z)), nil, or a variable");
  }
  std::vector<Effect> effects;
  std::transform(datum.items.begin(), datum.items.end(), std::back_inserter(effects),
                 [&](const Datum& effect) { return ReadEffect(in, effect); });
  return effects;
}

std::vector<Effect> ReadDeletes(const Construct& in, const Datum& datum,
                                std::vector<std::string>* warnings) {
  if (!datum.IsList() || !datum.tail.empty() || !datum.Head().empty())
    return ReadEffects(in, datum);
  const auto is_inert = [](const Datum& item) {
    const std::string_view head = item.Head();
    return IsLogicalWord(head) && head != "forall" && head != "shop-forall";
  };
  const auto first = std::find_if(datum.items.begin(), datum.items.end(), is_inert);
  if (first == datum.items.end()) return ReadEffects(in, datum);
  warnings->push_back(
      Located(in.source, first->place,
              fmt::format("{}: the delete {} begins with a logical word and deletes nothing, as no "
                          "fact has such a name; it is passed over; take it away, or write the "
                          "atoms that shall go",
                          in.name, Excerpt(*first))));
  Datum rest = datum;
  rest.items.erase(std::remove_if(rest.items.begin(), rest.items.end(), is_inert),
                   rest.items.end());
  return ReadEffects(in, rest);
}

}  // namespace hires::planning::shop2
