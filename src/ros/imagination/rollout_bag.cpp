#include "hires/ros/imagination/rollout_bag.h"

#include <fmt/format.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "hires/base/error.h"
#include "hires/robot/posture.h"
#include "hires/ros/imagination/trace_markers.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/ros/values/geometry_messages.h"

namespace hires_ros {
namespace {

namespace imagination = hires::imagination;
using imagination::RolloutRecording;
using imagination::RolloutSample;

constexpr char kOdometryFrame[] = "odom_combined";
constexpr double kEventShown = 2.0;  // [s]

std_msgs::Float64 Number(double value) {
  std_msgs::Float64 message;
  message.data = value;
  return message;
}

class RolloutBag : public imagination::RolloutSaver {
 public:
  RolloutBag(std::string path, const imagination::RolloutSetup& setup)
      : path_(std::move(path)), scene_(setup.scene), markers_(1, setup.standing) {}

  void OnBegin() override {
    pictures_.clear();
    markers_.Clear();
  }

  void OnSample(const hires::simulation::RobotSimulator& simulator) override {
    markers_.Add(simulator);
    pictures_.push_back(markers_.Draw(simulator));
  }

  void Save(const RolloutRecording& recording) override {
    const std::string unfinished = path_ + ".unfinished";
    try {
      bag_.open(unfinished, rosbag::bagmode::Write);
      bag_.setCompression(rosbag::compression::LZ4);
      Write(recording);
      bag_.close();
      std::filesystem::rename(unfinished, path_);
    } catch (const std::exception& error) {  // rosbag's, and those of the file system
      std::error_code ignored;
      std::filesystem::remove(unfinished, ignored);
      throw hires::base::ConfigError(
          fmt::format("--bag {}: the bag cannot be written ({}); check folder, rights and space",
                      path_, error.what()));
    }
  }

 private:
  /// Time 0 is none in ROS.
  ros::Time TimeOf(double time) const { return ros::Time(std::max(time, begin_)); }

  void Write(const RolloutRecording& recording) {
    begin_ = recording.samples.empty() ? 0.05 : recording.samples[0].time;
    const ros::Time begin(begin_);
    bag_.write("/world_markers", begin, WorldMarkers(scene_->world));
    tf2_msgs::TFMessage fixed;
    fixed.transforms.push_back(MakeTransform("map", kOdometryFrame, {}, begin));
    bag_.write("/tf_static", begin, fixed);
    for (std::size_t i = 0; i < recording.samples.size(); ++i) {
      WriteRobot(recording.samples[i]);
      WriteNumbers(recording, i);
      WriteMarkers(recording, i);
    }
    for (const imagination::RolloutEvent& event : recording.events) {
      std_msgs::String text;
      text.data = event.text;
      bag_.write("/rollout/events", TimeOf(event.time), text);
    }
  }

  /// With what happened last above the robot.
  void WriteMarkers(const RolloutRecording& recording, std::size_t i) {
    const RolloutSample& sample = recording.samples[i];
    visualization_msgs::MarkerArray markers = pictures_.at(i);
    std::string text;
    for (const imagination::RolloutEvent& event : recording.events) {
      const double ago = sample.time - event.time;
      if (ago >= 0.0 && ago < kEventShown) text = event.text;
    }
    markers.markers.push_back(TextMarker("events", text, sample.X_MB.translation, 1.8, 0.16));
    bag_.write("/rollout/markers", TimeOf(sample.time), markers);
  }

  void WriteRobot(const RolloutSample& sample) {
    const ros::Time stamp = TimeOf(sample.time);
    const hires::robot::Robot& robot = scene_->robot;
    const auto posture = hires::robot::PostureOf(robot, sample.joints);
    tf2_msgs::TFMessage transforms;
    transforms.transforms = LinkTransforms(robot, posture, stamp);
    transforms.transforms.push_back(
        MakeTransform(kOdometryFrame, robot.profile.base_link, sample.X_MB, stamp));
    bag_.write("/tf", stamp, transforms);
    sensor_msgs::JointState joints;
    joints.header.stamp = stamp;
    for (const auto& [name, position] : posture) {
      joints.name.push_back(name);
      joints.position.push_back(position);
    }
    bag_.write("/joint_states", stamp, joints);
    nav_msgs::Odometry odometry;
    odometry.header.stamp = stamp;
    odometry.header.frame_id = kOdometryFrame;
    odometry.child_frame_id = robot.profile.base_link;
    odometry.pose.pose = ToMsg(sample.X_MB);
    odometry.twist.twist = ToMsg(sample.V_B);
    bag_.write("/base_odometry/odom", stamp, odometry);
  }

  void WriteNumbers(const RolloutRecording& recording, std::size_t i) {
    const RolloutSample& sample = recording.samples[i];
    const ros::Time stamp = TimeOf(sample.time);
    bag_.write("/rollout/speed", stamp, Number(std::hypot(sample.V_B.vx, sample.V_B.vy)));
    bag_.write("/rollout/acceleration", stamp, Number(std::hypot(sample.A_B.vx, sample.A_B.vy)));
    bag_.write("/rollout/jerk", stamp, Number(imagination::JerkAt(recording.samples, i)));
    for (std::size_t k = 0; k < recording.objects.size(); ++k) {
      bag_.write("/rollout/tilt/" + recording.objects[k], stamp,
                 Number(hires::geometry::TiltOf(sample.X_MO[k].rotation)));
    }
  }

  const std::string path_;
  std::shared_ptr<const hires::simulation::Scene> scene_;
  TraceMarkers markers_;
  std::vector<visualization_msgs::MarkerArray> pictures_;  // of each sample
  double begin_{0.0};                                      // [s] of the first one
  rosbag::Bag bag_;
};

}  // namespace

std::unique_ptr<imagination::RolloutSaver> MakeRolloutBag(const std::string& path,
                                                          const imagination::RolloutSetup& setup) {
  return std::make_unique<RolloutBag>(path, setup);
}

}  // namespace hires_ros
