#pragma once

#include <Eigen/Core>

#include "hires/geometry/pose.h"
#include "localisation/particles.h"

namespace hires::localisation {

constexpr double kClusterThatCounts = 0.05;  ///< share of the weight; less is random particles

/// Particles in a few numbers.
struct BeliefSummary {
  geometry::Pose2 X_MB;  ///< mean of the heaviest cluster, yaw by the circular mean
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};  ///< around it, over clusters that count
  double best_spread{0.0};  ///< [m] largest standard deviation of the heaviest cluster's position
  double best_share{0.0};
  int num_clusters{0};  ///< that count
};

BeliefSummary Summarise(const Particles& particles);
/// All particles as one cluster: quick where they are all over the map.
BeliefSummary SummariseAsOne(const Particles& particles);

}  // namespace hires::localisation
