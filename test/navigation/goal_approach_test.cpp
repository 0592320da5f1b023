#include "navigation/goal_approach.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "navigation/closed_loop.h"

namespace hires::navigation::goal_approach_test {
namespace {

using geometry::Pose2;
using test_support::EmptyScene;
using test_support::IdealBase;
using test_support::PaddedFootprint;

const robot::MotionSet kGentle{0.30, 0.6, 0.5, 1.0};

GoalApproach ApproachOf(double max_lateral_velocity, const robot::MotionSet& limits = kGentle) {
  DwaParams params;
  params.max_lateral_velocity = max_lateral_velocity;
  GoalApproach approach(params);
  approach.SetMotionSet(limits);
  return approach;
}

struct Approached {
  GoalApproach::State state{GoalApproach::State::kDriving};
  IdealBase base;
  double duration{0.0};  // [s]
};

/// @param X_BBelieved  where the base takes itself to be, in the true base.
Approached RunTo(GoalApproach* approach, const Costmap& costmap, const Pose2& X_MB,
                 const Pose2& X_BBelieved = {}) {
  SweptFootprint sweep(PaddedFootprint(), 0.025, 0.1);
  Approached run;
  run.base.X_MB = X_MB;
  while (run.state == GoalApproach::State::kDriving && run.duration < 60.0) {
    const auto step = approach->Update(costmap, run.base.X_MB * X_BBelieved, run.base.V_B, &sweep);
    run.state = step.state;
    run.base.Step(step.velocity, 0.1);
    run.duration += 0.1;
  }
  return run;
}

// Whoever lacks a part of its way at the goal's heading drives just that, whatever its believed
// place does while it turns.
TEST(GoalApproachTest, DrivesWhatIsMissingHoweverItsPlaceErrs) {
  const Costmap costmap = EmptyScene(6, 6).MakeCostmap();
  const base::Rng root(5);
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = root.Fork(seed);
    const robot::MotionSet limits{rng.Uniform(0.2, 0.8), rng.Uniform(0.5, 1.5),
                                  rng.Uniform(0.5, 5.0), rng.Uniform(1.0, 10.0)};
    GoalApproach approach = ApproachOf(seed % 2 == 0 ? 0.0 : 0.1, limits);
    const Pose2 X_BBelieved{rng.Normal(0.0, 0.05), rng.Normal(0.0, 0.05), rng.Normal(0.0, 0.02)};
    const Pose2 X_MB{3.0, 3.0, rng.Uniform(-3.1, 3.1)};
    const double way = rng.Uniform(0.2, 0.4), to = rng.Uniform(-3.1, 3.1);
    const Eigen::Vector2d missing(way * std::cos(to), way * std::sin(to));
    const Pose2 X_MBelieved = X_MB * X_BBelieved;
    approach.BeginFrom(X_MBelieved,
                       {X_MBelieved.x + missing.x(), X_MBelieved.y + missing.y(), X_MBelieved.yaw});
    const Approached run = RunTo(&approach, costmap, X_MB, X_BBelieved);
    EXPECT_EQ(run.state, GoalApproach::State::kArrived) << seed;
    EXPECT_LT((run.base.X_MB.position() - X_MB.position() - missing).norm(), 0.05) << seed;
    EXPECT_LT(run.duration, 12.0 + way / 0.1) << seed;
    EXPECT_FALSE(approach.is_active());
  }
}

TEST(GoalApproachTest, TurnsItsBackWhereThatIsNearer) {
  const Costmap costmap = EmptyScene(6, 6).MakeCostmap();
  GoalApproach approach = ApproachOf(0.0);
  approach.BeginTo({2.7, 3.0, 0.0});
  const Approached run = RunTo(&approach, costmap, {3.0, 3.0, 0.0});
  EXPECT_EQ(run.state, GoalApproach::State::kArrived);
  EXPECT_NEAR(run.base.X_MB.yaw, 0.0, 0.05);
  EXPECT_NEAR(run.base.X_MB.x, 2.7, 0.03);
}

TEST(GoalApproachTest, IsBlockedByWhatStandsInItsWay) {
  test_support::Scene scene = EmptyScene(6, 6);
  scene.Add(3.4, 2.0, 3.5, 4.0);  // 0.06 m before its front
  const Costmap costmap = scene.MakeCostmap();
  for (const double lateral : {0.0, 0.1}) {
    GoalApproach approach = ApproachOf(lateral);
    approach.BeginTo({3.25, 3.0, 0.0});
    const Approached run = RunTo(&approach, costmap, {2.93, 3.0, 0.0});
    EXPECT_EQ(run.state, GoalApproach::State::kBlocked) << lateral;
    EXPECT_FALSE(approach.is_active());
  }
}

TEST(GoalWatchTest, ToAndFroBesideTheGoalIsSwinging) {
  GoalWatch watch{DwaParams{}};
  int cycles = 0;
  while (cycles < 100 && !watch.Swings({0.0, 0.0, cycles % 10 < 5 ? 0.3 : 0.4}, {0.25, 0.0}))
    ++cycles;
  EXPECT_GT(cycles, 15);
  EXPECT_LT(cycles, 30);
}

TEST(GoalWatchTest, ComingNearerTurningToTheGoalAndBeingFarAreNot) {
  GoalWatch watch{DwaParams{}};
  for (int i = 0; i < 100; ++i)
    EXPECT_FALSE(watch.Swings({0.003 * i, 0.0, 0.0}, {0.5, 0.0})) << "30 mm/s";
  watch.Reset();
  for (int i = 0; i < 60; ++i)
    EXPECT_FALSE(watch.Swings({0.0, 0.0, 3.0 - 0.05 * i}, {0.4, 0.0})) << "0.5 rad/s";
  watch.Reset();
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(watch.Swings({0.0, 0.0, 0.0}, {2.0, 0.0}));
}

TEST(GoalWatchTest, OfASlowMotionSetNoMoreIsAskedThanItCanDo) {
  GoalWatch watch{DwaParams{}};
  watch.SetMotionSet({0.02, 0.05, 0.05, 0.1});
  for (int i = 0; i < 400; ++i)
    EXPECT_FALSE(watch.Swings({0.0, 0.0, 3.0 - 0.005 * i}, {0.4, 0.0})) << "0.05 rad/s";
  watch.Reset();
  for (int i = 0; i < 150; ++i)
    EXPECT_FALSE(watch.Swings({0.002 * i, 0.0, 0.0}, {0.5, 0.0})) << "20 mm/s";
  watch.Reset();
  int cycles = 0;
  while (cycles < 100 && !watch.Swings({0.0, 0.0, 0.3}, {0.25, 0.0})) ++cycles;
  EXPECT_LT(cycles, 30);
}

}  // namespace
}  // namespace hires::navigation::goal_approach_test
