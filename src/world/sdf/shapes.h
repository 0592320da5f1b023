#pragma once

#include <sdf/Collision.hh>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/geometry/shape.h"

namespace hires::world {

/// A part of what an SDF shape is made of.
struct ShapePart {
  std::string suffix;  ///< for its name: "" or "_2"
  geometry::Shape shape;
  geometry::Pose3 X_CS;  ///< in the collision's frame
};

/// The name of a shape that PruneSdf put aside: "capsule", "ellipsoid", "cone", "polyline", or one
/// that is not known; "" for those that libsdformat reads.
std::string OtherShapeOf(const sdf::Collision& collision);

/// A capsule is a cylinder and two balls; an ellipsoid and a cone are meshes round which 24 corners
/// lie (as round a cylinder's outline); a polyline is one upright prism for each triangle that it
/// is cut into, so that bays and holes (polylines within it) stay open.
/// @param where  Opens the error message.
/// @throws base::ConfigError for a shape that is not known, or not made of finite sizes above 0, or
/// a polyline that crosses itself.
/// @pre OtherShapeOf is not "".
std::vector<ShapePart> ShapePartsOf(const sdf::Collision& collision, const std::string& where);

}  // namespace hires::world
