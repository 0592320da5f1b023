#pragma once

#include <string>
#include <vector>

#include "hires/perception/picture.h"

namespace hires::reports {

/// The bytes of a PNG file.  @pre the picture has pixels.
std::string ToPng(const perception::Picture& picture);

/// The bytes of a GIF file that plays for ever: frames of one size with 255 colours of their own
/// choice for all. What does not change from frame to frame takes little space.
/// @param delay  [s] each frame is shown, the last one for `last` seconds; counted in 0.01 s.
/// @pre there are frames, all of one size.
std::string ToGif(const std::vector<perception::Picture>& frames, double delay, double last);

}  // namespace hires::reports
