#include "sim_robot/bump_schedule.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace hires::sim_robot::bump_schedule_test {
namespace {

constexpr double kStep = 0.0005;  // [s]

struct Bump {
  double begin{0.0}, end{0.0};                          // [s] between the first and last push
  Eigen::Vector2d velocity{Eigen::Vector2d::Zero()};    // [m/s] that the base has gained by it
  Eigen::Vector2d first_half{Eigen::Vector2d::Zero()};  // [m/s] of that, before its middle
};

/// All bumps of so many seconds.
std::vector<Bump> BumpsIn(double seconds, const Bumps& bumps, int seed) {
  BumpSchedule schedule(bumps, base::Rng(seed));
  std::vector<Bump> found;
  bool was_pushed = false;
  for (double time = 0.0; time < seconds; time += kStep) {
    const auto push = schedule.PushAt(time);
    if (push) {
      if (!was_pushed) found.push_back({time, time});
      Bump& bump = found.back();
      bump.end = time;
      const Eigen::Vector2d gained = kStep * Eigen::Vector2d(push->vx, push->vy);
      bump.velocity += gained;
      if (time - bump.begin < bumps.duration / 2.0) bump.first_half += gained;
      EXPECT_EQ(push->wz, 0.0);
    }
    was_pushed = push.has_value();
  }
  return found;
}

// In closed form: half a sine wave whose integral is the bump's speed, half of it by its middle.
TEST(BumpScheduleTest, ABumpGivesTheSpeedThatIsAskedForWithinItsDuration) {
  const Bumps one_speed{2.0, 0.2, 0.2, 0.25};
  const std::vector<Bump> bumps = BumpsIn(100.0, one_speed, 1);
  ASSERT_GT(bumps.size(), 20U);
  for (const Bump& bump : bumps) {
    EXPECT_NEAR(bump.velocity.norm(), 0.2, 0.001);
    EXPECT_NEAR(bump.first_half.norm(), 0.1, 0.002);
    EXPECT_NEAR(bump.end - bump.begin, 0.25, 3.0 * kStep);
  }
}

TEST(BumpScheduleTest, SpeedsBearingsAndIntervalsAreDrawnAsTheTruthSays) {
  const Bumps range{2.0, 0.1, 0.3, 0.25};
  double speeds = 0.0, pause = 0.0, last_end = 0.0;
  Eigen::Vector2d bearings = Eigen::Vector2d::Zero();
  const std::vector<Bump> bumps = BumpsIn(2000.0, range, 2);
  const auto count = static_cast<double>(bumps.size());
  for (const Bump& bump : bumps) {
    EXPECT_GT(bump.velocity.norm(), 0.099);
    EXPECT_LT(bump.velocity.norm(), 0.301);
    speeds += bump.velocity.norm() / count;
    bearings += bump.velocity.normalized() / count;
    pause += (bump.begin - last_end) / count;
    last_end = bump.end;
  }
  ASSERT_GT(count, 500.0);  // bounds below: four standard errors and more
  EXPECT_NEAR(speeds, 0.2, 0.011);
  EXPECT_LT(bearings.norm(), 0.13);
  EXPECT_NEAR(pause, 2.0, 0.36);
}

TEST(BumpScheduleTest, NobodyBumpsWhereNoIntervalIsGiven) {
  EXPECT_TRUE(BumpsIn(100.0, Bumps{}, 3).empty());
}

}  // namespace
}  // namespace hires::sim_robot::bump_schedule_test
