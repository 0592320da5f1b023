#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hires/control/robot_names.h"
#include "hires/relay/uri.h"
#include "hires/robot/robot_profile.h"
#include "nodes/hires/doctor_probe.h"

/// What `hires doctor --robot` wants of a robot, and what it saw of one.
namespace hires_ros {

/// A topic that some node must publish for our nodes to work.
struct WantedTopic {
  std::string what;  ///< "odometry"
  std::string name;  ///< "/base_odometry/odom"
  std::string type;  ///< "nav_msgs/Odometry"
  std::string md5;
  bool is_stamped{false};  ///< its messages begin with a header
  double min_rate{0.0};    ///< [Hz] below which a motion is not safe; 0: comes when there is news
  double max_age{0.0};     ///< [s] of its stamps; 0: old ones are well
  std::string remedy;      ///< what to do where no node publishes it
};

/// A topic that some node must listen to, or nothing moves.
struct WantedListener {
  std::string what;  ///< "arm leftarm1"
  std::string name;  ///< "/l_arm_controller/command"
  std::string type;
  std::string remedy;
};

/// Without the map, for which a service does as well.
std::vector<WantedTopic> TopicsOf(const hires::control::RobotNames& names);
WantedTopic MapOf(const hires::control::RobotNames& names);
std::vector<WantedListener> ListenersOf(const hires::control::RobotNames& names);

/// Links that our nodes look up; each must have a transform.
std::vector<std::string> LinksOf(const hires::robot::RobotProfile& profile);

/// A joint that must be told by one of these names: a gripper's by its gap or its finger's angle.
using JointChoice = std::vector<std::string>;
std::vector<JointChoice> JointsOf(const hires::robot::RobotProfile& profile);

/// "/base_scan" for "base_scan".
std::string Absolute(const std::string& name);

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

}  // namespace hires_ros
