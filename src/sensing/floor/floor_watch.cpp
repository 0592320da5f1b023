#include "hires/sensing/floor_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

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
constexpr double kReach = 2.0;       // [m] above the floor, of what clouds are compared with
constexpr int kClouds = 2;           // that show a thing before it counts, and its place empty
constexpr double kLeast = 0.1;  // [m] height of things: lower ones would be driven over in rollouts

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
bool CoverEachOther(const Rectangle& a, const Rectangle& b, double tolerance) {
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
                       std::shared_ptr<const robot::Robot> robot, const FloorWatchParams& params,
                       const GroundWatchParams& ground)
    : params_(params),
      footprint_(geometry::Padded(robot->profile.footprint, robot->profile.footprint_padding)),
      known_M_(world::OutlinesInBand(*world, nullptr, kMinHeight, params.height)),
      map_(MapOf(*world, params.height)),
      state_(state),
      scans_(state) {
  if (!ground.is_enabled) return;
  ground_ = std::make_unique<GroundWatch>(
      state, std::move(robot), std::make_shared<const navigation::Costmap>(MapOf(*world, kReach)),
      ground);
}

Receipt FloorWatch::OnScan(double stamp, const std::string& frame, robot::ScanReading reading) {
  return scans_.OnScan(stamp, frame, std::move(reading));
}

bool FloorWatch::Update(double time) {
  const bool is_new = TakeScan(time);
  if (!TakeCloud(time) && !is_new) return false;
  std::vector<Thing> boxes;
  for (std::vector<Spot>& group : Groups()) Box(std::move(group), &boxes);
  const std::vector<std::string> gone = vanished_;
  const std::vector<Thing> before = boxes_;
  Name(boxes, time);
  const auto same = [](const Thing& a, const Thing& b) {
    return a.box.size == b.box.size && a.box.X_PR.position() == b.box.X_PR.position() &&
           a.height == b.height;
  };
  return gone != vanished_ ||
         !std::equal(before.begin(), before.end(), boxes_.begin(), boxes_.end(), same);
}

FloorWatch::Key FloorWatch::KeyOf(const Vector2d& p_M) const {
  return {std::lround(std::floor(p_M.x() / params_.cell)),
          std::lround(std::floor(p_M.y() / params_.cell))};
}

/// @return whether cells were taken or given up.
bool FloorWatch::TakeScan(double time) {
  const auto scan = scans_.Take(time);
  if (!scan) return false;
  const double elapsed = std::clamp(scan->stamp - time_, 0.0, kLongestPause);
  time_ = scan->stamp;
  return Count(*scan, elapsed);
}

/// @return likewise, or whether one is higher or lower now.
bool FloorWatch::TakeCloud(double time) {
  if (!ground_) return false;
  const auto now = state_->At(time);
  if (!now || !ground_->Update(*now)) return false;
  bool has_changed = false;
  for (const GroundSpot& spot : ground_->reading().spots) {
    if (spot.lowest > params_.height || IsExplained(map_, spot.p_M, params_.tolerance)) continue;
    Swept& swept = swept_[spot.cell];
    const double height = spot.highest < 0.0 ? params_.height : std::max(spot.highest, kLeast);
    swept.clouds = std::min(swept.clouds + 1, kClouds);
    has_changed = has_changed || swept.clouds == kClouds;
    swept.is_taken = swept.is_taken || swept.clouds == kClouds;
    swept.p_M = spot.p_M;
    swept.height = height;
  }
  return ForgetSwept(ground_->reading()) || has_changed;
}

/// Gives up the cells through which beams went to the floor.
bool FloorWatch::ForgetSwept(const GroundReading& reading) {
  std::set<GroundCell> seen;
  for (const GroundSpot& spot : reading.spots) seen.insert(spot.cell);
  bool has_changed = false;
  for (auto at = swept_.begin(); at != swept_.end();) {
    Swept& swept = at->second;
    const bool is_passed = seen.count(at->first) == 0 && IsPassed(swept, reading);
    if (is_passed) --swept.clouds;
    has_changed = has_changed || (swept.is_taken && swept.clouds <= 0);
    at = swept.clouds <= 0 ? swept_.erase(at) : std::next(at);
  }
  return has_changed;
}

/// Whether the floor is seen at a cell, or so little behind it that the beam went through what
/// stood there, below the middle of its height.
bool FloorWatch::IsPassed(const Swept& swept, const GroundReading& reading) const {
  const double edge = ground_->cell();
  const Vector2d eye_M = reading.eye_M.head<2>();
  const Vector2d to_cell = swept.p_M - eye_M;
  const double away = to_cell.norm();
  if (away < edge) return false;
  const double share = 1.0 - 0.5 * swept.height / std::max(reading.eye_M.z(), edge);
  const double farthest = share > 0.0 ? away / share : std::numeric_limits<double>::infinity();
  return std::any_of(reading.clear.begin(), reading.clear.end(), [&](const GroundCell& cell) {
    const Vector2d to_floor =
        edge * (Vector2d(cell.first, cell.second).array() + 0.5).matrix() - eye_M;
    const double along = to_floor.dot(to_cell) / away;
    const double beside = (to_floor.x() * to_cell.y() - to_floor.y() * to_cell.x()) / away;
    return std::abs(beside) <= edge && along >= away - 0.5 * edge && along <= farthest + 0.5 * edge;
  });
}

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

