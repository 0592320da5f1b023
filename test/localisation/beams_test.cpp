#include "localisation/beams.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hires::localisation::beams_test {
namespace {

robot::ScanReading ScanOf(double range_max) {
  return {0.0, 0.1, 0.05, {1.0f, 5.0f, 9.0f, 20.0f}, range_max};
}

TEST(BeamsTest, TheLongestRangeIsTheSmallerOneOfWhatScanAndParametersSay) {
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(RangeMax(ScanOf(8.0), {60, -1.0, 30.0}, 99.0), 8.0);
  EXPECT_EQ(RangeMax(ScanOf(8.0), {60, -1.0, 4.0}, 99.0), 4.0);
  EXPECT_EQ(RangeMax(ScanOf(8.0), {60, -1.0, -1.0}, 99.0), 8.0);
  for (const double nobody : {0.0, infinite, std::nan("")}) {
    EXPECT_EQ(RangeMax(ScanOf(nobody), {60, -1.0, 4.0}, 99.0), 4.0) << nobody;
    EXPECT_EQ(RangeMax(ScanOf(nobody), {60, -1.0, -1.0}, 99.0), 99.0) << nobody;
  }
}

TEST(BeamsTest, ABeamThatMetNothingIsNotTakenForAnEchoByAParameter) {
  Beams beams;
  ASSERT_EQ(SelectBeams(ScanOf(8.0), {}, {60, -1.0, 30.0}, &beams), ScanOutcome::kUpdated);
  EXPECT_EQ(beams.size(), 2u) << "9 m and 20 m met nothing, as the laser sees 8 m far";
}

TEST(HasMetNothingTest, WhatIsAsLongAsTheLaserSeesHasMetNothingWhateverTheDigits) {
  for (const double range_max : {4.095, 5.6, 8.183, 8.19, 8.191, 16.38, 18.3, 29.9, 32.76, 80.0}) {
    for (const double digit : {0.01, 0.001, 0.0001}) {
      for (const int off : {0, 1}) {
        const double written = std::round(range_max / digit + off) * digit;
        EXPECT_EQ(HasMetNothing(static_cast<float>(written), range_max), written > range_max - 0.01)
            << written << " of " << range_max;
      }
    }
    EXPECT_TRUE(HasMetNothing(static_cast<float>(range_max - 0.01), range_max)) << range_max;
    EXPECT_TRUE(HasMetNothing(81.83, range_max));
    EXPECT_TRUE(HasMetNothing(std::numeric_limits<double>::infinity(), range_max));
    for (const double nearer : {0.011, 0.02, 1.0})
      EXPECT_FALSE(HasMetNothing(static_cast<float>(range_max - nearer), range_max)) << range_max;
  }
}

TEST(HasMetNothingTest, WhereNobodySaysHowFarItSeesNothingIsTooFar) {
  for (const double nobody : {0.0, -1.0, std::nan("")}) EXPECT_FALSE(HasMetNothing(50.0, nobody));
  EXPECT_FALSE(HasMetNothing(50.0, std::numeric_limits<double>::infinity()));
}

TEST(BeamsTest, ABeamAsLongAsTheLaserSeesHasMetNothing) {
  for (const double range_max : {4.095, 5.6, 8.183, 8.19, 8.191, 16.38, 18.3, 29.9, 32.76}) {
    for (const double off : {-0.01, -0.001, 0.0, 0.001, 0.01}) {
      const auto range = static_cast<float>(range_max + off);
      Beams beams;
      const robot::ScanReading some{0.0, 0.1, 0.05, {2.0F, range, 2.5F}, range_max};
      ASSERT_EQ(SelectBeams(some, {}, {}, &beams), ScanOutcome::kUpdated);
      EXPECT_EQ(beams.size(), 2u) << range_max << " " << off;
      const robot::ScanReading all{0.0, 0.1, 0.05, {range, range, range}, range_max};
      EXPECT_EQ(SelectBeams(all, {}, {}, &beams), ScanOutcome::kNothingMet) << range_max;
    }
  }
}

}  // namespace
}  // namespace hires::localisation::beams_test
