#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "hires/base/failure.h"
#include "hires/base/param_reader.h"
#include "hires/geometry/pose.h"
#include "hires/navigation/braking.h"
#include "hires/robot/robot_profile.h"

namespace hires::navigation {

/// When the guard stops the base, and how: config/base_guard.yaml. All times in s.
struct BaseGuardParams {
  double pose_patience{0.3};      ///< age of odometry and of each transform from map to base
  double scan_patience{0.3};      ///< age of the base laser's scan
  double request_patience{0.1};   ///< since the last request: its sender is dead
  double command_patience{0.25};  ///< since the last velocity, while the base moves
  double update_patience{0.15};   ///< between two updates of the guard itself
  double max_position_sd{0.3};    ///< [m] of the localisation, in its worst direction
  double max_yaw_sd{0.2};         ///< [rad] of the localisation
  double zero_time{1.0};          ///< that zeros are sent once the base stands
  double trailing{0.2};           ///< [m/s], [rad/s] by which a base may trail what it was told
  double still_speed{0.01};       ///< [m/s], [rad/s] counts as standing
  bool needs_motors_state{true};  ///< false: the robot does not tell whether motors are halted
  bool needs_localisation{true};  ///< false: no source tells how sure the localisation is
  bool needs_scan{true};          ///< false: the robot has no base laser
  BrakingParams braking;
};
/// Reads the file. What the robot has, the `needs_...`, is not in it.
/// @throws base::ConfigError naming file and key.
BaseGuardParams ReadBaseGuardParams(const std::string& path);

/// Permission to drive.
struct DriveRequest {
  std::uint64_t id{0};                          ///< 0: no request to drive
  robot::MotionSet limits{0.0, 0.0, 0.0, 0.0};  ///< velocities are clipped to its speeds
  BrakingLimits braking{0.0, 0.0};              ///< what the load survives; 0: unknown
};

/// What is wrong with a request, in words for people; empty if it can be used.
std::string Defect(const DriveRequest& request);

enum class GuardState {
  kPassing,  ///< velocities go through, within the request's limits
  kBraking,  ///< along a ramp that the load survives
  kStanding  ///< nothing moves until a new request
};

/// What the robot tells about its pose; each must be fresh.
enum class PoseSource {
  kOdometry,       ///< wheel odometry, tells the speed
  kBaseTransform,  ///< odometry frame to base
  kMapTransform    ///< map to odometry frame
};

/// Stands between the program that drives and the base. Velocities pass while a request is alive
/// and all is well: motors on, pose and scan fresh, localisation sure, commands coming. Else the
/// base is led to a stand along a ramp, and nothing passes until a request with another id has come
/// and all is well again. A request that was stopped is over for good.
///
/// Time is handed in, on any steady clock of the caller [s]; it does not decrease. Messages say
/// when what they tell was so (`stamp`, on the same clock); a stamp that lies ahead counts as now.
/// Nothing is thrown and nothing waits.
class BaseGuard {
 public:
  explicit BaseGuard(const BaseGuardParams& params);

  void OnCommand(const geometry::Twist2& V_B, double now);
  void OnRequest(const DriveRequest& request, double now);
  void OnMotorsHalted(bool halted);
  void OnOdometry(const geometry::Twist2& V_B, double stamp, double now);
  void OnTransform(PoseSource source, double stamp, double now);  ///< @pre not kOdometry
  /// @param position_sd [m] in the worst direction, @param yaw_sd [rad]; negative or no numbers
  /// count as lost.
  void OnLocalisation(double position_sd, double yaw_sd);
  void OnScan(double stamp, double now);
  /// Something else that forbids driving; no failure: nothing does.
  void OnHindrance(base::Failure hindrance) { hindrance_ = std::move(hindrance); }
  /// While held, who wants to drive waits: what it needs is being prepared. Who drives goes on.
  void OnHold(bool is_held) { is_held_ = is_held; }

  /// The request that wants to drive, or drives: alive and not over. 0: none.
  std::uint64_t Applicant(double now) const;

  /// What keeps the base from driving, whoever wants to: no_pose, motors_halted, ...; no failure:
  /// nothing does.
  base::Failure WhatForbidsDriving(double now) const;

  /// To be called often (50 Hz), and after each command that shall pass at once.
  /// @return the velocity to send to the base now; nothing where nothing is to be sent.
  std::optional<geometry::Twist2> Update(double now);

  GuardState state() const { return state_; }
  std::uint64_t request() const { return current_; }  ///< that the state is about; 0: none
  /// Why it brakes or stands: stale_pose ("0.41 s, odometry"); no_request at first; nothing while
  /// passing.
  const base::Failure& failure() const { return failure_; }
  /// The stop that is going on or went on last: how long it takes, and how far [s, m].
  double stop_time() const { return stop_ ? stop_->duration() : 0.0; }
  double stop_distance() const { return stop_ ? stop_->distance() : 0.0; }

 private:
  struct Velocity {
    geometry::Twist2 V;
    double time{0.0};
  };
  struct Localisation {
    double position_sd{0.0}, yaw_sd{0.0};
  };
  std::optional<geometry::Twist2> Pass(double now);
  std::optional<geometry::Twist2> Brake(double now);
  void Wait(double now);
  void FollowRequest();
  base::Failure WhyNoPose(double now) const;
  base::Failure WhyStop(double now) const;  // nothing: go on
  void Begin(base::Failure failure, double now);
  void End(std::uint64_t id);
  bool HasEnded(std::uint64_t id) const;
  geometry::Twist2 MotionNow(double now) const;
  geometry::Twist2 AccelerationNow(double now) const;
  BrakingLimits LimitsInForce() const;

  BaseGuardParams params_;
  GuardState state_{GuardState::kStanding};
  base::Failure failure_{base::FailureCode::kNoRequest};
  std::uint64_t current_{0};
  std::deque<std::uint64_t> ended_;  // requests that are over, newest last

  DriveRequest request_;  // the last that came and is not over
  double request_time_{0.0};
  DriveRequest active_;              // the one that velocities pass for
  std::optional<Velocity> command_;  // the last since velocities pass
  std::optional<Velocity> sent_;     // the last that went out
  std::deque<Velocity> odometry_;    // of the last moments, newest last
  std::array<std::optional<double>, 3> pose_stamps_;
  std::optional<double> scan_stamp_;
  std::optional<bool> motors_halted_;
  base::Failure hindrance_;
  bool is_held_{false};
  std::optional<Localisation> localisation_;

  double last_update_{0.0};
  double since_{0.0};  // when braking began, or the base stood
  std::optional<PlanarStop> stop_;
};

}  // namespace hires::navigation
