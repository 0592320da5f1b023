#include "hires/localisation/filtered_log.h"

#include "hires/geometry/angles.h"

namespace hires::localisation {
namespace {

using Inertia = RobotLog::Inertia;

constexpr double kLongestStep = 0.25;  // [s] over which a rate is integrated

/// Hands a unit's readings to the filter, each with a yaw. They must outlive it.
class HeadingFeed {
 public:
  explicit HeadingFeed(OdometryFilter* filter) : filter_(*filter) {}

  void Take(const Inertia& now) {
    if (before_ && !IsSameZero(*before_, now)) filter_.BeginNewZero();
    if (now.yaw) {
      yaw_ = *now.yaw;
    } else if (before_ && IsSameZero(*before_, now)) {
      const double turn = 0.5 * (before_->yaw_rate + now.yaw_rate) * (now.time - before_->time);
      yaw_ = geometry::WrapToPi(yaw_ + turn);
    }
    filter_.OnInertia(now.time, {yaw_, now.yaw_rate});
    before_ = &now;
  }

 private:
  static bool IsSameZero(const Inertia& before, const Inertia& now) {
    if (before.yaw || now.yaw) return before.yaw && now.yaw;
    return now.time - before.time <= kLongestStep;
  }

  OdometryFilter& filter_;
  const Inertia* before_{nullptr};
  double yaw_{0.0};
};

}  // namespace

int FilterOdometry(const OdometryFilterParams& params, RobotLog* log) {
  OdometryFilter filter(params);
  HeadingFeed unit(&filter);
  int num_resets = 0;
  auto next = log->inertia.begin();
  for (RobotLog::Odometry& odometry : log->odometry) {
    for (; next != log->inertia.end() && next->time <= odometry.time; ++next) unit.Take(*next);
    const FilterOutcome outcome = filter.OnOdometry(odometry.time, {odometry.reading.X_OB, {}});
    if (outcome == FilterOutcome::kJumped) ++num_resets;
    odometry.reading.X_OB = filter.X_FB();
  }
  return num_resets;
}

}  // namespace hires::localisation
