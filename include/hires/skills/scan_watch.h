#pragma once

#include <memory>
#include <optional>

#include "hires/robot/observation.h"

namespace hires::skills {

/// [s] A scan that is older tells nothing of now.
constexpr double kScanPatience = 1.0;

/// Tells what is new between two looks of a skill at its robot. A value.
class ScanWatch {
 public:
  struct News {
    /// The odometry was reset, or its clock: where anything was seen before, nobody knows any more.
    bool is_reset{false};
    /// Not looked at yet, and taken within kScanPatience; null: none.
    std::shared_ptr<const robot::PlacedScan> scan;
  };

  News Look(const robot::Observation& observation);

 private:
  std::shared_ptr<const robot::PlacedScan> scan_;
  struct Odometry {
    double time;  // [s]
    geometry::Pose2 X_OB;
  };
  std::optional<Odometry> before_;
};

}  // namespace hires::skills
