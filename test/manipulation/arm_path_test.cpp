#include "hires/manipulation/arm_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>

#include "hires/base/hash.h"
#include "hires/base/rng.h"
#include "restaurant_scene.h"

namespace hires::manipulation::arm_path_test {
namespace {

using namespace test_support;
using geometry::Pose3;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

double LargestDifference(const ArmJoints& a, const ArmJoints& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// The right arm at the counter, with a mug and a mill on it.
class ArmPathTest : public ::testing::Test {
 protected:
  ArmPathTest() {
    scene_.SetObjects({Standing("mug1", "coffee_cup", 5.37, 10.26, 0.75),
                       Standing("peppermill1", "peppermill_thesis", 5.47, 10.16, 0.75)},
                      X_MB_, posture_);
  }

  ArmScene In() const { return {&arm_, &scene_, X_MB_, posture_, std::nullopt}; }
  Pose3 ToolAt(double x_M, double y_M, double z_M, double yaw_B) const {
    Pose3 X_MT;
    X_MT.translation = {x_M, y_M, z_M};
    Pose3 X_BT = geometry::Lift(X_MB_).Inverse() * X_MT;
    X_BT.rotation = geometry::RotationFromRpy(0.0, 0.0, yaw_B);
    return X_BT;
  }
  std::vector<ArmJoints> Goals(const Pose3& X_BT) const {
    return arm_.Solve(posture_, X_BT, arm_.JointsOf(posture_), 5);
  }
  bool IsFree(const ArmJoints& joints) const {
    robot::JointPositions posture = posture_;
    arm_.SetJoints(joints, &posture);
    return !scene_.FindTouch(X_MB_, posture, scene_.MovedBy(arm_.joint_names()));
  }
  void ExpectFree(const std::vector<ArmJoints>& path, double resolution) const {
    for (std::size_t i = 1; i < path.size(); ++i) {
      const int steps =
          static_cast<int>(std::ceil(LargestDifference(path[i - 1], path[i]) / (0.5 * resolution)));
      for (int k = 0; k <= steps; ++k) {
        ArmJoints joints = path[i - 1];
        for (std::size_t j = 0; j < joints.size(); ++j) {
          joints[j] += (path[i][j] - joints[j]) * k / std::max(1, steps);
        }
        EXPECT_TRUE(IsFree(joints)) << "between point " << i - 1 << " and the next, step " << k;
      }
    }
  }

  ArmKinematics arm_{*Pr2(), "rightarm1"};
  CollisionScene scene_ = RestaurantScene();
  geometry::Pose2 X_MB_ = Area("manipulationAreaEastCounter1");
  robot::JointPositions posture_ = Posture("armtosideposture", 0.295);
};

/// Goals before and behind the mill, most of them with no straight way.
std::vector<Pose3> Targets(const std::function<Pose3(double, double, double, double)>& tool_at) {
  return {tool_at(5.25, 10.00, 0.95, -0.6), tool_at(5.45, 9.85, 0.95, 0.0),
          tool_at(5.35, 10.45, 0.95, 0.6), tool_at(5.55, 10.15, 0.95, -0.6)};
}

TEST_F(ArmPathTest, EveryStretchIsFreeAtHalfTheResolution) {
  const ArmPathParams params;
  int bent = 0;
  const auto targets = Targets([this](auto... at) { return ToolAt(at...); });
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const ArmJoints start = arm_.JointsOf(posture_);
    const auto goals = Goals(targets[i]);
    const ArmPathResult result = PlanArmPath(In(), goals, i, params);
    ASSERT_EQ(result.status, ArmPathStatus::kFound) << i << " " << result.obstruction.words;
    EXPECT_EQ(result.path.front(), start);
    EXPECT_THAT(goals, testing::Contains(result.path.back()));
    EXPECT_FALSE(result.obstruction);
    ExpectFree(result.path, params.resolution);
    if (result.path.size() > 2) ++bent;
  }
  EXPECT_GT(bent, 0) << "no target needs the planner: the test shows nothing";
}

/// A goal behind the mill that only the planner reaches.
ArmPathResult PlanTheHardOne(const ArmScene& in, const std::vector<ArmJoints>& goals,
                             std::uint64_t seed) {
  for (const ArmJoints& goal : goals) {
    ArmPathResult result = PlanArmPath(in, {goal}, seed);
    if (result.status == ArmPathStatus::kFound && result.path.size() > 2) return result;
  }
  return {};
}

TEST_F(ArmPathTest, TheSameSeedGivesTheSameBitsWhateverWasPlannedBefore) {
  const auto goals = Goals(ToolAt(5.25, 10.00, 0.95, -0.6));
  const ArmPathResult first = PlanTheHardOne(In(), goals, 3);
  ASSERT_THAT(first.path, Not(IsEmpty()));
  for (std::uint64_t seed = 10; seed < 13; ++seed) PlanTheHardOne(In(), goals, seed);
  PlanArmPath(In(), Goals(ToolAt(5.45, 9.85, 0.95, 0.0)), 1);
  EXPECT_EQ(PlanTheHardOne(In(), goals, 3).path, first.path);
}

TEST_F(ArmPathTest, AnotherSeedGivesAnotherPath) {
  const auto goals = Goals(ToolAt(5.25, 10.00, 0.95, -0.6));
  EXPECT_NE(PlanTheHardOne(In(), goals, 3).path, PlanTheHardOne(In(), goals, 4).path);
}

std::uint64_t HashOf(const std::vector<ArmJoints>& path) {
  base::Hasher hasher;
  for (const ArmJoints& joints : path) {
    for (const double joint : joints) hasher.Add(joint);
  }
  return hasher.value();
}

/// What `work` returns in a process of its own.
template <typename Work>
std::uint64_t InAnotherProcess(Work work) {
  int pipe_ends[2];
  if (pipe(pipe_ends) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child == 0) {
    const std::uint64_t value = work();
    const bool is_written = write(pipe_ends[1], &value, sizeof value) == sizeof value;
    _exit(is_written ? 0 : 1);
  }
  close(pipe_ends[1]);
  std::uint64_t value = 0;
  const bool is_read = read(pipe_ends[0], &value, sizeof value) == sizeof value;
  close(pipe_ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!is_read || status != 0) throw std::runtime_error("the other process failed");
  return value;
}

TEST_F(ArmPathTest, ProcessesThatPlanInAnotherOrderFindTheSamePaths) {
  const auto goals = Goals(ToolAt(5.25, 10.00, 0.95, -0.6));
  const auto hash_of_seed = [&](std::uint64_t seed) {
    return HashOf(PlanTheHardOne(In(), goals, seed).path);
  };
  const std::uint64_t forth = InAnotherProcess([&] {
    hash_of_seed(1);
    hash_of_seed(2);
    return hash_of_seed(3);
  });
  const std::uint64_t alone = InAnotherProcess([&] { return hash_of_seed(3); });
  EXPECT_EQ(forth, alone);
  EXPECT_EQ(hash_of_seed(3), alone);
}

TEST_F(ArmPathTest, WithoutGoalsItIsUnreachable) {
  EXPECT_EQ(PlanArmPath(In(), {}, 1).status, ArmPathStatus::kUnreachable);
  ArmJoints beyond = arm_.JointsOf(posture_);
  beyond[3] = 0.5;  // the elbow does not bend that way
  EXPECT_EQ(PlanArmPath(In(), {beyond}, 1).status, ArmPathStatus::kUnreachable);
}

TEST_F(ArmPathTest, AGoalInsideTheCounterNamesWhatIsInTheWay) {
  const auto goals = Goals(ToolAt(5.35, 10.25, 0.72, 0.6));
  ASSERT_THAT(goals, Not(IsEmpty()));
  const ArmPathResult result = PlanArmPath(In(), goals, 1);
  EXPECT_EQ(result.status, ArmPathStatus::kGoalBlocked);
  EXPECT_THAT(result.obstruction.words, HasSubstr("touches counter1"));
  EXPECT_THAT(result.obstruction.parts, ::testing::Contains("counter1"));
}

TEST_F(ArmPathTest, ABlockedStartNamesWhatIsInTheWay) {
  arm_.SetJoints(Goals(ToolAt(5.35, 10.25, 0.72, 0.6)).front(), &posture_);
  const ArmPathResult result = PlanArmPath(In(), {arm_.JointsOf(posture_)}, 1);
  EXPECT_EQ(result.status, ArmPathStatus::kStartBlocked);
  EXPECT_THAT(result.obstruction.words, HasSubstr("touches counter1"));
}

TEST_F(ArmPathTest, WithoutIterationsThereIsNoPathAndTheObstacleIsNamed) {
  ArmPathParams params;
  params.max_iterations = 0;
  for (const ArmJoints& goal : Goals(ToolAt(5.25, 10.00, 0.95, -0.6))) {
    const ArmPathResult result = PlanArmPath(In(), {goal}, 1, params);
    if (result.status != ArmPathStatus::kNoPath) continue;
    EXPECT_THAT(result.obstruction.words, HasSubstr(" touches "));
    return;
  }
  FAIL() << "every goal has a free straight way";
}

TEST_F(ArmPathTest, AHeldObjectStaysUprightOnTheWay) {
  // Two postures with the hand level, and a way between them on which it has to stay so.
  const auto start = Goals(ToolAt(5.45, 10.30, 1.05, 0.6));
  const auto goals = Goals(ToolAt(5.45, 10.00, 1.05, 0.6));
  ASSERT_THAT(start, Not(IsEmpty()));
  const auto free = std::find_if(start.begin(), start.end(),
                                 [&](const ArmJoints& joints) { return IsFree(joints); });
  ASSERT_NE(free, start.end());
  arm_.SetJoints(*free, &posture_);
  ArmScene in = In();
  in.upright_T = Eigen::Vector3d::UnitZ();
  ArmPathParams params;
  params.max_held_tilt = 0.4;
  const ArmPathResult result = PlanArmPath(in, goals, 2, params);
  ASSERT_EQ(result.status, ArmPathStatus::kFound) << result.obstruction.words;
  for (const ArmJoints& joints : result.path) {
    const auto R_BT = arm_.ToolPose(posture_, joints).rotation;
    EXPECT_LE(std::acos((R_BT * Eigen::Vector3d::UnitZ()).z()), 0.4 + 1e-9);
  }
}

TEST_F(ArmPathTest, AStartThatTiltsIsBlockedByThat) {
  ArmScene in = In();
  in.upright_T = Eigen::Vector3d::UnitZ();  // "to side" does not hold it level
  const ArmPathResult result = PlanArmPath(in, {arm_.JointsOf(posture_)}, 1);
  EXPECT_EQ(result.status, ArmPathStatus::kStartBlocked);
  EXPECT_EQ(result.obstruction.words, "held object tilts");
  EXPECT_THAT(result.obstruction.parts, IsEmpty());
}

TEST_F(ArmPathTest, WhatDoesNotMoveIsNotBlamed) {
  // With the base in a leg of the table: nothing that the arm could change.
  X_MB_ = Area("manipulationAreaNorthTable1");
  X_MB_.y -= 0.05;
  EXPECT_TRUE(scene_.FindTouch(X_MB_, posture_));
  EXPECT_EQ(PlanArmPath(In(), {arm_.JointsOf(posture_)}, 1).status, ArmPathStatus::kFound);
}

TEST_F(ArmPathTest, AWrongNumberOfJointsIsTheCallersFault) {
  EXPECT_THROW(PlanArmPath(In(), {{0.0, 0.0}}, 1), std::logic_error);
  ArmPathParams params;
  params.resolution = 0.0;
  EXPECT_THROW(PlanArmPath(In(), {arm_.JointsOf(posture_)}, 1, params), std::logic_error);
  EXPECT_THROW(PlanStraight(In(), {}, 0.0), std::logic_error);
}

class StraightTest : public ArmPathTest {
 protected:
  StraightTest() { arm_.SetJoints(FreeGoal(), &posture_); }
  ArmJoints FreeGoal() const {
    for (const ArmJoints& goal : Goals(ToolAt(5.45, 10.35, 1.05, 0.6))) {
      if (IsFree(goal)) return goal;
    }
    throw std::runtime_error("no free goal");
  }
  Pose3 ToolNow() const { return arm_.ToolPose(posture_, arm_.JointsOf(posture_)); }
};

TEST_F(StraightTest, TheToolMovesOnALineAndTurnsEvenly) {
  const Pose3 X_BStart = ToolNow();
  Pose3 X_BT = X_BStart;
  X_BT.translation += Eigen::Vector3d(0.05, 0.02, 0.08);
  const ArmPathResult result = PlanStraight(In(), X_BT);
  ASSERT_EQ(result.status, ArmPathStatus::kFound) << result.obstruction.words;
  EXPECT_THAT(result.path, SizeIs(testing::Ge(10)));
  const Eigen::Vector3d way = (X_BT.translation - X_BStart.translation).normalized();
  for (const ArmJoints& joints : result.path) {
    const Pose3 X = arm_.ToolPose(posture_, joints);
    const Eigen::Vector3d off = X.translation - X_BStart.translation;
    EXPECT_LE((off - way * way.dot(off)).norm(), 2e-4);
    EXPECT_LE(X.rotation.angularDistance(X_BT.rotation), 2e-3);
  }
  EXPECT_LE((arm_.ToolPose(posture_, result.path.back()).translation - X_BT.translation).norm(),
            1.1e-4);
  ExpectFree(result.path, 0.05);
}

TEST_F(StraightTest, AWayBeyondTheReachIsUnreachable) {
  Pose3 X_BT = ToolNow();
  X_BT.translation.x() += 1.0;
  EXPECT_EQ(PlanStraight(In(), X_BT).status, ArmPathStatus::kUnreachable);
}

TEST_F(StraightTest, AnEndInsideTheCounterIsNamed) {
  for (const ArmJoints& start : Goals(ToolAt(5.45, 10.45, 0.95, 0.6))) {
    arm_.SetJoints(start, &posture_);
    const ArmPathResult result = PlanStraight(In(), ToolAt(5.45, 10.45, 0.77, 0.6));
    if (result.status != ArmPathStatus::kGoalBlocked) continue;
    EXPECT_THAT(result.obstruction.words, HasSubstr("touches counter1"));
    EXPECT_THAT(result.path, IsEmpty());
    return;
  }
  FAIL() << "no start from which the counter's top can be reached";
}

TEST_F(StraightTest, StandingStillIsAWay) {
  const ArmPathResult result = PlanStraight(In(), ToolNow());
  EXPECT_EQ(result.status, ArmPathStatus::kFound);
}

}  // namespace
}  // namespace hires::manipulation::arm_path_test
