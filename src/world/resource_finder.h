#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/files/package_finder.h"

namespace hires::world {

/// Turns the URIs of world and object files into paths: model://name/..., package://name/...,
/// file:///..., https://... of Fuel, and paths relative to the file that names them.
class ResourceFinder {
 public:
  /// @param folders  Where model:// and package:// names are looked for, in this order; folders
  /// that do not exist are left out. package:// is looked for as base::PackageFinder does, near
  /// them and near the file that names it.
  explicit ResourceFinder(const std::vector<std::string>& folders);

  /// The SDF file that an <include> names: a file, or a model folder with its model.config. Nothing
  /// is fetched: https:// stands for a folder of the name that its last part says (FuelNameOf).
  /// @param where  Opens the error message, "a.world:12".
  /// @param from_file  What a path without a scheme is relative to.
  /// @throws base::ConfigError naming the URI, where it was looked for, what comes near, and the
  /// remedy.
  std::string FindModel(const std::string& uri, const std::string& where,
                        const std::string& from_file) const;

  /// The file of a mesh. A path without a scheme is relative to `from_file`, a model folder or the
  /// parent of one, and must end below the folder of that file or below a model folder.
  /// @throws base::ConfigError as FindModel.
  std::string FindMesh(const std::string& uri, const std::string& from_file,
                       const std::string& where) const;

  const std::vector<std::string>& model_folders() const { return model_folders_; }
  const std::vector<std::string>& package_folders() const { return package_folders_; }

 private:
  std::string FindIn(const std::vector<std::string>& folders, const std::string& uri,
                     const std::string& where) const;
  std::string FindInPackages(const std::string& uri, const std::string& near,
                             const std::string& where) const;
  std::string FindOfFuel(const std::string& uri, const std::string& where) const;
  /// @param near  folder of the file that names it, or "".
  std::string FindByScheme(const std::string& uri, const std::string& near,
                           const std::string& where) const;
  std::string FindBeside(const std::string& uri, const std::string& from_file,
                         const std::string& where) const;
  /// By the URI as it stands, else by what its escapes (%20) stand for.
  /// @param has_file  a path without a scheme is relative to `from_file`.
  std::string Find(const std::string& uri, const std::string& where, const std::string& from_file,
                   bool has_file) const;
  /// Why `name`, which `uri` gives, is in none of the folders.
  std::string NotThere(const std::string& uri, const std::string& name, const std::string& where,
                       const std::vector<std::string>& folders) const;
  /// " (did you mean ...?)" for a file, or "".
  std::string NearestFile(const std::string& path) const;
  /// What `look` finds near a name that is not there: once for each name, and for the first ones
  /// alone, as a world may name thousands and folders may be large.
  std::string Guess(const std::string& name, const std::function<std::string()>& look) const;

  std::vector<std::string> model_folders_;
  std::vector<std::string> package_folders_;
  base::PackageFinder packages_;
  mutable std::map<std::string, std::string> guesses_;  // by name
};

}  // namespace hires::world
