#pragma once

#include "hires/localisation/outline_match.h"

namespace hires::skills {

/// How what the base's laser sees of the world corrects the place that the robot is told.
struct SeenPlaceParams {
  localisation::OutlineMatchParams match;
  double told_sd{0.03};      ///< [m] of the told place, along each axis: at least, and where nobody
                             ///< tells it
  double told_yaw_sd{0.02};  ///< [rad] of the told place
  double drift{0.02};        ///< sd of the odometry: [m] and [rad] after a metre, [rad] after a
                             ///< radian; its variance grows with the way
  double walk{0.002};        ///< [m], [rad] likewise after a second, whether it drives or not
};

/// What a scene's skills share of it; constant.
struct SeenPlace {
  localisation::OutlineMatch match;
  SeenPlaceParams params;
};

}  // namespace hires::skills
