#include "nodes/sim_worker/run.h"

#include <ros/ros.h>

#include <cstdlib>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/ros/master/xmlrpc_master_api.h"
#include "hires/ros/node/launch_guard.h"
#include "hires/ros/node/log_sink.h"
#include "hires/ros/node/master_watch.h"
#include "hires/ros/node/private_params.h"
#include "nodes/sim_worker/sim_robot_node.h"
#include "nodes/sim_worker/sim_worker_node.h"
#include "sim_robot/scenario_names.h"

namespace hires_ros {
namespace {

using hires::imagination::LoadImaginationSetup;

void Work(ros::NodeHandle* nh) {
  const SimWorkerParams params = LoadSimWorkerParams();
  SimWorkerNode node(params, LoadImaginationSetup(params.setup), nh);
  ros::spin();
}

/// The Blackboard, which reads the knowledge files as well, does not know of the scenario.
void WarnOfNames(const std::string& path) {
  if (path.empty()) return;
  const auto scenario = hires::sim_robot::ReadScenario(path);
  for (const auto& misfit : NamesThatDoNotFit(scenario, path, scenario.task)) {
    hires::base::Log(hires::base::LogLevel::kWarn, misfit);
  }
}

void PlayRobot(ros::NodeHandle* nh) {
  const SimRobotParams params = LoadSimRobotParams();
  WarnOfNames(params.scenario);
  SimRobotNode node(params, LoadImaginationSetup(params.setup), nh);
  ros::spin();
}

/// A worker plays rollouts under a master of its own; the robot is the one that is real to the
/// rest.
bool IsRobot() { return PrivateWord("role", hires::base::OneOf({"worker", "robot"})) == "robot"; }

}  // namespace

int RunSimWorkerNode(int argc, char** argv) {
  QuietXmlRpc();
  ros::init(argc, argv, "sim_worker", ros::init_options::NoSigintHandler);
  ShutDownRosOnSignals();
  if (!ClaimName()) return EXIT_FAILURE;
  ros::NodeHandle nh;
  const ScopedLogSink log_sink;
  try {
    if (IsRobot()) {
      PlayRobot(&nh);
    } else {
      Work(&nh);
    }
  } catch (const hires::base::ConfigError& error) {
    return EndMisconfigured("sim_worker", error);
  }
  return EXIT_SUCCESS;
}

}  // namespace hires_ros
