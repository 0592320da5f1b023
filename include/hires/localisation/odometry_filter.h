#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>
#include <string>

#include "hires/base/param_reader.h"
#include "hires/geometry/pose.h"
#include "hires/robot/odometry_jump.h"
#include "hires/robot/readings.h"

namespace hires::localisation {

/// How wheels and inertial unit err. Variances of the wheels grow with what was driven, so that it
/// does not matter in how many readings it was reported.
struct OdometryFilterParams {
  double position_per_metre{4e-4};                ///< [m^2 / m] along and across, by driving
  double position_per_radian{1e-4};               ///< [m^2 / rad] by turning
  double yaw_per_metre{4e-4};                     ///< [rad^2 / m] by driving
  double yaw_per_radian{4e-3};                    ///< [rad^2 / rad] by turning
  double imu_yaw_sd{1e-3};                        ///< [rad] of one reading of the unit's heading
  double imu_drift{1e-7};                         ///< [rad^2 / s] by which its zero wanders
  double imu_timeout{1.0};                        ///< [s] readings farther apart are a gap
  double odometry_timeout{1.0};                   ///< [s] the same of the wheels
  double max_linear_speed{robot::kFastestDrive};  ///< [m/s] odometry that is faster was reset
  double max_angular_speed{robot::kFastestTurn};  ///< [rad/s]
  double jump_position_sd{0.1};  ///< [m] by which the estimate may be off after each jump of
  double jump_yaw_sd{0.1};       ///< [rad] odometry or time, beside what it was off before
};

/// What the node `odometry_filter` alone needs.
struct LiveOdometryParams {
  bool tf_broadcast{true};  ///< tells tf where the base is in the odometry's frame
  bool imu_used{true};
  double imu_wait{0.05};  ///< [s] of odometry's time that inertial readings may come after the
                          ///< odometry of their time
};

/// config/odometry_filter.yaml
struct OdometryFilterConfig {
  OdometryFilterParams filter;
  LiveOdometryParams node;
};

/// @throws base::ConfigError naming the key
OdometryFilterConfig ReadOdometryFilterConfig(base::ParamReader in);

/// What became of a reading.
enum class FilterOutcome {
  kTaken,
  kAfterGap,      ///< taken, but none came for too long; after it a unit's zero is found again
  kNotFinite,     ///< time or reading is no number
  kLate,          ///< older than what has been used already; odometry: by less than
                  ///< robot::kClockReset
  kTimeWentBack,  ///< odometry whose clock began again: goes on from this reading, as after
                  ///< kJumped; the unit's zero is found again
  kJumped,        ///< the odometry was reset: goes on from this reading; the estimate stays, its
                  ///< variances grow by the squares of jump_position_sd and jump_yaw_sd
  kTooMany        ///< inertial readings without odometry; the oldest one was left out
};
std::string ToString(FilterOutcome outcome);

/// Extended Kalman filter of wheel odometry and an inertial unit's heading, in the plane, as ROS's
/// robot_pose_ekf joins them to `odom_combined`: what it says drifts, but never jumps by more than
/// the unit corrects the wheels. State: x, y, yaw, and the unit's unknown zero.
///
/// Odometry is used as motion from one reading to the next. The unit's heading is used up to its
/// zero, which the first reading tells and which wanders from there, so nobody must say where north
/// is. Its rate is not: the unit integrates it to the heading already, and would count twice.
///
/// Inertial readings wait for the odometry of their time, and motion between two readings of the
/// odometry is taken as steady; so the order in which messages arrive changes nothing. Those from
/// before the first odometry, or from before a jump, are left out: no known motion leads to them.
class OdometryFilter {
 public:
  explicit OdometryFilter(const OdometryFilterParams& params);

  FilterOutcome OnOdometry(double time, const robot::OdometryReading& reading);
  FilterOutcome OnInertia(double time, const robot::ImuReading& reading);
  /// Inertial readings that come from now on count from another zero than those before.
  void BeginNewZero() { ++newest_zero_; }

  bool has_estimate() const { return odometry_.has_value(); }
  double time() const { return time_; }  ///< [s] of the newest odometry
  /// Base in the frame in which the estimate began at the first odometry's pose.
  geometry::Pose2 X_FB() const { return {state_[0], state_[1], state_[2]}; }
  geometry::Twist2 V_B() const { return V_B_; }
  Eigen::Matrix3d Covariance() const { return P_.topLeftCorner<3, 3>(); }  ///< symmetric

 private:
  struct Odometry {
    double time;
    geometry::Pose2 X_OB;
  };
  struct Inertia {
    double time, yaw;
    int zero;  // which of the unit's zeros it counts from
  };
  void Begin(double time, const geometry::Pose2& X_OB);
  void DropWaitingBefore(double time);
  void AddUnseenMotion();
  void GoOnFrom(double time, const geometry::Pose2& X_OB);
  void Drive(const geometry::Pose2& X_AB, double time);
  void UseHeading(const Inertia& inertia);

  OdometryFilterParams params_;
  double time_{0.0};
  Eigen::Vector4d state_{Eigen::Vector4d::Zero()};
  Eigen::Matrix4d P_{Eigen::Matrix4d::Zero()};
  geometry::Twist2 V_B_;
  std::optional<Odometry> odometry_;
  std::optional<double> inertia_time_;  // of the newest one used since the unit's zero is known
  int newest_zero_{0}, known_zero_{0};
  std::deque<Inertia> waiting_;
};

}  // namespace hires::localisation
