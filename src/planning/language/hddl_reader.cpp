#include "planning/language/hddl_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/check.h"
#include "hires/base/faults.h"
#include "hires/base/text.h"
#include "hires/planning/datum_reader.h"
#include "hires/planning/domain.h"
#include "planning/language/hddl_effect.h"
#include "planning/language/hddl_formula.h"
#include "planning/language/hddl_network.h"
#include "planning/language/hddl_syntax.h"
#include "planning/language/hddl_vocabulary.h"

namespace hires::planning {
namespace hddl {
namespace {

using Sections = std::map<std::string, std::vector<const Datum*>>;

bool IsPddlOnly(const std::string& keyword) {
  static const std::set<std::string> keywords{":durative-action", ":derived", ":axiom", ":process",
                                              ":event"};
  return keywords.count(keyword) > 0;
}

/// The sections of a definition by their keyword.
/// @param several  Keywords that may stand more than once.
Sections ReadSections(const HddlSpot& spot, const Datum& form,
                      const std::vector<std::string>& known, const std::set<std::string>& several) {
  Sections sections;
  for (std::size_t i = 2; i < form.items.size(); ++i) {
    const Datum& section = RequireList(spot, form.items[i], "a section such as (:types ...)");
    const std::string keyword(section.Head());
    if (keyword.empty() || keyword[0] != ':') {
      spot.Fail(section, fmt::format("{} came, wanted a section such as ({} ...)", Excerpt(section),
                                     known[0]));
    }
    if (IsPddlOnly(keyword)) {
      spot.Fail(section, fmt::format("({} ...) of PDDL is not supported; do without it", keyword));
    }
    if (std::find(known.begin(), known.end(), keyword) == known.end()) {
      spot.Fail(section, base::UnknownName("section", keyword, known));
    }
    std::vector<const Datum*>& found = sections[keyword];
    if (!found.empty() && several.count(keyword) == 0) {
      spot.Fail(section, fmt::format("({} ...) stands twice, first in line {}; keep one", keyword,
                                     found[0]->place.line));
    }
    found.push_back(&section);
  }
  return sections;
}

const Datum* OneOf(const Sections& sections, const std::string& keyword) {
  const auto found = sections.find(keyword);
  return found == sections.end() ? nullptr : found->second[0];
}

std::vector<const Datum*> AllOf(const Sections& sections, const std::string& keyword) {
  const auto found = sections.find(keyword);
  return found == sections.end() ? std::vector<const Datum*>{} : found->second;
}

/// A list of parameters: variables, their types, and the atoms that check these.
struct Parameters {
  std::vector<Datum> variables;
  std::vector<Formula> type_atoms;
};

Parameters ReadParameters(const HddlFields& fields, HddlScope* scope) {
  Parameters parameters;
  const Datum* list = fields.Find(":parameters");
  if (list == nullptr) return parameters;
  RequireList(scope->spot, *list, "parameters such as (?a ?b - place)");
  for (const HddlTyped& typed : ReadTypedList(scope->spot, *list, 0, Datum::Kind::kVariable)) {
    const int type = TypeOf(scope->spot, typed, scope->vocabulary);
    scope->variables[typed.datum->text] = type;
    parameters.variables.push_back(*typed.datum);
    parameters.type_atoms.push_back(TypeAtom(*scope->vocabulary, typed.datum->text, type));
  }
  return parameters;
}

std::vector<Datum> CallOf(const std::string& name, const std::vector<Datum>& arguments) {
  std::vector<Datum> items{MakeSymbol(name)};
  items.insert(items.end(), arguments.begin(), arguments.end());
  return items;
}

// ------------------------------------------------------------------------------------------ domain

const std::vector<std::string>& DomainSections() {
  static const std::vector<std::string> known{":requirements", ":types",     ":constants",
                                              ":predicates",   ":functions", ":task",
                                              ":method",       ":action"};
  return known;
}

class DomainReader {
 public:
  DomainReader(std::string_view text, const std::string& source)
      : definition_(ReadDefinition(text, source, "domain")),
        spot_{source, fmt::format("domain '{}'", definition_.name)} {
    domain_.name = definition_.name;
    domain_.source = source;
    domain_.language = Domain::Language::kHddl;
  }

