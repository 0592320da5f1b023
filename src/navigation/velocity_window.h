#pragma once

#include <vector>

#include "hires/geometry/pose.h"
#include "hires/navigation/dwa.h"

namespace hires::navigation {

/// Integrals over a duration of cosine and sine of a heading that turns at a constant rate [s].
struct ArcIntegrals {
  double along, across;
};
ArcIntegrals IntegralsAlong(double wz, double duration);

/// Where a base ends up that keeps its velocity V_B (expressed in the moving base) for `duration`
/// [s]: an exact arc, no matter into how many steps it is cut.
geometry::Pose2 PoseAfter(const geometry::Pose2& X_MB, const geometry::Twist2& V_B,
                          double duration);

/// `count` evenly spaced values from lower to upper, both included (at least these two), and 0
/// where two neighbours lie on either side of it. One value if the ends are equal.
/// @pre lower <= upper.
std::vector<double> SampleAxis(double lower, double upper, int count);

/// The velocities that the base can reach within one control period and may drive: forward,
/// sideways and turning within the limits; of a base that cannot move sideways so many that a brisk
/// one has fine ones, too. Velocities too small for the base to follow smoothly are
/// left out (slower than min_linear_velocity and turning slower than min_angular_velocity, both at
/// once), unless the limits are so low that nothing else could be reached. A velocity that is out
/// of the limits already, and cannot be brought back within one period, is asked to come back at
/// once: the base's own controller ramps it down.
std::vector<geometry::Twist2> ReachableVelocities(const DwaParams& params,
                                                  const robot::MotionSet& limits,
                                                  const geometry::Twist2& V_B);

/// The velocity one control period later when braking as hard as the limits allow.
geometry::Twist2 Braked(const geometry::Twist2& V_B, const robot::MotionSet& limits, double period);

bool IsStopped(const geometry::Twist2& V_B, const DwaParams& params);

/// [m/s^2], [rad/s^2] What a ramp that is as steep in both directions may plan to brake with.
double LinearRamp(const robot::MotionSet& limits);
double AngularRamp(const robot::MotionSet& limits);

/// [s] A base that cannot brake counts as one that need not.
double TimeToStop(double velocity, double acceleration);

/// [s] of driving on at a velocity for one period that covers the way of braking evenly after it,
/// too: half of what driving on for as long would cover.
double TimeToCover(const geometry::Twist2& V_B, const robot::MotionSet& limits, double period);

/// From `now` to `wanted` by `change` at most.
double Approach(double now, double wanted, double change);

/// The next of a row of commands that go to `wanted` by `change` at most in a period. From the last
/// command, for a base that lags would hardly be slowed down from what it was measured to do; but
/// from no command that it did not follow.
double Ramped(double commanded, double measured, double wanted, double change);

}  // namespace hires::navigation
