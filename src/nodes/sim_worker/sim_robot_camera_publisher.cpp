#include "nodes/sim_worker/sim_robot_camera_publisher.h"

#include "hires/perception/camera_view.h"
#include "hires/ros/robot/robot_messages.h"
#include "nodes/sim_worker/is_heard.h"
#include "nodes/sim_worker/sensor_messages.h"

namespace hires_ros {
namespace {

constexpr std::uint32_t kPictureQueue = 2;  // pictures are large, and soon old

/// A topic without a name has no listeners either.
template <typename Message>
ros::Publisher Advertise(const std::string& topic, bool is_there, ros::NodeHandle* nh) {
  return is_there && !topic.empty() ? nh->advertise<Message>(topic, kPictureQueue)
                                    : ros::Publisher();
}

template <typename Message>
void Send(Message msg, const std::string& frame, const ros::Time& stamp,
          const ros::Publisher& publisher) {
  msg.header.frame_id = frame;
  msg.header.stamp = stamp;
  publisher.publish(msg);
}

}  // namespace

SimRobotCameraPublisher::SimRobotCameraPublisher(const hires::control::SensorNames& names,
                                                 const hires::robot::Robot& robot,
                                                 hires::sim_robot::SimRobotCameras* cameras,
                                                 ros::NodeHandle* nh)
    : cameras_(*cameras) {
  using sensor_msgs::CameraInfo;
  using sensor_msgs::Image;
  const bool has_depth = cameras_.has_depth_camera(), has_heat = cameras_.has_thermal_camera();
  depth_cloud_ = Advertise<sensor_msgs::PointCloud2>(names.depth_cloud, has_depth, nh);
  depth_image_ = Advertise<Image>(names.depth_image, has_depth, nh);
  depth_info_ = Advertise<CameraInfo>(names.depth_info, has_depth, nh);
  colour_image_ = Advertise<Image>(names.colour_image, has_depth, nh);
  colour_info_ = Advertise<CameraInfo>(names.colour_info, has_depth, nh);
  thermal_image_ = Advertise<Image>(names.thermal_image, has_heat, nh);
  thermal_colours_ = Advertise<Image>(names.thermal_colours, has_heat, nh);
  thermal_info_ = Advertise<CameraInfo>(names.thermal_info, has_heat, nh);
  if (has_depth) depth_frame_ = OpticalFrameOf(robot, robot.profile.upper_body->camera_link);
  if (has_heat) heat_frame_ = OpticalFrameOf(robot, robot.profile.sensors.thermal_camera_link);
}

std::string SimRobotCameraPublisher::OpticalFrameOf(const hires::robot::Robot& robot,
                                                    const std::string& link) {
  if (const auto own = hires::perception::FindOpticalLink(robot.model, link)) return *own;
  const std::string frame = link + "_optical";
  if (!static_tf_) static_tf_.emplace();
  static_tf_->sendTransform(
      MakeTransform(link, frame, hires::perception::OpticalFrame(), ros::Time::now()));
  return frame;
}

void SimRobotCameraPublisher::PublishDepthIfDue(const hires::sim_robot::SimRobotWorld& world,
                                                const ros::Time& stamp) {
  if (cameras_.IsDepthDue(world)) PublishDepth(world, stamp);
}

bool SimRobotCameraPublisher::PublishDepth(const hires::sim_robot::SimRobotWorld& world,
                                           const ros::Time& stamp) {
  const bool wants_cloud = IsHeard(depth_cloud_);
  hires::perception::PointCloud cloud;
  hires::perception::Picture colours;
  if (wants_cloud || IsHeard(depth_image_)) {
    cloud = cameras_.Cloud(world);
    ++num_drawn_;
  }
  if (wants_cloud || IsHeard(colour_image_)) {
    colours = cameras_.Colours(world);
    ++num_drawn_;
  }
  const auto send = [&](const auto& msg, const ros::Publisher& publisher) {
    Send(msg, depth_frame_, stamp, publisher);
  };
  if (wants_cloud) send(ToMsg(cloud, colours), depth_cloud_);
  if (IsHeard(depth_image_)) send(DepthToMsg(cloud), depth_image_);
  if (IsHeard(colour_image_)) send(ToMsg(colours), colour_image_);
  for (const ros::Publisher& info : {depth_info_, colour_info_}) {
    if (IsHeard(info)) send(ToMsg(cameras_.depth_camera()), info);
  }
  return wants_cloud;
}

void SimRobotCameraPublisher::PublishHeatIfDue(const hires::sim_robot::SimRobotWorld& world,
                                               const ros::Time& stamp) {
  if (!cameras_.IsHeatDue(world)) return;
  const auto send = [&](const auto& msg, const ros::Publisher& publisher) {
    Send(msg, heat_frame_, stamp, publisher);
  };
  if (IsHeard(thermal_info_)) send(ToMsg(cameras_.heat_camera()), thermal_info_);
  if (!IsHeard(thermal_image_) && !IsHeard(thermal_colours_)) return;
  const hires::perception::HeatPicture heat = cameras_.Heat(world);
  ++num_drawn_;
  if (IsHeard(thermal_image_)) send(ToMsg(heat), thermal_image_);
  if (IsHeard(thermal_colours_)) send(ToMsg(cameras_.InColours(heat)), thermal_colours_);
}

}  // namespace hires_ros
