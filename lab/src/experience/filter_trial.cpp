#include "lab/src/experience/filter_trial.h"

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "lab/src/experience/filters.h"
#include "lab/src/experience/separation.h"
#include "lab/src/interval_json.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;

constexpr double kRate = 1.0 / knowledge::kExperiencePeriod;  // [Hz]
// [m] of each measured position, white: what the filter of wheels and laser leaves from one sample
// to the next, an assumption; the dissertation does not say how noisy its data were.
constexpr double kNoise = 0.001;
constexpr double kStillAlike = 0.9;          // autocorrelation down to which a window may reach
constexpr std::size_t kMaxLag = 40;          // samples
constexpr std::size_t kLeastOfStretch = 40;  // of a stretch
// -3 dB of a moving average of n samples lies at 0.443 / n of the rate.
constexpr double kCutoffOfAverage = 0.443;

using Signal = std::vector<double>;
using Filter = std::function<Signal(const Signal&)>;

/// One stretch: what was measured, what is true, and what the load did.
struct Measured {
  Signal speed;                   // [m/s], noisy
  Signal true_v, true_a, true_j;  // [m/s], ...
  std::vector<knowledge::ToppleState> states;
};

Signal SpeedOf(const Signal& x, const Signal& y) {
  Signal speed(x.size(), 0.0);
  for (std::size_t i = 1; i < x.size(); ++i) {
    speed[i] = std::hypot(x[i] - x[i - 1], y[i] - y[i - 1]) / knowledge::kExperiencePeriod;
  }
  if (speed.size() > 1) speed[0] = speed[1];
  return speed;
}

Measured MeasureStretch(const Stretch& stretch, base::Rng rng) {
  Measured measured;
  Signal x, y, true_x, true_y;
  for (const knowledge::ToppleEpisodePart& part : stretch) {
    true_x.push_back(part.x);
    true_y.push_back(part.y);
    x.push_back(part.x + rng.Normal(0.0, kNoise));
    y.push_back(part.y + rng.Normal(0.0, kNoise));
    measured.states.push_back(part.state);
  }
  measured.speed = SpeedOf(x, y);
  measured.true_v = SpeedOf(true_x, true_y);
  measured.true_a = CentralDifferences(measured.true_v, knowledge::kExperiencePeriod);
  measured.true_j = CentralDifferences(measured.true_a, knowledge::kExperiencePeriod);
  return measured;
}

/// By run, in order.
std::vector<std::vector<Measured>> MeasureAll(const std::vector<ExperienceRun>& runs,
                                              const base::Rng& rng) {
  std::vector<std::vector<Measured>> all;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    all.emplace_back();
    for (std::size_t s = 0; s < runs[r].stretches.size(); ++s) {
      if (runs[r].stretches[s].size() < kLeastOfStretch) continue;
      all.back().push_back(MeasureStretch(runs[r].stretches[s], rng.Fork(r).Fork(s)));
    }
  }
  return all;
}

/// Mean over stretches.
Signal MeanAutocorrelation(const std::vector<std::vector<Measured>>& all) {
  Signal mean(kMaxLag + 1, 0.0);
  double count = 0.0;
  for (const std::vector<Measured>& run : all) {
    for (const Measured& stretch : run) {
      const Signal one = Autocorrelation(stretch.speed, kMaxLag);
      for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += one[i];
      count += 1.0;
    }
  }
  for (double& value : mean) value /= std::max(count, 1.0);
  return mean;
}

/// The largest odd window whose outermost samples still look like its middle.
std::size_t WindowFrom(const Signal& autocorrelation) {
  std::size_t lag = 1;
  while (lag + 1 < autocorrelation.size() && autocorrelation[lag + 1] >= kStillAlike) ++lag;
  return 2 * (lag / 2) + 1 < 3 ? 3 : 2 * (lag / 2) + 1;
}

struct Errors {
  double v{0.0}, a{0.0}, j{0.0}, count{0.0};  // sums of squares
  double delay{0.0}, stretches{0.0};          // [samples]
};

