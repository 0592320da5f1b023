#include "localisation/way_comparison.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/averages.h"
#include "hires/geometry/angles.h"

namespace hires::localisation {
namespace {

constexpr double kSignificant = 3.0;   // standard errors
constexpr double kLeastMore = 0.005;   // of the beams
constexpr std::size_t kFewScans = 10;  // whose spread tells nothing
constexpr double kFewPoses = 0.5;      // of those that the other way has
constexpr double kSamePath = 1.0;      // [m] at most, in the median
constexpr double kSameHeading = 0.5;   // [rad] likewise

/// Whether one way has poses for less than half as many scans as the other.
bool LacksPoses(const ExplainedShares& a, const ExplainedShares& b) {
  const auto count = [](const ExplainedShares& shares) {
    return std::count_if(shares.begin(), shares.end(),
                         [](const std::optional<double>& share) { return share.has_value(); });
  };
  return static_cast<double>(count(a)) < kFewPoses * static_cast<double>(count(b));
}

/// Of the scans that both ways have poses for.
bool ExplainsMore(const ExplainedShares& a, const ExplainedShares& b) {
  std::vector<double> more;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i] && b[i]) more.push_back(*a[i] - *b[i]);
  const std::size_t count = more.size();
  if (count < kFewScans) return false;
  const double mean = base::Mean(more);
  double squares = 0.0;
  for (const double value : more) squares += (value - mean) * (value - mean);
  const double error = std::sqrt(squares / static_cast<double>((count - 1) * count));
  return mean >= kLeastMore && mean > kSignificant * error;
}

}  // namespace

const TimedPose* PoseAt(const TimedPath& path, double time) {
  const auto at = std::lower_bound(path.begin(), path.end(), time,
                                   [](const TimedPose& pose, double t) { return pose.time < t; });
  return at != path.end() && at->time == time ? &*at : nullptr;
}

MeanShares MeanExplained(const ExplainedShares& a, const ExplainedShares& b) {
  MeanShares mean;
  int count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!a[i] || !b[i]) continue;
    mean.a += *a[i];
    mean.b += *b[i];
    ++count;
  }
  if (count > 0) mean = {mean.a / count, mean.b / count};
  return mean;
}

TimedPath PosesApart(const TimedPath& path, double distance, double turn) {
  TimedPath apart;
  for (const TimedPose& pose : path) {
    if (!apart.empty()) {
      const geometry::Pose2 step = apart.back().X_MB.Inverse() * pose.X_MB;
      const bool has_turned = std::abs(geometry::WrapToPi(step.yaw)) >= turn;
      if (step.position().norm() < distance && !has_turned) continue;
    }
    apart.push_back(pose);
  }
  return apart;
}

bool IsBetter(const ExplainedShares& a, const ExplainedShares& b) {
  if (LacksPoses(a, b) || LacksPoses(b, a)) return LacksPoses(b, a);
  const MeanShares mean = MeanExplained(a, b);
  return mean.a > mean.b;
}

bool IsSignificantlyBetter(const ExplainedShares& a, const ExplainedShares& b) {
  if (LacksPoses(b, a)) return !ExplainsMore(b, a);
  return !LacksPoses(a, b) && ExplainsMore(a, b);
}

bool IsSameWay(const TimedPath& a, const TimedPath& b) {
  std::vector<double> off, turned;
  for (const TimedPose& pose : a) {
    const TimedPose* other = PoseAt(b, pose.time);
    if (!other) continue;
    off.push_back((other->X_MB.position() - pose.X_MB.position()).norm());
    turned.push_back(std::abs(geometry::WrapToPi(other->X_MB.yaw - pose.X_MB.yaw)));
  }
  return !off.empty() && base::Median(off) <= kSamePath && base::Median(turned) <= kSameHeading;
}

}  // namespace hires::localisation
