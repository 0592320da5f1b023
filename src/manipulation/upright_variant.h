#pragma once

#include <optional>

#include "hires/manipulation/arm_path.h"

namespace hires::manipulation {

/// Angle [rad] between a held object's axis and the vertical at these joint positions.
/// @pre arm.upright_T is set.
double HeldTilt(const ArmScene& arm, const ArmJoints& joints);

/// A posture like `wanted` in which what the hand holds stands upright, free of collisions with
/// everything else as in `arm.posture`: the nearest one (largest joint difference) that differs in
/// the last three joints only (the forearm's roll and both of the wrist), on a grid of 5 degrees;
/// if there is none, the nearest one with the tool at the same place and any heading; if there is
/// none, with the tool up to 0.3 m higher and up to 0.2 m further in front, as little as possible.
/// Nothing if there is none. Deterministic.
/// @param max_tilt  [rad] of the held object's axis.
/// @pre arm.upright_T is set; the arm has three joints or more, the last about the tool's x axis;
/// max_tilt > 0.
std::optional<ArmJoints> FindUprightVariant(const ArmScene& arm, const ArmJoints& wanted,
                                            double max_tilt = 0.1);

}  // namespace hires::manipulation
