#include "perception/tabletop/smooth_borders.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "hires/base/rng.h"
#include "support/rounds.h"

namespace hires::perception::smooth_borders_test {
namespace {

using Height = std::function<double(double, double)>;  // [m] of x, y [m]
using Side = std::function<int(double, double)>;       // part of x, y

/// How many parts are left of a surface of 0.1 m by 0.1 m, 1 m below a camera that looks down.
int NumParts(const Height& height, const Side& side, base::Rng rng, double noise = 0.0005) {
  PointCloud cloud;
  std::vector<int> all;
  for (double x = -0.05; x < 0.05; x += 0.002) {
    for (double y = -0.05; y < 0.05; y += 0.002) {
      if (side(x, y) < 0) continue;
      const double z = 1.0 - height(x, y) + rng.Normal(0.0, noise);
      all.push_back(static_cast<int>(cloud.points.size()));
      cloud.points.push_back(Eigen::Vector3d(x, y, z).cast<float>());
    }
  }
  const SurfelCloud surfels = MakeSurfels(cloud, all, {});
  std::vector<int> part;
  for (const Surfel& surfel : surfels.surfels) part.push_back(side(surfel.p_C.x(), surfel.p_C.y()));
  const std::vector<int> joined = JoinAcrossSmoothBorders(surfels, part, {});
  std::set<int> parts(joined.begin(), joined.end());
  parts.erase(-1);
  return static_cast<int>(parts.size());
}

int LeftOrRight(double x, double /*y*/) { return x < 0.0 ? 0 : 1; }

TEST(SmoothBordersTest, PatchesOfOneGentleSurfaceAreOne) {
  for (int seed = 1; seed <= test_support::Rounds(16); ++seed) {
    base::Rng rng(seed);
    const double radius = rng.Uniform(0.08, 0.2), turn = rng.Uniform(-0.5, 0.5);
    const auto ball = [&](double x, double y) {
      return std::sqrt(radius * radius - x * x - y * y) - radius;
    };
    const auto bowl = [&](double x, double y) { return -ball(x, y); };
    EXPECT_EQ(NumParts(ball, LeftOrRight, rng.Fork(0)), 1) << seed << ": a ball of " << radius;
    EXPECT_EQ(NumParts(bowl, LeftOrRight, rng.Fork(1)), 1) << seed << ": a bowl of " << radius;
    const auto slope = [&](double x, double y) { return turn * (x + y); };
    EXPECT_EQ(NumParts(slope, LeftOrRight, rng.Fork(2)), 1) << seed << ": a plane";
    const auto roof = [&](double x, double) { return -(1.0 + turn) * std::abs(x); };
    EXPECT_EQ(NumParts(roof, LeftOrRight, rng.Fork(3)), 1) << seed << ": a roof";
  }
}

TEST(SmoothBordersTest, AConcaveEdgeIsNoSmoothBorder) {
  for (int seed = 1; seed <= test_support::Rounds(16); ++seed) {
    base::Rng rng(seed);
    const double left = rng.Uniform(0.6, 1.2), right = rng.Uniform(0.6, 1.2);
    const auto valley = [&](double x, double) { return x < 0.0 ? -left * x : right * x; };
    EXPECT_EQ(NumParts(valley, LeftOrRight, rng.Fork(0)), 2) << left << ", " << right;
  }
}

TEST(SmoothBordersTest, PartsThatHardlyTouchStayTwo) {
  base::Rng rng(1);
  const auto flat = [](double, double) { return 0.0; };
  const auto gap = [](double x, double y) { return std::abs(x) < 0.008 ? -1 : LeftOrRight(x, y); };
  EXPECT_EQ(NumParts(flat, gap, rng.Fork(0)), 2);
}

TEST(SmoothBordersTest, NothingStaysNothing) {
  EXPECT_TRUE(JoinAcrossSmoothBorders({}, {}, {}).empty());
  SurfelCloud one;
  one.surfels.resize(1);
  one.neighbours.resize(1);
  EXPECT_EQ(JoinAcrossSmoothBorders(one, {-1}, {}), std::vector<int>{-1});
}

}  // namespace
}  // namespace hires::perception::smooth_borders_test
