#include "hires/robot/caster_params.h"

namespace hires::robot {
namespace {

constexpr int kNumWheels = 8;

}  // namespace

double WheelGain(const CasterParams& params) { return params.version == 1 ? 3.0 : 5.0; }

double RollingMass(const CasterParams& params) {
  const double r = params.wheel_radius;
  return params.mass + kNumWheels * params.wheel_inertia / (r * r);
}

double RollingLag(const CasterParams& params) {
  const double r = params.wheel_radius;
  return RollingMass(params) * r * r / (kNumWheels * (WheelGain(params) + params.wheel_damping));
}

double RollingShare(const CasterParams& params) {
  return WheelGain(params) / (WheelGain(params) + params.wheel_damping);
}

double HardestStop(const CasterParams& params, double speed) {
  const double r = params.wheel_radius;
  const double effort = params.wheel_effort + params.wheel_damping * speed / r;
  return kNumWheels * effort / r / RollingMass(params);
}

}  // namespace hires::robot
