#include "skills/driving/by_height.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hires/geometry/segment.h"
#include "hires/geometry/shape.h"
#include "hires/robot/link_bounds.h"

namespace hires::skills {
namespace {

constexpr std::size_t kMostLayers = 3;  // each costs a map

struct PlacedShape {
  const geometry::Collision* shape;
  geometry::Pose3 X_BS;
  double lower, upper;  // [m]
  bool bears;           // what stands on it reaches higher
};

std::vector<PlacedShape> ShapesOf(const robot::Robot& robot) {
  const robot::RobotProfile& profile = robot.profile;
  const auto X_R = robot::ForwardKinematics(robot.model, profile.joints);
  const geometry::Pose3 X_BR = X_R[*robot.model.FindLink(profile.base_link)].Inverse();
  std::vector<PlacedShape> shapes;
  for (std::size_t i = 0; i < X_R.size(); ++i) {
    const robot::Link& link = robot.model.links[i];
    for (const geometry::Collision& shape : link.collisions) {
      const geometry::Pose3 X_BS = X_BR * (X_R[i] * shape.X_BS);
      const geometry::Aabb bounds = geometry::BoundsOf(shape.shape, X_BS);
      shapes.push_back({&shape, X_BS, bounds.lower.z(), bounds.upper.z(),
                        !profile.tray_link.empty() && link.name == profile.tray_link});
    }
  }
  return shapes;
}

std::optional<geometry::Polygon> OutlineWithin(const std::vector<PlacedShape>& shapes,
                                               const Band& band) {
  std::vector<Eigen::Vector2d> points;
  for (const PlacedShape& placed : shapes) {
    if (placed.lower > band.second || (placed.upper < band.first && !placed.bears)) continue;
    const double lower = placed.bears ? std::min(band.first, placed.lower) : band.first;
    const auto outline =
        geometry::OutlineInBand(placed.shape->shape, placed.X_BS, lower, band.second);
    if (outline) points.insert(points.end(), outline->begin(), outline->end());
  }
  if (points.empty()) return std::nullopt;
  return geometry::ConvexHull(std::move(points));
}

/// [m] by which the corner of one outline that lies farthest outside of another one does so.
double Beyond(const geometry::Polygon& outline, const geometry::Polygon& other) {
  double farthest = 0.0;
  for (const Eigen::Vector2d& p : outline) {
    if (geometry::Contains(other, p)) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < other.size(); ++i) {
      const Eigen::Vector2d& next = other[i + 1 == other.size() ? 0 : i + 1];
      nearest = std::min(nearest, (p - geometry::NearestOnSegment(p, other[i], next)).norm());
    }
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

bool AreAlike(const geometry::Polygon& a, const geometry::Polygon& b) {
  return Beyond(a, b) <= kNarrower && Beyond(b, a) <= kNarrower;
}

geometry::Polygon Around(const geometry::Polygon& a, const geometry::Polygon& b) {
  std::vector<Eigen::Vector2d> points = a;
  points.insert(points.end(), b.begin(), b.end());
  return geometry::ConvexHull(std::move(points));
}

/// Whether the footprint is the outline of the shapes, which do not move but with the base.
bool IsOfItsShapes(const robot::Robot& robot, const std::vector<PlacedShape>& shapes) {
  if (robot.profile.upper_body) return false;
  const auto all = OutlineWithin(shapes, {0.0, robot::kFootprintTop});
  return all && AreAlike(*all, robot.profile.footprint);
}

void Append(const Band& band, std::vector<Band>* bands) {
  if (!bands->empty() && band.first - bands->back().second < 0.5 * kHeightStep) {
    bands->back().second = band.second;
  } else {
    bands->push_back(band);
  }
}

void Append(const NarrowHeights& more, NarrowHeights* heights) {
  heights->bands.insert(heights->bands.end(), more.bands.begin(), more.bands.end());
  heights->outline = Around(heights->outline, more.outline);
}

/// Joins the two that are most alike.
void JoinTwo(std::vector<NarrowHeights>* narrow) {
  std::size_t first = 0, second = 1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < narrow->size(); ++i) {
    for (std::size_t j = i + 1; j < narrow->size(); ++j) {
      const double off = std::max(Beyond((*narrow)[i].outline, (*narrow)[j].outline),
                                  Beyond((*narrow)[j].outline, (*narrow)[i].outline));
      if (off >= least) continue;
      least = off;
      first = i;
      second = j;
    }
  }
  Append((*narrow)[second], &(*narrow)[first]);
  narrow->erase(narrow->begin() + static_cast<std::ptrdiff_t>(second));
}

}  // namespace

void Occupy(const world::OccupancyGrid& more, world::OccupancyGrid* grid) {
  for (std::size_t i = 0; i < grid->cells.size(); ++i)
    if (more.cells[i] == world::Cell::kOccupied) grid->cells[i] = world::Cell::kOccupied;
}

std::optional<geometry::Polygon> ShapesWithin(const robot::Robot& robot, const Band& band) {
  return OutlineWithin(ShapesOf(robot), band);
}

HeightSplit SplitByHeight(const robot::Robot& robot, double lowest, double highest) {
  const std::vector<PlacedShape> shapes = ShapesOf(robot);
  if (!IsOfItsShapes(robot, shapes)) return {{{lowest, highest}}, {}};
  HeightSplit split;
  const double top = std::min(highest, robot::kFootprintTop);
  for (int i = 0; lowest + i * kHeightStep < top; ++i) {
    const Band band{lowest + i * kHeightStep, std::min(lowest + (i + 1) * kHeightStep, top)};
    const auto outline =
        OutlineWithin(shapes, {band.first - kHeightSlack, band.second + kHeightSlack});
    if (!outline || Beyond(robot.profile.footprint, *outline) <= kNarrower) {
      Append(band, &split.whole);
      continue;
    }
    const auto alike =
        std::find_if(split.narrow.begin(), split.narrow.end(),
                     [&](const auto& other) { return AreAlike(other.outline, *outline); });
    if (alike == split.narrow.end()) {
      split.narrow.push_back({{band}, *outline});
    } else {
      Append(band, &alike->bands);
      alike->outline = Around(alike->outline, *outline);
    }
  }
  if (highest > top) Append({top, highest}, &split.whole);
  while (split.narrow.size() > kMostLayers) JoinTwo(&split.narrow);
  return split;
}

SlicedByHeight SliceByHeight(const world::World& world, const robot::Robot& robot, const Band& band,
                             double resolution, double margin) {
  SlicedByHeight sliced{world::SliceWorld(world, band.first, band.second, resolution, margin), {}};
  const HeightSplit split = SplitByHeight(robot, band.first, band.second);
  if (split.narrow.empty()) return sliced;
  world::OccupancyGrid nothing = sliced.whole;
  std::fill(nothing.cells.begin(), nothing.cells.end(), world::Cell::kFree);
  const auto slice = [&](const std::vector<Band>& bands) {
    world::OccupancyGrid grid = nothing;
    for (const Band& part : bands)
      Occupy(world::SliceWorld(world, part.first, part.second, resolution, margin), &grid);
    return grid;
  };
  world::OccupancyGrid whole = slice(split.whole);
  for (const NarrowHeights& heights : split.narrow) {
    world::OccupancyGrid map = slice(heights.bands);
    bool has_more = false;
    for (std::size_t i = 0; i < map.cells.size() && !has_more; ++i)
      has_more = map.cells[i] != whole.cells[i] && map.cells[i] == world::Cell::kOccupied;
    if (has_more) sliced.layers.push_back({std::move(map), heights.outline});
  }
  if (!sliced.layers.empty()) sliced.whole = std::move(whole);
  return sliced;
}

navigation::Costmap Layered(navigation::Costmap whole,
                            const std::vector<SlicedByHeight::Layer>& layers,
                            const robot::Robot& robot) {
  for (const SlicedByHeight::Layer& layer : layers) {
    const auto padded =
        navigation::PaddedFromMiddle(layer.outline, robot.profile.footprint_padding);
    whole = whole.WithLayer(layer.map, geometry::CircumscribedRadius(padded));
  }
  return whole;
}

navigation::Footprint BodyOf(const geometry::Polygon& padded,
                             const std::vector<SlicedByHeight::Layer>& layers,
                             const robot::Robot& robot) {
  navigation::Footprint body(padded);
  for (const SlicedByHeight::Layer& layer : layers) {
    body.by_layer.push_back(
        navigation::PaddedFromMiddle(layer.outline, robot.profile.footprint_padding));
  }
  return body;
}

}  // namespace hires::skills
