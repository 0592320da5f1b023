#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <atomic>
#include <optional>
#include <string>

#include "hires/control/robot_names.h"
#include "sim_robot/sim_robot_cameras.h"

namespace hires_ros {

/// Says what the simulated robot's cameras see, at their periods and while somebody listens:
/// nothing is drawn for nobody. Frames are the optical ones of the robot's URDF; where it has none,
/// they are called after the camera's link and told once as static transforms.
class SimRobotCameraPublisher {
 public:
  /// @param cameras  outlives this.
  SimRobotCameraPublisher(const hires::control::SensorNames& names,
                          const hires::robot::Robot& robot,
                          hires::sim_robot::SimRobotCameras* cameras, ros::NodeHandle* nh);

  void PublishDepthIfDue(const hires::sim_robot::SimRobotWorld& world, const ros::Time& stamp);
  /// Whether it is due or not.
  /// @return whether somebody gets the cloud.
  bool PublishDepth(const hires::sim_robot::SimRobotWorld& world, const ros::Time& stamp);
  void PublishHeatIfDue(const hires::sim_robot::SimRobotWorld& world, const ros::Time& stamp);

  long num_drawn() const { return num_drawn_; }  ///< clouds and pictures so far; any thread may ask

 private:
  std::string OpticalFrameOf(const hires::robot::Robot& robot, const std::string& link);

  hires::sim_robot::SimRobotCameras& cameras_;
  std::optional<tf2_ros::StaticTransformBroadcaster> static_tf_;  // if there is a frame to tell
  std::atomic<long> num_drawn_{0};
  std::string depth_frame_, heat_frame_;
  ros::Publisher depth_cloud_, depth_image_, depth_info_, colour_image_, colour_info_;
  ros::Publisher thermal_image_, thermal_colours_, thermal_info_;
};

}  // namespace hires_ros
