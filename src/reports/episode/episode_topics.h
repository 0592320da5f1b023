#pragma once

#include <string>
#include <vector>

#include "hires/control/robot_names.h"
#include "reports/episode/bag_rotation.h"

namespace hires::reports {

/// What an episode's topic is there for.
enum class TopicNeed {
  kNeeded,  ///< nothing can be imagined without it
  kHelps,   ///< read where it is there
  kKept     ///< recorded for people and other programs
};

/// One topic of an episode.
struct EpisodeTopic {
  std::string role;   ///< "odometry", or a part of an action: "execute_action/goal"
  std::string topic;  ///< from the root: "/base_odometry/odom"
  std::string type;   ///< "nav_msgs/Odometry"
  TopicNeed need{TopicNeed::kKept};
};

/// How motions are found where no goals were recorded.
struct MotionParams {
  double still_speed{0.02};    ///< [m/s] of the base that counts as none
  double still_turning{0.03};  ///< [rad/s] likewise
  double still_joint{0.03};    ///< [rad/s] of an arm's joint, likewise
  double still_torso{0.005};   ///< [m/s] likewise
  double pause{1.0};           ///< [s] of rest that parts two motions
  double least_drive{0.1};     ///< [m] along the way; less, and less turned, is no drive
  double least_turn{0.2};      ///< [rad]
  double least_reach{0.2};     ///< [rad] of one joint of an arm, at least
  double least_lift{0.02};     ///< [m] of the torso
  double blind_distance{1.2};  ///< [m] a straight drive no longer than that is move_base_blind
  double straightness{0.95};   ///< beeline by way of such a drive
  double speed_slack{0.1};     ///< by which a peak may be over its motion set's limit
};

/// A file like config/episode.yaml.
struct EpisodeConfig {
  control::RobotNames names;
  std::vector<EpisodeTopic> topics;
  double sample_period{0.1};  ///< [s]
  double max_gap{1.0};        ///< [s] without a known state within a step that is compared
  MotionParams motions;
  double surprise{0.05};  ///< chance of a duration that is not as imagined
  BagLimits bags;

  /// @pre there is one of that role.
  const EpisodeTopic& Of(const std::string& role) const;
};

/// @param names  what the robot calls its topics, in place of the file's; empty: the file's.
/// @throws base::ConfigError naming file and key: also roles that come twice, and those that
/// replaying reads and the file lacks.
EpisodeConfig ReadEpisodeConfig(const std::string& path, const std::string& names = "");

/// A topic that a bag has.
struct BagTopic {
  std::string name, type;
  std::size_t num_messages{0};
};

/// What of an episode is in a bag. Topics without a message count as missing.
struct TopicCheck {
  std::vector<EpisodeTopic> there, missing;
  std::vector<std::string>
      wrong;  ///< "topic /tf has type std_msgs/String, wanted ...", each left out
  std::vector<std::string> elsewhere;  ///< "/odom (nav_msgs/Odometry)": may be what is missing

  bool Has(const std::string& role) const;
  bool is_usable() const;  ///< nothing that is needed is missing
  /// Which topics are missing, what comes of it and what to record, for people; empty: all is
  /// there.
  std::string Advice() const;
};

TopicCheck CheckTopics(const EpisodeConfig& config, const std::vector<BagTopic>& bag);

}  // namespace hires::reports
