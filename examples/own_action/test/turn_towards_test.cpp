#include "turn_towards.h"

#include <gtest/gtest.h>

#include <cmath>

namespace own_action {
namespace {

using hires::geometry::Pose2;
using hires::skills::Progress;
using hires::skills::Status;

/// A base that turns as it is told, one cycle late.
struct Turntable {
  hires::robot::Observation seen;
  double fastest{0.0};  // [rad/s] that it was told
  double most_moved{0.0};

  Status Play(TurnTowards* skill, bool is_blocked = false) {
    Status status;
    double wz = 0.0;
    for (int i = 0; i < 400 && status.progress == Progress::kRunning; ++i) {
      hires::robot::Command command;
      status = skill->Update(seen, &command);
      seen.V_B.wz = is_blocked ? 0.0 : wz;
      wz = command.base_velocity->wz;
      fastest = std::max(fastest, std::abs(wz));
      most_moved = std::max(
          {most_moved, std::abs(command.base_velocity->vx), std::abs(command.base_velocity->vy)});
      seen.X_MB.yaw += skill->period() * seen.V_B.wz;
      seen.time += skill->period();
    }
    return status;
  }
};

hires::robot::MotionSet Fast() {
  hires::robot::MotionSet fast;
  fast.max_angular_velocity = 1.0;
  fast.max_angular_acceleration = 3.2;
  return fast;
}

TEST(TurnTowardsTest, FacesThePointFromWhereverItLooks) {
  for (int i = -8; i <= 8; ++i) {
    Turntable base;
    base.seen.X_MB = Pose2{1.0, 2.0, 0.39 * i};
    TurnTowards skill({4.0, 6.0}, Fast());
    EXPECT_EQ(base.Play(&skill).progress, Progress::kSucceeded);
    EXPECT_NEAR(std::remainder(base.seen.X_MB.yaw - std::atan2(4.0, 3.0), 2.0 * M_PI), 0.0, 0.03);
    EXPECT_LE(base.fastest, 1.0);
    EXPECT_EQ(base.most_moved, 0.0);
  }
}

TEST(TurnTowardsTest, TurnsTheShortWay) {
  Turntable base;
  base.seen.X_MB.yaw = 3.0;
  TurnTowards skill({-1.0, -0.1}, Fast());  // at -3.04 rad, 0.24 rad farther to the left
  EXPECT_EQ(base.Play(&skill).progress, Progress::kSucceeded);
  EXPECT_NEAR(base.seen.X_MB.yaw, 3.24, 0.04);
}

TEST(TurnTowardsTest, GivesUpWhenTheBaseDoesNotTurn) {
  Turntable base;
  TurnTowards skill({0.0, 1.0}, Fast());
  EXPECT_EQ(base.Play(&skill, true).progress, Progress::kFailed);
  EXPECT_NEAR(base.seen.time, 2.1, 0.11);
}

}  // namespace
}  // namespace own_action
