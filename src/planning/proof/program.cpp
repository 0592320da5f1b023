#include "planning/proof/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/planning/datum_reader.h"
#include "hires/planning/shop2_reader.h"

namespace hires::planning {
namespace {

std::string Where(const std::string& source, const Place& place) {
  return place.line == 0 ? source : fmt::format("{}:{}:{}", source, place.line, place.column);
}

/// The value at `index`, which is made where it is missing.
template <typename Values>
typename Values::value_type& EnsureAt(Values* values, std::size_t index) {
  if (index >= values->size()) values->resize(index + 1);
  return (*values)[index];
}

bool IsCall(const Datum& datum) { return datum.IsList() && datum.Head() == "call"; }

void CollectOuterVariables(const Datum& datum, std::vector<std::string>* names) {
  if (datum.kind == Datum::Kind::kVariable) names->push_back(datum.text);
  for (const Datum& item : datum.items) CollectOuterVariables(item, names);
  for (const Datum& item : datum.tail) CollectOuterVariables(item, names);
}

/// Variables of a formula that are seen from outside of it.
void CollectOuterVariables(const Formula& formula, std::vector<std::string>* names) {
  switch (formula.kind) {
    case Formula::Kind::kNot:
    case Formula::Kind::kForall:
    case Formula::Kind::kExists:
      return;  // bind nothing
    case Formula::Kind::kSetOf:
    case Formula::Kind::kBagOf:
      CollectOuterVariables(formula.expression, names);
      return;
    case Formula::Kind::kEval:
      return;
    default:
      break;
  }
  CollectOuterVariables(formula.term, names);
  for (const Formula& part : formula.parts) CollectOuterVariables(part, names);
}

}  // namespace

bool IsEmpty(const TaskItem& item) {
  return !item.network.empty() &&
         std::all_of(item.network.front().items.begin(), item.network.front().items.end(), IsEmpty);
}

/// The same network without the items that hold no task; what they stood between stays in order.
TaskNetwork WithoutEmptyItems(TaskNetwork network) {
  for (int gone = static_cast<int>(network.items.size()); gone-- > 0;) {
    if (!IsEmpty(network.items[gone])) continue;
    network.items.erase(network.items.begin() + gone);
    std::vector<std::pair<int, int>> order;
    const auto moved = [gone](int item) { return item > gone ? item - 1 : item; };
    for (const auto& [before, after] : network.order) {
      if (before != gone && after != gone) order.emplace_back(moved(before), moved(after));
      if (after != gone) continue;
      for (const auto& [middle, last] : network.order) {
        if (middle == gone) order.emplace_back(moved(before), moved(last));
      }
    }
    std::sort(order.begin(), order.end());
    order.erase(std::unique(order.begin(), order.end()), order.end());
    network.order = std::move(order);
  }
  return network;
}

/// Numbers of the variables of one clause. Quantified variables hide those outside of the same
/// name.
class Scope {
 public:
  std::uint32_t SlotOf(const std::string& name) {
    for (std::size_t i = visible_.size(); i-- > 0;) {
      if (visible_[i].first == name) return visible_[i].second;
    }
    return Declare(name);
  }
  std::uint32_t Declare(const std::string& name) {
    const auto slot = static_cast<std::uint32_t>(names_.size());
    names_.push_back(name);
    visible_.emplace_back(name, slot);
    return slot;
  }
  std::size_t Open(const std::vector<std::string>& variables) {
    const std::size_t mark = visible_.size();
    for (const std::string& name : variables) Declare(name);
    return mark;
  }
  /// Forgets the quantified variables; others that came up inside stay visible, as in SHOP.
  void Close(std::size_t mark, std::size_t count) {
    visible_.erase(visible_.begin() + static_cast<std::ptrdiff_t>(mark),
                   visible_.begin() + static_cast<std::ptrdiff_t>(mark + count));
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;
  std::vector<std::pair<std::string, std::uint32_t>> visible_;
};

class Compiler {
 public:
  Compiler(Program* program, const Functions& functions, TermTable* terms)
      : program_(*program),
        functions_(functions),
        terms_(*terms),
        changing_(ChangingPredicates(program->domain_)) {}

