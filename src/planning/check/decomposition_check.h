#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/planning/domain.h"
#include "hires/planning/fact_history.h"
#include "hires/planning/plan.h"
#include "hires/planning/reference_prover.h"

namespace hires::planning {

/// The tasks of a network and of the networks in it, in the order of listing.
std::vector<const TaskItem*> LeavesOf(const TaskNetwork& network);

/// Nodes from the root on, parents before children. Ends on any plan whose children exist.
std::vector<int> NodesFromRoot(const Plan& plan);

/// "node 7 (move a b)"
std::string NodeText(const Plan& plan, int node);

/// Whether the nodes of a plan form a tree whose leaves are its steps. The other checks need that.
std::vector<std::string> CheckTree(const Plan& plan);

/// Checks how the tasks of a plan were decomposed. @pre CheckTree found nothing.
class DecompositionCheck {
 public:
  /// @param facts     Of all moments of the plan.
  /// @param windowed  Take any moment for a method's precondition at which the task could have been
  ///   decomposed, instead of the recorded one.
  DecompositionCheck(const Domain& domain, const Problem& problem, const Plan& plan,
                     const FactHistory& facts, bool windowed, ReferenceProver* prover);

  std::vector<std::string> Run();

 private:
  /// When a node was worked on, in numbers of steps taken.
  struct Span {
    int first_step{-1};  ///< below it; -1: none
    int begin{-1};       ///< decomposed or executed; -1: not known
    int end{-1};         ///< everything below it is done; -1: not known
    int ready{0};        ///< all that it waits for is done
    bool immediate{false};
  };

  /// A decomposition with its variables bound as the plan tells.
  struct Reading {
    Substitution values;  ///< by record, head and children
    ValueMap known;       ///< of the head's variables, for the precondition
    ValueMap expected;    ///< of the others
    bool fits{true};
  };

  void FindOrder();
  void FindSpans();
  void FindReadiness(int node);
  int Walk(const TaskNetwork& network, int ready, const std::vector<int>& children,
           std::size_t first_leaf);
  void MarkImmediate(int node, const std::vector<const TaskItem*>& leaves);

  void CheckNode(int node);
  void CheckMethod(int node, const Method& method);
  void CheckRoot();
  Reading Read(int node, const Datum* head, const std::vector<const TaskItem*>& leaves);
  void ReadRecord(int node, Reading* reading) const;
  void ReadChild(int node, int child, const TaskItem& item, Reading* reading);
  void Fill(int node, const Datum* head, const Precondition& precondition, Reading* reading) const;
  void CheckPrecondition(int node, const Branch& branch, const Reading& reading);
  void CheckEarlierBranches(int node, const Method& method, const Reading& reading);
  Datum SubtaskAsItCame(int parent, const Datum& task_of_parent, std::size_t place);
  Datum TaskAsItCame(int node);
  ValueMap HeadAsItCame(int node, const Method& method, const ValueMap& known);
  void CheckOrder(int node);
  void CheckImmediate(int node);
  bool Holds(const Precondition& precondition, int moment, const ValueMap& known,
             const ValueMap& expected);
  const TaskNetwork* NetworkOf(int node) const;
  const Precondition& PreconditionOf(int node) const;  ///< @pre it has a network
  void Report(int node, const std::string& text);

  const Domain& domain_;
  const Problem& problem_;
  const Plan& plan_;
  const FactHistory& facts_;
  bool windowed_;
  ReferenceProver& prover_;
  std::vector<int> order_;  ///< nodes, parents before children
  std::vector<Span> spans_;
  std::vector<std::string> wrong_;
};

}  // namespace hires::planning
