#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/report_output.h"
#include "cli/verbs/doctor/file_doctor.h"
#include "cli/verbs/doctor/finding.h"

namespace CLI {
class App;
}

namespace hires::cli {

/// `hires doctor --robot`.
struct RobotDoctorOptions {
  std::string names;       ///< file; empty: config/robots/pr2_names.yaml
  std::string profile;     ///< file; empty: config/robots/pr2.yaml
  std::string navigation;  ///< move_base, own; empty: not decided, so that what the first lacks is
                           ///< a warning
  double seconds{3.0};     ///< [s] to listen
  ReportOptions report;    ///< without --robot, too
};

/// Looks at a running robot.  @return Exit code.  @throws base::ConfigError.
using ExamineRobot = std::function<int(const RobotDoctorOptions&)>;

/// A check of `hires doctor` that another layer adds.
using Check = std::function<std::vector<Finding>()>;

/// What `hires doctor` can do beyond this process.
struct DoctorBackends {
  std::string package_folder;  ///< where config/, worlds/, urdf/ lie
  ExamineRobot examine_robot;  ///< may be empty
  std::vector<Check> more_checks;
};

/// What was typed behind `hires doctor`.
struct DoctorOptions {
  bool is_without_physics{false};  ///< what the machine has is looked at alone
  RobotDoctorOptions robot;
  FileDoctorOptions files;
  CLI::App* verb{nullptr};
};

/// Adds the verb to the program.  @pre `options` outlives `app`.
void AddDoctorVerb(CLI::App* app, DoctorOptions* options);

/// `hires doctor`: looks at the package's files and the machine, then compares the physics with
/// closed forms. Prints one line per check with what to do where it failed. With --robot it looks
/// at a running robot instead; with --world or --map at these files, and --robot names one.
/// @return 0 if all passed, else kExitBadInput.
/// @throws base::ConfigError for --robot where there are no ROS nodes to ask, and for a file of a
/// robot without a world.
int RunDoctorVerb(const DoctorOptions& options, const DoctorBackends& backends);

}  // namespace hires::cli
