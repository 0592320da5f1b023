#pragma once

#include <map>
#include <string>
#include <vector>

#include "reports/episode/episode.h"
#include "reports/episode/episode_topics.h"

namespace hires_ros {

/// What a bag of a robot episode says.
struct EpisodeRecording {
  hires::reports::TopicCheck topics;
  std::vector<hires::reports::Episode> episodes;  ///< one for each run of the robot's clock
  std::map<std::string, int> dropped;             ///< what was left out and why -> how often
  std::vector<std::string> untold_joints;         ///< of arms and torso
  std::string missing;  ///< of a robot whose state was never known: what did not come; or empty
};

/// Reads the topics that `config` names. Messages of another version are left out by name.
/// @throws hires::base::ConfigError naming the bag and what to do: no such bag, unindexed or
/// broken.
EpisodeRecording ReadEpisodeRecording(const std::string& path,
                                      const hires::reports::EpisodeConfig& config,
                                      const hires::imagination::ImaginationSetup& setup);

}  // namespace hires_ros
