// Goals that are atoms: facts first, then axioms.
#include <fmt/format.h>

#include <algorithm>

#include "hires/base/error.h"
#include "planning/search/prover.h"

namespace hires::planning {
namespace {

constexpr std::uint32_t kMaxAxiomDepth = 100'000;

}  // namespace

std::uint32_t Prover::BuildArguments(const Goal* goal) {
  const auto first = static_cast<std::uint32_t>(arguments_.size());
  for (const Pattern* pattern : goal->patterns) {
    const Term argument = Build(*pattern, frame_);
    arguments_.push_back(argument);
  }
  return first;
}

bool Prover::AllGround(std::uint32_t arguments, std::uint32_t count) const {
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!terms_.IsGround(arguments_[arguments + i])) return false;
  }
  return true;
}

bool Prover::HoldsAsFact(Term predicate, std::uint32_t arguments, std::uint32_t count) const {
  Term list;
  for (std::uint32_t i = count; i-- > 0;) {
    list = terms_.FindPair(arguments_[arguments + i], list);
    if (list.IsNil()) return false;
  }
  return state_.Holds(terms_.FindPair(predicate, list));
}

bool Prover::CallAtom(Term predicate, std::uint32_t arguments, std::uint32_t count,
                      const Goal* next) {
  const bool has_axioms = !program_.Axioms(predicate).empty();
  if (AllGround(arguments, count)) {
    if (HoldsAsFact(predicate, arguments, count)) {
      arguments_.resize(arguments);
      goal_ = next;
      return true;
    }
    if (!has_axioms) return false;
    PushContinuation(Continuation::Kind::kCut, next, static_cast<std::uint32_t>(choices_.size()));
    continuations_.back().arguments = arguments;
    return EnterAxioms(predicate, arguments, count, true);
  }
  const State::Chain chain = state_.Candidates(predicate, &arguments_[arguments], count);
  const std::uint32_t fact = FirstAgreeing(newest_first_ ? chain.newest : chain.oldest,
                                           newest_first_, chain.key, arguments, count);
  if (fact == State::kNone) {
    if (!has_axioms) return false;
    PushReturn(next);
    return EnterAxioms(predicate, arguments, count, false);
  }
  const std::uint32_t after =
      FirstAgreeing(newest_first_ ? state_.Previous(fact, chain.key) : state_.Next(fact, chain.key),
                    newest_first_, chain.key, arguments, count);
  if (after != State::kNone || has_axioms) {
    Choice& others = Push(Choice::Kind::kFacts, next);
    others.key = chain.key;
    others.next = after;
    others.predicate = predicate;
    others.arguments = arguments;
    others.num_arguments = count;
  }
  goal_ = next;
  if (!UnifyFact(fact, arguments, count)) return false;
  if (after == State::kNone && !has_axioms) arguments_.resize(arguments);
  return true;
}

/// From `fact` on along its chain, the first that has the goal's arguments where these are ground.
std::uint32_t Prover::FirstAgreeing(std::uint32_t fact, bool newest_first, std::uint8_t key,
                                    std::uint32_t arguments, std::uint32_t count) const {
  for (; fact != State::kNone;
       fact = newest_first ? state_.Previous(fact, key) : state_.Next(fact, key)) {
    if (state_.Arity(fact) != count) continue;
    const Term* known = state_.Arguments(fact);
    bool agrees = true;
    for (std::uint32_t i = 0; i < count && agrees; ++i) {
      const Term wanted = arguments_[arguments + i];
      agrees = wanted == known[i] || !terms_.IsGround(wanted);
    }
    if (agrees) return fact;
  }
  return State::kNone;
}

bool Prover::SomeFactMatches(Term predicate, std::uint32_t arguments, std::uint32_t count) {
  const State::Chain chain = state_.Candidates(predicate, &arguments_[arguments], count);
  const Bindings::Mark mark = bindings_.Remember();
  std::uint32_t fact = chain.newest;
  bool matches = false;
  while (!matches) {
    fact = FirstAgreeing(fact, true, chain.key, arguments, count);
    if (fact == State::kNone) break;
    matches = UnifyFact(fact, arguments, count);
    bindings_.Undo(mark);
    fact = state_.Previous(fact, chain.key);
  }
  return matches;
}

bool Prover::UnifyFact(std::uint32_t fact, std::uint32_t arguments, std::uint32_t count) {
  const Term* known = state_.Arguments(fact);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Term wanted = arguments_[arguments + i];
    if (wanted != known[i] && !bindings_.Unify(wanted, known[i])) return false;
  }
  return true;
}

