#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/world/world.h"

namespace hires::world {

/// A place to stand at that is named beside the world's file.
struct NamedArea {
  std::string name;
  geometry::Pose2 X_MA;
  std::optional<double> z{};  ///< [m] of the world's file, where one is given
};

/// LoadWorld, with areas added: each on the floor under it; where floors lie over one another, its
/// own height says which one (docs/your_files.md).
/// @throws base::ConfigError as LoadWorld and AddAreas.
World LoadWorldWithAreas(const std::string& sdf_path, const std::vector<NamedArea>& areas);

/// Adds areas on the floor z = 0, and notes if the world is wider than its map is then; or at
/// `heights` [m] (one for each).
/// @throws base::ConfigError: too far away, or called as another area of the world.
void AddAreas(const std::vector<NamedArea>& areas, World* world);
void AddAreas(const std::vector<NamedArea>& areas, const std::vector<double>& heights,
              World* world);

}  // namespace hires::world
