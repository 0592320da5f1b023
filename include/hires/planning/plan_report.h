#pragma once

#include <string>

#include "hires/planning/planner.h"

namespace hires::planning {

/// "1 plan, 16 steps, cost 16", "there is no plan; every way was tried", "stopped at the time limit
/// with 2 plans, ...": the outcome for people. The most important words come first.
std::string OutcomeSentence(const PlanResult& result, Which which);

/// "first", "all", "best".  @throws base::ConfigError that names them for anything else.
Which ParseWhich(const std::string& text);

}  // namespace hires::planning
