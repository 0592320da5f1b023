#include "planning/check/known_names.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/error.h"
#include "hires/base/spelling.h"
#include "hires/planning/reference_prover.h"
#include "hires/planning/request.h"

namespace hires::planning {
namespace {

/// An atom that a condition asks for, and where.
struct Asked {
  std::string name;
  std::string by;
  Place place;
};

class Conditions {
 public:
  explicit Conditions(const Domain& domain) {
    for (const Operator& op : domain.operators) {
      const std::string by = fmt::format("operator '{}'", op.head.Head());
      Collect(op.precondition.condition, by);
      Collect(op.deletes, by);
      Collect(op.adds, by);
    }
    for (const Method& method : domain.methods) {
      for (const Branch& branch : method.branches) {
        Collect(branch.precondition.condition, fmt::format("method '{}'", method.head.Head()));
      }
    }
    for (const Axiom& axiom : domain.axioms) {
      for (const Axiom::Branch& branch : axiom.branches) {
        Collect(branch.condition, fmt::format("axiom '{}'", axiom.head.Head()));
      }
    }
  }

  const std::vector<Asked>& asked() const { return asked_; }
  /// A variable stands for a goal, so that anything may be asked for.
  bool is_open() const { return is_open_; }

 private:
  void Collect(const Formula& formula, const std::string& by) {
    is_open_ = is_open_ || formula.kind == Formula::Kind::kGoal;
    if (formula.kind == Formula::Kind::kAtom && !formula.term.Head().empty()) {
      asked_.push_back({std::string(formula.term.Head()), by, formula.place});
    }
    for (const Formula& part : formula.parts) Collect(part, by);
  }

  void Collect(const std::vector<Effect>& effects, const std::string& by) {
    for (const Effect& effect : effects) {
      Collect(effect.condition, by);
      Collect(effect.effects, by);
    }
  }

  std::vector<Asked> asked_;
  bool is_open_{false};
};

class Symbols {
 public:
  Symbols(const Domain& domain, const Problem& problem) {
    for (const auto* facts : {&domain.facts, &problem.facts}) {
      for (const Datum& fact : *facts) Collect(fact);
    }
    for (const Operator& op : domain.operators) {
      Collect(op.head);
      Collect(op.precondition.condition);
      Collect(op.deletes);
      Collect(op.adds);
    }
    for (const Method& method : domain.methods) {
      Collect(method.head);
      for (const Branch& branch : method.branches) {
        Collect(branch.precondition.condition);
        Collect(branch.subtasks);
      }
    }
    for (const Axiom& axiom : domain.axioms) {
      Collect(axiom.head);
      for (const Axiom::Branch& branch : axiom.branches) Collect(branch.condition);
    }
  }

  const std::set<std::string>& names() const { return names_; }

 private:
  void Collect(const Datum& datum) {
    if (datum.kind == Datum::Kind::kSymbol) names_.insert(datum.text);
    for (const Datum& item : datum.items) Collect(item);
    for (const Datum& item : datum.tail) Collect(item);
  }
  void Collect(const Formula& formula) {
    Collect(formula.term);
    Collect(formula.expression);
    for (const Formula& part : formula.parts) Collect(part);
  }
  void Collect(const std::vector<Effect>& effects) {
    for (const Effect& effect : effects) {
      Collect(effect.term);
      Collect(effect.condition);
      Collect(effect.effects);
    }
  }
  void Collect(const TaskNetwork& network) {
    for (const TaskItem& item : network.items) {
      Collect(item.task);
      for (const TaskNetwork& inner : item.network) Collect(inner);
    }
  }

