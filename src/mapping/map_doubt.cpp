#include "hires/mapping/map_doubt.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "mapping/scan_points.h"

namespace hires::mapping {
namespace {

using world::OccupancyGrid;

constexpr std::size_t kMostJudgedScans = 200, kMostJudgedBeams = 90;
constexpr double kJudgedCell = 0.05;  // [m]
constexpr double kMostJudgedCells = 2e7;
constexpr double kEndsAtWall = 0.1;     // [m]
constexpr double kLeastBehind = 0.5;    // [m] from a wall to the end of a beam that went through
constexpr double kClearOfWalls = 0.25;  // [m], else it may have gone along a wall
constexpr double kBeside = 0.2;         // [m] to either side, where a wall goes on ...
constexpr double kAtWallBeside = 0.15;  // ... within this [m]
constexpr double kClearStep = 0.1;      // [m] between places at which that is asked

constexpr int kFewReturns = 5;
constexpr double kMostApart = 0.4;      // of the returns
constexpr double kMostThrough = 0.008;  // of the beams
constexpr double kLeastExplained = 0.6;
constexpr int kFewLost = 20;
constexpr double kLeastAlike = 0.8, kMostAlike = 1.25;  // motion by the laser for that by odometry
constexpr double kLeastOfField = 0.87, kMostOfField = 1.15;  // turns where the field is assumed
constexpr double kLeastTurned = 0.5,
                 kMostTurned = 2.0;  // turns of bases that skid; the map is right
constexpr int kFewDisagreed = 20;
constexpr double kMostDisagreed = 0.75;  // of the stretches
constexpr double kSameUnit = 0.1;        // by which a ratio may miss that of two units
constexpr double kMostJumps = 0.2;       // of the scans
constexpr double kMostLost = 1.0 / 3.0;  // of the scans

class Walls {
 public:
  explicit Walls(const OccupancyGrid& grid) : grid_(grid) {}

  bool IsAt(const Eigen::Vector2d& p) const {
    const Eigen::Vector2i cell = CellOf(p);
    return IsOccupied(cell.x(), cell.y());
  }
  bool IsNear(const Eigen::Vector2d& p, double distance) const {
    const Eigen::Vector2i cell = CellOf(p);
    const int reach = static_cast<int>(std::lround(distance / grid_.resolution));
    for (int row = cell.y() - reach; row <= cell.y() + reach; ++row)
      for (int column = cell.x() - reach; column <= cell.x() + reach; ++column)
        if (IsOccupied(column, row)) return true;
    return false;
  }

  /// Whether a wall lies between two places, and a place clear of all walls behind it.
  bool AreBetween(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
    const double length = (to - from).norm(), step = grid_.resolution;
    const Eigen::Vector2d ahead = (to - from) / length;
    std::optional<double> clear_from;  // [m] on the way; nothing: no wall so far
    for (double way = step; way < length - kLeastBehind; way += step) {
      const Eigen::Vector2d p = from + way * ahead;
      if (IsAt(p) && IsAcross(p, ahead)) {
        clear_from = way + kClearOfWalls;
      } else if (clear_from && way >= *clear_from) {
        if (!IsNear(p, kClearOfWalls)) return true;
        clear_from = way + kClearStep;
      }
    }
    return false;
  }

 private:
  /// Whether the wall goes on to both sides: beams brush past its end, as of a door's jamb.
  bool IsAcross(const Eigen::Vector2d& p, const Eigen::Vector2d& ahead) const {
    const Eigen::Vector2d aside = kBeside * Eigen::Vector2d(-ahead.y(), ahead.x());
    return IsNear(p + aside, kAtWallBeside) && IsNear(p - aside, kAtWallBeside);
  }

  Eigen::Vector2i CellOf(const Eigen::Vector2d& p) const {
    return ((p - grid_.origin) / grid_.resolution).array().floor().cast<int>();
  }
  bool IsOccupied(int column, int row) const {
    return column >= 0 && row >= 0 && column < grid_.width && row < grid_.height &&
           grid_.at(column, row) == world::Cell::kOccupied;
  }

