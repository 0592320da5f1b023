#include "hires/geometry/map_to_world.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "hires/base/error.h"
#include "hires/base/rng.h"

namespace hires::geometry::map_to_world_test {
namespace {

using ::testing::HasSubstr;

std::string ErrorOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(MapToWorldTest, ThereAndBackIsTheSame) {
  base::Rng rng(5);
  for (int i = 0; i < 100; ++i) {
    const MapToWorld m{{rng.Uniform(-9, 9), rng.Uniform(-9, 9), rng.Uniform(-3, 3)},
                       rng.Uniform(0.5, 2)};
    const Pose2 X_MB{rng.Uniform(-9, 9), rng.Uniform(-9, 9), rng.Uniform(-3, 3)};
    const Pose2 back = m.ToMap(m.ToWorld(X_MB));
    EXPECT_NEAR(back.x, X_MB.x, 1e-9);
    EXPECT_NEAR(back.y, X_MB.y, 1e-9);
    EXPECT_NEAR(std::cos(back.yaw - X_MB.yaw), 1.0, 1e-12);
  }
}

TEST(MapToWorldTest, TurnsAndScalesAboutTheMapsOrigin) {
  const MapToWorld m{{1.0, 2.0, M_PI / 2}, 2.0};
  const Pose2 X_WB = m.ToWorld(Pose2{3.0, 0.0, 0.1});
  EXPECT_NEAR(X_WB.x, 1.0, 1e-12);
  EXPECT_NEAR(X_WB.y, 8.0, 1e-12);
  EXPECT_NEAR(X_WB.yaw, M_PI / 2 + 0.1, 1e-12);
}

TEST(MapToWorldTest, ReadsThreeOrFourNumbers) {
  EXPECT_TRUE(ParseMapToWorld("", "here").is_identity());
  EXPECT_TRUE(ParseMapToWorld("0 0 0", "here").is_identity());
  const MapToWorld m = ParseMapToWorld(" 1.5  -2 0.5 1.02 ", "here");
  EXPECT_EQ(m.X_WM.x, 1.5);
  EXPECT_EQ(m.X_WM.y, -2.0);
  EXPECT_EQ(m.X_WM.yaw, 0.5);
  EXPECT_EQ(m.scale, 1.02);
}

TEST(MapToWorldTest, RefusesWhatIsNoTransformation) {
  EXPECT_THAT(ErrorOf([] { ParseMapToWorld("1 2", "~map_to_world"); }),
              HasSubstr("~map_to_world: '1 2' has 2 numbers"));
  EXPECT_THAT(ErrorOf([] { ParseMapToWorld("1 2 3 4 5", "here"); }), HasSubstr("has 5 numbers"));
  EXPECT_THAT(ErrorOf([] { ParseMapToWorld("1 two 3", "here"); }), HasSubstr("'two'"));
  EXPECT_THAT(ErrorOf([] { ParseMapToWorld("1 nan 3", "here"); }), HasSubstr("'nan'"));
  EXPECT_THAT(ErrorOf([] { ParseMapToWorld("0 0 0 0.05", "here"); }), HasSubstr("scale is 0.05"));
}

}  // namespace
}  // namespace hires::geometry::map_to_world_test
