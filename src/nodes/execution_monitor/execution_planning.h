#pragma once

#include <hires/PlanAction.h>

#include <functional>
#include <map>

#include "hires/base/thread_pool.h"
#include "hires/execution/monitor.h"
#include "hires/planning/planner_config.h"
#include "nodes/execution_monitor/action_link.h"

namespace hires_ros {

/// Asks the planner for the execution monitor. Belongs to the monitor's thread; what takes time is
/// done on a thread of its own.
class PlanRequests {
 public:
  using Post = std::function<void(std::function<void()>)>;  ///< to the monitor's thread
  using OnAnswer = std::function<void(const hires::execution::PlanArrived&)>;

  /// @param time_limit  [s] for the planner.  @pre `knowledge` outlives the desk.
  PlanRequests(const hires::planning::PlanningKnowledge* knowledge, double time_limit,
               const ActionLinkParams& params, ros::NodeHandle* nh, Post post, OnAnswer on_answer);

  void Start(const hires::execution::StartPlanning& command);
  void Cancel(const hires::execution::CancelPlanning& command);
  void CancelAll();  ///< No answer comes any more.
  void Tick() { link_.Tick(); }
  bool is_available() { return link_.is_available(); }

 private:
  struct Request {
    int id;  ///< the monitor's
    hires::PlanGoal goal;
  };

  void OnEnd(int key, const hires::PlanResultConstPtr& result, const std::string& why);
  void Read(int key, const Request& request, const hires::PlanResultConstPtr& result);
  void Answer(int key, const hires::execution::PlanArrived& answer);

  const hires::planning::PlanningKnowledge* const knowledge_;
  const double time_limit_;
  const Post post_;
  const OnAnswer on_answer_;
  std::map<int, Request> requests_;
  int next_key_{1};
  ActionLink<hires::PlanAction> link_;
  hires::base::ThreadPool reader_;
};

}  // namespace hires_ros
