#include "lab/src/experiment/chain.h"

#include <algorithm>
#include <cmath>

#include "hires/base/text.h"
#include "hires/geometry/angles.h"

namespace hires::lab {
namespace {

using geometry::Pose2;
using geometry::Pose3;

// A chain knows where its robot and its load stand.
const std::set<std::string> kKnown{"start_x", "start_y", "start_yaw", "object_x", "object_y"};
enum ChainStreams : std::uint64_t { kRolloutStream, kTruthStream };

}  // namespace

Chain::Chain(std::shared_ptr<const Stage> stage, const std::string& start, const Options& options)
    : stage_(std::move(stage)),
      options_(options),
      setup_(SetupAt(*stage_, start, base::Rng(options.seed).Fork(kRolloutStream).seed())),
      at_(start) {
  imagination::Uncertainty uncertainty = Without(*setup_.uncertainty, kKnown);
  if (options.one_truth) {
    uncertainty = OneTruth(std::move(uncertainty), base::Rng(options.seed).Fork(kTruthStream));
  }
  setup_.uncertainty = std::make_shared<const imagination::Uncertainty>(std::move(uncertainty));
  setup_.params.put_back = options.put_back;
  const Pose3 X_BM = geometry::Lift(setup_.robot_state.X_MB).Inverse();
  for (const world::ObjectState& object : setup_.world_state.objects) {
    X_BO_nominal_.push_back(X_BM * object.X_MO);
  }
}

std::optional<Leg> Chain::Drive(const std::string& goal, const std::function<bool()>& cancelled) {
  Leg leg;
  leg.from = at_;
  leg.to = goal;
  leg.X_MStart = setup_.robot_state.X_MB;
  auto result = Play(goal, &leg, cancelled);
  if (!result) return std::nullopt;
  leg.result = *std::move(result);
  time_ += leg.result.simulated;
  Measure(goal, &leg);
  GoOn(goal, &leg);
  return leg;
}

std::optional<imagination::RolloutResult> Chain::Play(const std::string& goal, Leg* leg,
                                                      const std::function<bool()>& cancelled) {
  const simulation::RobotClearance& clearance = stage_->setup.scene->clearance;
  leg->clearance = clearance.Clearance(setup_.robot_state.X_MB, kFarClearance);
  long samples = 0;
  const auto look = [&](const simulation::RobotSimulator& simulator, double tilt) {
    leg->clearance =
        std::min(leg->clearance, clearance.Clearance(simulator.base().X_MB, leg->clearance));
    if (const simulation::SelfLocaliser* own = simulator.self_localiser())
      leg->places.push_back(MomentOf(*own, stage_->setup.skills->driving->params.lost));
    if (options_.record) Record(simulator, leg);
    if (++samples % 2 == 0) leg->counts_10hz += imagination::SampleOf(tilt, setup_.params);
  };
  down_.clear();
  const auto end = [&](const std::vector<std::string>& down) { down_ = down; };
  return imagination::PlayRollout(setup_, DriveTo(goal, options_.motion_set), next_index_++,
                                  {cancelled, look, {}, end});
}

void Chain::Record(const simulation::RobotSimulator& simulator, Leg* leg) const {
  if (simulator.carried().empty()) return;
  const bool begins_anew =
      !leg->samples.empty() && time_ + simulator.time() <= leg->samples.back().time;
  if (begins_anew) leg->samples.clear();  // the engine could not go on, and all is played again
  const Pose3 X_MO = simulator.PoseOf(simulator.carried().front());
  leg->samples.push_back(
      {time_ + simulator.time(), simulator.base().X_MB, X_MO, simulator.X_MB().Inverse() * X_MO});
}

void Chain::Measure(const std::string& goal, Leg* leg) const {
  const Pose2& X_MB = leg->result.final_robot.X_MB;
  const Pose2 X_BGoal = X_MB.Inverse() * geometry::Flatten(*setup_.scene->world.FindFrame(goal));
  leg->distance = std::hypot(X_BGoal.x, X_BGoal.y);
  leg->yaw_error = std::abs(geometry::WrapToPi(X_BGoal.yaw));
  if (const auto contact = setup_.scene->clearance.FindContact(X_MB)) {
    leg->touched = contact->robot_part + " / " + contact->obstacle;
    leg->clearance = 0.0;
  } else if (leg->result.failure.code == base::FailureCode::kRobotCollision) {
    leg->touched = "unknown";  // it was over before the robot stood still
    leg->clearance = 0.0;
  }
}

void Chain::GoOn(const std::string& goal, Leg* leg) {
  at_ = goal;
  Pose2 X_MB = leg->result.final_robot.X_MB;
  const bool is_stuck =
      !leg->touched.empty() || leg->result.failure.code == base::FailureCode::kBadStart;
  if (is_stuck) {
    X_MB = geometry::Flatten(*setup_.scene->world.FindFrame(goal));
    leg->was_restarted = true;
  }
  setup_.robot_state.X_MB = X_MB;
  leg->was_put_back = SettleLoad(leg->result.final_world, leg->result.final_robot.X_MB);
}

/// @param X_MB  where the robot stood when the load was there.
bool Chain::SettleLoad(const world::WorldState& final_world, const Pose2& X_MB) {
  bool has_put_back = false;
  for (std::size_t i = 0; i < setup_.world_state.objects.size(); ++i) {
    const Pose3 X_BO = geometry::Lift(X_MB).Inverse() * final_world.objects[i].X_MO;
    const Pose3& nominal = X_BO_nominal_[i];
    Pose3 X_BO_next = nominal;
    const std::string name = base::ToLower(final_world.objects[i].name);
    const bool is_down = std::count(down_.begin(), down_.end(), name) > 0;
    const bool stands = X_BO.IsFinite() && !is_down &&
                        !world::IsAway(setup_.standing, world::DepartureFrom(nominal, X_BO));
    if (stands) X_BO_next = geometry::Lift(geometry::Flatten(X_BO), nominal.translation.z());
    has_put_back = has_put_back || !stands;
    world::ObjectState& object = setup_.world_state.objects[i];
    object.X_MO = geometry::Lift(setup_.robot_state.X_MB) * X_BO_next;
    object.V_MO = {};
  }
  return has_put_back;
}

}  // namespace hires::lab
