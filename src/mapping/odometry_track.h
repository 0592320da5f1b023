#pragma once

#include <deque>
#include <optional>

#include "hires/localisation/robot_log.h"

namespace hires::mapping {

/// Where odometry says the base was, for times a little back.
class OdometryTrack {
 public:
  /// @pre times do not go back.
  void Add(double time, const geometry::Pose2& X_OB);

  /// Between two readings, in proportion to time; after the last one, as that one. Readings that
  /// are older are forgotten.
  /// @return nothing if no reading came before.
  std::optional<geometry::Pose2> At(double time);

  bool Reaches(double time) const { return !readings_.empty() && readings_.back().time >= time; }

 private:
  std::deque<localisation::RobotLog::Odometry> readings_;
};

}  // namespace hires::mapping
