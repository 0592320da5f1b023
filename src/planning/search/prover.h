#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <unordered_set>
#include <vector>

#include "hires/planning/functions.h"
#include "hires/planning/term.h"
#include "planning/search/bindings.h"
#include "planning/search/program.h"
#include "planning/search/state.h"

namespace hires::planning {

/// Proves conditions in the current state by facts and axioms, one solution after the other, with
/// the order of solutions that SHOP3 has:
/// - "all bindings" (methods): facts oldest first, then axioms, the last one first;
/// - "one binding" (operators, :first): facts newest first, then axioms, the first one first;
/// - an explicit `and`, an `or`, and the body of an axiom with several goals are solved for all
///   bindings on their own; "all bindings" then takes these the other way round.
/// Solutions are found when they are asked for; proofs that can only repeat a solution are skipped.
class Prover {
 public:
  Prover(const Program& program, TermTable* terms, Bindings* bindings, const State* state);

  /// Asked at least every 4096 inferences; true gives up (Solve and Next say no from then on).
  void set_interrupt(std::function<bool()> interrupt) { interrupt_ = std::move(interrupt); }
  /// Keeps the furthest goal that was tried, for people; `names` are those of the frame's
  /// variables, null keeps nothing.
  void set_tracing(const std::vector<std::string>* names) { names_ = names; }

  /// The first solution of `goals`, whose variables begin at `frame`. Alternatives stay on the
  /// stack above what num_choices() was before; Next asks for them, Cut drops them.
  bool Solve(const Goal* goals, std::uint32_t frame, bool newest_first);
  bool Next(std::size_t floor);  ///< @pre num_choices() > floor
  void Cut(std::size_t floor);
  std::size_t num_choices() const { return choices_.size(); }
  /// One proof of a ground atom; leaves nothing behind.
  bool Proves(Term atom);

  /// What the stacks hold, to be dropped when nothing above is needed any more.
  struct Mark {
    std::uint32_t continuations, arguments, tuples;
  };
  Mark Remember() const;
  void Release(const Mark& mark);
  /// While held, pairs that proofs made stay (the caller keeps terms across solutions).
  void HoldPairs(bool hold) { held_ += hold ? 1 : -1; }

  /// An instance of a pattern in the frame at `frame`: variables replaced, unbound ones left.
  Term Build(const Pattern& pattern, std::uint32_t frame);
  bool Match(const Pattern& pattern, std::uint32_t frame, Term term);
  Term Evaluate(const Expression& expression, std::uint32_t frame);

  std::uint64_t inferences() const { return inferences_; }
  bool interrupted() const { return interrupted_; }
  /// The furthest goal of the last Solve with its bindings so far: "goal 3 (on ?x b2)".
  const std::string& furthest() const { return furthest_; }
  std::size_t bytes() const;

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// What to do when a chain of goals is proven.
  struct Continuation {
    enum class Kind : std::uint8_t { kReturn, kCommit, kCut, kRefute, kCollect };
    Kind kind;
    bool newest_first;
    const Goal* goal;
    std::uint32_t frame;
    std::uint32_t parent;
    std::uint32_t choice;  ///< height of the choices it acts on
    std::uint32_t depth;
    std::uint32_t variables;  ///< kCut: how many there were
    std::uint32_t arguments;  ///< the same
  };
  /// Another way to go.
  struct Choice {
    enum class Kind : std::uint8_t {
      kFacts,
      kAxioms,
      kBranches,
      kNot,
      kDisjuncts,
      kValues,
      kCollect,
      kTuples
    };
    Kind kind;
    bool newest_first;
    bool forwards;     ///< kAxioms: the first one first
    std::uint8_t key;  ///< kFacts: chain walked
    const Goal* goal;  ///< kFacts, kAxioms: what comes next; else the goal itself
    const CompiledAxiom* axiom;
    Term predicate;
    Term list;  ///< kValues: those left
    std::uint32_t frame, continuation, cut, depth;
    std::uint32_t next;  ///< fact, axiom, branch, disjunct or tuple to try
    std::uint32_t arguments, num_arguments;
    std::uint32_t tuples;  ///< kTuples: where they begin
    Bindings::Mark bindings;
    std::uint32_t num_continuations, num_arguments_stack, num_tuples;
    std::size_t pairs;
  };
  /// Solutions of one goal, gathered before any of them is used.
  struct Collection {
    const Goal* goal;
    std::uint32_t frame;
    std::vector<std::uint32_t> unbound;  ///< slots to be recorded
    std::vector<Term> values;
    std::unordered_set<std::uint64_t> seen;
    std::uint32_t part{0};  ///< disjunct that is being solved
  };
  class Values;

