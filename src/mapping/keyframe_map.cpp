#include "mapping/keyframe_map.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "hires/geometry/angles.h"

namespace hires::mapping {
namespace {

using geometry::Pose2;

constexpr double kLostFit = 0.2;        // with less, a scan fits nothing
constexpr double kBetterFit = 0.1;      // by which the wider search has to win
constexpr int kChainHalf = 10;          // keyframes to either side of a place seen before
constexpr int kLoopEvery = 2;           // keyframes
constexpr double kLarge = 0.5;          // [m] of correction, which then needs a witness
constexpr double kToldSd = 0.03;        // [m] of a match in a direction that walls tell of
constexpr double kSettles = 0.3;        // [m] by which refining may move what was searched
constexpr double kWalks = 0.6;          // [m] likewise, of a scan and the latest keyframes
constexpr double kTurnsAway = 0.3;      // [rad]
constexpr double kAtBorder = 0.15;      // [m] from a window's border
constexpr double kWayOfASlip = 10.0;    // [m] of way for each slip, where slips are many
constexpr int kFewSeen = 10;            // points that tell whether a scan fits where it is
constexpr double kFitsHere = 0.6;       // of those ...
constexpr double kFitsBetter = 0.25;    // ... by which another place has to fit better
constexpr double kSameHeading = 1.0;    // [rad]
constexpr double kDrift = 0.05;         // [m / m] of a map that is not tied together
constexpr double kYawDrift = 0.004;     // [rad / m]
constexpr double kFarthestOff = 12.0;   // [m] that a place is looked for
constexpr double kMostTurnedOff = 0.8;  // [rad]
constexpr double kReturned = 2.0;       // [m] from a place seen before
constexpr int kReturnedHalf = 5;        // keyframes to either side of it
constexpr std::size_t kMostReturns = 30;
const Eigen::Vector3d kUnknownStep(1.0, 1.0, 0.3), kUnknownPlace(30.0, 30.0, 3.0);
const Eigen::Vector3d kEdgeFloor(0.01, 0.01, 0.003);  // [m], [m], [rad] sd of the best match

double AngleBetween(const Pose2& a, const Pose2& b) {
  return std::abs(geometry::WrapToPi(a.yaw - b.yaw));
}
double DistanceBetween(const Pose2& a, const Pose2& b) {
  return (a.position() - b.position()).norm();
}

/// What the match of `to` with places about `from` says of the two.
/// @param unknown_sd  [m], [rad] where nothing is known at all.
PoseGraph::Edge EdgeOf(int from, int to, const Pose2& X_MF, const ScanMatch& match,
                       const Eigen::Vector3d& unknown_sd) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  // map to `from`
  turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-X_MF.yaw).toRotationMatrix();
  const Eigen::Matrix3d information =
      match.information + unknown_sd.cwiseAbs2().cwiseInverse().asDiagonal().toDenseMatrix();
  Eigen::Matrix3d covariance = turn * information.inverse() * turn.transpose();
  covariance.diagonal() += kEdgeFloor.cwiseAbs2();
  return {from, to, X_MF.Inverse() * match.X_MB, covariance.inverse()};
}

/// Whether walls tell of the shift that a match asks for, as those of a corridor do not along it.
bool IsTold(const Pose2& X_before, const ScanMatch& match) {
  const Eigen::Vector2d along = (match.X_MB.position() - X_before.position()).normalized();
  return along.dot(PositionCovarianceOf(match) * along) <= kToldSd * kToldSd;
}

/// What fits best at the border of a window would fit better beyond it.
bool IsAtBorder(const Pose2& X_MB, const Pose2& guess, const SearchWindow& window) {
  return (X_MB.position() - guess.position()).cwiseAbs().maxCoeff() > window.reach - kAtBorder;
}

/// A match that keeps the pose from before in the direction that walls hardly tell of, as along a
/// corridor, or in which a rival lies, and says nothing of it: the best of all poses along it is
/// one that noise chose.
/// @return nothing if the scan does not fit there.
std::optional<ScanMatch> KeptWhereUntold(const SurfaceMap& map, const SurfacePoints& few,
                                         const Pose2& X_before, const ScanMatch& match,
                                         const std::optional<Pose2>& X_MRival,
                                         const MapperParams& params) {
  const LeastKnown least = LeastKnownOf(match);
  if (least.sd <= kToldSd && !X_MRival) return match;
  const Eigen::Vector2d u = least.sd > kToldSd
                                ? least.direction
                                : (X_MRival->position() - match.X_MB.position()).normalized();
  const Eigen::Vector2d shift = match.X_MB.position() - X_before.position();
  const Eigen::Vector2d kept = match.X_MB.position() - u * u.dot(shift);
  ScanMatch out =
      RefineMatch(map, few, {kept.x(), kept.y(), match.X_MB.yaw}, std::nullopt, params.surface_sd);
  if (out.fit < params.min_fit) return std::nullopt;
  Eigen::Matrix3d told = Eigen::Matrix3d::Identity();
  told.topLeftCorner<2, 2>() -= u * u.transpose();
  out.information = told * out.information * told;
  return out;
}

}  // namespace

