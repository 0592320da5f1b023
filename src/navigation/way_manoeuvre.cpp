#include "navigation/way_manoeuvre.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>
#include <tuple>
#include <unordered_set>

#include "hires/geometry/angles.h"
#include "navigation/velocity_window.h"

namespace hires::navigation {
namespace {

using Eigen::Vector2d;
using geometry::Pose2;

// [s] Without coming further, and between two searches; twice as long after each that finds
// nothing.
constexpr double kStuckPatience = 3.0;
constexpr int kMostManoeuvres = 4;       // without coming further by kFurther
constexpr double kFoundElsewhere = 0.3;  // [m] in a cycle: it was found elsewhere
constexpr double kFacedAhead = 0.5;      // [m] on the way to what the base shall face

constexpr double kFurther = 1.0, kFurthest = 2.0;  // [m] along the way, where pieces may end,
constexpr double kBeside = 0.1;                    // [m] so far beside it at most,
constexpr double kOffHeading = 0.2;                // [rad] so far off its heading,
constexpr double kChord = 0.3;                     // [m] which is that of so much of it
constexpr double kPieceReach = 2.5;                // [m] from where it stands
constexpr double kDriveStep = 0.1;                 // [m] of a drive
constexpr int kHeadings = 36;                      // that are told apart
constexpr double kTurnStep = 2.0 * geometry::kPi / kHeadings;
constexpr int kMostTurnSteps = kHeadings / 2;  // of a piece
constexpr double kSameHeading = 1e-6;          // of turn steps: one and the same heading
constexpr double kPieceSquare = 0.05;          // [m] of squares that are told apart
constexpr double kTurnCost = 0.3;              // [m/rad]
constexpr double kSidewaysStep = 0.0708;  // [m] sqrt(2) squares: into another one whatever heading
constexpr double kSidewaysCost = 2.0;     // of a drive's, as it is slower
constexpr double kPieceCost = 0.15;       // [m] of stopping between pieces
constexpr int kMostExpansions = 4000;     // with each margin

enum class Move { kNone, kTurnLeft, kTurnRight, kForward, kBackward, kLeft, kRight };

bool IsTurn(Move move) { return move == Move::kTurnLeft || move == Move::kTurnRight; }
bool IsSideways(Move move) { return move == Move::kLeft || move == Move::kRight; }

/// What a drive is in one unit of time.
geometry::Twist2 DriveOf(Move move) {
  if (IsSideways(move)) return {0.0, move == Move::kLeft ? kSidewaysStep : -kSidewaysStep, 0.0};
  return {move == Move::kForward ? kDriveStep : -kDriveStep, 0.0, 0.0};
}

struct PieceNode {
  Pose2 X_MB;
  double heading{0.0};    // in turn steps from the way's; whole but before the first turn
  double cost{0.0};       // [m]
  std::size_t margin{0};  // of the move there: index of a sweep
  Move move{Move::kNone};
  int parent{-1};
};

/// Lowest estimate first; of equal ones the one found first.
struct OpenPiece {
  double estimate;
  int node;
  bool operator<(const OpenPiece& other) const {
    return std::tie(other.estimate, other.node) < std::tie(estimate, node);
  }
};

/// A* over moves that keep a margin; where the base stands nearer to things, no less than the move
/// before.
class PieceSearch {
 public:
  PieceSearch(const Costmap& costmap, const Pose2& X_MB, const std::vector<Vector2d>& way,
              bool moves_sideways, std::vector<SweptFootprint>* sweeps)
      : costmap_(costmap), X_MStart_(X_MB), sweeps_(sweeps) {
    moves_ = {Move::kForward, Move::kBackward, Move::kTurnLeft, Move::kTurnRight};
    if (moves_sideways) moves_.insert(moves_.end(), {Move::kLeft, Move::kRight});
    MeasureWay(way);
  }

  /// @param margin  index of a sweep
  std::vector<Piece> Find(std::size_t margin) {
    margin_ = margin;
    nodes_.clear();
    closed_.clear();
    open_ = {};
    PieceNode start;
    start.X_MB = X_MStart_;
    start.heading = geometry::WrapToPi(X_MStart_.yaw - way_yaw()) / kTurnStep;
    start.margin = MarginOf(X_MStart_, {}, 0);
    if (start.margin == sweeps_->size()) return {};
    Add(start);
    for (int i = 0; i < kMostExpansions && !open_.empty(); ++i) {
      const int at = open_.top().node;
      open_.pop();
      if (!closed_.insert(KeyOf(nodes_[at])).second) continue;
      if (IsThere(nodes_[at].X_MB)) return PiecesTo(at);
      for (const Move move : moves_) Expand(at, move);
    }
    return {};
  }

 private:
  struct WayPoint {
    Vector2d p_M;
    double yaw;  // [rad] of the way there
  };

