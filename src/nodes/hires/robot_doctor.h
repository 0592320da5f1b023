#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hires/cli/doctor.h"
#include "hires/robot/robot_profile.h"
#include "nodes/hires/robot_doctor_view.h"
#include "nodes/hires/robot_finding.h"

/// `hires doctor --robot`: whether a running robot has all that our nodes need, and what to do
/// where not. It listens and asks; it publishes nothing and moves nothing.
namespace hires_ros {

/// All judgements on what was seen; what fails comes first. Nothing where all is well.
RobotFindings JudgeRobot(const hires::cli::RobotDoctorOptions& options,
                         const hires::control::RobotNames& names,
                         const hires::robot::RobotProfile& profile, const RobotView& view);

/// Tables for people: what was heard, then the findings, each with what to do.
std::string RobotReport(const hires::control::RobotNames& names, const RobotView& view,
                        const RobotFindings& findings);
nlohmann::ordered_json RobotJson(const hires::control::RobotNames& names, const RobotView& view,
                                 const RobotFindings& findings);

/// The whole verb.
/// @return 0 if nothing failed, else kExitBadInput.  @throws hires::base::ConfigError.
int ExamineRobot(const hires::cli::RobotDoctorOptions& options, const std::string& package_folder);

}  // namespace hires_ros
