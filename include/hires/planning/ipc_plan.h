#pragma once

#include <string>
#include <string_view>

#include "hires/planning/domain.h"
#include "hires/planning/plan.h"

namespace hires::planning {

/// A plan as the International Planning Competition 2020 wants it, with its decomposition:
///
///   ==>
///   0 drive dock t1                      primitive tasks as they are executed, without their `!`
///   root 1                               the problem's tasks
///   1 go t1 -> m_go 0                    task, method, subtasks
///   <==
///
/// An HDDL method goes by its name. One of SHOP2 goes by its name, with `/` and the branch's label
/// or number where it has several branches; without a name by the label of its branch where that
/// label is the only one among the task's methods, else by the task and a number: `get-money-2`,
/// `get-money-2/1`. Steps of bookkeeping (`!!x` prints as `!x`) are steps like others, arguments
/// that are lists print as Lisp.
std::string ToIpcPlan(const Domain& domain, const Plan& plan);

/// Reads such a plan, also one that another planner wrote: what stands before `==>` is skipped, ids
/// are any whole numbers, subtasks may come in any order that the method allows, and an artificial
/// root `__top` is taken off. Variables are bound as far as heads and subtasks determine them. A
/// task counts as decomposed when the first step below it is taken; one without steps, as soon as
/// all that must come before it is done. Costs are not evaluated: they are 0.
/// @param source  File, for messages.
/// @throws base::ConfigError naming source:line, what came and what was wanted: unknown tasks,
///   methods or ids, doubled ids, tasks in no decomposition or in two, subtasks that do not fit the
///   method or stand in another order. Whether the plan can be executed is for ValidatePlan.
Plan ReadIpcPlan(std::string_view text, const std::string& source, const Domain& domain,
                 const Problem& problem);

}  // namespace hires::planning
