#include "lab/src/experience/filters.h"

#include <algorithm>
#include <cmath>

#include "base/averages.h"
#include "hires/geometry/angles.h"
#include "lab/src/statistics.h"

namespace hires::lab {
namespace {

/// Calls `take` with each window of the signal, its ends going on.
template <typename Take>
std::vector<double> OverWindows(const std::vector<double>& signal, std::size_t window,
                                bool is_causal, const Take& take) {
  const auto size = static_cast<std::ptrdiff_t>(signal.size());
  const auto width = static_cast<std::ptrdiff_t>(window);
  const std::ptrdiff_t before = is_causal ? width - 1 : width / 2;
  std::vector<double> filtered(signal.size()), values(window);
  for (std::ptrdiff_t i = 0; i < size; ++i) {
    for (std::ptrdiff_t k = 0; k < width; ++k) {
      values[k] = signal[std::clamp(i - before + k, std::ptrdiff_t{0}, size - 1)];
    }
    filtered[i] = take(&values);
  }
  return filtered;
}

/// Begins as if the first value had been there for ever.
std::vector<double> Forward(const std::vector<double>& signal, const SecondOrderSection& s) {
  std::vector<double> filtered;
  filtered.reserve(signal.size());
  if (signal.empty()) return filtered;
  double x1 = signal[0], x2 = x1, y1 = x1, y2 = x1;
  for (const double x : signal) {
    const double y = s.b0 * x + s.b1 * x1 + s.b2 * x2 - s.a1 * y1 - s.a2 * y2;
    x2 = x1;
    x1 = x;
    y2 = y1;
    y1 = y;
    filtered.push_back(y);
  }
  return filtered;
}

double Correlation(const std::vector<double>& a, double mean_a, const std::vector<double>& b,
                   double mean_b, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = 0; i + lag < a.size(); ++i) sum += (a[i] - mean_a) * (b[i + lag] - mean_b);
  return sum;
}

}  // namespace

std::vector<double> MovingAverage(const std::vector<double>& signal, std::size_t window,
                                  bool is_causal) {
  return OverWindows(signal, window, is_causal,
                     [](const std::vector<double>* values) { return base::Mean(*values); });
}

std::vector<double> MovingMedian(const std::vector<double>& signal, std::size_t window,
                                 bool is_causal) {
  return OverWindows(signal, window, is_causal,
                     [](const std::vector<double>* values) { return base::Median(*values); });
}

SecondOrderSection ButterworthLowPass(double cutoff, double rate) {
  const double k = std::tan(geometry::kPi * cutoff / rate);
  const double norm = 1.0 / (1.0 + std::sqrt(2.0) * k + k * k);
  SecondOrderSection s;
  s.b0 = k * k * norm;
  s.b1 = 2.0 * s.b0;
  s.b2 = s.b0;
  s.a1 = 2.0 * (k * k - 1.0) * norm;
  s.a2 = (1.0 - std::sqrt(2.0) * k + k * k) * norm;
  return s;
}

std::vector<double> Filtered(const std::vector<double>& signal, const SecondOrderSection& section,
                             bool is_causal) {
  std::vector<double> filtered = Forward(signal, section);
  if (is_causal) return filtered;
  std::reverse(filtered.begin(), filtered.end());
  filtered = Forward(filtered, section);
  std::reverse(filtered.begin(), filtered.end());
  return filtered;
}

std::vector<double> Autocorrelation(const std::vector<double>& signal, std::size_t max_lag) {
  const double mean = base::Mean(signal);
  std::vector<double> correlation(max_lag + 1, 0.0);
  const double whole = Correlation(signal, mean, signal, mean, 0);
  if (whole == 0.0) return correlation;
  for (std::size_t lag = 0; lag <= max_lag; ++lag) {
    correlation[lag] = Correlation(signal, mean, signal, mean, lag) / whole;
  }
  return correlation;
}

std::vector<double> CentralDifferences(const std::vector<double>& signal, double period) {
  std::vector<double> derivative(signal.size(), 0.0);
  if (signal.size() < 2) return derivative;
  const std::size_t last = signal.size() - 1;
  derivative[0] = (signal[1] - signal[0]) / period;
  derivative[last] = (signal[last] - signal[last - 1]) / period;
  for (std::size_t i = 1; i < last; ++i) {
    derivative[i] = (signal[i + 1] - signal[i - 1]) / (2.0 * period);
  }
  return derivative;
}

std::size_t DelayOf(const std::vector<double>& signal, const std::vector<double>& later,
                    std::size_t max_lag) {
  const double mean_a = base::Mean(signal), mean_b = base::Mean(later);
  std::size_t best = 0;
  double most = Correlation(signal, mean_a, later, mean_b, 0);
  for (std::size_t lag = 1; lag <= max_lag; ++lag) {
    const double found = Correlation(signal, mean_a, later, mean_b, lag);
    if (found <= most) continue;
    most = found;
    best = lag;
  }
  return best;
}

}  // namespace hires::lab
