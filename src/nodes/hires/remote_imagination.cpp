#include "nodes/hires/remote_imagination.h"

#include <actionlib/client/simple_action_client.h>
#include <fmt/format.h>
#include <hires/ImagineAction.h>
#include <ros/ros.h>

#include <algorithm>
#include <optional>

#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/base/text.h"
#include "hires/ros/answer/report_messages.h"
#include "hires/ros/names/topic_names.h"
#include "hires/ros/robot/robot_state_messages.h"
#include "hires/ros/values/action_messages.h"
#include "hires/ros/world/world_messages.h"
#include "nodes/hires/remote_server.h"

namespace hires_ros {
namespace {

using ImagineClient = actionlib::SimpleActionClient<hires::ImagineAction>;

constexpr double kClientWait = 10.0;  // [s] to find the imagination client
constexpr double kCancelWait = 3.0;   // [s] for it to confirm that it cancelled

hires::Atom MakeAtom(const std::string& predicate, const std::vector<std::string>& arguments) {
  hires::Atom atom;
  atom.predicate = predicate;
  atom.arguments = arguments;
  return atom;
}

/// Symbols, which the client reads by itself; what stands at places given in numbers has none, so
/// that the state is made here, from the same files.
void SetStart(const hires::cli::ImagineQuery& query, hires::ImagineGoal* goal) {
  if (query.start.put.empty()) {
    for (const hires::base::Atom& atom : query.start.AllAtoms()) {
      goal->updated_fluents.push_back(MakeAtom(atom.predicate, atom.arguments));
    }
    return;
  }
  const auto setup = hires::imagination::LoadImaginationSetup(query.setup);
  const auto start =
      hires::imagination::MakeStartState(setup, query.start.AllAtoms(), query.start.put);
  goal->world_state = ToMsg(start.world);
  goal->world_state.world_hash = setup.world_hash;
  goal->robot_state = ToMsg(start.robot);
}

hires::ImagineGoal GoalOf(const hires::cli::ImagineQuery& query) {
  hires::ImagineGoal goal;
  goal.steps.push_back(ToMsg(query.action));
  SetStart(query, &goal);
  goal.deadline = ros::Duration(query.scheduler.deadline);
  goal.rollouts = query.scheduler.rollouts;
  goal.seed = query.seed;
  goal.ranking = hires::imagination::ToString(query.scheduler.criteria.rule);
  goal.min_success = query.scheduler.criteria.min_success;
  goal.max_regret = std::max(query.scheduler.criteria.max_regret, 1e-9);  // 0: the client's own
  goal.play_all = !query.scheduler.early_stop;
  goal.request_id = "hires_imagine";
  if (query.own_uncertainty) {
    const std::string& over = query.setup.uncertainty_over;
    goal.uncertainty = over.empty() ? "none" : hires::base::ReadTextFile(over, 1u << 20);
  }
  return goal;
}

[[noreturn]] void FailAsClientIsGone() {
  throw hires::base::ConfigError(
      "the imagination client went away during the request; see its log, then ask again");
}

/// @throws ConfigError if no server of the action is there in time.
void RequireServer(const ImagineClient& client, const std::function<bool()>& cancelled) {
  if (PollUntil([&] { return client.isServerConnected(); }, kClientWait, cancelled)) return;
  throw hires::base::ConfigError(fmt::format(
      "no imagination client serves the action '{}' at {}; start imagination.launch, or add "
      "--local",
      kImagineAction, ros::master::getURI()));
}

hires::ImagineResult Unconfirmed(const hires::ImagineGoal& goal) {
  hires::ImagineResult result;
  result.outcome = hires::ImagineResult::CANCELLED;
  result.recommended = -1;
  result.seed = goal.seed;
  result.why = fmt::format(
      "cancelled; the imagination client did not confirm it within {} s, see whether it hangs",
      kCancelWait);
  return result;
}

/// Waits by the wall's clock: ROS time stands still while the robot's clock does.
hires::ImagineResult AwaitResult(const hires::ImagineGoal& goal,
                                 const std::function<bool()>& cancelled, ImagineClient* client) {
  std::optional<double> give_up;
  while (!client->getState().isDone()) {
    const bool is_gone = !ros::ok() || !client->isServerConnected();
    // The answer may have come just before.
    if (is_gone && !client->getState().isDone()) FailAsClientIsGone();
    if (cancelled() && !give_up) {
      client->cancelGoal();
      give_up = hires::base::SteadyNow() + kCancelWait;
    }
    if (give_up && hires::base::SteadyNow() > *give_up) return Unconfirmed(goal);
    ros::WallDuration(kPollPeriod).sleep();
  }
  // A client that was restarted does not know the goal: there is no result then, and an
  // empty one would read as a ranking.
  const actionlib::SimpleClientGoalState state = client->getState();
  if (state == actionlib::SimpleClientGoalState::LOST) FailAsClientIsGone();
  hires::ImagineResult result = *client->getResult();
  const bool is_cancelled = state == actionlib::SimpleClientGoalState::PREEMPTED;
  if (is_cancelled) result.outcome = hires::ImagineResult::CANCELLED;  // whatever was found
  return result;
}

}  // namespace

hires::imagination::Report ImagineRemotely(const hires::cli::ImagineQuery& query,
                                           const hires::imagination::OnInterim& on_interim,
                                           const std::function<bool()>& cancelled) {
  if (query.own_scene) {
    throw hires::base::ConfigError(
        "a world, map, robot, area, catalogue or object file is named, but running nodes are asked "
        "about the files that they were started with (imagination.launch world:=, map:=, areas:=, "
        "robot:=, objects:=): leave it away, or add --local");
  }
  return FromMsg(AskImaginationClient(GoalOf(query), on_interim, cancelled));
}

hires::ImagineResult AskImaginationClient(const hires::ImagineGoal& goal,
                                          const hires::imagination::OnInterim& on_interim,
                                          const std::function<bool()>& cancelled) {
  int no_arguments = 0;
  ros::init(no_arguments, nullptr, "hires_imagine",
            ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
  RequireMaster("imagination.launch", "add --local");
  RequireTime(kClientWait, cancelled);
  ImagineClient client(kImagineAction, true);
  RequireServer(client, cancelled);
  client.sendGoal(goal, {}, {}, [&](const hires::ImagineFeedbackConstPtr& feedback) {
    if (on_interim) on_interim(FromMsg(*feedback));
  });
  return AwaitResult(goal, cancelled, &client);
}

}  // namespace hires_ros
