#include "hires/ros/world/map_messages.h"

#include <fmt/format.h>

#include <cmath>

#include "hires/base/error.h"
#include "hires/world/turned_grid.h"

namespace hires_ros {
namespace {

using hires::base::ConfigError;
using hires::world::Cell;
using hires::world::OccupancyGrid;

constexpr double kOccupied = 65, kFree = 19.6;  // [%] map_server's thresholds

Cell CellOf(int value) {
  if (value > kOccupied) return Cell::kOccupied;
  return value >= 0 && value < kFree ? Cell::kFree : Cell::kUnknown;
}

std::int8_t ValueOf(Cell cell) {
  switch (cell) {
    case Cell::kFree:
      return 0;
    case Cell::kOccupied:
      return 100;
    case Cell::kUnknown:
      break;
  }
  return -1;
}

void RequireSound(const nav_msgs::OccupancyGrid& map) {
  const auto& info = map.info;
  const std::size_t wanted = static_cast<std::size_t>(info.width) * info.height;
  if (wanted == 0 || map.data.size() != wanted) {
    throw ConfigError(
        fmt::format("map: {} x {} cells and {} values, wanted one for each of at "
                    "least one cell",
                    info.width, info.height, map.data.size()));
  }
  if (!(info.resolution > 0.0f && std::isfinite(info.resolution))) {
    throw ConfigError(fmt::format("map: resolution is {} m, wanted more than 0", info.resolution));
  }
  if (!std::isfinite(info.origin.position.x + info.origin.position.y)) {
    throw ConfigError("map: info.origin is not finite, wanted numbers");
  }
  const auto& turn = info.origin.orientation;
  if (!(std::abs(turn.x) + std::abs(turn.y) <= 1e-6 && std::isfinite(turn.z + turn.w))) {
    throw ConfigError(
        "map: its origin is tilted out of the floor's plane, wanted a turn about z alone; save it "
        "with a yaw");
  }
}

/// [rad] about z; a quaternion that nobody filled in turns nothing.
double YawOf(const geometry_msgs::Quaternion& turn) { return 2.0 * std::atan2(turn.z, turn.w); }

}  // namespace

OccupancyGrid FromMsg(const nav_msgs::OccupancyGrid& map) {
  RequireSound(map);
  OccupancyGrid grid;
  grid.resolution = static_cast<double>(map.info.resolution);
  grid.width = static_cast<int>(map.info.width);
  grid.height = static_cast<int>(map.info.height);
  grid.origin = {map.info.origin.position.x, map.info.origin.position.y};
  grid.cells.reserve(map.data.size());
  for (const int value : map.data) grid.cells.push_back(CellOf(value));
  return hires::world::TurnedGrid(grid, YawOf(map.info.origin.orientation));
}

nav_msgs::OccupancyGrid ToMsg(const OccupancyGrid& grid, const std_msgs::Header& header) {
  nav_msgs::OccupancyGrid map;
  map.header = header;
  map.info.map_load_time = header.stamp;
  map.info.resolution = static_cast<float>(grid.resolution);
  map.info.width = static_cast<std::uint32_t>(grid.width);
  map.info.height = static_cast<std::uint32_t>(grid.height);
  map.info.origin.position.x = grid.origin.x();
  map.info.origin.position.y = grid.origin.y();
  map.info.origin.orientation.w = 1.0;
  map.data.reserve(grid.cells.size());
  for (const Cell cell : grid.cells) map.data.push_back(ValueOf(cell));
  return map;
}

}  // namespace hires_ros
