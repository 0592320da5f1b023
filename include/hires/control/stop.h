#pragma once

#include <optional>
#include <set>
#include <string>

#include "hires/base/param_reader.h"
#include "hires/navigation/braking.h"
#include "hires/robot/observation.h"
#include "hires/robot/robot_profile.h"

namespace hires::control {

/// What a load bears, and how stops are planned for it.
struct LoadBraking {
  navigation::BrakingLimits limits;
  navigation::BrakingParams params;
};

/// How the robot comes to rest when an action is broken off.
struct StopParams {
  double linear_deceleration{1.0};   ///< [m/s^2] gentle: something may stand on the tray
  double angular_deceleration{2.0};  ///< [rad/s^2]
  double still_speed{0.01};          ///< [m/s], [rad/s], of base and joints: counts as standing
  double patience{3.0};              ///< [s] after which it counts as stopped in any case
  /// Where it is there the base stops as the load bears it, and not by the decelerations above.
  std::optional<LoadBraking> braking;
};

/// The block `stopping` of config/middle_layer.yaml; no braking.
/// @throws base::ConfigError naming the key.
StopParams ReadStopParams(base::ParamReader in);

/// Brings groups of joints and the base to rest: the base along a ramp, joints where they can be
/// stopped within the limits of their acceleration. Hands stay as they are: what is held stays
/// held.
class Stop {
 public:
  /// @param groups  as actions::GroupsOf.
  Stop(const robot::Robot& robot, std::set<std::string> groups, const StopParams& params);

  /// The command for now; the first call begins the stopping.
  /// @param time  [s] any clock that goes on.
  robot::Command Update(double time, const robot::Observation& seen);

  bool is_over() const { return is_over_; }

 private:
  geometry::Twist2 RampAt(double elapsed) const;
  robot::JointTrajectory HaltOf(const std::vector<std::string>& joints,
                                const robot::Observation& seen) const;
  void HaltJoints(const robot::Observation& seen, robot::Command* command) const;
  bool IsStill(const robot::Observation& seen) const;
  std::vector<std::string> JointsOf(const std::string& group) const;

  const robot::Robot& robot_;
  std::set<std::string> groups_;
  StopParams params_;
  std::optional<double> begin_;
  geometry::Twist2 V_begin_;
  std::optional<navigation::PlanarStop> ramp_;
  bool is_over_{false};
};

}  // namespace hires::control