  std::set<std::string> names_;
};

void CollectSymbols(const Datum& datum, std::vector<std::string>* names) {
  if (datum.kind == Datum::Kind::kSymbol && !datum.IsNil()) names->push_back(datum.text);
  for (const Datum& item : datum.items) CollectSymbols(item, names);
}

void CollectArguments(const TaskNetwork& network, std::vector<std::string>* names) {
  for (const TaskItem& item : network.items) {
    for (std::size_t i = 1; i < item.task.items.size(); ++i) {
      CollectSymbols(item.task.items[i], names);
    }
    for (const TaskNetwork& inner : item.network) CollectArguments(inner, names);
  }
}

/// Predicates that the domain has anything to do with.
std::set<std::string> PredicatesOf(const Domain& domain, const Conditions& conditions) {
  std::set<std::string> names = ChangingPredicates(domain).names;
  for (const Asked& asked : conditions.asked()) names.insert(asked.name);
  for (const Axiom& axiom : domain.axioms) names.emplace(axiom.head.Head());
  return names;
}

/// Facts of a file that the domain has nothing to do with, though it has with one spelt alike;
/// where nothing gives that one, the condition that asks for it is told of. What a program observes
/// may be anything.
void AddMisspeltFacts(const Domain& domain, const Problem& problem, const Conditions& conditions,
                      const PredicateSet& given, std::vector<std::string>* warnings) {
  constexpr int kMostCompared = 100;  // comparing takes time with the number of names
  if (conditions.is_open() || problem.name.empty()) return;
  const std::set<std::string> names = PredicatesOf(domain, conditions);
  std::set<std::string> seen = names;
  int compared = 0;
  for (const Datum& fact : problem.facts) {
    const std::string name(fact.Head());
    if (fact.place.line == 0 || !seen.insert(name).second) continue;
    if (++compared > kMostCompared) return;
    const auto meant = std::find_if(names.begin(), names.end(), [&](const std::string& other) {
      return given.MayHave(other) && base::AreSpeltAlike(name, other);
    });
    if (meant == names.end()) continue;
    warnings->push_back(fmt::format(
        "{}problem '{}': no operator, method or axiom has anything to do with ({} ...); did you "
        "mean '{}'?",
        At(problem.source, fact.place), problem.name, name, *meant));
  }
}

}  // namespace

std::set<std::string> SymbolsOf(const Domain& domain, const Problem& problem) {
  return Symbols(domain, problem).names();
}

std::vector<std::string> ArgumentSymbols(const TaskNetwork& tasks) {
  std::vector<std::string> all, once;
  CollectArguments(tasks, &all);
  std::set<std::string> seen;
  for (const std::string& name : all) {
    if (seen.insert(name).second) once.push_back(name);
  }
  return once;
}

std::vector<std::string> UnknownSymbols(const std::vector<Datum>& tasks, const Domain& domain,
                                        const Problem& problem) {
  const Symbols known(domain, problem);
  std::vector<std::string> asked, unknown;
  for (const Datum& task : tasks) CollectSymbols(task, &asked);
  std::set<std::string> seen;
  for (const std::string& name : asked) {
    if (known.names().count(name) > 0 || !seen.insert(name).second) continue;
    const auto meant =
        std::find_if(known.names().begin(), known.names().end(),
                     [&](const std::string& other) { return base::AreSpeltAlike(name, other); });
    unknown.push_back(meant == known.names().end()
                          ? fmt::format("'{}'", name)
                          : fmt::format("'{}' (did you mean '{}'?)", name, *meant));
  }
  return unknown;
}

PredicateSet PredicatesGiven(const Domain& domain, const Problem& problem) {
  PredicateSet given;
  for (const auto* facts : {&domain.facts, &problem.facts}) {
    for (const Datum& fact : *facts) given.names.emplace(fact.Head());
  }
  for (const Axiom& axiom : domain.axioms) given.names.emplace(axiom.head.Head());
  for (const Operator& op : domain.operators) CollectPredicates(op.adds, &given);
  return given;
}

std::vector<std::string> MisspeltPredicates(const Domain& domain, const Problem& problem) {
  std::vector<std::string> warnings;
  if (domain.language == Domain::Language::kHddl) return warnings;
  const Conditions conditions(domain);
  const PredicateSet given = PredicatesGiven(domain, problem);
  AddMisspeltFacts(domain, problem, conditions, given, &warnings);
  if (given.is_open) return warnings;
  std::set<std::string> seen = given.names;
  for (const Asked& asked : conditions.asked()) {
    if (!seen.insert(asked.name).second) continue;
    const auto meant = std::find_if(
        given.names.begin(), given.names.end(),
        [&](const std::string& name) { return base::AreSpeltAlike(asked.name, name); });
    if (meant == given.names.end()) continue;
    warnings.push_back(
        fmt::format("{}{}: no fact, axiom or effect gives any ({} ...); did you mean '{}'?",
                    At(domain.source, asked.place), asked.by, asked.name, *meant));
  }
  return warnings;
}

}  // namespace hires::planning
