#include "hires/base/hash.h"
#include "lab/src/decision/decision_play.h"

namespace hires::lab {
namespace {

using base::Hasher;
using imagination::ImaginationSetup;

void Add(std::initializer_list<double> values, Hasher* hasher) {
  for (const double value : values) hasher->Add(value);
}

void Add(const Eigen::Vector3d& v, Hasher* hasher) { Add({v.x(), v.y(), v.z()}, hasher); }

void Add(const ImaginationSetup& setup, Hasher* hasher) {
  for (const std::uint64_t hash : {setup.world_hash, setup.robot_hash, setup.physics_hash,
                                   setup.actions_hash, setup.uncertainty->hash}) {
    hasher->Add(hash);
  }
}

void Add(const imagination::StartState& start, Hasher* hasher) {
  for (const world::ObjectState& object : start.world.objects) {
    hasher->Add(object.name);
    hasher->Add(object.model);
    hasher->Add(object.attached_to);
    const Eigen::Quaterniond& q = object.X_MO.rotation;
    Add(object.X_MO.translation, hasher);
    Add({q.w(), q.x(), q.y(), q.z()}, hasher);
    Add(object.V_MO.linear, hasher);
    Add(object.V_MO.angular, hasher);
  }
  const robot::RobotState& robot = start.robot;
  Add({robot.X_MB.x, robot.X_MB.y, robot.X_MB.yaw}, hasher);
  Add({robot.V_B.vx, robot.V_B.vy, robot.V_B.wz}, hasher);
  for (const auto& [joint, position] : robot.joints) {
    hasher->Add(joint);
    hasher->Add(position);
  }
}

// All members by name: one that is added to a struct and not here does not compile.
void Add(const imagination::Prices& prices, Hasher* hasher) {
  const auto& [of, time_limit, late, not_done, deadline] = prices;
  for (const auto& [code, price] : of) Add({static_cast<double>(code), price}, hasher);
  Add({time_limit, late, not_done, deadline}, hasher);
}

void Add(const imagination::SchedulerParams& params, Hasher* hasher) {
  const auto& [rollouts, deadline, worker_wait, early_stop, criteria, first_look, batch,
               max_attempts, settle] = params;
  Add({static_cast<double>(rollouts), deadline, worker_wait, early_stop ? 1.0 : 0.0,
       static_cast<double>(first_look), static_cast<double>(batch),
       static_cast<double>(max_attempts)},
      hasher);
  const auto& [rule, min_success, prices, max_regret] = criteria;
  Add({static_cast<double>(rule), min_success, max_regret}, hasher);
  Add(prices, hasher);
  const auto& [alpha, indifference, only_best] = settle;
  Add({alpha, indifference, only_best ? 1.0 : 0.0}, hasher);
}

}  // namespace

std::uint64_t RequestHash(const DecisionTask& task, const DecisionParts& parts) {
  Hasher hasher;
  Add(parts.setup, &hasher);
  Add(StartOf(parts.setup, task), &hasher);
  Add(parts.scheduler, &hasher);
  for (const double scale : PriceScales()) {
    Add(PricesOf(task, parts.scheduler.criteria.prices, scale), &hasher);
  }
  for (const std::string& set : DecisionAlternatives()) {
    hasher.Add(base::ToString(ActionOf(task, set)));
  }
  hasher.Add(task.imagination_seed);
  return hasher.value();
}

}  // namespace hires::lab
