#include "hires/navigation/costmap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hires/base/check.h"

namespace hires::navigation {
namespace {

struct Interval {
  double lower{std::numeric_limits<double>::infinity()};
  double upper{-std::numeric_limits<double>::infinity()};
  void Include(double value) {
    lower = std::min(lower, value);
    upper = std::max(upper, value);
  }
};

/// First and last cell that an interval of positions [cells] shares more than a point with.
std::pair<int, int> CellsOf(const Interval& interval) {
  const double bound = 1e9;  // keeps far-away outlines within int
  const int first = static_cast<int>(std::floor(std::clamp(interval.lower, -bound, bound)));
  const int last = static_cast<int>(std::ceil(std::clamp(interval.upper, -bound, bound))) - 1;
  return {first, std::max(first, last)};
}

/// The x-range of the part of a segment that lies within y_lower..y_upper. @pre low lies below high
void IncludeClipped(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double y_lower,
                    double y_upper, Interval* range) {
  if (high.y() < y_lower || low.y() > y_upper) return;
  const bool cut_below = low.y() < y_lower;
  const bool cut_above = high.y() > y_upper;
  const double slope = cut_below || cut_above ? (high.x() - low.x()) / (high.y() - low.y()) : 0.0;
  range->Include(cut_below ? low.x() + slope * (y_lower - low.y()) : low.x());
  range->Include(cut_above ? low.x() + slope * (y_upper - low.y()) : high.x());
}

/// The rows from first to last that a convex outline reaches, with the x-range in each [m].
struct Spans {
  int first{0}, last{-1};
  std::vector<Interval> x_ranges;  // by row, from the first
};

/// Each edge adds to the rows that it passes, and one more for rounding.
void IncludeEdge(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Costmap& costmap,
                 Spans* spans) {
  const double resolution = costmap.resolution(), y_origin = costmap.origin().y();
  const Eigen::Vector2d& low = a.y() <= b.y() ? a : b;
  const Eigen::Vector2d& high = a.y() <= b.y() ? b : a;
  Interval y_range;
  y_range.Include((low.y() - y_origin) / resolution);
  y_range.Include((high.y() - y_origin) / resolution);
  const auto [lowest, highest] = CellsOf(y_range);
  for (int row = std::max(lowest - 1, spans->first); row <= std::min(highest + 1, spans->last);
       ++row) {
    const double y = y_origin + row * resolution;
    IncludeClipped(low, high, y, y + resolution, &spans->x_ranges[row - spans->first]);
  }
}

/// Calls visit(row, first column, last column) for all of the map's rows that a convex outline
/// reaches. Columns may lie outside the map.
template <typename Visit>
void ForEachSpan(const geometry::Polygon& outline_M, const Costmap& costmap, const Visit& visit) {
  const double resolution = costmap.resolution(), x_origin = costmap.origin().x();
  Interval y_range;
  for (const Eigen::Vector2d& p : outline_M) {
    y_range.Include((p.y() - costmap.origin().y()) / resolution);
  }
  const auto [lowest, highest] = CellsOf(y_range);
  static thread_local Spans spans;  // scratch: this runs for thousands of poses a second
  spans.first = std::max(lowest, 0);
  spans.last = std::min(highest, costmap.height() - 1);
  if (spans.last < spans.first) return;
  spans.x_ranges.assign(static_cast<std::size_t>(spans.last - spans.first) + 1, Interval());
  for (std::size_t i = 0; i < outline_M.size(); ++i) {
    IncludeEdge(outline_M[i], outline_M[i + 1 == outline_M.size() ? 0 : i + 1], costmap, &spans);
  }
  for (int row = spans.first; row <= spans.last; ++row) {
    const Interval& x_range = spans.x_ranges[row - spans.first];
    if (x_range.lower > x_range.upper) continue;  // rounding at the outline's very end
    const auto [first, last] =
        CellsOf({(x_range.lower - x_origin) / resolution, (x_range.upper - x_origin) / resolution});
    visit(row, first, last);
  }
}

// Far enough to stand for "no obstacle", small enough for sums in 64 bits to stay exact.
constexpr std::int64_t kFar = std::int64_t{1} << 40;

/// Squared distances to the nearest zero of a line of squared distances: the lower envelope of
/// parabolas [Felzenszwalb, Huttenlocher 2012, Theory of Computing 8:415-428], in integers.
class LineTransform {
 public:
  explicit LineTransform(int longest) : apex_(longest), start_(longest), height_(longest) {}

