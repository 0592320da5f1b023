#pragma once

#include <memory>

#include "hires/geometry/pose.h"
#include "hires/geometry/shape.h"

namespace hires::simulation {

/// A shape as it is, to be asked whether it touches another one: a mesh is where its triangles are,
/// and what it goes round is free; a part of it that is closed and convex is solid, as the planner
/// takes it. Constant, so any number of threads may ask.
class TouchShape {
 public:
  explicit TouchShape(const geometry::Shape& shape);  ///< @pre a mesh has triangles
  ~TouchShape();
  TouchShape(TouchShape&&) noexcept;
  TouchShape& operator=(TouchShape&&) noexcept;

  bool is_mesh() const { return is_mesh_; }
  bool Touches(const geometry::Pose3& X_MS, const TouchShape& other,
               const geometry::Pose3& X_MO) const;
  /// A point of both. @pre they touch.
  Eigen::Vector3d MeetingPoint(const geometry::Pose3& X_MS, const TouchShape& other,
                               const geometry::Pose3& X_MO) const;
  /// [m] 0 where they touch.
  double Distance(const geometry::Pose3& X_MS, const TouchShape& other,
                  const geometry::Pose3& X_MO) const;

 private:
  /// Whether it touches or lies within a solid part. @param p_S  of something that touches no
  /// triangle
  bool Contains(const Eigen::Vector3d& p_S) const;

  struct Geometry;
  std::unique_ptr<const Geometry> geometry_;
  bool is_mesh_{false};
};

}  // namespace hires::simulation