void AddErrors(const Measured& stretch, const Signal& v, Errors* errors) {
  const Signal a = CentralDifferences(v, knowledge::kExperiencePeriod);
  const Signal j = CentralDifferences(a, knowledge::kExperiencePeriod);
  for (std::size_t i = 0; i < v.size(); ++i) {
    errors->v += std::pow(v[i] - stretch.true_v[i], 2);
    errors->a += std::pow(a[i] - stretch.true_a[i], 2);
    errors->j += std::pow(j[i] - stretch.true_j[i], 2);
  }
  errors->count += static_cast<double>(v.size());
  errors->delay += static_cast<double>(DelayOf(stretch.true_v, v, kMaxLag));
  errors->stretches += 1.0;
}

/// Shaking against not toppling by |a|.
void AddScores(const Measured& stretch, const Signal& v, RunScores* scores) {
  const Signal a = CentralDifferences(v, knowledge::kExperiencePeriod);
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (stretch.states[i] == knowledge::ToppleState::kShaking) {
      scores->positive.push_back(std::abs(a[i]));
    } else if (stretch.states[i] == knowledge::ToppleState::kNoTopple) {
      scores->negative.push_back(std::abs(a[i]));
    }
  }
}

/// @param kinds  of the runs, for resampling.
ordered_json TryOne(const std::string& name, bool is_causal, const Filter& filter,
                    const std::vector<std::vector<Measured>>& all,
                    const std::vector<std::string>& kinds, const base::Rng& rng) {
  Errors errors;
  std::vector<RunScores> scores(all.size());
  for (std::size_t r = 0; r < all.size(); ++r) {
    for (const Measured& stretch : all[r]) {
      const Signal v = filter(stretch.speed);
      AddErrors(stretch, v, &errors);
      AddScores(stretch, v, &scores[r]);
    }
  }
  const auto root = [&](double squares) { return std::sqrt(squares / errors.count); };
  const Interval area = AreaInterval(StrataOf(scores, kinds), rng);
  return {{"filter", name},
          {"causal", is_causal},
          {"rms_error", {{"v", root(errors.v)}, {"a", root(errors.a)}, {"j", root(errors.j)}}},
          {"delay", knowledge::kExperiencePeriod * errors.delay / errors.stretches},
          {"separation", IntervalJson(area)}};
}

}  // namespace

ordered_json TryFilters(const std::vector<ExperienceRun>& runs, const base::Rng& rng) {
  enum Streams : std::uint64_t { kNoiseStream, kResampleStream };
  const auto all = MeasureAll(runs, rng.Fork(kNoiseStream));
  const std::vector<std::string> kinds = MotionSetsOf(runs);
  const Signal autocorrelation = MeanAutocorrelation(all);
  const std::size_t window = WindowFrom(autocorrelation);
  const double cutoff = kCutoffOfAverage * kRate / static_cast<double>(window);
  const SecondOrderSection section = ButterworthLowPass(cutoff, kRate);
  ordered_json filters = ordered_json::array();
  const base::Rng resampling = rng.Fork(kResampleStream);
  filters.push_back(TryOne(
      "none", false, [](const Signal& v) { return v; }, all, kinds, resampling));
  for (const bool is_causal : {false, true}) {
    filters.push_back(TryOne(
        "moving average", is_causal,
        [&](const Signal& v) { return MovingAverage(v, window, is_causal); }, all, kinds,
        resampling));
    filters.push_back(TryOne(
        "median", is_causal, [&](const Signal& v) { return MovingMedian(v, window, is_causal); },
        all, kinds, resampling));
    filters.push_back(TryOne(
        "Butterworth", is_causal, [&](const Signal& v) { return Filtered(v, section, is_causal); },
        all, kinds, resampling));
  }
  return {{"noise", kNoise},
          {"autocorrelation", autocorrelation},
          {"window", window},
          {"cutoff", cutoff},
          {"filters", filters}};
}

}  // namespace hires::lab
