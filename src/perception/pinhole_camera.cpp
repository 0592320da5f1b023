#include "hires/perception/pinhole_camera.h"

#include <cmath>

#include "hires/base/check.h"

namespace hires::perception {

using Eigen::Vector3d;

Vector3d PinholeCamera::DirectionAt(double column, double row) const {
  const Vector3d direction_C(focal_length, width / 2.0 - column, height / 2.0 - row);
  return X_MC.rotation * direction_C.normalized();
}

std::optional<Eigen::Vector2d> PinholeCamera::Project(const Vector3d& p_M) const {
  const Vector3d p_C = X_MC.Inverse() * p_M;
  if (p_C.x() <= 0.0) return std::nullopt;
  return Eigen::Vector2d(width / 2.0 - focal_length * p_C.y() / p_C.x(),
                         height / 2.0 - focal_length * p_C.z() / p_C.x());
}

geometry::Pose3 OpticalFrame() {
  Eigen::Matrix3d R_CO;
  R_CO << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {Vector3d::Zero(), Eigen::Quaterniond(R_CO)};
}

PinholeCamera CameraOf(int width, int height, double field_of_view) {
  PinholeCamera camera;
  camera.width = width;
  camera.height = height;
  camera.focal_length = width / 2.0 / std::tan(field_of_view / 2.0);
  return camera;
}

PinholeCamera LookAt(const Vector3d& eye_M, const Vector3d& target_M, int width, int height,
                     double field_of_view) {
  const Vector3d forward = (target_M - eye_M).normalized();
  HIRES_CHECK(forward.head<2>().norm() > 1e-6, "a camera that looks straight up or down");
  const Vector3d left = Vector3d::UnitZ().cross(forward).normalized();
  Eigen::Matrix3d R_MC;
  R_MC << forward, left, forward.cross(left);
  PinholeCamera camera = CameraOf(width, height, field_of_view);
  camera.X_MC.translation = eye_M;
  camera.X_MC.rotation = Eigen::Quaterniond(R_MC).normalized();
  return camera;
}

}  // namespace hires::perception
