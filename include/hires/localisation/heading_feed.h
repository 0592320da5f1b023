#pragma once

#include <optional>

#include "hires/localisation/odometry_filter.h"
#include "hires/localisation/robot_log.h"

namespace hires::localisation {

/// Hands an inertial unit's readings to the filter, each with a heading: its own, or where it tells
/// none, its rate integrated by the trapezoidal rule, over 0.25 s at most. After a longer pause the
/// heading counts from another zero, and so it does where the unit begins or ceases to tell one.
class HeadingFeed {
 public:
  /// @param filter  must outlive this.
  explicit HeadingFeed(OdometryFilter* filter) : filter_(*filter) {}

  /// In the order of time. One that is late, by less than robot::kClockReset, is left out.
  FilterOutcome Take(const RobotLog::Inertia& now);

 private:
  OdometryFilter& filter_;
  std::optional<RobotLog::Inertia> before_;
  double yaw_{0.0};  // [rad]
};

}  // namespace hires::localisation
