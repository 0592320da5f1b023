#pragma once

#include <string>
#include <vector>

#include "hires/geometry/pose.h"
#include "hires/robot/upper_body.h"
#include "hires/world/world.h"

namespace hires::manipulation {

/// One way to take an upright object between the fingers.
struct Grasp {
  std::string kind;       ///< "side" or "top"
  geometry::Pose3 X_OT;   ///< tool in the object's frame, fingers round the object
  double approach{0.10};  ///< [m] back along the tool's x axis where the straight way begins
  double gap{0.0};        ///< [m] between the finger tips when they touch
  double quality{0.0};    ///< 0..1, for sorting: see GraspsFor
};

/// What of the gripper matters round an object. The tool's x axis points out between the fingers,
/// which open along y. Defaults: PR2, from the extents of its meshes.
struct FingerShape {
  double tip_reach{0.02};         ///< [m] the tips reach beyond the tool's origin
  double palm_distance{0.0546};   ///< [m] from the tool's origin back to the palm's front
  double pad_half_height{0.011};  ///< [m] of the tips, along the tool's z
  double half_height{0.028};      ///< [m] of the fingers, likewise
  double max_gap_used{0.085};  ///< [m] of an object's width: leaves room to get the fingers round
  double clearance{0.015};     ///< [m] kept from the supporting face and the palm
  /// Open fingers stand like a V. Their inner faces, drawn on to the tool's origin, are
  /// `open_width` apart there and `narrowing` less for each metre towards the palm (PR2's finger
  /// boxes turned by 0.548 rad): how deep a wide object fits between them.
  double open_width{0.125};  ///< [m]
  double narrowing{1.22};    ///< [m/m]
  double rim_margin{0.005};  ///< [m] on both sides, between the open fingers and the object's rim
};

/// Grasps of an object standing upright on its supporting face, best first: from the side at
/// several headings and heights, and from above. An object wider than the gripper opens has none.
/// Quality is the product of three shares: how near the grip is to the centre of mass (1 there, 0.5
/// at the object's height away), how deep the object is between the fingers (1 where its middle or
/// the palm is reached), and how far the gap is from both ends of the gripper's range (1 in the
/// middle, 0.5 at the ends). Deterministic.
/// @param headings  number of approach directions round the object, >= 1.
std::vector<Grasp> GraspsFor(const world::ObjectModel& object, const robot::GripperProfile& gripper,
                             int headings = 16, const FingerShape& fingers = {});

}  // namespace hires::manipulation
