#pragma once

#include "hires/robot/robot_model.h"
#include "hires/robot/upper_body.h"

namespace hires::robot {

/// Gap between the finger tips [m] at a position of the finger joint. Swinging fingers [rad]: the
/// tips swing on links of equal length and stay parallel, so the gap goes with sin(slant + angle) -
/// sin(slant), scaled to be 0 at angle 0 and max_gap at max_finger_angle (PR2: within 0.003 m of
/// its linkage, which ends at 0.0933 m). Sliding fingers [m]: twice the position, for both move.
/// Positions outside are taken as the nearest end.
double GapOf(const GripperProfile& gripper, double finger_position);

/// The inverse of GapOf; gaps outside 0 .. max_gap are taken as the nearest end.
double FingerPositionOf(const GripperProfile& gripper, double gap);

/// Completes joints so that each arm's gap and finger joint are both there and agree. The gap leads
/// where there are both, the finger joint where it is alone; an arm that has neither is left as it
/// is.
void CompleteGrippers(const UpperBodyProfile& profile, JointPositions* joints);

/// Sets gap and finger joint of one arm.
void SetGap(const GripperProfile& gripper, const ArmProfile& arm, double gap,
            JointPositions* joints);

}  // namespace hires::robot
