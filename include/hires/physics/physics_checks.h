#pragma once

#include <string>
#include <vector>

#include "hires/physics/closed_forms.h"

namespace hires::physics {

/// One comparison of the simulator with a closed form.
struct PhysicsCheck {
  std::string name;  ///< "onset of tipping, 36 headings, mill of the thesis text"
  std::string unit;
  double expected{0.0};
  double measured{0.0};  ///< the worst case over headings
  double error{0.0};     ///< |measured - expected| / expected, or absolute where expected is 0
  double tolerance{0.0};
  std::string remark;  ///< e.g. Housner's linearised value beside the nonlinear one
  bool passed() const { return error <= tolerance; }
};

/// Runs all closed-form comparisons (tipping, sliding, sudden stop, pulse, free fall,
/// precession, stopping distance, restitution, rest) for one cylinder. Takes seconds.
std::vector<PhysicsCheck> RunPhysicsChecks(const UprightCylinder& body,
                                           const std::string& body_name);

/// A cylinder that slides and tips when its ground stops at once.
struct SlipAndTip {
  UprightCylinder body;
  double friction{0.0};
  double speed{0.0};  ///< [m/s] of the ground from which the stop topples it
};
/// Without a closed form: computed by the planar solver of test/support/planar_oracle.h at a time
/// step of 0.1 ms; a test computes them again.
const std::vector<SlipAndTip>& SlipAndTipCases();

/// Friction from 0.02 to 3, radius over height of the center of mass (b/c) from 0.1 to 2, each over
/// 36 headings: sliding, tipping and both; on a slope; on ground that turns at 1 rad/s. Takes
/// seconds.
std::vector<PhysicsCheck> RunFrictionChecks();

/// Boxes, a cylinder and a mesh at rest on plates of 0.005 to 0.1 m, parallel to their edges and
/// turned, and the onset of tipping of a box over each of its edges. Takes seconds.
std::vector<PhysicsCheck> RunShapeChecks();

}  // namespace hires::physics
