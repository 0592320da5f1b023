#include "planning/language/hddl_formula.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "hires/base/check.h"
#include "hires/planning/datum_reader.h"
#include "hires/planning/substitution.h"

namespace hires::planning::hddl {
namespace {

using Kind = Formula::Kind;

void RequireParts(const HddlScope& scope, const Datum& datum, std::size_t count,
                  std::string_view wanted) {
  if (datum.items.size() == count + 1) return;
  scope.spot.Fail(datum, fmt::format("{} came, wanted {}", Excerpt(datum), wanted));
}

/// @param first  of the items that are parts.
Formula ReadParts(Kind kind, const Datum& datum, HddlScope* scope, std::size_t first = 1) {
  Formula formula;
  formula.kind = kind;
  formula.place = datum.place;
  for (std::size_t i = first; i < datum.items.size(); ++i) {
    formula.parts.push_back(ReadCondition(datum.items[i], scope));
  }
  return formula;
}

bool IsComparison(const std::string& head) {
  return head == "<" || head == ">" || head == "<=" || head == ">=";
}

bool IsNumeric(const Datum& datum) {
  const auto is_value = [](const Datum& item) {
    return item.IsList() || item.kind == Datum::Kind::kInteger || item.kind == Datum::Kind::kReal;
  };
  return std::any_of(datum.items.begin() + 1, datum.items.end(), is_value);
}

[[noreturn]] void FailOnNumbers(const Datum& datum, const HddlScope& scope) {
  scope.spot.Fail(datum, fmt::format("{} compares numbers, which no condition can: functions say "
                                     "what actions cost; write what matters as a predicate",
                                     Excerpt(datum)));
}

Formula ReadEqual(const Datum& datum, HddlScope* scope) {
  RequireParts(*scope, datum, 2, "(= a b)");
  if (IsNumeric(datum)) FailOnNumbers(datum, *scope);
  Formula formula;
  formula.kind = Kind::kEqual;
  formula.term = datum;
  formula.place = datum.place;
  for (int i : {1, 2}) {
    CheckArgument(scope->spot, datum.items[i], HddlVocabulary::kObject, scope->variables,
                  scope->vocabulary);
  }
  return formula;
}

/// (sortof ?x - type), where no predicate goes by that name.
Formula ReadSort(const Datum& datum, HddlScope* scope) {
  const std::vector<HddlTyped> typed = ReadTypedList(scope->spot, datum, 1, Datum::Kind::kVariable);
  if (typed.size() != 1 || typed[0].types.empty()) {
    scope->spot.Fail(datum, fmt::format("{} came, wanted (sortof ?x - type)", Excerpt(datum)));
  }
  CheckArgument(scope->spot, *typed[0].datum, HddlVocabulary::kObject, scope->variables,
                scope->vocabulary);
  Formula atom = TypeAtom(*scope->vocabulary, typed[0].datum->text,
                          TypeOf(scope->spot, typed[0], scope->vocabulary));
  atom.place = datum.place;
  return atom;
}

Formula ReadAtom(const Datum& datum, HddlScope* scope) {
  CheckTerm(scope->spot, datum, "predicate", scope->vocabulary->predicates, scope->variables,
            scope->vocabulary);
  Formula atom = MakeAtom(datum);
  atom.place = datum.place;
  return atom;
}

Formula ReadQuantifier(Kind kind, const Datum& datum, HddlScope* scope) {
  RequireParts(*scope, datum, 2, fmt::format("({} (?x - type) condition)", datum.Head()));
  const HddlVariables outer = scope->variables;
  HddlQuantified quantified = DeclareQuantified(datum.items[1], datum.items[2], scope);
  Formula formula;
  formula.kind = kind;
  formula.place = datum.place;
  formula.variables = std::move(quantified.names);
  formula.parts.push_back(MakeSequence(std::move(quantified.type_atoms)));
  formula.parts.push_back(ReadCondition(quantified.body, scope));
  scope->variables = outer;
  return formula;
}

std::vector<Formula> Pair(Formula first, Formula second) {
  std::vector<Formula> parts;
  parts.push_back(std::move(first));
  parts.push_back(std::move(second));
  return parts;
}

/// A condition other than a positive atom, all its free variables bound: quantified parts arranged.
Formula ArrangeTest(Formula test, const std::set<std::string>& bound) {
  if (test.kind != Kind::kExists && test.kind != Kind::kForall) {
    for (Formula& part : test.parts) part = ArrangeTest(std::move(part), bound);
    return test;
  }
  std::vector<Formula> types = std::move(test.parts[0].parts);
  Formula body = std::move(test.parts[1]);
  std::vector<Formula> guard;
  if (test.kind == Kind::kExists) {
    guard.push_back(std::move(body));
    body = MakeSequence({});
  } else if (body.kind == Kind::kImply) {
    // forall x: a implies b is the same as: for all x with a, b; and a says which x matter.
    guard.push_back(std::move(body.parts[0]));
    body = Formula(std::move(body.parts[1]));
  }
  std::set<std::string> inner = bound;
  inner.insert(test.variables.begin(), test.variables.end());
  test.parts = Pair(ArrangeConjunction(std::move(guard), std::move(types), bound),
                    ArrangeTest(std::move(body), inner));
  return test;
}

/// One arrangement in the making. Goals are told apart by their index in the order in which they
/// came; the work grows with the number of times that they name variables.
class Arrangement {
 public:
  explicit Arrangement(const std::set<std::string>& bound) : bound_(bound) {}

