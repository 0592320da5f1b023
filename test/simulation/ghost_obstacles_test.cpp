#include "simulation/ghost_obstacles.h"

#include <gtest/gtest.h>

namespace hires::simulation::ghost_obstacles_test {
namespace {

using geometry::Pose2;

Eigen::Vector2d Middle(const geometry::Polygon& square) {
  return 0.25 * (square.at(0) + square.at(1) + square.at(2) + square.at(3));
}

TEST(GhostObstaclesTest, WithoutARateThereAreNone) {
  GhostObstacles ghosts{base::Rng(1)};
  for (int i = 0; i < 100; ++i) ghosts.Update({}, 0.0, i);
  EXPECT_TRUE(ghosts.OutlinesInMap().empty());
}

TEST(GhostObstaclesTest, TheyComeUpBeforeTheRobotAndStayFor4Point6Seconds) {
  for (int seed = 1; seed <= 100; ++seed) {
    GhostObstacles ghosts{base::Rng(seed)};
    const Pose2 X_MB{3.0, -2.0, 1.0};
    ghosts.Update(X_MB, 1e6, 1.0);
    ASSERT_EQ(ghosts.OutlinesInMap().size(), 1u);
    const Eigen::Vector2d p_B = X_MB.Inverse() * Middle(ghosts.OutlinesInMap()[0]);
    EXPECT_GT(p_B.norm(), 0.79);
    EXPECT_LT(p_B.norm(), 2.51);
    EXPECT_GT(p_B.x(), 0.0);
    ghosts.Update(X_MB, 0.0, 5.59);
    EXPECT_EQ(ghosts.OutlinesInMap().size(), 1u);
    ghosts.Update(X_MB, 0.0, 5.61);
    EXPECT_TRUE(ghosts.OutlinesInMap().empty());
  }
}

TEST(GhostObstaclesTest, ACopyGoesOnAsTheOriginal) {
  GhostObstacles ghosts{base::Rng(7)};
  ghosts.Update({}, 0.5, 1.0);
  GhostObstacles copy = ghosts;
  for (int i = 2; i < 50; ++i) {
    ghosts.Update({}, 0.5, i);
    copy.Update({}, 0.5, i);
    ASSERT_EQ(ghosts.OutlinesInMap().size(), copy.OutlinesInMap().size());
    for (std::size_t k = 0; k < copy.OutlinesInMap().size(); ++k) {
      EXPECT_EQ(ghosts.OutlinesInMap()[k], copy.OutlinesInMap()[k]);
    }
  }
}

}  // namespace
}  // namespace hires::simulation::ghost_obstacles_test
