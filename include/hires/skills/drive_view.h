#pragma once

#include <memory>
#include <vector>

#include "hires/geometry/pose.h"

namespace hires::navigation {
class Costmap;
}

namespace hires::skills {

/// What a drive goes by, for people to look at. It is shared with the skill, not copied, and does
/// not change any more.
struct DriveView {
  std::shared_ptr<const std::vector<geometry::Pose2>> path;  ///< X_MB, as it was planned last
  std::shared_ptr<const navigation::Costmap> costmap;        ///< with what was seen
  geometry::Pose2 X_MB;                                      ///< where the robot was then
};

}  // namespace hires::skills
