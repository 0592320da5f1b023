#include "localisation/beams.h"

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"

namespace hires::localisation {
namespace {

constexpr double kLastDigit = 0.01;                     // [m] of ranges in most files
constexpr double kFloatRounding = 1e-6;                 // of a float
constexpr double kOneTurn = 2.0 * geometry::kPi + 0.1;  // [rad] the last beam may be the first

ScanOutcome CheckAngles(const robot::ScanReading& scan) {
  if (scan.ranges.empty()) return ScanOutcome::kNoRanges;
  const double span = std::abs(scan.angle_increment) * static_cast<double>(scan.ranges.size() - 1);
  const bool is_good = std::isfinite(scan.angle_min) && std::isfinite(span) &&
                       scan.angle_increment != 0.0 && span <= kOneTurn;
  return is_good ? ScanOutcome::kUpdated : ScanOutcome::kBadAngles;
}

bool IsMeasured(double range, double shortest, double longest) {
  return range > 0.0 && range >= shortest && !HasMetNothing(range, longest);
}

}  // namespace

bool HasMetNothing(double range, double range_max) {
  return range_max > 0.0 && range >= (1.0 - kFloatRounding) * range_max - kLastDigit;
}

ScanOutcome Examine(const robot::ScanReading& scan, double shortest, double longest) {
  const ScanOutcome angles = CheckAngles(scan);
  if (angles != ScanOutcome::kUpdated) return angles;
  bool is_any_far = false;
  for (const double range : scan.ranges) {
    if (IsMeasured(range, shortest, longest)) return ScanOutcome::kUpdated;
    is_any_far = is_any_far || HasMetNothing(range, longest);
  }
  return is_any_far ? ScanOutcome::kNothingMet : ScanOutcome::kNothingMeasured;
}

std::string ToString(ScanOutcome outcome) {
  switch (outcome) {
    case ScanOutcome::kUpdated:
      return "used";
    case ScanOutcome::kNotMoved:
      return "not moved";
    case ScanOutcome::kNoRanges:
      return "no ranges";
    case ScanOutcome::kBadAngles:
      return "bad angles";
    case ScanOutcome::kNothingMeasured:
      return "nothing measured";
    case ScanOutcome::kNothingMet:
      return "nothing met within range";
    case ScanOutcome::kNotFinite:
      return "not finite";
    case ScanOutcome::kLate:
      return "late";
    case ScanOutcome::kTimeWentBack:
      return "time went back";
    case ScanOutcome::kOdometryJumped:
      return "odometry jumped";
  }
  return "unknown";
}

bool IsBad(ScanOutcome outcome) {
  return outcome != ScanOutcome::kUpdated && outcome != ScanOutcome::kNotMoved;
}

double RangeMax(const robot::ScanReading& scan, const BeamParams& params, double otherwise) {
  const bool is_said = std::isfinite(scan.range_max) && scan.range_max > 0.0;
  if (params.max_range <= 0.0) return is_said ? scan.range_max : otherwise;
  return is_said ? std::min(scan.range_max, params.max_range) : params.max_range;
}

ScanOutcome SelectBeams(const robot::ScanReading& scan, const geometry::Pose2& X_BL,
                        const BeamParams& params, Beams* beams) {
  *beams = {};
  const double shortest = params.min_range >= 0.0 ? params.min_range : scan.range_min;
  const double longest = RangeMax(scan, params, INFINITY);
  const ScanOutcome outcome = Examine(scan, shortest, longest);
  if (outcome != ScanOutcome::kUpdated) return outcome;
  if (!X_BL.IsFinite()) return ScanOutcome::kNotFinite;
  std::vector<std::size_t> measured;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i)
    if (IsMeasured(scan.ranges[i], shortest, longest)) measured.push_back(i);
  const std::size_t count = std::min<std::size_t>(params.most, measured.size());
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = measured[(2 * k + 1) * measured.size() / (2 * count)];
    const double angle = scan.angle_min + static_cast<double>(i) * scan.angle_increment;
    const double range = scan.ranges[i];
    const Eigen::Vector2d p_B =
        X_BL * Eigen::Vector2d(range * std::cos(angle), range * std::sin(angle));
    beams->x.push_back(static_cast<float>(p_B.x()));
    beams->y.push_back(static_cast<float>(p_B.y()));
  }
  return ScanOutcome::kUpdated;
}

}  // namespace hires::localisation
