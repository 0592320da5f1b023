#include "localisation/particles.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hires/geometry/angles.h"
#include "localisation/belief_summary.h"

namespace hires::localisation::particles_test {
namespace {

Particles Even(const std::vector<geometry::Pose2>& poses) {
  Particles particles;
  for (const auto& pose : poses) particles.Add(pose, 1.0 / static_cast<double>(poses.size()));
  return particles;
}

TEST(ParticlesTest, EffectiveSizeCountsParticlesOfEvenWeight) {
  Particles particles = Even({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  EXPECT_NEAR(EffectiveSize(particles), 4.0, 1e-12);
  particles.weight = {1.0, 0.0, 0.0, 0.0};
  EXPECT_NEAR(EffectiveSize(particles), 1.0, 1e-12);
}

TEST(ParticlesTest, KldSizesAreThoseOfTheFormula) {
  // k = 2, error 0.05, z 0.99: 10 (1 - 2/9 + 0.99 sqrt(2/9))^3 = 19.1 by hand.
  EXPECT_EQ(KldSize(0, 0.05, 0.99, 5000), 1);
  EXPECT_EQ(KldSize(1, 0.05, 0.99, 5000), 1);
  EXPECT_EQ(KldSize(2, 0.05, 0.99, 5000), 20);
  EXPECT_EQ(KldSize(100000, 0.05, 0.99, 5000), 5000);
  for (int bins = 1; bins < 200; ++bins)
    EXPECT_LT(KldSize(bins, 0.05, 0.99, 100000), KldSize(bins + 1, 0.05, 0.99, 100000));
}

TEST(ParticlesTest, ResamplingKeepsShares) {
  Particles particles = Even({{0.1, 0.1, 0}, {5.1, 0.1, 0}});
  particles.weight = {0.9, 0.1};
  base::Rng rng(2);
  const Particles drawn = Resample(particles, {0.05, 0.99, 1000, 5000}, &rng);
  ASSERT_EQ(drawn.size(), 1000u);
  int far = 0;
  for (double x : drawn.x) far += x > 1.0;
  EXPECT_NEAR(far, 100, 1);
  for (double weight : drawn.weight) EXPECT_EQ(weight, 1.0 / 1000);
}

TEST(ParticlesTest, ResamplingSpendsMoreParticlesOnWiderBeliefs) {
  base::Rng rng(2);
  Particles narrow, wide;
  for (int i = 0; i < 5000; ++i) {
    narrow.Add({rng.Normal(0, 0.05), rng.Normal(0, 0.05), rng.Normal(0, 0.05)}, 1.0 / 5000);
    wide.Add({rng.Normal(0, 3.0), rng.Normal(0, 3.0), rng.Normal(0, 1.0)}, 1.0 / 5000);
  }
  EXPECT_LT(Resample(narrow, {0.05, 0.99, 100, 5000}, &rng).size(), 200u);
  EXPECT_GT(Resample(wide, {0.05, 0.99, 100, 5000}, &rng).size(), 2000u);
}

TEST(ParticlesTest, ClustersAreTheGroupsThatLieApart) {
  std::vector<geometry::Pose2> poses(30, {0.1, 0.1, 0.1});
  poses.insert(poses.end(), 60, {8.0, 0.1, 0.1});
  poses.insert(poses.end(), 10, {0.1, 0.1, 2.0});  // same place, other way round
  const Clusters clusters = ClustersOf(Even(poses));
  ASSERT_EQ(clusters.weights.size(), 3u);
  EXPECT_NEAR(clusters.weights[0], 0.6, 1e-9);
  EXPECT_NEAR(clusters.weights[1], 0.3, 1e-9);
  EXPECT_EQ(clusters.cluster_of[0], 1);
  EXPECT_EQ(clusters.cluster_of[99], 2);
}

TEST(ParticlesTest, ClustersReachAcrossTheTurnAtPi) {
  EXPECT_EQ(ClustersOf(Even({{0.1, 0.1, geometry::kPi - 0.01}, {0.1, 0.1, 0.01 - geometry::kPi}}))
                .weights.size(),
            1u);
}

TEST(BeliefSummaryTest, MomentsAreThoseThatWereDrawn) {
  base::Rng rng(4);
  Particles particles;
  for (int i = 0; i < 20000; ++i) {
    particles.Add(
        {3.0 + rng.Normal(0, 0.1), -1.0 + rng.Normal(0, 0.2), geometry::kPi + rng.Normal(0, 0.05)},
        1.0 / 20000);
  }
  const BeliefSummary summary = Summarise(particles);
  EXPECT_NEAR(summary.X_MB.x, 3.0, 0.005);
  EXPECT_NEAR(summary.X_MB.y, -1.0, 0.005);
  EXPECT_NEAR(geometry::WrapToPi(summary.X_MB.yaw - geometry::kPi), 0.0, 0.002);
  EXPECT_NEAR(std::sqrt(summary.covariance(0, 0)), 0.1, 0.005);
  EXPECT_NEAR(std::sqrt(summary.covariance(2, 2)), 0.05, 0.002);
  EXPECT_NEAR(summary.best_spread, 0.2, 0.005);
  EXPECT_EQ(summary.num_clusters, 1);
}

TEST(BeliefSummaryTest, CovarianceCoversTheSecondPlaceThatFits) {
  std::vector<geometry::Pose2> poses(60, {0.0, 0.0, 0.0});
  poses.insert(poses.end(), 40, {10.0, 0.0, 0.0});
  const BeliefSummary summary = Summarise(Even(poses));
  EXPECT_EQ(summary.num_clusters, 2);
  EXPECT_NEAR(summary.X_MB.x, 0.0, 1e-12);
  EXPECT_NEAR(summary.covariance(0, 0), 0.4 * 100.0, 1e-9);
}

TEST(SumOverBeamsTest, SumAgreesWithTheSlowWay) {
  base::Rng rng(9);
  world::OccupancyGrid grid{0.1, 60, 40, {-2.0, -1.0}, {}};
  for (int i = 0; i < 60 * 40; ++i)
    grid.cells.push_back(rng.Bernoulli(0.03) ? world::Cell::kOccupied : world::Cell::kFree);
  const LikelihoodField field(grid, 1.0);
  const std::vector<float> table = field.LogLikelihoods(0.5, 0.5, 0.2, 10.0);
  Beams beams;
  for (int k = 0; k < 25; ++k) {
    beams.x.push_back(static_cast<float>(rng.Uniform(-3, 3)));
    beams.y.push_back(static_cast<float>(rng.Uniform(-3, 3)));
  }
  Particles particles;
  for (int i = 0; i < 200; ++i)
    particles.Add({rng.Uniform(-3, 5), rng.Uniform(-2, 4), rng.Uniform(-3, 3)}, 1.0 / 200);
  std::vector<float> sums;
  SumOverBeams(particles, beams, field, table, &sums);
  double off = 0.0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    double slow = 0.0;
    for (std::size_t k = 0; k < beams.size(); ++k) {
      const Eigen::Vector2d end = particles.pose(i) * Eigen::Vector2d(beams.x[k], beams.y[k]);
      const double d = field.DistanceAt(end.x(), end.y()) / 0.2;
      slow += std::log(0.5 * std::exp(-0.5 * d * d) + 0.05);
    }
    off = std::max(off, std::abs(slow - sums[i]));
  }
  EXPECT_LT(off, 1e-3);
}

}  // namespace
}  // namespace hires::localisation::particles_test
