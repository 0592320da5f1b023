#pragma once

#include <map>
#include <string>
#include <vector>

#include "hires/control/robot_names.h"
#include "hires/robot/robot_profile.h"

namespace hires::control {

/// Numbers of a dynamic_reconfigure server, by name.
using PlannerValues = std::map<std::string, double>;

/// What a motion set asks of a local planner, by the words of RobotNames::MoveBase::parameters.
/// A limit in the plane holds along every axis: linear also means translational and lateral
/// [facts of the original: max_trans_vel = max_vel_x, acc_lim_y = acc_lim_x].
/// max_lateral_velocity is not among them: a PR2 that may drive sideways as fast as ahead would.
const std::vector<std::string>& MotionLimits();

/// One of MotionLimits() of a set [m/s, rad/s, m/s^2, rad/s^2].
/// @throws base::ConfigError for an unknown word.
double LimitOf(const robot::MotionSet& set, const std::string& limit);

/// A motion set in a planner's own words.
/// @param names   limit -> what planners have called it, newest first; those are taken that the
///                planner has.
/// @param having  all that the planner has.
/// @throws base::ConfigError naming the limit for which it has no parameter, or the word
/// that is no limit. (ReadRobotNames sees to it that no limit of a set is left out.)
PlannerValues InWordsOf(const PlannerValues& having, const RobotNames::MoveBase& names,
                        const robot::MotionSet& set);

/// What a planner did not take as it was told: "max_vel_x is 0.4, wanted 0.3"; empty: it took all.
std::string WhatDiffers(const PlannerValues& wanted, const PlannerValues& got);

/// "max_vel_x 0.3, max_rot_vel 1", for messages.
std::string ToText(const PlannerValues& values);

}  // namespace hires::control
