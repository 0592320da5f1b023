#pragma once

#include <map>
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

  const Model& Require(const std::string& model) const;

  MeshLibrary library;
  RayScene statics;
  std::vector<std::string> static_names;  ///< by owner
  std::map<std::string, Model> models;
};

}  // namespace hires::perception
