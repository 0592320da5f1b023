#pragma once

#include <string>
#include <vector>

namespace hires::perception {

/// What the middle of each pixel of a camera looks at, without noise. Row by row from the top left.
struct RangePicture {
  static constexpr int kNothing = -1;

  int width{0}, height{0};
  std::vector<float> depth{};        ///< [m] along the camera's axis; infinite: nothing is there
  std::vector<float> incidence{};    ///< cosine of the angle between ray and surface normal, 0 .. 1
  std::vector<int> owner{};          ///< of the surface, in `names`; kNothing
  std::vector<std::string> names{};  ///< static bodies, loose objects, shapes of the robot, "floor"
};

}  // namespace hires::perception
