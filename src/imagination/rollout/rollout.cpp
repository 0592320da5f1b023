#include "hires/imagination/rollout.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/simulation/robot_simulator.h"
#include "imagination/purpose.h"
#include "imagination/rollout/floor_objects.h"
#include "imagination/rollout/load_monitor.h"
#include "imagination/rollout/progress_watch.h"
#include "imagination/rollout/reach_watch.h"
#include "imagination/rollout/rollout_start.h"
#include "simulation/floor/robot_balance.h"

namespace hires::imagination {
namespace {

using simulation::RobotSimulator;
using Code = base::FailureCode;

enum Streams : std::uint64_t { kVariation, kSimulator, kControl };

Purpose PurposeIn(const RolloutSetup& setup, const base::ActionCall& action) {
  Purpose purpose = PurposeOf(setup.skills->actions->catalogue(), action);
  if (setup.skills->manipulation) {
    purpose.area_edge = setup.skills->manipulation->params.place.area_edge;
  }
  return purpose;
}

/// Of all objects, in the base frame.
std::vector<geometry::Pose3> NominalStarts(const RolloutSetup& setup) {
  const geometry::Pose3 X_BM = geometry::Lift(setup.robot_state.X_MB).Inverse();
  std::vector<geometry::Pose3> X_BO;
  for (const world::ObjectState& object : setup.world_state.objects) {
    X_BO.push_back(X_BM * object.X_MO);
  }
  return X_BO;
}

/// One play, from settling to the end.
class Player {
 public:
  /// `watch` is null where nothing is left out.
  Player(const RolloutSetup& setup, const base::ActionCall& action,
         std::unique_ptr<skills::Skill> skill, const simulation::Variation& variation,
         const base::Rng& rng, ReachWatch* watch)
      : watch_(watch),
        params_(setup.params),
        standing_(setup.standing),
        purpose_(PurposeIn(setup, action)),
        variation_(variation),
        skill_(std::move(skill)),
        control_rng_(rng.Fork(kControl)),
        simulator_(setup.scene, variation, setup.world_state, setup.robot_state,
                   rng.Fork(kSimulator), setup.physics, LevelFor(*setup.skills, action)),
        floor_(*setup.scene, setup.world_state.objects),
        X_BOstart_(NominalStarts(setup)),
        drives_(skills::SpecOf(*setup.skills, action).driving != actions::Driving::kNone),
        plans_(skills::SpecOf(*setup.skills, action).driving == actions::Driving::kRoundObstacles),
        driving_(setup.skills->driving) {
    if (drives_) balance_ = simulation::BalanceOf(simulator_, variation.mass_factor);
    if (balance_ && !balance_->IsStableAtRest()) balance_.reset();  // HazardsOf warns of it
    simulator_.Remember(KnownAtStart(setup, variation, simulator_));
  }

  /// Nothing if it is cancelled, or comes near what is left out.
  std::optional<RolloutResult> Play(const RolloutHooks& hooks) {
    if (!Settle(hooks)) return std::nullopt;
    if (hooks.on_begin) hooks.on_begin(simulator_);
    LoadMonitor monitor(&simulator_, params_, standing_, purpose_, X_BOstart_);
    const double start = next_cycle_ = start_ = simulator_.time();
    skills::Status status;
    const double half_step = 0.5 * simulator_.time_step();
    const long steps_per_look = world::StepsPerLook(simulator_.time_step());
    for (long step = 0; status.progress == skills::Progress::kRunning; ++step) {
      // Periods are sums of rounded numbers: without the half step some cycles came a step late.
      if (simulator_.time() >= next_cycle_ - half_step) status = Control(start, hooks);
      if (status.progress != skills::Progress::kRunning) break;
      StepOnce();
      if (step % steps_per_look == 0) {
        if (IsCancelled(hooks)) return std::nullopt;
        monitor.Look();
        if (!IsApart()) return std::nullopt;
        if (hooks.on_look) hooks.on_look(simulator_);
      }
      const double elapsed = simulator_.time() - start;
      if (IsSampleDue()) {
        monitor.Look();
        result_.counts += monitor.Sample();
        if (hooks.on_sample) hooks.on_sample(simulator_, monitor.tilt());
      }
      if (simulator_.contact()) status = skills::Failed(Collision());
      if (HasTipped()) status = skills::Failed(Tipped());
      if (monitor.is_lost()) status = skills::Failed(monitor.why_lost());
      NoteBroken(monitor);
      if (is_void_) status = skills::Failed(Code::kPhysicsBroke);
      if (elapsed >= params_.time_limit) status = skills::Failed(Code::kTimedOut);
    }
    result_.duration = simulator_.time() - start;
    SayWhyItEnds(hooks, &status.failure);
    if (!WatchAftermath(&monitor, hooks)) return std::nullopt;
    monitor.Conclude();
    if (hooks.on_end) hooks.on_end(monitor.Down());
    Conclude(status, monitor);
    PlayEpilogue(monitor, hooks);
    return result_;
  }

