#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/execution/monitor.h"

namespace hires::execution {

/// What a request to imagine says beside the action and its state.
struct ImaginingParams {
  int rollouts{400};    ///< per combination of alternatives, at most
  std::string ranking;  ///< "cost", "risk", "thesis"; empty: imagination's own default
  std::uint64_t seed{1};
};

/// How long the monitor's servers are waited for, [s] steady.
struct ServerParams {
  double server_wait{2.0};   ///< to be there, and to take a goal
  double server_loss{0.5};   ///< without connection, after which its goals are lost
  double silence{5.0};       ///< without a word, in main ROS time, too: it hangs
  double cancel_wait{10.0};  ///< for a cancelled goal to end, in main ROS time, too
};

/// config/execution_monitor.yaml.
struct MonitorConfig {
  std::string domain;                 ///< path
  std::string operators;              ///< path of the domain's sidecar
  std::vector<std::string> ontology;  ///< paths
  std::string robot;  ///< path; its motion sets order defaults that the sidecar leaves out
  MonitorParams monitor;
  ImaginingParams imagining;
  ServerParams servers;
  double start_wait{30.0};      ///< [s] steady, for all that a task needs to begin
  double feedback_period{0.2};  ///< [s] steady
  double pose_distance{0.02};   ///< [m] that counts as moved
  double pose_angle{0.1};       ///< [rad] likewise
};

base::Bound<std::string> ImaginePolicyWord();
/// "domain", "thesis", "off".  @throws base::ConfigError that names these.
MonitorParams::ImaginePolicy ReadImaginePolicy(const std::string& word);

/// Reads "motion_set=fast,spot=any" for MonitorParams::defaults; "" is none.
/// @throws base::ConfigError naming each entry that is not PARAMETER=VALUE, or whose parameter no
/// operator of the domain imagines.
std::map<std::string, std::string> ReadDefaults(const std::string& text,
                                                const planning::OperatorData& operators);

/// Relative paths count from the folder of the file.
/// @throws base::ConfigError naming file and key.
MonitorConfig ReadMonitorConfig(const std::string& path);

}  // namespace hires::execution
