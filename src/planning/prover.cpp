#include "hires/planning/prover.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/error.h"

namespace hires::planning {
namespace {

constexpr std::uint32_t kMaxAxiomDepth = 100'000;
constexpr std::uint64_t kQuestionEvery = 4096;  // inferences

bool IsTrue(Term value) { return !value.IsNil(); }

}  // namespace

/// The variables of a frame, for expressions.
class Prover::Values : public VariableValues {
 public:
  Values(Bindings* bindings, std::uint32_t frame) : bindings_(*bindings), frame_(frame) {}
  Term Value(int slot) override {
    return bindings_.Resolve(
        Term(Term::Kind::kVariable, frame_ + static_cast<std::uint32_t>(slot)));
  }

 private:
  Bindings& bindings_;
  std::uint32_t frame_;
};

Prover::Prover(const Program& program, TermTable* terms, Bindings* bindings, const State* state)
    : program_(program), terms_(*terms), bindings_(*bindings), state_(*state) {}

// --- terms
// -----------------------------------------------------------------------------------------

Term Prover::Evaluate(const Expression& expression, std::uint32_t frame) {
  Values values(&bindings_, frame);
  return expression.Evaluate(&terms_, &values);
}

Term Prover::Build(const Pattern& pattern, std::uint32_t frame) {
  switch (pattern.kind) {
    case Pattern::Kind::kConstant:
      return pattern.constant;
    case Pattern::Kind::kSlot: {
      const Term value = bindings_.Deref(Term(Term::Kind::kVariable, frame + pattern.slot));
      return terms_.IsGround(value) ? value : bindings_.Resolve(value);
    }
    case Pattern::Kind::kCall:
      return Evaluate(*pattern.call, frame);
    case Pattern::Kind::kPair:
      break;
  }
  const std::size_t first = arguments_.size();  // the arguments' stack has room for the items
  const Pattern* rest = &pattern;
  for (; rest->kind == Pattern::Kind::kPair; rest = rest->tail) {
    const Term item = Build(*rest->head, frame);
    arguments_.push_back(item);
  }
  Term list = Build(*rest, frame);
  while (arguments_.size() > first) {
    list = terms_.Pair(arguments_.back(), list);
    arguments_.pop_back();
  }
  return list;
}

bool Prover::Match(const Pattern& pattern, std::uint32_t frame, Term term) {
  const Pattern* rest = &pattern;
  for (; rest->kind == Pattern::Kind::kPair; rest = rest->tail) {
    term = bindings_.Deref(term);
    if (!term.IsPair()) return term.IsVariable() && bindings_.Unify(term, Build(*rest, frame));
    if (!Match(*rest->head, frame, terms_.head(term))) return false;
    term = terms_.tail(term);
  }
  switch (rest->kind) {
    case Pattern::Kind::kConstant:
      return rest->constant == term || bindings_.Unify(rest->constant, term);
    case Pattern::Kind::kSlot:
      return bindings_.Unify(Term(Term::Kind::kVariable, frame + rest->slot), term);
    default:
      return bindings_.Unify(Build(*rest, frame), term);
  }
}

// --- the machine
// -----------------------------------------------------------------------------------

bool Prover::Solve(const Goal* goals, std::uint32_t frame, bool newest_first) {
  goal_ = goals;
  frame_ = frame;
  newest_first_ = newest_first;
  continuation_ = kNone;
  cut_ = kNone;
  depth_ = 0;
  trace_frame_ = frame;
  furthest_number_ = 0;
  furthest_.clear();
  return Run(choices_.size());
}

bool Prover::Next(std::size_t floor) { return Backtrack(floor) && Run(floor); }

void Prover::Cut(std::size_t floor) { choices_.resize(floor); }

bool Prover::Proves(Term atom) {
  const std::size_t floor = choices_.size();
  const Mark mark = Remember();
  const Bindings::Mark bindings = bindings_.Remember();
  goal_ = nullptr;
  frame_ = bindings_.size();
  newest_first_ = true;
  continuation_ = cut_ = kNone;
  depth_ = 0;
  for (Term rest = terms_.tail(atom); rest.IsPair(); rest = terms_.tail(rest)) {
    arguments_.push_back(terms_.head(rest));
  }
  const bool proven =
      (CallAtom(terms_.head(atom), mark.arguments,
                static_cast<std::uint32_t>(arguments_.size()) - mark.arguments, nullptr) ||
       Backtrack(floor)) &&
      Run(floor);
  Cut(floor);
  bindings_.Undo(bindings);
  Release(mark);
  return proven;
}

Prover::Mark Prover::Remember() const {
  return {static_cast<std::uint32_t>(continuations_.size()),
          static_cast<std::uint32_t>(arguments_.size()),
          static_cast<std::uint32_t>(tuples_.size())};
}

void Prover::Release(const Mark& mark) {
  continuations_.resize(mark.continuations);
  arguments_.resize(mark.arguments);
  tuples_.resize(mark.tuples);
}

bool Prover::Run(std::size_t floor) {
  for (;;) {
    bool solved = false;
    bool good = true;
    if (goal_ == nullptr) {
      good = Leave(&solved);
      if (solved) return true;
    } else {
      if (++inferences_ % kQuestionEvery == 0 && AskedToStop()) {
        collections_.clear();
        Cut(floor);
        return false;
      }
      good = Step();
    }
    if (!good && !Backtrack(floor)) return false;
  }
}

bool Prover::AskedToStop() {
  if (interrupt_ && interrupt_()) interrupted_ = true;
  return interrupted_;
}

/// At the end of a chain of goals.
bool Prover::Leave(bool* solved) {
  if (continuation_ == kNone) {
    if (cut_ < choices_.size()) choices_.resize(cut_);
    *solved = true;
    return true;
  }
  const std::uint32_t index = continuation_;
  const Continuation& left = continuations_[index];
  goal_ = left.goal;
  frame_ = left.frame;
  newest_first_ = left.newest_first;
  continuation_ = left.parent;
  depth_ = left.depth;
  switch (left.kind) {
    case Continuation::Kind::kReturn:
      return true;
    case Continuation::Kind::kCommit:
      choices_[left.choice].next = kNone;
      return true;
    case Continuation::Kind::kCut:  // nothing older can refer to what the proof made
      choices_.resize(left.choice);
      bindings_.Shrink(left.variables);
      arguments_.resize(left.arguments);
      continuations_.resize(index);
      return true;
    case Continuation::Kind::kRefute:
      choices_.resize(left.choice);
      return false;
    case Continuation::Kind::kCollect:
      Record(left.choice);
      return false;
  }
  return false;
}

bool Prover::Step() {
  const Goal* goal = goal_;
  if (names_ != nullptr) Trace(goal);
  switch (goal->kind) {
    case Goal::Kind::kAtom: {
      const std::uint32_t arguments = BuildArguments(goal);
      return CallAtom(goal->predicate, arguments, static_cast<std::uint32_t>(goal->patterns.size()),
                      goal->next);
    }
    case Goal::Kind::kVariableGoal:
      return CallVariableGoal(goal);
    case Goal::Kind::kAnd:
      return CallAnd(goal);
    case Goal::Kind::kOr:
      return CallOr(goal);
    case Goal::Kind::kNot:
      return CallNot(goal);
    case Goal::Kind::kImply:
      return CallImply(goal);
    case Goal::Kind::kEqual:
      goal_ = goal->next;
      return bindings_.Unify(Build(*goal->patterns[0], frame_), Build(*goal->patterns[1], frame_));
    case Goal::Kind::kAssign:
      return CallAssign(goal);
    case Goal::Kind::kAssignEach:
      return CallAssignEach(goal);
    case Goal::Kind::kEval:
      goal_ = goal->next;
      return IsTrue(Evaluate(*goal->expression, frame_));
    case Goal::Kind::kCollect:
      StartCollection(goal);
      return true;
  }
  return false;
}

Prover::Choice& Prover::Push(Choice::Kind kind, const Goal* goal) {
  Choice& choice = choices_.emplace_back();
  choice.kind = kind;
  choice.newest_first = newest_first_;
  choice.goal = goal;
  choice.frame = frame_;
  choice.continuation = continuation_;
  choice.cut = cut_;
  choice.depth = depth_;
  choice.next = 0;
  choice.bindings = bindings_.Remember();
  choice.num_continuations = static_cast<std::uint32_t>(continuations_.size());
  choice.num_arguments_stack = static_cast<std::uint32_t>(arguments_.size());
  choice.num_tuples = static_cast<std::uint32_t>(tuples_.size());
  choice.pairs = terms_.Mark();
  return choice;
}

void Prover::PushContinuation(Continuation::Kind kind, const Goal* goal, std::uint32_t choice) {
  continuations_.push_back({kind, newest_first_, goal, frame_, continuation_, choice, depth_,
                            bindings_.size(), static_cast<std::uint32_t>(arguments_.size())});
  continuation_ = static_cast<std::uint32_t>(continuations_.size() - 1);
}

void Prover::Restore(const Choice& choice) {
  newest_first_ = choice.newest_first;
  frame_ = choice.frame;
  continuation_ = choice.continuation;
  cut_ = choice.cut;
  depth_ = choice.depth;
  bindings_.Undo(choice.bindings);
  continuations_.resize(choice.num_continuations);
  arguments_.resize(choice.num_arguments_stack);
  tuples_.resize(choice.num_tuples);
  if (collections_.empty() && held_ == 0)
    terms_.Release(choice.pairs);  // what is gathered has to survive
}

bool Prover::Backtrack(std::size_t floor) {
  while (choices_.size() > floor) {
    Restore(choices_.back());
    if (Resume()) return true;
  }
  return false;
}

/// Takes the next way of the choice on top, which goes when it has no more.
bool Prover::Resume() {
  Choice& choice = choices_.back();
  switch (choice.kind) {
    case Choice::Kind::kFacts:
      return NextFact(&choice);
    case Choice::Kind::kAxioms:
      return NextAxiom(&choice);
    case Choice::Kind::kBranches: {
      const Choice taken = choice;
      choices_.pop_back();
      return taken.next != kNone && EnterBranch(*taken.axiom, taken.next, taken.arguments);
    }
    case Choice::Kind::kNot:
      goal_ = choice.goal->next;
      choices_.pop_back();
      return true;
    case Choice::Kind::kDisjuncts: {
      const Choice taken = choice;
      choices_.pop_back();
      return EnterDisjunct(taken.goal, taken.next);
    }
    case Choice::Kind::kValues:
      return NextValue(&choice);
    case Choice::Kind::kCollect:
      return FinishCollection();
    case Choice::Kind::kTuples:
      return NextTuple(&choice);
  }
  return false;
}

// --- facts
// -----------------------------------------------------------------------------------------

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

// --- axioms
// ----------------------------------------------------------------------------------------

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

// --- logical words
// ---------------------------------------------------------------------------------

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

// --- solutions gathered before they are used
// -------------------------------------------------------

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

// --- messages
// --------------------------------------------------------------------------------------

void Prover::Fail(const Formula& source, const std::string& what) const {
  throw base::ConfigError(fmt::format("{}:{}:{}: {} {}", program_.domain().source,
                                      source.place.line, source.place.column, ToString(source.term),
                                      what));
}

void Prover::Trace(const Goal* goal) {
  if (frame_ != trace_frame_ || depth_ != 0 || goal->number <= furthest_number_) return;
  furthest_number_ = goal->number;
  furthest_ = fmt::format("goal {} {}", goal->number, Text(goal));
}

/// Replaces the numbers of unbound variables by their names in the file.
void NameVariables(const std::vector<std::string>& names, std::uint32_t frame, Datum* datum) {
  if (datum->kind == Datum::Kind::kVariable) {
    const std::size_t slot = std::stoul(datum->text.substr(1)) - frame;
    if (slot < names.size()) datum->text = names[slot];
  }
  for (Datum& item : datum->items) NameVariables(names, frame, &item);
  for (Datum& item : datum->tail) NameVariables(names, frame, &item);
}

std::string Prover::Text(const Goal* goal) {
  if (goal->kind == Goal::Kind::kNot && goal->bodies[0] != nullptr &&
      goal->source->kind == Formula::Kind::kNot) {
    return "(not " + Text(goal->bodies[0]) + ")";
  }
  if (goal->kind != Goal::Kind::kAtom) {
    static const char* const kWords[] = {
        "",        "a variable goal", "(and ...)",     "(or ...)",   "(not ...)",  "(imply ...)",
        "(= ...)", "(assign ...)",    "(assign* ...)", "(eval ...)", "(setof ...)"};
    return fmt::format("{} in line {}", kWords[static_cast<int>(goal->kind)],
                       goal->source->place.line);
  }
  Datum atom = MakeList({terms_.ToDatum(goal->predicate)});
  for (const Pattern* pattern : goal->patterns) {
    atom.items.push_back(terms_.ToDatum(Build(*pattern, frame_)));
  }
  NameVariables(*names_, frame_, &atom);
  return ToString(atom);
}

std::size_t Prover::bytes() const {
  return continuations_.capacity() * sizeof(Continuation) + choices_.capacity() * sizeof(Choice) +
         (arguments_.capacity() + tuples_.capacity()) * sizeof(Term);
}

}  // namespace hires::planning
