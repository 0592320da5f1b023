#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "hires/base/check.h"

namespace hires::base {

/// 0 for no values. Summed in their order.
inline double Mean(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The upper one of two middles.
/// @throws std::logic_error if there are no values
template <typename T>
T Median(std::vector<T> values) {
  HIRES_CHECK(!values.empty(), "no values have no median");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace hires::base
