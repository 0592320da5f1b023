#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "hires/base/text.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/navigation/standing_load.h"
#include "hires/physics/closed_forms.h"
#include "lab/src/experiment/braking.h"
#include "lab/src/experiment/experiment.h"
#include "lab/src/experiment/stage.h"

// What is played, and what closed forms say about it.
namespace hires::lab {
namespace {

using base::Between;

constexpr double kAtOnce = 1.0e4;  // [m/s^2] more than any speed needs within a step

BrakingWay ReadWay(base::ParamReader* in, const std::string& name) {
  if (name == "ramp") return {BrakingWay::Kind::kRamp, 0.0, name};
  if (name == "controller") return {BrakingWay::Kind::kConstant, 0.0, name};
  if (name == "silence") return {BrakingWay::Kind::kSilence, 0.0, name};
  if (name == "at_once") return {BrakingWay::Kind::kAtOnce, 0.0, name};
  char* end = nullptr;
  const double value = std::strtod(name.c_str(), &end);
  if (name.empty() || *end != '\0' || !(value >= 0.1 && value <= 100.0)) {
    in->Fail("ways", fmt::format("which has '{}'; wanted ramp, controller, silence, at_once "
                                 "or a deceleration between 0.1 and 100 m/s^2",
                                 name));
  }
  return {BrakingWay::Kind::kConstant, value, name};
}

/// [s] by which the wheels trail their target: on casters in proportion to their effort, else a
/// loop of second order, 2 d / w.
double LoopLag(const robot::BaseControllerParams& controller) {
  if (controller.casters) return robot::RollingLag(*controller.casters);
  return controller.loop_frequency > 0.0 ? 2.0 * controller.loop_damping / controller.loop_frequency
                                         : 0.0;
}

struct MotorStop {
  double time{0.0};      // [s]
  double distance{0.0};  // [m]
};

/// From straight on at speed v, when the wheels' target is 0 at once: at the limit of effort E,
/// that is dv/dt = -(a + b v), until P v / r = E; then v falls as exp(-t / lag).
MotorStop StopByMotors(const robot::CasterParams& casters, double v) {
  MotorStop stop;
  const double lag = robot::RollingLag(casters);
  const double a = robot::HardestStop(casters, 0.0), b = robot::HardestStop(casters, 1.0) - a;
  const double limit = casters.wheel_effort * casters.wheel_radius / robot::WheelGain(casters);
  if (v > limit) {
    stop.time = b > 0.0 ? std::log((a + b * v) / (a + b * limit)) / b : (v - limit) / a;
    stop.distance = b > 0.0 ? (v - limit - a * stop.time) / b : 0.5 * (v * v - limit * limit) / a;
    v = limit;
  }
  stop.distance += lag * v;
  if (v > kStandingSpeed) stop.time += lag * std::log(v / kStandingSpeed);
  return stop;
}

/// [s] in which the wheels' loop comes from speed v to a stand when its target is 0 at once: its
/// envelope is v exp(-r t), -r the real part of its slowest pole.
double SettlingTime(const robot::BaseControllerParams& controller, double v) {
  const double w = controller.loop_frequency, d = controller.loop_damping;
  if (w == 0.0 || v <= kStandingSpeed) return 0.0;
  const double rate = w * (d - std::sqrt(std::max(0.0, d * d - 1.0)));
  return std::log(v / kStandingSpeed) / rate;
}

void StateStop(const BrakingConfig& braking, const robot::BaseControllerParams& controller,
               BrakingCell* cell) {
  const bool is_led = cell->way.kind == BrakingWay::Kind::kRamp;
  const double share =
      controller.casters && !is_led ? robot::RollingShare(*controller.casters) : 1.0;
  const double v = share * cell->motion.linear;
  double lag = controller.command_lag + LoopLag(controller);
  if (is_led) {
    const navigation::PlanarStop stop({v, 0.0, cell->motion.angular}, {}, cell->limits,
                                      braking.guard.braking);
    cell->deceleration = cell->limits.max_deceleration;
    cell->stated_time = stop.duration();
    cell->stated_distance = stop.distance();
  } else if (cell->way.kind == BrakingWay::Kind::kConstant) {
    cell->deceleration = cell->way.deceleration > 0.0 ? cell->way.deceleration
                                                      : controller.limits.max_linear_acceleration;
    // All axes slow down together: around a bend the slower one tells.
    cell->stated_time =
        std::max(v / cell->deceleration,
                 std::abs(cell->motion.angular) / controller.limits.max_angular_acceleration);
    cell->stated_distance = 0.5 * v * cell->stated_time;
  } else {
    cell->deceleration = std::numeric_limits<double>::infinity();
    lag = controller.command_lag;  // only then the wheels lock, or the time-out begins
    if (cell->way.kind == BrakingWay::Kind::kSilence) {
      const double fastest = std::max(v, std::abs(cell->motion.angular));
      cell->stated_time = controller.command_timeout +
                          (controller.casters ? StopByMotors(*controller.casters, fastest).time
                                              : SettlingTime(controller, fastest));
      cell->stated_distance = v * controller.command_timeout +
                              (controller.casters ? StopByMotors(*controller.casters, v).distance
                                                  : v * LoopLag(controller));
    }
  }
  cell->stated_time += lag;
  cell->stated_distance += v * lag;
}

/// A mill is a solid cylinder on its foot, of which closed forms speak.
void Predict(const world::ObjectModel& model, double gravity, BrakingCell* cell) {
  const bool is_cylinder = model.collisions.size() == 1 &&
                           std::holds_alternative<geometry::Cylinder>(model.collisions[0].shape);
  const bool is_straight = cell->motion.angular == 0.0;
  if (!is_cylinder || !is_straight || cell->way.kind == BrakingWay::Kind::kRamp) return;
  const auto& shape = std::get<geometry::Cylinder>(model.collisions[0].shape);
  const physics::UprightCylinder body{shape.radius, shape.length, model.mass_properties.mass};
  const double v = cell->motion.linear, a = cell->deceleration;
  cell->is_comparable = true;
  cell->is_predicted_to_tip = a > physics::TippingAcceleration(body, gravity);
  cell->is_predicted_to_fall =
      std::isinf(a) ? v > physics::SuddenStopTopplingSpeed(body, gravity)
                    : cell->is_predicted_to_tip &&
                          v / a > physics::OverturningPulseDuration(body, a, gravity);
}

}  // namespace

BrakingConfig ReadBraking(base::ParamReader* in, const std::string& path,
                          const ExperimentOverrides& overrides) {
  BrakingConfig braking;
  braking.rollouts = overrides.runs.value_or(in->Get("rollouts", Between(1, 1000000)));
  braking.loads = in->GetStrings("loads");
  if (braking.loads.empty()) in->Fail("loads", "wanted at least one object");
  for (base::ParamReader& motion : in->SubList("motions")) {
    braking.motions.push_back(
        {motion.Get("linear", Between(0.01, 2.0)), motion.Get("angular", Between(-3.0, 3.0))});
  }
  if (braking.motions.empty()) in->Fail("motions", "wanted at least one motion");
  for (const std::string& name : in->GetStrings("ways")) {
    braking.ways.push_back(ReadWay(in, name));
  }
  if (braking.ways.empty()) in->Fail("ways", "wanted at least one way to stop");
  braking.run_up = in->Get("run_up", Between(0.05, 5.0));
  braking.cruise = in->Get("cruise", Between(0.1, 60.0));
  braking.guard =
      navigation::ReadBaseGuardParams(imagination::ResolvePath(in->GetString("guard"), path));
  return braking;
}

robot::BaseControllerParams ControllerFor(robot::BaseControllerParams controller,
                                          const BrakingWay& way) {
  if (way.kind == BrakingWay::Kind::kConstant && way.deceleration > 0.0) {
    controller.limits.max_linear_acceleration = way.deceleration;
    controller.casters.reset();
  }
  if (way.kind == BrakingWay::Kind::kSilence) controller.stops_at_timeout = true;
  if (way.kind == BrakingWay::Kind::kAtOnce) {
    controller.limits.max_linear_acceleration = kAtOnce;
    controller.limits.max_angular_acceleration = kAtOnce;
    controller.loop_frequency = 0.0;
    controller.casters.reset();
  }
  return controller;
}

std::vector<BrakingPlay> BrakingCells(const BrakingConfig& braking, const Stage& stage) {
  const simulation::Scene& scene = *stage.setup.scene;
  const robot::BaseControllerParams& controller = scene.robot.profile.base_controller;
  std::vector<BrakingPlay> plays;
  for (const std::string& load : braking.loads) {
    const auto model = scene.world.RequireModel(stage.setup.ModelOf(load));
    const navigation::StandingLoad standing = navigation::LoadOf(*model);
    const auto limits = navigation::LimitsFor(
        {standing}, {controller, scene.X_BO.translation.z(), scene.world.gravity},
        braking.guard.braking);
    for (const BrakingMotion& motion : braking.motions) {
      for (const BrakingWay& way : braking.ways) {
        BrakingCell cell;
        cell.load = load;
        cell.motion = motion;
        cell.way = way;
        cell.standing = standing;
        cell.limits = limits;
        StateStop(braking, ControllerFor(controller, way), &cell);
        Predict(*model, scene.world.gravity, &cell);
        plays.push_back({std::move(cell), {}, std::nullopt});
      }
    }
  }
  return plays;
}

}  // namespace hires::lab
