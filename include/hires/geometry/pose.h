#pragma once

#include <Eigen/Geometry>

namespace hires::geometry {

/// Where B stands in the plane of A: `X_AB`. x, y [m], yaw [rad].
struct Pose2 {
  double x{0.0};
  double y{0.0};
  double yaw{0.0};

  Eigen::Vector2d position() const { return {x, y}; }
  Pose2 Inverse() const;
  bool IsFinite() const;
};
Pose2 operator*(const Pose2& X_AB, const Pose2& X_BC);
Eigen::Vector2d operator*(const Pose2& X_AB, const Eigen::Vector2d& p_BC);

/// Velocity in the plane, expressed in the moving frame: vx forward, vy left [m/s], wz [rad/s].
struct Twist2 {
  double vx{0.0};
  double vy{0.0};
  double wz{0.0};
};

/// Where B stands in A: `X_AB`. The quaternion is of unit length.
struct Pose3 {
  Eigen::Vector3d translation{Eigen::Vector3d::Zero()};         ///< [m]
  Eigen::Quaterniond rotation{Eigen::Quaterniond::Identity()};  ///< turns B's axes into A's

  Pose3 Inverse() const;
  bool IsFinite() const;
};
Pose3 operator*(const Pose3& X_AB, const Pose3& X_BC);
Eigen::Vector3d operator*(const Pose3& X_AB, const Eigen::Vector3d& p_BC);

/// Velocity of a body's origin and its angular velocity, both expressed in the frame that the
/// variable's name states (the world, if none).
struct Twist3 {
  Eigen::Vector3d linear{Eigen::Vector3d::Zero()};   ///< [m/s]
  Eigen::Vector3d angular{Eigen::Vector3d::Zero()};  ///< [rad/s]
};

/// Fixed-axis roll, pitch, yaw (REP-103) [rad].
Eigen::Quaterniond RotationFromRpy(double roll, double pitch, double yaw);
double YawOf(const Eigen::Quaterniond& rotation);  ///< heading of the x axis in the plane [rad]

Pose3 Lift(const Pose2& pose, double z = 0.0);  ///< the planar pose at height z [m]
Pose2 Flatten(const Pose3& pose);               ///< drops z, roll and pitch

/// Angle between the body's z axis and the world's z axis, in [0, pi] [rad]: alpha of the
/// dissertation's Eq. 5.1.
double TiltOf(const Eigen::Quaterniond& R_WB);

}  // namespace hires::geometry