std::optional<ScanMatch> KeyframeMap::Match(const SurfacePoints& few,
                                            const PosePrior& prior) const {
  if (!local_ || few.empty()) return std::nullopt;
  ScanMatch match = RefineMatch(*local_, few, prior.X_MB, prior, params_.surface_sd);
  if (match.fit < kGoodFit && TellsWhere(few)) {
    const SearchWindow window{0.3 + prior.position_sd, 0.15 + prior.yaw_sd};
    const Pose2 found = SearchMatch(*local_, few, prior.X_MB, window).X_MB;
    const ScanMatch other = RefineMatch(*local_, few, found, std::nullopt, params_.surface_sd);
    const bool settles =
        DistanceBetween(other.X_MB, found) < kWalks && AngleBetween(other.X_MB, found) < kTurnsAway;
    if (settles && other.fit > match.fit + kBetterFit) {
      match = other;
      match.is_searched = true;
    }
  }
  return match.fit < kLostFit ? std::nullopt : std::make_optional(match);
}

/// Few points, as of a scan that somebody stands before, fit in many places.
bool KeyframeMap::TellsWhere(const SurfacePoints& few) const {
  return SeesMuch(few) && 2 * NumFacing(few) >= NumFacing(keyframes_.back()->few);
}

bool KeyframeMap::IsDue(const Pose2& X_MB) const {
  if (!local_) return true;
  const Pose2& last = graph_.pose(size() - 1);
  return DistanceBetween(X_MB, last) >= params_.keyframe_step ||
         AngleBetween(X_MB, last) >= params_.keyframe_step;
}

Pose2 KeyframeMap::Add(SurfacePoints points, SurfacePoints few, const ScanMatch& match,
                       double way) {
  const int k = graph_.AddPose(match.X_MB);
  keyframes_.push_back(
      std::make_shared<const Keyframe>(Keyframe{std::move(points), std::move(few), way}));
  if (k > 0) graph_.AddEdge(EdgeOf(k - 1, k, graph_.pose(k - 1), match, kUnknownStep));
  if (k % kLoopEvery == 0) CloseLoop();
  RebuildLocalMap();
  return graph_.pose(k);
}

void KeyframeMap::NoteBreak() {
  if (size() > 0 && (breaks_.empty() || breaks_.back() != size())) breaks_.push_back(size());
}

void KeyframeMap::NoteSlip() { slips_.push_back(size()); }

std::vector<PlacedPoints> KeyframeMap::Placed(int first, int last) const {
  std::vector<PlacedPoints> placed;
  for (int i = std::max(0, first); i <= last; ++i)
    placed.push_back({&keyframes_[i]->points, graph_.pose(i)});
  return placed;
}

void KeyframeMap::RebuildLocalMap() {
  const std::vector<PlacedPoints> placed = Placed(size() - params_.local_keyframes, size() - 1);
  const bool is_empty = std::all_of(placed.begin(), placed.end(),
                                    [](const auto& scan) { return scan.points->empty(); });
  local_.reset();
  if (!is_empty) local_.emplace(placed);
}

void KeyframeMap::CloseLoop() {
  const int k = size() - 1;
  std::optional<int> tried;
  // The laser looks ahead: who comes back the same way sees the same walls.
  for (const bool same_heading : {true, false}) {
    const std::optional<int> place = PlaceSeenBefore(same_heading);
    if (!place || place == tried) continue;
    tried = place;
    const std::optional<ScanMatch> match = MatchWithPlace(*place);
    if (!match) continue;
    const Pose2& X_before = graph_.pose(k);
    const bool is_large = DistanceBetween(X_before, match->X_MB) >= kLarge;
    if (is_large && !(IsTold(X_before, *match) && IsWitnessed(X_before, match->X_MB))) continue;
    const PoseGraph::Edge edge = EdgeOf(*place, k, graph_.pose(*place), *match, kUnknownPlace);
    if (!graph_.CloseLoop(edge, is_large)) continue;
    if (LeastKnownOf(*match).sd > kToldSd) return;  // along a corridor the map may still be off
    ++num_loops_;
    breaks_.erase(std::upper_bound(breaks_.begin(), breaks_.end(), *place), breaks_.end());
    way_at_loop_ = keyframes_[k]->way;
    return;
  }
}

/// [m] driven from a keyframe to the last one of which nothing says how far it led.
double KeyframeMap::UntiedWay(int i) const {
  return keyframes_.back()->way - std::max(way_at_loop_, keyframes_[i]->way);
}

/// The keyframe nearest to keyframe k, of those far enough back on the way.
/// @param radius_of  [m] around k, for each of them.
template <typename RadiusOf>
std::optional<int> KeyframeMap::NearestBefore(int k, bool same_heading,
                                              const RadiusOf& radius_of) const {
  std::optional<int> nearest;
  double best = std::numeric_limits<double>::infinity();
  for (int j = 0; j < k; ++j) {
    if (keyframes_[k]->way - keyframes_[j]->way < params_.loop_length) break;
    if (same_heading && AngleBetween(graph_.pose(j), graph_.pose(k)) > kSameHeading) continue;
    const double distance = DistanceBetween(graph_.pose(j), graph_.pose(k));
    if (distance >= std::min(best, radius_of(j))) continue;
    best = distance;
    nearest = j;
  }
  return nearest;
}

