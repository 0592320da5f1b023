#pragma once

#include <vector>

#include "hires/geometry/pose.h"

namespace hires::mapping {

/// Holds the motion that the laser shows against that of the odometry, over stretches of 0.5 m or
/// 0.5 rad by either of them: from scan to scan matches have noise, and readings may be late.
class MotionComparison {
 public:
  /// From one scan to the next.
  /// @param disagree  whether the two are farther apart there than odometry errs.
  void Add(const geometry::Pose2& by_laser, const geometry::Pose2& by_odometry, bool disagree);

  /// One of them does not tell how the robot moved: the stretch that has begun does not count.
  void Restart() { stretch_ = {}; }

  /// [rad/rad] turns by the laser for turns by odometry; 1 also where nobody turned.
  double turns_alike() const;

  /// [m/m] ways by the laser for ways by odometry, in the median of the stretches on which both
  /// moved: wheels that spin or are carried for a while do not count. 1 also on less than 5 m.
  double ways_alike() const;

  int num_stretches() const { return num_stretches_; }
  int num_disagreed() const { return num_disagreed_; }  ///< with a tenth of their scans

 private:
  struct Stretch {
    geometry::Pose2 by_laser, by_odometry;
    int num_scans{0}, num_disagree{0};
  };

  void TakeStretch();

  Stretch stretch_;                          // that has begun
  int num_stretches_{0}, num_disagreed_{0};  // whole ones
  double turned_{0.0}, turned_alike_{0.0};   // [rad^2] by odometry, and by it and the laser
  std::vector<double> ratios_;               // of ways
};

}  // namespace hires::mapping
