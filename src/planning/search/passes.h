#pragma once

#include "hires/planning/planner.h"
#include "planning/proof/program.h"

namespace hires::planning {

/// Plans of an HDDL domain, of which any may be given: by searches that leave ways out at first and
/// take more and more of them in. The competition's domains are full of tasks that come up below
/// themselves, from which a search from left to right may never come back, and of tasks without an
/// order, whose interleavings nobody can go through. So where one plan is wanted, tasks are done
/// one after the other at first; the same question is asked with interleaving now and then, with
/// budgets that grow. What was left out for its recursion is gone into where nothing else leads to
/// a plan, or more plans are wanted: where steps were taken in between, then once below itself,
/// twice, four times, ...
PlanResult FindHddlPlans(const Program& program, TermTable* terms, const PlanRequest& request);

}  // namespace hires::planning
