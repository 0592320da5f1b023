#pragma once

#include <Eigen/Geometry>

#include "hires/geometry/shape.h"
#include "perception/ray_scene.h"

namespace hires::perception {

/// A shape in the frame of a sensor, as far as `padding` [m] around it.
class PaddedShape {
 public:
  /// @param library  knows the shape, where it is a mesh; outlives this.
  PaddedShape(const geometry::Collision& shape_S, const MeshLibrary& library, float padding);

  /// [m] from the shape without its padding; 0 within. Of a mesh at most `limit`.
  float Distance(const Eigen::Vector3f& p_S, float limit) const;
  bool Contains(const Eigen::Vector3f& p_S) const { return IsWithin(p_S, 0.0f); }
  /// Whether p_S is as near as `reach` [m] to the padded shape, or in it.
  bool IsWithin(const Eigen::Vector3f& p_S, float reach) const {
    return Distance(p_S, padding_ + reach + 1e-3f) <= padding_ + reach;
  }
  /// Whether the straight way from the sensor to p_S leads through it, up to a graze of 1 mm.
  bool IsCrossed(const Eigen::Vector3f& p_S) const;

  const Eigen::AlignedBox3f& bounds() const { return bounds_; }  ///< of the padded shape

 private:
  enum class Kind { kBox, kCylinder, kSphere, kMesh };

  Kind kind_{Kind::kMesh};
  Eigen::Vector3f half_{0.0f, 0.0f, 0.0f};  // of a box; radius, -, half length of round ones
  const geometry::TriangleMesh* mesh_{nullptr};
  RTCScene scene_{nullptr};
  Eigen::Matrix3f R_ShapeS_;  // into the shape's own frame
  Eigen::Vector3f p_SShape_;
  Eigen::Vector3f middle_;  // in S, of the sphere about the padded shape
  float radius_{0.0f};
  float padding_;
  Eigen::AlignedBox3f bounds_;
};

}  // namespace hires::perception
