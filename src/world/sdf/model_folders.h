#pragma once

#include <string>
#include <vector>

namespace hires::world {

/// Without an exception where the path cannot be looked at.
bool Exists(const std::string& path);
bool IsFolder(const std::string& path);

/// Where model:// and https:// names are looked for, for a world or object file: models/ and the
/// folder beside it, models/ beside the folders above it up to its package (worlds/ and models/
/// side by side), `model_path`, what the environment names in GZ_SIM_RESOURCE_PATH,
/// IGN_GAZEBO_RESOURCE_PATH, SDF_PATH, GAZEBO_MODEL_PATH and GAZEBO_RESOURCE_PATH, Gazebo's caches
/// (~/.gz/fuel, ~/.ignition/fuel, ~/.gazebo/models), and our own ground plane and sun.
std::vector<std::string> ModelFoldersFor(const std::string& file,
                                         const std::vector<std::string>& model_path);

/// The variables of ModelFoldersFor, for messages.
std::string ModelVariables();

/// A name as Fuel's servers and caches compare them: case, blanks, "%20" and "_" are alike.
std::string AlikeName(const std::string& name);

/// "https://.../models/Name/2/files/meshes/a.dae": what it says beyond a server that is not asked.
struct FuelName {
  std::string model;   ///< "Name"; the last part where there is no "models"
  std::string inside;  ///< "meshes/a.dae", or ""
};
FuelName FuelNameOf(const std::string& uri);

/// A folder in `folders` whose name is alike (AlikeName), with the newest version's number below it
/// where there is one; "" if there is none.
std::string FindAlike(const std::vector<std::string>& folders, const std::string& name);

/// Names of folders in `folders` that may have been meant by a `name` that is not there, quoted
/// after "; did you mean ": or "". Of files base::DidYouMeanFile tells.
std::string NearestName(const std::vector<std::string>& folders, const std::string& name);

/// The SDF file of a model folder: what its model.config names for the newest SDF that is read,
/// else model.sdf. Of a folder of versions (of a cache of Fuel) that of the newest.
/// @param where  Opens the error message.
std::string ModelFileIn(const std::string& folder, const std::string& uri,
                        const std::string& where);

}  // namespace hires::world
