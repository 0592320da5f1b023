#pragma once

#include <gtest/gtest.h>

#include "hires/imagination/rollout_result.h"

namespace hires::test_support {

/// Two rollouts are one: outcome, time, where the robot and each object stand and how they move.
inline void ExpectSameBits(const imagination::RolloutResult& a,
                           const imagination::RolloutResult& b) {
  EXPECT_TRUE(SameOutcome(a, b));
  EXPECT_EQ(a.simulated, b.simulated);
  EXPECT_TRUE(a.final_robot == b.final_robot);
  ASSERT_EQ(a.final_world.objects.size(), b.final_world.objects.size());
  for (std::size_t i = 0; i < a.final_world.objects.size(); ++i) {
    const world::ObjectState &first = a.final_world.objects[i], &second = b.final_world.objects[i];
    EXPECT_EQ(first.name, second.name);
    EXPECT_EQ(first.X_MO.translation, second.X_MO.translation);
    EXPECT_EQ(first.X_MO.rotation.coeffs(), second.X_MO.rotation.coeffs());
    EXPECT_EQ(first.V_MO.linear, second.V_MO.linear);
    EXPECT_EQ(first.V_MO.angular, second.V_MO.angular);
  }
}

}  // namespace hires::test_support
