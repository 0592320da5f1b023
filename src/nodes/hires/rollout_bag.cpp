#include "nodes/hires/rollout_bag.h"

#include <fmt/format.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include <cmath>
#include <vector>

#include "hires/base/error.h"
#include "hires/robot/posture.h"
#include "hires/ros/conversions.h"
#include "hires/ros/robot_messages.h"
#include "hires/ros/trace_markers.h"

namespace hires_ros {
namespace {

namespace imagination = hires::imagination;
using imagination::RolloutRecording;
using imagination::RolloutSample;

constexpr double kBegin = 1.0;  // [s] a bag has no time 0
constexpr char kOdometryFrame[] = "odom_combined";

ros::Time TimeOf(double time) { return ros::Time(kBegin + time); }

std_msgs::Float64 Number(double value) {
  std_msgs::Float64 message;
  message.data = value;
  return message;
}

class RolloutBag : public imagination::RolloutWatcher {
 public:
  RolloutBag(const std::string& path, const imagination::RolloutSetup& setup)
      : scene_(setup.scene), markers_(1, setup.standing) {
    try {
      bag_.open(path, rosbag::bagmode::Write);
    } catch (const rosbag::BagException& error) {
      throw hires::base::ConfigError(fmt::format(
          "--bag {}: the bag cannot be written ({}); name a file in a folder that is there", path,
          error.what()));
    }
    bag_.setCompression(rosbag::compression::LZ4);
  }

  void OnSample(const hires::simulation::RobotSimulator& simulator) override {
    if (!pictures_.empty() && simulator.time() <= last_) {
      pictures_.clear();
      markers_.Clear();
    }
    last_ = simulator.time();
    markers_.Add(simulator);
    pictures_.push_back(markers_.Draw(simulator));
  }

  void OnEnd(const RolloutRecording& recording) override {
    const ros::Time begin = TimeOf(recording.samples.empty() ? 0.0 : recording.samples[0].time);
    bag_.write("/world_markers", begin, WorldMarkers(scene_->world));
    tf2_msgs::TFMessage fixed;
    fixed.transforms.push_back(MakeTransform("map", kOdometryFrame, {}, begin));
    bag_.write("/tf_static", begin, fixed);
    for (std::size_t i = 0; i < recording.samples.size(); ++i) {
      WriteRobot(recording.samples[i]);
      WriteNumbers(recording, i);
      bag_.write("/rollout/markers", TimeOf(recording.samples[i].time), pictures_.at(i));
    }
    for (const imagination::RolloutEvent& event : recording.events) {
      std_msgs::String text;
      text.data = event.text;
      bag_.write("/rollout/events", TimeOf(event.time), text);
    }
    bag_.close();
  }

 private:
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

  std::shared_ptr<const hires::simulation::Scene> scene_;
  TraceMarkers markers_;
  std::vector<visualization_msgs::MarkerArray> pictures_;  // of each sample
  double last_{0.0};                                       // [s] of the last one
  rosbag::Bag bag_;
};

}  // namespace

std::unique_ptr<imagination::RolloutWatcher> MakeRolloutBag(
    const std::string& path, const imagination::RolloutSetup& setup) {
  return std::make_unique<RolloutBag>(path, setup);
}

}  // namespace hires_ros
