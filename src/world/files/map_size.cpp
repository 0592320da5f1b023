#include "world/files/map_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace hires::world {
namespace {

constexpr double kWidest = 2000.0;                  // [m]
constexpr double kCoarsest = 1.0, kFinest = 0.001;  // [m] edge of a cell
constexpr double kCentimetre = 0.01, kMillimetre = 0.001;
constexpr double kUsual = 0.2;  // [m] cells of a map that robots drive by are hardly coarser

}  // namespace

std::string DoubtedMapSize(const OccupancyGrid& grid, const std::string& yaml_path) {
  const double edge = grid.resolution;
  const double width = edge * grid.width, height = edge * grid.height;
  if (std::max(width, height) < kWidest && edge < kCoarsest && edge >= kFinest) return "";
  std::string remedy = "write the edge of a cell in metres, 0.05 is usual";
  for (const auto& [unit, factor] : {std::pair("cm", kCentimetre), std::pair("mm", kMillimetre)}) {
    if (edge < kCoarsest || edge * factor > kUsual) continue;
    remedy = fmt::format("in {} it would be {:.4g} x {:.4g} m, write resolution: {:.4g}", unit,
                         factor * width, factor * height, factor * edge);
    break;
  }
  return fmt::format(
      "map {} is {:.4g} x {:.4g} m large, with cells of {:g} m, as if its "
      "resolution were not in metres; if so, {}",
      yaml_path, width, height, edge, remedy);
}

}  // namespace hires::world