  void Add(Formula formula, bool is_type) {
    const int index = static_cast<int>(goals_.size());
    const Group group = is_type ? kType : formula.kind == Kind::kAtom ? kAtom : kTest;
    Goal goal{std::move(formula), {}, 0, group};
    goal.variables = FreeVariables(goal.formula);
    for (const std::string& name : goal.variables) {
      if (bound_.count(name) > 0) {
        goal.is_touched = true;
      } else {
        ++goal.num_unbound;
        uses_[name].push_back(index);
      }
    }
    goals_.push_back(std::move(goal));
    Enqueue(index);
  }

  Formula Run() {
    while (!queues_.empty()) {
      const auto [queue, index] = *queues_.begin();
      HIRES_CHECK(queue != kNeverReady, "a variable has neither a type nor a value");
      queues_.erase(queues_.begin());
      Take(index);
    }
    return MakeSequence(std::move(arranged_));
  }

 private:
  enum Group { kAtom, kType, kTest };
  struct Goal {
    Formula formula;
    std::set<std::string> variables;
    int num_unbound;
    Group group;
    bool is_touched{false};  ///< one of its variables is bound
  };
  /// What is taken before what.
  enum Queue {
    kBoundAtom,
    kBoundType,
    kBoundTest,
    kTouchedAtom,
    kUntouchedAtom,
    kOpenType,
    kNeverReady
  };

  static Queue QueueOf(const Goal& goal) {
    if (goal.num_unbound == 0) {
      return goal.group == kAtom ? kBoundAtom : goal.group == kType ? kBoundType : kBoundTest;
    }
    if (goal.group == kTest) return kNeverReady;
    if (goal.group == kType) return kOpenType;
    return goal.is_touched ? kTouchedAtom : kUntouchedAtom;
  }

  void Enqueue(int index) { queues_.emplace(QueueOf(goals_[index]), index); }

  void Take(int index) {
    const std::set<std::string> variables = std::move(goals_[index].variables);
    arranged_.push_back(ArrangeTest(std::move(goals_[index].formula), bound_));
    for (const std::string& name : variables) {
      if (bound_.insert(name).second) Bind(name, index);
    }
  }

  void Bind(const std::string& name, int taken) {
    for (const int user : uses_[name]) {
      if (user == taken) continue;
      queues_.erase({QueueOf(goals_[user]), user});
      --goals_[user].num_unbound;
      goals_[user].is_touched = true;
      Enqueue(user);
    }
  }