  /// The way as far as pieces may end, and from where on they may.
  void MeasureWay(const std::vector<Vector2d>& way) {
    std::vector<double> lengths{0.0};
    for (std::size_t i = 1; i < way.size() && lengths.back() < kFurthest + kChord; ++i)
      lengths.push_back(lengths.back() + (way[i] - way[i - 1]).norm());
    const auto at = [&](double length) {
      const auto found = std::lower_bound(lengths.begin(), lengths.end(), length);
      return way[std::min<std::size_t>(found - lengths.begin(), lengths.size() - 1)];
    };
    for (std::size_t i = 0; i < lengths.size() && lengths[i] <= kFurthest; ++i) {
      const Vector2d chord = at(lengths[i] + kChord) - at(std::max(0.0, lengths[i] - kChord));
      way_.push_back({way[i], std::atan2(chord.y(), chord.x())});
      if (lengths[i] < kFurther) first_end_ = i;
    }
  }

  double way_yaw() const { return way_[first_end_].yaw; }

  double DistanceTo(std::size_t i, const Pose2& X_MB) const {
    return (way_[i].p_M - X_MB.position()).norm();
  }

  bool IsThere(const Pose2& X_MB) const {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < way_.size(); ++i)
      if (DistanceTo(i, X_MB) < DistanceTo(nearest, X_MB)) nearest = i;
    return nearest >= first_end_ && DistanceTo(nearest, X_MB) <= kBeside &&
           std::abs(geometry::WrapToPi(way_[nearest].yaw - X_MB.yaw)) <= kOffHeading;
  }

  double Estimate(const Pose2& X_MB) const {
    const double turn = std::abs(geometry::WrapToPi(way_yaw() - X_MB.yaw));
    return DistanceTo(first_end_, X_MB) + kTurnCost * turn;
  }

  static std::uint64_t KeyOf(const PieceNode& node) {
    const auto cell = [](double x) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x / kPieceSquare)));
    };
    const int nearest = static_cast<int>(std::lround(node.heading));
    const int whole = (nearest % kHeadings + kHeadings) % kHeadings;
    const int heading = IsWhole(node.heading) ? whole : kHeadings + whole;
    return ((cell(node.X_MB.x) & 0xfffffff) << 36) | ((cell(node.X_MB.y) & 0xfffffff) << 8) |
           static_cast<std::uint64_t>(heading);
  }

  void Add(const PieceNode& node) {
    open_.push({node.cost + Estimate(node.X_MB), static_cast<int>(nodes_.size())});
    nodes_.push_back(node);
  }

  /// The widest one from `first` on that a motion keeps; how many there are: something is in its
  /// way.
  std::size_t MarginOf(const Pose2& X_MB, const geometry::Twist2& motion, std::size_t first) const {
    while (first < sweeps_->size() && !(*sweeps_)[first].IsFree(costmap_, X_MB, motion, 1.0))
      ++first;
    return first;
  }

  static bool IsWhole(double heading) {
    return std::abs(heading - std::round(heading)) < kSameHeading;
  }

  /// Whole ones, so that the way's own heading is among them.
  static double NextHeading(double heading, Move move) {
    return move == Move::kTurnLeft ? std::floor(heading + kSameHeading) + 1.0
                                   : std::ceil(heading - kSameHeading) - 1.0;
  }

  static double CostOf(const geometry::Twist2& motion) {
    return std::abs(motion.vx) + kSidewaysCost * std::abs(motion.vy) +
           kTurnCost * std::abs(motion.wz);
  }

  void Expand(int parent, Move move) {
    const PieceNode from = nodes_[parent];
    PieceNode next = from;
    geometry::Twist2 motion;
    if (IsTurn(move)) {
      next.heading = NextHeading(from.heading, move);
      motion.wz = (next.heading - from.heading) * kTurnStep;
      next.X_MB.yaw = geometry::WrapToPi(way_yaw() + next.heading * kTurnStep);
    } else {
      motion = DriveOf(move);
      next.X_MB = PoseAfter(from.X_MB, motion, 1.0);
    }
    if ((next.X_MB.position() - X_MStart_.position()).norm() > kPieceReach) return;
    if (closed_.count(KeyOf(next)) > 0) return;
    next.margin = MarginOf(from.X_MB, motion, margin_);
    if (next.margin > std::max(margin_, from.margin) || next.margin == sweeps_->size()) return;
    next.cost += CostOf(motion);
    if (move != from.move) next.cost += kPieceCost;
    next.move = move;
    next.parent = parent;
    Add(next);
  }

  /// Turns and the drive after them are one piece; of more than half a turn two, as which way a
  /// piece is turned would not be clear.
  std::vector<Piece> PiecesTo(int end) const {
    std::vector<int> nodes;
    for (int at = end; at > 0; at = nodes_[at].parent) nodes.push_back(at);
    std::reverse(nodes.begin(), nodes.end());
    std::vector<Piece> pieces;
    Move last = Move::kNone;
    int num_turns = 0;
    for (const int i : nodes) {
      const PieceNode& node = nodes_[i];
      const bool is_turn = IsTurn(node.move);
      const bool goes_on =
          node.move == last ? !is_turn || num_turns < kMostTurnSteps : !is_turn && IsTurn(last);
      if (!goes_on) {
        pieces.emplace_back();
        num_turns = 0;
      }
      num_turns += is_turn;
      if (is_turn) pieces.back().sign = node.move == Move::kTurnLeft ? 1 : -1;
      pieces.back().yaw = node.X_MB.yaw;
      pieces.back().p_MTo = node.X_MB.position();
      last = node.move;
    }
    return pieces;
  }

  const Costmap& costmap_;
  Pose2 X_MStart_;
  std::vector<SweptFootprint>* sweeps_;
  std::vector<Move> moves_;
  std::vector<WayPoint> way_;
  std::size_t first_end_{0};
  std::size_t margin_{0};
  std::vector<PieceNode> nodes_;
  std::priority_queue<OpenPiece> open_;
  std::unordered_set<std::uint64_t> closed_;
};

}  // namespace

