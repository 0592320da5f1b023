#pragma once

#include <string>

#include "hires/base/rng.h"
#include "hires/geometry/pose.h"

namespace hires::localisation {

/// AMCL's models of how wheel odometry errs. `diff` and `omni` take as standard deviation what the
/// corrected ones take as variance, as AMCL does for robots that were tuned with it.
enum class MotionKind { kDiff, kOmni, kDiffCorrected, kOmniCorrected };

struct OdometryModelParams {
  MotionKind kind{MotionKind::kOmni};
  double alpha1{0.2};  ///< turning by turning; omni: moving and strafing by turning
  double alpha2{0.2};  ///< turning by moving
  double alpha3{0.8};  ///< moving by moving
  double alpha4{0.2};  ///< moving by turning; omni: turning by turning
  double alpha5{0.1};  ///< omni alone: strafing by moving
};

MotionKind MotionKindOf(const std::string& name);  ///< as AMCL spells it.  @pre one of them

/// What happened between two readings of the odometry, ready to be sampled many times
/// [Thrun, Burgard, Fox 2005, Probabilistic Robotics, 5.4].
class MotionSampler {
 public:
  /// @param X_AB  how the base moved, seen from where it was.  @pre finite
  MotionSampler(const OdometryModelParams& params, const geometry::Pose2& X_AB);

  /// A motion that may as well have led to that reading, seen from where the base was.
  geometry::Pose2 Sample(base::Rng* rng) const;

 private:
  geometry::Pose2 SampleDiff(base::Rng* rng) const;
  geometry::Pose2 SampleOmni(base::Rng* rng) const;

  bool is_omni_;
  double trans_, bearing_, turn_;  // [m, rad]; diff: turn_ follows the move
  double sd_trans_, sd_bearing_, sd_turn_, sd_strafe_;
};

}  // namespace hires::localisation
