#pragma once

#include <optional>
#include <sdf/Link.hh>
#include <vector>

#include "hires/geometry/inertia.h"
#include "hires/geometry/pose.h"

namespace hires::world {

/// Whether the link's <inertial> says mass and principal moments; for others there are defaults,
/// which nobody has weighed.
bool HasWholeInertial(const sdf::Link& link);

/// Whether it says a mass and no <inertia> at all.
bool HasMassAlone(const sdf::Link& link);

/// Whether <inertial auto="true"> (SDF 1.11) asks for mass and inertia of shapes and densities.
bool HasAutomaticInertia(const sdf::Link& link);

/// That mass and inertia, in a body B: each box, cylinder and sphere is solid, of the <density> of
/// its <collision>, else of the <inertial>, else 1000 kg/m^3, as SDF has it.
/// @return nothing where a collision has another shape, or none has one.
/// @throws base::ConfigError naming file, line and link where a density is no number above 0.
std::optional<geometry::MassProperties> AutomaticMassOf(const sdf::Link& link,
                                                        const geometry::Pose3& X_BL);

/// The link's mass and inertia, in a body B; without <inertia> one of no meaning.
/// @pre HasWholeInertial or HasMassAlone
/// @throws base::ConfigError naming file, line and link: what is no number, or what no rigid body
/// has.
geometry::MassProperties MassPropertiesOf(const sdf::Link& link, const geometry::Pose3& X_BL);

}  // namespace hires::world
