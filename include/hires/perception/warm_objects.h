#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hires/perception/heat_picture.h"
#include "hires/perception/range_picture.h"

namespace hires::perception {

struct WarmParams {
  double threshold{308.15};  ///< [K] from which on a pixel is warm
  int min_pixels{30};        ///< of a region, and of an object
  double min_share{0.2};     ///< of an object's pixels in a region, before the region is its
};

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

constexpr double kZeroCelsius = 273.15;  ///< [K]

}  // namespace hires::perception
