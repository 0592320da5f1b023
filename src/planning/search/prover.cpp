#include "planning/search/prover.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/error.h"

namespace hires::planning {
namespace {

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

// --- terms ---

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

// --- the machine ---

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

// --- messages ---

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
