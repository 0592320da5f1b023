#pragma once

#include <string>
#include <vector>

namespace hires::world {

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
