#include "hires/perception/heat_picture.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "hires/base/check.h"
#include "perception/colours.h"

namespace hires::perception {
namespace {

constexpr double kUnit = 0.01;  // [K] of a pixel's number
const Eigen::Vector3d kCold{0, 0, 255}, kWarm{255, 255, 0}, kHot{255, 0, 0};

std::uint16_t ToCentikelvin(double kelvin) {
  constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
  return static_cast<std::uint16_t>(std::lround(std::clamp(kelvin / kUnit, 0.0, kMost)));
}

}  // namespace

HeatPicture MeasureHeat(const RangePicture& picture,
                        const std::map<std::string, double>& temperatures,
                        const HeatSensorParams& params, base::Rng* rng) {
  std::vector<double> of_owner;
  for (const std::string& name : picture.names) {
    const auto found = temperatures.find(name);
    of_owner.push_back(found == temperatures.end() ? params.room_temperature : found->second);
  }
  HeatPicture heat;
  heat.width = picture.width;
  heat.height = picture.height;
  heat.centikelvin.reserve(picture.owner.size());
  for (const int owner : picture.owner) {
    const double kelvin =
        owner == RangePicture::kNothing ? params.room_temperature : of_owner[owner];
    heat.centikelvin.push_back(ToCentikelvin(rng->Normal(kelvin, params.noise)));
  }
  return heat;
}

Picture Coloured(const HeatPicture& heat, double coldest, double hottest) {
  HIRES_CHECK(coldest < hottest, "a scale of colours goes from cold to hot");
  Picture picture(heat.width, heat.height);
  for (std::size_t i = 0; i < heat.centikelvin.size(); ++i) {
    const double share =
        std::clamp((kUnit * heat.centikelvin[i] - coldest) / (hottest - coldest), 0.0, 1.0);
    picture.pixels[i] = ToColour(share < 0.5 ? kCold + 2.0 * share * (kWarm - kCold)
                                             : kWarm + (2.0 * share - 1.0) * (kHot - kWarm));
  }
  return picture;
}

}  // namespace hires::perception
