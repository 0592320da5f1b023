#pragma once

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "hires/perception/surroundings.h"
#include "perception/ray_scene.h"

namespace hires::perception {

struct Surroundings::Impl {
  struct Model {
    std::shared_ptr<const world::ObjectModel> description;
    std::vector<SurfacePoint> surface;
  };

  /// The world's own, or the box that the name says: made when first asked for and kept, so that
  /// references stay good. @throws base::ConfigError as world::World::RequireModel.
  const Model& Require(const std::string& model) const;

  MeshLibrary library;
  RayScene statics;
  std::vector<std::string> static_names;  ///< by owner
  std::map<std::string, Model> models;
  mutable std::mutex boxes_mutex;
  mutable std::map<std::string, Model> boxes;  ///< of unknown things, by model
};

}  // namespace hires::perception