std::optional<int> KeyframeMap::PlaceSeenBefore(bool same_heading) const {
  return NearestBefore(size() - 1, same_heading,
                       [&](int j) { return params_.loop_radius + kDrift * UntiedWay(j); });
}

/// What was seen around a place before keyframe k came back to it.
SurfaceMap KeyframeMap::MapAround(int place, int half, int k) const {
  int last = std::min(place + half, k - 1);
  while (keyframes_[k]->way - keyframes_[last]->way < params_.loop_length / 2.0) --last;
  return SurfaceMap(Placed(place - half, last));
}

/// After a break, or many slips that the laser alone followed, nothing is known to lie right.
bool KeyframeMap::MayBeBentSince(int place) const {
  if (!breaks_.empty() && breaks_.back() > place) return true;
  const auto num_slips = slips_.end() - std::upper_bound(slips_.begin(), slips_.end(), place);
  return static_cast<double>(num_slips) * kWayOfASlip >
         keyframes_.back()->way - keyframes_[place]->way;
}

/// Whether a match asks for a large shift of what lies right: what was seen around a place ends
/// where nobody had looked, and a scan that is pushed into it fits with more of its points than one
/// that lies half beside it.
bool KeyframeMap::FitsWhereItIs(const SurfaceMap& map, int place, const ScanMatch& match) const {
  const Pose2& X_MB = graph_.pose(size() - 1);
  if (DistanceBetween(match.X_MB, X_MB) < kLarge) return false;
  const SurfacePoints& few = keyframes_.back()->few;
  const Pose2 near = SearchMatch(map, few, X_MB, {0.3, 0.1}).X_MB;
  const ScanMatch stays = RefineMatch(map, few, near, std::nullopt, params_.surface_sd);
  const FitWhereSeen here = FitWhereSeenAt(map, few, stays.X_MB);
  const FitWhereSeen there = FitWhereSeenAt(map, few, match.X_MB);
  return here.num_points >= kFewSeen && here.fit > kFitsHere && here.fit > there.fit - kFitsBetter;
}

/// The last keyframe by the scans around a place, which it may be off by the more the longer the
/// map was not tied together.
std::optional<ScanMatch> KeyframeMap::MatchWithPlace(int place) const {
  const int k = size() - 1;
  const double unsure = UntiedWay(place);
  const SearchWindow window{std::min(0.3 + kDrift * unsure, kFarthestOff),
                            std::min(0.1 + kYawDrift * unsure, kMostTurnedOff)};
  const SurfaceMap map = MapAround(place, kChainHalf, k);
  const SurfacePoints& few = keyframes_[k]->few;
  const FoundPose found = SearchMatch(map, few, graph_.pose(k), window);
  const ScanMatch match = RefineMatch(map, few, found.X_MB, std::nullopt, params_.surface_sd);
  if (match.fit < params_.min_fit || DistanceBetween(match.X_MB, found.X_MB) >= kSettles)
    return std::nullopt;
  const auto kept = KeptWhereUntold(map, few, graph_.pose(k), match, found.X_MRival, params_);
  if (!kept || MayBeBentSince(place)) return kept;
  return IsAtBorder(kept->X_MB, graph_.pose(k), window) || FitsWhereItIs(map, place, *kept)
             ? std::nullopt
             : kept;
}

/// Poses of neither are changed: who lies beside what was seen before is found so, too.
MapReturns KeyframeMap::CountReturns() const {
  std::vector<std::pair<int, int>> returns;
  for (int k = 0; k < size(); k += 2) {
    const auto place = NearestBefore(k, true, [](int) { return kReturned; });
    if (place) returns.emplace_back(k, *place);
  }
  MapReturns judged;
  const std::size_t step = 1 + returns.size() / kMostReturns;
  for (std::size_t i = 0; i < returns.size(); i += step) {
    const auto [k, place] = returns[i];
    const auto fit = FitAt(MapAround(place, kReturnedHalf, k), keyframes_[k]->few, graph_.pose(k));
    if (!fit) continue;
    ++judged.num_judged;
    if (*fit < kGoodFit) ++judged.num_apart;
  }
  return judged;
}

std::function<MapReturns()> KeyframeMap::Returns() const {
  const auto now = std::make_shared<KeyframeMap>(params_);
  now->keyframes_ = keyframes_;
  now->graph_ = graph_;
  return [now] { return now->CountReturns(); };
}

/// A large correction is believed once the next one agrees with it: rooms may be alike.
bool KeyframeMap::IsWitnessed(const Pose2& X_before, const Pose2& X_after) {
  const int k = size() - 1;
  const Pose2 step = X_after * X_before.Inverse();
  const bool agrees = asked_ && k - asked_->keyframe <= 3 * kLoopEvery &&
                      DistanceBetween(asked_->step * X_before, X_after) < 0.25 &&
                      AngleBetween(asked_->step, step) < 0.1;
  asked_ = Correction{step, k};
  return agrees;
}

}  // namespace hires::mapping
