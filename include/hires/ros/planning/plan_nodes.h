#pragma once

#include <hires/Plan.h>
#include <hires/PlanNode.h>

#include <vector>

#include "hires/planning/domain.h"
#include "hires/planning/plan.h"

/// How the tasks of a plan broke down, in messages.
namespace hires_ros {

std::vector<hires::PlanNode> NodesToMsg(const hires::planning::Plan& plan);

/// Gives `plan` the message's nodes, and its steps their places among them. A message without nodes
/// leaves the plan as it is.
/// @pre the plan has the message's steps.
/// @throws hires::base::ConfigError naming the node whose fields do not fit: indices of nodes,
///   steps, methods or branches that there are not, variables without values.
void AddNodes(const hires::Plan& message, const hires::planning::Domain& domain,
              hires::planning::Plan* plan);

}  // namespace hires_ros
