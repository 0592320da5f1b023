#pragma once

#include <actionlib/client/action_client.h>
#include <actionlib_msgs/GoalID.h>
#include <actionlib_msgs/GoalStatusArray.h>
#include <fmt/format.h>
#include <ros/node_handle.h>
#include <ros/this_node.h>

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "hires/base/process.h"

namespace hires_ros {

/// How long a client of an action waits. [s] on a clock that never jumps, unless it says otherwise.
struct ActionLinkParams {
  /// For a server to be there, for it to take a goal, and for a result it says to have sent.
  double server_wait{2.0};
  double server_loss{0.5};  ///< without connection, after which its goals are lost
  /// Without a word from a connected server, both on a steady clock and in main ROS time (whose
  /// standstill silences every server): it hangs.
  double silence{5.0};
  double cancel_wait{10.0};  ///< for a cancelled goal to end, on both clocks
};

/// A client of the action `Action` for many goals at once that never waits: servers may be away,
/// die, hang or come back, and each goal ends in any case. It belongs to one thread; what comes
/// from the server is posted to that thread.
template <typename Action>
class ActionLink {
  ACTION_DEFINITION(Action)

 public:
  using Post = std::function<void(std::function<void()>)>;  ///< to the thread of the owner

  /// A goal's end; null: there will be no answer, and `why` says the reason.
  using OnEnd = std::function<void(int request, const ResultConstPtr& result, int terminal_state,
                                   const std::string& why)>;
  using OnFeedback = std::function<void(int request, const FeedbackConstPtr& feedback)>;

  /// @param post  May be called from any thread, also while this object is being destroyed.
  ActionLink(const std::string& name, const ActionLinkParams& params, ros::NodeHandle* nh,
             Post post, OnEnd on_end, OnFeedback on_feedback = {})
      : name_(name),
        params_(params),
        post_(std::move(post)),
        on_end_(std::move(on_end)),
        on_feedback_(std::move(on_feedback)),
        client_(*nh, name),
        status_(nh->subscribe<actionlib_msgs::GoalStatusArray>(
            name + "/status", 10,
            boost::function<void(const actionlib_msgs::GoalStatusArrayConstPtr&)>(
                [this](const actionlib_msgs::GoalStatusArrayConstPtr& status) {
                  heard_steady_ = hires::base::SteadyNow();
                  heard_ros_ = ros::Time::now().toSec();
                  const std::lock_guard<std::mutex> lock(goals_mutex_);
                  goals_ = status;
                }))),
        cancel_(nh->advertise<actionlib_msgs::GoalID>(name + "/cancel", 10)) {}

  /// @pre `request` is under way nowhere here.
  void Send(int request, Goal goal) {
    Pending& pending = pending_[request];
    pending.goal = std::move(goal);
    pending.asked = hires::base::SteadyNow();
    if (is_available()) Start(request, &pending);
  }

  /// Its end comes as of every goal. Unknown requests (ended just now) are passed over.
  void Cancel(int request) {
    const auto found = pending_.find(request);
    if (found == pending_.end() || found->second.cancelled) return;
    Pending& pending = found->second;
    pending.cancelled = Moment{hires::base::SteadyNow(), ros::Time::now().toSec()};
    if (!pending.handle) {
      post_([this, request] { End(request, nullptr, 0, "cancelled before it was sent"); });
      return;
    }
    // A client that cancels before it knows that its goal was taken may take it for lost.
    if (pending.is_taken) pending.handle->cancel();
  }

  /// To be called again and again, some times a second at least.
  void Tick() {
    const bool is_here = is_available();
    const double now = hires::base::SteadyNow();
    if (is_here) seen_ = now;
    for (const auto& [request, why] : Lost(is_here, now)) {
      pending_.at(request).GiveUp();
      End(request, nullptr, 0, why);
    }
    if (!is_here) return;
    for (auto& [request, pending] : pending_) {
      if (!pending.handle) Start(request, &pending);
    }
  }

  bool is_available() { return client_.isServerConnected() && !is_silent(); }
  bool has(int request) const { return pending_.count(request) > 0; }

  /// Cancels what a process of this node's name left with the server; goals of others go on.
  /// @pre nothing is under way here.
  /// @return false: the server cannot be told yet.
  bool CancelLeftGoals() {
    const actionlib_msgs::GoalStatusArrayConstPtr goals = Goals();
    if (!is_available() || !goals || cancel_.getNumSubscribers() == 0) return false;
    for (const actionlib_msgs::GoalStatus& goal : goals->status_list) {
      if (!IsOfThisName(goal.goal_id) || IsOver(goal)) continue;
      actionlib_msgs::GoalID this_alone;
      this_alone.id = goal.goal_id.id;
      cancel_.publish(this_alone);
    }
    return true;
  }

 private:
  using Client = actionlib::ActionClient<Action>;
  using GoalHandle = typename Client::GoalHandle;

  struct Moment {
    double steady, ros;  // [s]
  };
  struct Pending {
    Goal goal;
    double asked{0.0};  // [s] steady
    std::optional<double> sent;
    std::optional<GoalHandle> handle;
    bool is_taken{false};
    std::optional<double> over;  // [s] steady: the server has ended it, the result is on its way
    std::optional<Moment> cancelled;

