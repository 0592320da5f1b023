#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "hires/planning/reference_prover.h"

namespace hires::planning {

/// What all solvers of one question share.
struct ProofSession {
  ReferenceProver& prover;
  const FactHistory& facts;
  int moment;
  bool explain;
  int reading;  ///< above 0: what is asked goes into `reads`
  Substitution values{};
  std::vector<Literal> support{};
  std::vector<Datum> reads{};
  std::vector<Literal>* failures{nullptr};  ///< where to note atoms that nothing matches
  int nesting{0};
  std::uint64_t num_clauses{0};  ///< copies of clauses made, for names of their own
};

/// The proofs of one formula, depth first, with an explicit stack of goals and choices: a long
/// chain of axioms costs memory, not stack.
class ReferenceSolver {
 public:
  /// Begins with the values that the session has.
  ReferenceSolver(ProofSession* session, const Formula& formula, bool newest_first, int depth,
                  const ValueMap* expected);
  /// Takes back what it bound and noted.
  ~ReferenceSolver();
  ReferenceSolver(const ReferenceSolver&) = delete;
  ReferenceSolver& operator=(const ReferenceSolver&) = delete;

  /// Goes to the next proof; its values and support stand in the session until the next call.
  bool Next();

 private:
  static constexpr int kNoGoal = -1;

  /// A goal that is left, and what is left after it.
  struct Cell {
    const Formula* formula{nullptr};  ///< null: an axiom's branch has been proven
    int next{kNoGoal};
    int depth{0};  ///< axioms it stands in
    bool newest_first{false};
    int choice{0};          ///< of the axiom
    std::size_t resume{0};  ///< axiom to go on with
    bool only_one{false};   ///< `:first`: no second proof of the branch
  };

  struct Marks {
    std::size_t cells;
    std::size_t values;
    std::size_t support;
    std::size_t reads;
    std::size_t formulas;
  };

  /// A goal with several ways to prove it, and which come next.
  struct Choice {
    int cell{0};
    Marks marks{};
    std::size_t position{0};  ///< of facts, parts or members
    Datum atom;               ///< of an atom, as known when it was reached
    Datum guided;             ///< with expected values
    const std::vector<int>* facts{nullptr};
    const std::vector<const Axiom*>* axioms{nullptr};
    std::size_t axiom{0};
    std::size_t branch{0};
    bool had_proof{false};
    std::vector<Datum> members;  ///< of an assign*
  };

  Marks Here() const;
  void GoBack(const Marks& marks);
  int Push(Cell cell);
  int PushGoal(const Formula& formula, const Cell& like, int next);
  const Formula& Keep(Formula formula);  ///< until the solver goes back behind this moment
  std::string FreshSuffix();

  bool Step();
  bool Backtrack();
  bool TryNext(Choice* choice);
  bool EndsAsExpected();

  bool Begin(const Cell& cell, Choice choice);
  bool BeginAtom(const Cell& cell, const Datum& term);
  bool BeginAssignEach(const Cell& cell);
  bool NextFact(Choice* choice);
  bool NextAxiom(Choice* choice);
  bool EnterBranch(const Choice& choice, const Axiom& axiom, const Axiom::Branch& branch,
                   const std::string& suffix);
  bool Commit(const Cell& cell);
  bool NextPart(Choice* choice);
  bool NextImplied(Choice* choice);
  bool NextMember(Choice* choice);
  void NoteFailure(const Choice& choice);

  bool PushAll(const Cell& cell);
  bool TestNot(const Cell& cell);
  bool TestForall(const Cell& cell);
  bool PushExists(const Cell& cell);
  bool TestEqual(const Cell& cell);
  bool Assign(const Cell& cell);
  bool TestEval(const Cell& cell);
  bool Collect(const Cell& cell);

  bool FindsProof(const Formula& formula, const Cell& cell, std::vector<Literal>* why,
                  std::vector<Literal>* why_not);
  void AddSupport(const std::vector<Literal>& literals);
  Datum Guided(const Datum& atom) const;
  bool Agrees(const std::string& variable);
  void CheckNesting(const Cell& cell) const;
  [[noreturn]] void Fail(Place place, const std::string& text) const;

  ProofSession* session_;
  const ValueMap* expected_;
  Marks start_;
  std::vector<Cell> cells_;
  std::vector<Choice> choices_;
  std::vector<std::unique_ptr<Formula>> formulas_;
  int goal_;
  bool started_{false};
};

/// A copy of `formula` with `suffix` behind the names of its variables; only of those in `only`
/// where that is given.
Formula RenameFormula(const Formula& formula, const std::string& suffix,
                      const std::set<std::string>* only = nullptr);

}  // namespace hires::planning
