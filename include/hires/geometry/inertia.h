#pragma once

#include <Eigen/Core>

#include "hires/geometry/shape.h"

namespace hires::geometry {

/// Mass, centre of mass and rotational inertia of a rigid body B.
struct MassProperties {
  double mass{1.0};                                           ///< [kg], > 0
  Eigen::Vector3d p_BBcm{Eigen::Vector3d::Zero()};            ///< [m]
  Eigen::Matrix3d I_BBcm{0.4 * Eigen::Matrix3d::Identity()};  ///< about Bcm, in B [kg m^2]
};

/// Solid homogeneous shapes about their centre: I_z = m r^2 / 2, I_x = I_y = m (3 r^2 + h^2) / 12
/// for the cylinder (dissertation, section 5.2).
Eigen::Matrix3d SolidInertia(const Cylinder& cylinder, double mass);
Eigen::Matrix3d SolidInertia(const Box& box, double mass);
Eigen::Matrix3d SolidInertia(const Sphere& sphere, double mass);

/// Positive mass, finite, symmetric, positive definite, triangle inequality of principal moments
/// (with a relative slack of 1e-6). Empty if physical, else what is wrong.
std::string WhyUnphysical(const MassProperties& properties);

}  // namespace hires::geometry
