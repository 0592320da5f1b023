// What driving skills do while the robot does not know where it is.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "hires/skills/lost_watch.h"
#include "hires/skills/move_base.h"
#include "skills/laser_robot.h"
#include "skills/point_robot.h"
#include "support/scenes.h"

namespace hires::skills::lost_test {
namespace {

using base::FailureCode;
using geometry::Pose2;
using hires::test_support::Room;
using hires::test_support::TrayRobot;
using test_support::PointRobot;
using test_support::RunSkill;
using test_support::SkillRun;

const robot::MotionSet kFast{0.55, 1.0, 2.5, 3.2};
const Pose2 kWest{1.0, 2.0, 0.0}, kEast{4.5, 2.0, 0.0}, kMiddle{2.75, 2.0, 0.0};
constexpr double kUnsure = 0.8;  // [m]

std::shared_ptr<const DrivingContext> Context(MoveBaseParams params = {}) {
  return std::make_shared<const DrivingContext>(
      MakeDrivingContext(Room(), test_support::RobotWithLaser({}), params));
}

std::shared_ptr<const DrivingContext> WithObstacleLayer() {
  MoveBaseParams params;
  params.obstacle_layer.emplace();
  return Context(params);
}

/// Beams in all directions that end so far away [m].
std::shared_ptr<const robot::PlacedScan> ScanOf(double range, const Pose2& X_OB) {
  constexpr int kBeams = 180;
  auto scan = std::make_shared<robot::PlacedScan>();
  scan->reading = {-M_PI, 2.0 * M_PI / kBeams, 0.05, std::vector<float>(kBeams, range), 10.0};
  scan->X_OB = X_OB;
  return scan;
}

robot::Observation Seen(double time, double position_sd, double range) {
  robot::Observation seen;
  seen.time = time;
  seen.X_MB = seen.X_OB = kMiddle;
  seen.position_sd = position_sd;
  seen.scan = ScanOf(range, kMiddle);
  return seen;
}

TEST(LostWatchTest, ItIsLostUntilItIsSureAndGivesUpAfterItsPatience) {
  LostParams params;
  params.patience = 10.0;
  LostWatch watch(params);
  const auto look = [&](double time, double position_sd) {
    return watch.Look(Seen(time, position_sd, 2.0));
  };
  EXPECT_EQ(look(0.0, 0.0), LostWatch::State::kSure);
  EXPECT_EQ(look(1.0, params.max_position_sd), LostWatch::State::kSure);
  EXPECT_EQ(look(2.0, kUnsure), LostWatch::State::kLost);
  EXPECT_TRUE(watch.is_lost());
  EXPECT_EQ(look(11.0, 0.1), LostWatch::State::kFound);
  EXPECT_EQ(look(12.0, 0.1), LostWatch::State::kSure);
  EXPECT_EQ(look(13.0, std::numeric_limits<double>::quiet_NaN()), LostWatch::State::kLost);
  EXPECT_EQ(look(23.0, kUnsure), LostWatch::State::kLost);
  EXPECT_EQ(look(23.1, kUnsure), LostWatch::State::kGivenUp);
  const base::Failure why = watch.Why(Seen(23.1, kUnsure, 2.0));
  EXPECT_EQ(ToString(why), "localisation_lost: sd 0.80 m for 10 s");
}

TEST(LostTest, ARobotStopsAndDrivesOnFromWhereItIsFound) {
  MoveBase skill(Context(), kEast, kFast);
  bool was_moving = false, was_told = true;
  const SkillRun run = RunSkill(&skill, {kWest, {}, false}, [&](auto* seen, auto* robot) {
    const bool is_lost = seen->time > 2.0 && seen->time < 8.0;
    seen->position_sd = is_lost ? kUnsure : 0.02;
    if (seen->time > 2.2 && is_lost) was_moving = was_moving || robot->V_B.vx != 0.0;
    if (is_lost && seen->time > 2.2) was_told = was_told && skill.phase() == "lost";
    if (std::abs(seen->time - 7.9) < 1e-6) robot->X_MB.y += 0.6;  // it is found elsewhere
  });
  EXPECT_EQ(run.status.progress, Progress::kSucceeded) << ToString(run.status.failure);
  EXPECT_FALSE(was_moving);
  EXPECT_TRUE(was_told);
  EXPECT_GT(run.duration, 8.0);
  EXPECT_EQ(skill.phase(), "");
}

TEST(LostTest, ARobotThatIsNotFoundFailsSo) {
  MoveBaseParams params;
  params.lost.patience = 5.0;
  MoveBase skill(Context(params), kEast, kFast);
  const SkillRun run = RunSkill(&skill, {kWest, {}, false}, [&](auto* seen, auto*) {
    if (seen->time > 2.0) seen->position_sd = kUnsure;
  });
  EXPECT_EQ(run.status.failure.code, FailureCode::kLocalisationLost);
  EXPECT_NEAR(run.duration, 7.0, 0.3);
  EXPECT_EQ(run.last_command.vx, 0.0);
}

TEST(LostTest, ItLooksAroundOnlyWhereTheLaserShowsRoom) {
  const LostParams params;
  for (const double range : {2.0, 0.45}) {
    MoveBase skill(WithObstacleLayer(), kEast, kFast);
    robot::Command command;
    skill.Update(Seen(0.0, kUnsure, range), &command);
    ASSERT_TRUE(command.base_velocity);
    EXPECT_EQ(command.base_velocity->vx, 0.0);
    EXPECT_EQ(command.base_velocity->wz, range > 1.0 ? params.turning : 0.0) << range;
  }
  MoveBase by_the_map(Context(), kEast, kFast);
  robot::Command command;
  by_the_map.Update(Seen(0.0, kUnsure, 2.0), &command);
  ASSERT_TRUE(command.base_velocity);
  EXPECT_EQ(command.base_velocity->wz, 0.0) << "it does not know what is round it";
}

TEST(LostTest, WhoSeesNothingDoesNotTurn) {
  constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinite = std::numeric_limits<float>::infinity();
  const auto turns = [](const robot::Observation& seen) {
    MoveBase skill(WithObstacleLayer(), kEast, kFast);
    robot::Command command;
    skill.Update(seen, &command);
    return command.base_velocity.value().wz != 0.0;
  };
  EXPECT_TRUE(turns(Seen(0.0, kUnsure, kInfinite))) << "nothing is within its range";
  for (const float range : {kNoNumber, 0.0f, 0.02f})
    EXPECT_FALSE(turns(Seen(0.0, kUnsure, range))) << "covered: " << range;
  robot::Observation without = Seen(0.0, kUnsure, 2.0);
  without.scan = nullptr;
  EXPECT_FALSE(turns(without)) << "no scans";
  robot::Observation late = Seen(0.0, kUnsure, 2.0);
  late.scan_age = 1.5;
  EXPECT_FALSE(turns(late)) << "scans ended";
}

TEST(LostTest, WhatIsBehindALaserThatSees260DegreesCountsAsRoom) {
  robot::Observation seen = Seen(0.0, kUnsure, 2.0);
  auto scan = std::make_shared<robot::PlacedScan>(*seen.scan);
  for (std::size_t i = 0; i < scan->reading.ranges.size(); ++i) {
    const double angle = scan->reading.angle_min + i * scan->reading.angle_increment;
    if (std::abs(angle) > 2.27) scan->reading.ranges[i] = std::numeric_limits<float>::quiet_NaN();
  }
  seen.scan = scan;
  MoveBase skill(WithObstacleLayer(), kEast, kFast);
  robot::Command command;
  skill.Update(seen, &command);
  EXPECT_EQ(command.base_velocity.value().wz, LostParams().turning);
}

TEST(LostTest, SomethingOnTheFloorBesideItKeepsItFromTurning) {
  MoveBase skill(WithObstacleLayer(), kEast, kFast);
  robot::Observation seen = Seen(0.0, kUnsure, 2.0);
  seen.obstacles_M = {
      geometry::Transformed(kMiddle, {{0.45, 0.0}, {0.55, 0.0}, {0.55, 0.1}, {0.45, 0.1}})};
  robot::Command command;
  skill.Update(seen, &command);
  EXPECT_EQ(command.base_velocity.value().wz, 0.0);
}

TEST(LostTest, ABlindDriveStandsWhileItIsLost) {
  MoveBaseBlindParams params;
  params.lost.patience = 20.0;
  MoveBaseBlind skill(params, kEast, kFast, TrayRobot().profile.base_controller);
  bool was_moving = false;
  const SkillRun run = RunSkill(&skill, {kWest, {}, false}, [&](auto* seen, auto* robot) {
    const bool is_lost = seen->time > 2.0 && seen->time < 12.0;  // longer than stuck_timeout
    if (is_lost) seen->position_sd = kUnsure;
    if (is_lost && seen->time > 2.2) was_moving = was_moving || robot->V_B.vx != 0.0;
  });
  EXPECT_EQ(run.status.progress, Progress::kSucceeded) << ToString(run.status.failure);
  EXPECT_FALSE(was_moving);
  params.lost.patience = 5.0;
  MoveBaseBlind impatient(params, kEast, kFast, TrayRobot().profile.base_controller);
  const SkillRun lost = RunSkill(&impatient, {kWest, {}, false},
                                 [](auto* seen, auto*) { seen->position_sd = kUnsure; });
  EXPECT_EQ(lost.status.failure.code, FailureCode::kLocalisationLost);
}

}  // namespace
}  // namespace hires::skills::lost_test