  void Run() {
    source_ = program_.domain_.source;
    for (const auto& [task, text] : program_.domain_.unknown_tasks) {
      program_.warnings_.push_back(text);
    }
    for (const Operator& source : program_.domain_.operators) AddOperator(source);
    for (std::size_t i = 0; i < program_.domain_.methods.size(); ++i) AddMethod(i);
    for (const Axiom& source : program_.domain_.axioms) AddAxiom(source);
    source_ = program_.problem_.source;
    AddFacts(program_.domain_.facts);
    AddFacts(program_.problem_.facts);
    AddRoot();
  }

 private:
  // --- terms ---------------------------------------------------------------------------------

  const Pattern* Keep(Pattern pattern) {
    program_.patterns_.push_back(pattern);
    return &program_.patterns_.back();
  }

  const Pattern* Constant(Term term) {
    Pattern pattern;
    pattern.constant = term;
    return Keep(pattern);
  }

  const Pattern* Compile(const Datum& datum, Scope* scope) {
    if (datum.kind == Datum::Kind::kVariable) {
      Pattern pattern;
      pattern.kind = Pattern::Kind::kSlot;
      pattern.slot = scope->SlotOf(datum.text);
      return Keep(pattern);
    }
    if (!datum.IsList()) return Constant(terms_.FromDatum(datum));
    if (IsCall(datum)) return CompileCall(datum, scope);
    const Pattern* list = datum.tail.empty() ? Constant(Term()) : Compile(datum.tail[0], scope);
    for (std::size_t i = datum.items.size(); i-- > 0;) {
      list = MakePair(Compile(datum.items[i], scope), list);
    }
    return list;
  }

  const Pattern* MakePair(const Pattern* head, const Pattern* tail) {
    if (head->kind == Pattern::Kind::kConstant && tail->kind == Pattern::Kind::kConstant) {
      return Constant(terms_.Pair(head->constant, tail->constant));
    }
    Pattern pattern;
    pattern.kind = Pattern::Kind::kPair;
    pattern.head = head;
    pattern.tail = tail;
    return Keep(pattern);
  }

  const Pattern* CompileCall(const Datum& datum, Scope* scope) {
    Pattern pattern;
    pattern.kind = Pattern::Kind::kCall;
    Datum expression = datum;
    expression.items.erase(expression.items.begin());
    pattern.call = CompileExpression(expression, scope);
    return Keep(pattern);
  }

  const Expression* CompileExpression(const Datum& datum, Scope* scope) {
    const auto slot_of = [scope](const std::string& name) {
      return static_cast<int>(scope->SlotOf(name));
    };
    program_.expressions_.emplace_back(datum, slot_of, functions_, &terms_, source_,
                                       &program_.warnings_);
    return &program_.expressions_.back();
  }

  // --- conditions ----------------------------------------------------------------------------

  Goal* MakeGoal(Goal::Kind kind, const Formula& source) {
    program_.goals_.emplace_back();
    Goal* goal = &program_.goals_.back();
    goal->kind = kind;
    goal->source = &source;
    return goal;
  }

  /// A chain of goals; null where there is nothing to prove.
  const Goal* Compile(const Formula& formula, Scope* scope) {
    if (formula.kind != Formula::Kind::kSequence) return CompileOne(formula, scope);
    std::vector<Goal*> goals;
    Append(formula, scope, &goals);
    for (std::size_t i = 0; i < goals.size(); ++i) {
      goals[i]->number = static_cast<int>(i) + 1;
      goals[i]->next = i + 1 < goals.size() ? goals[i + 1] : nullptr;
    }
    return goals.empty() ? nullptr : goals.front();
  }

  void Append(const Formula& formula, Scope* scope, std::vector<Goal*>* goals) {
    for (const Formula& part : formula.parts) {
      if (part.kind == Formula::Kind::kSequence) {
        Append(part, scope, goals);
      } else if (Goal* goal = CompileOne(part, scope)) {
        goals->push_back(goal);
      }
    }
  }

