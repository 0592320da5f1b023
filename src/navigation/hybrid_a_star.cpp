#include "hires/navigation/hybrid_a_star.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "hires/base/check.h"
#include "hires/geometry/angles.h"
#include "navigation/centre_distances.h"

namespace hires::navigation {
namespace {

using geometry::Pose2;

constexpr double kPlaceSize = 0.1;      // [m] of the squares that the search tells apart
constexpr double kLeastStep = 0.15;     // [m] of an arc: it leaves its square, on the diagonal too
constexpr double kCurveFactor = 1.02;   // of equally long ways the straighter one
constexpr double kSteeringCost = 0.02;  // [m] of turning the wheels, so that a way does not wobble

/// Of a way that the search has found: its end, and what leads there.
struct Node {
  Pose2 X_MB;
  double cost{0.0};  // [m]
  int parent{-1};
  std::vector<CarArc> arcs;  // from the parent
  bool is_goal{false};
};

/// Lowest estimate first; of equal ones the one nearer to the goal, then the one found first.
struct OpenNode {
  double estimate, to_goal;
  int node;
  bool operator<(const OpenNode& other) const {
    return std::tie(other.estimate, other.to_goal, other.node) < std::tie(estimate, to_goal, node);
  }
};

/// The first pose is driven to as the second one is: nothing changes there.
std::vector<CarPose> PathAlong(const Pose2& X_MStart, const std::vector<CarArc>& arcs,
                               double spacing) {
  std::vector<CarPose> path{{X_MStart}};
  AppendPoses(X_MStart, arcs, spacing, &path);
  if (path.size() > 1) {
    path.front().curvature = path[1].curvature;
    path.front().is_backward = path[1].is_backward;
  }
  return path;
}

/// In which order a search looks at ways. From the goal, a narrow end is where it begins.
struct SearchKind {
  bool is_from_goal;
  double haste;  // the weight of estimates: above 1 a way is found sooner, and may cost more
  double backward_factor;
  int max_expansions;
};

/// Each finds most of the ways on which the others spend all their expansions: from room to room,
/// who may not turn about in the first one has to drive backward all the way, and so on.
std::array<SearchKind, 4> KindsOf(const CarPathParams& params) {
  return {{{false, 1.0, params.backward_factor, params.max_expansions},
           {false, params.haste, 1.0, params.max_expansions},
           {true, params.haste, 1.0, params.max_expansions},
           {false, params.haste, params.backward_factor, params.max_last_expansions}}};
}

/// Goal and start are those of the search: one from the goal begins there.
class CarSearch {
 public:
  CarSearch(const Costmap& costmap, Footprint footprint, const Pose2& X_MGoal, double radius,
            const CarPathParams& params, const CentreDistances& distances, const SearchKind& kind)
      : costmap_(costmap),
        footprint_(std::move(footprint)),
        X_MGoal_(X_MGoal),
        params_(params),
        cost_weight_(params.costs.cost_factor / params.costs.neutral_cost),
        step_(std::max(kLeastStep, radius * HeadingStep())),
        curvatures_{0.0, 0.5 / radius, -0.5 / radius, 1.0 / radius, -1.0 / radius},
        ways_(radius),
        distances_(distances),
        kind_(kind) {}

  /// @return the node at the goal.
  std::optional<int> Run(const Pose2& X_MStart) {
    Add({X_MStart, 0.0, -1, {}, false});
    while (!open_.empty() && num_expansions_ < kind_.max_expansions) {
      const int next = open_.top().node;
      open_.pop();
      if (nodes_[next].is_goal) return next;
      if (best_.at(KeyOf(nodes_[next])) != next) continue;  // reached more cheaply since
      Expand(next);
    }
    return std::nullopt;
  }

  bool IsFree(const Pose2& X_MB) const {
    return costmap_.FootprintCost(footprint_, X_MB) < kLethalCost;
  }

  /// From the drive's start to its goal.
  std::vector<CarPose> PathTo(int end) const {
    std::vector<int> way;
    for (int node = end; node >= 0; node = nodes_[node].parent) way.push_back(node);
    std::vector<CarArc> arcs;
    for (auto node = way.rbegin(); node != way.rend(); ++node) {
      arcs.insert(arcs.end(), nodes_[*node].arcs.begin(), nodes_[*node].arcs.end());
    }
    const Pose2& X_MFirst = nodes_[way.back()].X_MB;
    if (!kind_.is_from_goal) return PathAlong(X_MFirst, arcs, params_.spacing);
    std::reverse(arcs.begin(), arcs.end());
    for (CarArc& arc : arcs) arc.length = -arc.length;
    return PathAlong(X_MGoal_, arcs, params_.spacing);
  }

