#include "hires/perception/heat_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hires::perception::heat_picture_test {
namespace {

constexpr double kRoom = 293.15, kHot = 338.15;

/// The upper half sees a mug, the lower one a table, but for the last row, which sees nothing.
RangePicture MugOverTable() {
  RangePicture picture;
  picture.width = 100;
  picture.height = 101;
  picture.names = {"table", "mug1"};
  picture.owner.assign(5000, 1);
  picture.owner.insert(picture.owner.end(), 5000, 0);
  picture.owner.insert(picture.owner.end(), 100, RangePicture::kNothing);
  return picture;
}

HeatPicture Measured(const HeatSensorParams& params, int seed = 1) {
  base::Rng rng(seed);
  return MeasureHeat(MugOverTable(), {{"mug1", kHot}, {"mug2", 400.0}}, params, &rng);
}

TEST(MeasureHeatTest, PixelsAreCentikelvinOfWhatTheySee) {
  const HeatPicture heat = Measured({0.0, kRoom});
  ASSERT_EQ(heat.centikelvin.size(), 10100u);
  EXPECT_EQ(heat.width, 100);
  EXPECT_EQ(heat.centikelvin[4999], 33815);
  EXPECT_EQ(heat.centikelvin[5000], 29315);
  EXPECT_EQ(heat.centikelvin[10000], 29315) << "what is far away is as warm as the room";
}

TEST(MeasureHeatTest, NoiseHasItsDeviationAndNoBias) {
  const HeatPicture heat = Measured({0.05, kRoom});
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const double error = 0.01 * heat.centikelvin[i] - kHot;
    sum += error;
    squares += error * error;
  }
  const double sd = std::hypot(0.05, 0.01 / std::sqrt(12.0));  // rounding adds its own
  EXPECT_NEAR(std::sqrt(squares / 5000), sd, 5.0 * sd / std::sqrt(2.0 * 5000));
  EXPECT_NEAR(sum / 5000, 0.0, 5.0 * sd / std::sqrt(5000.0));
}

TEST(MeasureHeatTest, TheSameSeedGivesTheSameBits) {
  EXPECT_EQ(Measured({}, 7).centikelvin, Measured({}, 7).centikelvin);
  EXPECT_NE(Measured({}, 7).centikelvin, Measured({}, 8).centikelvin);
}

TEST(MeasureHeatTest, WhatSixteenBitsCannotHoldIsTheNearestThatTheyCan) {
  base::Rng rng(1);
  const auto hottest = MeasureHeat(MugOverTable(), {{"mug1", 1000.0}}, {0.0, kRoom}, &rng);
  EXPECT_EQ(hottest.centikelvin[0], 65535);
  EXPECT_EQ(Measured({0.0, 0.0}).centikelvin[5000], 0);
}

TEST(ColouredTest, ColdIsBlueWarmIsYellowHotIsRed) {
  HeatPicture heat;
  heat.width = 6;
  heat.height = 1;
  heat.centikelvin = {20000, 29000, 30000, 31000, 32000, 33000};
  const Picture picture = Coloured(heat, 290.0, 330.0);
  EXPECT_EQ(
      picture.pixels,
      (std::vector<Colour>{
          {0, 0, 255}, {0, 0, 255}, {128, 128, 128}, {255, 255, 0}, {255, 128, 0}, {255, 0, 0}}));
  EXPECT_THROW(Coloured(heat, 300.0, 300.0), std::logic_error);
}

}  // namespace
}  // namespace hires::perception::heat_picture_test
