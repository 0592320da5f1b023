#pragma once

#include "cli/verbs/doctor/finding.h"
#include "cli/verbs/doctor/robot_needs.h"
#include "cli/verbs/doctor/robot_view.h"
#include "hires/robot/robot_profile.h"

/// Judgements on what a robot publishes and listens to, by the codes of their findings; nothing
/// where all is well.
namespace hires::cli {

/// topic_missing, topic_type, topic_silent, topic_slow, topic_stale, topic_future,
/// sim_time.
RobotFindings JudgeTopics(const RobotNeeds& needs, const RobotView& view);
/// listener_missing, listener_type.
RobotFindings JudgeListeners(const RobotNeeds& needs, const RobotView& view);
/// frame_missing, frame_stale, frame_two_parents, link_missing.
RobotFindings JudgeFrames(const RobotNeeds& needs, const hires::robot::RobotProfile& profile,
                          const RobotView& view);
/// joint_missing; nothing while there are no joint states at all, which is another's finding.
RobotFindings JudgeJoints(const hires::robot::RobotProfile& profile, const RobotView& view);
/// motors_halted, robot_description_missing.
RobotFindings JudgeReadiness(const hires::control::RobotNames& names, const RobotView& view);
/// move_base_missing, planner_missing, planner_silent, planner_parameter_missing,
/// move_base_unguarded.
/// @param is_needed  what it lacks is a failure, not a warning.
RobotFindings JudgeMoveBase(const hires::control::RobotNames& names, const RobotView& view,
                            bool is_needed);

}  // namespace hires::cli
