#pragma once

#include "hires/localisation/odometry_filter.h"
#include "hires/localisation/robot_log.h"

namespace hires::localisation {

/// Puts what OdometryFilter makes of a log's odometry and inertial readings in place of the
/// odometry: at the same times, from the first one's pose on, velocities as they were.
///
/// Where the unit tells no yaw, its rate is integrated, evenly changing from one reading to the
/// next. Over more than 0.25 s it is not, nor from a reading with yaw to one without: nobody knows
/// how far the base turned meanwhile but the wheels, so the unit's zero is found again.
/// @pre both kinds are in the order of time.
/// @return how often the odometry was reset, which counts as no motion.
int FilterOdometry(const OdometryFilterParams& params, RobotLog* log);

}  // namespace hires::localisation
