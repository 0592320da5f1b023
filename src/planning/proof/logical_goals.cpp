#include "planning/proof/logical_goals.h"

#include <algorithm>

namespace hires::planning {

LogicalGoals::LogicalGoals(const Program& program, TermTable* terms, Instantiator* instances,
                           Bindings* bindings, ProofStack* stack, AtomGoals* atoms,
                           SolutionCollector* collector)
    : program_(program),
      terms_(*terms),
      instances_(*instances),
      bindings_(*bindings),
      stack_(*stack),
      atoms_(*atoms),
      collector_(*collector) {}

bool LogicalGoals::NothingToBind(const Goal* goal) const {
  const std::uint32_t frame = stack_.at().frame;
  return std::all_of(goal->slots.begin(), goal->slots.end(), [&](std::uint32_t slot) {
    return terms_.IsGround(bindings_.Deref(Instantiator::Variable(frame, slot)));
  });
}

bool LogicalGoals::And(const Goal* goal) {
  ProofStack::Position& at = stack_.at();
  if (NothingToBind(goal)) {  // a second proof would tell nothing new
    stack_.PushCut(goal->next);
  } else if (at.newest_first) {
    stack_.PushReturn(goal->next);
    at.newest_first = false;
  } else {
    collector_.Start(goal);
  }
  at.goal = goal->bodies[0];
  return true;
}

bool LogicalGoals::Or(const Goal* goal) {
  if (NothingToBind(goal)) {
    stack_.PushCut(goal->next);
  } else if (stack_.at().newest_first) {
    stack_.PushReturn(goal->next);
  } else {
    collector_.Start(goal);
  }
  stack_.at().newest_first = false;
  return EnterDisjunct(goal, 0);
}

bool LogicalGoals::EnterDisjunct(const Goal* goal, std::uint32_t disjunct) {
  const bool imply = goal->kind == Goal::Kind::kImply;  // bodies: if, then, not if
  const std::uint32_t count = imply ? 2 : static_cast<std::uint32_t>(goal->bodies.size());
  if (disjunct >= count) return false;
  if (disjunct + 1 < count) stack_.Push(Choice::Kind::kDisjuncts, goal).next = disjunct + 1;
  collector_.SetPart(goal, disjunct);
  stack_.at().goal = goal->bodies[imply ? 2 - disjunct : disjunct];
  return true;
}

bool LogicalGoals::NextDisjunct() {
  const Choice taken = stack_.top();
  stack_.Pop();
  return EnterDisjunct(taken.goal, taken.next);
}

bool LogicalGoals::Imply(const Goal* goal) {
  for (const Pattern* variable : goal->patterns) {
    if (!terms_.IsGround(instances_.Build(*variable, stack_.at().frame))) {
      program_.Fail(*goal->source,
                    "the first part of an imply must have no unbound variable when it is "
                    "reached; put goals that bind it before");
    }
  }
  return Or(goal);
}

bool LogicalGoals::Not(const Goal* goal) {
  const Goal* body = goal->bodies[0];
  if (body != nullptr && body->kind == Goal::Kind::kAtom && body->next == nullptr &&
      !atoms_.HasAxioms(body->predicate)) {
    stack_.at().goal = goal->next;
    return !atoms_.HoldsForSome(body);
  }
  stack_.Push(Choice::Kind::kNot, goal);
  stack_.PushContinuation(ProofStack::Continuation::Kind::kRefute, nullptr,
                          stack_.num_choices() - 1);
  stack_.at().newest_first = true;
  stack_.at().goal = body;
  return true;
}

bool LogicalGoals::AfterNot() {
  stack_.at().goal = stack_.top().goal->next;
  stack_.Pop();
  return true;
}

bool LogicalGoals::Equal(const Goal* goal) {
  ProofStack::Position& at = stack_.at();
  at.goal = goal->next;
  const Term left = instances_.Build(*goal->patterns[0], at.frame);
  return bindings_.Unify(left, instances_.Build(*goal->patterns[1], at.frame));
}

bool LogicalGoals::Eval(const Goal* goal) {
  stack_.at().goal = goal->next;
  return !instances_.Evaluate(*goal->expression, stack_.at().frame).IsNil();
}

bool LogicalGoals::Assign(const Goal* goal) {
  const Term value = instances_.Evaluate(*goal->expression, stack_.at().frame);
  const Term target = instances_.Build(*goal->patterns[0], stack_.at().frame);
  stack_.at().goal = goal->next;
  if (value.IsNumber() && target.IsNumber()) return terms_.number(value) == terms_.number(target);
  return bindings_.Unify(target, value);
}

bool LogicalGoals::AssignEach(const Goal* goal) {
  Term values = instances_.Evaluate(*goal->expression, stack_.at().frame);
  if (!stack_.at().newest_first) {  // "all bindings": the last one first
    Term reversed;
    for (; values.IsPair(); values = terms_.tail(values)) {
      reversed = terms_.Pair(terms_.head(values), reversed);
    }
    values = reversed;
  }
  if (!values.IsPair()) return false;
  stack_.Push(Choice::Kind::kValues, goal).list = values;
  return NextValue();
}

bool LogicalGoals::NextValue() {
  Choice& choice = stack_.top();
  const Goal* goal = choice.goal;
  const Term value = terms_.head(choice.list);
  choice.list = terms_.tail(choice.list);
  if (!choice.list.IsPair()) stack_.Pop();
  stack_.at().goal = goal->next;
  return bindings_.Unify(instances_.Build(*goal->patterns[0], stack_.at().frame), value);
}

bool LogicalGoals::Collect(const Goal* goal) {
  collector_.Start(goal);
  stack_.at().goal = goal->bodies[0];
  return true;
}

}  // namespace hires::planning
