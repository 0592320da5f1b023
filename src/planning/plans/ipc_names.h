#pragma once

#include <string>

#include "hires/planning/domain.h"

namespace hires::planning {

/// What a plan in the competition's format calls a branch of a method; see ToIpcPlan.
/// @param method  Index into Domain::methods.  @param branch  Index into its branches.
std::string IpcMethodName(const Domain& domain, int method, int branch);

}  // namespace hires::planning
