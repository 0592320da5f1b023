#pragma once

#include <actionlib/server/action_server.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <hires/PlanAction.h>
#include <ros/node_handle.h>

#include <list>
#include <memory>
#include <optional>

#include "hires/base/mailbox.h"
#include "hires/planning/planner_config.h"
#include "nodes/planner/plan_pool.h"

namespace hires_ros {

/// The file in ~config (config/planner.yaml where there is none); ~domain, ~initial (paths) and
/// ~threads win over it.  @throws hires::base::ConfigError.
hires::planning::PlannerConfig LoadPlannerParams();

/// Answers the action `plan`: several requests at once, each on a thread of its own; those beyond
/// wait. The thread that spins never reads, searches or explains; it hands requests to the pool and
/// answers back. Cancelling is answered within 50 ms, whatever the search does at that moment, for
/// ten requests at once as well; a hundred cancelled at once took up to 0.2 s on a busy machine,
/// because actionlib publishes the status of all with each answer.
class PlannerNode {
 public:
  PlannerNode(const hires::planning::PlannerConfig& config,
              hires::planning::PlanningKnowledge knowledge, ros::NodeHandle* nh);

 private:
  using Server = actionlib::ActionServer<hires::PlanAction>;
  using GoalHandle = Server::GoalHandle;

  /// A request that is not answered yet.
  struct Session {
    std::shared_ptr<PlanJob> job;
    GoalHandle goal;
    double next_feedback;                ///< [s] steady
    std::optional<double> cancelled_at;  ///< [s] steady
  };

  void OnGoal(GoalHandle goal);
  void OnCancel(GoalHandle goal);
  void OnTick();
  void SetPace();  ///< ticks are rare while nothing is asked
  void Accept(GoalHandle goal);
  hires::PlanResult AnswerFor(PlanJob* job) const;  ///< on a thread of the pool
  void OnAnswered(PlanAnswered answered);
  bool AnswerOverdue(Session* session, double now);
  void PublishFeedback(Session* session, double now);
  void Finish(Session* session, hires::PlanResult result);
  void Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status);

  const hires::planning::PlannerConfig config_;
  const hires::planning::PlanningKnowledge knowledge_;
  std::list<Session> sessions_;
  int next_id_{1};
  int num_answered_{0};
  hires::base::Mailbox<PlanAnswered> answered_;
  std::unique_ptr<PlanPool> pool_;
  Server server_;
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
  double period_{0.0};  // [s] of it
};

}  // namespace hires_ros
