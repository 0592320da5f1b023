#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <hires/ObjectTemperatures.h>
#include <hires/WorldState.h>
#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <optional>
#include <string>
#include <vector>

#include "hires/base/topic_warnings.h"
#include "hires/ros/transforms/transform_listener.h"
#include "nodes/heat_reader/heat_reader_params.h"

namespace hires_ros {

/// Tells how warm known objects are, by the pictures of a thermal camera. tf says where the camera
/// and the robot's own links are at the stamp of a picture, the world tracker where objects are.
/// Works while somebody listens, on the newest picture that came; each gets one answer, also where
/// none of the objects is in it.
class HeatReaderNode {
 public:
  HeatReaderNode(const HeatReaderParams& params, ros::NodeHandle* nh);

 private:
  void ListenWhereHeard();
  void OnPicture(const sensor_msgs::ImageConstPtr& msg);
  void Try();  ///< reads the picture that waits, if all else is there
  std::string WhyUnknown(const std_msgs::Header& header) const;
  void Read(const hires::geometry::Pose3& X_MC);
  hires::geometry::Pose3 InWorld(const hires::geometry::Pose3& X_MF) const;
  std::vector<hires::geometry::Collision> RobotShapes(double time);
  void Refuse(const std::string& why);
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  const HeatReaderParams params_;
  ros::NodeHandle nh_;
  const std::shared_ptr<const hires::perception::Surroundings> surroundings_;
  TransformListener transforms_;
  sensor_msgs::ImageConstPtr waiting_;  // or null
  sensor_msgs::CameraInfoConstPtr info_;
  hires::WorldStateConstPtr known_;

  std::string waits_for_, refused_;    // why the last picture was not read; or empty
  std::vector<std::string> unplaced_;  // links that tf did not know
  ros::Time read_;                     // stamp of the picture that was read last
  long num_pictures_{0}, num_read_{0}, num_refused_{0};
  std::size_t num_objects_{0}, num_regions_{0};  // in the last picture
  hires::base::TopicWarnings warnings_;

  ros::Publisher temperatures_;
  std::vector<ros::Subscriber> inputs_;  // while somebody listens
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer timer_;
};

}  // namespace hires_ros