  /// [m] Of the way to a node, as the drive's parameters weigh it, whatever the search did.
  double CostOf(int node) {
    if (node < 0 || nodes_[node].parent < 0) return 0.0;
    const Node& end = nodes_[node];
    const double before = CostOf(end.parent);
    kind_.backward_factor = params_.backward_factor;
    scratch_.clear();
    AppendPoses(nodes_[end.parent].X_MB, end.arcs, params_.spacing, &scratch_);
    return before + CostAlong(nodes_[end.parent], end.arcs);
  }
  /// Whether more expansions might have found a way.
  bool has_more() const { return !open_.empty(); }
  int num_expansions() const { return num_expansions_; }

 private:
  double HeadingStep() const { return 2.0 * geometry::kPi / params_.num_headings; }

  /// Square, heading, and whether it came there backward: what the search tells apart.
  std::uint64_t KeyOf(const Node& node) const {
    const auto count = [](double value, double size) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value / size)));
    };
    const std::uint64_t x = count(node.X_MB.x - costmap_.origin().x(), kPlaceSize) & 0xffffff;
    const std::uint64_t y = count(node.X_MB.y - costmap_.origin().y(), kPlaceSize) & 0xffffff;
    const auto heading = static_cast<std::uint64_t>(
        (std::lround(node.X_MB.yaw / HeadingStep()) + 2 * params_.num_headings) %
        params_.num_headings);
    const std::uint64_t back = !node.arcs.empty() && node.arcs.back().length < 0.0 ? 1 : 0;
    return ((x << 24 | y) << 15 | (heading & 0x3fff) << 1) | back;
  }

  void Expand(int from) {
    const double to_goal = Heuristic(nodes_[from]);
    // The farther the goal, the less likely it is that nothing stands on the way there.
    if (num_expansions_ % (1 + static_cast<int>(to_goal)) == 0) TryToReachGoal(from);
    ++num_expansions_;
    for (const double length : {step_, -step_}) {
      for (const double curvature : curvatures_) Try(from, {{length, curvature}}, false);
    }
  }

  void TryToReachGoal(int from) {
    std::vector<CarArc> arcs = ways_.Shortest(nodes_[from].X_MB, X_MGoal_);
    if (arcs.empty() && from != 0) return;
    Try(from, std::move(arcs), true);
  }

  /// Adds where the arcs lead to, unless a cheaper way there is known or the footprint would touch
  /// something; what takes long is looked at last.
  void Try(int from, std::vector<CarArc> arcs, bool is_goal) {
    scratch_.clear();
    AppendPoses(nodes_[from].X_MB, arcs, params_.spacing, &scratch_);
    Node node{is_goal ? X_MGoal_ : scratch_.back().X_MB,
              nodes_[from].cost + CostAlong(nodes_[from], arcs), from, std::move(arcs), is_goal};
    node.X_MB.yaw = geometry::WrapToPi(node.X_MB.yaw);
    if (IsBeaten(node)) return;
    const bool is_free = std::all_of(scratch_.begin(), scratch_.end(),
                                     [this](const CarPose& pose) { return IsFree(pose.X_MB); });
    if (is_free) Add(std::move(node));
  }

  bool IsBeaten(const Node& node) const {
    if (node.cost >= cost_of_goal_) return true;
    if (node.is_goal) return false;
    const auto known = best_.find(KeyOf(node));
    return known != best_.end() && nodes_[known->second].cost <= node.cost;
  }

  void Add(Node node) {
    const double to_goal = node.is_goal ? 0.0 : Heuristic(node);
    if (!std::isfinite(to_goal)) return;
    const int id = static_cast<int>(nodes_.size());
    if (node.is_goal) {
      cost_of_goal_ = node.cost;
    } else {
      best_[KeyOf(node)] = id;
    }
    open_.push({node.cost + kind_.haste * to_goal, to_goal, id});
    nodes_.push_back(std::move(node));
  }

  /// [m] Of the arcs that `scratch_` has the poses of.
  double CostAlong(const Node& from, const std::vector<CarArc>& arcs) const {
    double cost = 0.0;
    const CarArc* last = from.arcs.empty() ? nullptr : &from.arcs.back();
    std::size_t pose = 0;
    for (const CarArc& arc : arcs) {
      cost += CostOfBeginning(arc, last);
      const int pieces = NumPieces(arc, params_.spacing);
      const double each = FactorOf(arc) * std::abs(arc.length) / pieces;
      for (int i = 0; i < pieces; ++i, ++pose) {
        int column = 0, row = 0;
        costmap_.CellOf(scratch_[pose].X_MB.position(), &column, &row);
        if (!costmap_.Inside(column, row)) return std::numeric_limits<double>::infinity();
        cost += each * (1.0 + cost_weight_ * costmap_.cost(column, row));
      }
      last = &arc;
    }
    return cost;
  }

  /// [m] What the way to the goal will cost: that of the shortest one where nothing stands, or as a
  /// point round what stands there. The shortest way is not always the cheapest, so it may be too
  /// much; but one without reversals would let it look at thousands of ways before it believes that
  /// they are needed.
  double Heuristic(const Node& from) const {
    return std::max(CostWhereNothingStands(from.X_MB), distances_.At(from.X_MB.position()));
  }

  double CostWhereNothingStands(const Pose2& X_MB) const {
    double cost = 0.0;
    const CarArc* last = nullptr;
    const std::vector<CarArc> arcs = ways_.Shortest(X_MB, X_MGoal_);
    for (const CarArc& arc : arcs) {
      cost += CostOfBeginning(arc, last) + FactorOf(arc) * std::abs(arc.length);
      last = &arc;
    }
    return cost;
  }

  double CostOfBeginning(const CarArc& arc, const CarArc* last) const {
    if (!last) return 0.0;
    return ((arc.length < 0.0) != (last->length < 0.0) ? params_.reversal : 0.0) +
           (arc.curvature != last->curvature ? kSteeringCost : 0.0);
  }

  double FactorOf(const CarArc& arc) const {
    const bool is_backward = (arc.length < 0.0) != kind_.is_from_goal;
    return (is_backward ? kind_.backward_factor : 1.0) *
           (arc.curvature == 0.0 ? 1.0 : kCurveFactor);
  }

  const Costmap& costmap_;
  Footprint footprint_;
  Pose2 X_MGoal_;
  CarPathParams params_;
  double cost_weight_;
  double step_;  // [m] of an arc
  std::array<double, 5> curvatures_;
  ReedsSheppWays ways_;
  const CentreDistances& distances_;
  SearchKind kind_;
  std::vector<Node> nodes_;
  std::unordered_map<std::uint64_t, int> best_;  // cheapest node of each place
  std::priority_queue<OpenNode> open_;
  std::vector<CarPose> scratch_;
  double cost_of_goal_{std::numeric_limits<double>::infinity()};
  int num_expansions_{0};
};

}  // namespace

