#include "nodes/middle_layer/move_base_link.h"

#include <ros/ros.h>

#include "hires/ros/values/geometry_messages.h"

namespace hires_ros {
namespace {

using State = hires::control::MoveBaseNews::State;
using actionlib::CommState;
using actionlib::TerminalState;

State StateOf(const TerminalState& end) {
  switch (end.state_) {
    case TerminalState::SUCCEEDED:
      return State::kArrived;
    case TerminalState::ABORTED:
      return State::kAborted;
    case TerminalState::REJECTED:
      return State::kRejected;
    case TerminalState::PREEMPTED:
    case TerminalState::RECALLED:
      return State::kReplaced;
    case TerminalState::LOST:
      break;
  }
  return State::kLost;
}

}  // namespace

MoveBaseLink::MoveBaseLink(const std::string& action, const std::string& map_frame,
                           const hires::geometry::MapToWorld& map_to_world)
    : map_frame_(map_frame), map_to_world_(map_to_world) {
  ros::NodeHandle nh;
  nh.setCallbackQueue(&queue_);
  client_ = std::make_unique<Client>(nh, action, &queue_);
  thread_ = std::thread([this] {
    while (!is_ending_) queue_.callAvailable(ros::WallDuration(0.02));
  });
}

MoveBaseLink::~MoveBaseLink() {
  Shut();
  is_ending_ = true;
  thread_.join();
  const std::lock_guard<std::mutex> lock(handle_mutex_);
  handle_.reset();
}

bool MoveBaseLink::IsThere() { return client_->isServerConnected(); }

void MoveBaseLink::Open() {
  const std::lock_guard<std::mutex> lock(handle_mutex_);
  is_open_ = true;
}

void MoveBaseLink::Shut() {
  {
    const std::lock_guard<std::mutex> lock(handle_mutex_);
    is_open_ = false;
  }
  Cancel();
}

void MoveBaseLink::Go(const hires::geometry::Pose2& X_MGoal) {
  const std::lock_guard<std::mutex> handle_lock(handle_mutex_);
  if (!is_open_) return;
  std::uint64_t number;
  {
    const std::lock_guard<std::mutex> lock(news_mutex_);
    number = ++current_;
    news_ = {State::kSent, ""};
  }
  move_base_msgs::MoveBaseGoal goal;
  goal.target_pose.header.frame_id = map_frame_;
  goal.target_pose.header.stamp = ros::Time::now();
  goal.target_pose.pose = ToMsg(hires::geometry::Lift(map_to_world_.ToMap(X_MGoal)));
  handle_ = client_->sendGoal(
      goal, [this, number](Client::GoalHandle handle) { OnTransition(number, handle); });
}

void MoveBaseLink::OnTransition(std::uint64_t goal, Client::GoalHandle handle) {
  const CommState state = handle.getCommState();
  if (state == CommState::DONE) {
    const TerminalState end = handle.getTerminalState();
    SetNews(goal, {StateOf(end), end.getText()});
  } else if (state != CommState::WAITING_FOR_GOAL_ACK) {
    SetNews(goal, {State::kDriving, ""});
  }
}

void MoveBaseLink::SetNews(std::uint64_t goal, const hires::control::MoveBaseNews& news) {
  const std::lock_guard<std::mutex> lock(news_mutex_);
  if (goal == current_) news_ = news;
}

void MoveBaseLink::Cancel() {
  const std::lock_guard<std::mutex> lock(handle_mutex_);
  if (!handle_.isExpired()) handle_.cancel();
}

hires::control::MoveBaseNews MoveBaseLink::News() {
  const std::lock_guard<std::mutex> lock(news_mutex_);
  return news_;
}

}  // namespace hires_ros
