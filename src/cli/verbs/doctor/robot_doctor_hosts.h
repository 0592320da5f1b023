#pragma once

#include "cli/verbs/doctor/finding.h"
#include "cli/verbs/doctor/robot_view.h"

/// Judgements on the network and the clocks between the computers of a robot, by the codes of their
/// findings; nothing where all is well.
namespace hires::cli {

/// own_loopback, loopback, unresolvable, node_gone, node_unreachable, data_unreachable, not_heard.
RobotFindings JudgeHosts(const RobotView& view);
/// clock_skew, clock_unsure.
RobotFindings JudgeClocks(const RobotView& view);

}  // namespace hires::cli