std::vector<FloorWatch::Spot> FloorWatch::Taken() const {
  std::vector<Spot> spots;
  for (const auto& [key, cell] : cells_)
    if (cell.is_taken) spots.push_back({cell.sum / cell.count, 0.0});
  for (const auto& [key, swept] : swept_)
    if (swept.is_taken) spots.push_back({swept.p_M, swept.height});
  return spots;
}

/// Cells that are taken, of one thing each.
std::vector<std::vector<FloorWatch::Spot>> FloorWatch::Groups() const {
  std::vector<std::vector<Spot>> groups;
  for (const Spot& spot : Taken()) {
    std::vector<Spot> joined{spot};
    for (auto group = groups.begin(); group != groups.end();) {
      const bool is_near = std::any_of(group->begin(), group->end(), [&](const Spot& other) {
        return (other.p_M - spot.p_M).norm() <= params_.gap;
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

void FloorWatch::Box(std::vector<Spot> spots, std::vector<Thing>* boxes) const {
  std::vector<Vector2d> points;
  double height = 0.0;
  for (const Spot& spot : spots) {
    points.push_back(spot.p_M);
    height = std::max(height, spot.height);
  }
  const Rectangle box = BoxAround(points);
  if (IsFree(box)) {
    boxes->push_back({box, height > 0.0 ? height : params_.height});
    return;
  }
  if (spots.size() < 2) return;
  const int axis = box.size.x() >= box.size.y() ? 0 : 1;
  const geometry::Pose2 X_RM = box.X_PR.Inverse();
  std::sort(spots.begin(), spots.end(), [&](const Spot& a, const Spot& b) {
    return (X_RM * a.p_M)[axis] < (X_RM * b.p_M)[axis];
  });
  const auto middle = spots.begin() + static_cast<long>(spots.size() / 2);
  Box({spots.begin(), middle}, boxes);
  Box({middle, spots.end()}, boxes);
}

bool FloorWatch::AreAlike(const Thing& a, const Thing& b) const {
  return CoverEachOther(a.box, b.box, params_.min_change) &&
         std::abs(a.height - b.height) <= params_.min_change;
}

/// Things keep the name of the nearest one that they touch, and its box where it is alike.
void FloorWatch::Name(const std::vector<Thing>& boxes, double time) {
  const std::vector<Thing> old_boxes = std::exchange(boxes_, {});
  const std::vector<robot::SeenObject> old = std::exchange(things_, {});
  std::vector<std::pair<std::string, Thing>> named;
  std::vector<bool> is_used(old.size(), false);
  for (const Thing& thing : boxes) {
    const Rectangle& box = thing.box;
    int nearest = -1;
    double least = 0.0;
    for (std::size_t i = 0; i < old.size(); ++i) {
      const double away = (old_boxes[i].box.X_PR.position() - box.X_PR.position()).norm();
      const bool touches = geometry::Distance(geometry::CornersOf(old_boxes[i].box),
                                              geometry::CornersOf(box)) <= params_.min_change;
      if (is_used[i] || !touches || (nearest >= 0 && away >= least)) continue;
      nearest = static_cast<int>(i);
      least = away;
    }
    if (nearest >= 0) is_used[nearest] = true;
    const bool is_same = nearest >= 0 && AreAlike(old_boxes[nearest], thing);
    named.emplace_back(nearest >= 0 ? old[nearest].name : "", is_same ? old_boxes[nearest] : thing);
  }
  for (std::size_t i = 0; i < old.size(); ++i)
    if (!is_used[i]) vanished_.push_back(old[i].name);
  const auto is_taken = [&](const std::string& name) {
    return std::any_of(named.begin(), named.end(),
                       [&](const auto& one) { return one.first == name; });
  };
  for (auto& [name, thing] : named) {
    for (int number = 1; name.empty(); ++number) {
      const std::string next = "obstacle" + std::to_string(number);
      if (!is_taken(next)) name = next;
    }
  }
  std::sort(named.begin(), named.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [name, thing] : named) {
    vanished_.erase(std::remove(vanished_.begin(), vanished_.end(), name), vanished_.end());
    const auto& [box, height] = thing;
    boxes_.push_back(thing);
    things_.push_back({name, world::UnknownBoxModel({box.size.x(), box.size.y(), height}),
                       geometry::Lift(box.X_PR), time, ""});
  }
}

}  // namespace hires::sensing