  Domain Read() {
    const Sections sections =
        ReadSections(spot_, definition_.form, DomainSections(), {":task", ":method", ":action"});
    ReadDeclarations(sections);
    base::Faults faults;
    for (const Datum* form : AllOf(sections, ":action")) {
      faults.Collect([&] { ReadAction(*form); });
    }
    CollectNeeds();
    for (const Datum* form : AllOf(sections, ":method")) {
      faults.Collect([&] { ReadMethod(*form); });
    }
    faults.Require();
    AddMissingMethods();
    domain_.facts = TypeFacts(spot_.Within("(:constants ...)"), vocabulary_, nullptr);
    domain_.vocabulary = std::make_shared<HddlVocabulary>(std::move(vocabulary_));
    return std::move(domain_);
  }

 private:
  void ReadDeclarations(const Sections& sections) {
    if (const Datum* section = OneOf(sections, ":requirements")) {
      CheckRequirements(spot_.Within("(:requirements ...)"), *section, &domain_.warnings);
    }
    ReadTypeSection(spot_.Within("(:types ...)"), OneOf(sections, ":types"), &vocabulary_);
    if (const Datum* section = OneOf(sections, ":constants")) {
      ReadObjects(spot_.Within("(:constants ...)"), *section, &vocabulary_);
    }
    if (const Datum* section = OneOf(sections, ":predicates")) {
      ReadPredicates(spot_.Within("(:predicates ...)"), *section, &vocabulary_);
    }
    if (const Datum* section = OneOf(sections, ":functions")) {
      ReadFunctions(spot_.Within("(:functions ...)"), *section, &vocabulary_);
    }
    for (const Datum* form : AllOf(sections, ":task")) DeclareTask(*form, "task");
    for (const Datum* form : AllOf(sections, ":action")) DeclareTask(*form, "action");
  }

  /// "method 'm_go'", once its name is known to be there.
  HddlSpot SpotOf(const Datum& form, const std::string& kind) const {
    if (form.items.size() < 2) {
      spot_.Fail(form, fmt::format("{} has no name; write (:{} name ...)", Excerpt(form), kind));
    }
    const std::string& name =
        RequireName(spot_, form.items[1],
                    fmt::format("the name of {}", kind == "action" ? "an action" : "a " + kind));
    return spot_.Within(fmt::format("{} '{}'", kind, name));
  }

  void DeclareTask(const Datum& form, const std::string& kind) {
    const HddlSpot spot = SpotOf(form, kind);
    // Preconditions and effects of tasks are annotations that say nothing about plans.
    const HddlFields fields(spot, form, 2, {":parameters", ":precondition", ":effect"});
    const Datum none;
    const Datum* list = fields.Find(":parameters");
    if (list != nullptr) RequireList(spot, *list, "parameters such as (?a ?b - place)");
    HddlVocabulary::Signature signature = ReadSignature(
        spot, kind, form.items[1].text, list == nullptr ? none : *list, 0, &vocabulary_);
    const auto [entry, is_new] = vocabulary_.tasks.emplace(signature.name, signature);
    if (!is_new) {
      spot.Fail(form,
                fmt::format("there is {} '{}' already; rename one of them",
                            entry->second.kind == "task" ? "a task" : "an action", signature.name));
    }
  }

  void ReadAction(const Datum& form) {
    HddlScope scope{SpotOf(form, "action"), &vocabulary_, {}, 0};
    const HddlFields fields(scope.spot, form, 2, {":parameters", ":precondition", ":effect"});
    const Parameters parameters = ReadParameters(fields, &scope);
    Operator op;
    op.place = form.place;
    op.head = MakeList(CallOf("!" + form.items[1].text, parameters.variables));
    std::set<std::string> bound;
    for (const Datum& variable : parameters.variables) bound.insert(variable.text);
    std::vector<Formula> conditions;
    if (const Datum* condition = fields.Find(":precondition")) {
      conditions.push_back(ReadCondition(*condition, &scope));
    }
    op.precondition.condition = ArrangeConjunction(conditions, parameters.type_atoms, bound);
    if (const Datum* effect = fields.Find(":effect")) TakeEffects(*effect, &scope, &op);
    if (op.cost.IsNil()) op.cost = CostOf({}, vocabulary_);
    domain_.operators.push_back(std::move(op));
  }

  void TakeEffects(const Datum& effect, HddlScope* scope, Operator* op) {
    HddlEffects effects = ReadEffects(effect, scope);
    op->cost = CostOf(effects, vocabulary_);
    op->deletes = std::move(effects.deletes);
    op->adds = std::move(effects.adds);
    std::vector<Formula>& goals = op->precondition.condition.parts;
    goals.insert(goals.end(), effects.value_atoms.begin(), effects.value_atoms.end());
  }

