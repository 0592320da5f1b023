#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hires/world/world.h"

namespace hires::world {

enum class Cell : std::uint8_t { kFree, kOccupied, kUnknown };

/// A grid in the plane of the map. Cell (0, 0) is the lower left one; its lower left corner is
/// `origin`. Row by row, x fastest.
struct OccupancyGrid {
  double resolution{0.05};  ///< [m] edge of a cell
  int width{0};
  int height{0};
  Eigen::Vector2d origin{Eigen::Vector2d::Zero()};  ///< [m] in map
  std::vector<Cell> cells;
  std::vector<std::string> notes{};  ///< as World::notes, of the map that it was read from

  Cell at(int column, int row) const {
    return cells[static_cast<std::size_t>(row) * width + column];
  }
  Eigen::Vector2d CentreOf(int column, int row) const;
};

/// Outlines of all static bodies (and of `objects`, where given) that reach into z_min..z_max.
std::vector<geometry::Polygon> OutlinesInBand(const World& world, const WorldState* objects,
                                              double z_min, double z_max);

/// What stands somewhere, by the name that its file gives it (NameOf) and where that stands.
struct NamedOutline {
  std::string name;
  std::string source;  ///< "hall.world:12", or empty
  geometry::Polygon outline_M;
  double lower{0.0}, upper{0.0};  ///< [m] heights between which all of the shape lies
};
/// Outlines of all static bodies as above.
std::vector<NamedOutline> NamedOutlinesInBand(const World& world, double z_min, double z_max);

/// Occupied are the cells that a static body touches within z_min..z_max (equal: a slice, as the
/// laser sees it); all others are free. Covers all static bodies plus `margin` [m]; in wide worlds
/// what lies around its areas (MapRegion).
OccupancyGrid SliceWorld(const World& world, double z_min, double z_max, double resolution = 0.05,
                         double margin = 0.5);

/// In the cells of SliceWorld, occupied are those that no floor bears: more than half of their area
/// (to a fifth of a cell; narrower joints and cracks are none) no static body reaches between
/// `depth` below z = 0 and z = 0, and ground lies deeper than that. Nothing where
/// World::ground_depth is no more than `depth` [m].
std::optional<OccupancyGrid> FloorHoles(const World& world, double depth, double resolution = 0.05,
                                        double margin = 0.5);

/// Reads a map_server YAML and its picture: PGM and other netpbm, PNG, BMP or JPEG. Cells are
/// map_server's; what is between free and occupied is unknown:
/// - mode trinary: the share of black (of white with `negate`) by the thresholds. An alpha channel
///   is averaged with the colours, as map_server's image_loader.cpp has it ("alpha will be averaged
///   in with color channels when using trinary mode") and nav2_map_server's map_io.cpp kept it;
/// - mode scale: by the thresholds likewise, without alpha; what is not wholly opaque is unknown
///   (map_io.cpp);
/// - mode raw: the level 0 .. 100 is an occupancy in percent, and goes by the thresholds; above, it
///   is unknown.
/// Palettes count by their colours (map_io.cpp; image_loader.cpp takes an index for a grey). A yaw
/// of the origin turns the grid (TurnedGrid). What was passed over, assumed or is doubtful is
/// logged as a warning; what bears on answers stands in `notes`, too.
/// @throws base::ConfigError with all that is wrong, each with its line where it has one (a missing
/// origin included, as map_server does).
OccupancyGrid LoadMap(const std::string& yaml_path);

/// The picture that LoadMap() reads; empty where it finds none.
std::string PictureOfMap(const std::string& yaml_path);

/// Writes a YAML and its picture, PictureToSave().
void SaveMap(const OccupancyGrid& grid, const std::string& yaml_path);

/// Beside the YAML, with .pgm for its ending.
std::string PictureToSave(const std::string& yaml_path);

/// A world whose walls are the grid's occupied cells extruded to `height` [m] (runs of cells of a
/// row merged into boxes, equal runs of rows merged as well).
World ExtrudeMap(const OccupancyGrid& grid, double height);

}  // namespace hires::world
