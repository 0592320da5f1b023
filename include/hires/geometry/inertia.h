#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

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

/// Of a body B whose pose in W is X_WB, in the frame W.
MassProperties InFrame(const Pose3& X_WB, const MassProperties& properties_B);

/// Of several things that are one body: masses added, inertias by Steiner's theorem.
/// @pre not empty
MassProperties Together(const std::vector<MassProperties>& parts);

/// Of a body of that mass [kg] that is made of these shapes, of one density. A mesh counts as the
/// box round it, as its surface may be open; what two shapes share counts twice.
/// @pre shapes_B is not empty
MassProperties SolidOf(const std::vector<Collision>& shapes_B, double mass);

/// [kg m^2] About the centre of mass, from the smallest on.
Eigen::Vector3d PrincipalMoments(const MassProperties& properties);

/// Why no body that is made of these shapes has such an inertia; empty if one may. No principal
/// moment is more than if all mass lay in the farthest corner of the shapes from the centre of
/// mass; the larger two are taken to be 1 % of the solid's at least: less is in other units.
/// @pre WhyUnphysical is empty, shapes_B is not
std::string WhyImplausible(const MassProperties& properties,
                           const std::vector<Collision>& shapes_B);

}  // namespace hires::geometry
