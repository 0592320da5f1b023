#pragma once

#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/perception/picture.h"
#include "hires/simulation/scene.h"

namespace hires::reports {

/// A place with a name and a heading.
struct MarkedPlace {
  std::string name;
  geometry::Pose2 X_MP;
};

/// A world as it is seen from above, north (the map's y) upwards, with the loose things that it
/// begins with: what is higher than 1.7 m is grey, what begins above 2 m (ceilings) is left out.
/// @param places  an arrow and a name each.
/// @param way     [m] in the map; drawn as a line.
/// @return at most 1200 pixels wide and 900 high.
perception::Picture TopView(const simulation::Scene& scene, const std::vector<MarkedPlace>& places,
                            const std::vector<Eigen::Vector2d>& way);

}  // namespace hires::reports
