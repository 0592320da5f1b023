#include "reports/limits/load_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/imagination/uncertainty.h"
#include "hires/simulation/fall_watch.h"
#include "hires/simulation/robot_simulator.h"

namespace hires::reports {
namespace {

using geometry::Twist2;

constexpr double kQuiet = 0.6;     // [s] that the load must not have shaken ...
constexpr double kStill = 0.004;   // [rad] ... by more than this
constexpr double kFollows = 0.05;  // [m/s], [rad/s] and ...
constexpr double kSlips =
    0.1;  // ... of what is commanded: so far off a base follows it, as wheels slip
constexpr double kLongest = 60.0;   // [s] for the base to come to what is commanded
constexpr double kNoNearer = 1.0;   // [s] after which it is as near as it comes ...
constexpr double kLevel = 0.05;     // [rad] what leans more is tipping, and its origin moves
constexpr double kAtRest = 2e-4;    // [m] that it moves on the tray in one period of commands
constexpr double kUntilRest = 5.0;  // [s]
constexpr double kNearer = 0.01;    // [m/s], [rad/s] ... where it came no nearer by so much
enum DriveStreams : std::uint64_t { kDriveTruth, kDriveSimulator };

/// The next command on the way to a velocity.
Twist2 Approach(const Twist2& from, const DriveStep& step, double period) {
  const double dx = step.V_B.vx - from.vx, dy = step.V_B.vy - from.vy;
  const double distance = std::hypot(dx, dy), most = step.linear_rate * period;
  const double share = distance > most ? most / distance : 1.0;
  const double turn = step.angular_rate * period;
  return {from.vx + share * dx, from.vy + share * dy,
          from.wz + std::clamp(step.V_B.wz - from.wz, -turn, turn)};
}

bool AreEqual(const Twist2& a, const Twist2& b) {
  return a.vx == b.vx && a.vy == b.vy && a.wz == b.wz;
}

class Driver {
 public:
  Driver(const DriveStage& stage, const LoadDrive& drive, simulation::RobotSimulator* simulator)
      : stage_(stage),
        drive_(drive),
        simulator_(*simulator),
        payloads_(stage.start.world.objects.size(), Payload(stage.setup->standing)),
        steps_per_look_(world::StepsPerLook(simulator->time_step())) {}

  DriveOutcome Play() {
    MarkPlaces();
    Advance(stage_.setup->rollout.settling_time, Twist2{});
    for (std::size_t i = 0; i < drive_.size(); ++i) {
      if (i > 0) AwaitRest(false);
      MarkPlaces();
      Follow(drive_[i]);
    }
    last_shake_ = last_move_ = simulator_.time();  // what comes now is not known to be quiet
    const bool is_silent = !drive_.empty() && drive_.back().is_silent;
    while (!IsOver()) Command(is_silent);
    AwaitRest(is_silent);
    DriveOutcome outcome{{}, {}, simulator_.time()};
    for (const Payload& payload : payloads_) {
      outcome.fell.push_back(IsDown(payload));
      outcome.slide.push_back(payload.slide);
    }
    return outcome;
  }

 private:
  struct Payload {
    explicit Payload(const world::StandingCriterion& criterion) : watch(criterion) {}
    simulation::FallWatch watch;
    geometry::Pose3 X_BO;  // when the step of the drive began
    double slide{0.0};     // [m] since then, the largest of all steps
  };

  geometry::Pose3 PlaceOf(std::size_t i) const {
    return simulator_.X_MB().Inverse() * simulator_.PoseOf(static_cast<int>(i));
  }

  void MarkPlaces() {
    for (std::size_t i = 0; i < payloads_.size(); ++i) payloads_[i].X_BO = PlaceOf(i);
  }

  void AwaitRest(bool is_silent) {
    const double end = simulator_.time() + kUntilRest;
    for (bool rests = false; !rests && simulator_.time() < end && !is_down();) {
      std::vector<geometry::Pose3> before;
      for (std::size_t i = 0; i < payloads_.size(); ++i) before.push_back(PlaceOf(i));
      Command(is_silent);
      rests = true;
      for (std::size_t i = 0; i < payloads_.size(); ++i) {
        rests &= world::DepartureFrom(before[i], PlaceOf(i)).slide < kAtRest;
      }
    }
  }

  void Follow(const DriveStep& step) {
    if (step.is_silent) {
      V_B_ = {};
      return;
    }
    while (!AreEqual(V_B_, step.V_B) && !is_down()) {
      V_B_ = Approach(V_B_, step, stage_.command_period);
      Command(false);
    }
    AwaitVelocity(step.may_fall_short);
    const double end = simulator_.time() + step.hold;
    while (simulator_.time() < end && !is_down()) Command(false);
  }