  void CollectNeeds() {
    const PredicateSet changed = ChangingPredicates(domain_);
    for (const Operator& op : domain_.operators) {
      HddlVocabulary::Needs needs;
      for (std::size_t i = 1; i < op.head.items.size(); ++i) {
        needs.parameters.push_back(op.head.items[i].text);
      }
      for (const Formula& goal : op.precondition.condition.parts) {
        const std::string predicate(goal.term.Head());
        if (goal.kind != Formula::Kind::kAtom || vocabulary_.predicates.count(predicate) == 0)
          continue;
        (changed.MayHave(predicate) ? needs.changing : needs.fixed).push_back(goal.term);
      }
      vocabulary_.needs[op.head.items[0].text] = std::move(needs);
    }
  }

  void ReadMethod(const Datum& form) {
    HddlScope scope{SpotOf(form, "method"), &vocabulary_, {}, 0};
    std::vector<std::string> known = NetworkFields();
    known.insert(known.begin(), {":parameters", ":task", ":precondition"});
    const HddlFields fields(scope.spot, form, 2, known);
    const Parameters parameters = ReadParameters(fields, &scope);
    Method method;
    method.name = form.items[1].text;
    method.place = form.place;
    if (!method_names_.insert(method.name).second) {
      scope.spot.Fail(form, "there is a method of that name already; rename one, plans name them");
    }
    method.head = ReadHead(fields, scope);
    HddlNetwork network = ReadNetwork(fields, &scope);
    Branch branch;
    branch.place = form.place;
    const std::set<std::string> bound = FreeVariables(MakeAtom(method.head));
    std::vector<Formula> conditions = ReadConditions(fields, network, &scope);
    branch.precondition.condition = ArrangeConjunction(conditions, parameters.type_atoms, bound);
    if (!network.needs_of_first.empty()) {
      AddUnlessKnown(network.needs_of_first, &conditions);
      branch.with_first_step = branch.precondition;
      branch.with_first_step->condition =
          ArrangeConjunction(conditions, parameters.type_atoms, bound);
    }
    branch.subtasks = std::move(network.network);
    method.branches.push_back(std::move(branch));
    domain_.methods.push_back(std::move(method));
  }

  const Datum& ReadHead(const HddlFields& fields, const HddlScope& scope) {
    const Datum& head = fields.Require(":task");
    const HddlVocabulary::Signature& signature =
        CheckTerm(scope.spot, head, "task", vocabulary_.tasks, scope.variables, &vocabulary_);
    if (signature.kind == "action") {
      scope.spot.Fail(head,
                      fmt::format("'{}' is an action; a method decomposes a task", signature.name));
    }
    return head;
  }

  /// What is written first, then what actions need, unless it is written as well.
  static std::vector<Formula> ReadConditions(const HddlFields& fields, const HddlNetwork& network,
                                             HddlScope* scope) {
    std::vector<Formula> conditions;
    if (const Datum* condition = fields.Find(":precondition")) {
      AppendConjuncts(ReadCondition(*condition, scope), &conditions);
    }
    AddUnlessKnown(network.conditions, &conditions);
    return conditions;
  }

  static void AddUnlessKnown(const std::vector<Formula>& extras, std::vector<Formula>* conditions) {
    for (const Formula& extra : extras) {
      const bool known =
          std::any_of(conditions->begin(), conditions->end(), [&extra](const Formula& condition) {
            return extra.kind == Formula::Kind::kAtom && condition.kind == extra.kind &&
                   condition.term == extra.term;
          });
      if (!known) conditions->push_back(extra);
    }
  }

  /// A task without a method can never be done. The search has to know that it is a task.
  void AddMissingMethods() {
    std::set<std::string> decomposed;
    for (const Method& method : domain_.methods) decomposed.insert(std::string(method.head.Head()));
    for (const auto& [name, signature] : vocabulary_.tasks) {
      if (signature.kind != "task" || decomposed.count(name) > 0) continue;
      std::vector<Datum> arguments;
      for (std::size_t i = 1; i <= signature.types.size(); ++i) {
        arguments.push_back(MakeVariable(fmt::format("?{}", i)));
      }
      Method method;
      method.name = "%no-method-" + name;
      method.head = MakeList(CallOf(name, arguments));
      method.branches.resize(1);
      method.branches[0].precondition.condition.kind = Formula::Kind::kOr;  // of nothing: false
      domain_.methods.push_back(std::move(method));
    }
  }

