#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "hires/base/error.h"
#include "hires/geometry/shape.h"
#include "hires/imagination/start_state.h"
#include "hires/navigation/standing_load.h"
#include "hires/physics/closed_forms.h"
#include "reports/limits/motion_limits.h"

namespace hires::reports {
namespace {

constexpr double kLeastLimit = 0.01;  // of a controller that moves a base
constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr double kLeastShownArm = 0.005;  // [m] two decimals show less as 0.00

void RefuseIdleController(const robot::Robot& robot) {
  const robot::MotionSet& own = robot.profile.base_controller.limits;
  for (const auto& [key, value] :
       {std::pair("max_linear_velocity", own.max_linear_velocity),
        std::pair("max_angular_velocity", own.max_angular_velocity),
        std::pair("max_linear_acceleration", own.max_linear_acceleration),
        std::pair("max_angular_acceleration", own.max_angular_acceleration)}) {
    if (value >= kLeastLimit) continue;
    throw base::ConfigError(
        fmt::format("robot '{}': base_controller.limits.{} is {:g}, wanted at least {:g} for a "
                    "base whose limits are looked for; change its profile",
                    robot.model.name, key, value, kLeastLimit));
  }
}

/// Whether it stands on one round shape alone, a ball or a can that lies: no acceleration is so
/// small that it stays.
bool Rolls(const world::ObjectModel& model) {
  constexpr double kTouches = 0.001, kLies = 0.1;  // [m], of the axis' height
  std::vector<const geometry::Collision*> lowest;
  double height = kInfinity;
  for (const geometry::Collision& shape : model.collisions) {
    const double bottom = geometry::BoundsOf(shape.shape, shape.X_BS).lower.z();
    if (bottom < height - kTouches) lowest.clear();
    if (bottom <= height + kTouches) lowest.push_back(&shape);
    height = std::min(height, bottom);
  }
  if (lowest.size() != 1) return false;
  const geometry::Collision& round = *lowest.front();
  const Eigen::Vector3d axis = round.X_BS.rotation * Eigen::Vector3d::UnitZ();
  return std::holds_alternative<geometry::Sphere>(round.shape) ||
         (std::holds_alternative<geometry::Cylinder>(round.shape) && std::abs(axis.z()) < kLies);
}

/// What stands on the tray of a base that follows exactly.
class CarriedLoad {
 public:
  CarriedLoad(const std::string& object, const imagination::ImaginationSetup& setup)
      : controller_(setup.scene->robot.profile.base_controller),
        turning_arm_(TurningArm(setup.scene->X_BO.translation.head<2>(), controller_)),
        gravity_(setup.scene->world.gravity),
        body_(setup.scene->world.RequireModel(setup.ModelOf(object))->mass_properties),
        load_(navigation::LoadOf(*setup.scene->world.RequireModel(setup.ModelOf(object)))),
        rolls_(Rolls(*setup.scene->world.RequireModel(setup.ModelOf(object)))) {}

  /// The controller's time-out stops the base.
  MotionBounds Speed() const {
    MotionBounds bounds{"speed", "m/s", controller_.limits.max_linear_velocity, kInfinity, {}};
    if (controller_.stops_at_timeout) {
      bounds.closed_form = SuddenStopSpeed();
      bounds.stated = HowItBearsASuddenStop();
    } else {
      bounds.stated = OwnStop() < Bears() ? "the load stands through the controller's own stop"
                                          : "no closed form for a stop by a ramp";
    }
    return bounds;
  }

  MotionBounds AlongALine(const std::string& motion) const {
    return {motion, "m/s^2", controller_.limits.max_linear_acceleration, Bears(), HowItGives()};
  }

  MotionBounds Turning() const {
    const double arm = turning_arm_;
    const double on_arc = arm > 0.0 ? std::sqrt(Bears() / arm) : kInfinity;
    const double stopped =
        controller_.stops_at_timeout && arm > 0.0 ? SuddenStopSpeed() / arm : kInfinity;
    return {"turning", "rad/s", OwnTurning(), std::min(on_arc, stopped),
            arm < kLeastShownArm
                ? "stands over what the base turns about, so turning does not push it"
                : fmt::format("{}, {:.2f} m from {}",
                              stopped < on_arc ? HowItBearsASuddenStop() : HowItGives(), arm,
                              IsCar(controller_) ? "the middle of the smallest circle"
                                                 : "the base's centre")};
  }

 private:
  static bool IsCar(const robot::BaseControllerParams& controller) {
    return controller.drive == robot::Drive::kCarLike;
  }
  /// [m] From what the load turns about: a base that turns on the spot, or the middle of the circle
  /// that a car drives, on the side from which the load is farther.
  static double TurningArm(const Eigen::Vector2d& p_BO,
                           const robot::BaseControllerParams& controller) {
    return IsCar(controller)
               ? std::hypot(p_BO.x(), controller.min_turning_radius + std::abs(p_BO.y()))
               : p_BO.norm();
  }
  /// [rad/s] A car turns as fast as it drives round its smallest circle.
  double OwnTurning() const {
    const robot::MotionSet& limits = controller_.limits;
    return IsCar(controller_)
               ? std::min(limits.max_angular_velocity,
                          limits.max_linear_velocity / controller_.min_turning_radius)
               : limits.max_angular_velocity;
  }

  double Tips() const { return navigation::TippingAcceleration(load_, gravity_); }
  double Slides() const { return navigation::SlidingAcceleration(load_, gravity_); }
  double Bears() const { return rolls_ ? 0.0 : std::min(Tips(), Slides()); }
  std::string HowItGives() const {
    return rolls_ ? "rolls" : Tips() < Slides() ? "tips" : "slides";
  }

  /// [m/s^2] The hardest: each axis has a ramp of its own.
  double OwnStop() const {
    const bool has_two_axes = controller_.drive == robot::Drive::kOmnidirectional;
    return (has_two_axes ? std::sqrt(2.0) : 1.0) * controller_.limits.max_linear_acceleration;
  }

  /// Of what it stands on when wheels lock; infinite where it slides before it topples.
  double SuddenStopSpeed() const {
    if (rolls_) return 0.0;
    if (Slides() < Tips()) return kInfinity;
    const double gyration = std::min(body_.I_BBcm(0, 0), body_.I_BBcm(1, 1)) / body_.mass;
    return physics::SuddenStopTopplingSpeed(load_.support, load_.com_height, gyration, gravity_);
  }
  std::string HowItBearsASuddenStop() const {
    if (rolls_) return "rolls";
    const std::string how =
        Slides() < Tips() ? "slides where wheels lock" : "topples where wheels lock";
    if (!controller_.casters) return how;
    return fmt::format(
        "{}; its motors stop it with {:.1f} m/s^2 at most", how,
        robot::HardestStop(*controller_.casters, controller_.limits.max_linear_velocity));
  }

  const robot::BaseControllerParams& controller_;
  const double turning_arm_;  // [m]
  const double gravity_;      // [m/s^2]
  const geometry::MassProperties body_;
  const navigation::StandingLoad load_;
  const bool rolls_;
};

}  // namespace

std::vector<MotionBounds> ClosedFormLimits(const std::string& object,
                                           const imagination::ImaginationSetup& setup) {
  RefuseIdleController(setup.scene->robot);
  imagination::StartOnTray(setup, {}, {object});  // refuses what cannot be carried
  const CarriedLoad load(object, setup);
  return {load.Speed(), load.AlongALine("acceleration"), load.AlongALine("deceleration"),
          load.Turning()};
}

}  // namespace hires::reports
