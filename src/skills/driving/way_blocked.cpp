#include "skills/driving/way_blocked.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "hires/base/text.h"
#include "hires/robot/link_bounds.h"
#include "skills/driving/by_height.h"
#include "skills/driving/cell_room.h"
#include "world/floor_level.h"

namespace hires::skills {
namespace {

using geometry::Pose2;
using navigation::Costmap;

constexpr double kFarthestObstacle = 2.0;  // [m] from a place that it blocks

/// "the base, 8.23 m long and 0.63 m wide with its padding,"
std::string SizeText(const geometry::Polygon& footprint) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& p_B : footprint) box.extend(p_B);
  return fmt::format("the base, {:.2f} m long and {:.2f} m wide with its padding,", box.sizes().x(),
                     box.sizes().y());
}

/// What is said of a drive's map.
class Explainer {
 public:
  Explainer(const DrivingContext& context, const Costmap& costmap)
      : context_(context), costmap_(costmap) {}

  bool IsUnknown(const Eigen::Vector2d& p_M) const {
    int column = 0, row = 0;
    costmap_.CellOf(p_M, &column, &row);
    return costmap_.Inside(column, row) && costmap_.cost(column, row) == navigation::kUnknownCost;
  }

  /// @pre inside the map
  bool IsTakenAt(const Eigen::Vector2d& p_M) const {
    int column = 0, row = 0;
    costmap_.CellOf(p_M, &column, &row);
    return IsTaken(costmap_, column, row);
  }

  /// Whether what is there is in the way of no more than a part of the base. @pre inside the map
  bool IsInLayer(const Eigen::Vector2d& p_M) const {
    return IsTakenAt(p_M) && !IsObstacle(costmap_, p_M);
  }

  bool IsOutside(const Eigen::Vector2d& p_M) const {
    int column = 0, row = 0;
    costmap_.CellOf(p_M, &column, &row);
    return !costmap_.Inside(column, row);
  }

  /// The middle of the nearest cell that is no room, within kFarthestObstacle.
  std::optional<Eigen::Vector2d> NearestObstacle(const Eigen::Vector2d& p_M) const {
    return NearestTaken(p_M, kFarthestObstacle, nullptr);
  }

  /// "; as it is headed the base reaches 1.36 m to the back, into 'post' (hall.world:2): turn it,
  /// or choose another place": what the base touches that would be far enough from a round one.
  std::string TouchText(const Pose2& X_MB) const {
    const geometry::Polygon base_M = geometry::Transformed(X_MB, context_.footprint);
    const double reach = geometry::CircumscribedRadius(context_.footprint);
    const auto touched = NearestTaken(X_MB.position(), reach + costmap_.resolution(), &base_M);
    if (!touched) return "";
    const Eigen::Vector2d p_B = Eigen::Rotation2Dd(-X_MB.yaw) * (*touched - X_MB.position());
    const bool is_along = std::abs(p_B.x()) >= std::abs(p_B.y());
    const Eigen::Vector2d side = is_along ? Eigen::Vector2d(std::copysign(1.0, p_B.x()), 0.0)
                                          : Eigen::Vector2d(0.0, std::copysign(1.0, p_B.y()));
    double farthest = 0.0;
    for (const auto& corner : context_.footprint) {
      farthest = std::max(farthest, corner.dot(side));
    }
    return fmt::format(
        "; as it is headed the base reaches {:.2f} m to the {}, into {}: turn it, or choose "
        "another place",
        farthest,
        is_along ? (side.x() > 0.0 ? "front" : "back") : (side.y() > 0.0 ? "left" : "right"),
        WhatIsAt(*touched));
  }

  /// Whether no floor bears a base in the cell there, and nothing stands in it.
  bool IsHole(const Eigen::Vector2d& p_M) const {
    if (!context_.holes) return false;
    int column = 0, row = 0;
    costmap_.CellOf(p_M, &column, &row);
    if (!costmap_.Inside(column, row)) return false;
    if (context_.holes->at(column, row) != world::Cell::kOccupied) return false;
    return !context_.obstacles || NearestOf(*context_.obstacles, CellAt(p_M), 0.0) == nullptr;
  }

