#pragma once

#include <ros/node_handle.h>
#include <rosbag/bag.h>
#include <topic_tools/shape_shifter.h>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "reports/episode/episode_topics.h"

namespace hires_ros {

struct EpisodeRecorderParams {
  hires::reports::EpisodeConfig episode;
  std::string folder;  ///< of the bags
};

/// ~config (config/episode.yaml where there is none), ~names, ~folder.
/// @throws hires::base::ConfigError naming parameter, file and key; also where the folder cannot be
/// made.
EpisodeRecorderParams LoadEpisodeRecorderParams();

/// Records the topics of an episode, whatever their types. A bag that is being written ends with
/// `.active`; killed, it lacks its index and the last few kB, and `rosbag reindex` mends it.
/// Messages that are latched stand at the begin of each bag. It writes from when time is known.
class EpisodeRecorderNode {
 public:
  EpisodeRecorderNode(const EpisodeRecorderParams& params, ros::NodeHandle* nh);
  ~EpisodeRecorderNode();  ///< finishes the bag
  EpisodeRecorderNode(const EpisodeRecorderNode&) = delete;

 private:
  using Event = ros::MessageEvent<topic_tools::ShapeShifter const>;

  void OnMessage(const std::string& topic, const Event& event);
  void BeginBag(const ros::Time& now);
  void EndChunk();
  void FinishBag();

  hires::reports::BagRotation rotation_;
  const std::uint32_t chunk_;  // [bytes]
  rosbag::Bag bag_;
  using Connection = std::pair<std::string, std::string>;  // topic and publisher
  std::map<Connection, Event> latched_;
  std::set<Connection> connections_;  // that the bag describes
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace hires_ros
