#pragma once

#include <actionlib/server/action_server.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <hires/AchieveAction.h>
#include <hires/ExecuteActionAction.h>
#include <hires/ObservationProgress.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "hires/base/mailbox.h"
#include "hires/base/thread_pool.h"
#include "hires/execution/monitor_config.h"
#include "hires/execution/reaction_times.h"
#include "hires/knowledge/pose_watch.h"
#include "hires/planning/operator_data.h"
#include "hires/planning/planner_config.h"
#include "hires/ros/knowledge/remote_view.h"
#include "nodes/execution_monitor/action_link.h"
#include "nodes/execution_monitor/client_watch.h"
#include "nodes/execution_monitor/execution_imagination.h"
#include "nodes/execution_monitor/execution_planning.h"
#include "nodes/execution_monitor/record_writer.h"

namespace hires_ros {

/// The file in ~config (config/execution_monitor.yaml where there is none); ~domain, ~operators,
/// ~robot (paths), ~imagination, ~seed and ~dry_run override it.  @throws hires::base::ConfigError.
hires::execution::MonitorConfig LoadExecutionMonitorParams();

/// What the monitor knows before it is asked; constant.
struct ExecutionKnowledge {
  hires::planning::PlanningKnowledge planning;
  hires::planning::OperatorData operators;
  std::shared_ptr<const hires::knowledge::Ontology> ontology;
};
/// @throws hires::base::ConfigError naming file, line and column.
ExecutionKnowledge LoadExecutionKnowledge(const hires::execution::MonitorConfig& config);

/// The defaults of imagined parameters: ~default ("motion_set=fast") and, where the domain leaves one
/// out, the motion sets of the robot.  @throws hires::base::ConfigError.
void LoadDefaults(const hires::planning::OperatorData& operators,
                  hires::execution::MonitorConfig* config);

/// Answers the action `achieve`: carries the commands of execution::Monitor to planner, translator,
/// imagination client, middle layer and Blackboard, and their answers back. The monitor has one
/// owner, a thread of this node; whatever comes from elsewhere is posted to it, and whatever may
/// block is done on other threads. Servers may be away and come back.
///
/// In a dry run tasks are planned and imagined, and end before the first step: nothing is asked of
/// the middle layer, which need not be there.
class ExecutionMonitorNode {
 public:
  ExecutionMonitorNode(const hires::execution::MonitorConfig& config,
                       const ExecutionKnowledge& knowledge, ros::NodeHandle* nh);
  ~ExecutionMonitorNode();
  ExecutionMonitorNode(const ExecutionMonitorNode&) = delete;
  ExecutionMonitorNode& operator=(const ExecutionMonitorNode&) = delete;

 private:
  using Server = actionlib::ActionServer<hires::AchieveAction>;
  using GoalHandle = Server::GoalHandle;

  struct Posted {
    double time;  ///< [s] steady
    std::function<void()> run;
  };
  struct Task {
    GoalHandle goal;
    hires::execution::MonitorParams params;
    double accepted{0.0};                                ///< [s] steady
    std::unique_ptr<hires::execution::Monitor> monitor;  ///< none: it waits for the state
    bool is_state_current{false};                        ///< all that held when the task came
    bool is_catching_up{false};                          ///< the Blackboard is being asked for it
    std::vector<std::string> warnings;                   ///< all so far
    std::optional<hires::execution::Finish> finish;
    std::optional<hires::AchieveFeedback> told;
    double next_feedback{0.0};  ///< [s] steady
  };

  // On any thread.
  void Post(std::function<void()> run);
  void OnView(const RemoteView::Update& update);
  void OnProgress(const hires::ObservationProgress& progress);

  // On the monitor's thread.
  void Run();
  void Tick();
  void Accept(GoalHandle goal);
  void Refuse(GoalHandle goal, std::uint8_t code, const std::string& reason);
  Task MakeTask(const GoalHandle& goal) const;
  void Preempt(const GoalHandle& goal);
  void OnClientGone(const std::string& goal_id);
  void BeginWhenReady();
  void CatchUp();
  std::string MissingForBegin();
  void WatchClock(double now);
  void Feed(const hires::execution::Event& event);
  void CarryOut(const hires::execution::StartPlanning& command);
  void CarryOut(const hires::execution::CancelPlanning& command);
  void CarryOut(const hires::execution::StartStep& command);
  void CarryOut(const hires::execution::StopStep& command);
  void CarryOut(const hires::execution::StartImagination& command);
  void CarryOut(const hires::execution::MoveDeadline& command);
  void CarryOut(const hires::execution::CancelImagination& command);
  void CarryOut(const hires::execution::Record& command);
  void CarryOut(const hires::execution::Warn& command);
  void CarryOut(const hires::execution::Finish& command);
  void OnStepEnd(int key, const hires::ExecuteActionResultConstPtr& result, const std::string& why);
  void OnState(const hires::execution::StateObserved& state);
  void TellProgress();
  void FinishTask(const hires::execution::Finish& finish);
  void EndAll();
  void Conclude(const hires::execution::Finish& finish);
  hires::AchieveFeedback Status() const;
  void PublishFeedback();
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  const hires::execution::MonitorConfig config_;
  const ExecutionKnowledge& knowledge_;
  hires::base::Mailbox<Posted> mailbox_;
  std::atomic<bool> is_ending_{false};

  // Of the view's thread.
  hires::knowledge::PoseWatch poses_;
  std::vector<hires::base::Atom> atoms_;
  bool has_atoms_{false};

  // Of the monitor's thread.
  std::optional<Task> task_;
  std::optional<hires::execution::StateObserved> state_;
  std::optional<hires::execution::ObservedUntil> observed_until_;
  std::uint64_t sequence_{0};  ///< of the Blackboard, up to which all was told
  std::deque<hires::ObservationProgress> progress_;  ///< in order; not reached yet
  std::map<int, int> activities_;                    ///< the link's key -> the monitor's activity
  int next_key_{1};
  double event_time_{0.0};  ///< [s] steady, of the event being handled; 0: none
  double last_now_{0.0};    ///< [s] main ROS time
  bool has_cleared_{false};
  int num_tasks_{0};
  hires::execution::ReactionTimes reactions_;

  RecordWriter records_;
  PlanRequests planning_;
  ImagineRequests imagination_;
  ActionLink<hires::ExecuteActionAction> steps_;
  RemoteView view_;
  hires::base::ThreadPool catcher_;  // asks the Blackboard, which may take its time
  diagnostic_updater::Updater updater_;
  ros::Subscriber progress_subscriber_;
  ClientWatch client_watch_;
  Server server_;
  std::thread thread_;
};

}  // namespace hires_ros
