#include "mapping/grid_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "support/rounds.h"

namespace hires::mapping::grid_search_test {
namespace {

using geometry::Pose2;
using Points = std::vector<Eigen::Vector2d>;

/// Walls of a building of up to 12 m, drawn by points.
Points DrawnWalls(base::Rng* rng) {
  Points points;
  const int walls = 2 + rng->Index(6);
  for (int i = 0; i < walls; ++i) {
    const Eigen::Vector2d from(rng->Uniform(-6.0, 6.0), rng->Uniform(-6.0, 6.0));
    const double length = rng->Uniform(0.5, 6.0), angle = rng->Index(4) * geometry::kPi / 2.0;
    for (double s = 0.0; s < length; s += 0.1)
      points.push_back(from + s * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

Nearness NearnessOf(const Points& points) {
  Eigen::Array2d lower = points.front(), upper = lower;
  for (const Eigen::Vector2d& p : points) {
    lower = lower.min(p.array());
    upper = upper.max(p.array());
  }
  Nearness nearness(lower - 0.5, upper - lower + 1.0);
  for (const Eigen::Vector2d& p : points) nearness.Stamp(p);
  return nearness;
}

/// One pose after the other, by the definition in grid_search.h.
Pose2 BestOfAll(const Nearness& nearness, const Points& points, const Pose2& guess,
                const SearchWindow& window, const SearchStep& step) {
  const double length = step.cells * Nearness::kCell;
  const int most = static_cast<int>(std::ceil(window.reach / length));
  const int most_yaw = static_cast<int>(std::ceil(window.yaw / step.yaw));
  Pose2 best;
  double best_score = -1.0;
  for (int k = -most_yaw; k <= most_yaw; ++k) {
    for (int row = -most; row <= most; ++row) {
      for (int column = -most; column <= most; ++column) {
        int sum = 0;
        for (const Eigen::Vector2d& p : points) {
          const Eigen::Array2i cell =
              nearness.CellOf(Pose2{guess.x, guess.y, guess.yaw + k * step.yaw} * p);
          sum += nearness.At(cell.x() + column * step.cells, cell.y() + row * step.cells);
        }
        const double x = column * length / window.reach, y = row * length / window.reach;
        const double yaw = k * step.yaw / window.yaw;
        const double score = sum * (1.0 - 0.05 * (x * x + y * y + yaw * yaw) / 3.0);
        if (score <= best_score) continue;
        best_score = score;
        best = {guess.x + column * length, guess.y + row * length, guess.yaw + k * step.yaw};
      }
    }
  }
  return best;
}

TEST(GridSearchTest, BoundsLeaveOutNothingThatIsBetter) {
  const int rounds = hires::test_support::Rounds(100);
  for (int round = 0; round < rounds; ++round) {
    SCOPED_TRACE(round);
    base::Rng rng(static_cast<std::uint64_t>(round));
    const Points walls = DrawnWalls(&rng);
    const Pose2 X_MB{rng.Uniform(-2.0, 2.0), rng.Uniform(-2.0, 2.0), rng.Uniform(-3.0, 3.0)};
    Points seen;
    const std::size_t every = 1 + walls.size() / 20;
    for (std::size_t i = 0; i < walls.size(); i += every)
      seen.push_back(X_MB.Inverse() * (walls[i] + Eigen::Vector2d(rng.Uniform(-0.05, 0.05), 0.0)));
    const Nearness nearness = NearnessOf(walls);
    const Pose2 guess{X_MB.x + rng.Uniform(-1.0, 1.0), X_MB.y + rng.Uniform(-1.0, 1.0),
                      X_MB.yaw + rng.Uniform(-0.1, 0.1)};
    const SearchWindow window{rng.Uniform(0.1, 2.0), rng.Uniform(0.02, 0.1)};
    const SearchStep step{1 + rng.Index(3), 0.02};
    const Pose2 expected = BestOfAll(nearness, seen, guess, window, step);
    const Pose2 found = GridSearch(nearness, seen, guess, window, step).Best().X_MB;
    ASSERT_NEAR(found.x, expected.x, 1e-9);
    ASSERT_NEAR(found.y, expected.y, 1e-9);
    ASSERT_NEAR(found.yaw, expected.yaw, 1e-9);
  }
}

TEST(GridSearchTest, WhatIsLeftOutIsNotFound) {
  base::Rng rng(1);
  const Points walls = DrawnWalls(&rng);
  const Nearness nearness = NearnessOf(walls);
  const SearchWindow window{2.0, 0.02};
  const GridSearch search(nearness, walls, {}, window, {2, 0.02});
  const GridMatch best = search.Best();
  EXPECT_EQ(best.X_MB.position(), Eigen::Vector2d::Zero());
  const Disc disc{best.X_MB.position(), 0.5};
  const GridMatch other = search.Best(disc);
  EXPECT_GE(other.X_MB.position().norm(), 0.5);
  EXPECT_LT(other.score, best.score);
  EXPECT_GT(other.score, 0.0);
  EXPECT_EQ(search.Best(Disc{disc.centre, 5.0}).score, -1.0);
}

TEST(NearnessTest, MostOfSquaresIsThatOfAllTheirCells) {
  base::Rng rng(1);
  const Nearness nearness = NearnessOf(DrawnWalls(&rng));
  for (const int edge : {2, 4, 8, 16}) {
    const Nearness most = nearness.MostOfSquares(edge);
    for (int row = -20; row < 280; row += 3) {
      for (int column = -20; column < 280; column += 3) {
        int expected = 0;
        for (int i = 0; i < edge * edge; ++i)
          expected = std::max(expected, nearness.At(column + i % edge, row + i / edge));
        ASSERT_EQ(most.At(column, row), expected) << edge << ": " << column << ", " << row;
      }
    }
  }
}

TEST(NearnessTest, NothingIsNearWhereNothingWasMeasured) {
  EXPECT_EQ(Nearness().At(0, 0), 0);
  const Points points{{1.0, 1.0}, {1.5, 1.0}};
  const Nearness nearness = NearnessOf(points);
  const Eigen::Array2i at = nearness.CellOf(points[0]);
  EXPECT_EQ(nearness.At(at.x(), at.y()), 255);
  EXPECT_LT(nearness.At(at.x(), at.y() + 1), 255);
  EXPECT_EQ(nearness.At(at.x(), at.y() + 4), 0);
}

}  // namespace
}  // namespace hires::mapping::grid_search_test
