#pragma once

#include <actionlib/server/action_server.h>
#include <hires/ExecuteActionAction.h>
#include <ros/node_handle.h>

#include <chrono>
#include <functional>
#include <list>
#include <map>
#include <string>
#include <vector>

#include "hires/base/action.h"
#include "hires/base/failure.h"
#include "hires/control/action_runner.h"

namespace hires_ros {

/// Goals of the action `execute_action`, from their arrival to their results. A goal whose
/// controllers and sensors are not connected yet waits for them.
class ActionGoals {
 public:
  struct Params {
    double start_patience;   ///< [s] by the wall's clock, that a goal may wait
    double feedback_period;  ///< [s]
    bool dry_run;            ///< goals that are valid are refused
  };
  struct Hooks {
    /// Throws ConfigError for an action that cannot be made.
    std::function<void(const hires::base::ActionCall&)> check;
    /// Why the action would fail at once; what is missing may come.
    std::function<hires::base::Failure(const hires::base::ActionCall&)> why_not_ready;
    /// Returns why not, if it does not start.
    std::function<hires::base::Failure(int id, const hires::base::ActionCall&, double time_limit)>
        start;
    std::function<void(int id, const hires::base::ActionCall&)> started;
    std::function<void(int id)> cancel;
  };

  /// Takes goals from Start() on.
  ActionGoals(const Params& params, Hooks hooks, ros::NodeHandle* nh);
  void Start() { server_.start(); }

  void StartWaiting();  ///< those that can start now
  void PublishFeedback(const std::vector<hires::control::ActionNews>& news);
  /// @pre `started` was called for this action.
  void End(const hires::control::ActionNews& news, hires::control::ActionEnd end,
           const hires::base::Failure& failure);

  long num_ended() const { return num_ended_; }

 private:
  using Server = actionlib::ActionServer<hires::ExecuteActionAction>;
  using GoalHandle = Server::GoalHandle;
  using Steady = std::chrono::steady_clock;

  struct Waiting {
    GoalHandle goal;
    Steady::time_point since;
  };
  struct Going {
    GoalHandle goal;
    double next_feedback{0.0};  // [s] since its start
    std::string phase;
  };

  void OnGoal(GoalHandle goal);
  void OnCancel(GoalHandle goal);
  void StartGoal(GoalHandle goal);

  const Params params_;
  const Hooks hooks_;
  std::list<Waiting> waiting_;
  std::map<int, Going> going_;
  int next_id_{1};
  long num_ended_{0};
  Server server_;
};

}  // namespace hires_ros
