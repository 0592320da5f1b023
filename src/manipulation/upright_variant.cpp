#include "manipulation/upright_variant.h"

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"
#include "manipulation/motion_check.h"

namespace hires::manipulation {
namespace {

constexpr double kGrid = geometry::kPi / 36.0;  // [rad]

/// Values of a joint on a grid around `wanted`, within its limits; a whole turn of a continuous
/// one.
std::vector<double> GridAround(double wanted, double lower, double upper) {
  std::vector<double> values;
  const int half_turn = static_cast<int>(std::round(geometry::kPi / kGrid));
  for (int i = -half_turn; i <= half_turn; ++i) {
    const double value = wanted + i * kGrid;
    if (value >= lower && value <= upper) values.push_back(value);
  }
  return values;
}

/// Turn about the tool's x axis that brings the held axis closest to the vertical.
double BestRoll(const ArmScene& arm, const ArmJoints& joints) {
  const auto R_BT = arm.kinematics->ToolPose(arm.posture, joints).rotation;
  const Eigen::Vector3d up_T = R_BT.conjugate() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d& axis_T = *arm.upright_T;
  if (std::hypot(axis_T.y(), axis_T.z()) < 1e-6 * axis_T.norm()) return 0.0;
  if (std::hypot(up_T.y(), up_T.z()) < 1e-9) return 0.0;
  return geometry::WrapToPi(std::atan2(up_T.z(), up_T.y()) - std::atan2(axis_T.z(), axis_T.y()));
}

/// Postures with the last three joints turned.
std::vector<ArmJoints> WristVariants(const ArmScene& arm, const ArmJoints& wanted,
                                     double max_tilt) {
  const std::size_t n = wanted.size();
  const ArmJoints &lower = arm.kinematics->lower(), &upper = arm.kinematics->upper();
  std::vector<ArmJoints> upright;
  for (const double roll : GridAround(wanted[n - 3], lower[n - 3], upper[n - 3])) {
    for (const double flex : GridAround(wanted[n - 2], lower[n - 2], upper[n - 2])) {
      ArmJoints joints = wanted;
      joints[n - 3] = roll;
      joints[n - 2] = flex;
      joints[n - 1] += BestRoll(arm, joints);
      if (HeldTilt(arm, joints) <= max_tilt) upright.push_back(std::move(joints));
    }
  }
  return upright;
}

/// Where else the tool may be, in the base frame [m], nearest first.
std::vector<Eigen::Vector3d> Shifts() {
  std::vector<Eigen::Vector3d> shifts;
  for (double up = 0.0; up < 0.35; up += 0.05) {
    for (double forward = 0.0; forward < 0.25; forward += 0.05) {
      shifts.emplace_back(forward, 0.0, up);
    }
  }
  std::stable_sort(shifts.begin(), shifts.end(),
                   [](const auto& a, const auto& b) { return a.norm() < b.norm(); });
  return shifts;
}

/// Postures with the tool at its place in `wanted`, shifted, with any heading.
std::vector<ArmJoints> ShiftedVariants(const ArmScene& arm, const ArmJoints& wanted,
                                       const Eigen::Vector3d& shift_B) {
  constexpr int kNumHeadings = 24;
  InverseParams params;
  params.max_tries = 8;
  geometry::Pose3 X_BT = arm.kinematics->ToolPose(arm.posture, wanted);
  X_BT.translation += shift_B;
  const auto upright = Eigen::Quaterniond::FromTwoVectors(*arm.upright_T, Eigen::Vector3d::UnitZ());
  std::vector<ArmJoints> variants;
  for (int i = 0; i < kNumHeadings; ++i) {
    const double heading = 2.0 * geometry::kPi * i / kNumHeadings;
    X_BT.rotation = geometry::RotationFromRpy(0.0, 0.0, heading) * upright;
    for (ArmJoints& joints : arm.kinematics->Solve(arm.posture, X_BT, wanted, i, params)) {
      variants.push_back(std::move(joints));
    }
  }
  return variants;
}

std::optional<ArmJoints> NearestFree(const MotionCheck& check, std::vector<ArmJoints> variants,
                                     const ArmJoints& wanted) {
  std::stable_sort(variants.begin(), variants.end(), [&](const ArmJoints& a, const ArmJoints& b) {
    return LargestDifference(a, wanted) < LargestDifference(b, wanted);
  });
  const auto found = std::find_if(variants.begin(), variants.end(), [&](const ArmJoints& joints) {
    return check.IsWithinLimits(joints) && check.IsFree(joints);
  });
  if (found == variants.end()) return std::nullopt;
  return *found;
}

}  // namespace

double HeldTilt(const ArmScene& arm, const ArmJoints& joints) {
  HIRES_CHECK(arm.upright_T.has_value(), "something is held");
  const auto R_BT = arm.kinematics->ToolPose(arm.posture, joints).rotation;
  return std::acos(std::clamp((R_BT * arm.upright_T->normalized()).z(), -1.0, 1.0));
}

std::optional<ArmJoints> FindUprightVariant(const ArmScene& arm, const ArmJoints& wanted,
                                            double max_tilt) {
  HIRES_CHECK(arm.upright_T.has_value() && wanted.size() >= 3 && max_tilt > 0.0,
              "something is held, three joints, max_tilt > 0");
  const MotionCheck check(arm, {});
  if (auto found = NearestFree(check, WristVariants(arm, wanted, max_tilt), wanted)) return found;
  for (const Eigen::Vector3d& shift_B : Shifts()) {
    if (auto found = NearestFree(check, ShiftedVariants(arm, wanted, shift_B), wanted)) {
      return found;
    }
  }
  return std::nullopt;
}

}  // namespace hires::manipulation
