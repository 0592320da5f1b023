#include "hires/ros/imagination/imagine_request.h"

#include <fmt/format.h>

#include <memory>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/log.h"
#include "hires/base/short_text.h"
#include "hires/imagination/uncertainty.h"
#include "hires/ros/answer/report_messages.h"
#include "hires/ros/robot/robot_state_messages.h"
#include "hires/ros/values/action_messages.h"
#include "hires/ros/values/atom_messages.h"
#include "hires/ros/world/world_messages.h"
#include "imagination/object_support.h"
#include "imagination/uncertainty_layers.h"

namespace hires_ros {
namespace {

namespace imagination = hires::imagination;

void RequireSameWorld(const hires::ImagineGoal& goal, const imagination::ImaginationSetup& setup) {
  const std::uint64_t stated = goal.world_state.world_hash;
  if (stated == 0 || stated == setup.world_hash) return;
  throw hires::base::ConfigError(fmt::format(
      "world_state.world_hash is {}, but the world that is loaded has {}; ask with a state of this "
      "world, or start with the files of the other one",
      hires::base::HexOf(stated), hires::base::HexOf(setup.world_hash)));
}

/// What a state says that nothing here would hear.
void RequireHeard(const hires::ImagineGoal& goal, const imagination::ImaginationSetup& setup) {
  const msg::RobotState& robot = goal.robot_state;
  if (!robot.postures.empty() && robot.joints.name.empty() &&
      setup.scene->robot.profile.upper_body) {
    throw hires::base::ConfigError(
        "robot_state.postures are names for what joints say, and robot_state.joints is empty; give "
        "joints, or HasArmPosture(arm, posture) and HasTorsoPosture(posture) in updated_fluents");
  }
  for (std::size_t i = 0; i < goal.world_state.objects.size(); ++i) {
    if (!goal.world_state.objects[i].name.empty()) continue;
    throw hires::base::ConfigError(
        fmt::format("world_state.objects[{}].name is empty; name the instance, e.g. mug1", i));
  }
}

imagination::StartState StartOf(const hires::ImagineGoal& goal,
                                const imagination::ImaginationSetup& setup) {
  if (!goal.updated_fluents.empty()) {
    return imagination::MakeStartState(setup, FromMsg(goal.updated_fluents));
  }
  RequireSameWorld(goal, setup);
  RequireHeard(goal, setup);
  return {FromMsg(goal.world_state), FromMsg(goal.robot_state)};
}

hires::base::ActionTemplate StepOf(const hires::ImagineGoal& goal) {
  if (goal.steps.size() != 1) {
    throw hires::base::ConfigError(fmt::format(
        "steps has {} entries, wanted 1: one step is imagined at a time; ask for each by itself",
        goal.steps.size()));
  }
  return FromMsg(goal.steps.front());
}

imagination::SchedulerParams ParamsOf(const hires::ImagineGoal& goal,
                                      const imagination::SchedulerParams& defaults) {
  if (goal.rollouts > static_cast<std::uint32_t>(imagination::kMostRollouts)) {
    throw hires::base::ConfigError(fmt::format("rollouts is {}, wanted between 1 and {}",
                                               goal.rollouts, imagination::kMostRollouts));
  }
  imagination::SchedulerParams params = defaults;
  params.rollouts = static_cast<int>(goal.rollouts);
  params.deadline = goal.deadline.toSec();
  params.early_stop = !goal.play_all && defaults.early_stop;
  if (goal.min_success != 0.0) params.criteria.min_success = goal.min_success;
  if (goal.max_regret != 0.0) params.criteria.max_regret = goal.max_regret;
  if (!goal.ranking.empty()) params.criteria.rule = imagination::ParseRankingRule(goal.ranking);
  imagination::CheckParams(params);
  return params;
}

/// Of a state that was observed it may be true, as far as it was seen.
void WarnOfUnsupported(const hires::ImagineGoal& goal, const imagination::RolloutSetup& setup) {
  std::vector<std::string> objects;
  for (const hires::world::ObjectState& object : setup.world_state.objects)
    objects.push_back(object.name);
  for (const std::string& why : imagination::WhyUnsupported(objects, setup)) {
    hires::base::Log(
        hires::base::LogLevel::kWarn,
        fmt::format("request={} world_state: {}", hires::base::Shortened(goal.request_id), why));
  }
}

/// What all rollouts of a request have in common.
void Complete(const hires::ImagineGoal& goal, const ImagineRequest& request,
              const imagination::ImaginationSetup& setup, hires::RolloutRef* ref) {
  ref->request_id = goal.request_id;
  ref->seed = request.setup.seed;
  ref->world_hash = setup.world_hash;
  ref->robot_hash = setup.robot_hash;
  ref->uncertainty_hash = request.setup.uncertainty->hash;
  ref->physics_hash = setup.physics_hash;
  ref->actions_hash = setup.actions_hash;
}

}  // namespace

ImagineRequest RequestOf(const hires::ImagineGoal& goal, const imagination::ImaginationSetup& setup,
                         const imagination::SchedulerParams& defaults) {
  ImagineRequest request;
  request.actions = hires::base::Combinations(StepOf(goal));
  request.setup = imagination::MakeRolloutSetup(setup, StartOf(goal, setup), goal.seed);
  if (!goal.uncertainty.empty()) {
    request.setup.uncertainty =
        std::make_shared<const imagination::Uncertainty>(imagination::LaidOver(
            *setup.uncertainty,
            imagination::UncertaintyFromText(goal.uncertainty, "uncertainty of the request")));
  }
  request.params = ParamsOf(goal, defaults);
  request.params.criteria.prices.time_limit = request.setup.params.time_limit;
  imagination::CheckSetupForAll(request.setup, request.actions);
  if (goal.updated_fluents.empty()) WarnOfUnsupported(goal, request.setup);
  return request;
}

hires::ImagineResult AnswerTo(const hires::ImagineGoal& goal, const ImagineRequest& request,
                              const imagination::ImaginationSetup& setup,
                              const imagination::Report& report) {
  hires::ImagineResult result = ToMsg(report);
  for (hires::Prediction& prediction : result.predictions) {
    for (auto* ref : {&prediction.worst, &prediction.median, &prediction.first_failed}) {
      Complete(goal, request, setup, ref);
    }
  }
  result.depends_on = goal.updated_fluents;
  return result;
}

hires::ImagineResult RefusalOf(const hires::ImagineGoal& goal, const std::string& why) {
  hires::ImagineResult result;
  result.outcome = hires::ImagineResult::INVALID;
  result.recommended = -1;
  result.why = hires::base::Shortened(why);
  result.seed = goal.seed;
  return result;
}

}  // namespace hires_ros