bool Prover::NextFact(Choice* choice) {
  const std::uint32_t fact = choice->next;
  const std::uint32_t arguments = choice->arguments;
  const std::uint32_t count = choice->num_arguments;
  const bool has_axioms = !program_.Axioms(choice->predicate).empty();
  goal_ = choice->goal;
  if (fact == State::kNone) {
    const Term predicate = choice->predicate;
    choices_.pop_back();
    PushReturn(goal_);
    return EnterAxioms(predicate, arguments, count, false);
  }
  choice->next = FirstAgreeing(
      choice->newest_first ? state_.Previous(fact, choice->key) : state_.Next(fact, choice->key),
      choice->newest_first, choice->key, arguments, count);
  if (choice->next == State::kNone && !has_axioms) choices_.pop_back();
  return UnifyFact(fact, arguments, count);
}

bool Prover::CallVariableGoal(const Goal* goal) {
  const Term atom = Build(*goal->patterns[0], frame_);
  if (!atom.IsPair() || terms_.head(atom).kind() != Term::Kind::kSymbol) {
    Fail(*goal->source, fmt::format("stands for {}, but a goal must be a list that begins with a "
                                    "predicate; bind the variable before it is used as a goal",
                                    terms_.ToString(atom)));
  }
  const auto arguments = static_cast<std::uint32_t>(arguments_.size());
  Term rest = terms_.tail(atom);
  for (; rest.IsPair(); rest = terms_.tail(rest)) arguments_.push_back(terms_.head(rest));
  return CallAtom(terms_.head(atom), arguments,
                  static_cast<std::uint32_t>(arguments_.size()) - arguments, goal->next);
}

// --- axioms ---

/// What comes after the axiom has been pushed as a continuation.
bool Prover::EnterAxioms(Term predicate, std::uint32_t arguments, std::uint32_t count, bool once) {
  const auto& axioms = program_.Axioms(predicate);
  const bool forwards = once || newest_first_;
  Choice& choice = Push(Choice::Kind::kAxioms, nullptr);
  choice.forwards = forwards;
  choice.predicate = predicate;
  choice.arguments = arguments;
  choice.num_arguments = count;
  choice.next = forwards ? 0 : static_cast<std::uint32_t>(axioms.size()) - 1;
  return NextAxiom(&choice);
}

bool Prover::NextAxiom(Choice* choice) {
  const auto& axioms = program_.Axioms(choice->predicate);
  const std::uint32_t taken = choice->next;
  const std::uint32_t arguments = choice->arguments;
  const std::uint32_t count = choice->num_arguments;
  const bool last = choice->forwards ? taken + 1 == axioms.size() : taken == 0;
  if (last) {
    choices_.pop_back();
  } else {
    choice->next = choice->forwards ? taken + 1 : taken - 1;
  }
  return TryAxiom(*axioms[taken], arguments, count);
}

bool Prover::TryAxiom(const CompiledAxiom& axiom, std::uint32_t arguments, std::uint32_t count) {
  if (axiom.head.size() != count) return false;
  if (++depth_ > kMaxAxiomDepth) {
    throw base::ConfigError(
        fmt::format("{}:{}: axiom {} needs itself more than {} times; give it a branch that ends",
                    program_.domain().source, axiom.source->place.line,
                    ToString(axiom.source->head), kMaxAxiomDepth));
  }
  const std::uint32_t frame = bindings_.Make(axiom.num_slots);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!Match(*axiom.head[i], frame, arguments_[arguments + i])) return false;
  }
  return EnterBranch(axiom, 0, frame);
}

bool Prover::EnterBranch(const CompiledAxiom& axiom, std::uint32_t branch, std::uint32_t frame) {
  if (branch + 1 < axiom.branches.size()) {
    Choice& others = Push(Choice::Kind::kBranches, nullptr);
    others.axiom = &axiom;
    others.next = branch + 1;
    others.arguments = frame;
    PushContinuation(Continuation::Kind::kCommit, nullptr,
                     static_cast<std::uint32_t>(choices_.size()) - 1);
  }
  frame_ = frame;
  goal_ = nullptr;
  if (axiom.branches.empty()) return true;
  goal_ = axiom.branches[branch].goals;
  if (axiom.branches[branch].first) {
    cut_ = std::min(cut_, static_cast<std::uint32_t>(choices_.size()));
    newest_first_ = true;
  }
  return true;
}

}  // namespace hires::planning
