#include "hires/relay/restart_policy.h"

#include <gtest/gtest.h>

namespace hires::relay::restart_policy_test {
namespace {

constexpr RestartLimits kLimits{0.1, 1.0, 30.0, 6};

TEST(RestartPolicyTest, DelaysDoubleUpToTheLongest) {
  RestartPolicy policy(kLimits);
  for (const double delay : {0.1, 0.2, 0.4, 0.8, 1.0, 1.0}) {
    policy.OnStarted(100.0);
    EXPECT_DOUBLE_EQ(policy.OnDied(100.0).value(), 100.0 + delay);
  }
}

TEST(RestartPolicyTest, GivesUpAfterTooManyDeathsInARow) {
  RestartPolicy policy(kLimits);
  for (int i = 0; i < kLimits.most_in_a_row; ++i) EXPECT_TRUE(policy.OnDied(1.0)) << i;
  EXPECT_FALSE(policy.OnDied(1.0));
  EXPECT_EQ(policy.num_restarts(), kLimits.most_in_a_row);
}

TEST(RestartPolicyTest, AStableLifeForgivesEarlierDeaths) {
  RestartPolicy policy(kLimits);
  policy.OnStarted(0.0);
  for (int i = 0; i < kLimits.most_in_a_row; ++i) policy.OnDied(1.0);
  policy.OnStarted(10.0);
  EXPECT_DOUBLE_EQ(policy.OnDied(40.0).value(), 40.1);
  policy.OnStarted(50.0);
  EXPECT_DOUBLE_EQ(policy.OnDied(79.9).value(), 80.1);
}

TEST(RestartPolicyTest, ZeroRestartsMeansNone) {
  RestartPolicy policy({0.1, 1.0, 30.0, 0});
  EXPECT_FALSE(policy.OnDied(0.0));
}

TEST(RestartPolicyTest, SenselessDelaysAreTheCallersFault) {
  EXPECT_THROW(RestartPolicy({0.0, 1.0, 30.0, 1}), std::logic_error);
  EXPECT_THROW(RestartPolicy({2.0, 1.0, 30.0, 1}), std::logic_error);
}

}  // namespace
}  // namespace hires::relay::restart_policy_test
