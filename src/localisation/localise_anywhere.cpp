#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "hires/localisation/localise_log.h"
#include "localisation/beams.h"
#include "localisation/likelihood_field.h"
#include "localisation/other_places.h"
#include "localisation/way_comparison.h"

namespace hires::localisation {
namespace {

using Eigen::Vector2d;
using geometry::Pose2;

enum Streams : std::uint64_t { kWayThere = 1, kFromEnd, kOtherPlaces };
constexpr int kMostPlayed = 4;                                // other places
constexpr std::size_t kMostSketched = 100;                    // scans
constexpr std::size_t kMostCompared = 200;                    // scans
constexpr double kSketchedApart = 0.1, kComparedApart = 0.5;  // [m] and [rad], from scan to scan
constexpr double kClearOf = 2.0;  // explained distances before its end, what a beam passes

/// A scan and where a path says that the base was.
struct PlacedBeams {
  double time;
  Pose2 X_MB;
  Vector2d laser_B;  // [m]
  Beams beams;
};

BeamParams BeamParamsOf(const MonteCarloParams& params) {
  return {params.laser_max_beams, params.laser_min_range, params.laser_max_range};
}

/// Up to `most` scans that have poses, evenly picked.
std::vector<PlacedBeams> PlacedScans(const RobotLog& log, const TimedPath& path,
                                     const MonteCarloParams& params, std::size_t most) {
  std::vector<PlacedBeams> placed;
  const std::size_t count = std::min(path.size(), most);
  auto scan = log.scans.begin();
  for (std::size_t k = 0; k < count; ++k) {
    const TimedPose& pose = path[(2 * k + 1) * path.size() / (2 * count)];
    scan = std::find_if(scan, log.scans.end(),
                        [&](const RobotLog::Scan& s) { return s.time == pose.time; });
    if (scan == log.scans.end()) break;
    PlacedBeams beams{pose.time, pose.X_MB, scan->X_BL.position(), {}};
    if (!IsBad(SelectBeams(scan->reading, scan->X_BL, BeamParamsOf(params), &beams.beams)))
      placed.push_back(std::move(beams));
  }
  return placed;
}

/// Scans of a path for its sketch.
std::vector<PlacedBeams> SketchedScans(const RobotLog& log, const TimedPath& path,
                                       const MonteCarloParams& params) {
  return PlacedScans(log, PosesApart(path, kSketchedApart, kSketchedApart), params, kMostSketched);
}

/// Scans of the whole log, by whose beams the ways that it may have gone are compared; their poses
/// are those of the odometry.
std::vector<PlacedBeams> ComparedScans(const RobotLog& log, const MonteCarloParams& params) {
  TimedPath odometry;
  for (const RobotLog::Scan& scan : log.scans)
    if (const std::optional<Pose2> X_OB = OdometryOf(log, scan))
      odometry.push_back({scan.time, *X_OB});
  return PlacedScans(log, PosesApart(odometry, kComparedApart, kComparedApart), params,
                     kMostCompared);
}

Vector2d EndOf(const Beams& beams, std::size_t k) { return {beams.x[k], beams.y[k]}; }

DriveSketch SketchOf(const std::vector<PlacedBeams>& scans) {
  DriveSketch sketch;
  for (const PlacedBeams& scan : scans) {
    sketch.way_M.push_back(scan.X_MB.position());
    for (std::size_t k = 0; k < scan.beams.size(); ++k)
      sketch.echoes_M.push_back(scan.X_MB * EndOf(scan.beams, k));
  }
  return sketch;
}

/// Whether an obstacle of the map lies on the first `length` [m] of the way from a point to
/// another, the point itself included.
bool IsObstacleBetween(const world::OccupancyGrid& map, const Vector2d& from, const Vector2d& to,
                       double length) {
  const Vector2d step = (to - from).normalized() * map.resolution;
  for (int i = 0; i * map.resolution < length; ++i) {
    const Vector2d at = (from + i * step - map.origin) / map.resolution;
    const int column = static_cast<int>(std::floor(at.x()));
    const int row = static_cast<int>(std::floor(at.y()));
    if (column < 0 || row < 0 || column >= map.width || row >= map.height) continue;
    if (map.at(column, row) == world::Cell::kOccupied) return true;
  }
  return false;
}

/// Whether a beam goes through an obstacle of the map well before its end, or its laser is behind
/// one: no robot stands in walls.
bool PassesObstacle(const world::OccupancyGrid& map, const Pose2& X_MB, const Vector2d& laser_B,
                    const Vector2d& end_M, double explained_distance) {
  const Vector2d base_M = X_MB.position(), laser_M = X_MB * laser_B;
  const double beam = (end_M - laser_M).norm() - kClearOf * explained_distance;
  return IsObstacleBetween(map, base_M, laser_M, laser_B.norm()) ||
         IsObstacleBetween(map, laser_M, end_M, beam);
}

/// Tells which share of a scan's beams ends near an obstacle and passes none.
class BeamJudge {
 public:
  BeamJudge(const world::OccupancyGrid& map, const MonteCarloParams& params)
      : map_(map),
        field_(map, params.laser_likelihood_max_dist),
        explained_distance_(params.explained_distance) {}