  bool Run(std::size_t floor);
  bool Leave(bool* solved);
  bool Step();
  bool Backtrack(std::size_t floor);
  bool Resume();
  void Restore(const Choice& choice);
  Choice& Push(Choice::Kind kind, const Goal* goal);
  void PushContinuation(Continuation::Kind kind, const Goal* goal, std::uint32_t choice);
  void PushReturn(const Goal* next) {
    if (next != nullptr) PushContinuation(Continuation::Kind::kReturn, next, 0);
  }

  bool CallAtom(Term predicate, std::uint32_t arguments, std::uint32_t count, const Goal* next);
  bool CallVariableGoal(const Goal* goal);
  bool HoldsAsFact(Term predicate, std::uint32_t arguments, std::uint32_t count) const;
  bool AllGround(std::uint32_t arguments, std::uint32_t count) const;
  bool NextFact(Choice* choice);
  std::uint32_t FirstAgreeing(std::uint32_t fact, bool newest_first, std::uint8_t key,
                              std::uint32_t arguments, std::uint32_t count) const;
  bool SomeFactMatches(Term predicate, std::uint32_t arguments, std::uint32_t count);
  bool UnifyFact(std::uint32_t fact, std::uint32_t arguments, std::uint32_t count);
  bool EnterAxioms(Term predicate, std::uint32_t arguments, std::uint32_t count, bool once);
  bool NextAxiom(Choice* choice);
  bool TryAxiom(const CompiledAxiom& axiom, std::uint32_t arguments, std::uint32_t count);
  bool EnterBranch(const CompiledAxiom& axiom, std::uint32_t branch, std::uint32_t frame);
  bool CallAnd(const Goal* goal);
  bool CallOr(const Goal* goal);
  bool EnterDisjunct(const Goal* goal, std::uint32_t disjunct);
  bool CallImply(const Goal* goal);
  bool CallNot(const Goal* goal);
  bool CallAssign(const Goal* goal);
  bool CallAssignEach(const Goal* goal);
  bool NextValue(Choice* choice);
  bool StartCollection(const Goal* goal);
  void Record(std::uint32_t barrier);
  bool FinishCollection();
  bool NextTuple(Choice* choice);
  std::vector<std::uint32_t> Unbound(const Goal* goal);
  bool NothingToBind(const Goal* goal) const;
  std::uint32_t BuildArguments(const Goal* goal);
  bool AskedToStop();
  void Trace(const Goal* goal);
  std::string Text(const Goal* goal);
  [[noreturn]] void Fail(const Formula& source, const std::string& what) const;

  const Program& program_;
  TermTable& terms_;
  Bindings& bindings_;
  const State& state_;
  std::function<bool()> interrupt_;

  // Where the proof is.
  const Goal* goal_{nullptr};
  std::uint32_t frame_{0};
  std::uint32_t continuation_{kNone};
  std::uint32_t cut_{kNone};  ///< choices above this height go when the whole proof succeeds
  std::uint32_t depth_{0};    ///< axioms within axioms
  bool newest_first_{false};

  std::vector<Continuation> continuations_;
  std::vector<Choice> choices_;
  std::vector<Term> arguments_;
  std::vector<Term> tuples_;
  std::vector<Collection> collections_;
  int held_{0};
  std::uint64_t inferences_{0};
  bool interrupted_{false};
  const std::vector<std::string>* names_{nullptr};
  std::uint32_t trace_frame_{0};
  int furthest_number_{0};
  std::string furthest_;
};

}  // namespace hires::planning