  /// The controller may be slower than what it is told.
  void AwaitVelocity(bool may_fall_short) {
    const double begin = simulator_.time();
    double least = Shortfall(), since = begin;
    while (!is_down() && !FollowsCommand()) {
      Command(false);
      if (Shortfall() < least - kNearer) {
        least = Shortfall();
        since = simulator_.time();
      }
      if (may_fall_short && simulator_.time() - since > kNoNearer) return;
      if (simulator_.time() - begin < kLongest) continue;
      throw base::ConfigError(
          fmt::format("the base does not come to ({:.2f}, {:.2f}) m/s and {:.2f} rad/s within "
                      "{:.0f} s, wanted a "
                      "controller that does; see base_controller in the robot's profile",
                      V_B_.vx, V_B_.vy, V_B_.wz, kLongest));
    }
  }

  /// [m/s] or [rad/s] by which the base is farther from what is commanded than one that follows.
  double Shortfall() const {
    const Twist2& V = simulator_.base().V_B;
    const double linear = std::hypot(V.vx - V_B_.vx, V.vy - V_B_.vy);
    const double angular = std::abs(V.wz - V_B_.wz);
    return std::max(linear - kFollows - kSlips * std::hypot(V_B_.vx, V_B_.vy),
                    angular - kFollows - kSlips * std::abs(V_B_.wz));
  }

  bool FollowsCommand() const { return Shortfall() < 0.0; }

  /// For one period of commands.
  void Command(bool is_silent) {
    Advance(stage_.command_period, is_silent ? std::nullopt : std::optional<Twist2>(V_B_));
  }

  /// A velocity is repeated as often as a base's controller wants to hear it.
  void Advance(double duration, const std::optional<Twist2>& V) {
    const long steps = std::lround(duration / simulator_.time_step());
    for (long i = 0; i < steps; ++i) {
      if (V) {
        robot::Command command;
        command.base_velocity = *V;
        simulator_.Send(command);
      }
      simulator_.Step();
      if (stage_.on_step) stage_.on_step(simulator_);
      if (++steps_ % steps_per_look_ == 0) Look();
    }
  }

  void Look() {
    for (std::size_t i = 0; i < payloads_.size(); ++i) {
      Payload& payload = payloads_[i];
      payload.watch.Look(simulator_, static_cast<int>(i));
      const double tilt = geometry::TiltOf(simulator_.PoseOf(static_cast<int>(i)).rotation);
      if (tilt > kStill && !IsDown(payload)) last_shake_ = simulator_.time();
      if (tilt > kLevel || IsDown(payload)) continue;
      payload.slide = std::max(payload.slide, world::DepartureFrom(payload.X_BO, PlaceOf(i)).slide);
    }
    if (!FollowsCommand()) last_move_ = simulator_.time();
  }

  bool IsDown(const Payload& payload) const {
    return payload.watch.detector().falls() > 0 || payload.slide > stage_.setup->standing.slide;
  }
  bool is_down() const {
    const auto down = [this](const Payload& payload) { return IsDown(payload); };
    return stage_.ends_at_first_fall ? std::any_of(payloads_.begin(), payloads_.end(), down)
                                     : std::all_of(payloads_.begin(), payloads_.end(), down);
  }
  /// Once the base does as told nothing is added to what shakes: `aftermath` shows what becomes of
  /// it.
  bool IsOver() const {
    const double quiet = simulator_.time() - std::max(last_shake_, last_move_);
    const double done = simulator_.time() - last_move_;
    return is_down() || quiet > kQuiet || done > kQuiet + stage_.setup->rollout.aftermath;
  }

  const DriveStage& stage_;
  const LoadDrive& drive_;
  simulation::RobotSimulator& simulator_;
  std::vector<Payload> payloads_;
  const long steps_per_look_;
  long steps_{0};
  Twist2 V_B_;              // the last that was commanded
  double last_shake_{0.0};  // [s] of a payload
  double last_move_{0.0};   // [s] that the base was on its way to V_B_
};

}  // namespace

bool DriveOutcome::AnyFell() const {
  return std::find(fell.begin(), fell.end(), true) != fell.end();
}

double DriveOutcome::MaxSlide() const {
  return slide.empty() ? 0.0 : *std::max_element(slide.begin(), slide.end());
}

DriveStage MakeDriveStage(const imagination::ImaginationSetup& setup,
                          const std::vector<std::string>& objects, double command_period) {
  DriveStage stage;
  stage.setup = &setup;
  world::World floor = setup.scene->world;
  floor.statics.clear();
  stage.scene = simulation::MakeScene(std::move(floor), setup.scene->robot, setup.scene->memory,
                                      setup.scene->sight);
  stage.start = imagination::StartOnTray(setup, {}, objects);
  stage.command_period = command_period;
  return stage;
}

DriveOutcome PlayDrive(const DriveStage& stage, const LoadDrive& drive, const base::Rng& rng) {
  simulation::RobotSimulator simulator(stage.scene, VariationOfDrive(stage, rng), stage.start.world,
                                       stage.start.robot, rng.Fork(kDriveSimulator),
                                       stage.setup->physics, simulation::LevelOfDetail::kTray);
  return Driver(stage, drive, &simulator).Play();
}

simulation::Variation VariationOfDrive(const DriveStage& stage, const base::Rng& rng) {
  return imagination::SampleVariation(*stage.setup->uncertainty, rng.Fork(kDriveTruth));
}

}  // namespace hires::reports