  Goal* CompileOne(const Formula& formula, Scope* scope) {
    switch (formula.kind) {
      case Formula::Kind::kSequence:
        break;
      case Formula::Kind::kAtom:
        return CompileAtom(formula, scope);
      case Formula::Kind::kGoal:
        return Binding(Goal::Kind::kVariableGoal, formula, scope);
      case Formula::Kind::kAnd:
        return CompileAnd(formula, scope);
      case Formula::Kind::kOr:
        return CompileParts(Goal::Kind::kOr, formula, scope);
      case Formula::Kind::kImply:
        return CompileParts(Goal::Kind::kImply, formula, scope);
      case Formula::Kind::kNot:
        return Negation(formula, Compile(formula.parts[0], scope));
      case Formula::Kind::kForall:
        return CompileForall(formula, scope);
      case Formula::Kind::kExists:
        return CompileExists(formula, scope);
      case Formula::Kind::kEqual:
        return CompileEqual(formula, scope);
      case Formula::Kind::kAssign:
        return Binding(Goal::Kind::kAssign, formula, scope);
      case Formula::Kind::kAssignEach:
        return Binding(Goal::Kind::kAssignEach, formula, scope);
      case Formula::Kind::kEval: {
        Goal* goal = MakeGoal(Goal::Kind::kEval, formula);
        goal->expression = CompileExpression(formula.expression, scope);
        return goal;
      }
      case Formula::Kind::kSetOf:
      case Formula::Kind::kBagOf:
        return CompileCollect(formula, scope);
    }
    return nullptr;
  }

  Goal* CompileAtom(const Formula& formula, Scope* scope) {
    const Datum& atom = formula.term;
    if (atom.Head().empty() || !atom.tail.empty()) {  // (?predicate ...) or (p . ?arguments)
      Goal* goal = MakeGoal(Goal::Kind::kVariableGoal, formula);
      goal->patterns.push_back(Compile(atom, scope));
      return goal;
    }
    Goal* goal = MakeGoal(Goal::Kind::kAtom, formula);
    goal->predicate = terms_.Symbol(atom.Head());
    for (std::size_t i = 1; i < atom.items.size(); ++i) {
      goal->patterns.push_back(Compile(atom.items[i], scope));
    }
    return goal;
  }

  Goal* Binding(Goal::Kind kind, const Formula& formula, Scope* scope) {
    Goal* goal = MakeGoal(kind, formula);
    goal->patterns.push_back(Compile(formula.term, scope));
    if (kind != Goal::Kind::kVariableGoal) {
      goal->expression = CompileExpression(formula.expression, scope);
    }
    return goal;
  }

  void SetVisible(const Formula& formula, Scope* scope, Goal* goal) {
    std::vector<std::string> names;
    CollectOuterVariables(formula, &names);
    for (const std::string& name : names) {
      const std::uint32_t slot = scope->SlotOf(name);
      if (std::find(goal->slots.begin(), goal->slots.end(), slot) == goal->slots.end()) {
        goal->slots.push_back(slot);
      }
    }
  }

  // One goal under an `and` is that goal, none is true.
  Goal* CompileAnd(const Formula& formula, Scope* scope) {
    if (formula.parts.empty()) return nullptr;
    Formula& sequence = program_.formulas_.emplace_back();
    sequence.parts = formula.parts;
    sequence.place = formula.place;
    Goal* goal = MakeGoal(Goal::Kind::kAnd, formula);
    SetVisible(formula, scope, goal);
    goal->bodies.push_back(Compile(sequence, scope));
    return goal;
  }

  Goal* CompileParts(Goal::Kind kind, const Formula& formula, Scope* scope) {
    Goal* goal = MakeGoal(kind, formula);
    SetVisible(formula, scope, goal);
    for (const Formula& part : formula.parts) goal->bodies.push_back(Compile(part, scope));
    if (kind == Goal::Kind::kImply) {  // (imply a b): (or (not a) b)
      goal->bodies.push_back(Negation(formula.parts[0], goal->bodies[0]));
      std::vector<std::string> names;
      CollectOuterVariables(formula.parts[0], &names);
      for (const std::string& name : names) {
        Pattern slot;
        slot.kind = Pattern::Kind::kSlot;
        slot.slot = scope->SlotOf(name);
        goal->patterns.push_back(Keep(slot));
      }
    }
    return goal;
  }

