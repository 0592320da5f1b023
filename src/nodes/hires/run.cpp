#include "nodes/hires/run.h"

#include <ros/init.h>
#include <ros/package.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "cli/command_line.h"
#include "cli/verbs/doctor/robot_doctor.h"
#include "hires/ros/imagination/rollout_bag.h"
#include "hires/ros/node/launch_guard.h"
#include "nodes/hires/drive_bag.h"
#include "nodes/hires/episode_writer.h"
#include "nodes/hires/message_types.h"
#include "nodes/hires/remote_achieve.h"
#include "nodes/hires/remote_blackboard.h"
#include "nodes/hires/remote_imagination.h"
#include "nodes/hires/replay.h"
#include "nodes/hires/robot_doctor_look.h"
#include "nodes/hires/ros_doctor.h"
#include "nodes/hires/watch.h"

namespace hires_ros {

/// For launch files: what went well ends the launch that started it. A `required` node would end
/// it, too, but roslaunch calls that a death.
constexpr char kEndLaunch[] = "--end-launch";

int RunHiresNode(int argc, char** argv) {
  std::vector<std::string> arguments;  // roslaunch adds names and remappings that are not ours
  ros::removeROSArgs(argc, argv, arguments);
  hires::cli::Backends backends;
  backends.package_folder = ros::package::getPath("hires");
  backends.imagine_remotely = ImagineRemotely;
  backends.achieve_remotely = AchieveRemotely;
  backends.domain_of_monitor = DomainOfMonitor;
  backends.connect_blackboard = ConnectBlackboard;
  backends.record_loop = [&](const std::string& path) {
    return MakeEpisodeWriter(path, backends.package_folder);
  };
  backends.make_rollout_bag = MakeRolloutBag;
  backends.read_drive_bag = ReadDriveBag;
  backends.examine_robot = [&](const hires::cli::RobotDoctorOptions& options) {
    return hires::cli::RunRobotDoctor(options, backends.package_folder, MessageTypesOfRobot(),
                                      LookAtRobot);
  };
  backends.more_verbs.push_back({"replay",
                                 "imagine the steps of a recorded robot episode, or recorded "
                                 "requests again, and compare: BAG [--local [--threads N]] "
                                 "[--json FILE] [--requests]",
                                 [&](const std::vector<std::string>& words) {
                                   return RunReplay(words, backends.package_folder);
                                 }});
  backends.more_verbs.push_back(
      {"watch", "look at a saved rollout in RViz, with keys to pause and seek: BAG [--no-rviz]",
       [&](const std::vector<std::string>& words) {
         return RunWatch(words, backends.package_folder);
       }});
  backends.more_checks.push_back(CheckRos);
  const auto end_launch = std::find(arguments.begin(), arguments.end(), kEndLaunch);
  const bool ends_launch = end_launch != arguments.end();
  if (ends_launch) arguments.erase(end_launch);
  const int code = hires::cli::RunCommandLine(arguments, backends);
  if (ends_launch && code == EXIT_SUCCESS) EndLaunch();
  return code;
}

}  // namespace hires_ros
