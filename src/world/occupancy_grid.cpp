#include "hires/world/occupancy_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/mesh_pieces.h"
#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "world/floor_level.h"
#include "world/map_region.h"

namespace hires::world {
namespace {

/// Bodies that reach less than this [m] into a cell only lie against it: rounding must not make a
/// wall that ends on a cell's edge one cell thicker.
constexpr double kTouch = 1e-6;
constexpr double kMaxCells = 5e7;

void AppendOutlines(const geometry::Collision& collision, const geometry::Pose3& X_MB, double z_min,
                    double z_max, std::vector<geometry::Polygon>* outlines) {
  auto outline = geometry::OutlineInBand(collision.shape, X_MB * collision.X_BS, z_min, z_max);
  if (outline) outlines->push_back(std::move(*outline));
}

void AppendStatic(const StaticBody& body, double z_min, double z_max,
                  std::vector<geometry::Polygon>* outlines) {
  for (const geometry::Collision& collision : body.collisions) {
    const auto* mesh = std::get_if<std::shared_ptr<const geometry::TriangleMesh>>(&collision.shape);
    if (mesh == nullptr) {
      AppendOutlines(collision, body.X_MB, z_min, z_max, outlines);
      continue;
    }
    // A whole building can be one mesh: its hull would fill the rooms.
    auto more = geometry::MeshOutlinesInBand(**mesh, body.X_MB * collision.X_BS, z_min, z_max);
    std::move(more.begin(), more.end(), std::back_inserter(*outlines));
  }
}

/// Where the convex polygon lies within the strip y_min..y_max: x from .. to; from > to if nowhere.
struct Span {
  double from{std::numeric_limits<double>::infinity()};
  double to{-std::numeric_limits<double>::infinity()};
  void Include(double x) {
    from = std::min(from, x);
    to = std::max(to, x);
  }
};

Span SpanInStrip(const geometry::Polygon& polygon, double y_min, double y_max) {
  Span span;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    if (a.y() >= y_min && a.y() <= y_max) span.Include(a.x());
    for (const double y : {y_min, y_max}) {
      if ((a.y() < y) == (b.y() < y)) continue;
      span.Include(a.x() + (b.x() - a.x()) * (y - a.y()) / (b.y() - a.y()));
    }
  }
  return span;
}

geometry::Aabb BoundsOf(const World& world) {
  geometry::Aabb bounds;
  for (const StaticBody& body : world.statics) {
    for (const geometry::Collision& collision : body.collisions) {
      bounds.Include(geometry::BoundsOf(collision.shape, body.X_MB * collision.X_BS));
    }
  }
  if (world.statics.empty()) bounds.Include(Eigen::Vector3d::Zero());
  return bounds;
}

/// "; 'shelf' (w.world:5) alone is 400 x 1200 m large" of the largest body from above, as a slip of
/// its units may be the cause.
std::string LargestText(const World& world) {
  double largest = 0.0;
  std::string text;
  for (const StaticBody& body : world.statics) {
    for (const geometry::Collision& shape : body.collisions) {
      const geometry::Aabb bounds = geometry::BoundsOf(shape.shape, body.X_MB * shape.X_BS);
      const Eigen::Vector3d size = bounds.upper - bounds.lower;
      if (size.head<2>().maxCoeff() <= largest) continue;
      largest = size.head<2>().maxCoeff();
      const std::string name = NameOf(body, shape), source = SourceOf(name, world);
      text = fmt::format("; '{}'{} alone is {:.4g} x {:.4g} m large", name,
                         source.empty() ? "" : " (" + source + ")", size.x(), size.y());
    }
  }
  return text;
}

/// A free grid around x, y of the world's bodies, or of what MapRegion says, its cell edges on
/// whole multiples of the resolution.
OccupancyGrid GridAround(const World& world, double resolution, double margin) {
  geometry::Aabb bounds = BoundsOf(world);
  if (const auto region = MapRegion(world)) {
    bounds.lower.head<2>() = region->min();
    bounds.upper.head<2>() = region->max();
  }
  const Eigen::Array2d lower =
      ((bounds.lower.head<2>().array() - margin) / resolution + kTouch).floor();
  const Eigen::Array2d upper =
      ((bounds.upper.head<2>().array() + margin) / resolution - kTouch).ceil();
  const Eigen::Array2d size = (upper - lower).max(1.0);
  if (!(size.prod() <= kMaxCells)) {
    throw base::ConfigError(fmt::format(
        "a grid of {:g} x {:g} cells of {} m is too large, at most {:g} cells; {}take a coarser "
        "resolution where there is a choice{}",
        size.x(), size.y(), resolution, kMaxCells,
        world.frames.empty() ? "" : "leave out areas that lie far from the others, or ",
        LargestText(world)));
  }
  OccupancyGrid grid;
  grid.resolution = resolution;
  grid.width = static_cast<int>(size.x());
  grid.height = static_cast<int>(size.y());
  grid.origin = lower * resolution;
  grid.cells.assign(static_cast<std::size_t>(grid.width) * grid.height, Cell::kFree);
  return grid;
}

int ClampedIndex(double cell, int size) {
  return static_cast<int>(std::clamp(std::floor(cell), 0.0, size - 1.0));
}

void Occupy(const geometry::Polygon& outline, OccupancyGrid* grid) {
  const auto [low, high] = std::minmax_element(
      outline.begin(), outline.end(), [](const auto& a, const auto& b) { return a.y() < b.y(); });
  const double res = grid->resolution;
  if (high->y() < grid->origin.y() || low->y() > grid->origin.y() + res * grid->height) return;
  const int first = ClampedIndex((low->y() - grid->origin.y()) / res - kTouch, grid->height);
  const int last = ClampedIndex((high->y() - grid->origin.y()) / res + kTouch, grid->height);
  for (int row = first; row <= last; ++row) {
    const double y = grid->origin.y() + row * res;
    const Span span = SpanInStrip(outline, y + kTouch, y + res - kTouch);
    const double from = (span.from + kTouch - grid->origin.x()) / res;
    const double to = (span.to - kTouch - grid->origin.x()) / res;
    if (!(span.to - span.from > 2.0 * kTouch) || to < 0.0 || from >= grid->width) continue;
    for (int column = ClampedIndex(from, grid->width); column <= ClampedIndex(to, grid->width);
         ++column) {
      grid->cells[static_cast<std::size_t>(row) * grid->width + column] = Cell::kOccupied;
    }
  }
}

/// Into so many parts along each edge a cell is divided to see how much of it a floor bears: fewer
/// where the map is that large.
int PartsOfCell(const OccupancyGrid& grid) {
  int parts = 5;
  while (parts > 1 && 1.0 * grid.width * grid.height * parts * parts > kMaxCells) --parts;
  return parts;
}

/// Free cells in the place of the grid's, `parts` along each of their edges.
OccupancyGrid Finer(const OccupancyGrid& grid, int parts) {
  OccupancyGrid fine;
  fine.resolution = grid.resolution / parts;
  fine.width = grid.width * parts;
  fine.height = grid.height * parts;
  fine.origin = grid.origin;
  fine.cells.assign(static_cast<std::size_t>(fine.width) * fine.height, Cell::kFree);
  return fine;
}

int PartsBorne(const OccupancyGrid& fine, int column, int row, int parts) {
  int borne = 0;
  for (int y = row * parts; y < (row + 1) * parts; ++y) {
    for (int x = column * parts; x < (column + 1) * parts; ++x)
      borne += fine.at(x, y) == Cell::kOccupied ? 1 : 0;
  }
  return borne;
}

/// Cells column_begin .. column_end - 1 of the rows row_begin .. row_end - 1.
struct Block {
  int column_begin, column_end, row_begin, row_end;
};

std::vector<Block> RunsOfRow(const OccupancyGrid& grid, int row) {
  std::vector<Block> runs;
  for (int column = 0; column < grid.width; ++column) {
    if (grid.at(column, row) != Cell::kOccupied) continue;
    if (!runs.empty() && runs.back().column_end == column) {
      ++runs.back().column_end;
    } else {
      runs.push_back({column, column + 1, row, row + 1});
    }
  }
  return runs;
}

/// Runs of occupied cells; a run just like one of the row below is joined to it.
std::vector<Block> Blocks(const OccupancyGrid& grid) {
  std::vector<Block> done;
  std::vector<Block> open;  // reach up to the row before
  for (int row = 0; row < grid.height; ++row) {
    std::vector<Block> runs = RunsOfRow(grid, row);
    for (const Block& below : open) {
      const auto same = std::find_if(runs.begin(), runs.end(), [&](const Block& run) {
        return run.column_begin == below.column_begin && run.column_end == below.column_end;
      });
      if (same == runs.end()) {
        done.push_back(below);
      } else {
        same->row_begin = below.row_begin;
      }
    }
    open = std::move(runs);
  }
  done.insert(done.end(), open.begin(), open.end());
  return done;
}

geometry::Collision BoxOf(const Block& block, const OccupancyGrid& grid, double height) {
  const Eigen::Vector2d lower =
      grid.origin + grid.resolution * Eigen::Vector2d(block.column_begin, block.row_begin);
  const Eigen::Vector2d upper =
      grid.origin + grid.resolution * Eigen::Vector2d(block.column_end, block.row_end);
  const Eigen::Vector2d middle = (lower + upper) / 2.0;
  geometry::Collision collision;  // without a name: the map gives it none
  collision.shape = geometry::Box{{upper.x() - lower.x(), upper.y() - lower.y(), height}};
  collision.X_BS.translation = {middle.x(), middle.y(), height / 2.0};
  return collision;
}

}  // namespace

