#include "hires/simulation/caster_drive.h"

#include <algorithm>
#include <cmath>

namespace hires::simulation {
namespace {

using geometry::Twist2;

// Published gains: pr2_controller_configuration, pr2_base_controller.yaml and
// pr2_base_controller2.yaml.
constexpr double kSteeringPosition1 = 80.0;                   // [1/s] wanted speed for each rad
constexpr double kSteeringSpeed1 = 8.0;                       // [N m s]
constexpr double kSteeringPosition2 = 100.0;                  // [N m] for each rad
constexpr double kFrontDamping2 = 8.0, kBackDamping2 = 12.0;  // [N m s]
constexpr double kWheelPosition2 = 100.0;                     // [N m] for each rad of rolling
constexpr double kFilter2 = 0.5;        // y = a y + (1 - a) x, 1000 times a second
constexpr double kLeastCommand = 1e-5;  // [m/s], [rad/s] what is less stands

constexpr double kVelocityGain = 10.0;  // [N m s] of the joints' safety controller
constexpr double kPeriod = 0.001;       // [s] of the published loop
constexpr double kGravity = 9.81;       // [m/s^2]
/// [m/s] sideways, from which on a tyre's friction is that of sliding; below, it is proportional.
constexpr double kCreep = 0.01;

constexpr double kRestSpeed = 1e-6;  // [m/s], [rad/s]
constexpr double kRestRate = 1e-4;   // [rad/s] of steering
constexpr double kRestError = 1e-4;  // [rad]

bool IsCommanded(const Twist2& v) {
  return v.vx * v.vx + v.vy * v.vy >= kLeastCommand * kLeastCommand ||
         std::abs(v.wz) >= kLeastCommand;
}

/// atan2(y, x) for x >= 0; a series where that is as good.
double AngleOf(double y, double x) {
  if (std::abs(y) >= 0.03 * x) return std::atan2(y, x);
  const double t = y / x;
  return t * (1.0 - t * t / 3.0);
}

}  // namespace

CasterDrive::CasterDrive(const robot::CasterParams& params) : params_(params) {
  const double arm = 0.5 * params.track;
  wheel_gain_ = robot::WheelGain(params);
  per_radius_ = 1.0 / params.wheel_radius;
  wheel_mass_ = 2.0 * params.wheel_inertia * per_radius_ * per_radius_;
  steering_mass_ = params.steering_inertia + wheel_mass_ * arm * arm;
  for (int i = 0; i < kNumCasters; ++i) {
    casters_[i].x = i < 2 ? params.at : -params.at;
    casters_[i].y = i % 2 == 0 ? params.at : -params.at;
    casters_[i].steering_damping = i < 2 ? kFrontDamping2 : kBackDamping2;
  }
}

std::array<double, CasterDrive::kNumCasters> CasterDrive::Angles() const {
  std::array<double, kNumCasters> angles{};
  for (int i = 0; i < kNumCasters; ++i) angles[i] = std::atan2(casters_[i].sin, casters_[i].cos);
  return angles;
}

void CasterDrive::Step(const Twist2& commanded, double traction, double dt, Twist2* V_B) {
  if (IsAtRest(commanded, *V_B)) return;
  const double hold = params_.mass / kNumCasters * std::min(params_.grip * kGravity, traction);
  const int num_cycles = std::max(1, static_cast<int>(std::ceil(dt / kPeriod - 1e-6)));
  for (int i = 0; i < num_cycles; ++i) StepOnce(commanded, hold, dt / num_cycles, V_B);
  if (!IsCommanded(commanded)) ComeToRest(V_B);
}

/// The tyres' hold is that at the end of the step, as far as it grows with the creep: this keeps
/// the step stable however hard they hold.
void CasterDrive::StepOnce(const Twist2& commanded, double hold, double dt, Twist2* V_B) {
  Balance balance;
  balance.xx = balance.yy = params_.mass;
  balance.ww = params_.yaw_inertia;
  balance.force_x = params_.mass * V_B->wz * V_B->vy;  // the base frame turns
  balance.force_y = -params_.mass * V_B->wz * V_B->vx;
  for (Caster& caster : casters_) {
    Aim(commanded, &caster);
    const double steering = SteeringEffort(&caster) - params_.steering_damping * caster.rate;
    const Rolling rolling = Roll(commanded, *V_B, &caster);
    AddTo(&balance, caster, *V_B, rolling.force, hold, dt);
    balance.moment -= steering;  // what turns the caster stands on the base
    caster.rate += dt * (steering + rolling.moment) / steering_mass_;
    const double turn = dt * caster.rate;
    if (turn == 0.0) continue;
    const double c = caster.cos - turn * caster.sin, s = caster.sin + turn * caster.cos;
    const double scale = 1.5 - 0.5 * (c * c + s * s);  // 1 / length, as good as it is near 1
    caster.cos = scale * c;
    caster.sin = scale * s;
  }
  const Twist2 change = balance.Solve(dt);
  V_B->vx += change.vx;
  V_B->vy += change.vy;
  V_B->wz += change.wz;
}

/// To where the commanded twist sends the caster's axis; without a command it stays as it was.
void CasterDrive::Aim(const Twist2& commanded, Caster* caster) const {
  if (IsCommanded(commanded)) {
    caster->wanted_x = commanded.vx - caster->y * commanded.wz;
    caster->wanted_y = commanded.vy + caster->x * commanded.wz;
    if (caster->wanted_x == 0.0 && caster->wanted_y == 0.0) caster->wanted_x = 1.0;
  }
  const double across = caster->cos * caster->wanted_y - caster->sin * caster->wanted_x;
  const double along = caster->cos * caster->wanted_x + caster->sin * caster->wanted_y;
  caster->error = along < 0.0 ? AngleOf(-across, -along) : AngleOf(across, along);
}

double CasterDrive::SteeringEffort(Caster* caster) const {
  double effort = 0.0;
  if (params_.version == 1) {
    effort = kSteeringSpeed1 * (kSteeringPosition1 * caster->error - caster->rate);
  } else {
    caster->filtered_rate = kFilter2 * caster->filtered_rate + (1.0 - kFilter2) * caster->rate;
    effort = kSteeringPosition2 * caster->error - caster->steering_damping * caster->filtered_rate;
  }
  const double most = params_.steering_effort;
  const double upper =
      std::clamp(kVelocityGain * (params_.steering_speed - caster->rate), -most, most);
  const double lower =
      std::clamp(-kVelocityGain * (params_.steering_speed + caster->rate), -most, most);
  return std::clamp(effort, lower, upper);
}

CasterDrive::Rolling CasterDrive::Roll(const Twist2& commanded, const Twist2& V_B,
                                       Caster* caster) const {
  const auto along = [caster](const Twist2& V) {
    return caster->cos * (V.vx - caster->y * V.wz) + caster->sin * (V.vy + caster->x * V.wz);
  };
  const double wanted = along(commanded), actual = along(V_B);
  const double turning = V_B.wz + caster->rate;
  Rolling rolling;
  for (int side = 0; side < 2; ++side) {
    const double y = side == 0 ? 0.5 * params_.track : -0.5 * params_.track;
    const double speed = (actual - y * turning) * per_radius_;
    const double wanted_speed = (wanted - y * commanded.wz) * per_radius_;
    const double still_to_roll = -y * caster->error * per_radius_;  // [rad] until it points there
    double effort = 0.0;
    if (params_.version == 1) {
      effort = wheel_gain_ * (wanted_speed + kSteeringPosition1 * still_to_roll - speed);
    } else {
      double& filtered = caster->filtered_speeds[side];
      filtered = kFilter2 * filtered + (1.0 - kFilter2) * speed;
      effort = wheel_gain_ * (wanted_speed - filtered) + kWheelPosition2 * still_to_roll;
    }
    const double force = (std::clamp(effort, -params_.wheel_effort, params_.wheel_effort) -
                          params_.wheel_damping * speed) *
                         per_radius_;
    rolling.force += force;
    rolling.moment -= y * force;
  }
  return rolling;
}

void CasterDrive::AddTo(Balance* balance, const Caster& caster, const Twist2& V_B, double force,
                        double hold, double dt) const {
  const double c = caster.cos, s = caster.sin;
  const double arm_along = caster.x * s - caster.y * c;   // [m] of forces along the caster
  const double arm_across = caster.x * c + caster.y * s;  // ... and across it
  const double creep = -s * V_B.vx + c * V_B.vy + arm_across * V_B.wz;
  const double across = -hold * std::clamp(creep / kCreep, -1.0, 1.0);
  const double m = wheel_mass_, k = std::abs(creep) < kCreep ? dt * hold / kCreep : 0.0;
  balance->xx += m * c * c + k * s * s;
  balance->xy += (m - k) * c * s;
  balance->xw += m * c * arm_along - k * s * arm_across;
  balance->yy += m * s * s + k * c * c;
  balance->yw += m * s * arm_along + k * c * arm_across;
  balance->ww += m * arm_along * arm_along + k * arm_across * arm_across;
  balance->force_x += force * c - across * s;
  balance->force_y += force * s + across * c;
  balance->moment += force * arm_along + across * arm_across;
}

/// By Cramer's rule.
Twist2 CasterDrive::Balance::Solve(double dt) const {
  const double a = yy * ww - yw * yw, b = xw * yw - xy * ww, c = xy * yw - xw * yy;
  const double d = xx * ww - xw * xw, e = xy * xw - xx * yw, f = xx * yy - xy * xy;
  const double scale = dt / (xx * a + xy * b + xw * c);
  return {scale * (a * force_x + b * force_y + c * moment),
          scale * (b * force_x + d * force_y + e * moment),
          scale * (c * force_x + e * force_y + f * moment)};
}

bool CasterDrive::IsAtRest(const Twist2& commanded, const Twist2& V_B) const {
  if (IsCommanded(commanded) || V_B.vx != 0.0 || V_B.vy != 0.0 || V_B.wz != 0.0) return false;
  return std::all_of(casters_.begin(), casters_.end(),
                     [](const Caster& caster) { return caster.rate == 0.0; });
}

/// What comes ever nearer to a stand has come to it.
void CasterDrive::ComeToRest(Twist2* V_B) {
  for (const double speed : {V_B->vx, V_B->vy, V_B->wz}) {
    if (std::abs(speed) > kRestSpeed) return;
  }
  for (const Caster& caster : casters_) {
    if (std::abs(caster.rate) > kRestRate || std::abs(caster.error) > kRestError) return;
  }
  *V_B = {};
  for (Caster& caster : casters_) {
    caster.rate = caster.filtered_rate = 0.0;
    caster.filtered_speeds = {};
  }
}

}  // namespace hires::simulation
