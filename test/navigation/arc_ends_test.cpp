#include "navigation/arc_ends.h"

#include <gtest/gtest.h>

#include "hires/base/rng.h"
#include "navigation/velocity_window.h"

namespace hires::navigation::arc_ends_test {
namespace {

constexpr double kAhead = 0.325;  // [m]

void ExpectAsPoseAfter(const geometry::Pose2& X_MB, double duration, const geometry::Twist2& V_B,
                       ArcEnds* ends) {
  const geometry::Pose2 X_MEnd = PoseAfter(X_MB, V_B, duration);
  const Eigen::Vector2d p_MF = X_MEnd * Eigen::Vector2d(kAhead, 0.0);
  const ArcEnds::End end = ends->Of(V_B);
  EXPECT_EQ(end.p_MB.x(), X_MEnd.x);
  EXPECT_EQ(end.p_MB.y(), X_MEnd.y);
  EXPECT_EQ(end.p_MF.x(), p_MF.x());
  EXPECT_EQ(end.p_MF.y(), p_MF.y());
}

TEST(ArcEndsTest, EndsAreThoseOfPoseAfterToTheLastBit) {
  const base::Rng root(53);
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = root.Fork(seed);
    const geometry::Pose2 X_MB{rng.Uniform(-9.0, 9.0), rng.Uniform(-9.0, 9.0),
                               rng.Uniform(-3.1, 3.1)};
    const double duration = rng.Uniform(0.1, 4.0);
    ArcEnds ends(X_MB, duration, kAhead);
    for (const double vx : {0.0, 0.2, 0.55}) {
      for (const double wz : {-1.0, -0.3, 0.0, 1e-12, rng.Uniform(-2.0, 2.0)}) {
        ExpectAsPoseAfter(X_MB, duration, {vx, rng.Uniform(-0.1, 0.1), wz}, &ends);
      }
    }
  }
}

TEST(ArcEndsTest, RatesMayComeInAnyOrder) {
  const geometry::Pose2 X_MB{1.0, 2.0, 0.7};
  ArcEnds ends(X_MB, 1.7, kAhead);
  for (const double wz : {0.4, -0.4, 0.4, 0.4, 1.0, -0.4, 0.0, 1.0}) {
    ExpectAsPoseAfter(X_MB, 1.7, {0.3, 0.05, wz}, &ends);
  }
}

}  // namespace
}  // namespace hires::navigation::arc_ends_test
