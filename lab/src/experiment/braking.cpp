#include "lab/src/experiment/braking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "hires/base/rng.h"
#include "hires/imagination/uncertainty.h"
#include "hires/simulation/fall_watch.h"
#include "hires/simulation/robot_simulator.h"
#include "lab/src/experiment/experiment.h"
#include "lab/src/experiment/stage.h"

namespace hires::lab {
namespace {

using geometry::Twist2;
using imagination::ImaginationSetup;
using simulation::RobotSimulator;

constexpr double kTick = 0.02;     // [s] between two looks of the guard, as its node has it
constexpr double kQuiet = 0.6;     // [s] that the base must have stood ...
constexpr double kStill = 0.004;   // [rad] ... with its load no more tilted than this
constexpr double kNoSlip = 100.0;  // friction of what closed forms suppose
enum BrakingStreams : std::uint64_t { kBrakingTruth, kBrakingSimulator };

/// The robot alone on an even floor, its base stopping in a given way.
std::shared_ptr<const simulation::Scene> SceneFor(const ImaginationSetup& setup,
                                                  const BrakingWay& way, bool is_ideal) {
  world::World floor = setup.scene->world;
  floor.statics.clear();
  robot::Robot robot = setup.scene->robot;
  robot::BaseControllerParams& controller = robot.profile.base_controller;
  controller = ControllerFor(controller, way);
  if (is_ideal) {
    controller.casters.reset();
    controller.loop_frequency = controller.command_lag = controller.sway_compliance = 0.0;
  }
  auto scene = simulation::MakeScene(std::move(floor), std::move(robot));
  if (!is_ideal) return scene;
  simulation::Scene rough = *scene;
  for (geometry::Collision& shape : rough.robot_shapes_B) shape.friction = kNoSlip;
  return std::make_shared<const simulation::Scene>(std::move(rough));
}

/// One stop in one world.
class Player {
 public:
  Player(const BrakingConfig& braking, const BrakingCell& cell, const ImaginationSetup& setup,
         RobotSimulator* simulator)
      : braking_(braking),
        cell_(cell),
        rollout_(setup.rollout),
        simulator_(*simulator),
        guard_(braking.guard),
        watch_(setup.standing),
        steps_per_look_(world::StepsPerLook(simulator->time_step())) {}

  BrakingStop Play() {
    StepFor(rollout_.settling_time, [] { return Twist2{}; });
    Drive();
    stop_.tilt_before = stop_.max_tilt;
    stop_.max_tilt = 0.0;
    begin_ = simulator_.time();
    X_MBbegin_ = simulator_.base().X_MB;
    watch_.Look(simulator_, 0);
    Brake();
    stop_.fell = watch_.detector().falls() > 0;
    stop_.simulated = simulator_.time();
    return stop_;
  }

 private:
  template <typename NextVelocity>
  void StepFor(double duration, const NextVelocity& next) {
    const long steps = std::lround(duration / simulator_.time_step());
    for (long i = 0; i < steps; ++i) {
      Send(next());
      Step();
    }
  }

  void Send(const Twist2& V) {
    robot::Command command;
    command.base_velocity = V;
    simulator_.Send(command);
  }

  void Step() {
    simulator_.Step();
    if (++steps_ % steps_per_look_ == 0) Look();
  }

  void Look() {
    tilt_ = geometry::TiltOf(simulator_.PoseOf(0).rotation);
    stop_.max_tilt = std::max(stop_.max_tilt, tilt_);
    if (!begin_) return;  // what it does while driving is not the stop's
    watch_.Look(simulator_, 0);
    stop_.slide = std::max(stop_.slide, watch_.detector().now().slide);
  }

  /// Up to full speed, and on until nothing shakes any more.
  void Drive() {
    const BrakingMotion& full = cell_.motion;
    const double rise = std::max(full.linear, std::abs(full.angular)) / braking_.run_up;
    double share = 0.0;
    StepFor(rise, [&] {
      share = std::min(1.0, share + simulator_.time_step() / rise);
      return Twist2{share * full.linear, 0.0, share * full.angular};
    });
    const Twist2 V{full.linear, 0.0, full.angular};
    const long ticks = std::lround(braking_.cruise / kTick);
    guard_.OnMotorsHalted(false);
    guard_.OnLocalisation(0.0, 0.0);
    for (long i = 0; i < ticks; ++i) {
      Tell(V);
      guard_.Update(simulator_.time());
      StepFor(kTick, [&] { return V; });
    }
  }

  /// What the guard gets to know at each of its looks.
  void Tell(const Twist2& V) {
    const double now = simulator_.time();
    guard_.OnOdometry(simulator_.Observe(0.0).V_B, now, now);
    guard_.OnTransform(navigation::PoseSource::kBaseTransform, now, now);
    guard_.OnTransform(navigation::PoseSource::kMapTransform, now, now);
    guard_.OnScan(now, now);
    guard_.OnRequest({1, {1.0, 2.0, 2.5, 3.2}, cell_.limits}, now);
    guard_.OnCommand(V, now);
  }

