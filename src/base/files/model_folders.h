#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hires::base {

/// Without an exception where the path cannot be looked at.
bool Exists(const std::string& path);
bool IsFolder(const std::string& path);

/// Where model:// and https:// names are looked for, for the file of a world, object or robot:
/// models/ and the folder beside it, models/ beside the folders above it up to its package (worlds/
/// and models/ side by side), `model_path`, what the environment names in GZ_SIM_RESOURCE_PATH,
/// IGN_GAZEBO_RESOURCE_PATH, SDF_PATH, GAZEBO_MODEL_PATH and GAZEBO_RESOURCE_PATH, Gazebo's caches
/// (~/.gz/fuel, ~/.ignition/fuel, ~/.gazebo/models), and our own ground plane and sun.
std::vector<std::string> ModelFoldersFor(const std::string& file,
                                         const std::vector<std::string>& model_path);

/// The variables of ModelFoldersFor, for messages.
std::string ModelVariables();

/// What lies in a folder, in the order of names, 20000 entries at most; nothing if it cannot be
/// read.
std::vector<std::filesystem::path> EntriesOf(const std::filesystem::path& folder);

}  // namespace hires::base