  HddlDefinition definition_;
  HddlSpot spot_;
  HddlVocabulary vocabulary_;
  std::set<std::string> method_names_;
  Domain domain_;
};

// ----------------------------------------------------------------------------------------- problem

const std::vector<std::string>& ProblemSections() {
  static const std::vector<std::string> known{":domain", ":requirements", ":objects",
                                              ":htn",    ":htn-ti",       ":htn-tihtn",
                                              ":init",   ":goal",         ":metric"};
  return known;
}

class ProblemReader {
 public:
  ProblemReader(std::string_view text, const std::string& source, const Domain& domain)
      : definition_(ReadDefinition(text, source, "problem")),
        spot_{source, fmt::format("problem '{}'", definition_.name)},
        domain_(domain),
        vocabulary_(*domain.vocabulary) {
    problem_.name = definition_.name;
    problem_.source = source;
  }

  Problem Read() {
    const Sections sections = ReadSections(spot_, definition_.form, ProblemSections(), {});
    ReadDomainName(sections);
    if (const Datum* section = OneOf(sections, ":requirements")) {
      CheckRequirements(spot_.Within("(:requirements ...)"), *section, &problem_.warnings);
    }
    if (const Datum* section = OneOf(sections, ":objects")) {
      ReadObjects(spot_.Within("(:objects ...)"), *section, &vocabulary_);
    }
    vocabulary_.has_all_objects = true;
    base::Faults faults;
    faults.Collect([&] { CheckOpenObjects(spot_, domain_.source, vocabulary_); });
    faults.Collect([&] { ReadTasks(sections); });
    if (const Datum* section = OneOf(sections, ":goal")) {
      faults.Collect([&] { ReadGoal(*section); });
    }
    if (const Datum* section = OneOf(sections, ":metric")) {
      faults.Collect([&] { CheckMetric(*section); });
    }
    // After the conditions, which may have made types of their own by (either ...).
    problem_.facts =
        TypeFacts(spot_.Within("(:objects ...)"), vocabulary_, domain_.vocabulary.get());
    if (const Datum* section = OneOf(sections, ":init")) ReadInit(*section, &faults);
    faults.Require();
    return std::move(problem_);
  }

 private:
  void ReadDomainName(const Sections& sections) {
    const Datum* section = OneOf(sections, ":domain");
    if (section == nullptr) {
      spot_.Fail(definition_.form,
                 fmt::format("(:domain ...) is missing; add (:domain {})", domain_.name));
    }
    if (section->items.size() != 2) {
      spot_.Fail(*section,
                 fmt::format("{} came, wanted (:domain {})", Excerpt(*section), domain_.name));
    }
    problem_.domain = RequireName(spot_, section->items[1], "the name of a domain");
    problem_.domain_place = section->place;
  }

  const Datum& HtnSection(const Sections& sections) const {
    const Datum* found = nullptr;
    for (const char* keyword : {":htn", ":htn-ti", ":htn-tihtn"}) {
      const Datum* section = OneOf(sections, keyword);
      if (section == nullptr) continue;
      if (found != nullptr) spot_.Fail(*section, "two (:htn ...) sections stand here; keep one");
      found = section;
    }
    if (found == nullptr) {
      spot_.Fail(definition_.form,
                 fmt::format("(:htn ...) is missing; say which tasks are to be done, as in "
                             "(:htn :ordered-subtasks (and (task a b))){}",
                             domain_.methods.empty()
                                 ? ". The domain has no method either: this is PDDL, whose goals "
                                   "a planner without tasks reaches; here tasks are decomposed"
                                 : ""));
    }
    return *found;
  }

  void ReadTasks(const Sections& sections) {
    const Datum& section = HtnSection(sections);
    HddlScope scope{spot_.Within(fmt::format("({} ...)", section.Head())), &vocabulary_, {}, 0};
    std::vector<std::string> known = NetworkFields();
    known.insert(known.begin(), ":parameters");
    const HddlFields fields(scope.spot, section, 1, known);
    const Parameters parameters = ReadParameters(fields, &scope);
    HddlNetwork network = ReadNetwork(fields, &scope);
    problem_.parameters.condition =
        ArrangeConjunction(network.conditions, parameters.type_atoms, {});
    problem_.tasks = std::move(network.network);
  }

