#pragma once

#include <vector>

#include "hires/geometry/pose.h"
#include "hires/localisation/scan_outcome.h"
#include "hires/robot/readings.h"

namespace hires::localisation {

struct BeamParams {
  int most{60};            ///< beams of a scan that are used
  double min_range{-1.0};  ///< [m] shorter ones are left out; negative: as the scan says
  double max_range{-1.0};  ///< [m] as long or longer ones met nothing; negative, or more than the
                           ///< scan says: as that says
};

/// Where beams ended, in the robot's base [m].
struct Beams {
  std::vector<float> x, y;
  std::size_t size() const { return x.size(); }
};

/// Whether a range [m] is what a laser of that `range_max` [m] says where nothing was met: as long,
/// or up to a centimetre shorter, as files round both to their digits, and ranges to `float`, which
/// makes 5.5999999 of 5.6. A `range_max` of 0 or less says nothing.
bool HasMetNothing(double range, double range_max);

/// Beams that measured something, evenly spread over all that did.
/// @return kUpdated, or why there are none.
ScanOutcome SelectBeams(const robot::ScanReading& scan, const geometry::Pose2& X_BL,
                        const BeamParams& params, Beams* beams);

/// [m] from where on nothing was met: the smaller one of what scan and parameters say, as AMCL
/// takes it; `otherwise` where neither does.
double RangeMax(const robot::ScanReading& scan, const BeamParams& params, double otherwise);

}  // namespace hires::localisation
