#pragma once

#include <string>

#include "hires/translation/areas.h"
#include "hires/translation/classification.h"
#include "translation/body.h"

namespace hires::translation {

/// Where an area's middle is now.
geometry::Pose3 PoseOf(const Area& area, const Body& body);

/// Whether an object's origin is on the area, whether the object stands or lies.
/// @param beyond  [m] that its middle may lie outside of the edges.
bool IsOver(const Area& area, const Body& body, const geometry::Pose3& X_MO,
            const ClassifyParams& params, double beyond = 0.0);

/// The placing area or tray that the object is on; null if there is none, or it lies or is held.
/// @param before  area that it was on (lower case), or empty.
const Area* AreaUnder(const TranslatorContext& context, const Body& body,
                      const world::ObjectState& object, const std::string& before);

/// The box around an object in its own frame.
geometry::Aabb BoundsOf(const world::ObjectModel& model);

}  // namespace hires::translation
