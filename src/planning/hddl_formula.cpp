#include "hddl_formula.h"

#include <fmt/format.h>

#include <algorithm>

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

Formula ReadParts(Kind kind, const Datum& datum, HddlScope* scope) {
  Formula formula;
  formula.kind = kind;
  formula.place = datum.place;
  for (std::size_t i = 1; i < datum.items.size(); ++i) {
    formula.parts.push_back(ReadCondition(datum.items[i], scope));
  }
  return formula;
}

Formula ReadEqual(const Datum& datum, HddlScope* scope) {
  RequireParts(*scope, datum, 2, "(= a b)");
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

bool Includes(const std::set<std::string>& all, const std::set<std::string>& some) {
  return std::includes(all.begin(), all.end(), some.begin(), some.end());
}

/// A condition other than a positive atom, all its free variables bound: quantified parts arranged.
Formula ArrangeTest(const Formula& test, const std::set<std::string>& bound) {
  Formula arranged = test;
  if (test.kind == Kind::kExists) {
    arranged.parts = {ArrangeConjunction({test.parts[1]}, test.parts[0].parts, bound),
                      MakeSequence({})};
    return arranged;
  }
  if (test.kind != Kind::kForall) {
    for (Formula& part : arranged.parts) part = ArrangeTest(part, bound);
    return arranged;
  }
  // forall x: a implies b is the same as: for all x with a, b; and a says which x matter.
  const bool guarded = test.parts[1].kind == Kind::kImply;
  const Formula body = guarded ? test.parts[1].parts[1] : test.parts[1];
  const std::vector<Formula> guard =
      guarded ? std::vector<Formula>{test.parts[1].parts[0]} : std::vector<Formula>{};
  std::set<std::string> inner = bound;
  inner.insert(test.variables.begin(), test.variables.end());
  arranged.parts = {ArrangeConjunction(guard, test.parts[0].parts, bound),
                    ArrangeTest(body, inner)};
  return arranged;
}

/// One arrangement in the making.
class Arrangement {
 public:
  Arrangement(const std::vector<Formula>& conjuncts, const std::vector<Formula>& type_atoms,
              std::set<std::string> bound)
      : bound_(std::move(bound)) {
    for (const Formula& conjunct : conjuncts) {
      const bool is_atom = conjunct.kind == Kind::kAtom;
      (is_atom ? atoms_ : tests_).push_back({&conjunct, FreeVariables(conjunct)});
    }
    for (const Formula& atom : type_atoms) types_.push_back({&atom, FreeVariables(atom)});
  }

  Formula Run() {
    while (!atoms_.empty() || !types_.empty() || !tests_.empty()) {
      TakeBound(&atoms_);
      TakeBound(&types_);
      TakeBound(&tests_);
      HIRES_CHECK(!atoms_.empty() || !types_.empty() || tests_.empty(),
                  "a variable has neither a type nor a value");
      TakeNext();
    }
    return MakeSequence(std::move(goals_));
  }

 private:
  struct Goal {
    const Formula* formula;
    std::set<std::string> variables;
  };

  void Take(std::vector<Goal>* from, std::size_t index) {
    const Goal goal = (*from)[index];
    from->erase(from->begin() + static_cast<std::ptrdiff_t>(index));
    goals_.push_back(ArrangeTest(*goal.formula, bound_));
    bound_.insert(goal.variables.begin(), goal.variables.end());
  }

  void TakeBound(std::vector<Goal>* from) {
    std::vector<Goal> later;
    for (Goal& goal : *from) {
      if (Includes(bound_, goal.variables)) {
        goals_.push_back(ArrangeTest(*goal.formula, bound_));
      } else {
        later.push_back(std::move(goal));
      }
    }
    *from = std::move(later);
  }

  void TakeNext() {
    if (atoms_.empty()) {
      if (!types_.empty()) Take(&types_, 0);
      return;
    }
    const auto touches = [this](const Goal& goal) {
      return std::any_of(goal.variables.begin(), goal.variables.end(),
                         [this](const std::string& name) { return bound_.count(name) > 0; });
    };
    const auto found = std::find_if(atoms_.begin(), atoms_.end(), touches);
    Take(&atoms_, found == atoms_.end() ? 0 : static_cast<std::size_t>(found - atoms_.begin()));
  }

  std::set<std::string> bound_;
  std::vector<Goal> atoms_;
  std::vector<Goal> types_;
  std::vector<Goal> tests_;
  std::vector<Formula> goals_;
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
  if (IsSortWord(head) && scope->vocabulary->predicates.count(head) == 0) {
    return ReadSort(datum, scope);
  }
  return ReadAtom(datum, scope);
}

HddlQuantified DeclareQuantified(const Datum& list, const Datum& body, HddlScope* scope) {
  RequireList(scope->spot, list, "variables such as (?x - type)");
  HddlQuantified quantified;
  std::map<std::string, Datum> renamed;
  for (const HddlTyped& typed : ReadTypedList(scope->spot, list, 0, Datum::Kind::kVariable)) {
    std::string name = typed.datum->text;
    if (scope->variables.count(name) > 0) {
      name = fmt::format("{}%{}", name, ++scope->num_renamed);
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
  Datum result = datum;
  for (Datum& item : result.items) item = Substitute(item, values);
  return result;
}

void AppendConjuncts(const Formula& formula, std::vector<Formula>* parts) {
  if (formula.kind == Kind::kSequence || formula.kind == Kind::kAnd) {
    for (const Formula& part : formula.parts) AppendConjuncts(part, parts);
  } else if (formula.kind == Kind::kNot && formula.parts[0].kind == Kind::kNot) {
    AppendConjuncts(formula.parts[0].parts[0], parts);
  } else {
    parts->push_back(formula);
  }
}

std::set<std::string> FreeVariables(const Formula& formula) {
  std::set<std::string> variables;
  CollectVariables(formula.term, &variables);
  for (const Formula& part : formula.parts) variables.merge(FreeVariables(part));
  for (const std::string& name : formula.variables) variables.erase(name);
  return variables;
}

Formula ArrangeConjunction(const std::vector<Formula>& conjuncts,
                           const std::vector<Formula>& type_atoms, std::set<std::string> bound) {
  std::vector<Formula> parts;
  for (const Formula& conjunct : conjuncts) AppendConjuncts(conjunct, &parts);
  return Arrangement(parts, type_atoms, std::move(bound)).Run();
}

}  // namespace hires::planning::hddl
