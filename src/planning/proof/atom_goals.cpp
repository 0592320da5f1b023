#include "planning/proof/atom_goals.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/error.h"

namespace hires::planning {
namespace {

constexpr std::uint32_t kMaxAxiomDepth = 100'000;

}  // namespace

AtomGoals::AtomGoals(const Program& program, TermTable* terms, Instantiator* instances,
                     Bindings* bindings, FactMatcher* facts, ProofStack* stack)
    : program_(program),
      terms_(*terms),
      instances_(*instances),
      bindings_(*bindings),
      facts_(*facts),
      stack_(*stack) {}

std::uint32_t AtomGoals::BuildArguments(const Goal* goal) {
  const std::uint32_t first = stack_.num_arguments();
  for (const Pattern* pattern : goal->patterns) {
    stack_.arguments().push_back(instances_.Build(*pattern, stack_.at().frame));
  }
  return first;
}

bool AtomGoals::Call(const Goal* goal) {
  return Call(goal->predicate, BuildArguments(goal), goal->next);
}

bool AtomGoals::CallVariable(const Goal* goal) {
  const Term atom = instances_.Build(*goal->patterns[0], stack_.at().frame);
  if (!atom.IsPair() || terms_.head(atom).kind() != Term::Kind::kSymbol) {
    program_.Fail(*goal->source,
                  fmt::format("stands for {}, but a goal must be a list that begins with a "
                              "predicate; bind the variable before it is used as a goal",
                              terms_.ToString(atom)));
  }
  const std::uint32_t arguments = stack_.num_arguments();
  for (Term rest = terms_.tail(atom); rest.IsPair(); rest = terms_.tail(rest)) {
    stack_.arguments().push_back(terms_.head(rest));
  }
  return Call(terms_.head(atom), arguments, goal->next);
}

bool AtomGoals::HoldsForSome(const Goal* goal) {
  const std::uint32_t arguments = BuildArguments(goal);
  const AtomView atom = Atom(goal->predicate, arguments, stack_.num_arguments() - arguments);
  const bool holds = facts_.IsGround(atom) ? facts_.Holds(atom) : facts_.HoldsForSome(atom);
  stack_.arguments().resize(arguments);
  return holds;
}

// --- facts ---

bool AtomGoals::Call(Term predicate, std::uint32_t arguments, const Goal* next) {
  const std::uint32_t count = stack_.num_arguments() - arguments;
  const AtomView atom = Atom(predicate, arguments, count);
  const bool has_axioms = HasAxioms(predicate);
  if (facts_.IsGround(atom)) {
    if (facts_.Holds(atom)) {
      stack_.arguments().resize(arguments);
      stack_.at().goal = next;
      return true;
    }
    if (!has_axioms) return false;
    stack_.PushCut(next, arguments);
    return EnterAxioms(predicate, arguments, count, true);
  }
  const FactMatcher::Walk first = facts_.Begin(atom, stack_.at().newest_first);
  if (first.done()) {
    if (!has_axioms) return false;
    stack_.PushReturn(next);
    return EnterAxioms(predicate, arguments, count, false);
  }
  const FactMatcher::Walk others = facts_.Next(atom, first);
  const bool only = others.done() && !has_axioms;
  if (!only) {
    Choice& choice = stack_.Push(Choice::Kind::kFacts, next);
    choice.key = others.key;
    choice.next = others.fact;
    choice.predicate = predicate;
    choice.arguments = arguments;
    choice.num_arguments = count;
  }
  stack_.at().goal = next;
  if (!facts_.Unify(atom, first.fact)) return false;
  if (only) stack_.arguments().resize(arguments);
  return true;
}

bool AtomGoals::NextFact() {
  Choice& choice = stack_.top();
  const AtomView atom = Atom(choice.predicate, choice.arguments, choice.num_arguments);
  const FactMatcher::Walk walk{choice.next, choice.key, choice.newest_first};
  stack_.at().goal = choice.goal;
  if (walk.done()) {
    const std::uint32_t arguments = choice.arguments;
    stack_.Pop();
    stack_.PushReturn(stack_.at().goal);
    return EnterAxioms(atom.predicate, arguments, atom.count, false);
  }
  choice.next = facts_.Next(atom, walk).fact;
  if (choice.next == State::kNone && !HasAxioms(atom.predicate)) stack_.Pop();
  return facts_.Unify(atom, walk.fact);
}

// --- axioms ---

/// What comes after the axiom has been pushed as a continuation.
bool AtomGoals::EnterAxioms(Term predicate, std::uint32_t arguments, std::uint32_t count,
                            bool once) {
  const auto& axioms = program_.Axioms(predicate);
  const bool forwards = once || stack_.at().newest_first;
  Choice& choice = stack_.Push(Choice::Kind::kAxioms, nullptr);
  choice.forwards = forwards;
  choice.predicate = predicate;
  choice.arguments = arguments;
  choice.num_arguments = count;
  choice.next = forwards ? 0 : static_cast<std::uint32_t>(axioms.size()) - 1;
  return NextAxiom();
}

bool AtomGoals::NextAxiom() {
  Choice& choice = stack_.top();
  const auto& axioms = program_.Axioms(choice.predicate);
  const std::uint32_t taken = choice.next;
  const std::uint32_t arguments = choice.arguments;
  const std::uint32_t count = choice.num_arguments;
  const bool last = choice.forwards ? taken + 1 == axioms.size() : taken == 0;
  if (last) {
    stack_.Pop();
  } else {
    choice.next = choice.forwards ? taken + 1 : taken - 1;
  }
  return TryAxiom(*axioms[taken], arguments, count);
}

bool AtomGoals::TryAxiom(const CompiledAxiom& axiom, std::uint32_t arguments, std::uint32_t count) {
  if (axiom.head.size() != count) return false;
  if (++stack_.at().depth > kMaxAxiomDepth) {
    throw base::ConfigError(
        fmt::format("{}:{}: axiom {} needs itself more than {} times; give it a branch that ends",
                    program_.domain().source, axiom.source->place.line,
                    ToString(axiom.source->head), kMaxAxiomDepth));
  }
  const std::uint32_t frame = bindings_.Make(axiom.num_slots);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Term argument = stack_.arguments()[arguments + i];
    if (!instances_.Match(*axiom.head[i], frame, argument)) return false;
  }
  return EnterBranch(axiom, 0, frame);
}

bool AtomGoals::NextBranch() {
  const Choice taken = stack_.top();
  stack_.Pop();
  return taken.next != ProofStack::kNone && EnterBranch(*taken.axiom, taken.next, taken.arguments);
}

bool AtomGoals::EnterBranch(const CompiledAxiom& axiom, std::uint32_t branch, std::uint32_t frame) {
  if (branch + 1 < axiom.branches.size()) {
    Choice& others = stack_.Push(Choice::Kind::kBranches, nullptr);
    others.axiom = &axiom;
    others.next = branch + 1;
    others.arguments = frame;
    stack_.PushContinuation(ProofStack::Continuation::Kind::kCommit, nullptr,
                            stack_.num_choices() - 1);
  }
  ProofStack::Position& at = stack_.at();
  at.frame = frame;
  at.goal = nullptr;
  if (axiom.branches.empty()) return true;
  at.goal = axiom.branches[branch].goals;
  if (axiom.branches[branch].first) {
    at.cut = std::min(at.cut, stack_.num_choices());
    at.newest_first = true;
  }
  return true;
}

}  // namespace hires::planning
