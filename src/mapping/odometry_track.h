#pragma once

#include <deque>
#include <optional>

#include "hires/localisation/robot_log.h"
#include "hires/robot/odometry_jumps.h"

namespace hires::mapping {

/// Where odometry says the base was, for times a little back. A reset counts as no motion: poses
/// after it go on in the frame of those before.
class OdometryTrack {
 public:
  /// @param max_linear_speed, max_angular_speed  [m/s], [rad/s] faster odometry was reset.
  OdometryTrack(double max_linear_speed, double max_angular_speed)
      : jumps_(max_linear_speed, max_angular_speed) {}

  /// @pre times do not go back.
  void Add(double time, const geometry::Pose2& X_OB);

  /// Between two readings, in proportion to time; after the last one, as that one. Readings that
  /// are older are forgotten.
  /// @return nothing if no reading came before.
  std::optional<geometry::Pose2> At(double time);

  /// Resets up to the time that At was last asked for.
  int num_resets() const { return readings_.empty() ? 0 : readings_.front().num_resets; }

  bool Reaches(double time) const { return !readings_.empty() && readings_.back().time >= time; }

 private:
  struct Reading : localisation::RobotLog::Odometry {
    int num_resets{0};  // up to it
  };
  robot::OdometryJumps jumps_;
  std::deque<Reading> readings_;
  geometry::Pose2 X_OB_;                 // last reading as it came
  std::optional<geometry::Pose2> X_FO_;  // its frame in the first one, after a reset
};

}  // namespace hires::mapping
