#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/verbs/doctor/doctor.h"
#include "cli/verbs/doctor/finding.h"
#include "cli/verbs/doctor/robot_needs.h"
#include "cli/verbs/doctor/robot_view.h"
#include "hires/robot/robot_profile.h"

/// `hires doctor --robot`: whether a running robot has all that our nodes need, and what to do
/// where not. It listens and asks; it publishes nothing and moves nothing.
namespace hires::cli {

/// All judgements on what was seen; what fails comes first. Nothing where all is well.
RobotFindings JudgeRobot(const RobotDoctorOptions& options, const RobotNeeds& needs,
                         const hires::robot::RobotProfile& profile, const RobotView& view);

/// Tables for people: what was heard, then the findings, each with what to do.
std::string RobotReport(const RobotNeeds& needs, const RobotView& view,
                        const RobotFindings& findings);
nlohmann::ordered_json RobotJson(const RobotNeeds& needs, const RobotView& view,
                                 const RobotFindings& findings);

/// Listens to the robot for some seconds.  @throws base::ConfigError if no master answers.
using LookAtRobot = std::function<RobotView(double seconds, const RobotNeeds& needs)>;

/// The whole verb.
/// @return 0 if nothing failed, else kExitBadInput.  @throws base::ConfigError.
int RunRobotDoctor(const RobotDoctorOptions& options, const std::string& package_folder,
                   const RobotMessageTypes& types, const LookAtRobot& look);

}  // namespace hires::cli
