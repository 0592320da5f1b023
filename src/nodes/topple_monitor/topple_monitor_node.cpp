#include "nodes/topple_monitor/topple_monitor_node.h"

#include <fmt/format.h>

#include <algorithm>

#include "hires/base/action.h"
#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/ros/names/robot_topics.h"
#include "hires/ros/robot/robot_state_messages.h"
#include "hires/ros/values/action_messages.h"
#include "hires/ros/world/world_messages.h"
#include "nodes/topple_monitor/topple_messages.h"

namespace hires_ros {
namespace {

using hires::knowledge::ToppleState;

constexpr int kQueue = 200;               // ten seconds
constexpr std::size_t kMostMoments = 40;  // that wait for their other half: two seconds

}  // namespace

ToppleMonitorNode::ToppleMonitorNode(const ToppleMonitorParams& params, ros::NodeHandle* nh)
    : params_(params),
      store_(params.store, hires::knowledge::ExperienceStore::Mode::kWrite),
      follower_(params.config.follower, params.robot, params.rollout),
      writer_(&store_, params.run),
      parts_(nh->advertise<hires::ToppleEpisodePart>("topple_episode_part", kQueue)),
      worlds_(nh->subscribe(params.config.world_topic, kQueue, &ToppleMonitorNode::OnWorld, this)),
      robots_(nh->subscribe(params.config.robot_topic, kQueue, &ToppleMonitorNode::OnRobot, this)),
      goals_(nh->subscribe(std::string(kExecuteAction) + "/goal", kQueue,
                           &ToppleMonitorNode::OnGoal, this)),
      results_(nh->subscribe(std::string(kExecuteAction) + "/result", kQueue,
                             &ToppleMonitorNode::OnResult, this)) {
  updater_.setHardwareID("topple_monitor");
  updater_.add("load", this, &ToppleMonitorNode::Diagnose);
  timer_ = nh->createSteadyTimer(ros::WallDuration(1.0), [this](const ros::SteadyTimerEvent&) {
    writer_.Flush();
    TellProblem();
    updater_.force_update();  // also while the simulated time stands
  });
}

ToppleMonitorNode::~ToppleMonitorNode() {
  writer_.Flush();
  if (writer_.problem().empty()) return;
  hires::base::Log(hires::base::LogLevel::kError,
                   fmt::format("experiences lost parts={} why={}",
                               num_parts_ - writer_.num_written(), writer_.problem()));
}

void ToppleMonitorNode::OnWorld(const hires::WorldStateConstPtr& msg) {
  MomentAt(msg->header.stamp)->world = msg;
  TakeWhole();
}

void ToppleMonitorNode::OnRobot(const hires::RobotStateConstPtr& msg) {
  MomentAt(msg->joints.header.stamp)->robot = msg;
  TakeWhole();
}

ToppleMonitorNode::Moment* ToppleMonitorNode::MomentAt(const ros::Time& stamp) {
  for (Moment& moment : moments_) {
    if (moment.stamp == stamp) return &moment;
  }
  if (moments_.size() == kMostMoments) moments_.pop_front();
  moments_.push_back({stamp, {}, {}});
  return &moments_.back();
}

/// Uses the moment that has just become whole. Each topic keeps its order, so what waits for longer
/// waits in vain.
void ToppleMonitorNode::TakeWhole() {
  const auto whole = std::find_if(moments_.begin(), moments_.end(), [](const Moment& moment) {
    return moment.world && moment.robot;
  });
  if (whole == moments_.end()) return;
  const Moment moment = *whole;
  moments_.erase(moments_.begin(), whole + 1);
  if (moment.stamp != last_) Use(moment);  // else the world stands
}

void ToppleMonitorNode::Use(const Moment& moment) {
  if (moment.stamp < last_) {  // whoever did something then is gone with the clock
    writer_.SetRun(fmt::format("{}/{}", params_.run, ++num_runs_));
    actions_.clear();
    TellActions();
  }
  last_ = moment.stamp;
  ++num_moments_;
  try {
    const auto part =
        follower_.Add(moment.stamp.toSec(), FromMsg(*moment.world), FromMsg(*moment.robot));
    refused_.clear();
    if (part) Note(*part, moment.world->header);
  } catch (const hires::base::ConfigError& error) {
    ++num_refused_;
    refused_ = error.what();
    warnings_.Tell(params_.config.world_topic, "dropped", refused_);
  }
}

void ToppleMonitorNode::Note(const hires::knowledge::ToppleEpisodePart& part,
                             const std_msgs::Header& header) {
  parts_.publish(ToMsg(part, header, params_.robot.profile.base_link));
  writer_.Add(part);
  ++num_parts_;
  if (part.state == ToppleState::kTopple && state_ != ToppleState::kTopple) {
    ++num_falls_;
    hires::base::Log(hires::base::LogLevel::kInfo,
                     fmt::format("topples object={} episode={} time={:.2f}", follower_.load(),
                                 part.episode, part.time));
  }
  state_ = part.state;
  TellProblem();
}

void ToppleMonitorNode::TellProblem() {
  if (writer_.problem() != problem_ && !writer_.problem().empty()) {
    hires::base::Log(hires::base::LogLevel::kError,
                     fmt::format("experiences wait why={}", writer_.problem()));
  }
  problem_ = writer_.problem();
}

void ToppleMonitorNode::OnGoal(const hires::ExecuteActionActionGoalConstPtr& msg) {
  actions_[msg->goal_id.id] = hires::base::ToString(FromMsg(msg->goal.action));
  TellActions();
}

void ToppleMonitorNode::OnResult(const hires::ExecuteActionActionResultConstPtr& msg) {
  actions_.erase(msg->status.goal_id.id);
  TellActions();
}

void ToppleMonitorNode::TellActions() {
  std::vector<std::string> texts;
  for (const auto& [id, text] : actions_) texts.push_back(text);
  writer_.SetAction(hires::base::Join(texts, "; "));
}

void ToppleMonitorNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const std::string from =
      fmt::format("{} and {} of one stamp", worlds_.getTopic(), robots_.getTopic());
  if (!writer_.problem().empty()) {
    status.summary(DiagnosticStatus::ERROR,
                   "cannot write, keeps what comes and tries again: " + writer_.problem());
  } else if (!refused_.empty()) {
    status.summary(DiagnosticStatus::WARN, "dropped a moment: " + refused_);
  } else if (num_moments_ == 0) {
    status.summary(DiagnosticStatus::WARN, "waits for " + from);
  } else if (follower_.load().empty()) {
    status.summary(DiagnosticStatus::OK,
                   params_.config.follower.object.empty()
                       ? "waits for something that stands on the tray"
                       : "waits for " + params_.config.follower.object + " to stand on the tray");
  } else {
    status.summary(DiagnosticStatus::OK, "looks at " + follower_.load());
  }
  status.add("store", params_.store);
  status.add("moments", num_moments_);
  status.add("dropped", num_refused_);
  status.add("parts", num_parts_);
  status.add("written", writer_.num_written());
  status.add("lost", writer_.num_lost());
  status.add("falls", num_falls_);
}

}  // namespace hires_ros
