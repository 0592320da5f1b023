#include "hires/localisation/odometry_filter.h"

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/robot/odometry_jump.h"

namespace hires::localisation {
namespace {

using geometry::Pose2;
using geometry::WrapToPi;

constexpr std::size_t kMostWaiting = 1000;  // 10 s at 100 Hz
constexpr double kSuddenTurn = 0.3;         // [rad] the wheels do not turn so far unseen
constexpr double kDeviations = 6.0;         // ... nor does the unit err so much

bool IsFinite(const geometry::Twist2& V) {
  return std::isfinite(V.vx) && std::isfinite(V.vy) && std::isfinite(V.wz);
}

/// A share of a motion along the arc on which it was steady.
Pose2 ShareOf(const Pose2& X_AB, double share) {
  const double half = 0.5 * X_AB.yaw;
  const double chord = std::hypot(X_AB.x, X_AB.y);
  const double bearing = std::atan2(X_AB.y, X_AB.x) - half;  // of the tangent at the start
  const double sinc = std::abs(half) > 1e-9 ? std::sin(half) / half : 1.0;
  const double part = share * half;
  const double part_sinc = std::abs(part) > 1e-9 ? std::sin(part) / part : 1.0;
  const double length = chord / sinc * share * part_sinc;
  return {length * std::cos(bearing + part), length * std::sin(bearing + part), share * X_AB.yaw};
}

}  // namespace

OdometryFilterConfig ReadOdometryFilterConfig(base::ParamReader in) {
  using base::Between;
  OdometryFilterConfig config;
  OdometryFilterParams& params = config.filter;
  params.position_per_metre = in.Get("position_per_metre", Between(0.0, 1.0));
  params.position_per_radian = in.Get("position_per_radian", Between(0.0, 1.0));
  params.yaw_per_metre = in.Get("yaw_per_metre", Between(0.0, 1.0));
  params.yaw_per_radian = in.Get("yaw_per_radian", Between(0.0, 1.0));
  params.imu_yaw_sd = in.Get("imu_yaw_sd", Between(1e-6, 1.0));
  params.imu_drift = in.Get("imu_drift", Between(0.0, 1.0));
  params.imu_timeout = in.Get("imu_timeout", Between(0.01, 60.0));
  params.odometry_timeout = in.Get("odometry_timeout", Between(0.01, 60.0));
  params.max_linear_speed = in.Get("max_linear_speed", Between(0.01, 100.0));
  params.max_angular_speed = in.Get("max_angular_speed", Between(0.01, 100.0));
  params.jump_position_sd = in.Get("jump_position_sd", Between(0.0, 100.0));
  params.jump_yaw_sd = in.Get("jump_yaw_sd", Between(0.0, 10.0));
  base::ParamReader node = in.Sub("node");
  config.node.tf_broadcast = node.GetBool("tf_broadcast");
  config.node.imu_used = node.GetBool("imu_used");
  config.node.imu_wait = node.Get("imu_wait", Between(0.0, 10.0));
  in.RejectUnknownKeys();
  return config;
}

std::string ToString(FilterOutcome outcome) {
  switch (outcome) {
    case FilterOutcome::kTaken:
      return "taken";
    case FilterOutcome::kAfterGap:
      return "after a gap";
    case FilterOutcome::kNotFinite:
      return "not finite";
    case FilterOutcome::kLate:
      return "late";
    case FilterOutcome::kTimeWentBack:
      return "time went back";
    case FilterOutcome::kJumped:
      return "jumped";
    case FilterOutcome::kTooMany:
      return "too many";
  }
  return "unknown";
}

OdometryFilter::OdometryFilter(const OdometryFilterParams& params) : params_(params) {}

void OdometryFilter::Begin(double time, const Pose2& X_OB) {
  state_.head<3>() << X_OB.x, X_OB.y, WrapToPi(X_OB.yaw);
  DropWaitingBefore(time);
  GoOnFrom(time, X_OB);
  if (waiting_.empty() || waiting_.front().time > time) return;
  UseHeading(waiting_.front());
  waiting_.pop_front();
}

void OdometryFilter::DropWaitingBefore(double time) {
  while (!waiting_.empty() && waiting_.front().time < time) waiting_.pop_front();
}

void OdometryFilter::AddUnseenMotion() {
  const double position = params_.jump_position_sd * params_.jump_position_sd;
  P_.diagonal() +=
      Eigen::Vector4d(position, position, params_.jump_yaw_sd * params_.jump_yaw_sd, 0);
}

void OdometryFilter::GoOnFrom(double time, const Pose2& X_OB) {
  odometry_ = Odometry{time, X_OB};
  time_ = time;
}

FilterOutcome OdometryFilter::OnOdometry(double time, const robot::OdometryReading& reading) {
  const Pose2& X_OB = reading.X_OB;
  if (!std::isfinite(time) || !X_OB.IsFinite() || !IsFinite(reading.V_B)) {
    return FilterOutcome::kNotFinite;
  }
  if (!odometry_) {
    V_B_ = reading.V_B;
    Begin(time, X_OB);
    return FilterOutcome::kTaken;
  }
  const double duration = time - time_;
  if (duration < 0.0 && duration > -robot::kClockReset) return FilterOutcome::kLate;
  V_B_ = reading.V_B;
  Pose2 moved = odometry_->X_OB.Inverse() * X_OB;
  moved.yaw = WrapToPi(moved.yaw);
  if (duration < 0.0) {
    waiting_.clear();
    inertia_time_.reset();  // its zero is found again
    AddUnseenMotion();
    GoOnFrom(time, X_OB);
    return FilterOutcome::kTimeWentBack;
  }
  if (robot::IsOdometryJump(moved, duration, params_.max_linear_speed, params_.max_angular_speed)) {
    AddUnseenMotion();
    P_(3, 3) += params_.imu_drift * duration;
    DropWaitingBefore(time);
    GoOnFrom(time, X_OB);
    return FilterOutcome::kJumped;
  }
  double done = 0.0;  // share of the motion
  while (!waiting_.empty() && waiting_.front().time <= time) {
    const Inertia inertia = waiting_.front();
    waiting_.pop_front();
    const double share = duration > 0.0 ? (inertia.time - (time - duration)) / duration : 1.0;
    Drive(ShareOf(moved, done).Inverse() * ShareOf(moved, share), inertia.time);
    done = share;
    UseHeading(inertia);
  }
  Drive(ShareOf(moved, done).Inverse() * moved, time);
  GoOnFrom(time, X_OB);
  return duration > params_.odometry_timeout ? FilterOutcome::kAfterGap : FilterOutcome::kTaken;
}

FilterOutcome OdometryFilter::OnInertia(double time, const robot::ImuReading& reading) {
  if (!std::isfinite(time) || !std::isfinite(reading.yaw)) return FilterOutcome::kNotFinite;
  const bool is_late =
      (odometry_ && time < time_) || (!waiting_.empty() && time <= waiting_.back().time);
  if (is_late) return FilterOutcome::kLate;
  const std::optional<double> before =
      waiting_.empty() ? inertia_time_ : std::optional<double>(waiting_.back().time);
  const bool is_gap = before && time - *before > params_.imu_timeout;
  if (is_gap) BeginNewZero();  // it may have restarted meanwhile, which a small turn does not show
  waiting_.push_back({time, reading.yaw, newest_zero_});
  if (waiting_.size() > kMostWaiting) {
    waiting_.pop_front();
    return FilterOutcome::kTooMany;
  }
  return is_gap ? FilterOutcome::kAfterGap : FilterOutcome::kTaken;
}

void OdometryFilter::Drive(const Pose2& X_AB, double time) {
  const double c = std::cos(state_[2]), s = std::sin(state_[2]);
  const double dx = c * X_AB.x - s * X_AB.y, dy = s * X_AB.x + c * X_AB.y;
  Eigen::Matrix4d F = Eigen::Matrix4d::Identity();
  F(0, 2) = -dy;
  F(1, 2) = dx;
  const double driven = std::hypot(X_AB.x, X_AB.y), turned = std::abs(X_AB.yaw);
  Eigen::Vector4d Q;
  Q[0] = Q[1] = params_.position_per_metre * driven + params_.position_per_radian * turned;
  Q[2] = params_.yaw_per_metre * driven + params_.yaw_per_radian * turned;
  Q[3] = params_.imu_drift * std::max(0.0, time - time_);
  P_ = F * P_ * F.transpose();
  P_ += Q.asDiagonal();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  state_[0] += dx;
  state_[1] += dy;
  state_[2] = WrapToPi(state_[2] + X_AB.yaw);
  time_ = std::max(time_, time);
}

void OdometryFilter::UseHeading(const Inertia& inertia) {
  const double variance = params_.imu_yaw_sd * params_.imu_yaw_sd;
  const Eigen::RowVector4d H(0.0, 0.0, 1.0, 1.0);
  const double expected_variance = (H * P_ * H.transpose()).value() + variance;
  const double innovation = WrapToPi(inertia.yaw - state_[2] - state_[3]);
  const bool is_restarted =
      std::abs(innovation) > std::max(kSuddenTurn, kDeviations * std::sqrt(expected_variance));
  const bool is_first = !inertia_time_ || inertia.zero != known_zero_ || is_restarted;
  inertia_time_ = inertia.time;
  known_zero_ = inertia.zero;
  if (is_first) {  // the zero is what the heading lacks, as uncertain as both
    state_[3] = WrapToPi(inertia.yaw - state_[2]);
    P_.row(3) = -P_.row(2);
    P_.col(3) = -P_.col(2);
    P_(3, 3) = P_(2, 2) + variance;
    return;
  }
  const Eigen::Vector4d K = P_ * H.transpose() / expected_variance;
  const Eigen::Matrix4d A = Eigen::Matrix4d::Identity() - K * H;
  P_ = (A * P_ * A.transpose() + variance * K * K.transpose()).eval();  // Joseph's form
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  state_ += K * innovation;
  state_[2] = WrapToPi(state_[2]);
  state_[3] = WrapToPi(state_[3]);
}

}  // namespace hires::localisation
