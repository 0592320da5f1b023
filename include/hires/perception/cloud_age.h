#pragma once

namespace hires::perception {

struct CloudAgeParams {
  double max_age{3.0};    ///< [s] of a cloud, whether it came late or waited for its transform
  double max_ahead{0.5};  ///< [s] that its stamp may lie in the future: clocks of two computers
};

enum class CloudAge { kTimely, kTooOld, kAhead };

/// Whether a cloud is of now, by its stamp. Both times [s] are of one clock.
CloudAge AgeOf(double stamp, double now, const CloudAgeParams& params);

}  // namespace hires::perception
