#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hires/planning/term.h"
#include "planning/proof/bindings.h"
#include "planning/proof/program.h"

namespace hires::planning {

/// Where a proof is, what has to be proven after the goals at hand (continuations), and where there
/// are other ways to go (choices); with the way back to each of these. What goals mean is not its
/// concern. Registers and stacks as in a machine for Prolog [Warren 1983, SRI Technical Note 309].
class ProofStack {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// The registers.
  struct Position {
    const Goal* goal{nullptr};  ///< to be proven next; null: this chain of goals is proven
    std::uint32_t frame{0};     ///< of its variables
    std::uint32_t continuation{kNone};
    std::uint32_t cut{kNone};  ///< choices above this height go when the whole proof succeeds
    std::uint32_t depth{0};    ///< axioms within axioms
    bool newest_first{false};  ///< order of facts
  };
  /// What to do when a chain of goals is proven.
  struct Continuation {
    enum class Kind : std::uint8_t {
      kReturn,  ///< go on with `goal`
      kCommit,  ///< the same, and the choice takes no other branch
      kCut,     ///< the same, and choices above the height go
      kRefute,  ///< fail, and choices above the height go
      kCollect  ///< fail, once the solution is noted
    };
    Kind kind;
    bool newest_first;
    const Goal* goal;
    std::uint32_t frame;
    std::uint32_t parent;
    std::uint32_t choice;  ///< index or height of the choices it acts on
    std::uint32_t depth;
    std::uint32_t variables;  ///< kCut: how many there were
    std::uint32_t arguments;  ///< the same
  };
  /// How high the stacks were.
  struct Mark {
    std::uint32_t continuations, arguments, tuples;
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
    Mark stacks;
    std::size_t pairs;
  };

  ProofStack(TermTable* terms, Bindings* bindings) : terms_(*terms), bindings_(*bindings) {}

  Position& at() { return at_; }
  const Position& at() const { return at_; }
  /// Another proof, above whatever is there.
  void Begin(const Goal* goals, std::uint32_t frame, bool newest_first);

  /// A choice to which Restore comes back, to be filled in; valid until the next Push.
  Choice& Push(Choice::Kind kind, const Goal* goal);
  Choice& top() { return choices_.back(); }
  const Choice& choice(std::uint32_t index) const { return choices_[index]; }
  std::uint32_t num_choices() const { return static_cast<std::uint32_t>(choices_.size()); }
  void Pop() { choices_.pop_back(); }
  void CutTo(std::size_t num_choices) { choices_.resize(num_choices); }
  /// Back to where the choice on top was pushed; it stays.
  void Restore();

  void PushContinuation(Continuation::Kind kind, const Goal* goal, std::uint32_t choice);
  void PushReturn(const Goal* next) {
    if (next != nullptr) PushContinuation(Continuation::Kind::kReturn, next, 0);
  }
  /// When what comes before `next` is proven, it is proven for good. Forgets the arguments above
  /// `num_arguments` then, too.
  void PushCut(const Goal* next, std::uint32_t num_arguments);
  void PushCut(const Goal* next) { PushCut(next, num_arguments()); }
  /// Takes the newest continuation of the position and carries out what it asks of the stacks.
  /// @pre at().continuation is not kNone.
  Continuation Leave();

  /// Arguments of the goals that are being proven, and solutions that wait to be taken up.
  std::vector<Term>& arguments() { return arguments_; }
  std::uint32_t num_arguments() const { return static_cast<std::uint32_t>(arguments_.size()); }
  std::vector<Term>& tuples() { return tuples_; }

  Mark Remember() const {
    return {static_cast<std::uint32_t>(continuations_.size()), num_arguments(),
            static_cast<std::uint32_t>(tuples_.size())};
  }
  void Release(const Mark& mark) {  ///< what is above is not needed any more
    continuations_.resize(mark.continuations);
    arguments_.resize(mark.arguments);
    tuples_.resize(mark.tuples);
  }
  /// While held, pairs that proofs made stay.
  void HoldPairs(bool hold) { held_ += hold ? 1 : -1; }
  std::size_t bytes() const;

 private:
  TermTable& terms_;
  Bindings& bindings_;
  Position at_;
  std::vector<Continuation> continuations_;
  std::vector<Choice> choices_;
  std::vector<Term> arguments_;
  std::vector<Term> tuples_;
  int held_{0};
};

}  // namespace hires::planning