 private:
  /// False if it is cancelled, or something comes near what is left out.
  bool Settle(const RolloutHooks& hooks) {
    const long steps = std::lround(params_.settling_time / simulator_.time_step());
    const long steps_per_look = world::StepsPerLook(simulator_.time_step());
    for (long i = 0; i < steps; ++i) {
      if (i % steps_per_look == 0 && !IsApart()) return false;
      if (IsCancelled(hooks)) return false;
      simulator_.Step();
    }
    return IsApart();
  }

  /// Asked at every step where there is much to step: a thousand loose things take 10 ms each time.
  static bool IsCancelled(const RolloutHooks& hooks) {
    return hooks.cancelled && hooks.cancelled();
  }

  bool IsSampleDue() {
    const double next = (samples_ + 1) * params_.sample_period - 0.5 * simulator_.time_step();
    if (simulator_.time() - start_ < next) return false;
    ++samples_;
    return true;
  }

  skills::Status Control(double start, const RolloutHooks& hooks) {
    robot::Command command;
    robot::Observation seen = simulator_.Observe(start);
    for (geometry::Polygon& outline : floor_.SeenBy(simulator_, seen.X_MB))
      seen.obstacles_M.push_back(std::move(outline));
    const skills::Status status = skill_->Update(seen, &command);
    if (drives_)
      progress_.Note(simulator_.time() - start, simulator_.base().X_MB, skill_->drive_view());
    simulator_.Send(command);
    next_cycle_ += skill_->period();
    if (control_rng_.Bernoulli(variation_.late_cycle_probability)) {
      next_cycle_ += variation_.late_cycle_delay;
      if (hooks.on_late_cycle) hooks.on_late_cycle(simulator_, variation_.late_cycle_delay);
    }
    return status;
  }

  /// What is down may be run over, and jump: the fall came before, and counts, be it that of a load
  /// or of what was knocked over.
  void NoteBroken(const LoadMonitor& monitor) {
    if (is_broken_ || !simulator_.broken_object()) return;
    is_broken_ = true;
    if (monitor.falls() > 0) return;
    down_before_ = monitor.KnockedOver();
    is_void_ = down_before_.empty();
  }

  /// Of a drive that came no further, from when on and what would help. Others are left alone.
  void SayWhyItEnds(const RolloutHooks& hooks, base::Failure* failure) const {
    const bool is_endless = failure->code == Code::kTimedOut || failure->code == Code::kOscillating;
    if (!is_endless || !drives_ || !driving_) return;
    const std::optional<Stall> stall = progress_.StallAtEnd();
    if (stall && hooks.on_stall) hooks.on_stall(start_ + stall->since, WhatItDoes(*stall));
    if (!failure->detail.empty()) return;
    if (stall) {
      const auto goal = progress_.X_MGoal();
      const std::string why_tight = goal ? skills::WhyGoalIsTight(*driving_, *goal) : "";
      failure->detail = StallText(*stall, driving_->params, why_tight);
    } else if (failure->code == Code::kTimedOut) {
      failure->detail = UnderWayText(params_.time_limit, progress_.ToGoal(), progress_.ComesOn());
    }
  }

  /// A robot without a laser drives round nothing loose.
  void SayWhatIsInNoMap(base::Failure* failure) const {
    const simulation::Scene& scene = simulator_.scene();
    const bool sees = !scene.robot.profile.laser_link.empty();
    if (failure->code != Code::kKnockedOver || sees || !plans_) return;
    std::vector<std::string> things;
    bool is_any_of_world = false;
    for (const std::string& name : failure->subjects) {
      const std::string source = world::SourceOf(name, scene.world);
      things.push_back(fmt::format("'{}'{}", name, source.empty() ? "" : " (" + source + ")"));
      is_any_of_world |= !source.empty();
    }
    const bool is_one = things.size() == 1;
    failure->detail = fmt::format(
        "{} {} loose, so not in the map by which drives are planned, and the robot has no laser "
        "that would see {}: name its laser (laser_link){}",
        base::Join(things, ", "), is_one ? "is" : "are", is_one ? "it" : "them",
        is_any_of_world ? ", or let the world have what is in the way as <static>" : "");
  }

