#pragma once

#include <hires/BaseGuardState.h>
#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <optional>

#include "hires/control/action_runner.h"
#include "hires/control/drive_permit.h"
#include "hires/control/override_watch.h"
#include "hires/imagination/imagination_setup.h"
#include "nodes/middle_layer/middle_layer_params.h"
#include "nodes/middle_layer/move_base_link.h"
#include "nodes/middle_layer/robot_controllers.h"

namespace hires_ros {

/// What an action that drives needs beside its skill: permission of the base's guard, brakes that
/// suit the load, the robot's own move_base where that drives, and whether a person drives instead.
/// Not made in a dry run.
class BaseDriving {
 public:
  /// @param controllers  outlive this.
  /// @param fail  ends all that runs: the guard stopped the base, or is not there any more.
  BaseDriving(const MiddleLayerParams& params, const hires::imagination::ImaginationSetup& setup,
              const RobotControllers* controllers,
              std::function<void(const hires::base::Failure&)> fail, ros::NodeHandle* nh);

  /// A skill of ours, or the robot's own move_base.
  /// @throws hires::base::ConfigError as skills::MakeSkill.
  std::unique_ptr<hires::skills::Skill> MakeSkill(const hires::base::ActionCall& action) const;

  void Begin(int id, const hires::base::ActionCall& action);  ///< it has the base from now on
  void BreakOff();   ///< of the action that has the base: move_base must stop
  void End(int id);  ///< of the action that has the base
  void Tick();       ///< asks for permission again, where it is time

  void Command(const hires::geometry::Twist2& V_B) { override_.Command(V_B); }
  void See(double time, const hires::robot::Observation& seen);

  /// How hard the base may brake with what it carries; nothing if that is not due to be found out,
  /// or there is no guard.
  std::optional<hires::control::LoadBraking> WeighLoad(double time,
                                                       const hires::robot::Observation& seen);

  bool is_overridden() const { return override_.is_overridden(); }
  std::uint64_t request() const { return permit_.id(); }  ///< to the guard; 0: none

 private:
  void Send(const hires::control::DriveRequest& request);
  void OnGuardState(const hires::BaseGuardState& state);
  void OnGuardStopped(const hires::base::Failure& failure);

  const GuardParams guard_;
  const hires::control::MoveBaseDriveParams navigation_;
  const hires::imagination::ImaginationSetup& setup_;
  const RobotControllers* controllers_;
  const std::function<void(const hires::base::Failure&)> fail_;
  hires::control::DrivePermit permit_;
  hires::control::OverrideWatch override_;
  std::shared_ptr<MoveBaseLink> move_base_;             // where it drives long ways; else null
  hires::navigation::BrakingLimits braking_{0.0, 0.0};  // what the load bears; 0: unknown
  double weighed_{-1.0};                                // [s] when that was found out
  ros::Publisher request_;
  ros::Subscriber guard_state_;
};

}  // namespace hires_ros
