#include "hires/geometry/inertia.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

namespace hires::geometry {

Eigen::Matrix3d SolidInertia(const Cylinder& cylinder, double mass) {
  const double r2 = cylinder.radius * cylinder.radius;
  const double across = mass * (3.0 * r2 + cylinder.length * cylinder.length) / 12.0;
  return Eigen::Vector3d(across, across, mass * r2 / 2.0).asDiagonal();
}

Eigen::Matrix3d SolidInertia(const Box& box, double mass) {
  const Eigen::Vector3d sq = box.size.cwiseAbs2();
  return (mass / 12.0 * Eigen::Vector3d(sq.y() + sq.z(), sq.x() + sq.z(), sq.x() + sq.y()))
      .asDiagonal();
}

Eigen::Matrix3d SolidInertia(const Sphere& sphere, double mass) {
  return 0.4 * mass * sphere.radius * sphere.radius * Eigen::Matrix3d::Identity();
}

std::string WhyUnphysical(const MassProperties& properties) {
  if (!(properties.mass > 0.0) || !std::isfinite(properties.mass)) {
    return fmt::format("mass is {} kg, wanted a finite number above 0", properties.mass);
  }
  if (!properties.p_BBcm.allFinite() || !properties.I_BBcm.allFinite()) {
    return "centre of mass or inertia is not finite";
  }
  const Eigen::Matrix3d& inertia = properties.I_BBcm;
  if (!inertia.isApprox(inertia.transpose(), 1e-9)) return "inertia is not symmetric";
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  if (!(moments[0] > 0.0)) return "inertia is not positive definite";
  if (moments[2] > (moments[0] + moments[1]) * (1.0 + 1e-6)) {
    return fmt::format(
        "principal moments {:.6g}, {:.6g}, {:.6g} kg m^2 break the triangle inequality; no rigid "
        "body has them",
        moments[0], moments[1], moments[2]);
  }
  return "";
}

}  // namespace hires::geometry