  /// Transforms the `count` values at line[0], line[stride], ... in place.
  void operator()(std::int64_t* line, int count, std::ptrdiff_t stride) {
    int last = -1;
    for (int q = 0; q < count; ++q) {
      height_[q] = line[q * stride];
      if (height_[q] >= kFar) continue;
      while (last >= 0 && FirstBelow(apex_[last], q) <= start_[last]) --last;
      const std::int64_t start = last < 0 ? 0 : FirstBelow(apex_[last], q);
      if (start >= count) continue;
      apex_[++last] = q;
      start_[last] = start;
    }
    for (int q = 0, k = 0; q < count && last >= 0; ++q) {
      while (k < last && start_[k + 1] <= q) ++k;
      const std::int64_t offset = q - apex_[k];
      line[q * stride] = offset * offset + height_[apex_[k]];
    }
  }

 private:
  /// The first place where the parabola of `right` lies below that of `left` (left < right).
  std::int64_t FirstBelow(std::int64_t left, std::int64_t right) const {
    const std::int64_t numerator = right * right + height_[right] - left * left - height_[left];
    const std::int64_t denominator = 2 * (right - left);
    return numerator < 0 ? 0 : numerator / denominator + 1;
  }

  std::vector<std::int64_t> apex_, start_, height_;
};

}  // namespace

geometry::Polygon PaddedFromMiddle(const geometry::Polygon& part, double padding) {
  if (part.empty()) return part;
  Eigen::Vector2d lower = part.front(), upper = part.front();
  for (const Eigen::Vector2d& p : part) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  const Eigen::Vector2d middle = 0.5 * (lower + upper);
  geometry::Polygon moved = part;
  for (Eigen::Vector2d& p : moved) p -= middle;
  moved = geometry::Padded(moved, padding);
  for (Eigen::Vector2d& p : moved) p += middle;
  return moved;
}

Footprint Padded(const Footprint& footprint, double padding) {
  Footprint padded(geometry::Padded(footprint.outline, padding));
  for (const geometry::Polygon& part : footprint.by_layer)
    padded.by_layer.push_back(PaddedFromMiddle(part, padding));
  return padded;
}

Footprint Transformed(const geometry::Pose2& X_AB, const Footprint& footprint_B) {
  Footprint footprint_A(geometry::Transformed(X_AB, footprint_B.outline));
  for (const geometry::Polygon& part : footprint_B.by_layer)
    footprint_A.by_layer.push_back(geometry::Transformed(X_AB, part));
  return footprint_A;
}

Costmap::Costmap(const world::OccupancyGrid& grid, double inscribed_radius,
                 const CostmapParams& params)
    : resolution_(grid.resolution),
      width_(grid.width),
      height_(grid.height),
      origin_(grid.origin),
      inscribed_radius_(inscribed_radius),
      params_(params) {
  HIRES_CHECK(resolution_ > 0.0 && width_ > 0 && height_ > 0, "a costmap needs cells");
  HIRES_CHECK(grid.cells.size() == static_cast<std::size_t>(width_) * height_,
              "a grid has width * height cells");
  HIRES_CHECK(inscribed_radius >= 0.0 && params.inflation_radius >= 0.0 &&
                  params.cost_scaling_factor >= 0.0 && std::isfinite(inscribed_radius) &&
                  std::isfinite(params.inflation_radius),
              "radii and scaling factor of a costmap are finite and not negative");
  SetCostsFrom(grid);
}

void Costmap::SetCostsFrom(const world::OccupancyGrid& grid) {
  std::vector<std::int64_t> squared(grid.cells.size(), kFar);
  const auto blocks = [this](world::Cell cell) {
    return cell == world::Cell::kOccupied ||
           (cell == world::Cell::kUnknown && params_.unknown_is_lethal);
  };
  for (std::size_t i = 0; i < squared.size(); ++i) {
    if (blocks(grid.cells[i])) squared[i] = 0;
  }
  LineTransform transform(std::max(width_, height_));
  for (int column = 0; column < width_; ++column) transform(&squared[column], height_, width_);
  costs_.resize(squared.size());
  for (int row = 0; row < height_; ++row) {
    std::int64_t* line = &squared[static_cast<std::size_t>(row) * width_];
    transform(line, width_, 1);
  }
  for (std::size_t i = 0; i < squared.size(); ++i) {
    costs_[i] = squared[i] >= kFar
                    ? kFreeCost
                    : CostAt(std::sqrt(static_cast<double>(squared[i])) * resolution_);
    if (squared[i] == 0 && grid.cells[i] == world::Cell::kUnknown) costs_[i] = kUnknownCost;
  }
}

std::uint8_t Costmap::CostAt(double distance) const {
  if (distance == 0.0) return kLethalCost;
  if (distance <= inscribed_radius_) return kInscribedCost;
  if (distance > params_.inflation_radius) return kFreeCost;
  const double decay = std::exp(-params_.cost_scaling_factor * (distance - inscribed_radius_));
  return static_cast<std::uint8_t>((kInscribedCost - 1) * decay);
}

void Costmap::CellOf(const Eigen::Vector2d& point, int* column, int* row) const {
  const double bound = 1e9;  // a point far off the map still gives a valid int
  *column = static_cast<int>(
      std::floor(std::clamp((point.x() - origin_.x()) / resolution_, -bound, bound)));
  *row = static_cast<int>(
      std::floor(std::clamp((point.y() - origin_.y()) / resolution_, -bound, bound)));
}

Eigen::Vector2d Costmap::CentreOf(int column, int row) const {
  return origin_ + resolution_ * Eigen::Vector2d(column + 0.5, row + 0.5);
}

bool Costmap::Covers(const geometry::Polygon& outline_M) const {
  const Eigen::Vector2d far_corner = origin_ + resolution_ * Eigen::Vector2d(width_, height_);
  return std::all_of(outline_M.begin(), outline_M.end(), [&](const Eigen::Vector2d& p) {
    return p.x() >= origin_.x() && p.y() >= origin_.y() && p.x() <= far_corner.x() &&
           p.y() <= far_corner.y();
  });
}

Costmap Costmap::WithLayer(const world::OccupancyGrid& grid, double radius) const {
  HIRES_CHECK(grid.width == width_ && grid.height == height_ && grid.resolution == resolution_ &&
                  grid.origin == origin_,
              "a layer has its map's cells");
  const double inscribed = std::min(radius, inscribed_radius_);
  CostmapParams params = params_;
  params.inflation_radius = std::max(0.0, params_.inflation_radius + inscribed - inscribed_radius_);
  Costmap layered = *this;
  layered.layers_.push_back(std::make_shared<const Costmap>(grid, inscribed, params));
  return layered;
}

std::uint8_t Costmap::CostWithLayers(std::size_t cell) const {
  std::uint8_t highest = costs_[cell];
  for (const auto& layer : layers_)
    highest = std::max(highest, std::min(layer->costs_[cell], kInscribedCost));
  return highest;
}

bool Costmap::HasObstacle(int column, int row) const {
  const std::size_t cell = static_cast<std::size_t>(row) * width_ + column;
  return costs_[cell] == kLethalCost ||
         std::any_of(layers_.begin(), layers_.end(),
                     [&](const auto& layer) { return layer->costs_[cell] == kLethalCost; });
}

std::uint8_t Costmap::CostBelow(const Footprint& footprint_M) const {
  std::uint8_t highest = OwnCostBelow(footprint_M.outline);
  for (std::size_t i = 0; i < layers_.size() && highest < kLethalCost; ++i)
    highest = std::max(highest, layers_[i]->OwnCostBelow(footprint_M.AtLayer(i)));
  return highest;
}

std::uint8_t Costmap::OwnCostBelow(const geometry::Polygon& outline_M) const {
  if (!Covers(outline_M)) return kLethalCost;
  std::uint8_t highest = kFreeCost;
  ForEachSpan(outline_M, *this, [&](int row, int first, int last) {
    const std::uint8_t* costs = &costs_[static_cast<std::size_t>(row) * width_];
    first = std::max(first, 0);  // rounding at the map's edge
    last = std::min(last, width_ - 1);
    for (int column = first; column <= last; ++column) highest = std::max(highest, costs[column]);
  });
  return highest;
}

std::uint8_t Costmap::FootprintCost(const Footprint& footprint, const geometry::Pose2& X_MB) const {
  return CostBelow(Transformed(X_MB, footprint));
}

Costmap Costmap::WithObstacles(const std::vector<geometry::Polygon>& outlines_M) const {
  Costmap extended = *this;
  std::vector<std::pair<int, int>> added;
  for (const geometry::Polygon& outline : outlines_M) {
    ForEachSpan(outline, *this, [&](int row, int first, int last) {
      for (int column = std::max(first, 0); column <= std::min(last, width_ - 1); ++column) {
        std::uint8_t& cost = extended.costs_[static_cast<std::size_t>(row) * width_ + column];
        if (cost >= kLethalCost) continue;
        cost = kLethalCost;
        added.emplace_back(column, row);
      }
    });
  }
  extended.Inflate(added);
  return extended;
}

Costmap Costmap::WithObstaclesAt(const std::vector<Eigen::Vector2d>& points_M) const {
  Costmap extended = *this;
  std::vector<std::pair<int, int>> added;
  for (const Eigen::Vector2d& point : points_M) {
    int column = 0, row = 0;
    CellOf(point, &column, &row);
    if (!Inside(column, row)) continue;
    std::uint8_t& cost = extended.costs_[static_cast<std::size_t>(row) * width_ + column];
    if (cost >= kLethalCost) continue;
    cost = kLethalCost;
    added.emplace_back(column, row);
  }
  extended.Inflate(added);
  return extended;
}

Costmap Costmap::Eased(const geometry::Polygon& outline_M, std::uint8_t most) const {
  Costmap eased = *this;
  ForEachSpan(outline_M, *this, [&](int row, int first, int last) {
    std::uint8_t* costs = &eased.costs_[static_cast<std::size_t>(row) * width_];
    for (int column = std::max(first, 0); column <= std::min(last, width_ - 1); ++column) {
      if (costs[column] <= most)
        costs[column] = std::min<std::uint8_t>(costs[column], kInscribedCost - 1);
    }
  });
  return eased;
}

/// Below what of the robot is at a layer's heights things go; below the rest of it they stay, but
/// do not keep its centre away.
Costmap Costmap::WithRoomFor(const Footprint& footprint_M) const {
  constexpr std::uint8_t kAll = std::numeric_limits<std::uint8_t>::max();
  Costmap eased = Eased(footprint_M.outline, kAll);
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    eased.layers_[i] = std::make_shared<const Costmap>(
        layers_[i]->Eased(footprint_M.AtLayer(i), kAll).Eased(footprint_M.outline, kInscribedCost));
  }
  return eased;
}

