#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hires/base/error.h"
#include "hires/geometry/angles.h"
#include "hires/navigation/braking.h"

// What a load survives.
namespace hires::navigation {
namespace {

/// What a load bears if everything about it is as bad as the margins allow.
double WorstAcceleration(const StandingLoad& load, double gravity, const BrakingMargins& margins) {
  StandingLoad worst = load;
  worst.support = std::max(0.0, load.support * margins.support_share - margins.com_offset);
  worst.com_height = load.com_height * margins.com_height_share;
  worst.friction = load.friction * margins.friction_share;
  return std::min(TippingAcceleration(worst, gravity), SlidingAcceleration(worst, gravity));
}

/// Seconds in which the deceleration rises: so many periods of the sway that it hardly swings.
double RiseTime(const robot::BaseControllerParams& controller, const BrakingMargins& margins) {
  return controller.sway_frequency > 0.0
             ? margins.rise_periods * 2.0 * geometry::kPi / controller.sway_frequency
             : 0.0;
}

/// What the load feels of 1 m/s^2 that the ramp asks for: wheels that overshoot, a body that leans
/// forward, and the swing of a load that stands high on it.
double Amplification(const StandingLoad& load, const CarryingBase& base,
                     const BrakingMargins& margins) {
  const robot::BaseControllerParams& controller = base.controller;
  const double rise = RiseTime(controller, margins);
  double wheels = 1.0;
  if (controller.loop_frequency > 0.0) {
    wheels += OvershootShare(controller.loop_frequency,
                             controller.loop_damping * margins.damping_share, rise);
  }
  const double lean = controller.sway_compliance * margins.sway_share;
  if (lean == 0.0) return wheels;
  const double sway =
      1.0 + OvershootShare(controller.sway_frequency, controller.sway_damping, rise);
  const double height = base.tray_height + load.com_height;
  const double swing = lean * height * controller.sway_frequency / rise;
  return wheels * (1.0 + base.gravity * lean * sway + swing);
}

BrakingMargins ReadMargins(base::ParamReader in) {
  using base::Between;
  BrakingMargins margins;
  margins.support_share = in.Get("support_share", Between(0.1, 1.0));
  margins.com_height_share = in.Get("com_height_share", Between(1.0, 3.0));
  margins.com_offset = in.Get("com_offset", Between(0.0, 0.1));
  margins.friction_share = in.Get("friction_share", Between(0.01, 1.0));
  margins.sway_share = in.Get("sway_share", Between(1.0, 10.0));
  margins.damping_share = in.Get("damping_share", Between(0.0, 1.0));
  margins.rise_periods = in.Get("rise_periods", Between(0.1, 10.0));
  margins.used_share = in.Get("used_share", Between(0.1, 1.0));
  return margins;
}

BrakingLimits ReadLimits(base::ParamReader in) {
  BrakingLimits limits;
  limits.max_deceleration = in.Get("max_deceleration", base::Between(0.05, 10.0));
  limits.max_jerk = in.Get("max_jerk", base::Between(0.1, 1000.0));
  return limits;
}

}  // namespace

double TippingAcceleration(const StandingLoad& load, double gravity) {
  return load.com_height > 0.0 ? gravity * load.support / load.com_height
                               : std::numeric_limits<double>::infinity();
}

double SlidingAcceleration(const StandingLoad& load, double gravity) {
  return load.friction * gravity;
}

BrakingLimits LimitsFor(const std::vector<StandingLoad>& loads, const CarryingBase& base,
                        const BrakingParams& params) {
  const BrakingMargins& margins = params.margins;
  const double rise = RiseTime(base.controller, margins);
  BrakingLimits limits = params.hardest;
  for (const StandingLoad& load : loads) {
    const double bears = margins.used_share * WorstAcceleration(load, base.gravity, margins);
    if (bears <= 0.0) {
      throw base::ConfigError(fmt::format(
          "load '{}': with the margins of the braking it stands on nothing ({:.1f} mm from below "
          "its centre of mass to the edge of its base), wanted something that can be driven; take "
          "it off the tray or change braking/margins",
          load.name, 1000.0 * load.support));
    }
    limits.max_deceleration =
        std::min(limits.max_deceleration, bears / Amplification(load, base, margins));
  }
  if (!loads.empty() && rise > 0.0) {
    limits.max_jerk = std::min(limits.max_jerk, limits.max_deceleration / rise);
  }
  return limits;
}

BrakingParams ReadBrakingParams(base::ParamReader in) {
  BrakingParams params;
  params.unknown_load = ReadLimits(in.Sub("unknown_load"));
  params.hardest = ReadLimits(in.Sub("hardest"));
  params.max_angular_deceleration = in.Get("max_angular_deceleration", base::Between(0.05, 20.0));
  params.max_angular_jerk = in.Get("max_angular_jerk", base::Between(0.1, 1000.0));
  params.load_reach = in.Get("load_reach", base::Between(0.0, 5.0));
  params.margins = ReadMargins(in.Sub("margins"));
  if (params.unknown_load.max_deceleration > params.hardest.max_deceleration) {
    in.Fail("unknown_load", "wanted a max_deceleration of at most that of `hardest`");
  }
  return params;
}

}  // namespace hires::navigation
