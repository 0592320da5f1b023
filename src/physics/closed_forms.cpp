#include "hires/physics/closed_forms.h"

#include <cmath>

#include "hires/base/check.h"

namespace hires::physics {
namespace {

constexpr double kIntegrationStep = 1e-5;  // [s]
constexpr double kLongest = 100.0;  // [s] no pulse that overturns a body on a table lasts as long

/// The body as a rocker on its lower edge A.
struct Rocker {
  double alpha;      ///< between the upright axis and the line from A to the centre of mass [rad]
  double arm;        ///< R, from A to the centre of mass [m]
  double inertia_A;  ///< I_A / m [m^2]
};

Rocker RockerOf(const UprightCylinder& body) {
  const double r = body.radius, h = body.height, c = h / 2;
  Rocker rocker;
  rocker.alpha = std::atan2(r, c);
  rocker.arm = std::hypot(r, c);
  rocker.inertia_A = (3.0 * r * r + h * h) / 12.0 + rocker.arm * rocker.arm;
  return rocker;
}

struct RockingState {
  double tilt{0.0};  // [rad]
  double rate{0.0};  // [rad/s]
};

double TiltAcceleration(const Rocker& rocker, double tilt, double acceleration, double gravity) {
  const double rest = rocker.alpha - tilt;
  return rocker.arm / rocker.inertia_A * (acceleration * std::cos(rest) - gravity * std::sin(rest));
}

RockingState RungeKuttaStep(const Rocker& rocker, const RockingState& from, double acceleration,
                            double gravity) {
  const auto slope = [&](double tilt) {
    return TiltAcceleration(rocker, tilt, acceleration, gravity);
  };
  const double h = kIntegrationStep;
  const double a1 = slope(from.tilt), v1 = from.rate;
  const double a2 = slope(from.tilt + 0.5 * h * v1), v2 = from.rate + 0.5 * h * a1;
  const double a3 = slope(from.tilt + 0.5 * h * v2), v3 = from.rate + 0.5 * h * a2;
  const double a4 = slope(from.tilt + h * v3), v4 = from.rate + h * a3;
  return {from.tilt + h / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4),
          from.rate + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)};
}

/// Energy per mass beyond what it takes to pass over the edge once the ground moves evenly [J/kg].
double SpareEnergy(const Rocker& rocker, const RockingState& state, double gravity) {
  return 0.5 * rocker.inertia_A * state.rate * state.rate -
         gravity * rocker.arm * (1.0 - std::cos(rocker.alpha - state.tilt));
}

}  // namespace

double TippingAcceleration(const UprightCylinder& body, double gravity) {
  return gravity * body.radius / (body.height / 2);
}

double SlidingAcceleration(double friction, double gravity) { return friction * gravity; }

double SuddenStopTopplingSpeed(const UprightCylinder& body, double gravity) {
  const double r = body.radius, h = body.height;
  return SuddenStopTopplingSpeed(r, h / 2, (3.0 * r * r + h * h) / 12.0, gravity);
}

double SuddenStopTopplingSpeed(double support, double com_height, double gyration, double gravity) {
  const double arm = std::hypot(support, com_height);
  return std::sqrt(2.0 * gravity * (arm - com_height) * (gyration + arm * arm)) / com_height;
}

double OverturningPulseDuration(const UprightCylinder& body, double acceleration, double gravity) {
  HIRES_CHECK(acceleration > TippingAcceleration(body, gravity),
              "a pulse below the tipping acceleration overturns nothing, however long");
  const Rocker rocker = RockerOf(body);
  RockingState state;
  double spare = SpareEnergy(rocker, state, gravity);
  for (long step = 0; step * kIntegrationStep < kLongest; ++step) {
    state = RungeKuttaStep(rocker, state, acceleration, gravity);
    const double next = SpareEnergy(rocker, state, gravity);
    if (next >= 0.0) return (step + spare / (spare - next)) * kIntegrationStep;
    spare = next;
  }
  HIRES_CHECK(false, "the acceleration is too close to the tipping acceleration for a number");
  return kLongest;
}

double HousnerPulseDuration(const UprightCylinder& body, double acceleration, double gravity) {
  const Rocker rocker = RockerOf(body);
  const double x = acceleration / (gravity * rocker.alpha);
  HIRES_CHECK(x > 1.0, "a pulse below g alpha overturns nothing, however long");
  const double p = std::sqrt(gravity * rocker.arm / rocker.inertia_A);
  return std::acosh(1.0 + 1.0 / (2.0 * x * (x - 1.0))) / p;
}

}  // namespace hires::physics
