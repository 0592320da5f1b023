#include "sim_robot/sim_robot_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/simulation/free_start.h"
#include "sim_robot/bump_schedule.h"
#include "sim_robot/scenario.h"

namespace hires::sim_robot {
namespace {

using base::ConfigError;
using base::ToLower;
using geometry::Pose2;
using geometry::Pose3;
using geometry::Twist2;
using imagination::ImaginationSetup;
using imagination::StartState;
using simulation::RobotSimulator;

constexpr long kSettling = 500;  // [ms]
constexpr long kWalkStep = 50;   // [ms]
constexpr double kStood = 0.02;  // [m], [rad] by which one that stands moves at most
enum Streams : std::uint64_t {
  kVariation,
  kSimulator,
  kControl,
  kOdometer,
  kFurniture,
  kBumps,
  kWalk,
  kMotion
};

template <typename T>
const T& Lookup(const std::map<std::string, T>& known, const std::string& kind,
                const std::string& name, const std::string& where) {
  const auto found = known.find(ToLower(name));
  if (found != known.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& entry : known) names.push_back(entry.first);
  throw ConfigError(where + ": " + base::UnknownName(kind, name, names));
}

void SetPostures(const robot::Robot& robot, const Scenario& scenario, const std::string& where,
                 robot::JointPositions* joints) {
  if (!robot.profile.upper_body) return;  // nothing above the base moves
  const robot::UpperBodyProfile& body = *robot.profile.upper_body;
  if (scenario.torso.empty()) {
    throw ConfigError(where + ": robot.torso is missing; name the posture in which it begins");
  }
  (*joints)[body.torso_joint] = Lookup(body.torso_postures, "torso posture", scenario.torso, where);
  for (const auto& [name, posture] : scenario.arms) {
    const robot::ArmProfile& arm = Lookup(body.arms, "arm", name, where);
    const auto& positions = Lookup(arm.postures, "posture of " + name, posture, where).front();
    for (std::size_t i = 0; i < arm.joints.size(); ++i) (*joints)[arm.joints[i]] = positions[i];
  }
}

StartState StartOfScenario(const ImaginationSetup& setup, const std::string& path) {
  const Scenario scenario = ReadScenario(path);
  StartState start;
  start.robot.X_MB = scenario.X_MB;
  SetPostures(setup.scene->robot, scenario, path, &start.robot.joints);
  for (const ScenarioObject& object : scenario.objects) {
    const std::string& kind = object.model.empty() ? object.name : object.model;
    start.world.objects.push_back({object.name, setup.ModelOf(kind), object.X_MO, {}, ""});
  }
  return start;
}

long StepsPerMillisecond(double time_step) {
  const double steps = 0.001 / time_step;
  if (std::abs(steps - std::round(steps)) < 1e-6 && steps > 0.5) return std::lround(steps);
  throw ConfigError(fmt::format(
      "physics: time_step is {:g} s; the robot's sensors need 0.001 s or a whole part of it",
      time_step));
}

}  // namespace

simulation::LevelOfDetail LevelFor(const simulation::Scene& scene) {
  return scene.robot.profile.upper_body ? simulation::LevelOfDetail::kPlanar
                                        : simulation::LevelOfDetail::kTray;
}

StartState StartOf(const ImaginationSetup& setup, const std::string& scenario,
                   const std::string& area) {
  return scenario.empty() ? imagination::MakeStartState(setup, area, std::vector<std::string>{})
                          : StartOfScenario(setup, scenario);
}

SimRobotWorld::SimRobotWorld(const ImaginationSetup& imagined, const StartState& start,
                             std::uint64_t seed, const Truth& truth)
    : setup_(std::make_shared<const ImaginationSetup>(
          SetupOf(truth, imagined, start.robot.X_MB, base::Rng(seed).Fork(kFurniture)))),
      control_rng_(base::Rng(seed).Fork(kControl)),
      simulator_rng_(base::Rng(seed).Fork(kSimulator)),
      steps_per_millisecond_(StepsPerMillisecond(imagined.physics.time_step)),
      walk_(truth.walk),
      walk_rng_(base::Rng(seed).Fork(kWalk)) {
  const base::Rng rng(seed);
  const ImaginationSetup& setup = *setup_;
  variation_ = simulation::WithFreeStart(
      DrawVariation(truth, *setup.uncertainty, rng.Fork(kVariation)), *setup.scene, start.robot);
  odometry_scale_ = 1.0 + rng.Fork(kOdometer).Normal(0.0, variation_.wheel_slip);
  simulator_ =
      std::make_unique<RobotSimulator>(setup.scene, variation_, start.world, start.robot,
                                       simulator_rng_, setup.physics, LevelFor(*setup.scene));
  Advance(kSettling);
  milliseconds_ = 0;
  if (truth.bumps.mean_interval > 0.0) {
    bumps_ = std::make_unique<BumpSchedule>(truth.bumps, rng.Fork(kBumps));
  }
  if (truth.localisation == Localisation::kNothing)
    BeginToMeasure(truth.self_localisation, rng.Fork(kMotion));
}

void SimRobotWorld::BeginToMeasure(std::shared_ptr<const simulation::SelfLocalisationParams> params,
                                   const base::Rng& rng) {
  X_MBstart_ = simulator_->base().X_MB;
  told_start_ = {simulation::BelievedStart(*params, X_MBstart_, rng),
                 simulation::StartCovariance(*params)};
  motion_.emplace(std::move(params), X_MBstart_, rng);
}

std::optional<ToldPlace> SimRobotWorld::ToldStart() const {
  if (!motion_) return std::nullopt;
  const Pose2 moved = X_MBstart_.Inverse() * simulator_->base().X_MB;
  if (moved.position().norm() > kStood || std::abs(moved.yaw) > kStood) return std::nullopt;
  return told_start_;
}

SimRobotWorld::~SimRobotWorld() = default;

void SimRobotWorld::Advance(long milliseconds) {
  for (long i = 0; i < milliseconds; ++i) {
    DeliverLate();
    if (bumps_) Bump();
    if (milliseconds_ % kWalkStep == 0) Walk(0.001 * kWalkStep);
    for (long step = 0; step < steps_per_millisecond_; ++step) simulator_->Step();
    MoveOdometry(0.001);
    ++milliseconds_;
  }
}

void SimRobotWorld::Bump() {
  const std::optional<Twist2> push = bumps_->PushAt(time());
  if (push || is_pushed_) simulator_->Push(push);
  is_pushed_ = push.has_value();
}

/// A process whose spread stays the same while its values lose their memory.
void SimRobotWorld::Walk(double dt) {
  if (walk_.sd == 0.0 && walk_.sd_yaw == 0.0) return;
  const double keep = std::exp(-dt / walk_.time), rest = std::sqrt(1.0 - keep * keep);
  const auto move = [&](double sd, double* error) {
    *error = keep * *error + rest * walk_rng_.Normal(0.0, sd);
  };
  move(walk_.sd, &walk_error_.x);
  move(walk_.sd, &walk_error_.y);
  move(walk_.sd_yaw, &walk_error_.yaw);
}

void SimRobotWorld::MoveOdometry(double dt) {
  const Twist2& V_B = simulator_->base().V_B;
  const double length = odometry_scale_ * dt;
  const double half_turn = 0.5 * dt * V_B.wz;
  // The middle of the arc: second order, as the simulator's own base.
  const Pose2 turn{0.0, 0.0, half_turn};
  X_OB_ = X_OB_ * turn * Pose2{length * V_B.vx, length * V_B.vy, 0.0} * turn;
}

void SimRobotWorld::Apply(const robot::Command& command) {
  robot::Command rest = command;
  rest.base_velocity.reset();
  simulator_->Send(rest);
  NoteSent(rest);
  if (!command.base_velocity) return;
  if (time() < late_until_) {
    held_back_ = command.base_velocity;
  } else {
    Deliver(*command.base_velocity);
  }
}

void SimRobotWorld::NoteSent(const robot::Command& command) {
  for (const auto& [group, trajectory] : command.trajectories) {
    trajectories_[group] = {time(), trajectory};
  }
  for (const auto& [arm, gripper] : command.grippers) grippers_[arm] = gripper;
}

void SimRobotWorld::Deliver(const Twist2& velocity) {
  robot::Command command;
  command.base_velocity = velocity;
  simulator_->Send(command);
  const double period = std::min(time() - last_delivery_, 0.2);
  last_delivery_ = time();
  if (control_rng_.Bernoulli(variation_.late_cycle_probability)) {
    late_until_ = time() + period + variation_.late_cycle_delay;
  }
}

void SimRobotWorld::DeliverLate() {
  if (!held_back_ || time() < late_until_) return;
  const Twist2 velocity = *held_back_;
  held_back_.reset();
  Deliver(velocity);
}

/// Asked twice at one moment, they say the same twice.
void SimRobotWorld::Measure() {
  if (time() > moved_) motion_->Drive(time() - moved_, simulator_->base().X_MB);
  moved_ = time();
  X_OB_ = motion_->odometry().X_OB;
}

Twist2 SimRobotWorld::VelocityByOdometry() const {
  if (motion_) return motion_->odometry().V_B;
  if (const simulation::SelfLocaliser* own = simulator_->self_localiser()) return own->V_B();
  const Twist2& V_B = simulator_->base().V_B;
  return {odometry_scale_ * V_B.vx, odometry_scale_ * V_B.vy, V_B.wz};
}

SensorReadings SimRobotWorld::Sense() {
  const robot::Observation seen = simulator_->Observe(0.0);
  SensorReadings readings;
  if (const simulation::SelfLocaliser* own = simulator_->self_localiser()) {
    X_OB_ = own->X_OB();
    readings.covariance = own->Estimate().covariance;
  }
  if (motion_) {
    Measure();
    readings.inertia = motion_->inertia();
  }
  readings.X_MB = walk_.sd > 0.0 || walk_.sd_yaw > 0.0 ? seen.X_MB * walk_error_ : seen.X_MB;
  readings.X_MO = readings.X_MB * X_OB_.Inverse();
  readings.odometry = {X_OB_, VelocityByOdometry()};
  readings.joints = {seen.joints, seen.joint_velocities};
  if (readings.joints.positions.empty()) {
    readings.joints.positions = simulator_->GetRobotState().joints;
  }
  readings.ghosts_M = seen.obstacles_M;
  return readings;
}

}  // namespace hires::sim_robot
