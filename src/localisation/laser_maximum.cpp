#include "localisation/laser_maximum.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

#include "localisation/beams.h"

namespace hires::localisation {
namespace {

constexpr float kExceeding = 0.15F;         // [m] that others may be longer
constexpr double kLeastFrequent = 0.005;    // of the beams
constexpr double kLeastBeside = 0.5;        // of those: the beam before or behind is one, too
constexpr double kLeastOvershoot = 3.0;     // times as many as ...
constexpr float kAbout = 0.1F;              // [m] ... up to that shorter or longer
constexpr double kManyBeams = 0.05;         // of all, in which it is enough to be ...
constexpr double kMuchMoreFrequent = 10.0;  // times as frequent as any other one about it
constexpr double kLeastApart = 0.5;         // [m] the places from which

template <typename Use>
void ForEachRange(const RobotLog& log, const Use& use) {
  for (const RobotLog::Scan& scan : log.scans)
    for (const float range : scan.reading.ranges)
      if (std::isfinite(range)) use(range);
}

/// The most frequent one of those that are about the largest; noise may make a few exceed it.
float FrequentLargestRange(const RobotLog& log) {
  float largest = 0.0F;
  ForEachRange(log, [&](float range) { largest = std::max(largest, range); });
  std::map<float, std::size_t> counts;
  ForEachRange(log, [&](float range) {
    if (range >= largest - kExceeding) ++counts[range];
  });
  const auto rarer = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto most = std::max_element(counts.begin(), counts.end(), rarer);
  return most == counts.end() ? 0.0F : most->first;
}

/// How often a range stands in a log.
class RangeCount {
 public:
  explicit RangeCount(float range) : range_(range) {}

  /// @param p_O  where the robot was.
  void Take(const RobotLog::Scan& scan, const Eigen::Vector2d& p_O) {
    const std::vector<float>& ranges = scan.reading.ranges;
    const std::size_t before = num_equal_;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      if (std::isnan(ranges[i])) continue;
      ++num_all_;
      if (ranges[i] == range_) {
        ++num_equal_;
        const bool is_beside = (i > 0 && ranges[i - 1] == range_) ||
                               (i + 1 < ranges.size() && ranges[i + 1] == range_);
        if (is_beside) ++num_beside_;
      } else if (std::abs(ranges[i] - range_) < kAbout) {
        ++num_about_;
        num_most_frequent_ = std::max(num_most_frequent_, ++others_[ranges[i]]);
      }
    }
    if (num_equal_ == before) return;
    if (before == 0) first_O_ = p_O;
    is_from_apart_ = is_from_apart_ || (p_O - first_O_).norm() > kLeastApart;
  }
  double share() const { return num_all_ > 0 ? static_cast<double>(num_equal_) / num_all_ : 0.0; }
  bool IsOfNothing() const {
    const bool stands_out =
        num_equal_ > kLeastOvershoot * num_about_ ||
        (share() > kManyBeams && num_equal_ > kMuchMoreFrequent * num_most_frequent_);
    return share() > kLeastFrequent && num_beside_ > kLeastBeside * num_equal_ && stands_out &&
           is_from_apart_;
  }

 private:
  float range_;
  std::size_t num_all_{0}, num_equal_{0}, num_beside_{0}, num_about_{0};
  std::map<float, std::size_t> others_;  // of those about it, how often each stands in the log
  std::size_t num_most_frequent_{0};
  Eigen::Vector2d first_O_{Eigen::Vector2d::Zero()};  // the first place with one
  bool is_from_apart_{false};
};

}  // namespace

std::string TakeLaserMaximum(RobotLog* log) {
  if (log->odometry.empty()) return "";
  const float largest = FrequentLargestRange(*log);
  RangeCount count(largest);
  for (const RobotLog::Scan& scan : log->scans) {
    if (largest == 0.0F || HasMetNothing(largest, scan.reading.range_max)) return "";
    const auto at = std::lower_bound(
        log->odometry.begin(), log->odometry.end(), scan.time,
        [](const RobotLog::Odometry& odometry, double time) { return odometry.time < time; });
    const auto& nearest = at == log->odometry.end() ? log->odometry.back() : *at;
    count.Take(scan, nearest.reading.X_OB.position());
  }
  if (!count.IsOfNothing()) return "";
  for (RobotLog::Scan& scan : log->scans) scan.reading.range_max = largest;
  return fmt::format(
      "{:.4g} m is the largest range, in {:.1f} % of the beams and in many side by side: taken as "
      "what the laser says where it meets nothing",
      largest, 100.0 * count.share());
}

}  // namespace hires::localisation
