#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/drive_log.h"
#include "cli/verbs/blackboard/blackboard_command.h"
#include "cli/verbs/doctor/doctor.h"
#include "cli/verbs/imagine/imagine_query.h"
#include "loop/achieve.h"
#include "loop/loop_observer.h"

namespace hires::cli {

/// A verb that another layer adds: name, one line of help, and what to do with its arguments.
struct Verb {
  std::string name;
  std::string help;
  std::function<int(const std::vector<std::string>& arguments)> run;
};

/// What the program can do beyond this process; all may be empty.
struct Backends {
  std::string package_folder;  ///< where config/, worlds/, urdf/ lie
  ImagineRemotely imagine_remotely;
  ConnectBlackboard connect_blackboard;
  loop::AchieveRemotely achieve_remotely;
  /// File of the domain that the running execution monitor was given; "": none runs, or none was.
  std::function<std::string()> domain_of_monitor;
  loop::RecordLoop record_loop;  ///< empty: this program writes no bags
  MakeRolloutBag make_rollout_bag;
  ExamineRobot examine_robot;
  ReadDriveBag read_drive_bag;  ///< empty: this program reads no bags
  std::vector<Verb> more_verbs;
  std::vector<Check> more_checks;
};

/// The program `hires`: parses, runs one verb, prints. Never throws.
/// @param arguments  the program's name first, as in argv.
int RunCommandLine(const std::vector<std::string>& arguments, const Backends& backends);

}  // namespace hires::cli
