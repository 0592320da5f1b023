#include "perception/tabletop/on_table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "hires/perception/depth_sensor.h"
#include "perception/tabletop/part_shape.h"

namespace hires::perception {
namespace {

constexpr double kPlaneCell = 0.02;     // [m] of the plane, in which what is below a part counts
constexpr double kFarthestBelow = 0.3;  // [m]
constexpr double kBelow = 4.0;          // [DepthNoise] from which on a point is below the plane
constexpr double kMinBelow = 0.01;      // [m] likewise
constexpr double kFoot = 0.05;         // [m] above the plane, up to which a part reaches down to it
constexpr double kMostBelow = 0.2;     // of its cells there, in which something is below the plane
constexpr double kMostThrough = 0.3;   // of a part's feet, where the camera looks through the plane
constexpr double kLargestThing = 0.6;  // [m] what stands on tables; furniture and walls are larger
constexpr int kTouching = 20;          // pairs of surfels; things that are apart have none

using PlaneCell = std::pair<int, int>;

PlaneCell PlaneCellOf(const Eigen::Vector2d& p) {
  return {static_cast<int>(std::floor(p.x() / kPlaneCell)),
          static_cast<int>(std::floor(p.y() / kPlaneCell))};
}

double ToleranceBelow(const Table& table, const Eigen::Vector3d& p_C) {
  return std::max(kMinBelow, kBelow * table.noise * DepthNoise(p_C.z()));
}

std::set<PlaneCell> CellsBelow(const PointCloud& cloud, const Table& table) {
  std::set<PlaneCell> cells;
  for (const Eigen::Vector3f& point : cloud.points) {
    if (!IsMeasured(point)) continue;
    const Eigen::Vector3d p = point.cast<double>();
    const double depth = -table.HeightOf(p);
    if (depth > ToleranceBelow(table, p) && depth < kFarthestBelow)
      cells.insert(PlaneCellOf(table.FromAbove(p)));
  }
  return cells;
}

/// Evidence about one part.
struct Part {
  std::vector<int> members{};  // surfels
  bool is_within{false}, is_large{false}, is_beside{false};
  bool goes_below{false}, hangs{false};
};

class Judge {
 public:
  Judge(const PointCloud& cloud, const Table& table, const SurfelCloud& all, const SeenDepth& seen)
      : cloud_(cloud), table_(table), all_(all), seen_(seen), below_(CellsBelow(cloud, table)) {}

  void Look(Part* part) const;

 private:
  bool IsLarge(const Part& part) const;
  std::set<PlaneCell> FeetOf(const Part& part) const;
  bool GoesOnBelow(const std::set<PlaneCell>& feet) const;
  bool IsSeenThrough(const Part& part) const;

  const PointCloud& cloud_;
  const Table& table_;
  const SurfelCloud& all_;
  const SeenDepth& seen_;
  const std::set<PlaneCell> below_;
};

void Judge::Look(Part* part) const {
  const auto within = std::count_if(part->members.begin(), part->members.end(), [&](int i) {
    return geometry::Contains(table_.outline, table_.FromAbove(all_.surfels[i].p_C));
  });
  part->is_within = 2 * within >= static_cast<std::ptrdiff_t>(part->members.size());
  const std::set<PlaneCell> feet = FeetOf(*part);
  part->goes_below = GoesOnBelow(feet);
  part->hangs = feet.empty();
  if (part->is_within) {  // but for walls that the table's outline reaches into
    part->is_large = part->is_beside = part->goes_below && IsLarge(*part);
    return;
  }
  part->is_large = IsLarge(*part);
  part->is_beside = part->is_large || part->goes_below || IsSeenThrough(*part);
}

bool Judge::IsLarge(const Part& part) const {
  const auto shape = ShapeOf(all_, part.members, table_);
  if (!shape) return false;
  double largest = 0.0;
  for (const Eigen::Vector2d& a : shape->outline)
    for (const Eigen::Vector2d& b : shape->outline) largest = std::max(largest, (a - b).norm());
  return largest > kLargestThing;
}

std::set<PlaneCell> Judge::FeetOf(const Part& part) const {
  std::set<PlaneCell> feet;
  for (const int i : part.members) {
    const Eigen::Vector3d& p_C = all_.surfels[i].p_C;
    if (table_.HeightOf(p_C) < kFoot) feet.insert(PlaneCellOf(table_.FromAbove(p_C)));
  }
  return feet;
}

bool Judge::GoesOnBelow(const std::set<PlaneCell>& feet) const {
  const auto below = std::count_if(feet.begin(), feet.end(),
                                   [&](const PlaneCell& cell) { return below_.count(cell); });
  return static_cast<double>(below) > kMostBelow * static_cast<double>(feet.size());
}

bool Judge::IsSeenThrough(const Part& part) const {
  int through = 0;
  for (const int i : part.members) {
    const Eigen::Vector3d foot = table_.Lift(table_.FromAbove(all_.surfels[i].p_C));
    const int point = foot.z() > 0.0 ? seen_.PointTowards(foot) : -1;
    if (point < 0) continue;
    const Eigen::Vector3d p = cloud_.points[point].cast<double>();
    through += -table_.HeightOf(p) > ToleranceBelow(table_, p);
  }
  return through > kMostThrough * static_cast<double>(part.members.size());
}

// Pairs of neighbouring surfels that some have with each part.
std::map<int, int> TouchingOf(const SurfelCloud& all, const std::vector<int>& members,
                              const std::vector<int>& part) {
  std::map<int, int> pairs;
  for (const int i : members)
    for (const int j : all.neighbours[i])
      if (part[j] >= 0) ++pairs[part[j]];
  return pairs;
}

}  // namespace

std::vector<int> WithoutBeside(const PointCloud& cloud, const Table& table, const SurfelCloud& all,
                               const SeenDepth& seen, Outline outline, std::vector<int> part) {
  std::map<int, Part> parts;
  for (std::size_t i = 0; i < part.size(); ++i)
    if (part[i] >= 0) parts[part[i]].members.push_back(static_cast<int>(i));
  const Judge judge(cloud, table, all, seen);
  for (auto& [number, one] : parts) judge.Look(&one);
  std::vector<int> large;
  for (auto& [number, one] : parts) {
    if (one.is_large) large.push_back(number);
    one.is_beside = one.is_beside || (outline == Outline::kWhole && !one.is_within);
  }
  while (!large.empty()) {  // what hangs together with walls and other furniture
    const std::map<int, int> touching = TouchingOf(all, parts.at(large.back()).members, part);
    large.pop_back();
    for (const auto& [number, pairs] : touching) {
      Part& one = parts.at(number);
      const bool may_stand = one.is_within && !one.goes_below && !one.hangs;
      if (may_stand || one.is_large || pairs <= kTouching) continue;
      one.is_large = one.is_beside = true;
      large.push_back(number);
    }
  }
  for (int& one : part)
    if (one >= 0 && parts[one].is_beside) one = -1;
  return part;
}

}  // namespace hires::perception
