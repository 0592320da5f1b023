#include "robot/profile/motion_set_order.h"

#include <gtest/gtest.h>

namespace hires::robot::motion_set_order_test {
namespace {

TEST(MostCautiousFirstTest, OrdersByVelocityThenAcceleration) {
  EXPECT_EQ(MostCautiousFirst({{"a", {0.5, 1.0, 2.0, 3.0}},
                               {"b", {0.3, 1.0, 2.0, 3.0}},
                               {"c", {0.5, 0.4, 1.0, 3.0}},
                               {"d", {0.5, 0.5, 2.0, 3.0}},
                               {"e", {0.5, 0.5, 2.0, 3.0}}}),
            (std::vector<std::string>{"b", "c", "d", "e", "a"}));
  EXPECT_EQ(MostCautiousFirst(RobotProfile().motion_sets),
            (std::vector<std::string>{"slow", "fast"}));
}

}  // namespace
}  // namespace hires::robot::motion_set_order_test
