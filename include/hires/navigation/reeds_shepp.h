#pragma once

#include <memory>
#include <vector>

#include "hires/geometry/pose.h"

namespace hires::navigation {

/// A pose on the way of a base that steers like a car, and how it is driven to.
struct CarPose {
  geometry::Pose2 X_MB;
  double curvature{0.0};    ///< [1/m] of the arc that ends here; > 0: steered to the left
  bool is_backward{false};  ///< the arc is driven backward
};

/// A piece of way with the steering held still.
struct CarArc {
  double length{0.0};     ///< [m] < 0: backward
  double curvature{0.0};  ///< [1/m] > 0: steered to the left; turns by length * curvature
};

/// Where an arc from X_MA ends; one that is driven to share `share` of its length.
geometry::Pose2 EndOf(const geometry::Pose2& X_MA, const CarArc& arc, double share = 1.0);

/// Into how many equal pieces of at most `spacing` [m] an arc is cut, >= 1. @pre spacing > 0
int NumPieces(const CarArc& arc, double spacing);

/// Appends the poses along the arcs that begin at X_MA, which itself is left out: the ends of the
/// NumPieces of each. @pre spacing > 0
void AppendPoses(const geometry::Pose2& X_MA, const std::vector<CarArc>& arcs, double spacing,
                 std::vector<CarPose>* poses);

/// [m], forward and backward.
double LengthOf(const std::vector<CarArc>& arcs);

/// Shortest ways between poses, where nothing stands, of a base that drives forward and backward on
/// circles of a radius or larger [Reeds, Shepp 1990, Pacific J. Math. 145:367-393]. Same poses,
/// same bits. One object serves one thread at a time.
class ReedsSheppWays {
 public:
  explicit ReedsSheppWays(double radius);  ///< [m] @pre > 0
  ReedsSheppWays(const ReedsSheppWays&) = delete;
  ReedsSheppWays& operator=(const ReedsSheppWays&) = delete;
  ~ReedsSheppWays();

  /// At most five arcs; none where the poses are the same.
  std::vector<CarArc> Shortest(const geometry::Pose2& X_MA, const geometry::Pose2& X_MB) const;
  double Distance(const geometry::Pose2& X_MA, const geometry::Pose2& X_MB) const;  ///< [m]

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hires::navigation
