#include "nodes/hires/episode_writer.h"

#include <fmt/format.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <hires/AchieveActionGoal.h>
#include <hires/AchieveActionResult.h>
#include <hires/Detections.h>
#include <hires/ExecuteActionActionGoal.h>
#include <hires/ExecuteActionActionResult.h>
#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>

#include <map>
#include <utility>

#include "hires/base/error.h"
#include "hires/imagination/client_config.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/robot/load_robot.h"
#include "hires/ros/execution/step_messages.h"
#include "hires/ros/perception/detection_messages.h"
#include "hires/ros/robot/controller_messages.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/ros/values/action_messages.h"
#include "hires/ros/values/failure_messages.h"
#include "hires/ros/values/geometry_messages.h"
#include "hires/ros/world/world_messages.h"
#include "nodes/hires/achieve_messages.h"
#include "reports/episode/episode_topics.h"

namespace hires_ros {
namespace {

namespace loop = hires::loop;
namespace reports = hires::reports;
namespace loop = hires::loop;
using hires::control::ActionEnd;

constexpr char kTaskGoal[] = "loop_task";

/// The camera's link of the robot that loops are played with; empty: it has none.
std::string CameraOf(const std::string& package_folder) {
  namespace imagination = hires::imagination;
  const auto client =
      imagination::ReadClientConfig(package_folder + "/config/imagination_client.yaml");
  const auto robot = hires::robot::LoadAnyRobot(imagination::ReadSetupConfig(client.scene).robot);
  return robot.profile.upper_body ? robot.profile.upper_body->camera_link : "";
}

actionlib_msgs::GoalStatus StatusOf(const actionlib_msgs::GoalID& id, ActionEnd end) {
  actionlib_msgs::GoalStatus status;
  status.goal_id = id;
  status.status = end == ActionEnd::kSucceeded   ? actionlib_msgs::GoalStatus::SUCCEEDED
                  : end == ActionEnd::kPreempted ? actionlib_msgs::GoalStatus::PREEMPTED
                                                 : actionlib_msgs::GoalStatus::ABORTED;
  return status;
}

std::uint8_t CodeOf(ActionEnd end) {
  return end == ActionEnd::kSucceeded   ? hires::ExecuteActionResult::SUCCEEDED
         : end == ActionEnd::kPreempted ? hires::ExecuteActionResult::PREEMPTED
                                        : hires::ExecuteActionResult::FAILED;
}

std::uint8_t CodeOf(loop::AchieveOutcome outcome) {
  using Outcome = loop::AchieveOutcome;
  switch (outcome) {
    case Outcome::kSucceeded:
      return hires::AchieveResult::SUCCEEDED;
    case Outcome::kNoPlan:
      return hires::AchieveResult::NO_PLAN;
    case Outcome::kPreempted:
      return hires::AchieveResult::PREEMPTED;
    case Outcome::kInvalid:
      return hires::AchieveResult::INVALID;
    case Outcome::kBusy:
      return hires::AchieveResult::BUSY;
    case Outcome::kDryRun:
      return hires::AchieveResult::DRY_RUN;
    case Outcome::kFailed:
      break;
  }
  return hires::AchieveResult::FAILED;
}

class EpisodeWriter : public loop::LoopRecording {
 public:
  EpisodeWriter(const std::string& path, const std::string& package_folder)
      : config_(reports::ReadEpisodeConfig(package_folder + "/config/episode.yaml")),
        camera_(CameraOf(package_folder)) {
    try {
      bag_.open(path, rosbag::bagmode::Write);
    } catch (const rosbag::BagException& error) {
      throw hires::base::ConfigError(fmt::format(
          "--record {}: the bag cannot be written ({}); name a file in a folder that is there",
          path, error.what()));
    }
    bag_.setCompression(rosbag::compression::LZ4);
  }

  loop::LoopObserver observer() override {
    return {[this](const loop::SensorNews& news) { OnSensed(news); },
            [this](double time, const hires::robot::Command& command) { OnCommand(time, command); },
            [this](double time, const hires::world::WorldState& known) { OnKnown(time, known); },
            [this](double time, int activity, const hires::base::ActionCall& action) {
              OnBegan(time, activity, action);
            },
            [this](double time, int activity, ActionEnd end, const hires::base::Failure& failure) {
              OnEnded(time, activity, end, failure);
            }};
  }

  void Finish(const loop::AchieveReport& report) override;

 private:
  template <typename Message>
  void Write(const std::string& role, double time, const Message& message) {
    bag_.write(config_.Of(role).topic, ros::Time(time), message);
  }
  void WriteTransform(const std::string& parent, const std::string& child,
                      const hires::geometry::Pose2& X_PC, double time) {
    tf2_msgs::TFMessage message;
    message.transforms.push_back(
        MakeTransform(parent, child, hires::geometry::Lift(X_PC), ros::Time(time)));
    Write("transforms", time, message);
  }
  void OnSensed(const loop::SensorNews& news);
  void OnSeen(double time, const std::vector<hires::perception::Detection>& seen);
  void OnCommand(double time, const hires::robot::Command& command);
  void OnKnown(double time, const hires::world::WorldState& known);
  void OnBegan(double time, int activity, const hires::base::ActionCall& action);
  void OnEnded(double time, int activity, ActionEnd end, const hires::base::Failure& failure);

