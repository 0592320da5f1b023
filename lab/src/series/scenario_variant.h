#pragma once

#include <string>
#include <vector>

#include "lab/src/series/scenario_series.h"

namespace hires::lab {

/// From what the world of a run is made.
struct VariantOrder {
  std::string scenario;  ///< file: who stands where, and what the robot is told
  std::string task;      ///< empty: the scenario's
  std::string world;     ///< SDF file, or a map, in which nothing but robot and objects can move
  std::string folder;    ///< where the files are written
};

/// The files that one run is played with: as `hires achieve --local` and closed_loop.launch take
/// them.
struct VariantFiles {
  std::string scenario, world;
  std::vector<std::string> knowledge;
};

/// Moves things in the world that is simulated and in what the robot knows of it alike, and writes
/// both. A pose of the file belongs to the instance whose `hasPose` it is: a model or frame of the
/// world, an object of the scenario, or the robot. With furniture go its areas, with an area what
/// stands `On` it, and with both what the scenario hides on the furniture's box; all of them
/// rigidly.
/// @throws base::ConfigError naming document, line and instance: a pose that only the knowledge,
/// only the world or neither of them has; one at which the world has its thing more than 0.01 m or
/// 0.01 rad away; one below the floor (see ZOrigin); and as ReadScenario and LoadKnowledge.
VariantFiles WriteVariant(const ScenarioSeries& series, const std::vector<int>& choices,
                          const VariantOrder& order);

}  // namespace hires::lab
