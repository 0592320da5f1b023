#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <optional>
#include <string>
#include <vector>

#include "hires/control/robot_names.h"
#include "sim_robot/sim_robot_lasers.h"

namespace hires_ros {

/// Says what the simulated robot's nodding laser and that of its tray measure, while somebody
/// listens. The nodding joint is in tf alone: no skill and no rollout knows it.
class SimRobotLaserPublisher {
 public:
  /// @param tells_place  else no clouds are put together, for nobody here knows where the
  ///                     odometry's frame is.
  /// @param lasers  outlives this.
  SimRobotLaserPublisher(const hires::control::RobotNames& names, const hires::robot::Robot& robot,
                         bool tells_place, const hires::sim_robot::SimRobotLasers* lasers,
                         ros::NodeHandle* nh);

  /// The tray's scan, and the cloud of a sweep that is over: for each tick.
  /// @return the topics on which that was sent.
  std::vector<std::string> PublishTick(const hires::sim_robot::SimRobotWorld& world,
                                       const ros::Time& stamp);

  /// The nodding laser's, if one is due: for each look between two ticks.
  /// @param readings  of the last tick.
  void PublishLook(const hires::sim_robot::SimRobotWorld& world,
                   const hires::sim_robot::SensorReadings& readings, const ros::Time& stamp);

  /// Turns the joints of a tick to what tf tells of them.
  void AddTilt(const hires::sim_robot::SimRobotWorld& world,
               hires::robot::JointPositions* joints) const;

 private:
  void PublishTilt(const hires::sim_robot::SimRobotWorld& world, const ros::Time& stamp);

  const hires::sim_robot::SimRobotLasers& lasers_;
  const hires::robot::Robot& robot_;
  const hires::control::SensorNames names_;
  const std::string odometry_frame_;
  std::optional<hires::sim_robot::SweepCloud> sweep_;
  std::optional<hires::perception::PointCloud>
      cloud_;                      // in the odometry's frame, of the last sweep
  std::optional<ros::Time> sent_;  // when that was sent
  ros::Publisher tray_scan_, tilt_scan_, tilt_cloud_, tf_;
};

}  // namespace hires_ros