  std::set<std::string> bound_;
  std::vector<Goal> goals_;
  std::map<std::string, std::vector<int>> uses_;  // goals that wait for a variable
  std::set<std::pair<Queue, int>> queues_;        // goals to be taken
  std::vector<Formula> arranged_;
};

}  // namespace

Formula MakeAtom(Datum term) {
  Formula formula;
  formula.kind = Kind::kAtom;
  formula.place = term.place;
  formula.term = std::move(term);
  return formula;
}

Formula MakeSequence(std::vector<Formula> parts) {
  Formula formula;
  formula.parts = std::move(parts);
  return formula;
}

Formula TypeAtom(const HddlVocabulary& vocabulary, const std::string& variable, int type) {
  return MakeAtom(MakeList({MakeSymbol(TypePredicate(vocabulary, type)), MakeVariable(variable)}));
}

bool IsSortWord(std::string_view word) {
  return word == "sortof" || word == "sort" || word == "typeof" || word == "type";
}

Formula ReadCondition(const Datum& datum, HddlScope* scope) {
  RequireList(scope->spot, datum, "a condition such as (near ?a ?b) or (and ...)");
  if (datum.items.empty()) return MakeSequence({});
  if (LacksAnd(datum)) return ReadParts(Kind::kSequence, datum, scope, 0);
  const std::string head(datum.Head());
  if (head == "and") return ReadParts(Kind::kSequence, datum, scope);
  if (head == "or") return ReadParts(Kind::kOr, datum, scope);
  if (head == "not") {
    RequireParts(*scope, datum, 1, "(not condition)");
    return ReadParts(Kind::kNot, datum, scope);
  }
  if (head == "imply") {
    RequireParts(*scope, datum, 2, "(imply condition condition)");
    return ReadParts(Kind::kImply, datum, scope);
  }
  if (head == "forall") return ReadQuantifier(Kind::kForall, datum, scope);
  if (head == "exists") return ReadQuantifier(Kind::kExists, datum, scope);
  if (head == "=") return ReadEqual(datum, scope);
  if (scope->vocabulary->predicates.count(head) > 0) return ReadAtom(datum, scope);
  if (IsComparison(head)) FailOnNumbers(datum, *scope);
  if (IsSortWord(head)) return ReadSort(datum, scope);
  return ReadAtom(datum, scope);
}

HddlQuantified DeclareQuantified(const Datum& list, const Datum& body, HddlScope* scope) {
  RequireList(scope->spot, list, "variables such as (?x - type)");
  HddlQuantified quantified;
  std::map<std::string, Datum> renamed;
  for (const HddlTyped& typed : ReadTypedList(scope->spot, list, 0, Datum::Kind::kVariable)) {
    std::string name = typed.datum->text;
    if (scope->variables.count(name) > 0) {
      // A name that was changed before does not grow with every quantifier around it.
      name = fmt::format("{}%{}", name.substr(0, name.find('%')), ++scope->num_renamed);
      renamed[typed.datum->text] = MakeVariable(name);
    }
    const int type = TypeOf(scope->spot, typed, scope->vocabulary);
    scope->variables[name] = type;
    quantified.names.push_back(name);
    quantified.type_atoms.push_back(TypeAtom(*scope->vocabulary, name, type));
  }
  quantified.body = renamed.empty() ? body : Substitute(body, renamed);
  return quantified;
}

Datum Substitute(const Datum& datum, const std::map<std::string, Datum>& values) {
  if (datum.kind == Datum::Kind::kVariable) {
    const auto found = values.find(datum.text);
    return found == values.end() ? datum : found->second;
  }
  if (!datum.IsList()) return datum;
  Datum result;
  result.place = datum.place;
  result.tail = datum.tail;
  for (const Datum& item : datum.items) result.items.push_back(Substitute(item, values));
  return result;
}

void AppendConjuncts(Formula formula, std::vector<Formula>* parts) {
  if (formula.kind == Kind::kSequence || formula.kind == Kind::kAnd) {
    for (Formula& part : formula.parts) AppendConjuncts(std::move(part), parts);
  } else if (formula.kind == Kind::kNot && formula.parts[0].kind == Kind::kNot) {
    AppendConjuncts(std::move(formula.parts[0].parts[0]), parts);
  } else {
    parts->push_back(std::move(formula));
  }
}

std::set<std::string> FreeVariables(const Formula& formula) {
  std::set<std::string> variables;
  CollectVariables(formula.term, &variables);
  for (const Formula& part : formula.parts) variables.merge(FreeVariables(part));
  for (const std::string& name : formula.variables) variables.erase(name);
  return variables;
}

Formula ArrangeConjunction(std::vector<Formula> conjuncts, std::vector<Formula> type_atoms,
                           const std::set<std::string>& bound) {
  std::vector<Formula> parts;
  for (Formula& conjunct : conjuncts) AppendConjuncts(std::move(conjunct), &parts);
  Arrangement arrangement(bound);
  for (Formula& part : parts) arrangement.Add(std::move(part), false);
  for (Formula& atom : type_atoms) arrangement.Add(std::move(atom), true);
  return arrangement.Run();
}

}  // namespace hires::planning::hddl
