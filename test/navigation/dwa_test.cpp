#include "hires/navigation/dwa.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "hires/geometry/angles.h"
#include "navigation/closed_loop.h"
#include "navigation/distance_grid.h"
#include "navigation/swept_footprint.h"

namespace hires::navigation::dwa_test {
namespace {

using namespace test_support;
using geometry::kPi;

void ExpectArrived(const Drive& drive, const geometry::Pose2& X_MGoal) {
  const DwaParams params;
  ASSERT_EQ(drive.status, DwaStatus::kGoalReached)
      << "after " << drive.duration << " s at " << drive.base.X_MB.x << " " << drive.base.X_MB.y
      << " " << drive.base.X_MB.yaw;
  EXPECT_LE((drive.base.X_MB.position() - X_MGoal.position()).norm(), params.xy_goal_tolerance);
  EXPECT_LE(std::abs(geometry::WrapToPi(drive.base.X_MB.yaw - X_MGoal.yaw)),
            params.yaw_goal_tolerance);
  EXPECT_LE(std::hypot(drive.base.V_B.vx, drive.base.V_B.vy), params.stopped_linear_velocity);
  EXPECT_LE(std::abs(drive.base.V_B.wz), params.stopped_angular_velocity);
}

/// Velocities within the set's limits, and no command farther than one period's acceleration away
/// from what the base did.
void ExpectWithinLimits(const Drive& drive, const robot::MotionSet& limits) {
  const double dt = DwaParams{}.control_period, slack = 1e-3;
  for (const Cycle& cycle : drive.cycles) {
    const geometry::Twist2& V = cycle.result.velocity;
    EXPECT_LE(std::hypot(V.vx, V.vy), limits.max_linear_velocity + slack);
    EXPECT_LE(std::abs(V.wz), limits.max_angular_velocity + slack);
    if (cycle.result.status != DwaStatus::kDriving) continue;
    EXPECT_LE(std::abs(V.vx - cycle.V_B.vx), limits.max_linear_acceleration * dt + slack);
    EXPECT_LE(std::abs(V.vy - cycle.V_B.vy), limits.max_linear_acceleration * dt + slack);
    EXPECT_LE(std::abs(V.wz - cycle.V_B.wz), limits.max_angular_acceleration * dt + slack);
  }
}

struct NamedSet {
  const char* name;
  robot::MotionSet limits;
};

class DwaMotionSetTest : public ::testing::TestWithParam<NamedSet> {};
INSTANTIATE_TEST_SUITE_P(, DwaMotionSetTest,
                         ::testing::Values(NamedSet{"slow", kSlow}, NamedSet{"fast", kFast}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(DwaMotionSetTest, FreeGroundIsCrossedStraightAndTheGoalReached) {
  const geometry::Pose2 X_MGoal{7.0, 2.0, 0.0};
  const Drive drive = DriveTo(EmptyScene(9, 4), {1.0, 2.0, 0.0}, X_MGoal, GetParam().limits);
  ExpectArrived(drive, X_MGoal);
  ExpectWithinLimits(drive, GetParam().limits);
  double fastest = 0.0;
  for (const Cycle& cycle : drive.cycles) {
    EXPECT_NEAR(cycle.X_MB.y, 2.0, 0.1);
    EXPECT_NEAR(cycle.X_MB.yaw, 0.0, 0.15);
    fastest = std::max(fastest, cycle.result.velocity.vx);
  }
  EXPECT_NEAR(fastest, GetParam().limits.max_linear_velocity, 0.01);
}

TEST_P(DwaMotionSetTest, GoalsAllAroundAreReachedFromEveryHeading) {
  const base::Rng root(61);
  for (int seed = 0; seed < 30; ++seed) {
    base::Rng rng = root.Fork(seed);
    const auto pose = [&rng] {
      return geometry::Pose2{rng.Uniform(1, 6), rng.Uniform(1, 6), rng.Uniform(-kPi, kPi)};
    };
    const geometry::Pose2 X_MStart = pose(), X_MGoal = pose();
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Drive drive = DriveTo(EmptyScene(7, 7), X_MStart, X_MGoal, GetParam().limits);
    ExpectArrived(drive, X_MGoal);
    ExpectWithinLimits(drive, GetParam().limits);
  }
}

TEST_P(DwaMotionSetTest, ABoxIsDrivenRoundWithoutTouchingIt) {
  Scene scene = EmptyScene(8, 6);
  scene.Add(3.6, 2.4, 4.4, 3.4);
  const geometry::Pose2 X_MGoal{7.0, 3.0, 1.0};
  const Drive drive = DriveTo(scene, {1.0, 3.0, 0.0}, X_MGoal, GetParam().limits);
  ExpectArrived(drive, X_MGoal);
  ExpectWithinLimits(drive, GetParam().limits);
  EXPECT_GT(drive.clearance, 0.0);
}

TEST_P(DwaMotionSetTest, ACorridorOfOneMetreIsDrivenThrough) {
  Scene scene = EmptyScene(8, 4);
  scene.Add(2.0, 0.0, 6.0, 1.5);
  scene.Add(2.0, 2.5, 6.0, 4.0);
  const geometry::Pose2 X_MGoal{7.2, 2.0, 0.0};
  const Drive drive = DriveTo(scene, {0.8, 2.8, -1.0}, X_MGoal, GetParam().limits);
  ExpectArrived(drive, X_MGoal);
  ExpectWithinLimits(drive, GetParam().limits);
  EXPECT_GT(drive.clearance, 0.0);
}

TEST_P(DwaMotionSetTest, AWallThatAppearsIsNotTouched) {
  Scene scene = EmptyScene(8, 4);
  const Costmap costmap = scene.MakeCostmap();
  DwaPlanner planner({}, PaddedFootprint());
  planner.SetMotionSet(GetParam().limits);
  planner.SetPath({{1.0, 2.0, 0.0}, {7.0, 2.0, 0.0}});
  IdealBase base;
  base.X_MB = {1.0, 2.0, 0.0};
  Drive drive = DriveWith(&planner, costmap, base, {}, 2.0);
  const auto wall = Rectangle(drive.base.X_MB.x + 1.0, 0.0, drive.base.X_MB.x + 1.1, 4.0);
  const Costmap with_wall = costmap.WithObstacles({wall});
  const double x_before = drive.base.X_MB.x;
  drive = DriveWith(&planner, with_wall, drive.base, {wall}, 20.0);
  EXPECT_NE(drive.status, DwaStatus::kGoalReached);
  for (int i = 0; i < 100; ++i) {  // braked by the caller, as a skill does when there is no way
    drive.base.Step({}, 0.01);
    const auto outline = geometry::Transformed(drive.base.X_MB, Pr2Footprint());
    drive.clearance = std::min(drive.clearance, geometry::Distance(outline, wall));
  }
  EXPECT_GT(drive.clearance, 0.0);
  EXPECT_GT(drive.base.X_MB.x, x_before);
}

TEST_P(DwaMotionSetTest, AtTheGoalItTurnsInPlace) {
  const geometry::Pose2 X_MGoal{2.0, 2.0, 2.5};
  const Drive drive = DriveTo(EmptyScene(4, 4), {1.95, 2.05, 0.0}, X_MGoal, GetParam().limits);
  ExpectArrived(drive, X_MGoal);
  ExpectWithinLimits(drive, GetParam().limits);
  for (const Cycle& cycle : drive.cycles) {
    EXPECT_NEAR(cycle.X_MB.x, 1.95, 1e-9);
    EXPECT_NEAR(cycle.X_MB.y, 2.05, 1e-9);
    EXPECT_GE(cycle.result.velocity.wz, 0.0);  // the shorter way round
  }
}

// The pose west of table 2: the chair's side lies 0.14 m west of the footprint's square, the table
// 0.6 m east of it, the other table beyond the chair.
Scene BesideTheChair() {
  Scene scene = EmptyScene(8, 8);
  scene.Add(3.13, 3.73, 3.53, 4.13);  // chair; the goal is (4.00, 4.00)
  scene.Add(2.38, 3.65, 3.08, 4.35);  // table
  scene.Add(4.93, 3.65, 5.63, 4.35);  // table
  return scene;
}

TEST_P(DwaMotionSetTest, AGoalBesideAChairIsReachedFromEverywhereWithoutTouching) {
  const geometry::Pose2 X_MGoal{4.0, 4.0, 0.0};
  const Scene scene = BesideTheChair();
  const Costmap costmap = scene.MakeCostmap();
  ASSERT_LT(costmap.FootprintCost(PaddedFootprint(), X_MGoal), kLethalCost);
  const base::Rng root(62);
  double longest = 0.0, nearest = 1.0;
  for (int seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    base::Rng rng = root.Fork(seed);
    geometry::Pose2 X_MStart;
    do {  // anywhere outside of the goal's tolerance where the robot can stand and turn
      X_MStart = {rng.Uniform(1, 7), rng.Uniform(1, 7), rng.Uniform(-kPi, kPi)};
    } while (costmap.FootprintCost(Rectangle(-0.6, -0.6, 0.6, 0.6), X_MStart) >= kLethalCost);
    const Drive drive = DriveTo(scene, X_MStart, X_MGoal, GetParam().limits);
    ExpectArrived(drive, X_MGoal);
    ExpectWithinLimits(drive, GetParam().limits);
    EXPECT_GT(drive.clearance, 0.0);
    longest = std::max(longest, drive.duration);
    nearest = std::min(nearest, drive.clearance);
  }
  std::printf("%s: 100 drives to the chair, longest %.1f s, nearest %.3f m\n", GetParam().name,
              longest, nearest);
}

// Who comes from north or south cannot turn beside the chair, and cannot shift away from it.
TEST_P(DwaMotionSetTest, TwoDrivenWheelsArriveThereOrSayThatTheyCannotTurn) {
  const geometry::Pose2 X_MGoal{4.0, 4.0, 0.0};
  const Scene scene = BesideTheChair();
  const Costmap costmap = scene.MakeCostmap();
  DwaParams params;
  params.max_lateral_velocity = 0.0;
  const base::Rng root(62);
  int num_arrived = 0;
  for (int seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    base::Rng rng = root.Fork(seed);
    IdealBase base;
    do {
      base.X_MB = {rng.Uniform(1, 7), rng.Uniform(1, 7), rng.Uniform(-kPi, kPi)};
    } while (costmap.FootprintCost(Rectangle(-0.6, -0.6, 0.6, 0.6), base.X_MB) >= kLethalCost);
    DwaPlanner planner(params, PaddedFootprint());
    planner.SetMotionSet(GetParam().limits);
    planner.SetPath(PlanPath(costmap, base.X_MB, X_MGoal).path);
    const Drive drive = DriveWith(&planner, costmap, base, scene.obstacles);
    if (drive.status == DwaStatus::kNoValidTrajectory) {
      EXPECT_LT((drive.base.X_MB.position() - X_MGoal.position()).norm(), 0.3);  // it came there
    } else {
      ExpectArrived(drive, X_MGoal);
      ++num_arrived;
    }
    EXPECT_GT(drive.clearance, 0.0);
    for (const Cycle& cycle : drive.cycles) ASSERT_EQ(cycle.result.velocity.vy, 0.0);
  }
  EXPECT_GT(num_arrived, 50);
}

TEST_P(DwaMotionSetTest, FiveMetresTakeAboutAsLongAsInTheOriginal) {
  const geometry::Pose2 X_MGoal{6.17, 2.0, kPi};  // east, and turned back as at the tables
  const Drive turned = DriveTo(EmptyScene(8, 4), {1.0, 2.0, kPi}, X_MGoal, GetParam().limits);
  ExpectArrived(turned, X_MGoal);
  const Drive ahead =
      DriveTo(EmptyScene(8, 4), {1.0, 2.0, 0.0}, {6.17, 2.0, 0.0}, GetParam().limits);
  std::printf("%s: 5.17 m in %.1f s, with turning at both ends %.1f s\n", GetParam().name,
              ahead.duration, turned.duration);
  EXPECT_GT(ahead.duration, 4.97 / GetParam().limits.max_linear_velocity);
  EXPECT_GT(turned.duration, ahead.duration + 3.0);  // two half turns at 1 rad/s overlap partly
}

/// The obvious road: every velocity scored with all critics, for a straight path that ends within
/// sight and a planner that has just begun.
struct PlainScores {
  PlainScores(const Costmap& costmap, const geometry::Pose2& X_MB, const Eigen::Vector2d& p_MGoal)
      : costmap(costmap), X_MB(X_MB) {
    window.Centre(costmap, X_MB.position(), 3.0);
    const Eigen::Vector2d way = p_MGoal - X_MB.position();
    const int pieces = std::ceil(way.norm() / params.sim_granularity);
    std::vector<int> cells;
    for (int k = 0; k <= pieces; ++k) {
      cells.push_back(window.CellBelow(X_MB.position() + way * k / pieces));
    }
    path.Compute(window, cells);
    goal.Compute(window, {cells.back()});
    front.Compute(window, {window.CellBelow(p_MGoal + 0.325 * way.normalized())});
  }

  /// Negative if the velocity must not be driven.
  double Score(const geometry::Twist2& V) {
    const double speed = std::hypot(V.vx, V.vy);
    const double scale = speed > 0.25 ? 1.0 + 0.2 * std::min(1.0, (speed - 0.25) / 0.30) : 1.0;
    const int cost = sweep.HighestCost(costmap, X_MB, V, params.sim_time, scale);
    const geometry::Pose2 X_MEnd = PoseAfter(X_MB, V, params.sim_time);
    const auto base = window.Around(X_MEnd.position());
    const auto nose = window.Around(X_MEnd * Eigen::Vector2d(0.325, 0.0));
    if (cost >= kLethalCost || path.At(*base) >= DistanceGrid::kUnreachable ||
        goal.At(*base) >= DistanceGrid::kUnreachable) {
      return -1.0;
    }
    return 0.05 * (12.0 * (path.At(*base) + path.At(*nose)) +
                   16.0 * (goal.At(*base) + front.At(*nose)) + 0.01 * cost);
  }

  DwaParams params;
  const Costmap& costmap;
  geometry::Pose2 X_MB;
  LocalWindow window;
  DistanceGrid path, goal, front;
  SweptFootprint sweep{geometry::Padded(PaddedFootprint(), 0.02), 0.025, 0.1};
};

TEST(DwaTest, NoVelocityScoresBetterThanTheOneChosen) {
  const base::Rng root(63);
  int compared = 0;
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = root.Fork(seed);
    const Costmap costmap(RandomGrid(140, 140, 0.002, &rng), Scene::kInscribedRadius, {});
    const geometry::Pose2 X_MB{3.5, 3.5, rng.Uniform(-kPi, kPi)};
    const geometry::Twist2 V_B{rng.Uniform(0, 0.5), rng.Uniform(-0.1, 0.1), rng.Uniform(-1, 1)};
    const Eigen::Vector2d p_MGoal(rng.Uniform(5.0, 6.0), rng.Uniform(2.0, 5.0));
    DwaPlanner planner({}, PaddedFootprint());
    planner.SetMotionSet(kFast);
    planner.SetPath({X_MB, {p_MGoal.x(), p_MGoal.y(), 0.0}});
    const DwaResult result = planner.Update(costmap, X_MB, V_B);
    PlainScores plain(costmap, X_MB, p_MGoal);
    double best = std::numeric_limits<double>::infinity();
    for (const geometry::Twist2& V : ReachableVelocities({}, kFast, V_B)) {
      const double score = plain.Score(V);
      if (score >= 0.0) best = std::min(best, score);
    }
    if (std::isinf(best)) continue;  // nothing passes with the margin
    ++compared;
    ASSERT_EQ(result.status, DwaStatus::kDriving) << "seed " << seed;
    EXPECT_NEAR(plain.Score(result.velocity), best, 1e-9) << "seed " << seed;
  }
  EXPECT_GT(compared, 30);
}

TEST(DwaTest, AnotherRunGivesTheSameBits) {
  const Scene scene = BesideTheChair();
  const Drive one = DriveTo(scene, {2.0, 6.0, 1.0}, {4.0, 4.0, 0.0}, kFast);
  const Drive other = DriveTo(scene, {2.0, 6.0, 1.0}, {4.0, 4.0, 0.0}, kFast);
  ASSERT_EQ(one.cycles.size(), other.cycles.size());
  for (std::size_t i = 0; i < one.cycles.size(); ++i) {
    EXPECT_EQ(one.cycles[i].result.velocity.vx, other.cycles[i].result.velocity.vx);
    EXPECT_EQ(one.cycles[i].result.velocity.wz, other.cycles[i].result.velocity.wz);
    EXPECT_EQ(one.cycles[i].X_MB.x, other.cycles[i].X_MB.x);
  }
}

TEST(DwaTest, ACopyGoesOnFromTheSameStateOnItsOwn) {
  const Costmap costmap = EmptyScene(8, 4).MakeCostmap();
  DwaPlanner planner({}, PaddedFootprint());
  planner.SetPath({{1.0, 2.0, 0.0}, {7.0, 2.0, 0.0}});
  DwaPlanner copy = planner;
  copy.SetPath({{1.0, 2.0, 0.0}, {1.1, 2.0, 0.0}});
  const geometry::Pose2 X_MB{1.0, 2.0, 0.0};
  EXPECT_EQ(copy.Update(costmap, X_MB, {}).status, DwaStatus::kGoalReached);
  EXPECT_EQ(planner.Update(costmap, X_MB, {}).status, DwaStatus::kDriving);
}

TEST(DwaTest, ARobotThatTouchesSomethingHasNoValidTrajectory) {
  Scene scene = EmptyScene(8, 4);
  scene.Add(1.25, 1.9, 1.3, 2.0);  // within the square, but not where its centre is
  const Costmap costmap = scene.MakeCostmap();
  DwaPlanner planner({}, PaddedFootprint());
  planner.SetPath({{1.0, 2.0, 0.0}, {7.0, 2.0, 0.0}});
  const DwaResult result = planner.Update(costmap, {1.0, 2.0, 0.0}, {0.3, 0.0, 0.0});
  EXPECT_EQ(result.status, DwaStatus::kNoValidTrajectory);
  EXPECT_EQ(result.velocity.vx, 0.0);
}

TEST(DwaTest, ARobotInInflatedCostDrivesOn) {
  Scene scene = EmptyScene(8, 4);
  scene.Add(0.5, 2.45, 1.5, 2.5);  // 0.11 m beside the square
  const geometry::Pose2 X_MGoal{6.0, 2.0, 0.0};
  const Drive drive = DriveTo(scene, {1.0, 2.0, 0.0}, X_MGoal, kFast);
  ExpectArrived(drive, X_MGoal);
  EXPECT_GT(drive.clearance, 0.0);
}

TEST(DwaTest, APathOutOfSightLeavesNothingToFollow) {
  const Costmap costmap = EmptyScene(20, 4).MakeCostmap();
  DwaPlanner planner({}, PaddedFootprint());
  planner.SetPath({{15.0, 2.0, 0.0}, {18.0, 2.0, 0.0}});
  EXPECT_EQ(planner.Update(costmap, {1.0, 2.0, 0.0}, {}).status, DwaStatus::kNoValidTrajectory);
}

TEST(DwaTest, StandingStillWithinToleranceIsTheGoal) {
  const Costmap costmap = EmptyScene(4, 4).MakeCostmap();
  DwaPlanner planner({}, PaddedFootprint());
  planner.SetPath({{2.0, 2.0, 0.0}});
  EXPECT_EQ(planner.Update(costmap, {2.19, 2.0, 0.16}, {}).status, DwaStatus::kGoalReached);
  EXPECT_EQ(planner.Update(costmap, {2.0, 2.0, 0.0}, {0.02, 0.0, 0.0}).status, DwaStatus::kDriving);
  EXPECT_EQ(planner.Update(costmap, {2.0, 2.0, 0.18}, {}).status, DwaStatus::kDriving);
}

TEST(DwaTest, ARobotThatCameToRestOutsideTheToleranceDrivesOn) {
  const Costmap costmap = EmptyScene(4, 4).MakeCostmap();
  DwaPlanner planner({}, PaddedFootprint());
  planner.SetPath({{2.0, 2.0, 0.0}});
  ASSERT_EQ(planner.Update(costmap, {1.85, 2.0, 0.0}, {0.5, 0.0, 0.0}).status, DwaStatus::kDriving);
  const DwaResult result = planner.Update(costmap, {1.7, 2.0, 0.0}, {});  // moved by localisation
  EXPECT_EQ(result.status, DwaStatus::kDriving);
  EXPECT_GT(std::hypot(result.velocity.vx, result.velocity.vy) + std::abs(result.velocity.wz), 0.0);
}

const robot::MotionSet kGentle{0.30, 0.6, 0.5, 1.0};  // 0.05 m/s and 0.1 rad/s within one period

/// Stands 0.205 m from its goal (2, 2, 0), headed `yaw`, which it thought to have reached.
DwaPlanner MissedItsGoal(const Costmap& costmap, double max_lateral_velocity, double yaw) {
  DwaParams params;
  params.max_lateral_velocity = max_lateral_velocity;
  DwaPlanner planner(params, PaddedFootprint());
  planner.SetMotionSet(kGentle);
  planner.SetPath({{2.0, 2.0, yaw}});
  planner.Update(costmap, {1.9, 2.0, yaw}, {0.1, 0.0, 0.0});
  planner.Update(costmap, {1.795, 2.0, yaw}, {});
  return planner;
}

TEST(DwaTest, TwoDrivenWheelsStopWellInsideTheTolerance) {
  const Costmap costmap = EmptyScene(4, 4).MakeCostmap();
  DwaParams params;
  params.max_lateral_velocity = 0.0;
  DwaPlanner planner(params, PaddedFootprint());
  planner.SetMotionSet(kGentle);
  const geometry::Twist2 V_B{0.12, 0.0, 0.0};
  const double braked = 0.07;
  planner.SetPath({{2.0, 2.0, 0.0}});
  EXPECT_GT(planner.Update(costmap, {1.81, 2.0, 0.0}, V_B).velocity.vx, braked + 0.01);
  EXPECT_GT(planner.Update(costmap, {1.85, 2.0, 0.0}, V_B).velocity.vx, braked + 0.01);
  EXPECT_NEAR(planner.Update(costmap, {1.89, 2.0, 0.0}, V_B).velocity.vx, braked, 1e-9);
  EXPECT_EQ(planner.Update(costmap, {1.805, 2.0, 0.0}, {}).status, DwaStatus::kGoalReached);
}

TEST(DwaTest, WhoMissedTheGoalDrivesWhatIsMissing) {
  const Costmap costmap = EmptyScene(4, 4).MakeCostmap();
  for (const double lateral : {0.0, 0.1}) {  // kGentle is no brisk set
    DwaPlanner planner = MissedItsGoal(costmap, lateral, 0.0);
    const DwaResult result = planner.Update(costmap, {1.795, 2.0, 0.0}, {});
    EXPECT_EQ(result.status, DwaStatus::kDriving);
    EXPECT_GT(result.velocity.vx, 0.04) << lateral;
    EXPECT_NEAR(result.velocity.vy, 0.0, 1e-9);
    EXPECT_NEAR(result.velocity.wz, 0.0, 1e-9);
  }
}

TEST(DwaTest, TwoDrivenWheelsTurnBackToAMissedGoalTheShorterWay) {
  const Costmap costmap = EmptyScene(4, 4).MakeCostmap();
  for (const double side : {1.0, -1.0}) {
    for (const double measured : {-0.009, -0.001, 0.0, 0.001, 0.009}) {
      DwaPlanner planner = MissedItsGoal(costmap, 0.0, side * 1.45);
      DwaResult result;
      for (int i = 0; i < 3; ++i)
        result = planner.Update(costmap, {1.795, 2.0, side * 1.45}, {0.0, 0.0, measured});
      EXPECT_LT(side * result.velocity.wz, 0.0) << side << " " << measured;
    }
  }
}

// As the base turns to the goal's heading, the place at which it takes itself to be moves by up to
// 0.06 m, from within the tolerance to beyond it.
TEST(DwaTest, TwoDrivenWheelsWhosePlaceMovesAsTheyTurnArriveAllTheSame) {
  const Costmap costmap = EmptyScene(6, 5).MakeCostmap();
  DwaParams params;
  params.max_lateral_velocity = 0.0;
  const geometry::Pose2 X_MGoal{4.5, 2.0, kPi / 2};
  const auto path = PlanPath(costmap, {1.5, 2.0, 0.0}, X_MGoal).path;
  for (const robot::MotionSet& limits : {kGentle, kSlow, kFast}) {
    for (const double ahead : {-0.03, -0.015, 0.0, 0.015, 0.03}) {
      for (const double left : {-0.03, -0.015, 0.0, 0.015, 0.03}) {
        DwaPlanner planner(params, PaddedFootprint());
        planner.SetMotionSet(limits);
        planner.SetPath(path);
        IdealBase base;
        base.X_MB = {1.5, 2.0, 0.0};
        const Drive drive = DriveWith(&planner, costmap, base, {}, 30.0, {ahead, left, 0.0});
        EXPECT_EQ(drive.status, DwaStatus::kGoalReached)
            << limits.max_linear_velocity << " m/s, " << ahead << " " << left;
      }
    }
  }
}

// Where the square of 0.7 m cannot turn, the robot first moves to where it can.
TEST(DwaTest, ATurnThatWouldTouchIsMadeWhereThereIsRoom) {
  Scene scene = EmptyScene(6, 6);
  scene.Add(2.0, 2.0, 2.53, 4.0);  // a wall 0.44 m left of the start
  const geometry::Pose2 X_MGoal{3.0, 3.0, 0.0};
  const Costmap costmap = scene.MakeCostmap();
  DwaPlanner planner({}, PaddedFootprint());
  planner.SetMotionSet(kSlow);
  planner.SetPath({{2.97, 3.05, 0.0}, X_MGoal});
  IdealBase base;
  base.X_MB = {2.97, 3.05, -kPi / 2};
  ASSERT_LT(costmap.FootprintCost(PaddedFootprint(), base.X_MB), kLethalCost);
  ASSERT_GE(costmap.FootprintCost(PaddedFootprint(), {2.97, 3.05, -kPi / 4}), kLethalCost);
  const Drive drive = DriveWith(&planner, costmap, base, scene.obstacles);
  ExpectArrived(drive, X_MGoal);
  ExpectWithinLimits(drive, kSlow);
  EXPECT_GT(drive.base.X_MB.x, 2.97);
  EXPECT_GT(drive.clearance, 0.0);
}

TEST(DwaTest, WithoutRoomToTurnThereIsNoValidTrajectory) {
  Scene scene = EmptyScene(6, 6);
  scene.Add(2.0, 2.0, 2.55, 4.0);
  scene.Add(3.45, 2.0, 4.0, 4.0);  // 0.9 m between the walls, the diagonal is 0.99 m
  const Costmap costmap = scene.MakeCostmap();
  DwaPlanner planner({}, PaddedFootprint());
  planner.SetPath({{3.0, 3.0, 0.0}});
  EXPECT_EQ(planner.Update(costmap, {3.0, 3.0, -kPi / 2}, {}).status,
            DwaStatus::kNoValidTrajectory);
}

/// The path leads round a wall; the costmap has a gap in it, too narrow to turn in. Behind that gap
/// the goal is near.
TEST(DwaTest, APathThatGoesRoundIsNotLeftForAShorterWay) {
  for (const double gap : {0.7, 0.75}) {
    SCOPED_TRACE("gap of " + std::to_string(gap) + " m");
    Scene open = EmptyScene(6, 6);
    open.Add(0.0, 2.6, 2.0 - gap / 2, 3.1);
    open.Add(2.0 + gap / 2, 2.6, 3.6, 3.1);
    Scene shut = open;
    shut.Add(2.0 - gap / 2, 2.6, 2.0 + gap / 2, 3.1);
    const geometry::Pose2 X_MStart{2.0, 1.6, kPi}, X_MGoal{2.0, 4.4, 0.0};
    DwaPlanner planner({}, PaddedFootprint());
    planner.SetMotionSet(kFast);
    planner.SetPath(PlanPath(shut.MakeCostmap(), X_MStart, X_MGoal).path);
    IdealBase base;
    base.X_MB = X_MStart;
    const Drive drive = DriveWith(&planner, open.MakeCostmap(), base, open.obstacles);
    ExpectArrived(drive, X_MGoal);
    EXPECT_LT(drive.duration, 30.0);
  }
}

TEST(DwaTest, BrokenParametersAreRefused) {
  DwaParams params;
  params.control_period = 0.0;
  EXPECT_THROW(DwaPlanner(params, PaddedFootprint()), std::logic_error);
  params = {};
  params.obstacle_scale = -1.0;
  EXPECT_THROW(DwaPlanner(params, PaddedFootprint()), std::logic_error);
  EXPECT_THROW(DwaPlanner({}, geometry::Polygon{{0, 0}, {1, 0}}), std::logic_error);
  DwaPlanner planner({}, PaddedFootprint());
  EXPECT_THROW(planner.SetPath({}), std::logic_error);
  EXPECT_THROW(planner.SetMotionSet({-0.1, 1, 1, 1}), std::logic_error);
  EXPECT_THROW(planner.Update(EmptyScene(4, 4).MakeCostmap(), {}, {}), std::logic_error);
}

}  // namespace
}  // namespace hires::navigation::dwa_test
