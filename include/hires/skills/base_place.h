#pragma once

#include <string>
#include <vector>

#include "hires/geometry/pose.h"

namespace hires::skills {

/// Where a base may stand to look at what is in front of it, beside the place that it was given: in
/// the frame of that place, heading alike. The dissertation (section 6.2.1) found its places by
/// trying and does not print them.
struct BasePlace {
  std::string name;
  double ahead{0.0}, left{0.0};  ///< [m]
};

/// "default", "left", "right" and "behind", in this order.
const std::vector<BasePlace>& BasePlaces();

/// Where the base stands that was given X_MStand.
/// @param place  of BasePlaces(), case ignored.  @throws base::ConfigError with names like it.
geometry::Pose2 AtBasePlace(const geometry::Pose2& X_MStand, const std::string& place);

}  // namespace hires::skills