  double Explained(const PlacedBeams& scan, const Pose2& X_MB) const {
    const Beams& beams = scan.beams;
    int count = 0;
    for (std::size_t k = 0; k < beams.size(); ++k) {
      const Vector2d end = X_MB * EndOf(beams, k);
      count += field_.DistanceAt(end.x(), end.y()) <= explained_distance_ &&
               !PassesObstacle(map_, X_MB, scan.laser_B, end, explained_distance_);
    }
    return count / static_cast<double>(beams.size());
  }

 private:
  const world::OccupancyGrid& map_;
  LikelihoodField field_;
  double explained_distance_;
};

/// A way that the drive may have taken, and what of the scans that are compared is explained there.
struct Candidate {
  LocalisedLog localised;
  ExplainedShares explained;
};

std::size_t ScanOf(const RobotLog& log, double time) {
  const auto at = std::find_if(log.scans.begin(), log.scans.end(),
                               [&](const RobotLog::Scan& scan) { return scan.time == time; });
  return static_cast<std::size_t>(at - log.scans.begin());
}

/// What was recorded until a scan, as if it were driven backwards.
RobotLog Reversed(const RobotLog& log, std::size_t last_scan) {
  RobotLog reversed;
  for (std::size_t i = last_scan + 1; i-- > 0;) {
    RobotLog::Scan scan = log.scans[i];
    scan.X_OB = OdometryOf(log, scan);
    scan.time = -scan.time;
    reversed.scans.push_back(std::move(scan));
  }
  return reversed;
}

/// Times of poses that were left out on the way forwards or backwards, and have no others instead.
/// @param first  [s] of the pose from which it was played backwards
std::vector<double> ContradictedIn(const LocalisedLog& localised, const LocalisedLog& back,
                                   double first) {
  std::set<double> times(localised.contradicted.begin(), localised.contradicted.end());
  for (const double time : back.contradicted)
    if (-time < first) times.insert(-time);
  std::vector<double> contradicted;
  for (const double time : times)
    if (!PoseAt(localised.path, time)) contradicted.push_back(time);
  return contradicted;
}

int NumJudged(const LocalisedLog& localised) {
  int count = 0;
  for (const auto& [outcome, times] : localised.outcomes)
    if (!IsBad(outcome)) count += times;
  return count;
}

/// Counts the scans, too, that were played backwards.
/// @param after  [s] from the log's first scan to that from which it was played backwards
void AddCounts(const LocalisedLog& back, double after, LocalisedLog* localised) {
  const int here = NumJudged(*localised), there = NumJudged(back);
  if (here + there > 0) {
    localised->explained = (here * localised->explained + there * back.explained) / (here + there);
  }
  for (const auto& [outcome, times] : back.outcomes) localised->outcomes[outcome] += times;
  for (const auto& [status, times] : back.statuses) localised->statuses[status] += times;
  localised->num_without_odometry += back.num_without_odometry;
  localised->num_relocations += back.num_relocations;
  if (!localised->relocated_after && back.relocated_after)
    localised->relocated_after = after - *back.relocated_after;
}

/// Everything that plays a drive from a pose on the way.
struct Drives {
  const RobotLog& log;
  const MonteCarloLocalisation& filter;  // that has heard nothing; its copies share the map
  const Eigen::Vector3d& initial_variance;
  const std::string task;

  MonteCarloLocalisation At(const Pose2& X_MB, const base::Rng& rng) const {
    MonteCarloLocalisation there = filter;
    there.Reseed(rng);
    there.SetPose(X_MB, initial_variance.asDiagonal());
    return there;
  }

  /// The drive until a scan, backwards from where the robot was then; its times are negative, and
  /// that scan is in no count.
  LocalisedLog Back(std::size_t scan, const Pose2& X_MB, const base::Rng& rng) const {
    return LocaliseLog(Reversed(log, scan), At(X_MB, rng), task + ": backwards", 0,
                       JudgedFrom::kStart, 1);
  }

  /// Puts before the path how the robot came to its first pose.
  /// @param way  [m] of the whole drive, as LocalisedLog::way.
  /// @return what was played backwards
  LocalisedLog AddWayTo(const TimedPose& first, double way, const base::Rng& rng,
                        LocalisedLog* localised) const {
    LocalisedLog back = Back(ScanOf(log, first.time), first.X_MB, rng);
    TimedPath path;
    for (auto pose = back.path.rbegin(); pose != back.path.rend(); ++pose)
      if (-pose->time < first.time) path.push_back({-pose->time, pose->X_MB});
    path.insert(path.end(), localised->path.begin(), localised->path.end());
    localised->path = std::move(path);
    localised->contradicted = ContradictedIn(*localised, back, first.time);
    const double known = localised->way_known * localised->way + back.way_known * back.way;
    localised->way = way;
    localised->way_known = way > 0.0 ? std::min(1.0, known / way) : localised->way_known;
    return back;
  }

