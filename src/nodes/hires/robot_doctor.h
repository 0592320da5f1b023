#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hires/cli/doctor.h"
#include "hires/robot/robot_profile.h"
#include "nodes/hires/robot_doctor_view.h"
#include "nodes/hires/ros_doctor.h"

/// `hires doctor --robot`: whether a running robot has all that our nodes need, and what to do
/// where not. It listens and asks; it publishes nothing and moves nothing.
namespace hires_ros {

struct RobotFinding {
  FindingLevel level{FindingLevel::kFailed};
  std::string code;     ///< one word for programs: "topic_missing"
  std::string subject;  ///< "topic /base_scan"
  std::string text;     ///< what is
  std::string remedy;   ///< what to do
};
using RobotFindings = std::vector<RobotFinding>;

// Judgements on what was seen; nothing where all is well.

/// topic_missing, topic_type, topic_silent, topic_slow, topic_stale, topic_future,
/// sim_time.
RobotFindings JudgeTopics(const hires::control::RobotNames& names, const RobotView& view);
/// listener_missing, listener_type.
RobotFindings JudgeListeners(const hires::control::RobotNames& names, const RobotView& view);
/// frame_missing, frame_stale, frame_two_parents, link_missing.
RobotFindings JudgeFrames(const hires::control::RobotNames& names,
                          const hires::robot::RobotProfile& profile, const RobotView& view);
/// joint_missing; nothing while there are no joint states at all, which is another's finding.
RobotFindings JudgeJoints(const hires::robot::RobotProfile& profile, const RobotView& view);
/// motors_halted, robot_description_missing.
RobotFindings JudgeReadiness(const hires::control::RobotNames& names, const RobotView& view);
/// move_base_missing, planner_missing, planner_silent, planner_parameter_missing,
/// move_base_unguarded.
/// @param is_needed  what it lacks is a failure, not a warning.
RobotFindings JudgeMoveBase(const hires::control::RobotNames& names, const RobotView& view,
                            bool is_needed);
/// own_loopback, loopback, unresolvable, node_gone, node_unreachable, data_unreachable, not_heard.
RobotFindings JudgeHosts(const RobotView& view);
/// clock_skew, clock_unsure.
RobotFindings JudgeClocks(const RobotView& view);

/// All of them, what fails first.
RobotFindings JudgeRobot(const hires::cli::RobotDoctorOptions& options,
                         const hires::control::RobotNames& names,
                         const hires::robot::RobotProfile& profile, const RobotView& view);

/// Listens for options.seconds.
/// @throws hires::base::ConfigError if no master answers.
RobotView LookAtRobot(const hires::cli::RobotDoctorOptions& options,
                      const hires::control::RobotNames& names);

/// Tables for people: what was heard, then the findings, each with what to do.
std::string RobotReport(const hires::control::RobotNames& names, const RobotView& view,
                        const RobotFindings& findings);
nlohmann::ordered_json RobotJson(const hires::control::RobotNames& names, const RobotView& view,
                                 const RobotFindings& findings);

/// The whole verb.
/// @return 0 if nothing failed, else kExitBadInput.  @throws hires::base::ConfigError.
int ExamineRobot(const hires::cli::RobotDoctorOptions& options, const std::string& package_folder);

}  // namespace hires_ros