  Goal* Negation(const Formula& formula, const Goal* body) {
    Goal* goal = MakeGoal(Goal::Kind::kNot, formula);
    goal->bodies.push_back(body);
    return goal;
  }

  // For all that satisfy the bounds the condition holds: none satisfies them without it.
  Goal* CompileForall(const Formula& formula, Scope* scope) {
    const std::size_t mark = scope->Open(formula.variables);
    std::vector<Goal*> goals;
    AppendAny(formula.parts[0], scope, &goals);
    goals.push_back(Negation(formula.parts[1], Compile(formula.parts[1], scope)));
    scope->Close(mark, formula.variables.size());
    for (std::size_t i = 0; i + 1 < goals.size(); ++i) goals[i]->next = goals[i + 1];
    return Negation(formula, goals.front());
  }

  void AppendAny(const Formula& formula, Scope* scope, std::vector<Goal*>* goals) {
    if (formula.kind == Formula::Kind::kSequence || formula.kind == Formula::Kind::kAnd) {
      Append(formula, scope, goals);
    } else if (Goal* goal = CompileOne(formula, scope)) {
      goals->push_back(goal);
    }
  }

  Goal* CompileExists(const Formula& formula, Scope* scope) {
    const std::size_t mark = scope->Open(formula.variables);
    std::vector<Goal*> goals;
    AppendAny(formula.parts[0], scope, &goals);
    if (formula.parts.size() > 1) AppendAny(formula.parts[1], scope, &goals);
    scope->Close(mark, formula.variables.size());
    for (std::size_t i = 0; i + 1 < goals.size(); ++i) goals[i]->next = goals[i + 1];
    return Negation(formula, Negation(formula, goals.empty() ? nullptr : goals.front()));
  }

  Goal* CompileEqual(const Formula& formula, Scope* scope) {
    Goal* goal = MakeGoal(Goal::Kind::kEqual, formula);
    goal->patterns.push_back(Compile(formula.term.items.at(1), scope));
    goal->patterns.push_back(Compile(formula.term.items.at(2), scope));
    return goal;
  }

  Goal* CompileCollect(const Formula& formula, Scope* scope) {
    Goal* goal = MakeGoal(Goal::Kind::kCollect, formula);
    goal->bag = formula.kind == Formula::Kind::kBagOf;
    goal->patterns.push_back(Compile(formula.term, scope));
    goal->patterns.push_back(Compile(formula.expression, scope));
    goal->bodies.push_back(Compile(formula.parts[0], scope));
    return goal;
  }

  CompiledPrecondition Compile(const Precondition& precondition, Scope* scope) {
    CompiledPrecondition compiled;
    compiled.order = precondition.order;
    compiled.goals = Compile(precondition.condition, scope);
    if (precondition.order == Precondition::Order::kSortBy) {
      compiled.sort_key = CompileExpression(precondition.sort_key, scope);
      compiled.comparison = functions_.Find(precondition.comparison);
      if (compiled.comparison == nullptr) compiled.comparison = UnknownComparison(precondition);
    }
    return compiled;
  }

  /// Fails where something is to be sorted by it.
  const Functions::Entry* UnknownComparison(const Precondition& precondition) {
    const std::string text =
        Where(source_, precondition.sort_key.place) +
        ": :sort-by: " + base::UnknownName("function", precondition.comparison, functions_.Names());
    program_.warnings_.push_back(text);
    program_.unknown_comparisons_.push_back(
        {precondition.comparison, 2, 2,
         [text](TermTable*, const std::vector<Term>&) -> Term { throw base::ConfigError(text); }});
    return &program_.unknown_comparisons_.back();
  }

  // --- operators, methods, axioms ------------------------------------------------------------

  std::vector<CompiledEffect> Compile(const std::vector<Effect>& effects, Scope* scope) {
    std::vector<CompiledEffect> compiled;
    for (const Effect& effect : effects) {
      CompiledEffect& last = compiled.emplace_back();
      last.kind = effect.kind;
      last.source = &effect;
      if (effect.kind == Effect::Kind::kForall) {
        last.condition = Compile(effect.condition, scope);
        last.effects = Compile(effect.effects, scope);
      } else {
        last.pattern = Compile(effect.term, scope);
      }
    }
    return compiled;
  }

