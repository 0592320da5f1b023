#include "hires/geometry/angles.h"

#include <gtest/gtest.h>

#include "hires/base/rng.h"

namespace hires::geometry::angles_test {
namespace {

TEST(WrapToPiTest, LeavesWhatIsWrappedAlone) {
  for (const double angle : {-3.14, -1.0, 0.0, 0.5, 3.14, kPi}) EXPECT_EQ(WrapToPi(angle), angle);
}

TEST(WrapToPiTest, TheWayBackIsAlwaysPlusPi) {
  EXPECT_EQ(WrapToPi(-kPi), kPi);
  EXPECT_EQ(WrapToPi(3.0 * kPi), kPi);
  EXPECT_EQ(WrapToPi(-3.0 * kPi), kPi);
  EXPECT_LT(WrapToPi(std::nextafter(kPi, 4.0)), -3.14);
}

TEST(WrapToPiTest, WholeTurnsVanish) {
  EXPECT_DOUBLE_EQ(WrapToPi(0.5 + 2.0 * kPi), 0.5);
  EXPECT_DOUBLE_EQ(WrapToPi(-0.5 - 2.0 * kPi), -0.5);
  EXPECT_EQ(WrapToPi(2.0 * kPi), 0.0);
}

TEST(WrapToPiTest, KeepsTheDirectionOfEveryAngle) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const double angle = base::Rng(1).Fork(seed).Uniform(-1000.0, 1000.0);
    const double wrapped = WrapToPi(angle);
    EXPECT_GT(wrapped, -kPi);
    EXPECT_LE(wrapped, kPi);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-12);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-12);
  }
}

TEST(WrapToPiTest, NoNumberStaysNoNumber) {
  EXPECT_TRUE(std::isnan(WrapToPi(NAN)));
  EXPECT_TRUE(std::isnan(WrapToPi(INFINITY)));
}

}  // namespace
}  // namespace hires::geometry::angles_test