Costmap Costmap::WithAccessTo(const geometry::Polygon& outline_M) const {
  Costmap eased = Eased(outline_M, kInscribedCost);
  eased.layers_ = WithAccessUnder(outline_M).layers_;
  return eased;
}

Costmap Costmap::WithAccessUnder(const geometry::Polygon& outline_M) const {
  Costmap eased = *this;
  for (auto& layer : eased.layers_)
    layer = std::make_shared<const Costmap>(layer->Eased(outline_M, kInscribedCost));
  return eased;
}

Costmap Costmap::WithInscribedRadius(double inscribed_radius) const {
  world::OccupancyGrid grid;
  grid.resolution = resolution_;
  grid.width = width_;
  grid.height = height_;
  grid.origin = origin_;
  for (const std::uint8_t cost : costs_) {
    grid.cells.push_back(cost == kUnknownCost  ? world::Cell::kUnknown
                         : cost == kLethalCost ? world::Cell::kOccupied
                                               : world::Cell::kFree);
  }
  CostmapParams params = params_;
  params.inflation_radius =
      std::max(0.0, params_.inflation_radius + inscribed_radius - inscribed_radius_);
  Costmap changed(grid, inscribed_radius, params);
  for (const auto& layer : layers_) {
    const double radius = layer->inscribed_radius_ + inscribed_radius - inscribed_radius_;
    changed.layers_.push_back(
        std::make_shared<const Costmap>(layer->WithInscribedRadius(std::max(0.0, radius))));
  }
  return changed;
}

