#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "hires/base/error.h"
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

using Eigen::Vector2d;

/// One payload on the tray of a base that follows exactly.
class CarriedLoad {
 public:
  CarriedLoad(PayloadSupport payload, const imagination::ImaginationSetup& setup)
      : controller_(setup.scene->robot.profile.base_controller),
        gravity_(setup.scene->world.gravity),
        max_slide_(setup.standing.slide),
        payload_(std::move(payload)),
        travel_(TravelDirections()) {}

  /// The controller's time-out stops the base.
  MotionBounds Speed() const {
    MotionBounds bounds{"speed", "m/s", controller_.limits.max_linear_velocity, kInfinity, {}};
    if (controller_.stops_at_timeout) {
      const Vector2d worst = Worst(travel_, [&](const Vector2d& d) { return SuddenStopSpeed(d); });
      bounds.closed_form = SuddenStopSpeed(worst);
      bounds.stated = HowItBearsASuddenStop(worst);
    } else {
      bounds.stated = OwnStop() < Bears(WeakestTravel())
                          ? "the load stands through the controller's own stop"
                          : "no closed form for a stop by a ramp";
    }
    return bounds;
  }

  MotionBounds AlongALine(const std::string& motion) const {
    const Vector2d weakest = WeakestTravel();
    return {motion, "m/s^2", controller_.limits.max_linear_acceleration, Bears(weakest),
            HowItGives(weakest)};
  }

  /// The centrifugal force points away from the center of rotation; a stop of the turn acts along
  /// the tangent. A base that steers has two smallest circles, the weaker one counts.
  MotionBounds Turning() const {
    const double radius = IsCar() ? controller_.min_turning_radius : 0.0;
    MotionBounds weaker = TurningAbout({0.0, radius});
    if (!IsCar()) return weaker;
    MotionBounds right = TurningAbout({0.0, -radius});
    return right.closed_form < weaker.closed_form ? right : weaker;
  }

 private:
  bool IsCar() const { return controller_.drive == robot::Drive::kCarLike; }

  /// Unit vectors. Of a base that drives to all sides: across each edge of the support polygon,
  /// where the distance to the edge is least.
  std::vector<Vector2d> TravelDirections() const {
    if (controller_.drive == robot::Drive::kOmnidirectional) return payload_.Normals();
    return {Vector2d::UnitX(), -Vector2d::UnitX()};
  }

  template <typename Value>
  static Vector2d Worst(const std::vector<Vector2d>& directions, Value value) {
    return *std::min_element(
        directions.begin(), directions.end(),
        [&](const Vector2d& a, const Vector2d& b) { return value(a) < value(b); });
  }
  Vector2d WeakestTravel() const {
    return Worst(travel_, [&](const Vector2d& d) { return Tips(d); });
  }

  MotionBounds TurningAbout(const Vector2d& p_BCenter) const {
    const Vector2d from_center = payload_.p_BCom - p_BCenter;
    const double arm = from_center.norm();
    MotionBounds bounds{"turning", "rad/s", OwnTurning(), kInfinity, {}};
    if (arm < kLeastShownArm) {
      bounds.stated = "on the rotation axis: turning does not push it";
      return bounds;
    }
    const Vector2d outward = from_center / arm, tangent(-outward.y(), outward.x());
    const double on_arc = std::sqrt(Bears(outward) / arm);
    const Vector2d stop =
        Worst({tangent, -tangent}, [&](const Vector2d& d) { return SuddenStopSpeed(d); });
    const double stopped = controller_.stops_at_timeout ? SuddenStopSpeed(stop) / arm : kInfinity;
    const std::string on_arc_how = HowItGives(outward) + " outward on the arc";
    const std::string stopped_how = HowItBearsASuddenStop(stop);
    bounds.closed_form = std::min(on_arc, stopped);
    bounds.stated =
        fmt::format("{}, {:.2f} m from {}", stopped < on_arc ? stopped_how : on_arc_how, arm,
                    IsCar() ? "the middle of the smallest circle" : "the base's centre");
    if (std::isfinite(stopped) && !payload_.rolls) {
      bounds.stated += stopped < on_arc
                           ? fmt::format("; {} from {:.3f} rad/s", on_arc_how, on_arc)
                           : fmt::format("; {} from {:.3f} rad/s", stopped_how, stopped);
    }
    return bounds;
  }