Eigen::Vector2d OccupancyGrid::CentreOf(int column, int row) const {
  return origin + resolution * Eigen::Vector2d(column + 0.5, row + 0.5);
}

std::vector<geometry::Polygon> OutlinesInBand(const World& world, const WorldState* objects,
                                              double z_min, double z_max) {
  HIRES_CHECK(z_min <= z_max, "a band of heights ends above its begin");
  std::vector<geometry::Polygon> outlines;
  for (const StaticBody& body : world.statics) AppendStatic(body, z_min, z_max, &outlines);
  if (objects == nullptr) return outlines;
  for (const ObjectState& object : objects->objects) {
    const auto model = world.ModelOf(object);
    for (const geometry::Collision& collision : model->collisions) {
      AppendOutlines(collision, object.X_MO, z_min, z_max, &outlines);
    }
  }
  return outlines;
}

std::vector<NamedOutline> NamedOutlinesInBand(const World& world, double z_min, double z_max) {
  std::vector<NamedOutline> named;
  for (const StaticBody& body : world.statics) {
    for (const geometry::Collision& shape : body.collisions) {
      std::vector<geometry::Polygon> outlines;
      AppendStatic({body.name, body.X_MB, {shape}}, z_min, z_max, &outlines);
      const std::string name = NameOf(body, shape);
      const geometry::Aabb bounds = geometry::BoundsOf(shape.shape, body.X_MB * shape.X_BS);
      for (geometry::Polygon& outline : outlines) {
        named.push_back(
            {name, SourceOf(name, world), std::move(outline), bounds.lower.z(), bounds.upper.z()});
      }
    }
  }
  return named;
}