  /// "'slab' (hall.world:4) ends 0.20 m from there": what bears a base nearest to a hole.
  std::string FloorEndText(const Eigen::Vector2d& p_M) const {
    const world::NamedOutline* nearest =
        NearestOf(*context_.floor, CellAt(p_M), std::numeric_limits<double>::infinity());
    if (nearest == nullptr) return "nothing bears it";
    const double distance = geometry::Distance(nearest->outline_M, CellAt(p_M));
    if (distance < costmap_.resolution()) return NameText(*nearest) + " ends there";
    return fmt::format("{} ends {:.2f} m from there", NameText(*nearest), distance);
  }

  /// "'wall::c0'", "unmapped ground", "a wall of the map": what has the cell there.
  std::string WhatIsAt(const Eigen::Vector2d& cell_M) const {
    if (IsUnknown(cell_M)) return "unmapped (unknown) ground";
    if (IsHole(cell_M)) return "a place where no floor bears the robot, " + FloorEndText(cell_M);
    if (!context_.obstacles) return "a wall of the map";
    const world::NamedOutline* nearest = NearestTo(cell_M);
    if (nearest == nullptr) return "a thing that stands about";
    return NameText(*nearest);
  }

  /// ": 'top' is 0.70 m to 0.75 m up, where the robot is 0.12 m wide, and its footprint counts at
  /// all heights": where the shapes of the robot at these heights are narrower than its footprint,
  /// and nothing else has the cell there; else empty.
  std::string HeightText(const Eigen::Vector2d& cell_M) const {
    const bool is_thing = context_.obstacles && !IsHole(cell_M);
    const world::NamedOutline* there = is_thing ? NearestTo(cell_M) : nullptr;
    if (there == nullptr) return "";
    Band heights{there->lower, there->upper};
    for (const world::NamedOutline& other : *context_.obstacles) {
      if (geometry::Distance(other.outline_M, CellAt(cell_M)) > 0.0) continue;
      heights = {std::min(heights.first, other.lower), std::max(heights.second, other.upper)};
    }
    const auto part = ShapesWithin(*context_.robot,
                                   {heights.first - kHeightSlack, heights.second + kHeightSlack});
    const bool is_wide =
        part && geometry::CircumscribedRadius(*part) >= LeastDistance() && !IsInLayer(cell_M);
    if (is_wide) return "";
    return fmt::format("; '{}' is {:.2f} m to {:.2f} m up, where the robot is {}{}", there->name,
                       heights.first, heights.second,
                       part ? fmt::format("{:.2f} m wide", WidthOf(*part)) : "not",
                       IsInLayer(cell_M) ? "" : ", but its footprint counts at all heights");
  }

  /// Whether it is no higher than what a base drives over whose shapes end above it.
  bool IsLow(const world::NamedOutline& thing) const {
    return thing.upper <= context_.params.min_obstacle_height;
  }

  /// Of each cell, whether low things alone are there, or so near that the map may have them there.
  std::vector<bool> LowCells() const {
    std::vector<bool> low(static_cast<std::size_t>(costmap_.width()) * costmap_.height(), false);
    if (!context_.obstacles) return low;
    for (const world::NamedOutline& thing : *context_.obstacles)
      if (IsLow(thing)) Mark(thing, costmap_.resolution(), true, &low);
    if (std::find(low.begin(), low.end(), true) == low.end()) return low;
    for (const world::NamedOutline& thing : *context_.obstacles)
      if (!IsLow(thing)) Mark(thing, 0.0, false, &low);
    return low;
  }

  /// "; it is 0.008 m high, ...": where a low thing has the cell there; else empty.
  std::string LowText(const Eigen::Vector2d& cell_M) const {
    const bool is_thing = context_.obstacles && !IsHole(cell_M);
    const world::NamedOutline* there = is_thing ? NearestTo(cell_M) : nullptr;
    if (there == nullptr || !IsLow(*there) || !robot::HasShapes(context_.robot->model)) return "";
    geometry::Aabb all;
    for (const geometry::Aabb& link : robot::LinkBounds(*context_.robot)) all.Include(link);
    return fmt::format(
        "; it is {:.3f} m high, and the robot's shapes, which reach down to {:.3f} m, touch what "
        "is "
        "higher than {:.3f} m: where it really rolls over that, lower the thing in the world, or "
        "have these shapes end higher in the robot's",
        there->upper, std::max(0.0, all.lower.z()), std::max(all.lower.z(), world::kFloorStep));
  }

