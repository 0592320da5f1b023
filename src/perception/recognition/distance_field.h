#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "hires/geometry/shape.h"

namespace hires::perception {

/// [sd^2] at which a squared distance from a surface is as bad as any larger one.
inline constexpr double kFarthest = 9.0;

/// Distances from a body's surface on a grid, negative inside; between the nodes interpolated,
/// which is exact at flat faces and off by up to cell^2 / (8 r) at round ones. Constant after it is
/// made.
class DistanceField {
 public:
  /// [m] around the body that the grid reaches.
  static constexpr double kMargin = 0.04;

  /// Boxes, cylinders and spheres by their closed forms; meshes by their nearest triangle, whose
  /// normal tells inside from outside.
  /// @pre at least one shape.
  explicit DistanceField(const std::vector<geometry::Collision>& collisions_B);

  struct Value {
    double distance{0.0};                               ///< [m]
    Eigen::Vector3d gradient{Eigen::Vector3d::Zero()};  ///< about of length 1, outwards
  };
  /// @return nothing beyond the grid.
  std::optional<Value> At(const Eigen::Vector3d& p_B) const;

  /// Where a ray meets the surface first, as a multiple of its direction; by sphere tracing.
  /// @param direction_B  of length 1.
  std::optional<double> Meet(const Eigen::Vector3d& from_B,
                             const Eigen::Vector3d& direction_B) const;

  const geometry::Aabb& bounds() const { return bounds_; }  ///< of the body itself, B's axes

 private:
  std::size_t IndexOf(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * size_.y() + y) * size_.x() + x;
  }

  geometry::Aabb bounds_;
  Eigen::Vector3d origin_{Eigen::Vector3d::Zero()};  // of the grid
  Eigen::Vector3i size_{Eigen::Vector3i::Zero()};    // nodes
  double cell_{0.005};                               // [m]
  std::vector<float> distances_;
};

}  // namespace hires::perception
