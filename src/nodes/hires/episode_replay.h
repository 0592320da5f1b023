#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "reports/episode/episode_compare.h"
#include "reports/episode/episode_topics.h"

namespace hires_ros {

/// What `hires replay` was asked about a bag of a robot episode.
struct EpisodeReplay {
  std::string bag, json;
  std::string config;        ///< a file like config/episode.yaml
  std::string names;         ///< of topics and frames; empty: as `config` says
  std::string map_to_world;  ///< "x y yaw scale"; empty: they are one
  std::vector<std::string> action_libraries;
  bool is_local{false};  ///< else a running imagination client is asked
  int threads{1};        ///< of is_local
  hires::reports::ReplayParams params;
};

/// What of the bag is to be read as an episode; nothing if it holds requests of imagination alone.
/// @throws hires::base::ConfigError if it has neither that nor requests of imagination, saying what
/// is missing and what to record; and as OpenBag.
std::optional<hires::reports::EpisodeConfig> ConfigOfEpisode(const EpisodeReplay& replay);

/// Imagines each step from the state in which it began, and prints predicted against happened.
/// @param config  of ConfigOfEpisode.
/// @return 0, or 130 when it was cancelled.
/// @throws hires::base::ConfigError for a bag with nothing of use, saying why, and if there is no
/// client to ask.
int ReplayEpisode(const EpisodeReplay& replay, const hires::reports::EpisodeConfig& config,
                  const std::string& package_folder, const std::function<bool()>& cancelled);

}  // namespace hires_ros