  /// [m] of free room through a place, in the direction of what is nearest; none: it is wide.
  std::optional<double> WidthAt(const Eigen::Vector2d& p_M,
                                const Eigen::Vector2d& nearest_M) const {
    const Eigen::Vector2d towards = nearest_M - p_M;
    if (towards.norm() < 1e-9) return std::nullopt;
    const Eigen::Vector2d along = towards.normalized();
    const double ahead = FreeTowards(costmap_, p_M, along);
    const double behind = FreeTowards(costmap_, p_M, -along);
    if (behind >= kFarthestSide || ahead >= kFarthestSide) return std::nullopt;
    return ahead + behind;
  }

  /// [m] What is nearer than this is in the way of the base, however it is headed.
  double LeastDistance() const { return geometry::InscribedRadius(context_.footprint); }

  double NeededWidth() const { return NarrowestWidth(context_.footprint); }

  /// "it is 0.85 m wide there", by the things themselves where they are known: cells take up to one
  /// more at each side.
  /// @param left  across the way. @param by_cells  [m]
  std::string WidthText(const Eigen::Vector2d& p_M, const Eigen::Vector2d& left, double by_cells,
                        double needed) const {
    const auto by_things = WidthBetweenThings(p_M, left);
    const bool is_it = by_things && *by_things <= by_cells + 3.0 * costmap_.resolution();
    if (!is_it) return fmt::format("it is {:.2f} m wide there", by_cells);
    std::string text = fmt::format("it is {:.2f} m wide there", *by_things);
    if (*by_things >= needed)
      text +=
          fmt::format(" ({:.2f} m in the map's cells of {:g} m)", by_cells, costmap_.resolution());
    return text;
  }

  /// "the base is 0.53 m wide with its padding ('arm' reaches farthest)".
  std::string BaseText(double width) const {
    const robot::Robot& robot = *context_.robot;
    const std::string link = robot::WidestLink(robot, robot::LinkBounds(robot));
    return fmt::format(
        "the base is {:.2f} m wide{}", width,
        link.empty() ? "" : fmt::format(" with its padding ('{}' reaches farthest)", link));
  }

 private:
  /// @param within_M  cells that touch this alone count; null: all.
  std::optional<Eigen::Vector2d> NearestTaken(const Eigen::Vector2d& p_M, double farthest,
                                              const geometry::Polygon* within_M) const {
    const int reach = static_cast<int>(farthest / costmap_.resolution());
    int column = 0, row = 0;
    costmap_.CellOf(p_M, &column, &row);
    std::optional<Eigen::Vector2d> nearest;
    double least = std::numeric_limits<double>::infinity();
    for (int y = row - reach; y <= row + reach; ++y) {
      for (int x = column - reach; x <= column + reach; ++x) {
        if (!costmap_.Inside(x, y) || !IsTaken(costmap_, x, y)) continue;
        const Eigen::Vector2d centre_M = costmap_.CentreOf(x, y);
        const double distance = (centre_M - p_M).squaredNorm();
        if (distance >= least) continue;
        if (within_M && geometry::Distance(*within_M, CellAt(centre_M)) > 0.0) continue;
        least = distance;
        nearest = centre_M;
      }
    }
    return nearest;
  }

  /// [m] Through a place: to the nearest thing on either side, in that direction or nearly so. The
  /// place may lie a little before the passage.
  std::optional<double> WidthBetweenThings(const Eigen::Vector2d& p_M,
                                           const Eigen::Vector2d& left) const {
    constexpr double kTurned = 0.35, kTurnedStep = 0.0175;  // [rad]
    if (!context_.obstacles) return std::nullopt;
    double to_left = kFarthestSide, to_right = kFarthestSide;
    for (double turned = -kTurned; turned <= kTurned; turned += kTurnedStep) {
      const Eigen::Vector2d along = Eigen::Rotation2Dd(turned) * left;
      to_left = std::min(to_left, FreeOfThings(p_M, along));
      to_right = std::min(to_right, FreeOfThings(p_M, -along));
    }
    const double width = to_left + to_right;
    return width < kFarthestSide ? std::make_optional(width) : std::nullopt;
  }

