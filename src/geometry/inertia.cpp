#include "hires/geometry/inertia.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/overloaded.h"
#include "hires/geometry/angles.h"

namespace hires::geometry {
namespace {

constexpr double kLeastOfSolid = 0.01;  // share of the solid's moments
constexpr double kThinnest = 1e-4;      // [m] of the box round a mesh, which may be flat

/// Of density 1 kg/m^3.
MassProperties UnitSolidOf(const Collision& shape) {
  Eigen::Vector3d p_SScm = Eigen::Vector3d::Zero();
  const auto solid = [&](const auto& of_shape, double volume) {
    return MassProperties{volume, p_SScm, SolidInertia(of_shape, volume)};
  };
  const MassProperties in_S = std::visit(
      base::Overloaded{
          [&](const Box& box) { return solid(box, box.size.prod()); },
          [&](const Cylinder& it) { return solid(it, kPi * it.radius * it.radius * it.length); },
          [&](const Sphere& it) { return solid(it, 4.0 / 3.0 * kPi * std::pow(it.radius, 3)); },
          [&](const std::shared_ptr<const TriangleMesh>& mesh) {
            const Aabb bounds = BoundsOf(mesh, {});
            p_SScm = 0.5 * (bounds.lower + bounds.upper);
            const Box box{(bounds.upper - bounds.lower).cwiseMax(kThinnest)};
            return solid(box, box.size.prod());
          }},
      shape.shape);
  return InFrame(shape.X_BS, in_S);
}

/// [m] From a point to the farthest one of a shape.
double FarthestFrom(const Eigen::Vector3d& p_B, const Collision& shape) {
  const Eigen::Vector3d p_S = shape.X_BS.Inverse() * p_B;
  return std::visit(
      base::Overloaded{[&](const Box& box) { return (p_S.cwiseAbs() + 0.5 * box.size).norm(); },
                       [&](const Cylinder& it) {
                         return std::hypot(p_S.head<2>().norm() + it.radius,
                                           std::abs(p_S.z()) + 0.5 * it.length);
                       },
                       [&](const Sphere& sphere) { return p_S.norm() + sphere.radius; },
                       [&](const std::shared_ptr<const TriangleMesh>& mesh) {
                         double farthest = 0.0;
                         for (const Eigen::Vector3d& corner : mesh->vertices)
                           farthest = std::max(farthest, (corner - p_S).norm());
                         return farthest;
                       }},
      shape.shape);
}

}  // namespace

MassProperties InFrame(const Pose3& X_WB, const MassProperties& properties_B) {
  const Eigen::Matrix3d R_WB = X_WB.rotation.toRotationMatrix();
  return {properties_B.mass, X_WB * properties_B.p_BBcm,
          R_WB * properties_B.I_BBcm * R_WB.transpose()};
}

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
  const Eigen::Vector3d moments = PrincipalMoments(properties);
  if (!(moments[0] > 0.0)) return "inertia is not positive definite";
  if (moments[2] > (moments[0] + moments[1]) * (1.0 + 1e-6)) {
    return fmt::format(
        "principal moments {:.6g}, {:.6g}, {:.6g} kg m^2 break the triangle inequality; no rigid "
        "body has them",
        moments[0], moments[1], moments[2]);
  }
  return "";
}

MassProperties Together(const std::vector<MassProperties>& parts) {
  HIRES_CHECK(!parts.empty(), "nothing has no mass properties");
  MassProperties all;
  all.mass = 0.0;
  all.p_BBcm.setZero();
  all.I_BBcm.setZero();
  for (const MassProperties& part : parts) {
    all.mass += part.mass;
    all.p_BBcm += part.mass * part.p_BBcm;
  }
  all.p_BBcm /= all.mass;
  for (const MassProperties& part : parts) {
    const Eigen::Vector3d off = part.p_BBcm - all.p_BBcm;
    all.I_BBcm += part.I_BBcm + part.mass * (off.squaredNorm() * Eigen::Matrix3d::Identity() -
                                             off * off.transpose());
  }
  return all;
}

MassProperties SolidOf(const std::vector<Collision>& shapes_B, double mass) {
  std::vector<MassProperties> parts;
  for (const Collision& shape : shapes_B) parts.push_back(UnitSolidOf(shape));
  MassProperties solid = Together(parts);
  solid.I_BBcm *= mass / solid.mass;
  solid.mass = mass;
  return solid;
}

Eigen::Vector3d PrincipalMoments(const MassProperties& properties) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(properties.I_BBcm, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

std::string WhyImplausible(const MassProperties& properties,
                           const std::vector<Collision>& shapes_B) {
  double farthest = 0.0;
  for (const Collision& shape : shapes_B)
    farthest = std::max(farthest, FarthestFrom(properties.p_BBcm, shape));
  const double most = properties.mass * farthest * farthest;
  const Eigen::Vector3d moments = PrincipalMoments(properties);
  const Eigen::Vector3d least =
      kLeastOfSolid * PrincipalMoments(SolidOf(shapes_B, properties.mass));
  // The smallest is left aside: a thin mesh that lies askew fills little of the box round it.
  if (moments[2] <= most && moments[1] >= least[1] && moments[2] >= least[2]) return "";
  return fmt::format(
      "principal moments {:.3g}, {:.3g}, {:.3g} kg m^2, wanted at least {:.3g}, {:.3g}, {:.3g} and "
      "at most {:.3g} for {:g} kg in its shapes",
      moments[0], moments[1], moments[2], least[0], least[1], least[2], most, properties.mass);
}

}  // namespace hires::geometry
