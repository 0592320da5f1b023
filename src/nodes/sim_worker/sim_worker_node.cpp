#include "nodes/sim_worker/sim_worker_node.h"

#include <fmt/format.h>
#include <ros/package.h>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/imagination/rollout.h"
#include "hires/robot/load_robot.h"
#include "hires/ros/answer/report_messages.h"
#include "hires/ros/imagination/scene_params.h"
#include "hires/ros/names/topic_names.h"
#include "hires/ros/node/private_params.h"
#include "hires/ros/robot/robot_state_messages.h"
#include "hires/ros/values/action_messages.h"
#include "hires/ros/world/world_messages.h"
#include "hires/skills/action_loader.h"

namespace hires_ros {
namespace {

using hires::RolloutGoal;
using hires::RolloutResult;
namespace imagination = hires::imagination;

constexpr std::uint32_t kMostRollouts = 1000;  // per goal

/// The worker is another one than the client takes it for.
class HashDiffers : public hires::base::ConfigError {
 public:
  using ConfigError::ConfigError;
};

void RequireHash(const char* what, std::uint64_t wanted, std::uint64_t own) {
  if (wanted == own) return;
  throw HashDiffers(
      fmt::format("{} differs: the client has {}, this worker {}; start both with the same files",
                  what, hires::base::HexOf(wanted), hires::base::HexOf(own)));
}

/// A client with other actions, or another build of a library, may do something else by the same
/// name.
void RequireActions(std::uint64_t wanted, const hires::skills::ActionSet& own) {
  const std::string why_not = hires::skills::WhyActionsDiffer(wanted, own);
  if (!why_not.empty()) throw HashDiffers(why_not);
}

}  // namespace

SimWorkerParams LoadSimWorkerParams() {
  RejectUnknownPrivate(WithSceneParams({"role", "config", "index"}));
  const std::string path =
      PrivateText("config").value_or(ros::package::getPath("hires") + "/config/sim_worker.yaml");
  auto in = hires::base::ParamReader::FromFile(path);
  SimWorkerParams params;
  params.index = in.Get("index", hires::base::Between(1, 256));
  params.display_rate = in.Get("display_rate", hires::base::Between(0.1, 1000.0));
  params.setup =
      imagination::ReadSetupConfig(imagination::ResolvePath(in.GetString("scene"), path));
  in.RejectUnknownKeys();
  Override("index", PrivateInt("index"), hires::base::Between(1, 256), &params.index);
  OverrideScene(&params.setup);
  return params;
}

SimWorkerNode::SimWorkerNode(const SimWorkerParams& params, imagination::ImaginationSetup setup,
                             ros::NodeHandle* nh)
    : params_(params),
      setup_(std::move(setup)),
      broadcaster_(setup_.scene, setup_.standing, params.index, params.display_rate, nh),
      server_(
          *nh, WorkerName(params.index, kRollout), [this](GoalHandle goal) { OnGoal(goal); },
          [this](GoalHandle goal) { OnCancel(goal); }, false) {
  nh->setParam("robot_description",
               hires::robot::ReadUrdfOf(params.setup.robot, setup_.scene->robot.profile));
  updater_.setHardwareID(fmt::format("worker_{}", params.index));
  updater_.add("rollouts", this, &SimWorkerNode::Diagnose);
  heartbeat_ = nh->createTimer(ros::Duration(1.0),
                               boost::function<void(const ros::TimerEvent&)>(
                                   [this](const ros::TimerEvent&) { updater_.update(); }));
  thread_ = std::thread([this] { Work(); });
  server_.start();
}

SimWorkerNode::~SimWorkerNode() {
  stop_ = true;
  thread_.join();
}

void SimWorkerNode::OnGoal(GoalHandle goal) {
  goal.setAccepted();
  waiting_.Post(goal);
}

void SimWorkerNode::OnCancel(GoalHandle goal) {
  const std::lock_guard<std::mutex> lock(cancelled_mutex_);
  cancelled_.insert(goal.getGoalID().id);
}

bool SimWorkerNode::IsCancelled(const std::string& id) const {
  if (stop_) return true;
  const std::lock_guard<std::mutex> lock(cancelled_mutex_);
  return cancelled_.count(id) > 0;
}

void SimWorkerNode::Work() {
  while (!stop_) {
    if (auto goal = waiting_.WaitAndTake(std::chrono::milliseconds(50))) {
      Play(*goal);
    } else {
      broadcaster_.PublishIdle();
    }
  }
}

void SimWorkerNode::Play(GoalHandle goal) {
  const std::string id = goal.getGoalID().id;
  RolloutResult result;
  try {
    const imagination::RolloutSetup setup = SetupFor(*goal.getGoal());
    imagination::CheckSetup(setup, FromMsg(goal.getGoal()->action));
    if (PlayRange(goal, setup, &result)) {
      result.code = RolloutResult::FINISHED;
      goal.setSucceeded(result);
    } else {
      result.code = RolloutResult::CANCELLED;
      if (!stop_) goal.setCanceled(result);
    }
  } catch (const HashDiffers& error) {
    result.code = RolloutResult::HASH_DIFFERS;
    result.why = error.what();
    goal.setAborted(result, result.why);
  } catch (const std::exception& error) {  // the next goal may be a better one
    result.code = RolloutResult::INVALID;
    result.why = error.what();
    goal.setAborted(result, result.why);
  }
  const std::lock_guard<std::mutex> lock(cancelled_mutex_);
  cancelled_.erase(id);
}

bool SimWorkerNode::PlayRange(GoalHandle goal, const imagination::RolloutSetup& setup,
                              RolloutResult* result) {
  const RolloutGoal& wanted = *goal.getGoal();
  const hires::base::ActionCall action = FromMsg(wanted.action);
  const std::string id = goal.getGoalID().id;
  using hires::simulation::RobotSimulator;
  const imagination::RolloutHooks hooks{
      [&] { return IsCancelled(id); },
      [&](const RobotSimulator& simulator, double) { broadcaster_.Publish(simulator); },
      [&](const RobotSimulator&) { broadcaster_.BeginRollout(); }};
  for (std::uint32_t i = wanted.first; i < wanted.first + wanted.count; ++i) {
    const auto played = imagination::PlayRollout(setup, action, static_cast<int>(i), hooks);
    if (!played) return false;
    hires::RolloutFeedback feedback;
    feedback.result = ToMsg(*played, static_cast<int>(i));
    goal.publishFeedback(feedback);
    result->results.push_back(feedback.result);
    ++rollouts_played_;
    hires::base::Log(
        hires::base::LogLevel::kDebug,
        fmt::format("rollout={} action={} failure={} t_sim={:.2f}", i,
                    hires::base::ToString(action), ToString(played->failure), played->duration));
  }
  return true;
}

imagination::RolloutSetup SimWorkerNode::SetupFor(const RolloutGoal& goal) const {
  if (goal.count < 1 || goal.count > kMostRollouts || goal.first > 1000000) {
    throw hires::base::ConfigError(
        fmt::format("rollouts {} .. {} are wanted, a goal may have 1 to {}, below one million",
                    goal.first, goal.first + goal.count, kMostRollouts));
  }
  RequireHash("world", goal.world_hash, setup_.world_hash);
  RequireHash("robot", goal.robot_hash, setup_.robot_hash);
  RequireHash("physics (sections physics, rollout, standing of the scene)", goal.physics_hash,
              setup_.physics_hash);
  RequireActions(goal.actions_hash, *setup_.skills->actions);
  auto uncertainty = setup_.uncertainty;
  if (!goal.uncertainty.empty()) {
    uncertainty = std::make_shared<const imagination::Uncertainty>(
        imagination::UncertaintyFromText(goal.uncertainty, "uncertainty of the goal"));
  }
  RequireHash("uncertainty", goal.uncertainty_hash, uncertainty->hash);
  imagination::RolloutSetup setup = imagination::MakeRolloutSetup(
      setup_, {FromMsg(goal.world_state), FromMsg(goal.robot_state)}, goal.seed);
  setup.uncertainty = uncertainty;
  return setup;
}

void SimWorkerNode::Diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "ready");
  status.add("rollouts played", rollouts_played_.load());
  status.add("world hash", hires::base::HexOf(setup_.world_hash));
  status.add("robot hash", hires::base::HexOf(setup_.robot_hash));
  status.add("actions hash", hires::base::HexOf(setup_.actions_hash));
  status.add("action libraries", hires::skills::ToString(setup_.skills->actions->libraries()));
  status.add("physics hash", hires::base::HexOf(setup_.physics_hash));
}

}  // namespace hires_ros
