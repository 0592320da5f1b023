#include "hires/mapping/map_judge.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "hires/base/check.h"
#include "mapping/scan_points.h"

namespace hires::mapping {
namespace {

using world::OccupancyGrid;

constexpr double kMeetsFace = 0.1;  // [m] from the end of a beam, which has noise

bool IsOccupied(const OccupancyGrid& grid, int column, int row) {
  return column >= 0 && row >= 0 && column < grid.width && row < grid.height &&
         grid.at(column, row) == world::Cell::kOccupied;
}

/// The left face of a cell, or its lower one.
struct Face {
  int column{0}, row{0};
  bool is_left{false};
};

bool IsWall(const OccupancyGrid& grid, const Face& face) {
  return IsOccupied(grid, face.column, face.row) !=
         (face.is_left ? IsOccupied(grid, face.column - 1, face.row)
                       : IsOccupied(grid, face.column, face.row - 1));
}

Eigen::Vector2d MiddleOf(const OccupancyGrid& grid, const Face& face) {
  const Eigen::Vector2d aside =
      face.is_left ? Eigen::Vector2d(0.0, 0.5) : Eigen::Vector2d(0.5, 0.0);
  return grid.origin + grid.resolution * (Eigen::Vector2d(face.column, face.row) + aside);
}

/// Out of the wall.
Eigen::Vector2d NormalOf(const OccupancyGrid& grid, const Face& face) {
  const double out = IsOccupied(grid, face.column, face.row) ? -1.0 : 1.0;
  return face.is_left ? Eigen::Vector2d(out, 0.0) : Eigen::Vector2d(0.0, out);
}

/// [m] from a point to a face, which is a line.
double DistanceTo(const OccupancyGrid& grid, const Face& face, const Eigen::Vector2d& p) {
  const Eigen::Vector2d at = (p - grid.origin) / grid.resolution;
  const double x = face.column - at.x(), y = face.row - at.y();
  const double beside = face.is_left ? std::max({y, 0.0, -y - 1.0}) : std::max({x, 0.0, -x - 1.0});
  return grid.resolution * (face.is_left ? std::hypot(x, beside) : std::hypot(beside, y));
}

/// Calls `use` with each face of a wall in the cells around a point.
template <typename Use>
void ForEachFaceNear(const OccupancyGrid& grid, const Eigen::Vector2d& p, double distance,
                     const Use& use) {
  const Eigen::Vector2d at = (p - grid.origin) / grid.resolution;
  const int reach = static_cast<int>(std::ceil(distance / grid.resolution));
  const int column = static_cast<int>(std::floor(at.x())),
            row = static_cast<int>(std::floor(at.y()));
  for (int y = std::max(row - reach, 0); y <= std::min(row + reach, grid.height); ++y) {
    for (int x = std::max(column - reach, 0); x <= std::min(column + reach, grid.width); ++x) {
      for (const bool is_left : {true, false})
        if (const Face face{x, y, is_left}; IsWall(grid, face)) use(face);
    }
  }
}

double DistanceToFace(const OccupancyGrid& world, const Eigen::Vector2d& p_W) {
  double nearest = kFarthestWall;
  ForEachFaceNear(world, p_W, kFarthestWall, [&](const Face& face) {
    nearest = std::min(nearest, DistanceTo(world, face, p_W));
  });
  return nearest;
}

double DistanceToCell(const OccupancyGrid& map, const Eigen::Vector2d& p_M) {
  const Eigen::Vector2d at = (p_M - map.origin) / map.resolution;
  const int reach = static_cast<int>(std::ceil(kFarthestWall / map.resolution));
  const int column = static_cast<int>(std::floor(at.x())),
            row = static_cast<int>(std::floor(at.y()));
  double nearest = kFarthestWall;
  for (int y = row - reach; y <= row + reach; ++y) {
    for (int x = column - reach; x <= column + reach; ++x)
      if (IsOccupied(map, x, y)) nearest = std::min(nearest, (map.CentreOf(x, y) - p_M).norm());
  }
  return nearest;
}

std::optional<Face> FaceMet(const OccupancyGrid& world, const Eigen::Vector2d& p_WLaser,
                            const Eigen::Vector2d& p_WEnd) {
  std::optional<Face> met;
  double nearest = kMeetsFace;
  ForEachFaceNear(world, p_WEnd, kMeetsFace, [&](const Face& face) {
    const double distance = DistanceTo(world, face, p_WEnd);
    if (distance > nearest) return;
    if (NormalOf(world, face).dot(p_WLaser - MiddleOf(world, face)) <= 0.0) return;
    met = face;
    nearest = distance;
  });
  return met;
}

WallError SumUp(std::vector<double> errors) {
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  const auto rank = static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(errors.size())));
  return {errors[errors.size() / 2], errors[rank - 1], errors.size()};
}

}  // namespace

std::vector<Eigen::Vector2d> FacesThatWereSeen(
    const OccupancyGrid& world, const std::vector<localisation::RobotLog::Scan>& scans,
    const localisation::TimedPath& truth, double max_range) {
  HIRES_CHECK(scans.size() == truth.size(), "one true pose for each scan");
  const std::size_t stride = world.width + 1;
  std::vector<bool> is_seen(2 * stride * (world.height + 1));
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const geometry::Pose2 X_WL = truth[i].X_MB * scans[i].X_BL;
    for (std::size_t beam = 0; beam < scans[i].reading.ranges.size(); ++beam) {
      if (!HasMet(scans[i].reading, beam, max_range)) continue;
      const auto face = FaceMet(world, X_WL.position(), X_WL * EndOf(scans[i].reading, beam));
      if (face) is_seen[2 * (face->row * stride + face->column) + (face->is_left ? 0 : 1)] = true;
    }
  }
  std::vector<Eigen::Vector2d> middles;
  for (std::size_t i = 0; i < is_seen.size(); ++i) {
    if (!is_seen[i]) continue;
    const int column = static_cast<int>(i / 2 % stride), row = static_cast<int>(i / 2 / stride);
    middles.push_back(MiddleOf(world, {column, row, i % 2 == 0}));
  }
  return middles;
}

WallErrors JudgeWalls(const OccupancyGrid& map, const OccupancyGrid& world,
                      const geometry::Pose2& X_WM, const std::vector<Eigen::Vector2d>& seen_W) {
  std::vector<double> to_world, to_map;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (IsOccupied(map, column, row))
        to_world.push_back(DistanceToFace(world, X_WM * map.CentreOf(column, row)));
    }
  }
  const geometry::Pose2 X_MW = X_WM.Inverse();
  for (const Eigen::Vector2d& p_W : seen_W) to_map.push_back(DistanceToCell(map, X_MW * p_W));
  return {SumUp(std::move(to_world)), SumUp(std::move(to_map))};
}

}  // namespace hires::mapping
