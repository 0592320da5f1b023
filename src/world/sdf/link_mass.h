#pragma once

#include <sdf/Link.hh>
#include <vector>

#include "hires/geometry/inertia.h"
#include "hires/geometry/pose.h"

namespace hires::world {

/// Whether the link's <inertial> says mass and principal moments; for others there are defaults,
/// which nobody has weighed.
bool HasWholeInertial(const sdf::Link& link);

/// SDF 1.11: from shapes and densities.
bool HasAutomaticInertia(const sdf::Link& link);

/// The link's mass and inertia, in a body B.
/// @pre HasWholeInertial
/// @throws base::ConfigError naming file, line and link: what is no number, or what no rigid body
/// has.
geometry::MassProperties MassPropertiesOf(const sdf::Link& link, const geometry::Pose3& X_BL);

/// Of several things that are one body: masses added, inertias by Steiner's theorem.
/// @pre not empty
geometry::MassProperties Together(const std::vector<geometry::MassProperties>& parts);

}  // namespace hires::world
