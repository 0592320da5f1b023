#pragma once

#include <sdf/Model.hh>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"

namespace hires::world {

/// A link of a model or of a model in it.
struct PlacedLink {
  const sdf::Link* link;
  geometry::Pose3 X_ML;  ///< in the outermost model, at joint zero
  std::string name;      ///< with the models in which it is: "cabinet::box"
  int group;             ///< links of one group hold together; 0: they are fixed to the world
};

/// How a model hangs together.
struct ModelLinks {
  std::vector<PlacedLink> links;
  bool has_moving_joint{false};
  /// "with a joint 'hinge' whose <child> ...", of the first that joins what is not there; or "".
  std::string broken_joint;
  std::string place_of_broken;  ///< "hall.world:12"
};

/// @throws base::ConfigError if a pose or a joint names what is not there.
ModelLinks LinksOf(const sdf::Model& model);

}  // namespace hires::world
