#pragma once

#include <memory>

#include "hires/geometry/pose.h"
#include "hires/robot/observation.h"
#include "hires/robot/robot_profile.h"
#include "hires/world/occupancy_grid.h"
#include "support/planar_scan.h"
#include "support/scenes.h"

namespace hires::skills::test_support {

constexpr double kLaserPlane = 0.25;  ///< [m] of the laser above the floor

/// The robot with a tray, and a laser on its base.
inline robot::Robot RobotWithLaser(const geometry::Pose2& X_BL) {
  robot::Robot robot = hires::test_support::TrayRobot();
  robot::Link laser;
  laser.name = "laser";
  laser.joint = robot::Joint();
  laser.joint->name = "laser_joint";
  laser.joint->parent = 0;
  laser.joint->X_PJ.translation = {X_BL.x, X_BL.y, kLaserPlane};
  robot.model.links.push_back(laser);
  robot.profile.laser_link = "laser";
  return robot;
}

/// What the robot with a laser sees of a world, 4 rad wide, without noise.
inline std::shared_ptr<const robot::PlacedScan> ScanIn(const world::World& world,
                                                       const geometry::Pose2& X_WB,
                                                       const geometry::Pose2& X_OB,
                                                       const geometry::Pose2& X_BL) {
  return std::make_shared<const robot::PlacedScan>(hires::test_support::ScanOf(
      world::OutlinesInBand(world, nullptr, kLaserPlane, kLaserPlane), X_WB, X_OB, X_BL));
}

}  // namespace hires::skills::test_support