  /// [m] from a point in a direction to the nearest thing; kFarthestSide: nothing is there.
  double FreeOfThings(const Eigen::Vector2d& p_M, const Eigen::Vector2d& along) const {
    double free = kFarthestSide;
    for (const world::NamedOutline& thing : *context_.obstacles) {
      const geometry::Polygon& corners = thing.outline_M;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const Eigen::Vector2d from = corners[i] - p_M;
        const Eigen::Vector2d edge = corners[(i + 1) % corners.size()] - corners[i];
        const double across = along.x() * edge.y() - along.y() * edge.x();
        if (std::abs(across) < 1e-12) continue;
        const double way = (from.x() * edge.y() - from.y() * edge.x()) / across;
        const double on_edge = (from.x() * along.y() - from.y() * along.x()) / across;
        if (way >= 0.0 && on_edge >= 0.0 && on_edge <= 1.0) free = std::min(free, way);
      }
    }
    return free;
  }

  /// Sets all cells that are no farther from a thing than `within` [m].
  void Mark(const world::NamedOutline& thing, double within, bool value,
            std::vector<bool>* cells) const {
    Eigen::Vector2d lower = thing.outline_M.front(), upper = lower;
    for (const Eigen::Vector2d& corner : thing.outline_M) {
      lower = lower.cwiseMin(corner);
      upper = upper.cwiseMax(corner);
    }
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(within + costmap_.resolution());
    int left = 0, below = 0, right = 0, above = 0;
    costmap_.CellOf(lower - margin, &left, &below);
    costmap_.CellOf(upper + margin, &right, &above);
    for (int row = std::max(0, below); row <= std::min(above, costmap_.height() - 1); ++row) {
      for (int column = std::max(0, left); column <= std::min(right, costmap_.width() - 1);
           ++column) {
        const geometry::Polygon cell = CellAt(costmap_.CentreOf(column, row));
        if (geometry::Distance(thing.outline_M, cell) > within) continue;
        (*cells)[static_cast<std::size_t>(row) * costmap_.width() + column] = value;
      }
    }
  }

  geometry::Polygon CellAt(const Eigen::Vector2d& cell_M) const {
    return skills::CellAt(costmap_, cell_M);
  }

  static std::string NameText(const world::NamedOutline& thing) {
    return fmt::format("'{}'{}", thing.name, thing.source.empty() ? "" : " (" + thing.source + ")");
  }

  /// What is nearest to a cell, no farther than `most` [m], of several the first; or null.
  static const world::NamedOutline* NearestOf(const std::vector<world::NamedOutline>& things,
                                              const geometry::Polygon& cell, double most) {
    const world::NamedOutline* nearest = nullptr;
    double least = most;
    for (const world::NamedOutline& thing : things) {
      const double distance = geometry::Distance(thing.outline_M, cell);
      if (distance > least || (nearest != nullptr && distance == least)) continue;
      nearest = &thing;
      least = distance;
    }
    return nearest;
  }

  /// What has a cell, of several the first; or null. @pre there are named obstacles
  const world::NamedOutline* NearestTo(const Eigen::Vector2d& cell_M) const {
    return NearestOf(*context_.obstacles, CellAt(cell_M), costmap_.resolution());
  }

  const DrivingContext& context_;
  const Costmap& costmap_;
};

/// From start to goal through what is in the way, through as little as can be.
class Intrusion {
 public:
  /// @param low  of each cell: what is there is less in the way than a wall
  Intrusion(const Costmap& costmap, std::vector<bool> low)
      : costmap_(costmap), low_(std::move(low)) {
    const std::size_t size = static_cast<std::size_t>(costmap.width()) * costmap.height();
    cost_.assign(size, std::numeric_limits<double>::infinity());
    parent_.assign(size, -1);
  }

  /// Cells from start to goal; empty where one of them is outside.
  std::vector<Eigen::Vector2d> Find(const Pose2& X_MStart, const Pose2& X_MGoal) {
    const int start = IndexOf(X_MStart), goal = IndexOf(X_MGoal);
    if (start < 0 || goal < 0) return {};
    open_.push({0.0, start});
    cost_[start] = 0.0;
    while (!open_.empty() && open_.top().second != goal) Expand();
    std::vector<Eigen::Vector2d> cells;
    for (int at = goal; at >= 0; at = parent_[at]) cells.push_back(CentreOf(at));
    std::reverse(cells.begin(), cells.end());
    return cells;
  }

 private:
  static constexpr double kNarrow = 1e3, kSolid = 1e6;  // what a cell costs that is no room

