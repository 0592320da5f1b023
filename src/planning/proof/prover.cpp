#include "planning/proof/prover.h"

namespace hires::planning {
namespace {

constexpr std::uint64_t kQuestionEvery = 4096;  // inferences

}  // namespace

Prover::Prover(const Program& program, TermTable* terms, Bindings* bindings,
               Instantiator* instances, const State* state)
    : terms_(*terms),
      bindings_(*bindings),
      stack_(terms, bindings),
      facts_(terms, bindings, state),
      collector_(program, terms, instances, bindings, &stack_),
      atoms_(program, terms, instances, bindings, &facts_, &stack_),
      logic_(program, terms, instances, bindings, &stack_, &atoms_, &collector_),
      trace_(terms, instances) {}

bool Prover::Solve(const Goal* goals, std::uint32_t frame, bool newest_first) {
  stack_.Begin(goals, frame, newest_first);
  trace_.Begin(frame);
  return Run(num_choices());
}

bool Prover::Next(std::size_t floor) { return Backtrack(floor) && Run(floor); }

bool Prover::Proves(Term atom) {
  const std::size_t floor = num_choices();
  const Mark mark = Remember();
  const Bindings::Mark bindings = bindings_.Remember();
  stack_.Begin(nullptr, bindings_.size(), true);
  for (Term rest = terms_.tail(atom); rest.IsPair(); rest = terms_.tail(rest)) {
    stack_.arguments().push_back(terms_.head(rest));
  }
  const bool proven =
      (atoms_.Call(terms_.head(atom), mark.arguments, nullptr) || Backtrack(floor)) && Run(floor);
  Cut(floor);
  bindings_.Undo(bindings);
  Release(mark);
  return proven;
}

/// Until everything is proven, or there is no other way above `floor`.
bool Prover::Run(std::size_t floor) {
  const ProofStack::Position& at = stack_.at();
  for (;;) {
    bool good = true;
    if (at.goal != nullptr) {
      if (++inferences_ % kQuestionEvery == 0 && AskedToStop()) {
        collector_.Clear();
        Cut(floor);
        return false;
      }
      good = Step();
    } else if (at.continuation != ProofStack::kNone) {
      good = Leave();
    } else {
      if (at.cut < num_choices()) Cut(at.cut);
      return true;
    }
    if (!good && !Backtrack(floor)) return false;
  }
}

bool Prover::AskedToStop() {
  if (interrupt_ && interrupt_()) interrupted_ = true;
  return interrupted_;
}

/// One goal taken up.
bool Prover::Step() {
  if (trace_.active()) trace_.Note(stack_.at());
  const Goal* goal = stack_.at().goal;
  switch (goal->kind) {
    case Goal::Kind::kAtom:
      return atoms_.Call(goal);
    case Goal::Kind::kVariableGoal:
      return atoms_.CallVariable(goal);
    case Goal::Kind::kAnd:
      return logic_.And(goal);
    case Goal::Kind::kOr:
      return logic_.Or(goal);
    case Goal::Kind::kNot:
      return logic_.Not(goal);
    case Goal::Kind::kImply:
      return logic_.Imply(goal);
    case Goal::Kind::kEqual:
      return logic_.Equal(goal);
    case Goal::Kind::kAssign:
      return logic_.Assign(goal);
    case Goal::Kind::kAssignEach:
      return logic_.AssignEach(goal);
    case Goal::Kind::kEval:
      return logic_.Eval(goal);
    case Goal::Kind::kCollect:
      return logic_.Collect(goal);
  }
  return false;
}

/// At the end of a chain of goals.
bool Prover::Leave() {
  const ProofStack::Continuation left = stack_.Leave();
  switch (left.kind) {
    case ProofStack::Continuation::Kind::kReturn:
    case ProofStack::Continuation::Kind::kCommit:
    case ProofStack::Continuation::Kind::kCut:
      return true;
    case ProofStack::Continuation::Kind::kRefute:
      return false;
    case ProofStack::Continuation::Kind::kCollect:
      collector_.Record(stack_.choice(left.choice));
      return false;
  }
  return false;
}

bool Prover::Backtrack(std::size_t floor) {
  while (num_choices() > floor) {
    stack_.Restore();
    if (Resume()) return true;
  }
  return false;
}

/// Takes the next way of the choice on top, which goes when it has no more.
bool Prover::Resume() {
  switch (stack_.top().kind) {
    case ProofStack::Choice::Kind::kFacts:
      return atoms_.NextFact();
    case ProofStack::Choice::Kind::kAxioms:
      return atoms_.NextAxiom();
    case ProofStack::Choice::Kind::kBranches:
      return atoms_.NextBranch();
    case ProofStack::Choice::Kind::kNot:
      return logic_.AfterNot();
    case ProofStack::Choice::Kind::kDisjuncts:
      return logic_.NextDisjunct();
    case ProofStack::Choice::Kind::kValues:
      return logic_.NextValue();
    case ProofStack::Choice::Kind::kCollect:
      return collector_.Finish();
    case ProofStack::Choice::Kind::kTuples:
      return collector_.NextTuple();
  }
  return false;
}

}  // namespace hires::planning
