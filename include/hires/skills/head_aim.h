#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "hires/perception/camera_view.h"
#include "hires/skills/activity.h"
#include "hires/skills/manipulation_context.h"

namespace hires::skills {

/// Pan and tilt [rad] with which the camera's axis passes through a point, found by turning the
/// head by what is missing, again and again: the camera sits beside both axes. Cut off at the
/// joints' limits; nothing if the point then lies outside the field of view.
std::optional<std::vector<double>> AimHead(const robot::Robot& robot, const geometry::Pose2& X_MB,
                                           const robot::JointPositions& posture,
                                           const Eigen::Vector3d& p_M);

/// The head to a point, then resting there. Cannot begin (out_of_view) where AimHead finds
/// nothing.
Beginning LookAtPoint(std::shared_ptr<const ManipulationContext> context,
                      const robot::Observation& observation, const Eigen::Vector3d& p_M);

/// Whether a camera looks at a point and not just past its rim.
bool IsLookedAt(const perception::CameraView& view, const Eigen::Vector3d& p_M, double margin);

/// Points of an area round the origin of F, at most `spacing` apart, rims included, nearest to the
/// origin first.
/// @pre the extent holds the origin.
std::vector<Eigen::Vector3d> PointsOn(const geometry::Pose3& X_MF,
                                      const Eigen::AlignedBox2d& extent_F, double spacing);

/// Looks at points one after the other until the resting head has had every one in view. Fails with
/// out_of_view if one cannot be brought into view.
class SweepPoints : public Activity {
 public:
  SweepPoints(std::shared_ptr<const ManipulationContext> context,
              std::vector<Eigen::Vector3d> points_M);

  Status Update(const robot::Observation& observation, robot::Command* command) override;

 private:
  void CrossOff(const robot::Observation& observation);

  std::shared_ptr<const ManipulationContext> context_;
  std::vector<Eigen::Vector3d> left_M_;  // not yet looked at
  std::unique_ptr<Activity> look_;       // at the first of them
};

}  // namespace hires::skills
