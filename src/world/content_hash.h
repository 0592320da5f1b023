#pragma once

#include "hires/base/hash.h"
#include "hires/world/world.h"

namespace hires::world {

/// Adds everything that physics can tell about `model`; not its name.
void AddTo(base::Hasher* hasher, const ObjectModel& model);
void AddTo(base::Hasher* hasher, const StaticBody& body);
void AddTo(base::Hasher* hasher, const geometry::Pose3& pose);

}  // namespace hires::world
