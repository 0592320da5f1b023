#include "nodes/imagination_client/worker_link.h"

#include <algorithm>

#include "hires/base/process.h"
#include "hires/ros/names/topic_names.h"

namespace hires_ros {

WorkerLink::WorkerLink(int index, double timeout, ros::NodeHandle* nh, Handler handler)
    : name_(WorkerName(index, kRollout)),
      handler_(std::move(handler)),
      client_(*nh, name_),
      status_(nh->subscribe<actionlib_msgs::GoalStatusArray>(
          name_ + "/status", 10,
          boost::function<void(const actionlib_msgs::GoalStatusArrayConstPtr&)>(
              [this](const actionlib_msgs::GoalStatusArrayConstPtr&) { silence_.Hear(); }))),
      silence_(timeout) {}

WorkerLink::~WorkerLink() { Drop(); }

void WorkerLink::Send(int session, int assignment, const hires::RolloutGoal& goal) {
  jobs_.push_back({session, assignment, goal});
  StartNext();
}

void WorkerLink::Cancel(int session, int assignment) {
  jobs_.erase(std::remove_if(jobs_.begin(), jobs_.end(),
                             [&](const Job& job) {
                               return job.session == session && job.assignment == assignment;
                             }),
              jobs_.end());
  if (running_ && running_->session == session && running_->assignment == assignment) {
    running_->handle.cancel();
    running_.reset();
    StartNext();
  }
}

void WorkerLink::CancelSession(int session) {
  jobs_.erase(std::remove_if(jobs_.begin(), jobs_.end(),
                             [&](const Job& job) { return job.session == session; }),
              jobs_.end());
  if (running_ && running_->session == session) Cancel(session, running_->assignment);
}

void WorkerLink::StartNext() {
  if (running_ || jobs_.empty() || !is_alive_) return;
  // The session that waited longest goes first: sessions take turns.
  auto next = std::find_if(jobs_.begin(), jobs_.end(),
                           [&](const Job& job) { return job.session != last_session_; });
  if (next == jobs_.end()) next = jobs_.begin();
  const Job job = *next;
  jobs_.erase(next);
  last_session_ = job.session;
  running_ = Running{job.session, job.assignment, {}};
  running_->handle = client_.sendGoal(
      job.goal, [this](Client::GoalHandle handle) { OnTransition(handle); },
      [this](Client::GoalHandle handle, const hires::RolloutFeedbackConstPtr& feedback) {
        OnFeedback(handle, feedback);
      });
}

void WorkerLink::OnFeedback(Client::GoalHandle handle,
                            const hires::RolloutFeedbackConstPtr& feedback) {
  if (!running_ || !(running_->handle == handle)) return;
  handler_(Played{running_->session, running_->assignment, feedback->result});
}

void WorkerLink::OnTransition(Client::GoalHandle handle) {
  if (!running_ || !(running_->handle == handle)) return;
  if (!(handle.getCommState() == actionlib::CommState::DONE)) return;
  const Running ended = *running_;
  const auto result = handle.getResult();
  const bool succeeded =
      handle.getTerminalState() == actionlib::TerminalState::SUCCEEDED && result != nullptr;
  running_.reset();
  if (succeeded) {
    handler_(Finished{ended.session, ended.assignment, result->results});
  } else {
    const bool differs = result && result->code == hires::RolloutResult::HASH_DIFFERS;
    handler_(
        Failed{ended.session, ended.assignment,
               result && !result->why.empty() ? result->why : handle.getTerminalState().toString(),
               differs});
  }
  StartNext();
}

void WorkerLink::Look() {
  const bool is_heard = silence_.Look(hires::base::SteadyNow());
  const bool alive = is_heard && client_.isServerConnected();
  if (alive == is_alive_) return;
  is_alive_ = alive;
  if (alive) {
    handler_(Joined{});
  } else {
    Drop();
    handler_(Lost{});
  }
}

void WorkerLink::Drop() {
  jobs_.clear();
  if (running_) running_->handle.reset();
  running_.reset();
}

}  // namespace hires_ros
