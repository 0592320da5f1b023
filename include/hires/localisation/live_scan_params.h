#pragma once

#include "hires/base/param_reader.h"

namespace hires::localisation {

/// What nodes need that hear scans while they are made.
struct LiveScanParams {
  bool tf_broadcast{true};          ///< tells tf where the odometry's frame is in the map
  double transform_tolerance{0.1};  ///< [s] by which that transform is dated after its scan
  double max_age{3.0};              ///< [s] of a scan, whether it came late or waited for tf
  double max_ahead{0.5};            ///< [s] that its stamp may lie in the future, by wall clocks
};

/// Other keys may stand beside them.  @throws base::ConfigError naming the key
LiveScanParams ReadLiveScanParams(base::ParamReader* in);

}  // namespace hires::localisation
