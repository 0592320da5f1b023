#pragma once

#include <cstddef>
#include <vector>

namespace hires::lab {

// Filters of evenly sampled signals (dissertation, section 6.3.1). Beyond a signal's ends its first
// and last value go on.

/// Mean of `window` samples. @param is_causal  of the last ones, else around each.  @pre window
/// odd.
std::vector<double> MovingAverage(const std::vector<double>& signal, std::size_t window,
                                  bool is_causal);

/// Median of `window` samples, likewise.
std::vector<double> MovingMedian(const std::vector<double>& signal, std::size_t window,
                                 bool is_causal);

/// A second-order section in direct form: y = b0 x + b1 x' + b2 x'' - a1 y' - a2 y''.
struct SecondOrderSection {
  double b0{1.0}, b1{0.0}, b2{0.0}, a1{0.0}, a2{0.0};
};

/// Butterworth low pass of order two by the bilinear transform with its cutoff prewarped
/// [Oppenheim, Schafer, Discrete-Time Signal Processing, section 7.1].
/// @param cutoff  [Hz] of -3 dB.  @param rate  [Hz] of samples.  @pre 0 < cutoff < rate / 2.
SecondOrderSection ButterworthLowPass(double cutoff, double rate);

/// @param is_causal  once forward, else forward and backward: no delay, twice the order.
std::vector<double> Filtered(const std::vector<double>& signal, const SecondOrderSection& section,
                             bool is_causal);

/// Normalised autocorrelation of lags 0 .. max_lag; 1 at lag 0, all 0 for a constant signal.
std::vector<double> Autocorrelation(const std::vector<double>& signal, std::size_t max_lag);

/// Derivative by central differences, one-sided at the ends.  @param period  [s] of samples.
std::vector<double> CentralDifferences(const std::vector<double>& signal, double period);

/// Lag by which `later` follows `signal` best: that of their largest cross-correlation.
std::size_t DelayOf(const std::vector<double>& signal, const std::vector<double>& later,
                    std::size_t max_lag);

}  // namespace hires::lab
