#include <gtest/gtest.h>

#include "hires/robot/observation.h"

namespace hires::robot::robot_state_test {
namespace {

RobotState Example() { return {{1.0, 2.0, 0.5}, {0.3, 0.1, -0.2}, {{"torso_lift_joint", 0.295}}}; }

TEST(RobotState, EqualsItself) { EXPECT_TRUE(Example() == Example()); }

TEST(RobotState, DiffersInEveryField) {
  const std::vector<void (*)(RobotState*)> changes{
      [](RobotState* s) { s->X_MB.x += 1e-12; },
      [](RobotState* s) { s->X_MB.y += 1e-12; },
      [](RobotState* s) { s->X_MB.yaw += 1e-12; },
      [](RobotState* s) { s->V_B.vx += 1e-12; },
      [](RobotState* s) { s->V_B.vy += 1e-12; },
      [](RobotState* s) { s->V_B.wz += 1e-12; },
      [](RobotState* s) { s->joints["torso_lift_joint"] = 0.29; },
      [](RobotState* s) { s->joints["head_pan_joint"] = 0.0; }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    RobotState changed = Example();
    changes[i](&changed);
    EXPECT_FALSE(changed == Example()) << "change " << i;
  }
}

}  // namespace
}  // namespace hires::robot::robot_state_test
