#include "nodes/hires/episode_recording.h"

#include <hires/Detections.h>
#include <hires/ExecuteActionActionGoal.h>
#include <hires/ExecuteActionActionResult.h>
#include <rosbag/view.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

#include "hires/base/progress.h"
#include "hires/ros/perception/detection_messages.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/ros/transforms/transform_buffer.h"
#include "hires/ros/values/action_messages.h"
#include "hires/ros/values/failure_messages.h"
#include "hires/ros/world/world_messages.h"
#include "nodes/hires/bag_file.h"

namespace hires_ros {
namespace {

namespace reports = hires::reports;
using hires::ExecuteActionResult;
using reports::ActionFate;
using reports::EpisodeBuilder;

ActionFate FateOf(std::uint8_t code) {
  switch (code) {
    case ExecuteActionResult::SUCCEEDED:
      return ActionFate::kSucceeded;
    case ExecuteActionResult::PREEMPTED:
      return ActionFate::kPreempted;
  }
  return ActionFate::kFailed;
}

/// Hands messages of a bag to the builder: conversion alone.
class Reader {
 public:
  Reader(const reports::EpisodeConfig& config, const hires::imagination::ImaginationSetup& setup)
      : config_(config),
        tree_(std::make_shared<TransformBuffer>()),
        builder_(setup,
                 {config.names.map_frame, config.names.odometry_frame, config.names.base_frame},
                 config.names.map_to_world, tree_, config.sample_period) {
    On<tf2_msgs::TFMessage>("transforms", [this](const auto& m) { OnTransforms(m, false); });
    On<tf2_msgs::TFMessage>("static_transforms", [this](const auto& m) { OnTransforms(m, true); });
    On<nav_msgs::Odometry>("odometry", [this](const auto& m) {
      builder_.OnOdometry(m.header.stamp.toSec(), m.header.frame_id, m.child_frame_id, FromMsg(m));
    });
    On<sensor_msgs::JointState>("joint_states", [this](const auto& m) { OnJoints(m); });
    On<hires::Detections>("detections", [this](const auto& m) { OnDetections(m); });
    On<hires::WorldState>("known_objects", [this](const auto& m) { OnKnownObjects(m); });
    On<hires::ExecuteActionActionGoal>("execute_action/goal", [this](const auto& m) {
      builder_.OnGoal(m.goal_id.id, FromMsg(m.goal.action), m.header.stamp.toSec());
    });
    On<hires::ExecuteActionActionResult>("execute_action/result", [this](const auto& m) {
      builder_.OnResult(m.status.goal_id.id, m.header.stamp.toSec(), m.result.duration,
                        FateOf(m.result.code), FromMsg(m.result.failure));
    });
  }

  std::vector<std::string> Topics() const {
    std::vector<std::string> topics;
    for (const auto& [topic, take] : take_) topics.push_back(topic);
    return topics;
  }
  void Take(const rosbag::MessageInstance& message) { take_.at(message.getTopic())(message); }
  EpisodeBuilder& builder() { return builder_; }

 private:
  template <typename Message>
  void On(const std::string& role, std::function<void(const Message&)> take) {
    take_[config_.Of(role).topic] = [this, role, take](const rosbag::MessageInstance& instance) {
      const auto message = instance.instantiate<Message>();
      if (message) return take(*message);
      builder_.Drop(role, "another type than wanted, or of another version of it");
    };
  }

  void OnTransforms(const tf2_msgs::TFMessage& msg, bool are_static) {
    const TransformBuffer::News news = tree_->Take(msg, are_static);
    for (const std::string& why : news.warnings) builder_.Drop("transforms", why);
    for (const double stamp : news.stamps) builder_.OnTransforms(stamp);
  }

  void OnJoints(const sensor_msgs::JointState& msg) {
    if (msg.name.size() != msg.position.size()) {
      return builder_.Drop("joint states", "not one position for each name");
    }
    builder_.OnJoints(msg.header.stamp.toSec(), FromMsg(msg));
  }

  void OnDetections(const hires::Detections& msg) {
    hires::sensing::Look look{msg.header.stamp.toSec(), msg.header.frame_id, {}};
    for (const auto& detection : msg.detections) look.detections.push_back(FromMsg(detection));
    builder_.OnLook(std::move(look));
  }

  void OnKnownObjects(const hires::WorldState& msg) {
    if (hires::sensing::BareFrame(msg.header.frame_id) != config_.names.map_frame) {
      return builder_.Drop("known objects", "in another frame than the map's");
    }
    builder_.OnKnownObjects(msg.header.stamp.toSec(), FromMsg(msg));
  }

  const reports::EpisodeConfig& config_;
  std::shared_ptr<TransformBuffer> tree_;
  EpisodeBuilder builder_;
  std::map<std::string, std::function<void(const rosbag::MessageInstance&)>> take_;  // by topic
};

}  // namespace

EpisodeRecording ReadEpisodeRecording(const std::string& path, const reports::EpisodeConfig& config,
                                      const hires::imagination::ImaginationSetup& setup) {
  EpisodeRecording recording;
  ReadBag(path, [&] {
    rosbag::Bag bag;
    OpenBag(path, &bag);
    const std::vector<BagTopic> topics = TopicsOfBag(bag);
    recording.topics = CheckTopics(config, {topics.begin(), topics.end()});
    Reader reader(config, setup);
    rosbag::View view(bag, rosbag::TopicQuery(reader.Topics()));
    const double size = std::max(1u, view.size());
    long count = 0;
    for (const rosbag::MessageInstance& message : view) {
      if (++count % 1000 == 0) hires::base::ReportProgress("reading " + path, count / size);
      reader.Take(message);
    }
    hires::base::ReportProgress("reading " + path, 1.0);
    recording.missing = reader.builder().MissingText();
    recording.untold_joints = reader.builder().UntoldJoints();
    recording.dropped = reader.builder().dropped();
    recording.episodes = reader.builder().Take();
  });
  return recording;
}

}  // namespace hires_ros
