#pragma once

#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/robot/robot_profile.h"
#include "hires/world/world.h"

namespace hires::perception {

/// What a camera takes in: a pyramid along its x axis.
struct CameraView {
  geometry::Pose3 X_MC;
  double width{1.0};      ///< [rad] horizontal
  double height{0.785};   ///< [rad] vertical
  double min_range{0.4};  ///< [m]
  double max_range{3.5};  ///< [m]

  bool Contains(const Eigen::Vector3d& p_M) const;
};

/// The robot's camera now. @pre the robot has an upper body.
CameraView ViewOf(const robot::Robot& robot, const geometry::Pose2& X_MB,
                  const robot::JointPositions& posture);

/// Whether nothing stands between the camera and things that it looks at: rays against static
/// bodies, loose objects and, where wanted, the robot's own links (Embree).
class LineOfSight {
 public:
  /// @param robot_M  shapes of the robot in the map; may be empty.
  LineOfSight(const world::World& world, const std::vector<world::ObjectState>& objects,
              const std::vector<geometry::Collision>& robot_M);
  ~LineOfSight();

  /// Share of an object's visible surface points (a fixed pattern on its hull, those that face the
  /// camera) that the camera sees, 0..1.
  double VisibleShare(const CameraView& view, const std::string& object) const;
  /// Whether a point in space is in view and not hidden; `except` is looked through.
  bool Sees(const CameraView& view, const Eigen::Vector3d& p_M,
            const std::string& except = "") const;
  /// Distance along a ray to the first hit [m]; infinite without one.
  double Cast(const Eigen::Vector3d& from_M, const Eigen::Vector3d& direction) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hires::perception