  int IndexOf(const Pose2& X_MB) const {
    int column = 0, row = 0;
    costmap_.CellOf(X_MB.position(), &column, &row);
    return costmap_.Inside(column, row) ? row * costmap_.width() + column : -1;
  }
  Eigen::Vector2d CentreOf(int cell) const {
    return costmap_.CentreOf(cell % costmap_.width(), cell / costmap_.width());
  }
  double CostOf(int column, int row) const {
    const std::uint8_t cost = costmap_.cost(column, row);
    return cost < navigation::kInscribedCost                                          ? 1.0
           : IsTaken(costmap_, column, row) && !low_[row * costmap_.width() + column] ? kSolid
                                                                                      : kNarrow;
  }
  void Expand() {
    const auto [cost, cell] = open_.top();
    open_.pop();
    if (cost > cost_[cell]) return;
    const int column = cell % costmap_.width(), row = cell / costmap_.width();
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (!costmap_.Inside(column + dx, row + dy)) continue;
        const int next = (row + dy) * costmap_.width() + column + dx;
        const double more = CostOf(column + dx, row + dy) * (dx != 0 && dy != 0 ? M_SQRT2 : 1.0);
        if (cost + more >= cost_[next]) continue;
        cost_[next] = cost + more;
        parent_[next] = cell;
        open_.push({cost_[next], next});
      }
    }
  }

  using Open = std::pair<double, int>;
  const Costmap& costmap_;
  std::vector<bool> low_;
  std::vector<double> cost_;
  std::vector<int> parent_;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
};

std::uint8_t CostAt(const Costmap& costmap, const Eigen::Vector2d& p_M) {
  int column = 0, row = 0;
  costmap.CellOf(p_M, &column, &row);
  return costmap.cost(column, row);
}

}  // namespace

std::string WhyBlocked(const DrivingContext& context, const Costmap& costmap,
                       const std::string& place, const Pose2& X_MB) {
  const Explainer explainer(context, costmap);
  const Eigen::Vector2d p_M = X_MB.position();
  const std::string where =
      fmt::format("the {} at x {:.2f} m, y {:.2f} m", place, p_M.x(), p_M.y());
  if (explainer.IsOutside(p_M)) {
    const Eigen::Vector2d lower = costmap.origin();
    const Eigen::Vector2d upper =
        lower + costmap.resolution() * Eigen::Vector2d(costmap.width(), costmap.height());
    return fmt::format("{} lies outside of the map, x {:.2f} .. {:.2f} m, y {:.2f} .. {:.2f} m",
                       where, lower.x(), upper.x(), lower.y(), upper.y());
  }
  if (explainer.IsUnknown(p_M))
    return fmt::format("{} is unmapped (unknown) in the map; map it, or choose another place",
                       where);
  if (explainer.IsHole(p_M)) {
    return fmt::format(
        "no floor bears the robot at x {:.2f} m, y {:.2f} m, the {}: {}; choose "
        "another place",
        p_M.x(), p_M.y(), place, explainer.FloorEndText(p_M));
  }
  const auto nearest = explainer.NearestObstacle(p_M);
  if (!nearest) return fmt::format("{} is not free", where);
  const std::string what = explainer.WhatIsAt(*nearest);
  const std::string heights = explainer.HeightText(*nearest);
  const double distance = (*nearest - p_M).norm();
  if (distance <= costmap.resolution())
    return fmt::format("{} lies in {}; choose another place, or move it{}", where, what, heights);
  if (explainer.IsInLayer(*nearest))
    return fmt::format("{} is {:.2f} m from {}{}", where, distance, what, heights);
  const double needed = explainer.NeededWidth();
  const auto width = explainer.WidthAt(p_M, *nearest);
  if (width && *width < needed) {
    return fmt::format("{} is too narrow, {:.2f} m wide beside {}; {}{}", where, *width, what,
                       explainer.BaseText(needed), heights);
  }
  const double clear = std::max(0.0, distance - 0.5 * costmap.resolution());
  if (clear > explainer.LeastDistance()) {
    return fmt::format("{} is {:.2f} m from {}{}{}", where, clear, what, explainer.TouchText(X_MB),
                       heights);
  }
  return fmt::format("{} is {:.2f} m from {}, wanted at least {:.2f} m; {}{}", where, clear, what,
                     explainer.LeastDistance(), explainer.BaseText(needed), heights);
}

