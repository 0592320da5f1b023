// Goals that are logical words: and, or, not, imply, assign, setof.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "planning/search/prover.h"

namespace hires::planning {

bool Prover::NothingToBind(const Goal* goal) const {
  return std::all_of(goal->slots.begin(), goal->slots.end(), [&](std::uint32_t slot) {
    return terms_.IsGround(bindings_.Deref(Term(Term::Kind::kVariable, frame_ + slot)));
  });
}

bool Prover::CallAnd(const Goal* goal) {
  if (NothingToBind(goal)) {  // a second proof would tell nothing new
    PushContinuation(Continuation::Kind::kCut, goal->next,
                     static_cast<std::uint32_t>(choices_.size()));
  } else if (newest_first_) {
    PushReturn(goal->next);
    newest_first_ = false;
  } else {
    return StartCollection(goal);
  }
  goal_ = goal->bodies[0];
  return true;
}

bool Prover::CallOr(const Goal* goal) {
  if (NothingToBind(goal)) {
    PushContinuation(Continuation::Kind::kCut, goal->next,
                     static_cast<std::uint32_t>(choices_.size()));
  } else if (newest_first_) {
    PushReturn(goal->next);
  } else {
    return StartCollection(goal);
  }
  newest_first_ = false;
  return EnterDisjunct(goal, 0);
}

bool Prover::EnterDisjunct(const Goal* goal, std::uint32_t disjunct) {
  const bool imply = goal->kind == Goal::Kind::kImply;  // bodies: if, then, not if
  const std::uint32_t count = imply ? 2 : static_cast<std::uint32_t>(goal->bodies.size());
  if (disjunct >= count) return false;
  if (disjunct + 1 < count) Push(Choice::Kind::kDisjuncts, goal).next = disjunct + 1;
  if (!collections_.empty() && collections_.back().goal == goal &&
      collections_.back().frame == frame_) {
    collections_.back().part = disjunct;
  }
  goal_ = goal->bodies[imply ? 2 - disjunct : disjunct];
  return true;
}

bool Prover::CallImply(const Goal* goal) {
  for (const Pattern* variable : goal->patterns) {
    if (!terms_.IsGround(Build(*variable, frame_))) {
      Fail(*goal->source,
           "the first part of an imply must have no unbound variable when it is "
           "reached; put goals that bind it before");
    }
  }
  return CallOr(goal);
}

bool Prover::CallNot(const Goal* goal) {
  const Goal* body = goal->bodies[0];
  if (body != nullptr && body->kind == Goal::Kind::kAtom && body->next == nullptr &&
      program_.Axioms(body->predicate).empty()) {
    const std::uint32_t arguments = BuildArguments(body);
    const auto count = static_cast<std::uint32_t>(body->patterns.size());
    const bool holds = AllGround(arguments, count)
                           ? HoldsAsFact(body->predicate, arguments, count)
                           : SomeFactMatches(body->predicate, arguments, count);
    arguments_.resize(arguments);
    goal_ = goal->next;
    return !holds;
  }
  Push(Choice::Kind::kNot, goal);
  PushContinuation(Continuation::Kind::kRefute, nullptr,
                   static_cast<std::uint32_t>(choices_.size()) - 1);
  newest_first_ = true;
  goal_ = body;
  return true;
}

bool Prover::CallAssign(const Goal* goal) {
  const Term value = Evaluate(*goal->expression, frame_);
  const Term target = Build(*goal->patterns[0], frame_);
  goal_ = goal->next;
  if (value.IsNumber() && target.IsNumber()) return terms_.number(value) == terms_.number(target);
  return bindings_.Unify(target, value);
}

bool Prover::CallAssignEach(const Goal* goal) {
  Term values = Evaluate(*goal->expression, frame_);
  if (!newest_first_) {  // "all bindings": the last one first
    Term reversed;
    for (; values.IsPair(); values = terms_.tail(values)) {
      reversed = terms_.Pair(terms_.head(values), reversed);
    }
    values = reversed;
  }
  if (!values.IsPair()) return false;
  Choice& choice = Push(Choice::Kind::kValues, goal);
  choice.list = values;
  return NextValue(&choice);
}

bool Prover::NextValue(Choice* choice) {
  const Goal* goal = choice->goal;
  const Term value = terms_.head(choice->list);
  choice->list = terms_.tail(choice->list);
  if (!choice->list.IsPair()) choices_.pop_back();
  goal_ = goal->next;
  return bindings_.Unify(Build(*goal->patterns[0], frame_), value);
}

// --- solutions gathered before they are used ---

std::vector<std::uint32_t> Prover::Unbound(const Goal* goal) {
  std::vector<std::uint32_t> slots;
  for (const std::uint32_t slot : goal->slots) {
    const Term variable(Term::Kind::kVariable, frame_ + slot);
    if (!terms_.IsGround(bindings_.Resolve(variable))) slots.push_back(slot);
  }
  return slots;
}

bool Prover::StartCollection(const Goal* goal) {
  Collection fresh;
  fresh.goal = goal;
  fresh.frame = frame_;
  if (goal->kind != Goal::Kind::kCollect) fresh.unbound = Unbound(goal);
  Push(Choice::Kind::kCollect, goal);
  collections_.push_back(std::move(fresh));
  newest_first_ = false;
  PushContinuation(Continuation::Kind::kCollect, nullptr,
                   static_cast<std::uint32_t>(choices_.size()) - 1);
  if (goal->kind == Goal::Kind::kOr || goal->kind == Goal::Kind::kImply) {
    return EnterDisjunct(goal, 0);
  }
  goal_ = goal->bodies[0];
  return true;
}

void Prover::Record(std::uint32_t barrier) {
  Collection& collection = collections_.back();
  const Goal* goal = collection.goal;
  const std::size_t first = collection.values.size();
  if (goal->kind == Goal::Kind::kCollect) {
    collection.values.push_back(Build(*goal->patterns[0], collection.frame));
  }
  for (const std::uint32_t slot : collection.unbound) {
    collection.values.push_back(
        bindings_.Resolve(Term(Term::Kind::kVariable, collection.frame + slot)));
  }
  std::uint64_t hash = collection.part;
  for (std::size_t i = first; i < collection.values.size(); ++i) {
    const Term value = collection.values[i];
    const bool outer = value.IsVariable() && value.index() < choices_[barrier].bindings.variables;
    if (!terms_.IsGround(value) && !outer) {
      Fail(*goal->source, fmt::format("a solution leaves a variable unbound in {}; bind it inside",
                                      terms_.ToString(value)));
    }
    hash = hash * 0x9e3779b97f4a7c15ULL + terms_.Hash(value);
  }
  if (!goal->bag && !collection.seen.insert(hash).second) collection.values.resize(first);
}

bool Prover::FinishCollection() {
  const Collection collection = std::move(collections_.back());
  collections_.pop_back();
  choices_.pop_back();
  const Goal* goal = collection.goal;
  goal_ = goal->next;
  if (collection.values.empty()) return false;
  if (goal->kind == Goal::Kind::kCollect) {
    const Term list =
        terms_.List(collection.values.data(), collection.values.data() + collection.values.size());
    return bindings_.Unify(Build(*goal->patterns[1], frame_), list);
  }
  const auto first = static_cast<std::uint32_t>(tuples_.size());
  tuples_.insert(tuples_.end(), collection.values.begin(), collection.values.end());
  Choice& choice = Push(Choice::Kind::kTuples, goal);
  choice.tuples = first;
  choice.next =
      static_cast<std::uint32_t>(collection.values.size() / collection.unbound.size()) - 1;
  return NextTuple(&choice);
}

bool Prover::NextTuple(Choice* choice) {
  const Goal* goal = choice->goal;
  const std::vector<std::uint32_t> slots = Unbound(goal);
  const std::size_t first = choice->tuples + choice->next * slots.size();
  if (choice->next-- == 0) choices_.pop_back();
  goal_ = goal->next;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const Term variable(Term::Kind::kVariable, frame_ + slots[i]);
    if (!bindings_.Unify(variable, tuples_[first + i])) return false;
  }
  return true;
}

}  // namespace hires::planning
