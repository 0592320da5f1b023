#pragma once

#include "hires/robot/robot_profile.h"

namespace hires::robot {

/// What a robot's lowest shape may lie below the frame that drives on the floor [m]: what rounding
/// and soft wheels make of a model.
constexpr double kFloorSlack = 0.005;

/// [m] of the lowest collision shape over base_link, joints in the driving posture; 0 where there
/// is no shape.  @param bounds  LinkBounds of a robot
double LowestShape(const std::vector<geometry::Aabb>& bounds);

/// Has the robot drive on the floor: where its shapes reach below base_link, the link
/// "base_footprint" takes its place, which is put below it at the height of the lowest shape, or is
/// there already at that height. Where all shapes lie above base_link, that one is on the floor.
/// @pre base_link is one of the model's; joints are within limits.
void StandOnFloor(Robot* robot);

}  // namespace hires::robot
