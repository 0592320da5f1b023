#include "simulation/floor/floor_profile.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hires::simulation::floor_profile_test {
namespace {

TEST(FloorProfileTest, TheDefaultIsFlat) {
  const FloorProfile floor;
  EXPECT_TRUE(floor.is_flat());
  EXPECT_EQ(floor.HeightAt({3.0, -7.0}), 0.0);
}

TEST(FloorProfileTest, NoRoughnessIsFlat) {
  const FloorProfile floor(0.0, base::Rng(1));
  EXPECT_TRUE(floor.is_flat());
  EXPECT_EQ(floor.HeightAt({3.0, -7.0}), 0.0);
}

TEST(FloorProfileTest, HeightsOfManyFloorsSpreadAsTheRoughnessSays) {
  const int count = 4000;
  double sum = 0.0, squares = 0.0;
  for (int seed = 0; seed < count; ++seed) {
    const double height = FloorProfile(0.002, base::Rng(seed)).HeightAt({9.0, 11.5});
    sum += height;
    squares += height * height;
  }
  const double mean = sum / count;
  EXPECT_NEAR(mean, 0.0, 0.002 * 4.0 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count - mean * mean), 0.002, 0.05 * 0.002);
}

TEST(FloorProfileTest, OneFloorSpreadsOverItsAreaToo) {
  const FloorProfile floor(0.001, base::Rng(7));
  double squares = 0.0;
  int count = 0;
  for (double x = 0.0; x < 40.0; x += 0.21) {
    for (double y = 0.0; y < 40.0; y += 0.23, ++count) {
      squares += std::pow(floor.HeightAt({x, y}), 2);
    }
  }
  EXPECT_NEAR(std::sqrt(squares / count), 0.001, 0.0001);
}

TEST(FloorProfileTest, IsSmooth) {
  // Every wave is as steep as every other: 2 pi roughness / sqrt(sum of lengths^2 / 2); twelve in
  // phase give 28 times the roughness per metre.
  const FloorProfile floor(0.001, base::Rng(3));
  for (double x = 0.0; x < 5.0; x += 0.001) {
    ASSERT_LT(std::abs(floor.HeightAt({x + 0.001, 2.0}) - floor.HeightAt({x, 2.0})), 0.028e-3);
  }
}

TEST(FloorProfileTest, ChanceComesFromTheSeedAlone) {
  const Eigen::Vector2d p(1.0, 2.0);
  const double height = FloorProfile(0.001, base::Rng(3)).HeightAt(p);
  EXPECT_EQ(FloorProfile(0.001, base::Rng(3)).HeightAt(p), height);
  EXPECT_NE(FloorProfile(0.001, base::Rng(4)).HeightAt(p), height);
  EXPECT_NEAR(FloorProfile(0.002, base::Rng(3)).HeightAt(p), 2.0 * height, 1e-15);
}

}  // namespace
}  // namespace hires::simulation::floor_profile_test
