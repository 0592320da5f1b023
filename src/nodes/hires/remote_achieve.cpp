#include "nodes/hires/remote_achieve.h"

#include <actionlib/client/simple_action_client.h>
#include <fmt/format.h>
#include <hires/AchieveAction.h>
#include <ros/ros.h>

#include <mutex>
#include <optional>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/ros/execution/step_messages.h"
#include "hires/ros/names/topic_names.h"
#include "hires/ros/values/failure_messages.h"
#include "nodes/hires/achieve_messages.h"
#include "nodes/hires/remote_server.h"

namespace hires_ros {
namespace {

namespace loop = hires::loop;
using AchieveClient = actionlib::SimpleActionClient<hires::AchieveAction>;

constexpr double kStopWait = 60.0;  // [s] for the robot to come to a stand

/// Of a feedback or a result.
template <typename Message>
loop::AchieveStatus StatusOf(const Message& message) {
  loop::AchieveStatus status;
  status.now = ros::Time::now().toSec();
  for (const auto& step : message.steps) status.steps.push_back(FromMsg(step));
  for (const auto& step : message.imaginations) status.imaginations.push_back(FromMsg(step));
  status.replans = message.replans;
  status.warnings = message.warnings;
  return status;
}

loop::AchieveOutcome OutcomeOf(std::uint8_t code) {
  using Outcome = loop::AchieveOutcome;
  switch (code) {
    case hires::AchieveResult::SUCCEEDED:
      return Outcome::kSucceeded;
    case hires::AchieveResult::NO_PLAN:
      return Outcome::kNoPlan;
    case hires::AchieveResult::PREEMPTED:
      return Outcome::kPreempted;
    case hires::AchieveResult::INVALID:
      return Outcome::kInvalid;
    case hires::AchieveResult::BUSY:
      return Outcome::kBusy;
    case hires::AchieveResult::DRY_RUN:
      return Outcome::kDryRun;
  }
  return Outcome::kFailed;
}

[[noreturn]] void FailAsMonitorIsGone() {
  throw hires::base::ConfigError(
      "the execution monitor went away during the task; see its log, and whether the robot stands");
}

/// Feedback on its way from the thread that spins.
class Feedback {
 public:
  void Put(loop::AchieveStatus status) {
    const std::lock_guard<std::mutex> lock(mutex_);
    latest_ = std::move(status);
  }
  std::optional<loop::AchieveStatus> Take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::exchange(latest_, std::nullopt);
  }

 private:
  std::mutex mutex_;
  std::optional<loop::AchieveStatus> latest_;
};

/// The conversation about one task.
class Conversation {
 public:
  Conversation(const loop::AchieveQuery& query, const loop::OnAchieveStatus& on_status,
               const std::function<bool()>& cancelled)
      : query_(query),
        on_status_(on_status),
        cancelled_(cancelled),
        client_(kAchieveAction, true) {}

  loop::AchieveReport Run() {
    RequireServer();
    hires::AchieveGoal goal;
    goal.task = query_.task;
    goal.imagination = query_.imagination;
    client_.sendGoal(goal, {}, {}, [this](const hires::AchieveFeedbackConstPtr& feedback) {
      feedback_.Put(StatusOf(*feedback));
    });
    while (!client_.getState().isDone()) {
      Pass();
      ros::WallDuration(kPollPeriod).sleep();
    }
    Show();
    if (client_.getState() == actionlib::SimpleClientGoalState::LOST) FailAsMonitorIsGone();
    return ReportOf(*client_.getResult());
  }

 private:
  void RequireServer() {
    if (PollUntil([this] { return client_.isServerConnected(); }, query_.wait, cancelled_)) return;
    throw hires::base::ConfigError(fmt::format(
        "no execution monitor serves the action '{}' at {}; start execution_monitor.launch",
        kAchieveAction, ros::master::getURI()));
  }

  /// One round of waiting. By the wall's clock: ROS time stands still while the robot's does.
  void Pass() {
    Show();
    const bool is_gone = !ros::ok() || !client_.isServerConnected();
    if (is_gone && !client_.getState().isDone()) FailAsMonitorIsGone();
    if (cancelled_() && !give_up_) {
      client_.cancelGoal();
      give_up_ = hires::base::SteadyNow() + kStopWait;
    }
    if (give_up_ && hires::base::SteadyNow() > *give_up_) {
      throw hires::base::ConfigError(fmt::format(
          "the execution monitor did not end the task within {} s; see whether the robot stands",
          kStopWait));
    }
  }

  void Show() {
    const auto status = feedback_.Take();
    if (status && on_status_) on_status_(*status);
  }

  loop::AchieveReport ReportOf(const hires::AchieveResult& result) const {
    loop::AchieveReport report;
    report.task = query_.task;
    report.outcome = OutcomeOf(result.code);
    report.reason = result.reason;
    report.failure = FromMsg(result.failure);
    report.episode = result.episode;
    report.status = StatusOf(result);
    return report;
  }

  const loop::AchieveQuery& query_;
  const loop::OnAchieveStatus& on_status_;
  const std::function<bool()>& cancelled_;
  Feedback feedback_;
  std::optional<double> give_up_;  // [s] steady, once it was cancelled
  AchieveClient client_;
};

}  // namespace

loop::AchieveReport AchieveRemotely(const loop::AchieveQuery& query,
                                    const loop::OnAchieveStatus& on_status,
                                    const std::function<bool()>& cancelled) {
  int no_arguments = 0;
  ros::init(no_arguments, nullptr, "hires_achieve",
            ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
  loop::AchieveQuery rest = query;
  rest.wait = AwaitPublisher(kAchieveAction + std::string("/status"), query.wait, cancelled,
                             "topple.launch");
  RequireTime(std::max(rest.wait, 1.0), cancelled);
  return Conversation(rest, on_status, cancelled).Run();
}

std::string DomainOfMonitor() {
  int no_arguments = 0;
  ros::init(no_arguments, nullptr, "hires_achieve",
            ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
  std::string domain;
  if (ros::master::check()) ros::param::get("execution_monitor/domain", domain);
  return domain;
}

}  // namespace hires_ros