  void SetCost(const Datum& cost, Scope* scope, CompiledOperator* compiled) {
    if (cost.kind == Datum::Kind::kInteger || cost.kind == Datum::Kind::kReal) {
      compiled->fixed_cost =
          cost.kind == Datum::Kind::kReal ? cost.real : static_cast<double>(cost.integer);
    } else if (!cost.IsNil()) {
      compiled->cost = CompileExpression(cost, scope);
    }
  }

  void AddOperator(const Operator& source) {
    Scope scope;
    CompiledOperator& compiled = program_.operators_.emplace_back();
    compiled.source = &source;
    compiled.head = Compile(source.head, &scope);
    compiled.num_head_slots = static_cast<std::uint32_t>(scope.names().size());
    compiled.precondition = Compile(source.precondition, &scope);
    compiled.deletes = Compile(source.deletes, &scope);
    compiled.adds = Compile(source.adds, &scope);
    SetCost(source.cost, &scope, &compiled);
    compiled.num_slots = static_cast<std::uint32_t>(scope.names().size());
    compiled.variables = scope.names();
    EnsureAt(&program_.operator_of_, terms_.Symbol(source.head.Head()).index()) = &compiled;
  }

  /// One branch, of atoms that no step changes.
  bool IsFixed(const Method& method) const {
    if (method.branches.size() != 1 || !program_.domain_.axioms.empty()) return false;
    const Precondition& precondition = method.branches[0].precondition;
    const std::vector<Formula>& parts = precondition.condition.parts;
    return precondition.condition.kind == Formula::Kind::kSequence &&
           precondition.order == Precondition::Order::kAll &&
           std::all_of(parts.begin(), parts.end(), [&](const Formula& part) {
             return part.kind == Formula::Kind::kAtom &&
                    !changing_.MayHave(std::string(part.term.Head()));
           });
  }

  void AddMethod(std::size_t index) {
    const Method& source = program_.domain_.methods[index];
    Scope scope;
    CompiledMethod& compiled = program_.methods_.emplace_back();
    compiled.source = &source;
    compiled.index = static_cast<int>(index);
    compiled.head = Compile(source.head, &scope);
    compiled.num_head_slots = static_cast<std::uint32_t>(scope.names().size());
    for (const Branch& branch : source.branches) {
      const CompiledPrecondition precondition = Compile(branch.precondition, &scope);
      compiled.branches.push_back(
          {&branch, precondition, Compile(branch.subtasks, &scope),
           branch.with_first_step ? Compile(*branch.with_first_step, &scope) : precondition});
    }
    compiled.num_slots = static_cast<std::uint32_t>(scope.names().size());
    compiled.variables = scope.names();
    compiled.is_fixed = compiled.num_slots == compiled.num_head_slots && IsFixed(source);
    EnsureAt(&program_.methods_of_, terms_.Symbol(source.head.Head()).index()).push_back(&compiled);
  }

  void AddAxiom(const Axiom& source) {
    Scope scope;
    CompiledAxiom& compiled = program_.axiom_store_.emplace_back();
    compiled.source = &source;
    for (std::size_t i = 1; i < source.head.items.size(); ++i) {
      compiled.head.push_back(Compile(source.head.items[i], &scope));
    }
    for (const Axiom::Branch& branch : source.branches) {
      compiled.branches.push_back({Compile(branch.condition, &scope), branch.first});
    }
    compiled.num_slots = static_cast<std::uint32_t>(scope.names().size());
    EnsureAt(&program_.axioms_, terms_.Symbol(source.head.Head()).index()).push_back(&compiled);
  }

  // --- networks ------------------------------------------------------------------------------