std::string WhyStuck(const Costmap& costmap, const geometry::Polygon& footprint,
                     const Pose2& X_MB) {
  constexpr double kAround = 0.5;  // [m] from what the base takes up, however it is headed
  const double reach = geometry::CircumscribedRadius(footprint) + kAround;
  const int cells = static_cast<int>(std::ceil(reach / costmap.resolution()));
  int column = 0, row = 0, num_unknown = 0;
  costmap.CellOf(X_MB.position(), &column, &row);
  double to_unknown = reach, to_known = reach;
  Eigen::Vector2d nearest = X_MB.position();
  for (int y = row - cells; y <= row + cells; ++y) {
    for (int x = column - cells; x <= column + cells; ++x) {
      if (!costmap.Inside(x, y) || !IsTaken(costmap, x, y)) continue;
      const double distance = (costmap.CentreOf(x, y) - X_MB.position()).norm();
      if (costmap.cost(x, y) != navigation::kUnknownCost) {
        to_known = std::min(to_known, distance);
        continue;
      }
      num_unknown += distance <= reach ? 1 : 0;
      if (distance >= to_unknown) continue;
      to_unknown = distance;
      nearest = costmap.CentreOf(x, y);
    }
  }
  if (num_unknown == 0 || to_known < to_unknown) return {};
  return fmt::format(
      "{} unmapped (unknown) cell{} of the map within {:.1f} m of x {:.2f} m, y {:.2f} m, the "
      "nearest at x {:.2f} m, y {:.2f} m, count{} as obstacles; map them, or let what is unknown "
      "count as free (driving.costmap.unknown_is_lethal: false)",
      num_unknown, num_unknown == 1 ? "" : "s", reach, X_MB.x, X_MB.y, nearest.x(), nearest.y(),
      num_unknown == 1 ? "s" : "");
}

std::optional<std::string> WhyOffMap(const Costmap& costmap, const geometry::Polygon& footprint,
                                     const std::string& place, const Pose2& X_MB, double slack) {
  const Eigen::Vector2d lower = costmap.origin();
  const Eigen::Vector2d upper =
      lower + costmap.resolution() * Eigen::Vector2d(costmap.width(), costmap.height());
  double beyond = 0.0;
  for (const Eigen::Vector2d& p_M : geometry::Transformed(X_MB, footprint))
    beyond = std::max({beyond, (lower - p_M).maxCoeff(), (p_M - upper).maxCoeff()});
  if (beyond <= slack) return std::nullopt;
  return fmt::format(
      "the {} at x {:.2f} m, y {:.2f} m lies at the map's end, x {:.2f} .. {:.2f} m, y {:.2f} .. "
      "{:.2f} m: {} reaches {:.2f} m beyond it, where all counts as an obstacle; choose another "
      "place, or map more",
      place, X_MB.x, X_MB.y, lower.x(), upper.x(), lower.y(), upper.y(), SizeText(footprint),
      beyond);
}

std::string WhyNoTurn(const DrivingContext& context, const Costmap& costmap,
                      const geometry::Polygon& footprint, const Pose2& X_MB) {
  constexpr int kEnough = 90, kWhole = 180;  // [deg]
  const Explainer explainer(context, costmap);
  int widest = 0;
  std::vector<std::string> sides;
  for (const int sign : {1, -1}) {
    int angle = 1;
    geometry::Polygon outline_M;
    for (; angle < kWhole; ++angle) {
      outline_M = geometry::Transformed({X_MB.x, X_MB.y, X_MB.yaw + sign * angle * M_PI / kWhole},
                                        footprint);
      if (costmap.CostBelow(navigation::Footprint(outline_M)) >= navigation::kLethalCost) break;
    }
    widest = std::max(widest, angle - 1);
    const auto touched = NearestTakenTo(costmap, outline_M, costmap.resolution());
    sides.push_back(fmt::format("{} degrees to the {} it touches {}", angle,
                                sign > 0 ? "left" : "right",
                                touched ? explainer.WhatIsAt(touched->middle) : "the map's end"));
  }
  if (widest >= kEnough) return "";
  return fmt::format("{} cannot turn at x {:.2f} m, y {:.2f} m: {}", SizeText(footprint), X_MB.x,
                     X_MB.y, base::Join(sides, ", "));
}

