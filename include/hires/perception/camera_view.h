#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/geometry/shape.h"
#include "hires/robot/robot_profile.h"

namespace hires::perception {

/// What a camera takes in: a pyramid along its x axis.
struct CameraView {
  geometry::Pose3 X_MC;
  double width{1.0};      ///< [rad] horizontal
  double height{0.785};   ///< [rad] vertical
  double min_range{0.4};  ///< [m]
  double max_range{3.5};  ///< [m]

  /// Borders included; distances count from the camera, not from its image plane.
  bool Contains(const Eigen::Vector3d& p_M) const;
};

/// The robot's camera now.  @pre the robot has an upper body.
/// @throws base::ConfigError as robot::ForwardKinematics.
CameraView ViewOf(const robot::Robot& robot, const geometry::Pose2& X_MB,
                  const robot::JointPositions& posture);

/// A link of the robot in the map.
/// @pre the robot has that link.
/// @throws base::ConfigError as robot::ForwardKinematics.
geometry::Pose3 X_MLink(const robot::Robot& robot, const geometry::Pose2& X_MB,
                        const robot::JointPositions& posture, const std::string& link);

/// The same camera in another pose, e.g. one that a message names.  @pre as ViewOf
CameraView ViewFrom(const robot::Robot& robot, const geometry::Pose3& X_MC);

/// The link that the robot's model has for the optical frame of the camera at `link`: fixed to it,
/// turned as OpticalFrame says and in the same place; nothing if it has none.
std::optional<std::string> FindOpticalLink(const robot::RobotModel& model, const std::string& link);

/// All shapes of the robot in the map, named by their links: what may hide things from it.
/// @throws base::ConfigError as robot::ForwardKinematics.
std::vector<geometry::Collision> ShapesOf(const robot::Robot& robot, const geometry::Pose2& X_MB,
                                          const robot::JointPositions& posture);
/// Adds the shapes of a link that stands at X_FL in any frame F.
void AddShapesOf(const robot::Link& link, const geometry::Pose3& X_FL,
                 std::vector<geometry::Collision>* shapes_F);

}  // namespace hires::perception
