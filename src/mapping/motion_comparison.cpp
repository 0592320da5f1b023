#include "mapping/motion_comparison.h"

#include <algorithm>
#include <cmath>

#include "base/averages.h"
#include "hires/geometry/angles.h"

namespace hires::mapping {
namespace {

using geometry::Pose2;

constexpr double kStretch = 0.5;           // [m], [rad]
constexpr double kTurnsTold = 1.0;         // [rad^2] of stretches that tell whether turns are alike
constexpr double kWayOfStretch = 0.25;     // [m] that makes it one of a way
constexpr double kLeastOfStretch = 0.1;    // of its scans, with which it disagrees
constexpr double kHasMoved = 0.001;        // [m]
constexpr std::size_t kFewStretches = 10;  // whose ways tell nothing

bool IsStretch(const Pose2& moved) {
  return moved.position().norm() >= kStretch || std::abs(moved.yaw) >= kStretch;
}

}  // namespace

void MotionComparison::Add(const Pose2& by_laser, const Pose2& by_odometry, bool disagree) {
  stretch_.by_laser = stretch_.by_laser * by_laser;
  stretch_.by_odometry = stretch_.by_odometry * by_odometry;
  stretch_.by_laser.yaw = geometry::WrapToPi(stretch_.by_laser.yaw);
  stretch_.by_odometry.yaw = geometry::WrapToPi(stretch_.by_odometry.yaw);
  ++stretch_.num_scans;
  if (disagree) ++stretch_.num_disagree;
  if (!IsStretch(stretch_.by_laser) && !IsStretch(stretch_.by_odometry)) return;
  TakeStretch();
  stretch_ = {};
}

void MotionComparison::TakeStretch() {
  ++num_stretches_;
  // One of many scans may be of people who walk by.
  if (stretch_.num_disagree >= kLeastOfStretch * stretch_.num_scans) ++num_disagreed_;
  turned_ += stretch_.by_odometry.yaw * stretch_.by_odometry.yaw;
  turned_alike_ += stretch_.by_odometry.yaw * stretch_.by_laser.yaw;
  const double way = stretch_.by_laser.position().norm();
  const double way_of_odometry = stretch_.by_odometry.position().norm();
  const bool have_moved = std::min(way, way_of_odometry) > kHasMoved;
  if (have_moved && std::max(way, way_of_odometry) > kWayOfStretch)
    ratios_.push_back(way / way_of_odometry);
}

double MotionComparison::turns_alike() const {
  return turned_ > kTurnsTold ? turned_alike_ / turned_ : 1.0;
}

double MotionComparison::ways_alike() const {
  return ratios_.size() < kFewStretches ? 1.0 : base::Median(ratios_);
}

}  // namespace hires::mapping
