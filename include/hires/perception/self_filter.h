#pragma once

#include <memory>
#include <vector>

#include "hires/geometry/shape.h"
#include "hires/perception/point_cloud.h"

namespace hires::perception {

/// How far a robot's own shapes may be off from what its sensors see of them.
struct SelfFilterParams {
  double padding{0.03};  ///< [m] a point this near to a shape is the robot's own
  double jump{0.05};     ///< [m] step of range between neighbours that counts as an edge
};

/// Cuts the robot itself out of what its sensors measure. Two kinds of points go: those within
/// `padding` of a shape, and those that veil an edge: behind the padded shape, as the sensor sees
/// it, and next to a point that is nearer by more than `jump`. There the beam was split between the
/// robot and what is behind it. What stands steadily behind the robot stays. A shape that has the
/// sensor within its padding hides nothing.
///
/// Boxes, cylinders and spheres count exactly; a mesh by its triangles, closed ones as filled.
class SelfFilter {
 public:
  explicit SelfFilter(const SelfFilterParams& params);
  ~SelfFilter();
  SelfFilter(SelfFilter&&) noexcept;
  SelfFilter& operator=(SelfFilter&&) noexcept;

  /// Points that are cut become NaN. Neighbours are those of row and column; in a cloud that is not
  /// organised, the ones before and after.
  /// @param shapes_S  of links (and of a load, where it is known), in the sensor's frame S, as the
  /// cloud is.
  /// @return how many points were cut.
  /// @pre the cloud has width * height points.
  int Cut(const std::vector<geometry::Collision>& shapes_S, PointCloud* cloud);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hires::perception
