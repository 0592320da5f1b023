#pragma once

#include <string>
#include <utility>
#include <vector>

#include "hires/planning/datum.h"

namespace hires::planning {

/// A ground atom that holds, or that does not. A negative one may keep variables, all distinct in
/// meaning: "no fact matches".
struct Literal {
  Datum atom;
  bool holds{true};
};
bool operator==(const Literal& a, const Literal& b);

/// Why a precondition of a step holds when the step comes.
struct CausalLink {
  static constexpr int kInitial = -1;
  int producer{kInitial};  ///< index of the step that last made it so, or kInitial
  Literal literal;         ///< as listed among the preconditions of the step that carries the link
};

/// One primitive step with all that it rests on.
struct PlanStep {
  Datum task;                          ///< (!operator arguments...), ground
  std::vector<Literal> preconditions;  ///< facts that its precondition was proven with
  std::vector<Datum> deletes;          ///< atoms it really takes away, in the state it comes to
  std::vector<Datum> adds;             ///< atoms it really adds or keeps
  double cost{0.0};
  int node{0};                    ///< its place in the decomposition, index into Plan::nodes
  std::vector<CausalLink> links;  ///< one per precondition
  std::vector<std::pair<std::string, Datum>> bindings;  ///< of variables not in its head
  /// Patterns of facts that decide what the step does beside its links: what it negates or
  /// quantifies over, conditions of its effects, deletes that found nothing, atoms that it protects
  /// (:protection atom) or protects no more (:unprotection atom). Filled in by AddReasons, used by
  /// PartialOrder: a step that changes a match stays on its side.
  std::vector<Datum> reads;
};

/// A task and what became of it. Node 0 is the root: it has no task, its children are the
/// problem's.
struct PlanNode {
  Datum task;  ///< ground as far as it ever became so
  int parent{-1};
  std::vector<int> children;  ///< in the order of the method's subtasks
  int step{-1};               ///< of a primitive task: index into Plan::steps
  int method{-1};             ///< of another: index into Domain::methods
  int branch{-1};             ///< and of the branch taken
  std::string label;          ///< branch label, else method name, else ""
  int at_step{0};             ///< number of steps that had been taken when it was decomposed
  std::vector<std::pair<std::string, Datum>> bindings;  ///< of variables not in the head
};

/// A plan, its reasons and its decomposition.
struct Plan {
  std::vector<PlanStep> steps;
  std::vector<PlanNode> nodes;
  double cost{0.0};
  /// Steps (before, after) that methods and problem order, where the domain keeps that
  /// (Domain::subtask_order); what follows from others may be left out. Filled in by AddReasons,
  /// used by PartialOrder.
  std::vector<std::pair<int, int>> subtask_order;
};

/// Names of the tasks above a step, the root's first: "serve_coffee/move_object/put_object". Empty
/// for a step that the problem itself asks for.
/// @pre `step` is an index into plan.steps.  @throws std::logic_error if broken.
std::string DecompositionPath(const Plan& plan, int step);

/// One ground operator a line, as SHOP writes plans: "(!pickup kiwi)\n".
std::string ToShop2Plan(const Plan& plan);

}  // namespace hires::planning
