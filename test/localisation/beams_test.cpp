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

}  // namespace
}  // namespace hires::localisation::beams_test
