#include "hires/sensing/floor_watch.h"

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/world/unknown_box.h"
#include "sensing/unmapped.h"

namespace hires::sensing {
namespace {

using Eigen::Vector2d;
using geometry::Polygon;
using geometry::Rectangle;

constexpr double kResolution = 0.05;   // [m] of the grid of what is known
constexpr double kLongestPause = 0.2;  // [s] between two scans that counts as time of seeing
constexpr double kGoneFaster = 5.0;    // times as fast as they appear
constexpr double kBehind = 0.1;      // [m] behind a cell, where a beam that passed it ends at least
constexpr double kThickness = 0.02;  // [m] around points: a box has a size
constexpr double kMinHeight = 0.05;  // [m] above the floor, of what is known: rugs and sills

navigation::Costmap MapOf(const world::World& world, double height) {
  navigation::CostmapParams params;
  params.inflation_radius = 0.0;
  return {world::SliceWorld(world, kMinHeight, height, kResolution, 1.0), 0.0, params};
}

Rectangle BoxAround(const std::vector<Vector2d>& points) {
  Polygon corners;
  for (const Vector2d& p : points) {
    for (const double x : {-kThickness, kThickness})
      for (const double y : {-kThickness, kThickness}) corners.push_back(p + Vector2d(x, y));
  }
  return geometry::SmallestRectangle(geometry::ConvexHull(std::move(corners)));
}

/// Whether they are the same but for what a thing may seem to differ.
bool AreAlike(const Rectangle& a, const Rectangle& b, double tolerance) {
  const auto reaches = [&](const Rectangle& from, const Rectangle& to) {
    const Vector2d half = (0.5 * to.size).array() + tolerance;
    for (const Vector2d& corner : geometry::CornersOf(from))
      if (((to.X_PR.Inverse() * corner).cwiseAbs() - half).maxCoeff() > 0.0) return false;
    return true;
  };
  return reaches(a, b) && reaches(b, a);
}

}  // namespace

FloorWatchParams ReadFloorWatchParams(base::ParamReader in) {
  using base::Between;
  FloorWatchParams params;
  params.is_enabled = in.GetBool("enabled");
  params.range = in.Get("range", Between(0.1, 30.0));
  params.tolerance = in.Get("tolerance", Between(0.0, 1.0));
  params.cell = in.Get("cell", Between(0.02, 0.5));
  params.appear_after = in.Get("appear_after", Between(0.1, 600.0));
  params.gap = in.Get("gap", Between(0.0, 2.0));
  params.height = in.Get("height", Between(0.1, 2.0));
  params.min_change = in.Get("min_change", Between(0.0, 1.0));
  return params;
}

FloorWatch::FloorWatch(const RobotStateEstimator* state, std::shared_ptr<const world::World> world,
                       Polygon footprint, const FloorWatchParams& params)
    : params_(params),
      footprint_(std::move(footprint)),
      known_M_(world::OutlinesInBand(*world, nullptr, kMinHeight, params.height)),
      map_(MapOf(*world, params.height)),
      scans_(state) {}

Receipt FloorWatch::OnScan(double stamp, const std::string& frame, robot::ScanReading reading) {
  return scans_.OnScan(stamp, frame, std::move(reading));
}

bool FloorWatch::Update(double time) {
  const auto scan = scans_.Take(time);
  if (!scan) return false;
  const double elapsed = std::clamp(scan->stamp - time_, 0.0, kLongestPause);
  time_ = scan->stamp;
  if (!Count(*scan, elapsed)) return false;
  std::vector<Rectangle> boxes;
  for (std::vector<Vector2d>& group : Groups()) Box(std::move(group), &boxes);
  const std::vector<std::string> gone = vanished_;
  const std::vector<Rectangle> before = boxes_;
  Name(boxes, scan->stamp);
  const auto same = [](const Rectangle& a, const Rectangle& b) {
    return a.size == b.size && a.X_PR.position() == b.X_PR.position();
  };
  return gone != vanished_ ||
         !std::equal(before.begin(), before.end(), boxes_.begin(), boxes_.end(), same);
}

FloorWatch::Key FloorWatch::KeyOf(const Vector2d& p_M) const {
  return {std::lround(std::floor(p_M.x() / params_.cell)),
          std::lround(std::floor(p_M.y() / params_.cell))};
}

/// @return whether cells were taken or given up.
bool FloorWatch::Count(const ScanQueue::Placed& scan, double elapsed) {
  const robot::ScanReading& reading = scan.reading;
  std::map<Key, int> hit;
  for (std::size_t i = 0; i < reading.ranges.size(); ++i) {
    const double range = reading.ranges[i];
    if (!(range >= reading.range_min && range <= params_.range)) continue;  // NaN included
    const double angle = reading.angle_min + static_cast<double>(i) * reading.angle_increment;
    const Vector2d p_B = scan.X_BL * Vector2d(range * std::cos(angle), range * std::sin(angle));
    const Vector2d p_M = scan.X_MB * p_B;
    if (geometry::Contains(footprint_, p_B) || IsExplained(map_, p_M, params_.tolerance)) continue;
    Cell& cell = cells_[KeyOf(p_M)];
    cell.sum += p_M;
    ++cell.count;
    ++hit[KeyOf(p_M)];
  }
  bool has_changed = false;
  for (const auto& [key, unused] : hit) {
    Cell& cell = cells_[key];
    cell.seen = std::min(cell.seen + elapsed, params_.appear_after);
    if (cell.is_taken || cell.seen < params_.appear_after) continue;
    cell.is_taken = has_changed = true;
  }
  return Forget(scan, elapsed, hit) || has_changed;
}

/// Gives up the cells that beams pass.
bool FloorWatch::Forget(const ScanQueue::Placed& scan, double elapsed,
                        const std::map<Key, int>& hit) {
  bool has_changed = false;
  const robot::ScanReading& reading = scan.reading;
  const geometry::Pose2 X_LM = (scan.X_MB * scan.X_BL).Inverse();
  for (auto at = cells_.begin(); at != cells_.end();) {
    Cell& cell = at->second;
    const Vector2d p_L = X_LM * Vector2d(cell.sum / cell.count);
    const double bearing =
        geometry::WrapToPi(std::atan2(p_L.y(), p_L.x()) - reading.angle_min - geometry::kPi) +
        geometry::kPi;  // 0 .. 2 pi
    const auto beam = static_cast<std::size_t>(std::lround(bearing / reading.angle_increment));
    const bool is_passed = hit.count(at->first) == 0 && p_L.norm() <= params_.range &&
                           beam < reading.ranges.size() &&
                           reading.ranges[beam] > p_L.norm() + params_.cell + kBehind;
    if (is_passed) cell.seen -= kGoneFaster * elapsed;
    has_changed = has_changed || (cell.is_taken && cell.seen <= 0.0);
    at = is_passed && cell.seen <= 0.0 ? cells_.erase(at) : std::next(at);
  }
  return has_changed;
}

/// Points of the cells that are taken, of one thing each.
std::vector<std::vector<Vector2d>> FloorWatch::Groups() const {
  std::vector<std::vector<Vector2d>> groups;
  for (const auto& [key, cell] : cells_) {
    if (!cell.is_taken) continue;
    std::vector<Vector2d> joined{cell.sum / cell.count};
    for (auto group = groups.begin(); group != groups.end();) {
      const bool is_near = std::any_of(group->begin(), group->end(), [&](const Vector2d& p) {
        return (p - joined.front()).norm() <= params_.gap;
      });
      if (is_near) joined.insert(joined.end(), group->begin(), group->end());
      group = is_near ? groups.erase(group) : std::next(group);
    }
    groups.push_back(std::move(joined));
  }
  return groups;
}

bool FloorWatch::IsFree(const Rectangle& box) const {
  const Polygon corners = geometry::CornersOf(box);
  return std::none_of(known_M_.begin(), known_M_.end(), [&](const Polygon& outline) {
    return geometry::Distance(corners, outline) <= 0.0;
  });
}

void FloorWatch::Box(std::vector<Vector2d> points, std::vector<Rectangle>* boxes) const {
  const Rectangle box = BoxAround(points);
  if (IsFree(box)) {
    boxes->push_back(box);
    return;
  }
  if (points.size() < 2) return;
  const int axis = box.size.x() >= box.size.y() ? 0 : 1;
  const geometry::Pose2 X_RM = box.X_PR.Inverse();
  std::sort(points.begin(), points.end(), [&](const Vector2d& a, const Vector2d& b) {
    return (X_RM * a)[axis] < (X_RM * b)[axis];
  });
  const auto middle = points.begin() + static_cast<long>(points.size() / 2);
  Box({points.begin(), middle}, boxes);
  Box({middle, points.end()}, boxes);
}

/// Things keep the name of the nearest one that they touch, and its box where it is alike.
void FloorWatch::Name(const std::vector<Rectangle>& boxes, double time) {
  const std::vector<Rectangle> old_boxes = std::exchange(boxes_, {});
  const std::vector<robot::SeenObject> old = std::exchange(things_, {});
  std::vector<std::pair<std::string, Rectangle>> named;
  std::vector<bool> is_used(old.size(), false);
  for (const Rectangle& box : boxes) {
    int nearest = -1;
    double least = 0.0;
    for (std::size_t i = 0; i < old.size(); ++i) {
      const double away = (old_boxes[i].X_PR.position() - box.X_PR.position()).norm();
      const bool touches = geometry::Distance(geometry::CornersOf(old_boxes[i]),
                                              geometry::CornersOf(box)) <= params_.min_change;
      if (is_used[i] || !touches || (nearest >= 0 && away >= least)) continue;
      nearest = static_cast<int>(i);
      least = away;
    }
    if (nearest >= 0) is_used[nearest] = true;
    const bool is_same = nearest >= 0 && AreAlike(old_boxes[nearest], box, params_.min_change);
    named.emplace_back(nearest >= 0 ? old[nearest].name : "", is_same ? old_boxes[nearest] : box);
  }
  for (std::size_t i = 0; i < old.size(); ++i)
    if (!is_used[i]) vanished_.push_back(old[i].name);
  const auto is_taken = [&](const std::string& name) {
    return std::any_of(named.begin(), named.end(),
                       [&](const auto& one) { return one.first == name; });
  };
  for (auto& [name, box] : named) {
    for (int number = 1; name.empty(); ++number) {
      const std::string next = "obstacle" + std::to_string(number);
      if (!is_taken(next)) name = next;
    }
  }
  std::sort(named.begin(), named.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [name, box] : named) {
    vanished_.erase(std::remove(vanished_.begin(), vanished_.end(), name), vanished_.end());
    boxes_.push_back(box);
    things_.push_back({name, world::UnknownBoxModel({box.size.x(), box.size.y(), params_.height}),
                       geometry::Lift(box.X_PR), time, ""});
  }
}

}  // namespace hires::sensing