  void ReadGoal(const Datum& section) {
    HddlScope scope{spot_.Within("(:goal ...)"), &vocabulary_, {}, 0};
    if (section.items.size() != 2) {
      scope.spot.Fail(section, fmt::format("{} came, wanted (:goal condition)", Excerpt(section)));
    }
    Formula goal = ArrangeConjunction({ReadCondition(section.items[1], &scope)}, {}, {});
    if (!goal.parts.empty()) problem_.goal = std::move(goal);
  }

  /// The search minimises the cost of plans when it is asked to; nothing else can be said here.
  void CheckMetric(const Datum& section) const {
    const bool minimizes = section.items.size() == 3 && section.items[1].IsSymbol("minimize");
    const bool is_cost = minimizes && (section.items[2].IsSymbol("total-cost") ||
                                       section.items[2].Head() == "total-cost");
    if (is_cost) return;
    spot_.Fail(section,
               fmt::format("{} came, wanted (:metric minimize (total-cost))", Excerpt(section)));
  }

  void ReadInit(const Datum& section, base::Faults* faults) {
    const HddlSpot spot = spot_.Within("(:init ...)");
    for (std::size_t i = 1; i < section.items.size(); ++i) {
      faults->Collect([&] { ReadInitial(spot, section.items[i]); });
    }
    faults->Collect([&] { CheckDenied(spot); });
  }

  void ReadInitial(const HddlSpot& spot, const Datum& datum) {
    const Datum& fact = RequireList(spot, datum, "a fact such as (at robot dock)");
    if (fact.Head() == "=") {
      ReadValue(spot, fact);
    } else if (fact.Head() == "not" && fact.items.size() == 2) {
      ReadDenied(spot, fact.items[1]);
    } else {
      CheckFact(spot, fact);
      problem_.facts.push_back(fact);
    }
  }

  void CheckDenied(const HddlSpot& spot) const {
    if (denied_.empty()) return;
    std::set<std::string> facts;
    for (const Datum& fact : problem_.facts) facts.insert(ToString(fact));
    for (const Datum& denied : denied_) {
      if (facts.count(ToString(denied)) == 0) continue;
      spot.Fail(denied, fmt::format("{} holds and does not hold; keep one", Excerpt(denied)));
    }
  }

  void CheckFact(const HddlSpot& spot, const Datum& fact) {
    CheckTerm(spot, fact, "predicate", vocabulary_.predicates, {}, &vocabulary_);
  }

  /// What is not said does not hold anyway.
  void ReadDenied(const HddlSpot& spot, const Datum& atom) {
    CheckFact(spot, atom);
    denied_.push_back(atom);
  }

  /// (= (function object ...) number)
  void ReadValue(const HddlSpot& spot, const Datum& fact) {
    if (fact.items.size() != 3 || !fact.items[1].IsList()) {
      spot.Fail(fact, fmt::format("{} came, wanted (= (function ...) number)", Excerpt(fact)));
    }
    const Datum& term = fact.items[1];
    const Datum& value = RequireAmount(spot, fact.items[2]);
    if (term.Head() == "total-cost") {
      if (value != MakeInteger(0)) spot.Fail(fact, "plans begin with a (total-cost) of 0");
      return;
    }
    CheckTerm(spot, term, "function", vocabulary_.functions, {}, &vocabulary_);
    if (!values_.emplace(ToString(term), value).second) {
      spot.Fail(fact, fmt::format("{} has a value already; keep one", Excerpt(term)));
    }
    Datum atom = term;
    atom.items[0] = MakeSymbol(ValuePredicate(std::string(term.Head())));
    atom.items.push_back(value);
    problem_.facts.push_back(std::move(atom));
  }

  HddlDefinition definition_;
  HddlSpot spot_;
  const Domain& domain_;
  HddlVocabulary vocabulary_;
  std::map<std::string, Datum> values_;
  std::vector<Datum> denied_;
  Problem problem_;
};

}  // namespace
}  // namespace hddl

Domain ReadHddlDomain(std::string_view text, const std::string& source) {
  return hddl::DomainReader(text, source).Read();
}

Problem ReadHddlProblem(std::string_view text, const std::string& source, const Domain& domain) {
  HIRES_CHECK(domain.vocabulary != nullptr, "an HDDL problem needs the HDDL domain it belongs to");
  return hddl::ProblemReader(text, source, domain).Read();
}

}  // namespace hires::planning
