#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "hires/geometry/polygon.h"
#include "hires/robot/readings.h"

namespace hires::robot {

/// Remembers what a base's laser saw round the robot where it does not look any more. What came
/// nearer than it measures stays where it was seen, by odometry, until the robot has driven a
/// metre; what got out of its view to the side or behind, ten seconds. A value.
class ScanMemory {
 public:
  /// @param body  convex, in the base: what is seen within is the robot.
  explicit ScanMemory(geometry::Polygon body);

  /// Fills `out_of_view_O`, and remembers what the scan shows.
  /// @param time  [s] when it was taken. Where clock or odometry began again all is forgotten.
  void Complete(double time, PlacedScan* scan);

 private:
  struct Point {
    Eigen::Vector2d p_O;
    double time, way;  // [s], [m] when it was seen last
  };
  void NoteMotion(double time, const geometry::Pose2& X_OB);
  bool IsRemembered(double time, const PlacedScan& scan, const Point& point) const;

  geometry::Polygon body_;
  double reach_;  // [m] from the base's origin: farther away nothing is remembered
  std::vector<Point> points_;
  double way_{0.0};  // [m] that it has driven
  struct Last {
    double time;
    geometry::Pose2 X_OB;
  };
  std::optional<Last> last_;
};

}  // namespace hires::robot
