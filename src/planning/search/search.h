#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <unordered_set>
#include <vector>

#include "hires/planning/planner.h"
#include "planning/proof/bindings.h"
#include "planning/proof/instantiator.h"
#include "planning/proof/program.h"
#include "planning/proof/prover.h"
#include "planning/proof/state.h"
#include "planning/search/network.h"
#include "planning/search/protections.h"
#include "planning/search/visited.h"

namespace hires::planning {

/// One search for plans: a machine that goes forward along one path, task by task, and back to the
/// last place where there was another way. All that a step changes (state, tasks, bindings) can be
/// undone, so nothing is ever copied.
class Search {
 public:
  /// @param left_recursion  Whether a task may come up again below itself before a step was taken.
  ///   Without, a search ends that would never stop going down (get_to -> get_to, drive), but plans
  ///   may be missed (s -> s, b); gave_up_recursion() says whether there was such a task.
  Search(const Program& program, TermTable* terms, const PlanRequest& request,
         bool left_recursion = true);
  PlanResult Run();
  bool gave_up_recursion() const { return gave_up_recursion_; }

 private:
  /// A way back to a moment of the path.
  struct Moment {
    Bindings::Mark bindings;
    Prover::Mark prover;
    std::size_t state, tasks, protections, visited, pairs;
    std::uint32_t nodes;
    std::size_t num_steps, num_decompositions;
    std::size_t choices;  ///< of the prover
    int depth;
    double cost;
  };
  /// A place with other ways to go: another ready task, or another decomposition of `node`.
  struct Frame {
    Moment moment;
    std::uint32_t node{0};
    bool choose_task{false};
    const std::vector<const CompiledMethod*>* methods{nullptr};
    std::uint32_t method{0};     ///< that is being tried; methods->size(): none left
    std::uint32_t branch{0};     ///< of that method; kNotEntered before the first
    bool solved{false};          ///< the branch had a binding
    std::uint32_t variables{0};  ///< where the method's begin
    Bindings::Mark entered{};    ///< when the head had been matched
    std::uint32_t variant{0};    ///< which of the first tasks goes on at once
    std::uint32_t num_variants{0};
    Moment solution{};  ///< when the binding had been found
    bool sorted{false};
    std::vector<Term> solutions;  ///< of :sort-by, in order, num_slots values each
    std::size_t next_solution{0};
    std::vector<std::uint64_t> tried;  ///< reductions, by hash
  };
  struct Decomposition {
    std::uint32_t node;
    const CompiledMethod* method;
    std::uint32_t branch;
    std::uint32_t variables;
    std::size_t num_steps;
  };
  struct Step {
    std::uint32_t node;
    const CompiledOperator* applied;
    std::uint32_t variables;
    double cost;
  };

  Moment Now();
  void Return(const Moment& moment);
  bool Forward();
  bool Backward();
  bool Process(std::uint32_t node);
  bool IsLeftRecursion(std::uint32_t node, Term task) const;
  bool ReturnTo(Frame* frame);
  void PushTaskFrame(std::uint32_t node);
  bool PushMethodFrame(std::uint32_t node, const std::vector<const CompiledMethod*>& methods);

  // Methods.
  bool NextWay(Frame* frame);
  bool EnterMethod(Frame* frame);
  bool NextBranch(Frame* frame);
  bool NextSolution(Frame* frame);
  bool GatherSorted(Frame* frame, const CompiledPrecondition& precondition, std::uint32_t slots);
  bool UseSolution(Frame* frame);
  bool Reduce(Frame* frame);
  bool HasMore(const Frame& frame) const;
  std::uint32_t NextFitting(const Frame& frame, std::uint32_t from) const;
  void BuildTasks(const Frame& frame);
  void BuildTasks(const CompiledNetwork& network, std::uint32_t variables);
  bool WasHere();

  // Operators.
  bool Apply(std::uint32_t node);
  bool FindBinding(const CompiledPrecondition& precondition, std::uint32_t variables,
                   std::uint32_t slots);
  bool IsExcluded(Term task) const;
  double CostOf(const CompiledOperator& applied, std::uint32_t variables);
  bool TooDear(double cost);
  void Collect(const std::vector<CompiledEffect>& effects, std::uint32_t variables,
               std::vector<Term>* atoms);
  void CollectForAll(const CompiledEffect& effect, std::uint32_t variables,
                     std::vector<Term>* atoms);
  bool BreaksProtection();
  bool IsLost(Term atom);
  bool Change(const CompiledOperator& applied);
  bool ProtectionsHold();
  bool Protect();
  bool IsProtection(Term atom) const;
  void RequireGround(const CompiledOperator& applied, Term atom) const;

  // Plans, questions, messages.
  bool FoundPlan();
  std::uint64_t PlanKey();
  Plan Extract();
  void ExtractNodes(Plan* plan, std::vector<int>* number);
  int AddNode(std::uint32_t node, int parent, Plan* plan, std::vector<int>* number);
  std::vector<std::pair<std::string, Datum>> Values(const std::vector<std::string>& names,
                                                    std::uint32_t first, std::uint32_t variables);
  Progress CurrentProgress() const;
  bool Ask();
  std::size_t bytes() const;
  PlanOutcome Outcome() const;
  void Note(Term task, const std::string& where, const std::string& reason);
  bool tracing() const { return request_.max_trace > 0; }
  std::string Where(const CompiledMethod& method, std::uint32_t branch) const;
  std::string Where(const CompiledOperator& applied) const;

  static constexpr std::uint32_t kNotEntered = 0xffffffffu;

  const Program& program_;
  TermTable& terms_;
  const PlanRequest& request_;
  const bool left_recursion_;
  bool gave_up_recursion_{false};
  Bindings bindings_;
  Instantiator instances_;
  State state_;
  Network network_;
  Protections protections_;
  Visited visited_;
  Prover prover_;

  std::vector<const CompiledMethod*> root_methods_;
  std::vector<Frame> frames_;
  std::vector<Step> steps_;
  std::vector<Decomposition> decompositions_;
  std::vector<Term> tasks_, deletes_, adds_;  ///< scratch
  int depth_{0};
  double cost_{0.0};
  double best_cost_{std::numeric_limits<double>::infinity()};  ///< of the plans found
  std::uint64_t expansions_{0};
  std::size_t most_bytes_{0};
  Stop stop_{Stop::kContinue};
  bool enough_{false};
  bool too_deep_{false};
  bool too_dear_{false};
  Term protection_word_, failure_word_;
  Term lost_;  ///< protected fact that the last refused step would have broken
  std::vector<Plan> plans_;
  std::unordered_set<std::uint64_t> plan_keys_;
  std::deque<TraceEntry> trace_;
};

}  // namespace hires::planning
