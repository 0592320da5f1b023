#include "hires/sensing/joint_history.h"

#include <gtest/gtest.h>

#include <memory>

namespace hires::sensing::joint_history_test {
namespace {

/// Readings of one joint at 0 s and 0.6 s, of a robot without arms, which is asked of none.
JointHistory TwoReadings() {
  JointHistory history(std::make_shared<const robot::Robot>());
  EXPECT_TRUE(history.Insert(0.0, {{{"j", 1.0}}, {}}));
  EXPECT_TRUE(history.Insert(0.6, {{{"j", 4.0}}, {}}));
  return history;
}

double At(double time, double max_gap) { return TwoReadings().At(time, max_gap).positions.at("j"); }

TEST(JointHistoryTest, BetweenTwoReadingsAJointIsOnItsWay) {
  EXPECT_DOUBLE_EQ(At(0.2, 1.0), 2.0);
  EXPECT_DOUBLE_EQ(At(0.5, 0.6), 3.5);
}

TEST(JointHistoryTest, ReadingsThatLieTooFarApartSayNothingOfTheTimeBetween) {
  // However near one of them is.
  for (const double time : {0.1, 0.3, 0.5}) EXPECT_EQ(At(time, 0.59), 1.0) << time;
}

TEST(JointHistoryTest, BeforeTheFirstAndAfterTheLastTheNearestCounts) {
  EXPECT_EQ(At(-1.0, 0.1), 1.0);
  EXPECT_EQ(At(0.0, 0.1), 1.0);
  EXPECT_EQ(At(0.6, 0.1), 4.0);
  EXPECT_EQ(At(9.0, 0.1), 4.0);
}

}  // namespace
}  // namespace hires::sensing::joint_history_test
