#include "nodes/planner/planner_node.h"

#include <fmt/format.h>
#include <ros/package.h>

#include <algorithm>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/process.h"
#include "hires/base/short_text.h"
#include "hires/planning/planner.h"
#include "hires/ros/names/topic_names.h"
#include "hires/ros/node/private_params.h"
#include "hires/ros/planning/plan_request.h"

namespace hires_ros {
namespace {

namespace planning = hires::planning;
using hires::base::Log;
using hires::base::LogLevel;

constexpr double kTickPeriod = 0.005;  // [s] while something is searched
constexpr double kRestPeriod = 1.0;    // [s] otherwise, for the diagnostics
// What a thread may take to see that it is cancelled; the client is answered then in any
// case.
constexpr double kPatience = 0.03;  // [s]

planning::StopQuestion StopQuestionOf(PlanJob* job) {
  return [job](const planning::Progress& progress) {
    job->expansions = progress.expansions;
    job->depth = progress.depth;
    job->plans = progress.plans;
    job->best_cost = progress.best_cost;
    if (job->is_cancelled) return planning::Stop::kCancelled;
    return hires::base::SteadyNow() >= job->end ? planning::Stop::kTime : planning::Stop::kContinue;
  };
}

hires::PlanResult Cancelled(const PlanJob& job) {
  hires::PlanResult result =
      ResultWithout(hires::PlanResult::CANCELLED,
                    job.begun < 0.0 ? "cancelled while it waited" : "cancelled during the search");
  result.expansions = job.expansions;
  return result;
}

hires::PlanResult TimeOverWhileWaiting(const planning::PlannerConfig& config) {
  return ResultWithout(
      hires::PlanResult::LIMIT_TIME,
      fmt::format("the time limit passed while {} other searches were under way; allow more time, "
                  "or give the planner more threads",
                  config.threads));
}

/// actionlib keeps 50 messages of a kind and silently drops what comes beyond: goals of many
/// clients, or the results when all are cancelled at once.
ros::NodeHandle& WithRoomFor(int num_requests, ros::NodeHandle* nh) {
  for (const char* queue : {"pub", "sub"}) {
    nh->setParam(fmt::format("{}/actionlib_server_{}_queue_size", kPlanAction, queue),
                 num_requests + 50);
  }
  return *nh;
}

}  // namespace

planning::PlannerConfig LoadPlannerParams() {
  RejectUnknownPrivate({"config", "domain", "initial", "threads"});
  const auto path = PrivateText("config");
  planning::PlannerConfig config = planning::ReadPlannerConfig(
      path && !path->empty() ? *path : ros::package::getPath("hires") + "/config/planner.yaml");
  const auto domain = PrivateText("domain");
  if (domain && !domain->empty()) {
    config.domain = *domain;
    config.initial.clear();  // those of the file belong to its domain
  }
  const auto initial = PrivateWords("initial");
  if (initial && !initial->empty()) config.initial = *initial;
  Override("threads", PrivateInt("threads"), hires::base::Between(1, 256), &config.threads);
  return config;
}

PlannerNode::PlannerNode(const planning::PlannerConfig& config,
                         planning::PlanningKnowledge knowledge, ros::NodeHandle* nh)
    : config_(config),
      knowledge_(std::move(knowledge)),
      pool_(std::make_unique<PlanPool>(
          config.threads, [this](PlanJob* job) { return AnswerFor(job); }, &answered_)),
      server_(
          WithRoomFor(config.threads + config.max_waiting, nh), kPlanAction,
          [this](GoalHandle goal) { OnGoal(goal); }, [this](GoalHandle goal) { OnCancel(goal); },
          false) {
  updater_.setHardwareID("planner");
  updater_.add("searches", this, &PlannerNode::Diagnose);
  SetPace();
  timer_ = nh->createWallTimer(ros::WallDuration(period_),
                               boost::function<void(const ros::WallTimerEvent&)>(
                                   [this](const ros::WallTimerEvent&) { OnTick(); }));
  server_.start();
  for (const auto& [task, text] : knowledge_.domain.unknown_tasks) Log(LogLevel::kWarn, text);
  Log(LogLevel::kInfo,
      fmt::format("domain={} operators={} methods={} problems={} threads={}",
                  knowledge_.domain.name, knowledge_.domain.operators.size(),
                  knowledge_.domain.methods.size(), knowledge_.problems.size(), config_.threads));
}

void PlannerNode::OnGoal(GoalHandle goal) {
  goal.setAccepted();
  Accept(goal);
}

void PlannerNode::Accept(GoalHandle goal) {
  Session session{std::make_shared<PlanJob>(), goal, hires::base::SteadyNow(), std::nullopt};
  session.job->id = next_id_++;
  session.job->goal = goal.getGoal();
  session.job->accepted = hires::base::SteadyNow();
  try {
    session.job->end = session.job->accepted + TimeLimitOf(*goal.getGoal(), config_);
  } catch (const hires::base::ConfigError& error) {
    return Finish(&session, ResultWithout(hires::PlanResult::INVALID, error.what()));
  }
  if (pool_->num_waiting() >= config_.max_waiting &&
      pool_->num_waiting() + pool_->num_running() >= config_.threads) {
    return Finish(&session, ResultWithout(hires::PlanResult::BUSY,
                                          fmt::format("{} requests wait already; ask again later",
                                                      config_.max_waiting)));
  }
  pool_->Submit(session.job);
  sessions_.push_back(std::move(session));
  SetPace();
}

hires::PlanResult PlannerNode::AnswerFor(PlanJob* job) const {
  return AnswerTo(*job->goal, knowledge_, config_, StopQuestionOf(job));
}

void PlannerNode::OnCancel(GoalHandle goal) {
  const auto session = std::find_if(sessions_.begin(), sessions_.end(),
                                    [&](const Session& s) { return s.goal == goal; });
  if (session == sessions_.end() || session->cancelled_at) return;
  session->cancelled_at = hires::base::SteadyNow();
  session->job->is_cancelled = true;
  if (!pool_->Withdraw(session->job->id)) return;  // its thread will see it
  Finish(&*session, Cancelled(*session->job));
  sessions_.erase(session);
}

void PlannerNode::OnTick() {
  while (auto answered = answered_.Take()) OnAnswered(std::move(*answered));
  const double now = hires::base::SteadyNow();
  for (auto session = sessions_.begin(); session != sessions_.end();) {
    if (now >= session->next_feedback) PublishFeedback(&*session, now);
    session = AnswerOverdue(&*session, now) ? sessions_.erase(session) : std::next(session);
  }
  SetPace();
  updater_.update();
}

void PlannerNode::SetPace() {
  const double period = sessions_.empty() ? kRestPeriod : kTickPeriod;
  if (period == period_) return;
  period_ = period;
  timer_.setPeriod(ros::WallDuration(period));
}

void PlannerNode::OnAnswered(PlanAnswered answered) {
  const auto session = std::find_if(sessions_.begin(), sessions_.end(),
                                    [&](const Session& s) { return s.job->id == answered.id; });
  if (session == sessions_.end()) return;  // answered before its thread noticed
  Finish(&*session, std::move(answered.result));
  sessions_.erase(session);
}

/// True if the session was answered without its thread.
bool PlannerNode::AnswerOverdue(Session* session, double now) {
  if (session->cancelled_at && now >= *session->cancelled_at + kPatience) {
    Finish(session, Cancelled(*session->job));
    return true;
  }
  if (now < session->job->end || !pool_->Withdraw(session->job->id)) return false;
  Finish(session, TimeOverWhileWaiting(config_));
  return true;
}

void PlannerNode::PublishFeedback(Session* session, double now) {
  session->next_feedback = now + config_.feedback_period;
  const PlanJob& job = *session->job;
  hires::PlanFeedback feedback;
  feedback.expansions = job.expansions;
  feedback.depth = static_cast<std::uint32_t>(job.depth);
  feedback.plans = static_cast<std::uint32_t>(job.plans);
  feedback.best_cost = job.best_cost;
  feedback.seconds_left = std::max(0.0, job.end - now);
  feedback.waiting = job.begun < 0.0;
  session->goal.publishFeedback(feedback);
}

void PlannerNode::Finish(Session* session, hires::PlanResult result) {
  const double now = hires::base::SteadyNow();
  const double begun = session->job->begun;
  result.seconds_waiting = (begun < 0.0 ? now : begun) - session->job->accepted;
  if (session->cancelled_at) result.seconds_to_stop = now - *session->cancelled_at;
  Log(LogLevel::kInfo,
      fmt::format("request={} session={} outcome={} plans={} expansions={} cpu={:.3f} {}",
                  hires::base::Shortened(session->job->goal->request_id), session->job->id,
                  static_cast<int>(result.outcome), result.plans.size(), result.expansions,
                  result.cpu_seconds, result.why));
  ++num_answered_;
  if (result.outcome == hires::PlanResult::FOUND) {
    session->goal.setSucceeded(result, result.why);
  } else if (result.outcome == hires::PlanResult::CANCELLED && session->cancelled_at) {
    session->goal.setCanceled(result, result.why);
  } else {
    session->goal.setAborted(result, result.why);
  }
}

void PlannerNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const int waiting = pool_->num_waiting();
  using Level = diagnostic_msgs::DiagnosticStatus;
  status.summary(waiting > 0 ? Level::WARN : Level::OK,
                 fmt::format("{} of {} threads search, {} requests wait", pool_->num_running(),
                             config_.threads, waiting));
  status.add("domain", knowledge_.domain.name);
  status.add("file", knowledge_.domain.source);
  status.add("problems", knowledge_.problems.size());
  status.add("answered", num_answered_);
}

}  // namespace hires_ros