  base::Failure Collision() const {
    const simulation::RobotContact& contact = *simulator_.contact();
    return {Code::kRobotCollision, {contact.robot_part, contact.obstacle}, ToString(contact)};
  }

  bool HasTipped() const { return balance_ && balance_->tipped_over; }
  base::Failure Tipped() const {
    return {Code::kRobotTips, {simulator_.scene().robot.model.name}, balance_->TippedText()};
  }

  void StepOnce() {
    simulator_.Step();
    if (balance_) balance_->Step(simulator_.base(), simulator_.time_step());
  }

  bool IsApart() const { return watch_ == nullptr || watch_->Look(simulator_); }

  /// False if it is cancelled, or something comes near what is left out.
  bool WatchAftermath(LoadMonitor* monitor, const RolloutHooks& hooks) {
    const double end = simulator_.time() + params_.aftermath;
    const long steps_per_look = world::StepsPerLook(simulator_.time_step());
    while (simulator_.time() < end && !monitor->IsSettled()) {
      PlayUntilNextLook(steps_per_look, *monitor, hooks);
      monitor->Look();
      if (!IsApart() || IsCancelled(hooks)) return false;
    }
    return IsApart();
  }

  /// After the action, where samples are for those who watch alone.
  void PlayUntilNextLook(long steps, const LoadMonitor& monitor, const RolloutHooks& hooks) {
    for (long i = 0; i < steps; ++i) {
      StepOnce();
      if (hooks.epilogue > 0.0 && hooks.on_sample && IsSampleDue()) {
        hooks.on_sample(simulator_, monitor.tilt());
      }
    }
    if (hooks.on_look) hooks.on_look(simulator_);
  }

  void PlayEpilogue(const LoadMonitor& monitor, const RolloutHooks& hooks) {
    if (monitor.is_lost()) return;
    const double end = simulator_.time() + hooks.epilogue;
    const long steps_per_look = world::StepsPerLook(simulator_.time_step());
    while (simulator_.time() < end && !IsCancelled(hooks))
      PlayUntilNextLook(steps_per_look, monitor, hooks);
  }

  void Conclude(const skills::Status& status, const LoadMonitor& monitor) {
    result_.action_finished = status.progress == skills::Progress::kSucceeded;
    result_.nothing_watched = !monitor.watches_something();
    // It was over before the first sample was due: who stands at the goal already has arrived.
    if (result_.action_finished && samples_ == 0) result_.counts += monitor.Sample();
    result_.failure = result_.action_finished ? monitor.WhyNotWell() : status.failure;
    if (!result_.failure && HasTipped()) result_.failure = Tipped();
    result_.falls = monitor.falls();
    if (!down_before_.empty()) {  // what fell after that may have been thrown
      if (result_.action_finished) result_.failure = {Code::kKnockedOver, down_before_};
      result_.falls = static_cast<int>(down_before_.size());
    }
    SayWhatIsInNoMap(&result_.failure);
    result_.outcome = !result_.failure                          ? Outcome::kSucceeded
                      : result_.failure.code == Code::kTimedOut ? Outcome::kTimedOut
                                                                : Outcome::kFailed;
    if (result_.outcome == Outcome::kSucceeded && ActionFailed(result_)) {
      result_.outcome = Outcome::kFailed;
      result_.failure = Code::kNoSamples;
    }
    if (is_void_) {
      const int broken = *simulator_.broken_object();
      const std::string name = simulator_.GetWorldState().objects.at(broken).name;
      result_.failure = {Code::kPhysicsBroke, {name}, name + " gained energy that nothing gave it"};
      result_.outcome = Outcome::kFailed;
      result_.falls = 0;  // what moved it was no drive
    }
    result_.max_tilt = monitor.max_tilt();
    result_.first_cause = monitor.first_cause();
    result_.final_world = simulator_.GetWorldState();
    result_.final_robot = simulator_.GetRobotState();
    result_.simulated = simulator_.time();
  }