OccupancyGrid SliceWorld(const World& world, double z_min, double z_max, double resolution,
                         double margin) {
  HIRES_CHECK(resolution > 0.0 && std::isfinite(resolution), "a cell has an edge above 0 m");
  HIRES_CHECK(margin >= 0.0 && std::isfinite(margin), "a margin is not negative");
  HIRES_CHECK(z_min <= z_max, "a band of heights ends above its begin");
  OccupancyGrid grid = GridAround(world, resolution, margin);
  for (const geometry::Polygon& outline : OutlinesInBand(world, nullptr, z_min, z_max)) {
    Occupy(outline, &grid);
  }
  return grid;
}

std::optional<OccupancyGrid> FloorHoles(const World& world, double depth, double resolution,
                                        double margin) {
  HIRES_CHECK(resolution > 0.0 && std::isfinite(resolution), "a cell has an edge above 0 m");
  HIRES_CHECK(margin >= 0.0 && std::isfinite(margin), "a margin is not negative");
  HIRES_CHECK(depth >= 0.0 && std::isfinite(depth), "what is driven over is not negative");
  if (world.ground_depth <= depth) return std::nullopt;
  OccupancyGrid holes = GridAround(world, resolution, margin);
  const int parts = PartsOfCell(holes);
  OccupancyGrid fine = Finer(holes, parts);
  for (const geometry::Polygon& outline : OutlinesInBand(world, nullptr, -depth, kFloorStep)) {
    Occupy(outline, &fine);
  }
  for (int row = 0; row < holes.height; ++row) {
    for (int column = 0; column < holes.width; ++column) {
      if (2 * PartsBorne(fine, column, row, parts) >= parts * parts) continue;
      holes.cells[static_cast<std::size_t>(row) * holes.width + column] = Cell::kOccupied;
    }
  }
  return holes;
}

World ExtrudeMap(const OccupancyGrid& grid, double height) {
  HIRES_CHECK(height > 0.0 && std::isfinite(height), "walls have a height above 0 m");
  World world;
  world.name = "extruded_map";
  world.notes = grid.notes;
  StaticBody walls{"map_walls", {}, {}};
  for (const Block& block : Blocks(grid)) {
    walls.collisions.push_back(BoxOf(block, grid, height));
  }
  if (!walls.collisions.empty()) world.statics.push_back(std::move(walls));
  world.hash = world.ComputeHash();
  return world;
}

}  // namespace hires::world
