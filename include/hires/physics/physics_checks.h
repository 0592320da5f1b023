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

/// Boxes, a cylinder and a mesh at rest on plates of 0.005 to 0.1 m, parallel to their edges and
/// turned, and the onset of tipping of a box over each of its edges. Takes seconds.
std::vector<PhysicsCheck> RunShapeChecks();

}  // namespace hires::physics
