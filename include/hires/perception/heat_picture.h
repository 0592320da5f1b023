#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/perception/picture.h"
#include "hires/perception/range_picture.h"

namespace hires::perception {

/// What a thermal camera measures. Row by row from the top left.
struct HeatPicture {
  int width{0}, height{0};
  std::vector<std::uint16_t> centikelvin;  ///< 0.01 K each: 29315 is 20 degrees Celsius
};

struct HeatSensorParams {
  double noise{0.05};               ///< [K] sd of each pixel: its NETD
  double room_temperature{293.15};  ///< [K] of what has no temperature of its own
};

/// The temperatures of what is seen. Surfaces are black to heat rays: nothing is reflected.
/// @param temperatures  [K] by name of RangePicture::names; others, and the far distance, are as
/// warm as the room. What a centikelvin of 16 bits cannot hold is the nearest that it can.
/// @param rng  one draw for every pixel.
HeatPicture MeasureHeat(const RangePicture& picture,
                        const std::map<std::string, double>& temperatures,
                        const HeatSensorParams& params, base::Rng* rng);

/// For people: blue at `coldest` [K] and below, over yellow halfway, to red (0xFF0000) at `hottest`
/// and above.  @pre coldest < hottest.
Picture Coloured(const HeatPicture& heat, double coldest, double hottest);

}  // namespace hires::perception