  const OccupancyGrid& grid_;
};

void JudgeBeams(const MapSketch& sketch, const OccupancyGrid& grid, MapEvidence* evidence) {
  const Walls walls(grid);
  int num_ended = 0, num_through = 0;
  const std::size_t step = 1 + sketch.scans.size() / kMostJudgedScans;
  for (std::size_t i = 0; i < sketch.scans.size(); i += step) {
    const localisation::RobotLog::Scan& scan = *sketch.scans[i];
    const geometry::Pose2 X_ML = sketch.X_MBs[i] * scan.X_BL;
    const std::size_t beam_step = 1 + scan.reading.ranges.size() / kMostJudgedBeams;
    for (std::size_t beam = 0; beam < scan.reading.ranges.size(); beam += beam_step) {
      if (!HasMet(scan.reading, beam, sketch.max_range)) continue;
      const Eigen::Vector2d p_MEnd = X_ML * EndOf(scan.reading, beam);
      ++evidence->num_beams;
      if (walls.IsNear(p_MEnd, kEndsAtWall)) ++num_ended;
      if (walls.AreBetween(X_ML.position(), p_MEnd)) ++num_through;
    }
  }
  if (evidence->num_beams == 0) return;
  evidence->explained = static_cast<double>(num_ended) / evidence->num_beams;
  evidence->through_walls = static_cast<double>(num_through) / evidence->num_beams;
}

bool AreUntied(const MapReturns& returns) {
  return returns.num_apart >= kFewReturns && returns.num_apart > kMostApart * returns.num_judged;
}
bool AreWaysUnlike(const MapCounts& counts) {
  return counts.ways_alike < kLeastAlike || counts.ways_alike > kMostAlike;
}
bool AreTurnsUnlike(const MapCounts& counts, const MapEvidence& evidence) {
  const double alike = counts.turns_alike;
  return evidence.is_field_assumed ? alike < kLeastOfField || alike > kMostOfField
                                   : alike < kLeastTurned || alike > kMostTurned;
}
bool DoDisagree(const MapCounts& counts) {
  return counts.num_disagreed >= kFewDisagreed &&
         counts.num_disagreed > kMostDisagreed * counts.num_stretches;
}
bool AreLost(const MapCounts& counts) {
  return counts.num_lost >= kFewLost && counts.num_lost > kMostLost * counts.num_scans;
}

/// Which unit or scale is another one than metres.
std::string QuestionOfWays(double ways_alike) {
  constexpr std::pair<double, const char*> kPerMetre[] = {{3.2808, "feet"},
                                                          {10.0, "decimetres"},
                                                          {39.37, "inches"},
                                                          {100.0, "centimetres"},
                                                          {1000.0, "millimetres"}};
  const bool is_longer = ways_alike > 1.0;
  const double factor = is_longer ? ways_alike : 1.0 / ways_alike;
  for (const auto& [per_metre, unit] : kPerMetre) {
    if (std::abs(factor / per_metre - 1.0) > kSameUnit) continue;
    return is_longer
               ? fmt::format("are the ranges in {}? Divide them by {:g}", unit, per_metre)
               : fmt::format("is the odometry in {}? Divide its x and y by {:g}", unit, per_metre);
  }
  return "are ranges and odometry both in metres? Else check the scale of the odometry (radius and "
         "ticks of the wheels)";
}

/// Where the beams' angles are the reason; empty: they cannot be.
std::string QuestionOfAngles(double turns_alike, double field_of_view) {
  if (turns_alike <= 0.0) return "";
  const double by_turns = field_of_view / turns_alike;
  if (field_of_view == 0.0 || by_turns > 2.0 * geometry::kPi * kMostAlike) return "";
  const double degrees = 180.0 / geometry::kPi;
  return fmt::format(
      "does the laser see {:.0f} degrees, as the odometry's turns say, and not the {:.0f} that the "
      "log says? Correct its angles (FLASER always means 180 degrees, ROBOTLASER1 says its own)",
      degrees * by_turns, degrees * field_of_view);
}

}  // namespace

MapEvidence EvidenceOf(const MapSketch& sketch, const OccupancyGrid& grid) {
  MapEvidence evidence;
  if (!sketch.scans.empty()) {
    const localisation::RobotLog::Scan& first = *sketch.scans.front();
    const std::size_t num_steps =
        first.reading.ranges.empty() ? 0 : first.reading.ranges.size() - 1;
    evidence.field_of_view =
        std::abs(first.reading.angle_increment) * static_cast<double>(num_steps);
    evidence.is_field_assumed = first.is_field_assumed;
  }
  evidence.returns = sketch.judge_returns();
  const double finer = grid.resolution / kJudgedCell;
  if (finer > 0.8 && finer < 1.25) {
    JudgeBeams(sketch, grid, &evidence);
  } else if (static_cast<double>(grid.cells.size()) * finer * finer <= kMostJudgedCells) {
    MapSketch other = sketch;
    other.resolution = kJudgedCell;
    JudgeBeams(other, Draw(other), &evidence);
  }
  return evidence;
}

std::string WhyDoubtful(const MapCounts& counts, const MapEvidence& evidence) {
  std::vector<std::string> against;
  const MapReturns& returns = evidence.returns;
  if (AreUntied(returns))
    against.push_back(fmt::format(
        "loops are not tied: at {} of {} places to which the drive came back scans do not fit what "
        "was seen there before",
        returns.num_apart, returns.num_judged));
  if (evidence.through_walls > kMostThrough)
    against.push_back(fmt::format("{:.1f} % of the beams went through walls of the map",
                                  100.0 * evidence.through_walls));
  if (evidence.explained < kLeastExplained)
    against.push_back(
        fmt::format("{:.0f} % of the beams ended at its walls", 100.0 * evidence.explained));
  if (AreTurnsUnlike(counts, evidence))
    against.push_back(counts.turns_alike < 0.0
                          ? "laser and odometry turn in opposite directions"
                          : fmt::format("the laser sees {:.0f} % of the turns that odometry tells",
                                        100.0 * counts.turns_alike));
  if (AreWaysUnlike(counts))
    against.push_back(
        fmt::format("the laser moves {:.3g} times as far as odometry tells", counts.ways_alike));
  if (DoDisagree(counts))
    against.push_back(
        fmt::format("laser and odometry disagreed on {} of {} stretches of 0.5 m or 0.5 rad",
                    counts.num_disagreed, counts.num_stretches));
  if (counts.num_breaks > 0)
    against.push_back(fmt::format(
        "breaks at which scans do not fit those before, and nothing ties both sides together: {}",
        counts.num_breaks));
  if (AreLost(counts))
    against.push_back(
        fmt::format("{} of {} scans fitted nothing", counts.num_lost, counts.num_scans));
  if (!against.empty() && counts.num_searched > 0)
    against.push_back(
        fmt::format("scans at which laser and odometry disagreed: {}", counts.num_searched));
  return base::Join(against, ", ");
}

std::string WhatToDo(const MapCounts& counts, const MapEvidence& evidence) {
  std::vector<std::string> remedies;
  if (counts.odometry_jumps > kMostJumps * counts.num_scans)
    remedies.push_back(fmt::format(
        "odometry jumped {} times at {} scans: is it in metres and radians, not in millimetres or "
        "degrees?",
        counts.odometry_jumps, counts.num_scans));
  if (AreWaysUnlike(counts)) remedies.push_back(QuestionOfWays(counts.ways_alike));
  const std::string angles = AreTurnsUnlike(counts, evidence)
                                 ? QuestionOfAngles(counts.turns_alike, evidence.field_of_view)
                                 : "";
  if (!angles.empty()) remedies.push_back(angles);
  if (evidence.explained < kLeastExplained || evidence.through_walls > kMostThrough ||
      AreTurnsUnlike(counts, evidence) || DoDisagree(counts))
    remedies.push_back(
        "check the order, angles and unit of the ranges, the laser's place on the robot, and the "
        "odometry");
  if (AreUntied(evidence.returns) || counts.num_breaks > 0 || evidence.through_walls > kMostThrough)
    remedies.push_back(
        "drive again, turn more slowly, and go on past a corner or door that was seen before, in "
        "the same direction");
  if (AreLost(counts)) remedies.push_back("drive where the laser reaches walls");
  return base::Join(remedies, "; ");
}

}  // namespace hires::mapping
