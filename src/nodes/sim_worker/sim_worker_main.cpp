#include <ros/ros.h>

#include <cstdlib>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/evaluation/scenario_names.h"
#include "hires/ros/master/xmlrpc_master_api.h"
#include "hires/ros/node/launch_guard.h"
#include "hires/ros/node/log_sink.h"
#include "hires/ros/node/master_watch.h"
#include "hires/ros/node/private_params.h"
#include "nodes/sim_worker/sim_robot_node.h"
#include "nodes/sim_worker/sim_worker_node.h"

namespace {

using hires::imagination::LoadImaginationSetup;

void Work(ros::NodeHandle* nh) {
  const hires_ros::SimWorkerParams params = hires_ros::LoadSimWorkerParams();
  hires_ros::SimWorkerNode node(params, LoadImaginationSetup(params.setup), nh);
  ros::spin();
}

/// The Blackboard, which reads the knowledge files as well, does not know of the scenario.
void WarnOfNames(const std::string& path) {
  if (path.empty()) return;
  const auto scenario = hires::evaluation::ReadScenario(path);
  for (const auto& misfit : NamesThatDoNotFit(scenario, path, scenario.task)) {
    hires::base::Log(hires::base::LogLevel::kWarn, misfit);
  }
}

void PlayRobot(ros::NodeHandle* nh) {
  const hires_ros::SimRobotParams params = hires_ros::LoadSimRobotParams();
  WarnOfNames(params.scenario);
  hires_ros::SimRobotNode node(params, LoadImaginationSetup(params.setup), nh);
  ros::spin();
}

/// A worker plays rollouts under a master of its own; the robot is the one that is real to the
/// rest.
bool IsRobot() {
  std::string role = "worker";
  hires_ros::Override("role", hires_ros::PrivateText("role"),
                      hires::base::OneOf({"worker", "robot"}), &role);
  return role == "robot";
}

}  // namespace

int main(int argc, char** argv) {
  hires_ros::QuietXmlRpc();
  ros::init(argc, argv, "sim_worker", ros::init_options::NoSigintHandler);
  hires_ros::ShutDownRosOnSignals();
  if (!hires_ros::ClaimName()) return EXIT_FAILURE;
  ros::NodeHandle nh;
  const hires_ros::ScopedLogSink log_sink;
  try {
    if (IsRobot()) {
      PlayRobot(&nh);
    } else {
      Work(&nh);
    }
  } catch (const hires::base::ConfigError& error) {
    return hires_ros::EndMisconfigured("sim_worker", error);
  }
  return EXIT_SUCCESS;
}