  const CompiledNetwork* Compile(const TaskNetwork& written, Scope* scope) {
    const TaskNetwork network = WithoutEmptyItems(written);
    CompiledNetwork compiled;
    for (const TaskItem& item : network.items) {
      CompiledNetwork::Item& last = compiled.items.emplace_back();
      last.immediate = item.immediate;
      if (item.network.empty()) {
        last.task = Compile(item.task, scope);
      } else {
        last.network = Compile(item.network.front(), scope);
      }
    }
    for (const auto& [before, after] : network.order) {
      compiled.items.at(before).after.push_back(static_cast<std::uint32_t>(after));
      ++compiled.items.at(after).num_before;
    }
    compiled.chain = IsChain(network);
    CountFirst(&compiled);
    program_.networks_.push_back(std::move(compiled));
    return &program_.networks_.back();
  }

  static bool IsChain(const TaskNetwork& network) {
    if (network.items.size() < 2) return true;
    for (int i = 0; i + 1 < static_cast<int>(network.items.size()); ++i) {
      const std::pair<int, int> step(i, i + 1);
      if (std::find(network.order.begin(), network.order.end(), step) == network.order.end()) {
        return false;
      }
    }
    return true;
  }

  static void CountFirst(CompiledNetwork* network) {
    for (const CompiledNetwork::Item& item : network->items) {
      if (item.num_before > 0) continue;
      network->num_first += item.task != nullptr ? 1 : item.network->num_first;
      if (item.task != nullptr ? item.immediate : item.network->first_is_immediate) {
        network->first_is_immediate = true;
      }
    }
  }

  // --- problem -------------------------------------------------------------------------------

  void AddFacts(const std::vector<Datum>& facts) {
    for (const Datum& fact : facts) {
      if (!IsGround(fact) || fact.Head().empty()) {
        throw base::ConfigError(
            fmt::format("{}: fact {} must be a list without variables that "
                        "begins with a predicate, like (on b1 b2)",
                        Where(source_, fact.place), ToString(fact)));
      }
      program_.facts_.push_back(terms_.FromDatum(fact));
    }
  }

  void AddRoot() {
    Scope scope;
    program_.root_branch_.label = program_.problem_.name;
    program_.root_.head = Constant(Term());
    const CompiledPrecondition parameters = Compile(program_.problem_.parameters, &scope);
    program_.root_.branches.push_back(
        {&program_.root_branch_, parameters, Compile(program_.problem_.tasks, &scope), parameters});
    CheckTasks(program_.problem_, program_.domain_);
    program_.root_.index = -1;
    program_.root_.num_slots = static_cast<std::uint32_t>(scope.names().size());
    program_.root_.variables = scope.names();
    if (program_.problem_.goal) {
      Scope goal_scope;
      program_.goal_ = Compile(*program_.problem_.goal, &goal_scope);
      program_.goal_slots_ = static_cast<std::uint32_t>(goal_scope.names().size());
    }
  }

  Program& program_;
  const Functions& functions_;
  TermTable& terms_;
  const PredicateSet changing_;  // by steps
  std::string source_;
};

Program::Program(const Domain& domain, const Problem& problem, const Functions& functions,
                 TermTable* terms)
    : domain_(domain), problem_(problem) {
  Compiler(this, functions, terms).Run();
}

const CompiledOperator* Program::FindOperator(Term name) const {
  return name.index() < operator_of_.size() ? operator_of_[name.index()] : nullptr;
}

const std::vector<const CompiledMethod*>& Program::Methods(Term name) const {
  return name.index() < methods_of_.size() ? methods_of_[name.index()] : no_methods_;
}

bool Program::leaves_order_open() const {
  return std::any_of(networks_.begin(), networks_.end(),
                     [](const CompiledNetwork& network) { return !network.chain; });
}

void Program::FailUnhandled(const std::string& name, const std::string& task) const {
  const auto known = domain_.unknown_tasks.find(name);
  if (known != domain_.unknown_tasks.end()) {
    throw base::ConfigError(known->second + "; it was reached as " + task);
  }
  throw base::ConfigError(fmt::format("{}: task {} has no operator or method in domain '{}'",
                                      domain_.source, task, domain_.name));
}

void Program::Fail(const Formula& condition, const std::string& what) const {
  const std::string term = condition.term.IsNil() ? "" : ToString(condition.term) + " ";
  FailAt(domain_.source, condition.place, term + what);
}

}  // namespace hires::planning
