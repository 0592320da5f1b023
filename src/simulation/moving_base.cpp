#include "simulation/moving_base.h"

#include <cmath>

#include "simulation/varied.h"

namespace hires::simulation {
namespace {

constexpr double kSlipCorrelation = 0.1;  // [s]

bool IsSamePlace(const BaseMotion& a, const BaseMotion& b) {
  return a.X_MB.x == b.X_MB.x && a.X_MB.y == b.X_MB.y && a.X_MB.yaw == b.X_MB.yaw &&
         a.pitch == b.pitch && a.roll == b.roll;
}

}  // namespace

MovingBase::MovingBase(const robot::RobotProfile& profile, const FloorPlaces& places,
                       const Variation& variation, const geometry::Pose2& start, double time_step,
                       const base::Rng& rng)
    : wheel_slip_(variation.wheel_slip),
      time_step_(time_step),
      limits_(profile.base_controller.limits),
      // Four wheels at the corners of a square within the footprint carry the base.
      wheel_arm_(0.7 * geometry::InscribedRadius(profile.footprint)),
      floor_(variation.floor_roughness, rng.Fork(0)),
      places_(places),
      state_{
          BaseDrive(Varied(profile.base_controller, variation), start), rng.Fork(1), 0.0, {}, {}} {
  state_.X_MB = LeaningPose();
}

double MovingBase::HeightAt(const Eigen::Vector2d& p_M) const {
  return places_.sills.empty() ? floor_.HeightAt(p_M)
                               : floor_.HeightAt(p_M) + places_.HeightAt(p_M);
}

geometry::Pose3 MovingBase::LeaningPose() const {
  const BaseMotion& motion = state_.drive.motion();
  double height = 0.0, pitch = motion.pitch, roll = motion.roll;
  if (!floor_.is_flat() || !places_.sills.empty()) {
    const double arm = wheel_arm_, c = std::cos(motion.X_MB.yaw), s = std::sin(motion.X_MB.yaw);
    double front = 0.0, left = 0.0;
    for (const double x : {arm, -arm}) {
      for (const double y : {arm, -arm}) {
        const double h = HeightAt({motion.X_MB.x + c * x - s * y,  // X_MB * (x, y)
                                   motion.X_MB.y + s * x + c * y});
        height += h / 4.0;
        front += h / 2.0 * (x > 0.0 ? 1.0 : -1.0);
        left += h / 2.0 * (y > 0.0 ? 1.0 : -1.0);
      }
    }
    pitch -= front / (2.0 * arm);
    roll += left / (2.0 * arm);
  }
  return {{motion.X_MB.x, motion.X_MB.y, height},
          geometry::RotationFromRpy(roll, pitch, motion.X_MB.yaw)};
}

void MovingBase::DrawSlip(double dt) {
  if (wheel_slip_ == 0.0) return;
  const double keep = std::exp(-dt / kSlipCorrelation);
  state_.slip = keep * state_.slip +
                wheel_slip_ * std::sqrt(1.0 - keep * keep) * state_.slip_rng.Normal(0.0, 1.0);
}

void MovingBase::Step(double time, double next_time) {
  const BaseMotion before = motion();
  const double traction =
      places_.patches.empty() ? kFullTraction : places_.TractionAt(motion().X_MB.position());
  state_.drive.Step(time, time_step_, state_.slip, traction);
  if (!IsSamePlace(before, motion())) state_.X_MB = LeaningPose();
  state_.disturbances.Note(motion(), limits_, next_time);
}

geometry::Twist3 MovingBase::VelocityAt(const Eigen::Vector3d& p_M) const {
  const geometry::Twist2& V_B = motion().V_B;
  const Eigen::Vector3d w_M(0.0, 0.0, V_B.wz);
  const Eigen::Vector3d v_MB = X_MB().rotation * Eigen::Vector3d(V_B.vx, V_B.vy, 0.0);
  return {v_MB + w_M.cross(p_M - X_MB().translation), w_M};
}

}  // namespace hires::simulation
