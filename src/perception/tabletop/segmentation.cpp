#include "hires/perception/segmentation.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "hires/perception/depth_sensor.h"
#include "perception/patches/convex_patches.h"
#include "perception/tabletop/on_table.h"
#include "perception/tabletop/part_joining.h"
#include "perception/tabletop/smooth_borders.h"
#include "perception/tabletop/surfels.h"

namespace hires::perception {
namespace {

// Fork of the caller's stream.
enum Stream { kPartsStream = 1 };

// What is farther than a depth camera reaches was not measured: noise that grows with the square of
// the distance would have it on any plane, and a single such point the table as long as it is far.
PointCloud WithinReach(PointCloud cloud) {
  constexpr float kReach = 10.0F;  // [m] along the camera's axis
  for (Eigen::Vector3f& p : cloud.points)
    if (!(p.z() <= kReach)) p.setConstant(std::numeric_limits<float>::quiet_NaN());
  return cloud;
}

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
    if (height > params.surface_tolerance * table.noise * DepthNoise(p.z())) {
      if (height < params.max_above && IsNear(table.outline, table.FromAbove(p), params.max_beside))
        above.push_back(static_cast<int>(i));
    } else if (height > -params.max_below &&
               geometry::Contains(table.outline, table.FromAbove(p))) {
      (*labels)[i] = kLabelTable;
    }
  }
  return above;
}

// Part of each surfel, 0, 1, ...: the patch that has most of its points; -1: none, or one of too
// few points.
std::vector<int> PartsOf(const PointCloud& cloud, const std::vector<int>& above,
                         const SurfelCloud& surfels, const ConvexPartParams& params) {
  const std::vector<int> patches = FindConvexPatches(
      cloud.points, cloud.width, cloud.height, above,
      {params.voxel, params.seed, params.max_concavity, params.max_step, params.min_supervoxels});
  std::map<int, int> num_points;
  std::vector<std::map<int, int>> votes(surfels.surfels.size());
  for (const int i : above) {
    if (patches[i] == 0) continue;
    ++num_points[patches[i]];
    ++votes[surfels.of_point[i]][patches[i]];
  }
  std::map<int, int> numbers;
  std::vector<int> part(surfels.surfels.size(), -1);
  for (std::size_t i = 0; i < part.size(); ++i) {
    const auto most =
        std::max_element(votes[i].begin(), votes[i].end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most != votes[i].end() && num_points[most->first] >= params.min_points)
      part[i] = numbers.emplace(most->first, static_cast<int>(numbers.size())).first->second;
  }
  return part;
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

// Of each part, whether most of it is not within the outline.
std::vector<bool> AreBeside(const Table& table, const SurfelCloud& all,
                            const std::vector<int>& part, int num_parts) {
  std::vector<int> within(num_parts, 0), beside(num_parts, 0);
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (part[i] < 0) continue;
    const bool is_within = geometry::Contains(table.outline, table.FromAbove(all.surfels[i].p_C));
    ++(is_within ? within : beside)[part[i]];
  }
  std::vector<bool> are_beside;
  for (int i = 0; i < num_parts; ++i) are_beside.push_back(within[i] < beside[i]);
  return are_beside;
}

// So far above the plane that of a whole table's points none is by noise.
bool IsClearlyAbove(const Table& table, const Eigen::Vector3d& p_C,
                    const SegmentationParams& params) {
  return table.HeightOf(p_C) > 2.0 * params.surface_tolerance * table.noise * DepthNoise(p_C.z());
}

int CountOver(const Table& table, const PointCloud& cloud, const SegmentationParams& params) {
  return static_cast<int>(
      std::count_if(cloud.points.begin(), cloud.points.end(), [&](const Eigen::Vector3f& point) {
        if (!IsMeasured(point)) return false;
        const Eigen::Vector3d p = point.cast<double>();
        return IsClearlyAbove(table, p, params) &&
               geometry::Contains(table.outline, table.FromAbove(p));
      }));
}

Segmentation SegmentNear(const Table& table, Outline outline, const PointCloud& cloud,
                         const SegmentationParams& params, const base::Rng& rng) {
  Segmentation out;
  out.labels.assign(cloud.points.size(), kLabelNone);
  out.table = table;
  const std::vector<int> above = LabelTable(cloud, table, params, &out.labels);
  const SurfelCloud surfels = MakeSurfels(cloud, above, params.surfels);
  const SeenDepth seen(cloud);
  const std::vector<int> whole = JoinAcrossSmoothBorders(
      surfels, PartsOf(cloud, above, surfels, params.parts), params.smooth_borders);
  const JoinedParts parts = JoinParts(cloud, table, surfels, seen,
                                      WithoutBeside(cloud, table, surfels, seen, outline, whole),
                                      params.joining, rng.Fork(kPartsStream));
  for (const int i : above) {
    const int part = parts.part[surfels.of_point[i]];
    if (part >= 0) {
      out.labels[i] = kLabelFirstThing + part;
      out.num_things = std::max(out.num_things, part + 1);
    } else {
      out.num_left_out += IsClearlyAbove(table, cloud.points[i].cast<double>(), params);
    }
  }
  out.may_be_beside = AreBeside(table, surfels, parts.part, out.num_things);
  LabelFloors(cloud, table, parts.openings, &out.labels);
  if (out.num_things == 0) out.num_over = CountOver(table, cloud, params);
  return out;
}

}  // namespace

Segmentation SegmentOn(const Table& table, const PointCloud& cloud,
                       const SegmentationParams& params, const base::Rng& rng) {
  return SegmentNear(table, Outline::kWhole, WithinReach(cloud), params, rng);
}

Segmentation SegmentTabletop(const PointCloud& cloud, const std::optional<CameraStand>& stand,
                             const SegmentationParams& params, const base::Rng& rng) {
  const PointCloud near = WithinReach(cloud);
  const auto table = FindTable(near, stand, params.table);
  if (table) return SegmentNear(*table, Outline::kSeen, near, params, rng);
  Segmentation nothing;
  nothing.labels.assign(cloud.points.size(), kLabelNone);
  return nothing;
}

}  // namespace hires::perception
