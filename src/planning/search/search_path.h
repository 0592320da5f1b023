#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "hires/planning/term.h"
#include "planning/proof/bindings.h"
#include "planning/proof/instantiator.h"
#include "planning/proof/program.h"
#include "planning/proof/prover.h"
#include "planning/proof/state.h"
#include "planning/search/network.h"
#include "planning/search/protections.h"
#include "planning/search/visited.h"

namespace hires::planning {

/// The way from the problem's tasks to where the search is: steps taken, tasks decomposed and still
/// to be done, facts that hold now, bindings. All of it can be taken back to a moment, so nothing
/// is ever copied.
class SearchPath {
 public:
  struct Step {
    std::uint32_t node;
    const CompiledOperator* applied;
    std::uint32_t variables;
    double cost;
  };
  struct Decomposition {
    std::uint32_t node;
    const CompiledMethod* method;
    std::uint32_t branch;
    std::uint32_t variables;
    std::size_t num_steps;  ///< taken before
  };
  /// How far everything was.
  struct Moment {
    Bindings::Mark bindings;
    Prover::Mark prover;
    std::size_t state, tasks, protections, visited, begun, pairs;
    std::uint32_t nodes;
    std::size_t num_steps, num_decompositions;
    std::size_t choices;  ///< of the prover
    int depth;
    double cost;
  };

  /// At the beginning: the problem's facts hold, its tasks are not laid out yet.
  SearchPath(const Program& program, TermTable* terms);

  Moment Now();
  /// Takes back steps and decompositions; what proofs bound stays, for their next solution.
  void UndoSteps(const Moment& moment);
  /// Takes back everything.
  void ReturnTo(const Moment& moment);

  /// A task has been taken up.
  void GoDeeper() { ++depth_; }
  /// Lays out the reduction of a node by a branch of a method. @param immediate  As Network's.
  void Decompose(const Decomposition& decomposition, const std::vector<Term>& tasks, int immediate);
  std::size_t num_steps() const { return steps_.size(); }
  void Finish(const Step& step);  ///< a step has been taken; its effects are in the state

  /// The task of a node with its bindings.
  Term Task(std::uint32_t node) { return bindings_.Resolve(network_.node(node).task); }
  /// True where the path has been through the same state and tasks; notes that it was here now.
  bool WasHere();
  /// Of the facts, the tasks left and the protections, whatever path led to them.
  std::uint64_t situation() const;
  bool has_situation() const { return network_.has_content(); }  ///< otherwise it says nothing
  /// From now on it is noted in which state each task is decomposed, for NumRepeats().
  void CountRepeats() { counts_repeats_ = true; }
  /// How many ancestors of `node` are of `task` and were decomposed in this very state.
  /// @param across_steps  Also where steps have been taken since, which then led back to the state.
  int NumRepeats(std::uint32_t node, Term task, bool across_steps = true) const;

  /// From now on a task that was begun is done, with all of its subtasks, before another begins.
  void FinishWhatIsBegun() { focuses_ = true; }
  /// The first task that can come next, and others after it; 0: there is none.
  /// @param focus  as focus() was.
  std::uint32_t FirstReady() const;
  std::uint32_t NextReady(std::uint32_t node, std::uint32_t focus) const;
  std::uint32_t focus() const { return focus_; }

  int depth() const { return depth_; }  ///< decompositions and steps
  double cost() const { return cost_; }
  const std::vector<Step>& steps() const { return steps_; }
  const std::vector<Decomposition>& decompositions() const { return decompositions_; }

  TermTable& terms() { return terms_; }
  Bindings& bindings() { return bindings_; }
  Instantiator& instances() { return instances_; }
  State& state() { return state_; }
  Protections& protections() { return protections_; }
  Prover& prover() { return prover_; }
  const Prover& prover() const { return prover_; }
  const Network& network() const { return network_; }
  std::size_t bytes() const;

 private:
  /// When a node was decomposed.
  struct Begin {
    std::uint64_t state;  ///< by hash
    std::size_t num_steps;
  };
  void NoteBegun(std::uint32_t node);

  TermTable& terms_;
  const bool ages_count_;  ///< of facts, for which binding comes first
  Bindings bindings_;
  Instantiator instances_;
  State state_;
  Network network_;
  Protections protections_;
  Visited visited_;
  Visited begun_;              ///< tasks decomposed, each with the state
  std::vector<Begin> begins_;  ///< by node
  bool counts_repeats_{false};
  bool focuses_{false};
  std::uint32_t focus_{0};  ///< only tasks from this node on can come next
  Prover prover_;
  std::vector<Step> steps_;
  std::vector<Decomposition> decompositions_;
  int depth_{0};
  double cost_{0.0};
};

}  // namespace hires::planning
