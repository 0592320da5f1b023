#pragma once

#include "hires/robot/robot_profile.h"

namespace hires::robot {

/// The posture in which a robot stands: what `joints` leaves out as in the driving posture, gaps
/// and finger angles of grippers completed where the robot has some. As drivers measure it: joints
/// that follow others are left out, and up to 0.02 rad or m over a limit count as the limit.
JointPositions PostureOf(const Robot& robot, const JointPositions& joints);

}  // namespace hires::robot
