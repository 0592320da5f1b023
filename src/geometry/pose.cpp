#include "hires/geometry/pose.h"

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"

namespace hires::geometry {

Pose2 Pose2::Inverse() const {
  const double c = std::cos(yaw), s = std::sin(yaw);
  return {-(c * x + s * y), -(-s * x + c * y), WrapToPi(-yaw)};
}

bool Pose2::IsFinite() const { return std::isfinite(x) && std::isfinite(y) && std::isfinite(yaw); }

Pose2 operator*(const Pose2& X_AB, const Pose2& X_BC) {
  const Eigen::Vector2d p_AC = X_AB * X_BC.position();
  return {p_AC.x(), p_AC.y(), WrapToPi(X_AB.yaw + X_BC.yaw)};
}

Eigen::Vector2d operator*(const Pose2& X_AB, const Eigen::Vector2d& p_BC) {
  const double c = std::cos(X_AB.yaw), s = std::sin(X_AB.yaw);
  return {X_AB.x + c * p_BC.x() - s * p_BC.y(), X_AB.y + s * p_BC.x() + c * p_BC.y()};
}

Pose3 Pose3::Inverse() const {
  const Eigen::Quaterniond inverse = rotation.conjugate();
  return {-(inverse * translation), inverse};
}

bool Pose3::IsFinite() const { return translation.allFinite() && rotation.coeffs().allFinite(); }

Pose3 operator*(const Pose3& X_AB, const Pose3& X_BC) {
  return {X_AB.translation + X_AB.rotation * X_BC.translation,
          (X_AB.rotation * X_BC.rotation).normalized()};
}

Eigen::Vector3d operator*(const Pose3& X_AB, const Eigen::Vector3d& p_BC) {
  return X_AB.translation + X_AB.rotation * p_BC;
}

Eigen::Quaterniond RotationFromRpy(double roll, double pitch, double yaw) {
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
}

double YawOf(const Eigen::Quaterniond& rotation) {
  const Eigen::Vector3d x_axis = rotation * Eigen::Vector3d::UnitX();
  return std::atan2(x_axis.y(), x_axis.x());
}

Pose3 Lift(const Pose2& pose, double z) {
  return {{pose.x, pose.y, z}, RotationFromRpy(0.0, 0.0, pose.yaw)};
}

Pose2 Flatten(const Pose3& pose) {
  return {pose.translation.x(), pose.translation.y(), YawOf(pose.rotation)};
}

double TiltOf(const Eigen::Quaterniond& R_WB) {
  // atan2 keeps its precision near 0, where acos would lose half its digits.
  const Eigen::Vector3d axis = R_WB * Eigen::Vector3d::UnitZ();
  return std::atan2(std::hypot(axis.x(), axis.y()), axis.z());
}

}  // namespace hires::geometry
