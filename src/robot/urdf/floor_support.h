#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/inertia.h"
#include "hires/robot/robot_profile.h"

namespace hires::robot {

/// How a robot stands on the floor, joints frozen, without carts that it tows. In the frame of
/// base_link [m].
struct FloorSupport {
  geometry::Polygon polygon;  ///< convex hull of what is on the floor
  int num_contacts{0};        ///< wheels and caster balls count once, skids by their corners
  bool is_assumed{false};     ///< fewer than three contacts, or in a line: it is the footprint
  std::optional<double> wheel_radius;  ///< [m] of the smallest wheel; none: no wheel has a shape
  std::optional<geometry::MassProperties> body;  ///< none: no link has an inertial
  std::vector<std::string> towed;  ///< links that hitches carry, each with wheels of its own
};

/// A wheel is a continuous joint about a horizontal axis whose shapes are round about that axis and
/// reach down to the floor, or nearly so (profiles may end wheels higher, so that they roll over
/// thresholds). Its radius is the height of its axis; its width is left out. What else is within 5
/// mm of the floor is a caster ball or a skid. A hitch is a joint about a vertical axis whose
/// wheels are farther from it than a caster's, or one that is called so (hitch, trailer, drawbar).
/// @param joints  as ForwardKinematics takes them.  @throws base::ConfigError as ForwardKinematics.
FloorSupport FloorSupportOf(const Robot& robot, const JointPositions& joints);

}  // namespace hires::robot