  /// [rad/s] A car turns as fast as it drives round its smallest circle.
  double OwnTurning() const {
    const robot::MotionSet& limits = controller_.limits;
    return IsCar() ? std::min(limits.max_angular_velocity,
                              limits.max_linear_velocity / controller_.min_turning_radius)
                   : limits.max_angular_velocity;
  }

  double Tips(const Vector2d& direction) const {
    return payload_.TippingAcceleration(direction, gravity_);
  }
  double Slides() const { return payload_.SlidingAcceleration(gravity_); }
  double Bears(const Vector2d& direction) const {
    return payload_.rolls ? 0.0 : std::min(Tips(direction), Slides());
  }
  std::string HowItGives(const Vector2d& direction) const {
    return payload_.rolls ? "rolls" : Tips(direction) < Slides() ? "tips" : "slides";
  }

  /// [m/s^2] The hardest: each axis has a ramp of its own.
  double OwnStop() const {
    const bool has_two_axes = controller_.drive == robot::Drive::kOmnidirectional;
    return (has_two_axes ? std::sqrt(2.0) : 1.0) * controller_.limits.max_linear_acceleration;
  }

  /// When wheels lock: topples, or where it slides before that, goes v^2 / (2 mu g) far.
  double SuddenStopSpeed(const Vector2d& direction) const {
    if (payload_.rolls) return 0.0;
    return Slides() < Tips(direction) ? std::sqrt(2.0 * max_slide_ * Slides())
                                      : payload_.TopplingSpeed(direction, gravity_);
  }
  std::string HowItBearsASuddenStop(const Vector2d& direction) const {
    if (payload_.rolls) return "rolls";
    const std::string how = Slides() < Tips(direction)
                                ? fmt::format("slides {:g} m where wheels lock", max_slide_)
                                : "topples where wheels lock";
    if (!controller_.casters) return how;
    return fmt::format(
        "{}; its motors stop it with {:.1f} m/s^2 at most", how,
        robot::HardestStop(*controller_.casters, controller_.limits.max_linear_velocity));
  }

  const robot::BaseControllerParams& controller_;
  const double gravity_;    // [m/s^2]
  const double max_slide_;  // [m]
  const PayloadSupport payload_;
  const std::vector<Vector2d> travel_;
};

}  // namespace

ClosedForms ClosedFormLimits(const std::vector<std::string>& objects,
                             const imagination::ImaginationSetup& setup) {
  RefuseIdleController(setup.scene->robot);
  ClosedForms forms;
  forms.payloads = SupportsOnTray(setup, objects);
  for (const PayloadSupport& payload : forms.payloads) {
    const CarriedLoad load(payload, setup);
    forms.of_each.push_back({load.Speed(), load.AlongALine("acceleration"),
                             load.AlongALine("deceleration"), load.Turning()});
  }
  forms.weakest = forms.of_each.front();
  for (std::size_t motion = 0; motion < forms.weakest.size(); ++motion) {
    std::string name = forms.payloads.front().name;
    for (std::size_t i = 1; i < forms.of_each.size(); ++i) {
      const MotionBounds& bounds = forms.of_each[i][motion];
      if (!(bounds.closed_form < forms.weakest[motion].closed_form)) continue;
      forms.weakest[motion] = bounds;
      name = forms.payloads[i].name;
    }
    if (forms.of_each.size() > 1) {
      forms.weakest[motion].stated = name + ": " + forms.weakest[motion].stated;
    }
  }
  return forms;
}

}  // namespace hires::reports
