#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hires/base/param_reader.h"
#include "hires/geometry/shape.h"
#include "hires/perception/heat_picture.h"
#include "hires/perception/pinhole_camera.h"
#include "hires/perception/range_picture.h"
#include "hires/perception/surroundings.h"
#include "hires/world/world.h"

namespace hires::perception {

struct WarmParams {
  double threshold{308.15};  ///< [K] from which on a pixel is warm
  int min_pixels{30};        ///< of a region, and of an object
  double min_share{0.2};     ///< of an object's pixels in a region, before the region is its
  double max_range{4.0};     ///< [m] from the camera to an object that is measured
  double period{1.0};        ///< [s] at least between two pictures that are read
};
/// @throws base::ConfigError naming file and key.
WarmParams ReadWarmParams(base::ParamReader in);

/// Warm pixels that hang together, corners included.
struct WarmRegion {
  std::vector<Eigen::Vector2i> contour;  ///< pixels (column, row) along its outer border
  int num_pixels{0};
  double hottest{0.0};               ///< [K]
  double median{0.0};                ///< [K]
  std::vector<std::string> objects;  ///< whose region it may be, by name; none: nobody's known
};

/// What the picture says of one object.
struct ObjectHeat {
  std::string name;
  double temperature{0.0};  ///< [K] median of its pixels in its warm region, or of all without one
  double hottest{0.0};      ///< [K] of the same pixels
  int num_pixels{0};        ///< of the same
  std::vector<std::string> mixed_with;  ///< share its region: any of them may be the warm one
  bool is_ambiguous() const { return !mixed_with.empty(); }
};

struct HeatReading {
  std::vector<WarmRegion> regions;  ///< row by row from above, by their first pixels
  std::vector<ObjectHeat>
      objects;  ///< in the order asked for; those with too few pixels are left out
};

/// Finds warm regions, and which recognised objects they are.
/// @param seen     where the objects are in the very picture: LineOfSight::Look of the thermal
///                 camera with the objects as they were recognised.
/// @param objects  names in `seen`.
/// @throws std::logic_error unless both pictures are of one size.
HeatReading ReadHeat(const HeatPicture& heat, const RangePicture& seen,
                     const std::vector<std::string>& objects, const WarmParams& params);

/// A thermal picture with what the robot knows of the moment at which it was taken.
struct HeatView {
  HeatPicture heat;
  PinholeCamera camera;                      ///< where it stood
  std::vector<geometry::Collision> robot_M;  ///< the robot itself may hide things (ShapesOf)
};

/// The same by where objects are known to be. What the robot carries hides things and is not
/// measured: it moves with the robot, and what is known of its place is older than the picture.
/// @throws base::ConfigError for an object whose model the world does not have, or whose pose is
/// no number.
/// @throws std::logic_error unless picture and camera are of one size.
HeatReading ReadHeat(const HeatView& view, const std::shared_ptr<const Surroundings>& surroundings,
                     const std::vector<world::ObjectState>& known, const WarmParams& params);

/// [degrees Celsius] by object, of those that are not ambiguous.
std::map<std::string, double> SureDegrees(const HeatReading& reading);

constexpr double kZeroCelsius = 273.15;  ///< [K]

}  // namespace hires::perception