std::string WhyNoWay(const DrivingContext& context, const Costmap& costmap,
                     const navigation::Footprint& footprint, const Pose2& X_MB,
                     const std::vector<Pose2>& path) {
  const auto nearer = [&](const Pose2& a, const Pose2& b) {
    return (a.position() - X_MB.position()).norm() < (b.position() - X_MB.position()).norm();
  };
  for (auto pose = std::min_element(path.begin(), path.end(), nearer); pose != path.end(); ++pose) {
    if (costmap.FootprintCost(footprint, *pose) < navigation::kLethalCost) continue;
    const auto touched = NearestTakenTo(costmap, geometry::Transformed(*pose, footprint.outline),
                                        costmap.resolution());
    return fmt::format(
        "its way is blocked at x {:.2f} m, y {:.2f} m by {}", pose->x, pose->y,
        touched ? Explainer(context, costmap).WhatIsAt(touched->middle) : "the map's end");
  }
  return "";
}

std::string WhyNoMotion(const DrivingContext& context, const Costmap& costmap,
                        const geometry::Polygon& footprint, const Pose2& X_MB) {
  constexpr double kNear = 0.1;  // [m] What is farther from a base that stands is not in its way.
  const auto next = NearestTakenTo(costmap, geometry::Transformed(X_MB, footprint), kNear);
  if (!next) return "";
  return fmt::format(
      "{} finds no motion at x {:.2f} m, y {:.2f} m, yaw {:.2f} rad that touches nothing: {} is "
      "{:.2f} m from it",
      SizeText(footprint), X_MB.x, X_MB.y, X_MB.yaw,
      Explainer(context, costmap).WhatIsAt(next->middle), next->distance);
}

std::string WhyNoPath(const DrivingContext& context, const Costmap& costmap, const Pose2& X_MStart,
                      const Pose2& X_MGoal, const NarrowPlace* narrow) {
  const Explainer explainer(context, costmap);
  const auto ends_at = [](const Eigen::Vector2d& p_M) {
    return fmt::format("the way ends at x {:.2f} m, y {:.2f} m", p_M.x(), p_M.y());
  };
  const auto too_narrow = [&](const Eigen::Vector2d& p_M, const Eigen::Vector2d& left, double width,
                              double needed) {
    const auto nearest = explainer.NearestObstacle(p_M);
    return fmt::format("{}: {}{}; {}{}", ends_at(p_M),
                       explainer.WidthText(p_M, left, width, needed),
                       nearest ? " beside " + explainer.WhatIsAt(*nearest) : "",
                       explainer.BaseText(needed), nearest ? explainer.HeightText(*nearest) : "");
  };
  if (narrow) {
    const double yaw = narrow->X_MW.yaw;
    return too_narrow(narrow->X_MW.position(), {-std::sin(yaw), std::cos(yaw)}, narrow->width,
                      narrow->footprint_width);
  }
  const std::vector<Eigen::Vector2d> cells =
      Intrusion(costmap, explainer.LowCells()).Find(X_MStart, X_MGoal);
  const auto is_room = [&](const Eigen::Vector2d& p_M) {
    return CostAt(costmap, p_M) < navigation::kInscribedCost;
  };
  auto last = std::find_if_not(cells.begin(), cells.end(), is_room);
  if (last == cells.end()) {
    return fmt::format("no way that this base can steer leads to x {:.2f} m, y {:.2f} m", X_MGoal.x,
                       X_MGoal.y);
  }
  const Eigen::Vector2d end = last == cells.begin() ? *last : *(last - 1);
  const auto beyond = std::find_if(last, cells.end(), is_room);
  const auto solid = std::find_if(
      last, beyond, [&](const Eigen::Vector2d& p_M) { return explainer.IsTakenAt(p_M); });
  if (solid != beyond) {
    const std::string low = explainer.LowText(*solid);
    return fmt::format("{}; beyond it is {}{}", ends_at(end), explainer.WhatIsAt(*solid),
                       low.empty() ? explainer.HeightText(*solid) : low);
  }
  std::optional<double> least;
  Eigen::Vector2d narrowest = end, left(0.0, 1.0);
  for (auto cell = last; cell != beyond; ++cell) {
    const auto nearest = explainer.NearestObstacle(*cell);
    const auto width = nearest ? explainer.WidthAt(*cell, *nearest) : std::nullopt;
    if (!width || (least && *width >= *least)) continue;
    least = width;
    narrowest = *cell;
    left = (*nearest - *cell).normalized();
  }
  const double needed = explainer.NeededWidth();
  if (!least)
    return fmt::format("{}: there is too little room; {}", ends_at(end),
                       explainer.BaseText(needed));
  return too_narrow(narrowest, left, *least, needed);
}

}  // namespace hires::skills