  /// Of a filter that hardly ever decided between places: as if its best one at the end were right.
  std::optional<LocalisedLog> FromEnd(const PoseEstimate& last, double way,
                                      const base::Rng& rng) const {
    std::size_t end = log.scans.size() - 1;
    while (end > 0 && !OdometryOf(log, log.scans[end])) --end;
    const LocalisedLog back = Back(end, last.X_MB, rng.Fork(0));
    if (back.path.empty()) return std::nullopt;
    const TimedPose start{-back.path.back().time, back.path.back().X_MB};
    return Through(start, way, rng.Fork(1), "again");
  }

  /// As if the robot had been at `pose` at its time.
  /// @param what  is done, for those who wait
  LocalisedLog Through(const TimedPose& pose, double way, const base::Rng& rng,
                       const std::string& what) const {
    LocalisedLog localised = LocaliseLog(log, At(pose.X_MB, rng.Fork(0)), task + ": " + what,
                                         ScanOf(log, pose.time), JudgedFrom::kStart);
    const LocalisedLog back = AddWayTo(pose, way, rng.Fork(1), &localised);
    AddCounts(back, pose.time - log.scans.front().time, &localised);
    return localised;
  }
};

/// Of what was played forwards: it tells of the map, and that more can be added does not matter.
bool IsUseless(const LocalisedLog& localised) {
  return localised.path.empty() || !WhyDoubtful(localised).empty();
}

}  // namespace

double ShareThroughObstacles(const RobotLog& log, const TimedPath& path,
                             const world::OccupancyGrid& map, const MonteCarloParams& params) {
  double through = 0.0, all = 0.0;
  for (const PlacedBeams& scan : PlacedScans(log, path, params, kMostCompared)) {
    for (std::size_t k = 0; k < scan.beams.size(); ++k)
      through += PassesObstacle(map, scan.X_MB, scan.laser_B, scan.X_MB * EndOf(scan.beams, k),
                                params.explained_distance);
    all += static_cast<double>(scan.beams.size());
  }
  return all > 0.0 ? through / all : 0.0;
}

LocalisedLog LocaliseAnywhere(const RobotLog& log, const world::OccupancyGrid& map,
                              const MonteCarloParams& params, const base::Rng& rng,
                              const std::string& task) {
  const MonteCarloLocalisation filter(map, params, rng);
  MonteCarloLocalisation anywhere = filter;
  anywhere.GlobalLocalisation();
  Candidate best{LocaliseLog(log, std::move(anywhere), task), {}};
  const Drives drives{log, filter, params.initial_variance, task};
  const double way = best.localised.way;
  if (best.localised.last.status == LocalisationStatus::kAmbiguous && IsUseless(best.localised)) {
    auto again = drives.FromEnd(best.localised.last, way, rng.Fork(kFromEnd));
    if (again && !IsUseless(*again)) best.localised = *std::move(again);
  }
  if (IsUseless(best.localised)) return best.localised;
  const TimedPose first = best.localised.path.front();
  drives.AddWayTo(first, way, rng.Fork(kWayThere), &best.localised);
  const std::vector<Pose2> others =
      FindOtherPlaces(map, SketchOf(SketchedScans(log, best.localised.path, params)),
                      params.explained_distance, kMostPlayed, task + ": other places");
  if (others.empty()) return best.localised;
  const std::vector<PlacedBeams> compared = ComparedScans(log, params);
  const BeamJudge judge(map, params);
  const auto explain = [&](Candidate* candidate) {
    for (const PlacedBeams& scan : compared) {
      const TimedPose* pose = PoseAt(candidate->localised.path, scan.time);
      candidate->explained.push_back(pose ? std::optional(judge.Explained(scan, pose->X_MB))
                                          : std::nullopt);
    }
  };
  explain(&best);
  std::vector<Candidate> behind;
  for (std::size_t i = 0; i < others.size(); ++i) {
    const TimedPose there{first.time, others[i] * first.X_MB};
    Candidate other{drives.Through(there, way, rng.Fork(kOtherPlaces + i), "another place"), {}};
    explain(&other);
    if (!IsUseless(other.localised) && IsBetter(other.explained, best.explained))
      std::swap(best, other);
    behind.push_back(std::move(other));
  }
  for (const Candidate& other : behind) {
    const TimedPath& other_way = other.localised.path;
    const bool is_rival = !other_way.empty() && !IsSameWay(best.localised.path, other_way) &&
                          !IsSignificantlyBetter(best.explained, other.explained);
    const MeanShares mean = MeanExplained(best.explained, other.explained);
    if (!is_rival || (best.localised.rival && best.localised.rival->explained >= mean.b)) continue;
    best.localised.rival = Rival{other_way.back().X_MB, mean.b, mean.a};
  }
  return best.localised;
}

}  // namespace hires::localisation
