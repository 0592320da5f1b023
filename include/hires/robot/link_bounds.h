#pragma once

#include <string>
#include <vector>

#include "hires/robot/robot_profile.h"

namespace hires::robot {

/// [m] above base_link: what is higher passes over all, and is in no footprint.
inline constexpr double kFootprintTop = 2.0;

/// The box around the collision shapes of each link of the model, in the frame of base_link, joints
/// in the driving posture; as Aabb begins, with nothing in it, for a link without shapes.
/// @pre base_link is one of the model's.  @throws base::ConfigError as ForwardKinematics.
std::vector<geometry::Aabb> LinkBounds(const Robot& robot);

/// The link that reaches farthest to a side, of those that a footprint is made of; "" where none
/// reaches to a side.  @param bounds  LinkBounds(robot)
std::string WidestLink(const Robot& robot, const std::vector<geometry::Aabb>& bounds);

/// Links on which things could stand: the box round their shapes is 0.1 m long and wide at least,
/// and nothing of another link is over its middle. The largest first.
/// @pre as LinkBounds
std::vector<std::string> LinksOpenAbove(const Robot& robot);

/// "robot 'husky' has no tray; ...": with what to write, and on which links things could stand.
/// @pre as LinkBounds, and the robot's tray_link is empty
std::string NoTrayText(const Robot& robot);

}  // namespace hires::robot
