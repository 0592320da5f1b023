#include "nodes/imagination_client/imagination_client_node.h"

#include <fmt/format.h>
#include <ros/package.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstdlib>
#include <deque>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/overloaded.h"
#include "hires/base/process.h"
#include "hires/base/short_text.h"
#include "hires/imagination/report.h"
#include "hires/imagination/rollout.h"
#include "hires/ros/answer/report_messages.h"
#include "hires/ros/imagination/scene_params.h"
#include "hires/ros/imagination/trace_markers.h"
#include "hires/ros/names/topic_names.h"
#include "hires/ros/node/private_params.h"
#include "hires/ros/robot/robot_state_messages.h"
#include "hires/ros/values/action_messages.h"
#include "hires/ros/values/geometry_messages.h"
#include "hires/ros/values/pose_messages.h"
#include "hires/ros/world/world_messages.h"

namespace hires_ros {
namespace {

namespace imagination = hires::imagination;

constexpr double kTickPeriod = 0.02;  // [s] while something is imagined
constexpr double kRestPeriod = 0.2;   // [s] otherwise, to see workers come and go

/// The scheduler's clock: the deadline is in ROS time where that is simulated; the wall's ROS time
/// may jump, so there the steady clock counts.
double SchedulerNow() {
  return ros::Time::isSimTime() ? ros::Time::now().toSec() : hires::base::SteadyNow();
}

/// Where ROS keeps what programs write.
std::string DefaultRolloutFolder() {
  const char* ros_home = std::getenv("ROS_HOME");
  if (ros_home != nullptr && *ros_home != '\0') return std::string(ros_home) + "/hires_rollouts";
  const char* home = std::getenv("HOME");
  return std::string(home == nullptr ? "/tmp" : home) + "/.ros/hires_rollouts";
}

/// A record that cannot be read is the worker's failure: it gets no more work of this request.
imagination::Event EventOf(int worker, int alternative, const WorkerLink::Played& played) {
  try {
    return imagination::RolloutFinished{worker, played.assignment, alternative,
                                        static_cast<int>(played.record.index),
                                        FromMsg(played.record)};
  } catch (const hires::base::ConfigError& error) {
    return imagination::AssignmentFailed{worker, played.assignment, error.what(), true};
  }
}

}  // namespace

ImaginationClientParams LoadImaginationClientParams() {
  RejectUnknownPrivate(
      WithSceneParams({"config", "workers", "localisation", "map_to_world", "rollout_folder"}));
  ImaginationClientParams params;
  params.config = imagination::ReadClientConfig(PrivateText("config").value_or(
      ros::package::getPath("hires") + "/config/imagination_client.yaml"));
  params.setup = imagination::ReadSetupConfig(params.config.scene);
  Override("workers", PrivateInt("workers"), hires::base::Between(1, 256), &params.num_workers);
  OverrideScene(&params.setup);
  params.localisation = PrivateText("localisation").value_or("");
  params.map_to_world =
      hires::geometry::ParseMapToWorld(PrivateText("map_to_world").value_or(""), "~map_to_world");
  params.rollout_folder = PrivateText("rollout_folder").value_or(DefaultRolloutFolder());
  return params;
}

ImaginationClientNode::ImaginationClientNode(const ImaginationClientParams& params,
                                             imagination::ImaginationSetup setup,
                                             ros::NodeHandle* nh)
    : params_(params),
      setup_(std::move(setup)),
      kept_(params.config.kept_rollouts),
      server_(
          *nh, kImagineAction, [this](GoalHandle goal) { OnGoal(goal); },
          [this](GoalHandle goal) { OnCancel(goal); }, false),
      askers_(kImagineAction, nh),
      replayer_(params.rollout_folder, nh),
      ranking_markers_(
          nh->advertise<visualization_msgs::MarkerArray>(kImaginationMarkers, 1, true)),
      world_markers_(nh->advertise<visualization_msgs::MarkerArray>(kWorldMarkers, 1, true)) {
  for (int k = 1; k <= params_.num_workers; ++k) {
    workers_[k] = std::make_unique<WorkerLink>(
        k, params_.config.worker_timeout, nh,
        [this, k](const WorkerLink::Event& event) { OnWorkerEvent(k, event); });
  }
  if (!params_.localisation.empty()) {
    localisation_ = nh->subscribe(params_.localisation, 1, &ImaginationClientNode::OnLocalisation,
                                  this, ros::TransportHints().tcpNoDelay());
  }
  world_markers_.publish(WorldMarkers(setup_.scene->world));
  updater_.setHardwareID("imagination");
  updater_.add("workers", this, &ImaginationClientNode::Diagnose);
  SetPace();
  timer_ = nh->createWallTimer(ros::WallDuration(period_),
                               boost::function<void(const ros::WallTimerEvent&)>(
                                   [this](const ros::WallTimerEvent&) { OnTick(); }));
  server_.start();
}

ImaginationClientNode::~ImaginationClientNode() {
  for (auto& session : sessions_) {
    hires::ImagineResult result;
    result.outcome = hires::ImagineResult::CANCELLED;
    result.why = "the imagination client is going down";
    session->goal.setAborted(result, result.why);
  }
}

void ImaginationClientNode::Refuse(GoalHandle goal, const std::string& why) {
  hires::base::Log(hires::base::LogLevel::kWarn,
                   fmt::format("request={} outcome=invalid {}",
                               hires::base::Shortened(goal.getGoal()->request_id), why));
  askers_.Forget(goal.getGoalID().id);
  goal.setAborted(RefusalOf(*goal.getGoal(), why), why);
}

void ImaginationClientNode::OnGoal(GoalHandle goal) {
  goal.setAccepted();
  try {
    sessions_.push_back(MakeSession(goal));
  } catch (const std::exception& error) {  // one bad request must not end the others
    Refuse(goal, hires::base::Shortened(error.what()));
    return;
  }
  SetPace();
  Session* session = sessions_.back().get();
  hires::base::Log(
      hires::base::LogLevel::kInfo,
      fmt::format("request={} session={} action={} alternatives={} rollouts={} seed={}",
                  hires::base::Shortened(goal.getGoal()->request_id), session->id,
                  session->request->actions[0].name, session->request->actions.size(),
                  session->request->params.rollouts, goal.getGoal()->seed));
  // At the moment of the start: a worker that is there then is in time for any deadline.
  for (const auto& [k, worker] : workers_) {
    if (!worker->is_alive()) continue;
    CarryOut(session, session->scheduler->Handle(imagination::WorkerJoined{k}, session->started));
  }
}

std::unique_ptr<ImaginationClientNode::Session> ImaginationClientNode::MakeSession(
    GoalHandle goal) {
  auto session = std::make_unique<Session>();
  session->id = next_session_++;
  session->goal = goal;
  const hires::ImagineGoal& wanted = *goal.getGoal();
  if (wanted.updated_fluents.empty()) RequireSoundState(wanted.world_state, wanted.robot_state);
  ImagineRequest request = RequestOf(wanted, setup_, params_.config.scheduler);
  if (wanted.uncertainty.empty()) SpreadStart(&request);
  if (localisation_ && !believed_) {
    topic_warnings_.Tell(localisation_.getTopic(), "awaited",
                         "nothing came yet, so starts are as spread as the uncertainty says");
  }
  session->started = SchedulerNow();
  session->scheduler = std::make_unique<imagination::Scheduler>(
      request.params, static_cast<int>(request.actions.size()), session->started);
  session->request = std::make_shared<const ImagineRequest>(std::move(request));
  session->begun = session->next_feedback = hires::base::SteadyNow();
  return session;
}

void ImaginationClientNode::OnLocalisation(const geometry_msgs::PoseWithCovarianceStamped& msg) {
  const std::string topic = localisation_.getTopic();
  UncertainPose pose;
  try {
    pose = FromMsg(msg.pose);
  } catch (const hires::base::ConfigError& error) {
    topic_warnings_.Tell(topic, "dropped", error.what());
    return;
  }
  const std::string& frame = msg.header.frame_id;
  if (frame != "map" && frame != "/map" && frame != believed_frame_) {  // each said once
    topic_warnings_.Tell(topic, "taken for a pose in the map",
                         fmt::format("header.frame_id is '{}'", frame));
  }
  believed_frame_ = frame;
  imagination::BelievedPose believed;
  believed.X_MB = params_.map_to_world.ToWorld(pose.X_AB);
  const double turn = params_.map_to_world.X_WM.yaw, scale = params_.map_to_world.scale;
  Eigen::Matrix3d R_WM = Eigen::Matrix3d::Identity();
  R_WM.topLeftCorner<2, 2>() = scale * Eigen::Rotation2Dd(turn).toRotationMatrix();
  believed.covariance = R_WM * pose.covariance * R_WM.transpose();
  believed_ = believed;
}

/// What begins where the robot stands begins as surely as it knows where that is.
void ImaginationClientNode::SpreadStart(ImagineRequest* request) const {
  request->setup.uncertainty = imagination::UncertaintyFrom(
      request->setup.uncertainty, request->setup.robot_state.X_MB, believed_, params_.localisation);
}

void ImaginationClientNode::OnCancel(GoalHandle goal) {
  for (auto& session : sessions_) {
    if (session->goal == goal) {
      CarryOut(session.get(), session->scheduler->Cancel(SchedulerNow()));
    }
  }
}

/// Nobody would hear the answer; the workers are free for others.
void ImaginationClientNode::CancelForNobody(Session* session, double now) {
  const std::string asker = askers_.GoneFor(session->goal.getGoalID().id, now);
  if (asker.empty() || session->scheduler->finished()) return;
  hires::base::Log(
      hires::base::LogLevel::kWarn,
      fmt::format("session={} cancelled: {}, which asked, is gone", session->id, asker));
  CarryOut(session, session->scheduler->Cancel(SchedulerNow()));
}

void ImaginationClientNode::Feed(Session* session, const imagination::Event& event) {
  CarryOut(session, session->scheduler->Handle(event, SchedulerNow()));
}

void ImaginationClientNode::OnWorkerEvent(int worker, const WorkerLink::Event& event) {
  const auto with_session = [&](int id, const imagination::Event& what) {
    for (auto& session : sessions_) {
      if (session->id == id) Feed(session.get(), what);
    }
  };
  const auto log = [&](const std::string& what) {
    hires::base::Log(hires::base::LogLevel::kInfo, fmt::format("worker={} {}", worker, what));
  };
  std::visit(hires::base::Overloaded{
                 [&](const WorkerLink::Joined&) {
                   log("joined");
                   for (auto& s : sessions_) Feed(s.get(), imagination::WorkerJoined{worker});
                 },
                 [&](const WorkerLink::Lost&) {
                   log("lost");
                   for (auto& s : sessions_) Feed(s.get(), imagination::WorkerLost{worker});
                 },
                 [&](const WorkerLink::Played& e) { OnPlayed(worker, e); },
                 [&](const WorkerLink::Finished& e) {
                   // Feedback may have been lost on the way: the result has all rollouts once more.
                   for (const auto& record : e.records) {
                     OnWorkerEvent(worker, WorkerLink::Played{e.session, e.assignment, record});
                   }
                   with_session(e.session, imagination::AssignmentFinished{worker, e.assignment});
                 },
                 [&](const WorkerLink::Failed& e) {
                   const std::string why = e.reason + (e.is_unusable ? OwnLibraries() : "");
                   log("failed " + why);
                   with_session(e.session, imagination::AssignmentFailed{worker, e.assignment, why,
                                                                         e.is_unusable});
                 }},
             event);
}

void ImaginationClientNode::OnPlayed(int worker, const WorkerLink::Played& played) {
  for (auto& session : sessions_) {
    if (session->id != played.session) continue;
    const auto alternative = session->alternative_of.find(played.assignment);
    if (alternative == session->alternative_of.end()) continue;
    Feed(session.get(), EventOf(worker, alternative->second, played));
  }
}

/// For people, behind what a worker says that is not the same as here.
std::string ImaginationClientNode::OwnLibraries() const {
  const auto& libraries = setup_.skills->actions->libraries();
  return libraries.empty() ? "" : "; the client loaded " + hires::skills::ToString(libraries);
}

hires::RolloutGoal ImaginationClientNode::RolloutGoalFor(const Session& session,
                                                         const imagination::Assign& assign) const {
  hires::RolloutGoal goal;
  const imagination::RolloutSetup& setup = session.request->setup;
  goal.action = ToMsg(session.request->actions[assign.alternative]);
  goal.world_state = ToMsg(setup.world_state);
  goal.world_state.world_hash = setup_.world_hash;
  goal.robot_state = ToMsg(setup.robot_state);
  goal.world_hash = setup_.world_hash;
  goal.robot_hash = setup_.robot_hash;
  goal.actions_hash = setup_.actions_hash;
  goal.uncertainty_hash = setup.uncertainty->hash;
  goal.physics_hash = setup_.physics_hash;
  const bool is_own = setup.uncertainty->hash == setup_.uncertainty->hash;
  const bool is_asked_for = !session.goal.getGoal()->uncertainty.empty();
  goal.uncertainty = is_own && !is_asked_for ? "" : setup.uncertainty->yaml;
  goal.seed = setup.seed;
  goal.first = assign.first_index;
  goal.count = assign.count;
  return goal;
}

void ImaginationClientNode::CarryOut(Session* session,
                                     const std::vector<imagination::Command>& commands) {
  std::deque<imagination::Command> open(commands.begin(), commands.end());
  for (; !open.empty(); open.pop_front()) {
    if (const auto* cancel = std::get_if<imagination::CancelAssignment>(&open.front())) {
      workers_.at(cancel->worker)->Cancel(session->id, cancel->assignment);
      continue;
    }
    const auto& assign = std::get<imagination::Assign>(open.front());
    for (const imagination::Event& event : Begin(session, assign)) {
      const auto next = session->scheduler->Handle(event, SchedulerNow());
      open.insert(open.end(), next.begin(), next.end());
    }
  }
}

/// Sends to its worker what of it has to be played.  @return what is known without.
std::vector<imagination::Event> ImaginationClientNode::Begin(Session* session,
                                                             const imagination::Assign& assign) {
  imagination::KeptRollouts::Shortened shortened{{}, assign};
  if (!session->goal.getGoal()->play_afresh) {
    const ImagineRequest& request = *session->request;
    shortened = kept_.Shorten(assign, request.setup, request.actions[assign.alternative]);
  }
  std::vector<imagination::Event> known;
  for (auto& finished : shortened.known) {
    session->from_kept.insert({finished.alternative, finished.index});
    known.push_back(std::move(finished));
  }
  if (shortened.rest.count == 0) {
    known.push_back(imagination::AssignmentFinished{assign.worker, assign.assignment});
  } else {
    session->alternative_of[assign.assignment] = assign.alternative;
    workers_.at(assign.worker)
        ->Send(session->id, assign.assignment, RolloutGoalFor(*session, shortened.rest));
  }
  return known;
}

void ImaginationClientNode::OnTick() {
  for (auto& [k, worker] : workers_) worker->Look();
  const double now = hires::base::SteadyNow();
  for (auto& session : sessions_) {
    CancelForNobody(session.get(), now);
    CarryOut(session.get(), session->scheduler->Tick(SchedulerNow()));
    if (now >= session->next_feedback) PublishFeedback(session.get(), now);
  }
  FinishSessions();
  SetPace();
  updater_.update();
}

void ImaginationClientNode::SetPace() {
  const double period = sessions_.empty() ? kRestPeriod : kTickPeriod;
  if (period == period_) return;
  period_ = period;
  timer_.setPeriod(ros::WallDuration(period));
}

void ImaginationClientNode::PublishFeedback(Session* session, double now) {
  session->next_feedback = now + params_.config.feedback_period;
  session->goal.publishFeedback(ToMsg(
      imagination::Interim{session->scheduler->ProgressAt(SchedulerNow()),
                           PredictionsOf(*session->scheduler, session->scheduler->RankingSoFar(),
                                         session->request->actions, false),
                           NumWorkers()}));
}

void ImaginationClientNode::FinishSessions() {
  for (auto it = sessions_.begin(); it != sessions_.end();) {
    if (!(*it)->scheduler->finished()) {
      ++it;
      continue;
    }
    Finish(it->get());
    it = sessions_.erase(it);
  }
}

void ImaginationClientNode::Finish(Session* session) {
  for (auto& [k, worker] : workers_) worker->CancelSession(session->id);
  askers_.Forget(session->goal.getGoalID().id);
  const ImagineRequest& request = *session->request;
  Keep(*session);
  auto report =
      imagination::MakeReport(*session->scheduler, request.actions, request.setup.seed,
                              hires::base::SteadyNow() - session->begun, session->from_kept,
                              request.setup.uncertainty->quantities.empty());
  imagination::AddCaveats(request.setup, request.actions, params_.config.validated, &report);
  const hires::ImagineResult result = AnswerTo(*session->goal.getGoal(), request, setup_, report);
  replayer_.Keep({session->goal.getGoal()->request_id, session->id, session->request,
                  report.ranking, result.predictions});
  hires::base::Log(hires::base::LogLevel::kInfo,
                   fmt::format("session={} outcome={} {}", session->id,
                               imagination::ToString(report.outcome), report.why));
  ranking_markers_.publish(
      RankingMarkers(report.ranking, report.recommended, request.setup.robot_state.X_MB));
  if (report.outcome == imagination::ImaginationOutcome::kCancelled) {
    session->goal.setCanceled(result, report.why);
  } else if (report.outcome == imagination::ImaginationOutcome::kRanked ||
             report.outcome == imagination::ImaginationOutcome::kClose) {
    session->goal.setSucceeded(result, report.why);
  } else {
    session->goal.setAborted(result, report.why);
  }
}

/// What the scheduler took. Of a request in which a worker was set aside, or played one rollout
/// twice and differently, nothing: later requests could not see it any more.
void ImaginationClientNode::Keep(const Session& session) {
  const imagination::Scheduler& scheduler = *session.scheduler;
  if (!scheduler.worker_problems().empty() || scheduler.num_mismatches() > 0) return;
  const ImagineRequest& request = *session.request;
  const std::shared_ptr<const imagination::RolloutSetup> setup(session.request, &request.setup);
  for (std::size_t i = 0; i < request.actions.size(); ++i) {
    const int alternative = static_cast<int>(i);
    const auto& played = scheduler.Prefix(alternative);
    for (std::size_t k = 0; k < played.size(); ++k) {
      const int index = static_cast<int>(k);
      const bool is_known = session.from_kept.count({alternative, index}) > 0;
      if (is_known || played[k].failure.code == hires::base::FailureCode::kUnplayable) continue;
      kept_.Keep(setup, request.actions[i], index, played[k]);
    }
  }
}

int ImaginationClientNode::NumWorkers() const {
  int alive = 0;
  for (const auto& [k, worker] : workers_) alive += worker->is_alive() ? 1 : 0;
  return alive;
}

void ImaginationClientNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const int alive = NumWorkers();
  using Level = diagnostic_msgs::DiagnosticStatus;
  status.summary(alive == 0                    ? Level::ERROR
                 : alive < params_.num_workers ? Level::WARN
                                               : Level::OK,
                 fmt::format("{} of {} workers", alive, params_.num_workers));
  for (const auto& [k, worker] : workers_) {
    status.add(worker->name(), worker->is_alive() ? "alive" : "lost");
  }
  status.add("requests", sessions_.size());
  if (localisation_) {
    status.add(localisation_.getTopic(),
               believed_ ? "tells where the robot is" : "nothing came yet");
  }
}

}  // namespace hires_ros
