#pragma once

#include <string>

#include "hires/robot/robot_model.h"

namespace hires::robot {

/// Makes the base the root of a model whose root lies beside it: robots are placed, measured and
/// driven by their root. Only where fixed joints join both with an offset in x, y or yaw, and the
/// root is
/// - called world, map or odom, or has no shape and no "base" or "footprint" in its name: then the
///   base is base_footprint, else base_link, else the root's child;
/// - another one, above base_footprint, or above base_link where that carries all wheels.
/// base_link is passed over where wheels hang beside it, as it may be an arm's.
/// Joints between both are turned round; all links stand to each other as before.
/// @return what was done, or what is doubtful, a sentence; empty: neither.
std::string RootAtBase(RobotModel* model);

}  // namespace hires::robot
