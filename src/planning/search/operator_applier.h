#pragma once

#include <cstdint>

#include "hires/planning/planner.h"
#include "hires/planning/term.h"
#include "planning/proof/program.h"
#include "planning/search/found_plans.h"
#include "planning/search/search_limits.h"
#include "planning/search/search_path.h"
#include "planning/search/search_trace.h"
#include "planning/search/state_update.h"
#include "planning/search/step_effects.h"

namespace hires::planning {

/// Carries out primitive tasks: one binding of the operator's precondition, its cost, its effects.
class OperatorApplier {
 public:
  OperatorApplier(const Program& program, const PlanRequest& request, SearchPath* path,
                  SearchLimits* limits, const FoundPlans* plans, SearchTrace* trace);

  /// One step further. False: the task of `node` cannot be carried out now.
  /// @throws ConfigError where the domain has no such operator, or a negative cost spoils the
  /// search
  ///   for the cheapest plan.
  bool Apply(std::uint32_t node);

 private:
  const CompiledOperator& OperatorOf(Term task) const;
  bool Bind(const CompiledOperator& applied, std::uint32_t variables, Term task);
  bool FindBinding(const CompiledPrecondition& precondition, std::uint32_t variables,
                   std::uint32_t slots);
  bool IsExcluded(Term task) const;
  double CostOf(const CompiledOperator& applied, std::uint32_t variables) const;

  const Program& program_;
  const PlanRequest& request_;
  SearchPath& path_;
  SearchLimits& limits_;
  const FoundPlans& plans_;
  SearchTrace& trace_;
  StepEffects effects_;
  StateUpdate update_;
  const Term failure_word_;
};

}  // namespace hires::planning
