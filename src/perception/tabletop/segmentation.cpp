#include "hires/perception/segmentation.h"

#include <algorithm>
#include <map>

#include "hires/perception/depth_sensor.h"
#include "perception/tabletop/convex_parts.h"
#include "perception/tabletop/part_joining.h"
#include "perception/tabletop/surfels.h"

namespace hires::perception {
namespace {

// Fork of the caller's stream.
enum Stream { kTableStream, kPartsStream };

// Within the outline, or so near to one of its edges.
bool IsNear(const geometry::Polygon& outline, const Eigen::Vector2d& p, double distance) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Eigen::Vector2d along = (outline[(i + 1) % outline.size()] - outline[i]).normalized();
    const Eigen::Vector2d to_p = p - outline[i];
    if (along.y() * to_p.x() - along.x() * to_p.y() > distance) return false;
  }
  return true;
}

// What may stand on the table, and what is the table.
std::vector<int> LabelTable(const PointCloud& cloud, const Table& table,
                            const SegmentationParams& params, std::vector<int>* labels) {
  std::vector<int> above;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if (!IsMeasured(cloud.points[i])) continue;
    const Eigen::Vector3d p = cloud.points[i].cast<double>();
    const double height = table.HeightOf(p);
    if (height > params.surface_tolerance * DepthNoise(p.z())) {
      if (height < params.max_above && IsNear(table.outline, table.FromAbove(p), params.max_beside))
        above.push_back(static_cast<int>(i));
    } else if (height > -params.max_below &&
               geometry::Contains(table.outline, table.FromAbove(p))) {
      (*labels)[i] = kLabelTable;
    }
  }
  return above;
}

// A vessel's floor may lie as low as the table.
void LabelFloors(const PointCloud& cloud, const Table& table, const std::vector<Opening>& openings,
                 std::vector<int>* labels) {
  if (openings.empty()) return;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    if ((*labels)[i] > kLabelTable || !IsMeasured(cloud.points[i])) continue;
    for (const Opening& opening : openings)
      if (IsSeenThrough(opening, table, cloud.points[i].cast<double>()))
        (*labels)[i] = kLabelFirstThing + opening.part;
  }
}

// Parts whose surfels are mostly beside the table are no things on it.
std::vector<int> WithoutBeside(const SurfelCloud& all, const Table& table, std::vector<int> part) {
  std::map<int, std::pair<int, int>> on_and_all;
  for (std::size_t i = 0; i < part.size(); ++i) {
    auto& [on, count] = on_and_all[part[i]];
    on += geometry::Contains(table.outline, table.FromAbove(all.surfels[i].p_C));
    ++count;
  }
  for (int& one : part)
    if (2 * on_and_all[one].first < on_and_all[one].second) one = -1;
  return part;
}

}  // namespace

Segmentation SegmentOn(const Table& table, const PointCloud& cloud,
                       const SegmentationParams& params, const base::Rng& rng) {
  Segmentation out;
  out.labels.assign(cloud.points.size(), kLabelNone);
  out.table = table;
  const std::vector<int> above = LabelTable(cloud, table, params, &out.labels);
  const SurfelCloud surfels = MakeSurfels(cloud, above, params.surfels);
  const JoinedParts parts = JoinParts(
      cloud, table, surfels, WithoutBeside(surfels, table, FindConvexParts(surfels, params.parts)),
      params.joining, rng.Fork(kPartsStream));
  for (const int i : above) {
    const int part = parts.part[surfels.of_point[i]];
    if (part >= 0) out.labels[i] = kLabelFirstThing + part;
    out.num_things = std::max(out.num_things, part + 1);
  }
  LabelFloors(cloud, table, parts.openings, &out.labels);
  return out;
}

Segmentation SegmentTabletop(const PointCloud& cloud, const std::optional<CameraStand>& stand,
                             const SegmentationParams& params, const base::Rng& rng) {
  const auto table = FindTable(cloud, stand, params.table, rng.Fork(kTableStream));
  if (table) return SegmentOn(*table, cloud, params, rng);
  return {std::nullopt, std::vector<int>(cloud.points.size(), kLabelNone), 0};
}

}  // namespace hires::perception
