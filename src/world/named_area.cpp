#include "hires/world/named_area.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "world/map_region.h"

namespace hires::world {
namespace {

constexpr double kFarthestArea = 1000.0;  // [m], as what a world's file has

}  // namespace

void AddAreas(const std::vector<NamedArea>& areas, World* world) {
  AddAreas(areas, std::vector<double>(areas.size(), 0.0), world);
  NoteMapRegion(world);
}

void AddAreas(const std::vector<NamedArea>& areas, const std::vector<double>& heights,
              World* world) {
  HIRES_CHECK(areas.size() == heights.size(), "each area has a height");
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const NamedArea& area = areas[i];
    const std::string key = base::ToLower(area.name);
    if (std::max(std::abs(area.X_MA.x), std::abs(area.X_MA.y)) > kFarthestArea) {
      throw base::ConfigError(
          fmt::format("area '{}' lies at {:g}, {:g} m, wanted at most {:g} m away", area.name,
                      area.X_MA.x, area.X_MA.y, kFarthestArea));
    }
    geometry::Pose3 X_MA = geometry::Lift(area.X_MA);
    X_MA.translation.z() = heights[i];
    if (!world->frames.emplace(key, X_MA).second) {
      throw base::ConfigError(fmt::format(
          "area '{}' is there already, wanted a new name; call it otherwise", area.name));
    }
    world->frame_names[key] = area.name;
  }
}

}  // namespace hires::world
