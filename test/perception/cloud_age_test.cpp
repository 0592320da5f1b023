#include "hires/perception/cloud_age.h"

#include <gtest/gtest.h>

namespace hires::perception::cloud_age_test {
namespace {

TEST(CloudAgeTest, ACloudIsTimelyBetweenItsTwoBounds) {
  const CloudAgeParams params{3.0, 0.5};
  EXPECT_EQ(AgeOf(100.0, 103.25, params), CloudAge::kTooOld);
  EXPECT_EQ(AgeOf(100.0, 103.0, params), CloudAge::kTimely);
  EXPECT_EQ(AgeOf(100.0, 100.0, params), CloudAge::kTimely);
  EXPECT_EQ(AgeOf(100.0, 99.5, params), CloudAge::kTimely);
  EXPECT_EQ(AgeOf(100.0, 99.25, params), CloudAge::kAhead);
}

}  // namespace
}  // namespace hires::perception::cloud_age_test
