#pragma once

#include <Eigen/Core>
#include <string>

#include "hires/world/world.h"

namespace hires::world {

/// Why a base that drives on the floor z = 0 does not come to an area: a floor of its own bears it
/// that is more than `step` [m] higher or lower. Empty: it does come there, as far as heights go.
std::string WhyElsewhere(const World& world, const std::string& area, double step);

/// What is the matter where a robot on z = 0 touches a shape (NameOf) at x, y of the map: the
/// shape's top is a floor itself, higher than the robot stands. Empty: it is none.
std::string WhyInFloor(const World& world, const std::string& shape, const Eigen::Vector2d& p_M);

}  // namespace hires::world