std::vector<Piece> FindPieces(const Costmap& costmap, const Pose2& X_MB,
                              const std::vector<Vector2d>& way, bool moves_sideways,
                              std::vector<SweptFootprint>* sweeps) {
  PieceSearch search(costmap, X_MB, way, moves_sideways, sweeps);
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < sweeps->size() && pieces.empty(); ++i) pieces = search.Find(i);
  return pieces;
}

WayManoeuvre::WayManoeuvre(const DwaParams& params)
    : params_(params), watch_(params, kStuckPatience), drive_(params) {
  SetWay(false);
}

void WayManoeuvre::SetMotionSet(const robot::MotionSet& limits) {
  watch_.SetMotionSet(limits);
  drive_.SetMotionSet(limits);
}

void WayManoeuvre::SetWay(bool is_same_goal) {
  watch_.Reset();
  is_stuck_ = false;
  least_left_.reset();  // of ways of different length nothing is compared
  if (is_same_goal) return;
  drive_.End();
  num_tries_ = 0;
  patience_ = 0.0;
  since_search_ = 0.0;
}

WayManoeuvre::Step WayManoeuvre::Update(const Costmap& costmap, const Pose2& X_MB,
                                        const geometry::Twist2& V_B,
                                        const std::vector<Vector2d>& way, std::size_t nearest,
                                        std::vector<SweptFootprint>* sweeps) {
  since_search_ += params_.control_period;
  const bool has_jumped = p_MLast_ && (X_MB.position() - *p_MLast_).norm() > kFoundElsewhere;
  p_MLast_ = X_MB.position();
  if (has_jumped) drive_.End();
  if (!drive_.is_active()) {
    Look(X_MB, way, nearest);
    if (!is_stuck_) return {Next::kNothing, {}};
    if (!IsStopped(V_B, params_)) return {Next::kBrake, {}};
    is_stuck_ = false;
    since_search_ = 0.0;
    auto pieces =
        FindPieces(costmap, X_MB, {way.begin() + static_cast<std::ptrdiff_t>(nearest), way.end()},
                   params_.max_lateral_velocity > 0.0, sweeps);
    patience_ = pieces.empty() ? std::max(2.0 * patience_, kStuckPatience) : kStuckPatience;
    if (pieces.empty()) return {Next::kNothing, {}};
    ++num_tries_;
    drive_.BeginAlong(std::move(pieces));
  }
  const GoalApproach::Step step = drive_.Update(costmap, X_MB, V_B, &sweeps->back());
  if (step.state == GoalApproach::State::kDriving) return {Next::kDrive, step.velocity};
  watch_.Reset();
  return {Next::kNothing, {}};
}

/// Whether it is stuck, and something shall be done about it now.
void WayManoeuvre::Look(const Pose2& X_MB, const std::vector<Vector2d>& way, std::size_t nearest) {
  const double left = params_.sim_granularity * static_cast<double>(way.size() - 1 - nearest);
  const auto ahead = static_cast<std::size_t>(kFacedAhead / params_.sim_granularity);
  const Vector2d& p_MAhead = way[std::min(nearest + ahead, way.size() - 1)];
  is_stuck_ = watch_.Stalls(left + LeftTo(X_MB, p_MAhead)) || is_stuck_;
  if (!least_left_) least_left_ = left;
  if (left < *least_left_ - kFurther) {
    least_left_ = left;
    num_tries_ = 0;
  }
  const bool is_near = (way.back() - X_MB.position()).norm() <= NearGoal(params_);
  if (is_near || num_tries_ == kMostManoeuvres || since_search_ < patience_) is_stuck_ = false;
  if (is_stuck_) least_left_ = std::min(*least_left_, left);
}

}  // namespace hires::navigation
