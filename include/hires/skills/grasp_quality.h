#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hires/skills/manipulation_context.h"

namespace hires::skills {

/// Quality (manipulation::Grasp) of the best grasp of a standing object that an arm can carry out
/// from where it is, lift included; nothing if there is none.
/// @param object  upright, one of the world's models; it need not be in the observation.
std::optional<double> GraspQuality(const ManipulationContext& context, const std::string& arm,
                                   const robot::Observation& observation,
                                   const world::ObjectState& object, std::uint64_t seed);

}  // namespace hires::skills
