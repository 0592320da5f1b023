#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/geometry/shape.h"

namespace hires::robot {

/// What a <visual> shows.
struct SeenShape {
  geometry::Pose3 X_LS;                  ///< in the frame of its link
  std::optional<geometry::Shape> shape;  ///< none: a mesh, which is not read
};

/// By link, of those that have a <visual> and no <collision> with a shape: what is seen of it.
/// Nothing of what has no valid size or place, and nothing of text that is no XML.
std::map<std::string, std::vector<SeenShape>> ShapesSeenOnly(const std::string& urdf_xml);

}  // namespace hires::robot