  ReachWatch* const watch_;
  const RolloutParams& params_;
  const world::StandingCriterion& standing_;
  const Purpose purpose_;
  const simulation::Variation variation_;
  std::unique_ptr<skills::Skill> skill_;
  base::Rng control_rng_;
  RobotSimulator simulator_;
  FloorObjects floor_;
  const std::vector<geometry::Pose3> X_BOstart_;
  const bool drives_, plans_;  // its way round what is in the map
  const std::shared_ptr<const skills::DrivingContext> driving_;
  std::optional<simulation::RobotBalance> balance_;  // null: not known
  ProgressWatch progress_;
  double start_{0.0}, next_cycle_{0.0};  // [s]
  long samples_{0};
  bool is_broken_{false}, is_void_{false};  // physics broke; before anything fell
  std::vector<std::string> down_before_;    // what was knocked over before, and no load had fallen
  RolloutResult result_;
};

/// From a start that cannot be.
RolloutResult BadStart(const RolloutSetup& setup, int index, const base::ConfigError& error) {
  // The nominal start is sound (CheckSetup), the sampled one is not: a truth that cannot be.
  base::Log(base::LogLevel::kDebug, fmt::format("rollout={} failure={} {}", index,
                                                base::ToString(Code::kBadStart), error.what()));
  RolloutResult result;
  result.failure = {Code::kBadStart, {}, error.what()};
  result.final_world = setup.world_state;
  result.final_robot = setup.robot_state;
  return result;
}

/// Rollout `index` of an action, from one start or narrowed ones.
struct Rollout {
  Rollout(const RolloutSetup& setup, const base::ActionCall& action_in, int index)
      : action(action_in),
        rng(base::Rng(setup.seed).Fork(static_cast<std::uint64_t>(index))),
        variation(DrawTruth(setup, rng.Fork(kVariation))) {}

  std::optional<RolloutResult> Play(const RolloutSetup& setup, std::unique_ptr<skills::Skill> skill,
                                    const RolloutHooks& hooks, ReachWatch* watch) const {
    return Player(setup, action, std::move(skill), variation, rng, watch).Play(hooks);
  }

  const base::ActionCall& action;
  const base::Rng rng;
  const simulation::Variation variation;
};

}  // namespace

RolloutParams ReadRolloutParams(base::ParamReader in) {
  RolloutParams params;
  params.settling_time = in.Get("settling_time", base::Between(0.0, 10.0));
  params.time_limit = in.Get("time_limit", base::Between(0.1, 3600.0));
  params.sample_period = in.Get("sample_period", base::Between(0.001, 1.0));
  params.shaking_tilt = in.Get("shaking_tilt", base::Between(0.0, 1.0));
  params.topple_tilt = in.Get("topple_tilt", base::Between(0.01, 3.2));
  if (params.shaking_tilt >= params.topple_tilt) {
    in.Fail("shaking_tilt", "wanted less than topple_tilt");
  }
  params.aftermath = in.Get("aftermath", base::Between(0.0, 10.0));
  params.put_back = in.GetBool("put_back");
  params.put_back_tilt = in.Get("put_back_tilt", base::Between(0.01, 3.2));
  return params;
}

OutcomeCounts SampleOf(double tilt, const RolloutParams& params) {
  OutcomeCounts counts;
  counts.notopple = tilt <= params.shaking_tilt;
  counts.topple = tilt >= params.topple_tilt;
  counts.shaking = 1 - counts.notopple - counts.topple;
  return counts;
}

void CheckSetup(const RolloutSetup& setup, const base::ActionCall& action) {
  CheckSetupForAll(setup, {action});
}

void CheckSetupForAll(const RolloutSetup& setup, const std::vector<base::ActionCall>& actions) {
  std::set<simulation::LevelOfDetail> levels;
  for (const base::ActionCall& action : actions) {
    skills::MakeSkill(*setup.skills, action);
    levels.insert(LevelFor(*setup.skills, action));
  }
  for (const simulation::LevelOfDetail level : levels) {
    RobotSimulator(setup.scene, {}, setup.world_state, setup.robot_state, base::Rng(setup.seed),
                   setup.physics, level);
  }
  CheckHands(setup);
}

std::optional<RolloutResult> PlayRollout(const RolloutSetup& setup, const base::ActionCall& action,
                                         int index, const RolloutHooks& hooks) {
  const Rollout rollout(setup, action, index);
  auto skill = skills::MakeSkill(*setup.skills, action);  // an unknown action is refused
  try {
    const bool is_drive = LevelFor(*setup.skills, action) == simulation::LevelOfDetail::kTray;
    if (!is_drive || !AllAreAtRest(setup.world_state)) {
      return rollout.Play(setup, std::move(skill), hooks, nullptr);
    }
    ReachWatch watch(setup, action);
    while (true) {
      auto result = rollout.Play(watch.narrowed(), std::move(skill), hooks, &watch);
      if (result) {
        result->final_world = watch.WithLeftOut(result->final_world);
        result->reach = watch.reach();
        return result;
      }
      if (!watch.is_touched()) return std::nullopt;
      watch.BeginAgain();
      skill = skills::MakeSkill(*setup.skills, action);
    }
  } catch (const base::ConfigError& error) {
    return BadStart(setup, index, error);
  }
}

}  // namespace hires::imagination
