#pragma once

#include <memory>
#include <string>

#include "loop/loop_observer.h"

namespace hires_ros {

/// Writes what passes in a loop to a bag as a robot's topics would carry it, by the names of
/// config/episode.yaml: what `episode_recorder` records of a robot, but for scans and the
/// transforms of links, which follow from joint states. No master is needed.
/// @throws hires::base::ConfigError if the bag cannot be written.
std::unique_ptr<hires::loop::LoopRecording> MakeEpisodeWriter(const std::string& path,
                                                              const std::string& package_folder);

}  // namespace hires_ros
