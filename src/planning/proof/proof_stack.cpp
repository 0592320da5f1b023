#include "planning/proof/proof_stack.h"

namespace hires::planning {

void ProofStack::Begin(const Goal* goals, std::uint32_t frame, bool newest_first) {
  at_ = Position{};
  at_.goal = goals;
  at_.frame = frame;
  at_.newest_first = newest_first;
}

ProofStack::Choice& ProofStack::Push(Choice::Kind kind, const Goal* goal) {
  Choice& choice = choices_.emplace_back();
  choice.kind = kind;
  choice.newest_first = at_.newest_first;
  choice.goal = goal;
  choice.frame = at_.frame;
  choice.continuation = at_.continuation;
  choice.cut = at_.cut;
  choice.depth = at_.depth;
  choice.next = 0;
  choice.bindings = bindings_.Remember();
  choice.stacks = Remember();
  choice.pairs = terms_.Mark();
  return choice;
}

void ProofStack::Restore() {
  const Choice& choice = choices_.back();
  at_.newest_first = choice.newest_first;
  at_.frame = choice.frame;
  at_.continuation = choice.continuation;
  at_.cut = choice.cut;
  at_.depth = choice.depth;
  bindings_.Undo(choice.bindings);
  Release(choice.stacks);
  if (held_ == 0) terms_.Release(choice.pairs);
}

void ProofStack::PushContinuation(Continuation::Kind kind, const Goal* goal, std::uint32_t choice) {
  continuations_.push_back({kind, at_.newest_first, goal, at_.frame, at_.continuation, choice,
                            at_.depth, bindings_.size(), num_arguments()});
  at_.continuation = static_cast<std::uint32_t>(continuations_.size() - 1);
}

void ProofStack::PushCut(const Goal* next, std::uint32_t num_arguments) {
  PushContinuation(Continuation::Kind::kCut, next, num_choices());
  continuations_.back().arguments = num_arguments;
}

ProofStack::Continuation ProofStack::Leave() {
  const std::uint32_t index = at_.continuation;
  const Continuation left = continuations_[index];
  at_.goal = left.goal;
  at_.frame = left.frame;
  at_.newest_first = left.newest_first;
  at_.continuation = left.parent;
  at_.depth = left.depth;
  switch (left.kind) {
    case Continuation::Kind::kReturn:
    case Continuation::Kind::kCollect:
      break;
    case Continuation::Kind::kCommit:
      choices_[left.choice].next = kNone;
      break;
    case Continuation::Kind::kCut:  // nothing older can refer to what the proof made
      choices_.resize(left.choice);
      bindings_.Shrink(left.variables);
      arguments_.resize(left.arguments);
      continuations_.resize(index);
      break;
    case Continuation::Kind::kRefute:
      choices_.resize(left.choice);
      break;
  }
  return left;
}

std::size_t ProofStack::bytes() const {
  return continuations_.capacity() * sizeof(Continuation) + choices_.capacity() * sizeof(Choice) +
         (arguments_.capacity() + tuples_.capacity()) * sizeof(Term);
}

}  // namespace hires::planning