  void Brake() {
    guard_.OnMotorsHalted(true);
    const double end = *begin_ + 2.0 * cell_.stated_time + rollout_.aftermath;
    while (simulator_.time() < end && !IsOver()) {
      Tell({});
      const auto led = guard_.Update(simulator_.time());
      const BrakingWay::Kind kind = cell_.way.kind;
      if (kind == BrakingWay::Kind::kRamp) {
        Send(led.value_or(Twist2{}));
      } else if (kind != BrakingWay::Kind::kSilence) {
        Send({});
      }
      for (long i = std::lround(kTick / simulator_.time_step()); i > 0; --i) {
        Step();
        NoteStand();
      }
    }
    const geometry::Pose2 X_BbB = X_MBbegin_.Inverse() * simulator_.base().X_MB;
    stop_.distance = std::hypot(X_BbB.x, X_BbB.y);
  }

  /// The last moment at which the base still moved.
  void NoteStand() {
    const Twist2& V = simulator_.base().V_B;
    const bool moves = std::hypot(V.vx, V.vy) > kStandingSpeed || std::abs(V.wz) > kStandingSpeed;
    if (moves) stop_.time = simulator_.time() - *begin_;
  }

  /// Nothing comes any more: the load lies, or the base has stood for a while and the load is
  /// still.
  bool IsOver() const {
    const double since = simulator_.time() - *begin_ - stop_.time;
    return since > kQuiet && (watch_.detector().is_down() || tilt_ < kStill);
  }

  const BrakingConfig& braking_;
  const BrakingCell& cell_;
  const imagination::RolloutParams& rollout_;
  RobotSimulator& simulator_;
  navigation::BaseGuard guard_;
  BrakingStop stop_;
  std::optional<double> begin_;
  geometry::Pose2 X_MBbegin_;
  simulation::FallWatch watch_;  // of the load, from the stop's beginning on
  double tilt_{0.0};             // [rad] at the last look
  const long steps_per_look_;
  long steps_{0};
};

/// What all stops of a cell share.
struct CellSetup {
  std::shared_ptr<const simulation::Scene> scene, ideal_scene;
  std::vector<imagination::StartState> starts;  // one per goal: other headings
};

CellSetup SetUp(const BrakingCell& cell, const ExperimentConfig& config, const Stage& stage) {
  CellSetup setup{
      SceneFor(stage.setup, cell.way, false), SceneFor(stage.setup, cell.way, true), {}};
  for (const Goal& goal : config.goals) {
    const geometry::Pose3 X_MG = *stage.setup.scene->world.FindFrame(goal.name);
    setup.starts.push_back(
        imagination::StartOnTray(stage.setup, geometry::Flatten(X_MG), {cell.load}));
  }
  return setup;
}

BrakingStop PlayOne(const BrakingConfig& braking, const BrakingCell& cell, const CellSetup& setup,
                    const ExperimentConfig& config, const Stage& stage, int index) {
  const base::Rng rng = base::Rng(config.seed).Fork(static_cast<std::uint64_t>(index));
  simulation::Variation truth =
      imagination::SampleVariation(*stage.setup.uncertainty, rng.Fork(kBrakingTruth));
  const imagination::StartState& start = setup.starts[index % setup.starts.size()];
  RobotSimulator simulator(setup.scene, truth, start.world, start.robot,
                           rng.Fork(kBrakingSimulator), stage.setup.physics,
                           simulation::LevelOfDetail::kTray);
  return Player(braking, cell, stage.setup, &simulator).Play();
}

BrakingStop PlayIdeal(const BrakingConfig& braking, const BrakingCell& cell, const CellSetup& setup,
                      const ExperimentConfig& config, const Stage& stage) {
  simulation::Variation nominal;
  nominal.friction_factor = kNoSlip;
  const imagination::StartState& start = setup.starts.front();
  RobotSimulator simulator(setup.ideal_scene, nominal, start.world, start.robot,
                           base::Rng(config.seed), stage.setup.physics,
                           simulation::LevelOfDetail::kTray);
  return Player(braking, cell, stage.setup, &simulator).Play();
}

}  // namespace

std::optional<std::vector<BrakingPlay>> PlayBraking(const BrakingConfig& braking,
                                                    const ExperimentConfig& config,
                                                    const Stage& stage, const base::Crew& crew) {
  std::vector<BrakingPlay> plays = BrakingCells(braking, stage);
  std::vector<CellSetup> setups;
  for (BrakingPlay& play : plays) {
    setups.push_back(SetUp(play.cell, config, stage));
    play.stops.resize(braking.rollouts);
  }
  const int num_cells = static_cast<int>(plays.size());
  const auto work = [&](int task, const base::Advance& advance) {
    BrakingPlay& play = plays[task % num_cells];
    const CellSetup& setup = setups[task % num_cells];
    const int index = task / num_cells;
    play.stops[index] = PlayOne(braking, play.cell, setup, config, stage, index);
    if (index == 0 && play.cell.is_comparable) {
      play.ideal = PlayIdeal(braking, play.cell, setup, config, stage);
    }
    advance(1.0);
  };
  const int num_tasks = num_cells * braking.rollouts;
  if (!base::DoInParallel(num_tasks, num_tasks, crew, work)) return std::nullopt;
  return plays;
}

}  // namespace hires::lab
