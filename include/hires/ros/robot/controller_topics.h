#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "hires/control/robot_names.h"
#include "hires/robot/observation.h"
#include "hires/robot/trajectory.h"

namespace hires_ros {

/// A controller of joints, told by its own kind of message (RobotNames::trajectory_interface).
class TrajectoryTopic {
 public:
  TrajectoryTopic() = default;  ///< nobody is told anything
  TrajectoryTopic(hires::control::TrajectoryInterface interface, const std::string& topic,
                  ros::NodeHandle* nh);

  void Send(const hires::robot::JointTrajectory& trajectory) const;
  std::string name() const { return publisher_.getTopic(); }
  bool is_heard() const { return publisher_.getNumSubscribers() > 0; }

 private:
  hires::control::TrajectoryInterface interface_{};
  ros::Publisher publisher_;
};

/// A controller of a gripper, likewise (RobotNames::gripper_interface).
class GripperTopic {
 public:
  GripperTopic() = default;
  GripperTopic(hires::control::GripperInterface interface, const std::string& topic,
               ros::NodeHandle* nh);

  void Send(const hires::robot::GripperCommand& command) const;
  std::string name() const { return publisher_.getTopic(); }
  bool is_heard() const { return publisher_.getNumSubscribers() > 0; }

 private:
  hires::control::GripperInterface interface_{};
  ros::Publisher publisher_;
};

}  // namespace hires_ros