std::vector<CarPose> ShortestCarPath(const Pose2& X_MStart, const Pose2& X_MGoal,
                                     double min_turning_radius, const CarPathParams& params) {
  const ReedsSheppWays ways(params.steering_reserve * min_turning_radius);
  return PathAlong(X_MStart, ways.Shortest(X_MStart, X_MGoal), params.spacing);
}

CarPathResult PlanCarPath(const Costmap& costmap, const Footprint& footprint, const Pose2& X_MStart,
                          const Pose2& X_MGoal, double min_turning_radius,
                          const CarPathParams& params) {
  HIRES_CHECK(
      min_turning_radius > 0.0 && params.steering_reserve >= 1.0 && params.spacing > 0.0 &&
          params.num_headings > 0 && params.costs.neutral_cost > 0.0,
      "a car's path needs a turning radius, and steps, headings and costs that are positive");
  CarPathResult result;
  const double radius = params.steering_reserve * min_turning_radius;
  const CentreDistances to_goal(costmap, X_MGoal.position(), X_MStart.position(), params.costs);
  std::optional<CentreDistances> to_start;  // where it is asked for
  for (const double clearance : {params.clearance, 0.0}) {
    const Footprint padded = Padded(footprint, clearance);
    for (const SearchKind& kind : KindsOf(params)) {
      if (kind.is_from_goal && !to_start)
        to_start.emplace(costmap, X_MStart.position(), X_MGoal.position(), params.costs);
      CarSearch search(costmap, padded, kind.is_from_goal ? X_MStart : X_MGoal, radius, params,
                       kind.is_from_goal ? *to_start : to_goal, kind);
      result.status = !search.IsFree(X_MStart)  ? PathStatus::kStartBlocked
                      : !search.IsFree(X_MGoal) ? PathStatus::kGoalBlocked
                                                : PathStatus::kNoPath;
      if (result.status != PathStatus::kNoPath) break;
      const std::optional<int> end = search.Run(kind.is_from_goal ? X_MGoal : X_MStart);
      result.num_expansions += search.num_expansions();
      if (end) {
        result.status = PathStatus::kFound;
        result.path = search.PathTo(*end);
        result.path.back().X_MB = X_MGoal;
        result.cost = search.CostOf(*end);
        return result;
      }
      if (!search.has_more()) break;  // all that can be reached was looked at
    }
  }
  return result;
}

}  // namespace hires::navigation
