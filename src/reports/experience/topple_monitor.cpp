#include "reports/experience/topple_monitor.h"

#include <algorithm>
#include <cmath>

#include "hires/geometry/angles.h"

namespace hires::reports {
namespace {

using knowledge::Dynamics;
using knowledge::ToppleState;

/// What three successive rates tell of their middle.
struct Derivatives {
  double v, a, j;
};

Derivatives Differentiate(const std::array<double, 3>& rates, double dt) {
  return {rates[1], (rates[2] - rates[0]) / (2.0 * dt),
          (rates[2] - 2.0 * rates[1] + rates[0]) / (dt * dt)};
}

/// @param way  from one sample to the next [m], @param turn  likewise [rad].
template <typename Way, typename Turn>
Dynamics DynamicsOf(const std::array<ToppleSample, 4>& samples, const Way& way, const Turn& turn) {
  std::array<double, 3> linear, angular;
  for (std::size_t i = 0; i < 3; ++i) {
    const double dt = samples[i + 1].time - samples[i].time;
    linear[i] = way(samples[i], samples[i + 1]) / dt;
    angular[i] = std::abs(turn(samples[i], samples[i + 1])) / dt;
  }
  const double period = (samples[3].time - samples[0].time) / 3.0;
  const Derivatives l = Differentiate(linear, period), a = Differentiate(angular, period);
  return {l.v, l.a, l.j, a.v, a.a, a.j};
}

double TiltOf(const ToppleSample& sample) { return geometry::TiltOf(sample.X_MO.rotation); }

ToppleState StateOf(double tilt, const imagination::RolloutParams& params) {
  const imagination::OutcomeCounts counts = imagination::SampleOf(tilt, params);
  if (counts.topple > 0) return ToppleState::kTopple;
  return counts.shaking > 0 ? ToppleState::kShaking : ToppleState::kNoTopple;
}

}  // namespace

void ToppleMonitor::Begin() { num_samples_ = 0; }

std::optional<knowledge::ToppleEpisodePart> ToppleMonitor::Add(const ToppleSample& sample) {
  const ToppleState state = StateOf(TiltOf(sample), params_);
  if (IsPutBack(state)) Begin();
  if (num_samples_ == 0) X_BO_start_ = sample.X_BO;
  std::rotate(last_.begin(), last_.begin() + 1, last_.end());
  last_.back() = sample;
  if (++num_samples_ < kSamples) return std::nullopt;
  knowledge::ToppleEpisodePart part;
  part.time = sample.time;
  part.episode = episode_;
  part.state = state;
  part.alpha = TiltOf(sample);
  part.deviation = (sample.X_BO.translation - X_BO_start_.translation).head<2>().norm();
  part.object = DynamicsOf(
      last_,
      [](const auto& a, const auto& b) { return (b.X_MO.translation - a.X_MO.translation).norm(); },
      [](const auto& a, const auto& b) { return TiltOf(b) - TiltOf(a); });
  part.base = DynamicsOf(
      last_,
      [](const auto& a, const auto& b) {
        return std::hypot(b.X_MB.x - a.X_MB.x, b.X_MB.y - a.X_MB.y);
      },
      [](const auto& a, const auto& b) { return geometry::WrapToPi(b.X_MB.yaw - a.X_MB.yaw); });
  part.x = sample.X_MB.x;
  part.y = sample.X_MB.y;
  part.yaw = sample.X_MB.yaw;
  return part;
}

/// It stands again after it lay: an episode is over, and its way back is no motion.
bool ToppleMonitor::IsPutBack(ToppleState state) {
  const bool is_down = state == ToppleState::kTopple;
  const bool is_put_back = has_fallen_ && !is_down;
  if (is_put_back) ++episode_;
  has_fallen_ = is_down;
  return is_put_back;
}

}  // namespace hires::reports
