#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hires/planning/datum.h"

namespace hires::planning {

/// A logical expression over a state, in SHOP2's terms; HDDL's translate into the same.
struct Formula {
  enum class Kind {
    kSequence,  ///< a plain list of goals: each in its order, bindings in the list's order
    kAnd,       ///< the word `and`: as a sequence, but SHOP tries its bindings the other way round
    kOr,        ///< parts
    kNot,       ///< parts[0]
    kImply,     ///< parts[0] (ground when reached) implies parts[1]
    kForall,    ///< for all `variables` that satisfy parts[0], parts[1] holds
    kExists,    ///< for some `variables` that satisfy parts[0], parts[1] holds
    kAtom,      ///< `term`: (predicate arguments...), by facts and axioms
    kGoal,      ///< `term`: a variable that stands for an atom when it is reached
    kEqual,     ///< HDDL's built-in (= a b): `term` is that list. SHOP2's `=` is a plain atom
    kAssign,    ///< variable `term` becomes the value of `expression`
    kAssignEach,  ///< variable `term` becomes each member of the value of `expression` (assign*)
    kEval,        ///< the value of `expression` is not nil (eval, call)
    kSetOf,       ///< variable `expression` becomes the list of all `term` with parts[0], once each
    kBagOf,       ///< the same with repetitions
  };

  Kind kind{Kind::kSequence};
  std::vector<Formula> parts;
  std::vector<std::string> variables;  ///< of kForall and kExists, with their `?`
  Datum term;
  Datum expression;
  Place place;
};

/// A condition and the order in which its bindings are tried.
struct Precondition {
  enum class Order {
    kAll,     ///< every binding, oldest fact first
    kFirst,   ///< one binding, newest fact first (:first)
    kSortBy,  ///< every binding, ordered by `sort_key` under `comparison` (:sort-by)
  };
  Order order{Order::kAll};
  Datum sort_key;               ///< expression
  std::string comparison{"<"};  ///< name of a function of two values
  Formula condition;
};

/// A change of the state, or of the protections.
struct Effect {
  enum class Kind {
    kAtom,        ///< `term` is an atom
    kList,        ///< `term` is a variable bound to a list of atoms, or to one atom
    kProtection,  ///< `term` is an atom: protected from now on, or (as a delete) no more
    kForall,      ///< `effects` for each binding of `condition` before the step (forall, when)
  };
  Kind kind{Kind::kAtom};
  Datum term;
  Formula condition;
  std::vector<Effect> effects;
  Place place;
};

struct Operator {
  Datum head;  ///< (!name arguments...); arguments are variables, constants or lists of them
  Precondition precondition;  ///< one binding is used: the newest fact first
  std::vector<Effect> deletes;
  std::vector<Effect> adds;
  Datum cost;  ///< expression; 1 where nothing is said
  Place place;
};

struct TaskNetwork;

/// A task or a network within a network.
struct TaskItem {
  Datum task;                        ///< (name arguments...), when `network` is empty
  bool immediate{false};             ///< goes before every task that is not
  std::vector<TaskNetwork> network;  ///< none or one
  Place place;
};

/// Tasks and the order between them. `(:ordered a b c)` has the order {(0, 1), (1, 2)},
/// `(:unordered a b c)` has none; HDDL may order its tasks in any way that has no cycle.
struct TaskNetwork {
  std::vector<TaskItem> items;
  std::vector<std::pair<int, int>> order;  ///< (before, after), indices of items
};

/// One `if` of a method's if-then-else.
struct Branch {
  std::string label;  ///< "" where the domain gives none
  Precondition precondition;
  TaskNetwork subtasks;
  Place place;
  /// The precondition, and what the step needs that comes before all other subtasks, where one does
  /// (HDDL): a search in which nothing can come in between leaves out what fails one step later.
  std::optional<Precondition> with_first_step{};
};

struct Method {
  std::string name;  ///< HDDL's, or SHOP3's; "" where the domain gives none
  Datum head;        ///< (task arguments...)
  std::vector<Branch> branches;
  Place place;
};

/// `head` holds where a branch does; the first branch that can be proven is the only one used.
struct Axiom {
  struct Branch {
    std::string label;
    bool first{false};  ///< `:first`: one proof, newest fact first
    Formula condition;
  };
  Datum head;
  std::vector<Branch> branches;
  Place place;
};

struct HddlVocabulary;

/// What orders the steps of a plan beside their causal links.
enum class SubtaskOrder {
  kKept,         ///< the order that methods and problem give to their tasks
  kCausalLinks,  ///< nothing: steps that do not touch each other may run side by side
};

/// What can be done, as a file describes it. Constant once read.
struct Domain {
  enum class Language { kShop2, kHddl };

  std::string name;
  std::string source;  ///< file, for messages
  Language language{Language::kShop2};
  /// Always kept in HDDL; in SHOP2 as the sidecar beside the file says (LoadDomain).
  SubtaskOrder subtask_order{SubtaskOrder::kKept};
  std::vector<Operator> operators;
  std::vector<Method> methods;  ///< in the order in which they are tried
  std::vector<Axiom> axioms;
  /// Tasks that methods name and nothing handles, with what is wrong and where: no harm until one
  /// is reached. HDDL has none, its tasks are declared.
  std::map<std::string, std::string> unknown_tasks;
  /// What can hardly be meant, though it may be read, with file and line.
  std::vector<std::string> warnings;
  std::vector<Datum> facts;  ///< hold in every state: HDDL's constants with their types
  /// What an HDDL domain declares (types, predicates, tasks), for the reader of its problems; else
  /// null.
  std::shared_ptr<const HddlVocabulary> vocabulary;
};

/// What is to be done, and from where.
struct Problem {
  std::string name;
  std::string domain;  ///< name of the domain it is written for, "" where it says none
  Place domain_place;
  std::string source;
  std::vector<Datum> facts;  ///< ground atoms, oldest first; repeated ones count once
  Precondition parameters;   ///< binds variables of `tasks` (HDDL's :htn :parameters); else empty
  TaskNetwork tasks;
  std::optional<Formula> goal;     ///< must hold in the end (HDDL's :goal)
  std::vector<Datum> protections;  ///< atoms protected from the beginning, as often as listed here
  std::vector<std::string> warnings;  ///< as Domain's
  /// Why it cannot be planned for, though others of its file can, with file and line; else "".
  std::string fault;
};

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
