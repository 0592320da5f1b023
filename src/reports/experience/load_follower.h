#pragma once

#include <optional>
#include <string>

#include "hires/base/param_reader.h"
#include "hires/geometry/shape.h"
#include "hires/imagination/rollout.h"
#include "hires/robot/observation.h"
#include "hires/robot/robot_profile.h"
#include "hires/world/world.h"
#include "reports/experience/topple_monitor.h"

namespace hires::reports {

/// Finds in the states of a whole run the load that a ToppleMonitor looks at: what stands freely on
/// the robot's tray. It is followed until a hand takes it, it leaves the tray upright, it is no
/// longer there, or it has lain for a while.
class LoadFollower {
 public:
  struct Params {
    std::string object;      ///< instance to follow; empty: the first that stands on the tray
    double after_fall{1.5};  ///< [s] that one that lies is still followed
  };

  /// @throws base::ConfigError where the robot has no tray.
  LoadFollower(const Params& params, const robot::Robot& robot,
               const imagination::RolloutParams& rollout);

  /// One moment. What comes sooner than kExperiencePeriod after the one before is passed over;
  /// after a longer gap, or where time does not grow, differences are taken anew.
  /// @return nothing while nothing is followed, and as ToppleMonitor::Add.
  /// @throws base::ConfigError for joints that the robot has not, and for what is no number.
  std::optional<knowledge::ToppleEpisodePart> Add(double time, const world::WorldState& world,
                                                  const robot::RobotState& robot_state);

  /// What is followed; empty: nothing.
  const std::string& load() const { return load_; }

 private:
  const world::ObjectState* Find(const world::WorldState& world, const geometry::Pose3& X_MT) const;
  bool IsOverTray(const world::ObjectState& object, const geometry::Pose3& X_MT) const;
  bool IsDown(const world::ObjectState& object) const;
  bool IsLost(double time, const world::ObjectState* object, const geometry::Pose3& X_MT);
  void Drop();

  Params params_;
  robot::Robot robot_;
  geometry::Aabb plate_T_;
  double topple_tilt_;  // [rad]
  ToppleMonitor monitor_;
  std::string load_;
  std::optional<double> time_;  // [s] of the last moment that was used
  std::optional<double> down_;  // [s] since when the load lies
};

/// What the node topple_monitor listens to and follows.
struct ToppleMonitorConfig {
  std::string world_topic, robot_topic;
  LoadFollower::Params follower;
};
/// @throws base::ConfigError naming file and key.
ToppleMonitorConfig ReadToppleMonitorConfig(base::ParamReader in);

}  // namespace hires::reports
