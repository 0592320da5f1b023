#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli/exit_code.h"
#include "cli/verbs/blackboard/blackboard_command.h"
#include "cli/verbs/doctor/doctor.h"
#include "cli/verbs/doctor/finding.h"
#include "cli/verbs/imagine/imagine_start.h"
#include "hires/base/action.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/imagination/report.h"
#include "hires/imagination/rollout_recording.h"
#include "hires/imagination/scheduler.h"
#include "hires/imagination/validated.h"
#include "hires/localisation/robot_log.h"
#include "hires/sensing/drive_builder.h"
#include "loop/achieve.h"
#include "loop/loop_observer.h"

namespace hires::cli {

/// What `hires imagine` was asked.
struct ImagineQuery {
  base::ActionTemplate action;
  ImagineStart start;
  std::uint64_t seed{1};
  imagination::SchedulerParams scheduler;
  imagination::SetupConfig setup;
  imagination::Validated validated;
  bool own_scene{false};        ///< files were named that the workers may not have
  bool own_uncertainty{false};  ///< an uncertainty was named that the workers may not have
  int threads{1};
};

/// Answers a query through running nodes instead of in this process.
using ImagineRemotely = std::function<imagination::Report(
    const ImagineQuery&, const imagination::OnInterim&, const std::function<bool()>& cancelled)>;

/// A verb that another layer adds: name, one line of help, and what to do with its arguments.
struct Verb {
  std::string name;
  std::string help;
  std::function<int(const std::vector<std::string>& arguments)> run;
};

/// A check of `hires doctor` that another layer adds.
using Check = std::function<std::vector<Finding>()>;

/// Makes what saves a rollout of this setup as a bag.
using MakeRolloutBag = std::function<std::unique_ptr<imagination::RolloutSaver>(
    const std::string& path, const imagination::RolloutSetup& setup)>;

/// Reads a drive from a bag.  @throws base::ConfigError naming the bag and what is wrong with it.
using ReadDriveBag = std::function<localisation::RobotLog(const std::string& path,
                                                          const sensing::DriveSource& source)>;

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

int ExitCodeOf(const imagination::Report& report);

/// The program `hires`: parses, runs one verb, prints. Never throws.
/// @param arguments  the program's name first, as in argv.
int RunCommandLine(const std::vector<std::string>& arguments, const Backends& backends);

/// What an object is called that was typed by its name or as a file, which is then loaded beside
/// the catalogue's and called by its model.  @throws base::ConfigError as world::LoadObjectModel.
std::string NameOf(const std::string& object, imagination::SetupConfig* setup);

}  // namespace hires::cli
