#include "hires/ros/node/run_node.h"

#include <fmt/format.h>
#include <ros/exceptions.h>
#include <ros/init.h>

#include <cstdlib>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/ros/master/xmlrpc_master_api.h"
#include "hires/ros/node/launch_guard.h"
#include "hires/ros/node/log_sink.h"
#include "hires/ros/node/master_watch.h"

namespace hires_ros {
namespace {

constexpr double kClockWait = 20.0;  // [s] simulators may start as late

/// Such a node hangs: no timer comes due, and no transform is of now.
ros::WallTimer WarnOfMissingClock(ros::NodeHandle* nh) {
  const auto look = [](const ros::WallTimerEvent& /*event*/) {
    if (ros::Time::isValid()) return;
    hires::base::Log(
        hires::base::LogLevel::kWarn,
        fmt::format("/use_sim_time is true, and nobody publishes /clock since {} s: this node "
                    "waits for it; start what simulates or replays the time (rosbag play --clock), "
                    "or set use_sim_time false and start the nodes again",
                    kClockWait));
  };
  constexpr bool kOnce = true;
  return nh->createWallTimer(ros::WallDuration(kClockWait), ros::WallTimerCallback(look), kOnce);
}

}  // namespace

int RunNode(const std::string& name, int argc, char** argv,
            const std::function<void(ros::NodeHandle*)>& play, OnStopSignal on_stop) {
  QuietXmlRpc();
  ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  if (on_stop == OnStopSignal::kNote) {
    NoteStopSignals();
  } else {
    ShutDownRosOnSignals();
  }
  if (!ClaimName()) return EXIT_FAILURE;
  ros::NodeHandle nh;
  MasterWatch master_watch;
  const ScopedLogSink log_sink;
  const ros::WallTimer clock_watch = WarnOfMissingClock(&nh);
  try {
    play(&nh);
  } catch (const hires::base::ConfigError& error) {
    return EndMisconfigured(name, error);
  } catch (
      const ros::InvalidNameException& error) {  // of a topic or server, by a file or parameter
    return EndMisconfigured(name, hires::base::ConfigError(error.what()));
  }
  return master_watch.Finish(EXIT_SUCCESS);
}

}  // namespace hires_ros
