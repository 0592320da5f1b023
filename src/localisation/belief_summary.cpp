#include "localisation/belief_summary.h"

#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/geometry/covariance.h"

namespace hires::localisation {
namespace {

using geometry::Pose2;

Pose2 MeanOf(const Particles& particles, const Clusters& clusters, int cluster) {
  double x = 0.0, y = 0.0, c = 0.0, s = 0.0, total = 0.0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (clusters.cluster_of[i] != cluster) continue;
    const double w = particles.weight[i];
    total += w;
    x += w * particles.x[i];
    y += w * particles.y[i];
    c += w * std::cos(particles.yaw[i]);
    s += w * std::sin(particles.yaw[i]);
  }
  return {x / total, y / total, std::atan2(s, c)};
}

/// Over the clusters 0 .. count - 1, around a pose.
Eigen::Matrix3d CovarianceOf(const Particles& particles, const Clusters& clusters, int count,
                             const Pose2& X_MB) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double total = 0.0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (clusters.cluster_of[i] >= count) continue;
    const Eigen::Vector3d off(particles.x[i] - X_MB.x, particles.y[i] - X_MB.y,
                              geometry::WrapToPi(particles.yaw[i] - X_MB.yaw));
    sum += particles.weight[i] * off * off.transpose();
    total += particles.weight[i];
  }
  return sum / total;
}

BeliefSummary SummariseClusters(const Particles& particles, const Clusters& clusters) {
  BeliefSummary summary;
  for (double weight : clusters.weights) summary.num_clusters += weight >= kClusterThatCounts;
  summary.best_share = clusters.weights.front();
  summary.X_MB = MeanOf(particles, clusters, 0);
  const Eigen::Matrix3d best = CovarianceOf(particles, clusters, 1, summary.X_MB);
  summary.best_spread = geometry::LargestSd(best(0, 0), best(0, 1), best(1, 1));
  // Where no cluster counts, the belief is all over the map.
  const int most = static_cast<int>(clusters.weights.size());
  const int counted = summary.num_clusters > 0 ? summary.num_clusters : most;
  summary.covariance =
      counted == 1 ? best : CovarianceOf(particles, clusters, counted, summary.X_MB);
  return summary;
}

}  // namespace

BeliefSummary Summarise(const Particles& particles) {
  return SummariseClusters(particles, ClustersOf(particles));
}

BeliefSummary SummariseAsOne(const Particles& particles) {
  return SummariseClusters(particles, {std::vector<int>(particles.size(), 0), {1.0}});
}

}  // namespace hires::localisation
