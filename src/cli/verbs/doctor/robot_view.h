#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/verbs/doctor/network_probe.h"
#include "hires/relay/uri.h"

/// What `hires doctor --robot` saw of a robot.
namespace hires::cli {

/// What one node sent on one topic.
struct SeenMessages {
  std::string type, md5;     ///< of the connection
  int count{0};              ///< that came
  double first{0.0};         ///< [s] steady, when the first came
  double last{0.0};          ///< [s] steady, when the last came
  std::vector<double> ages;  ///< [s] from the stamp to the arrival; only of types with a header

  double rate() const;                ///< [Hz] 0: fewer than two came
  std::optional<double> age() const;  ///< [s] the median; nothing where there are no stamps
};

struct SeenTopic {
  std::string type;  ///< by the master; empty: unknown
  std::set<std::string> publishers, subscribers;
  std::map<std::string, SeenMessages> messages;           ///< by publisher
  std::map<std::string, Reach> data_ports;                ///< by publisher
  std::map<std::string, hires::relay::Endpoint> data_at;  ///< by publisher
};

struct SeenNode {
  std::string uri;
  Reach reach{Reach::kAnswers};
  std::string host() const;  ///< of the URI, as it is written there; empty if it is not a URI
};

struct SeenFrame {
  std::set<std::string> parents;
  double age{0.0};  ///< [s] of the newest transform; negative: it holds for some time to come
  bool is_static{false};
};

struct RobotView {
  std::string master_uri;
  bool uses_sim_time{false};
  double seconds{0.0};  ///< how long messages were waited for
  std::map<std::string, SeenTopic> topics;
  std::set<std::string> services;
  std::map<std::string, SeenNode> nodes;
  std::map<std::string, SeenFrame> frames;  ///< by child
  std::set<std::string> joints;
  std::optional<bool> motors_halted;
  std::optional<std::set<std::string>> planner_parameters;
  bool has_robot_description{false};
  hires::relay::HostNames this_host;  ///< names and addresses of this computer
  std::string own_host;               ///< by which others are told to find this computer's nodes
  std::optional<std::string> own_address;  ///< of this computer towards the master
  std::map<std::string, std::vector<std::string>> addresses;  ///< by host of a URI
  std::map<std::string, ClockBounds> clocks;  ///< by host, of those that tell the time
  std::optional<bool> is_heard;  ///< whether the log collector got through to this computer's node

  const SeenTopic* FindTopic(const std::string& name) const;
  /// Whether a host of a URI is this computer.
  bool IsHere(const std::string& host) const;
};

}  // namespace hires::cli