/// Where a cell's left neighbour is a new obstacle, too, that one is nearer to all that lies left,
/// and likewise on the other sides: of a wall's cells all but those at its ends inflate one line
/// each.
void Costmap::Inflate(const std::vector<std::pair<int, int>>& cells) {
  std::vector<std::uint8_t> is_new(costs_.size(), 0);
  for (const auto& [column, row] : cells)
    is_new[static_cast<std::size_t>(row) * width_ + column] = 1;
  const auto has = [&](int column, int row) {
    return Inside(column, row) && is_new[static_cast<std::size_t>(row) * width_ + column] != 0;
  };
  const double radius = std::max(params_.inflation_radius, inscribed_radius_);
  const int reach = static_cast<int>(std::min(radius / resolution_, 1e4));
  const int edge = 2 * reach + 1;
  std::vector<std::uint8_t> stamp(static_cast<std::size_t>(edge) * edge);
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      stamp[static_cast<std::size_t>(dy + reach) * edge + dx + reach] =
          CostAt(std::sqrt(static_cast<double>(dx * dx + dy * dy)) * resolution_);
    }
  }
  for (const auto& [column, row] : cells) {
    const int first = has(column - 1, row) ? column : std::max(column - reach, 0);
    const int last = has(column + 1, row) ? column : std::min(column + reach, width_ - 1);
    const int lowest = has(column, row - 1) ? row : std::max(row - reach, 0);
    const int highest = has(column, row + 1) ? row : std::min(row + reach, height_ - 1);
    for (int y = lowest; y <= highest; ++y) {
      const std::uint8_t* from =
          &stamp[static_cast<std::size_t>(y - row + reach) * edge + (first - column + reach)];
      std::uint8_t* to = &costs_[static_cast<std::size_t>(y) * width_ + first];
      for (int i = 0; i <= last - first; ++i) to[i] = std::max(to[i], from[i]);
    }
  }
}

}  // namespace hires::navigation