  const reports::EpisodeConfig config_;
  const std::string camera_;
  rosbag::Bag bag_;
  std::map<int, actionlib_msgs::GoalID> goals_;  // of the actions that run, by activity
};

void EpisodeWriter::OnSensed(const loop::SensorNews& news) {
  const auto& names = config_.names;
  const ros::Time stamp(news.stamp);
  if (news.is_tick) {
    WriteTransform(names.map_frame, names.odometry_frame, news.readings.X_MO, news.stamp);
    geometry_msgs::PoseWithCovarianceStamped pose;
    pose.header.stamp = stamp;
    pose.header.frame_id = names.map_frame;
    pose.pose.pose = ToMsg(hires::geometry::Lift(news.readings.X_MB));
    Write("localisation", news.stamp, pose);
  }
  WriteTransform(names.odometry_frame, names.base_frame, news.readings.odometry.X_OB, news.stamp);
  if (news.seen) OnSeen(news.stamp, news.seen->detections);
  Write("joint_states", news.stamp, ToMsg(news.readings.joints, stamp));
  nav_msgs::Odometry odometry;
  odometry.header.stamp = stamp;
  odometry.header.frame_id = names.odometry_frame;
  odometry.child_frame_id = names.base_frame;
  odometry.pose.pose = ToMsg(hires::geometry::Lift(news.readings.odometry.X_OB));
  odometry.twist.twist = ToMsg(news.readings.odometry.V_B);
  Write("odometry", news.stamp, odometry);
}

void EpisodeWriter::OnSeen(double time, const std::vector<hires::perception::Detection>& seen) {
  hires::Detections message;
  message.header.stamp = ros::Time(time);
  message.header.frame_id = camera_;
  for (const auto& detection : seen) message.detections.push_back(ToMsg(detection));
  Write("detections", time, message);
}

void EpisodeWriter::OnCommand(double time, const hires::robot::Command& command) {
  if (command.base_velocity) Write("base_command", time, ToMsg(*command.base_velocity));
  for (const auto& [group, trajectory] : command.trajectories) {
    const auto topic = config_.names.trajectories.find(group);
    if (topic == config_.names.trajectories.end()) continue;
    trajectory_msgs::JointTrajectory message = ToMsg(trajectory);
    bag_.write('/' + topic->second, ros::Time(time), message);
  }
  for (const auto& [arm, gripper] : command.grippers) {
    const auto topic = config_.names.grippers.find(arm);
    if (topic == config_.names.grippers.end()) continue;
    bag_.write('/' + topic->second, ros::Time(time),
               Pr2GripperCommand{gripper.gap, gripper.max_effort});
  }
}

void EpisodeWriter::OnKnown(double time, const hires::world::WorldState& known) {
  hires::WorldState message = ToMsg(known);
  message.header.stamp = ros::Time(time);
  message.header.frame_id = config_.names.map_frame;
  Write("known_objects", time, message);
}

void EpisodeWriter::OnBegan(double time, int activity, const hires::base::ActionCall& action) {
  hires::ExecuteActionActionGoal message;
  message.header.stamp = ros::Time(time);
  message.goal_id.stamp = ros::Time(time);
  message.goal_id.id = fmt::format("loop_{}", activity);
  message.goal.action = ToMsg(action);
  goals_[activity] = message.goal_id;
  Write("execute_action/goal", time, message);
}

void EpisodeWriter::OnEnded(double time, int activity, ActionEnd end,
                            const hires::base::Failure& failure) {
  const auto goal = goals_.find(activity);
  if (goal == goals_.end()) return;  // it ended already
  hires::ExecuteActionActionResult message;
  message.header.stamp = ros::Time(time);
  message.status = StatusOf(goal->second, end);
  message.result.code = CodeOf(end);
  message.result.failure = ToMsg(failure);
  message.result.duration = time - goal->second.stamp.toSec();
  goals_.erase(goal);
  Write("execute_action/result", time, message);
}

/// The task and what became of it: steps, and what was predicted of them.
void EpisodeWriter::Finish(const loop::AchieveReport& report) {
  const double begin = loop::BeginOf(report.status), end = report.status.now;
  hires::AchieveActionGoal goal;
  goal.header.stamp = ros::Time(begin);
  goal.goal_id.stamp = ros::Time(begin);
  goal.goal_id.id = kTaskGoal;
  goal.goal.task = report.task;
  Write("achieve/goal", begin, goal);
  hires::AchieveActionResult result;
  result.header.stamp = ros::Time(end);
  result.status.goal_id = goal.goal_id;
  result.status.status = report.outcome == loop::AchieveOutcome::kSucceeded
                             ? actionlib_msgs::GoalStatus::SUCCEEDED
                             : actionlib_msgs::GoalStatus::ABORTED;
  result.result.code = CodeOf(report.outcome);
  result.result.failure = ToMsg(report.failure);
  result.result.reason = report.reason;
  result.result.episode = report.episode;
  result.result.replans = report.status.replans;
  for (const auto& step : report.status.steps) result.result.steps.push_back(ToMsg(step));
  for (const auto& step : report.status.imaginations) {
    result.result.imaginations.push_back(ToMsg(step));
  }
  result.result.warnings = report.status.warnings;
  Write("achieve/result", end, result);
  bag_.close();
}

}  // namespace

std::unique_ptr<loop::LoopRecording> MakeEpisodeWriter(const std::string& path,
                                                       const std::string& package_folder) {
  return std::make_unique<EpisodeWriter>(path, package_folder);
}

}  // namespace hires_ros
