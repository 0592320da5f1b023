#include "hires/control/move_base_limits.h"

#include <gmock/gmock.h>

#include <limits>

#include "hires/base/error.h"
#include "support/move_base_fakes.h"

namespace hires::control::move_base_limits_test {
namespace {

using base::ConfigError;
using test_support::kSlow;
using test_support::NamesOfDwa;
using ::testing::HasSubstr;

TEST(MoveBaseLimitsTest, NoeticNamesAreTaken) {
  const PlannerValues values = InWordsOf(test_support::NoeticDwa(), NamesOfDwa(), kSlow);
  EXPECT_EQ(values, (PlannerValues{{"max_vel_x", 0.30},
                                   {"max_vel_trans", 0.30},
                                   {"max_vel_theta", 1.0},
                                   {"acc_lim_x", 1.4},
                                   {"acc_lim_y", 1.4},
                                   {"acc_lim_theta", 2.0}}));
}

TEST(MoveBaseLimitsTest, NamesBeforeNoeticAreTaken) {
  const PlannerValues values = InWordsOf(test_support::OldDwa(), NamesOfDwa(), kSlow);
  EXPECT_EQ(values, (PlannerValues{{"max_vel_x", 0.30},
                                   {"max_trans_vel", 0.30},
                                   {"max_rot_vel", 1.0},
                                   {"acc_lim_x", 1.4},
                                   {"acc_lim_y", 1.4},
                                   {"acc_lim_th", 2.0}}));
}

TEST(MoveBaseLimitsTest, TheNewestNameWinsWhereAPlannerHasBoth) {
  PlannerValues both = test_support::NoeticDwa();
  both["max_rot_vel"] = 7.0;
  EXPECT_EQ(InWordsOf(both, NamesOfDwa(), kSlow).count("max_rot_vel"), 0u);
}

TEST(MoveBaseLimitsTest, ALimitThatThePlannerDoesNotHaveIsAnError) {
  PlannerValues lacking = test_support::OldDwa();
  lacking.erase("acc_lim_th");
  try {
    InWordsOf(lacking, NamesOfDwa(), kSlow);
    FAIL() << "nobody would limit the angular acceleration";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("max_angular_acceleration"));
    EXPECT_THAT(error.what(), HasSubstr("none of acc_lim_theta, acc_lim_th"));
    EXPECT_THAT(error.what(), HasSubstr("max_rot_vel 1"));
  }
}

TEST(MoveBaseLimitsTest, AWordThatIsNoLimitIsAnError) {
  EXPECT_THROW(LimitOf(kSlow, "max_speed"), ConfigError);
}

TEST(MoveBaseLimitsTest, EachDifferenceIsNamed) {
  EXPECT_EQ(WhatDiffers({{"a", 1.0}, {"b", 2.0}}, {{"a", 1.0}, {"b", 2.0}, {"c", 3.0}}), "");
  EXPECT_EQ(WhatDiffers({{"a", 1.0}, {"b", 2.0}}, {{"a", 1.5}}),
            "a is 1.5, wanted 1; b is not there, wanted 2");
  EXPECT_EQ(WhatDiffers({{"a", 1.0}}, {{"a", std::numeric_limits<double>::quiet_NaN()}}),
            "a is nan, wanted 1");
}

}  // namespace
}  // namespace hires::control::move_base_limits_test
