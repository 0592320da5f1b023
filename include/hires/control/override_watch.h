#pragma once

#include <optional>

#include "hires/geometry/pose.h"

namespace hires::control {

struct OverrideParams {
  double after{1.0};     ///< [s] that the base must move otherwise than commanded
  double linear{0.15};   ///< [m/s] more than ramps, delays and noise explain for so long
  double angular{0.35};  ///< [rad/s] likewise
};

/// Notices that a person drives with the joystick, which has priority in the robot's multiplexer.
/// Time is handed in.
class OverrideWatch {
 public:
  explicit OverrideWatch(const OverrideParams& params) : params_(params) {}

  void Command(const geometry::Twist2& V_B) { commanded_ = V_B; }

  /// How the base moved at `now` [s].
  void See(double now, const geometry::Twist2& V_B);

  /// No action of ours drives any more.
  void Forget();

  bool is_overridden() const { return is_overridden_; }

 private:
  bool Differs(const geometry::Twist2& V_B) const;

  OverrideParams params_;
  std::optional<geometry::Twist2> commanded_;
  std::optional<double> since_;  // [s] it moves otherwise
  bool is_overridden_{false};
};

}  // namespace hires::control