    /// A server that only hung must not go on with a goal that was given up.
    void GiveUp() {
      if (handle) handle->cancel();
    }
  };

  /// A client's goals are named by its node, a count and the time.
  static bool IsOfThisName(const actionlib_msgs::GoalID& goal) {
    const std::string beginning = ros::this_node::getName() + "-";
    return goal.id.compare(0, beginning.size(), beginning) == 0;
  }

  static bool IsOver(const actionlib_msgs::GoalStatus& goal) {
    using Status = actionlib_msgs::GoalStatus;
    return goal.status != Status::PENDING && goal.status != Status::ACTIVE;
  }

  actionlib_msgs::GoalStatusArrayConstPtr Goals() const {
    const std::lock_guard<std::mutex> lock(goals_mutex_);
    return goals_;
  }

  void Start(int request, Pending* pending) {
    pending->sent = hires::base::SteadyNow();
    pending->handle = client_.sendGoal(
        pending->goal, [this, request](GoalHandle handle) { OnTransition(request, handle); },
        [this, request](GoalHandle, const FeedbackConstPtr& feedback) {
          if (!on_feedback_) return;
          post_([this, request, feedback] {
            if (has(request)) on_feedback_(request, feedback);
          });
        });
  }

  void OnTransition(int request, GoalHandle handle) {  // on a thread that spins
    const actionlib::CommState state = handle.getCommState();
    if (state == actionlib::CommState::DONE) {
      const ResultConstPtr result = handle.getResult();
      const actionlib::TerminalState terminal = handle.getTerminalState();
      const bool is_lost = terminal == actionlib::TerminalState::LOST;
      post_([this, request, result, terminal, is_lost] {
        End(request, is_lost ? nullptr : result, static_cast<int>(terminal.state_),
            is_lost ? fmt::format("the server of '{}' forgot the goal: it was restarted", name_)
                    : terminal.getText());
      });
    } else if (state != actionlib::CommState::WAITING_FOR_GOAL_ACK) {
      const bool is_over = state == actionlib::CommState::WAITING_FOR_RESULT;
      post_([this, request, is_over] { OnTaken(request, is_over); });
    }
  }

  void OnTaken(int request, bool is_over) {
    const auto found = pending_.find(request);
    if (found == pending_.end()) return;
    if (is_over && !found->second.over) found->second.over = hires::base::SteadyNow();
    if (found->second.is_taken) return;
    found->second.is_taken = true;
    if (found->second.cancelled) found->second.handle->cancel();
  }

  /// Requests that will have no answer, with the reason.
  std::map<int, std::string> Lost(bool is_here, double now) const {
    std::map<int, std::string> lost;
    for (const auto& [request, pending] : pending_) {
      const std::string why = WhyLost(pending, is_here, now);
      if (!why.empty()) lost[request] = why;
    }
    return lost;
  }

  std::string WhyLost(const Pending& pending, bool is_here, double now) const {
    if (!pending.sent) {
      return now - pending.asked > params_.server_wait
                 ? fmt::format("no server of '{}' runs", name_)
                 : "";
    }
    if (!is_here && now - seen_ > params_.server_loss) {
      return fmt::format("the server of '{}' went away", name_);
    }
    if (!pending.is_taken && now - *pending.sent > params_.server_wait) {
      return fmt::format("the server of '{}' does not take the goal", name_);
    }
    // A server that has just started may send it before we are connected to hear it.
    if (pending.over && now - *pending.over > params_.server_wait) {
      return fmt::format("the result of '{}' was lost", name_);
    }
    if (pending.cancelled && IsOver(*pending.cancelled, params_.cancel_wait)) {
      return fmt::format("the server of '{}' does not end the cancelled goal", name_);
    }
    return "";
  }

  static bool IsOver(const Moment& since, double limit) {
    const double steady = hires::base::SteadyNow() - since.steady;
    const double ros = ros::Time::now().toSec() - since.ros;
    return steady > limit && (ros > limit || steady > 6.0 * limit);
  }

  bool is_silent() const {
    return heard_steady_ > 0.0 && hires::base::SteadyNow() - heard_steady_ > params_.silence &&
           ros::Time::now().toSec() - heard_ros_ > params_.silence;
  }

  void End(int request, const ResultConstPtr& result, int terminal, const std::string& why) {
    if (pending_.erase(request) > 0) on_end_(request, result, terminal, why);
  }

  const std::string name_;
  const ActionLinkParams params_;
  const Post post_;
  const OnEnd on_end_;
  const OnFeedback on_feedback_;
  Client client_;
  std::map<int, Pending> pending_;
  double seen_{0.0};  // [s] steady, when the server was last there
  std::atomic<double> heard_steady_{0.0}, heard_ros_{0.0};  // [s], its last status
  mutable std::mutex goals_mutex_;
  actionlib_msgs::GoalStatusArrayConstPtr goals_;  // of the server, as it said last
  ros::Subscriber status_;
  ros::Publisher cancel_;
};

}  // namespace hires_ros
