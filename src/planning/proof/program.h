#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <unordered_map>
#include <vector>

#include "hires/planning/domain.h"
#include "hires/planning/functions.h"
#include "hires/planning/term.h"

namespace hires::planning {

/// A term with holes: variables of a clause are slots of a frame of bindings.
struct Pattern {
  enum class Kind : std::uint8_t { kConstant, kSlot, kPair, kCall };
  Kind kind{Kind::kConstant};
  Term constant;                    ///< kConstant
  std::uint32_t slot{0};            ///< kSlot
  const Pattern* head{nullptr};     ///< kPair
  const Pattern* tail{nullptr};     ///< kPair
  const Expression* call{nullptr};  ///< kCall: (call f arguments...) inside a term
};

/// One goal of a compiled condition. `next` is what has to hold besides.
struct Goal {
  enum class Kind : std::uint8_t {
    kAtom,
    kVariableGoal,
    kAnd,
    kOr,
    kNot,
    kImply,
    kEqual,
    kAssign,
    kAssignEach,
    kEval,
    kCollect
  };
  Kind kind{Kind::kAtom};
  bool bag{false};  ///< kCollect: keeps repetitions
  int number{0};    ///< place among the goals of its sequence, from 1
  const Goal* next{nullptr};
  Term predicate;                        ///< kAtom
  std::vector<const Pattern*> patterns;  ///< kAtom: arguments; kEqual: both; else what is bound
  std::vector<const Goal*> bodies;       ///< kAnd, kNot: one; kOr: each; kImply: if, then; kCollect
  const Expression* expression{nullptr};
  std::vector<std::uint32_t> slots;  ///< variables a kAnd, kOr or kImply may bind
  const Formula* source{nullptr};
};

struct CompiledPrecondition {
  Precondition::Order order{Precondition::Order::kAll};
  const Goal* goals{nullptr};  ///< null: always holds
  const Expression* sort_key{nullptr};
  const Functions::Entry* comparison{nullptr};
};

struct CompiledEffect {
  Effect::Kind kind{Effect::Kind::kAtom};
  const Pattern* pattern{nullptr};
  const Goal* condition{nullptr};
  std::vector<CompiledEffect> effects;
  const Effect* source{nullptr};
};

struct CompiledOperator {
  const Operator* source{nullptr};
  const Pattern* head{nullptr};  ///< of the whole task, name included
  std::uint32_t num_slots{0};
  std::uint32_t num_head_slots{0};  ///< the first ones: variables of the head
  CompiledPrecondition precondition;
  std::vector<CompiledEffect> deletes;
  std::vector<CompiledEffect> adds;
  const Expression* cost{nullptr};  ///< null: `fixed_cost`
  double fixed_cost{1.0};
  std::vector<std::string> variables;  ///< names of the slots
};

/// A task network ready to be laid out. Items are in the order of the file.
struct CompiledNetwork {
  struct Item {
    const Pattern* task{nullptr};  ///< null: `network`
    const CompiledNetwork* network{nullptr};
    bool immediate{false};
    std::vector<std::uint32_t> after;  ///< items that wait for this one
    std::uint32_t num_before{0};       ///< items that this one waits for
  };
  std::vector<Item> items;
  bool chain{false};               ///< totally ordered
  std::uint32_t num_first{0};      ///< tasks that could come first, at any depth
  bool first_is_immediate{false};  ///< one of those is marked so in the file
};

struct CompiledBranch {
  const Branch* source{nullptr};
  CompiledPrecondition precondition;
  const CompiledNetwork* subtasks{nullptr};
  CompiledPrecondition with_first_step;  ///< as Branch's; or the precondition
};

struct CompiledMethod {
  const Method* source{nullptr};
  int index{0};  ///< in Domain::methods
  const Pattern* head{nullptr};
  std::uint32_t num_slots{0};
  std::uint32_t num_head_slots{0};
  std::vector<CompiledBranch> branches;
  std::vector<std::string> variables;
  /// One reduction at most, the same in every state: it can as well be done at once.
  bool is_fixed{false};
};

struct CompiledAxiom {
  const Axiom* source{nullptr};
  std::vector<const Pattern*> head;  ///< arguments
  std::uint32_t num_slots{0};
  struct Branch {
    const Goal* goals{nullptr};
    bool first{false};
  };
  std::vector<Branch> branches;
};

/// A domain and a problem made ready for searching: names resolved, variables numbered, expressions
/// checked. Owns its parts; refers to the domain and problem it was made from.
class Program {
 public:
  /// @throws ConfigError naming file and line where they do not fit together.
  Program(const Domain& domain, const Problem& problem, const Functions& functions,
          TermTable* terms);

  const CompiledOperator* FindOperator(Term name) const;
  /// In the order in which they are tried; empty for an unknown task.
  const std::vector<const CompiledMethod*>& Methods(Term task_name) const;
  const std::vector<const CompiledAxiom*>& Axioms(Term predicate) const {
    return predicate.index() < axioms_.size() ? axioms_[predicate.index()] : no_axioms_;
  }

  const CompiledMethod& root() const { return root_; }  ///< the problem as a method without head
  const Goal* goal() const { return goal_; }            ///< must hold in the end; null: nothing
  std::uint32_t goal_slots() const { return goal_slots_; }
  const std::vector<Term>& facts() const { return facts_; }
  /// Names that nothing stands for, with their places: errors only where they are reached.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// Some tasks have no order among them.
  bool leaves_order_open() const;
  bool immediate_reductions() const { return domain_.language == Domain::Language::kShop2; }
  /// @throws ConfigError: place and text of the condition, then `what` is wrong with it.
  [[noreturn]] void Fail(const Formula& condition, const std::string& what) const;
  /// @throws ConfigError: nothing handles the task of that name, which was reached as `task`.
  [[noreturn]] void FailUnhandled(const std::string& name, const std::string& task) const;
  const Domain& domain() const { return domain_; }
  const Problem& problem() const { return problem_; }

 private:
  friend class Compiler;

  const Domain& domain_;
  const Problem& problem_;
  std::deque<Pattern> patterns_;
  std::deque<Goal> goals_;
  std::deque<Expression> expressions_;
  std::deque<Functions::Entry> unknown_comparisons_;
  std::vector<std::string> warnings_;
  std::deque<CompiledNetwork> networks_;
  std::deque<CompiledOperator> operators_;
  std::deque<CompiledMethod> methods_;
  std::deque<CompiledAxiom> axiom_store_;
  std::deque<Formula> formulas_;                                ///< made while compiling
  std::vector<const CompiledOperator*> operator_of_;            ///< by symbol
  std::vector<std::vector<const CompiledMethod*>> methods_of_;  ///< by symbol
  std::vector<std::vector<const CompiledAxiom*>> axioms_;       ///< by symbol
  std::vector<const CompiledAxiom*> no_axioms_;
  std::vector<const CompiledMethod*> no_methods_;
  CompiledMethod root_;
  Branch root_branch_;
  const Goal* goal_{nullptr};
  std::uint32_t goal_slots_{0};
  std::vector<Term> facts_;
};

}  // namespace hires::planning
