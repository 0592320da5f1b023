#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hires/world/named_area.h"
#include "hires/world/world.h"

namespace hires::world {

/// LoadWorldWithAreas, which reads at most `models_per_part` models at a time. The world is the
/// same for any number.
World LoadWorldInParts(const std::string& sdf_path, const std::vector<std::string>& model_path,
                       std::size_t models_per_part, const std::vector<NamedArea>& areas = {});

}  // namespace hires::world
