#include "hires/manipulation/arm_kinematics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <future>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "restaurant_scene.h"

namespace hires::manipulation::arm_kinematics_test {
namespace {

using geometry::Pose3;
using ::testing::AllOf;
using ::testing::DoubleNear;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::Pointwise;
using ::testing::SizeIs;

const robot::Robot& Pr2() { return *test_support::Pr2(); }

ArmJoints RandomJoints(const ArmKinematics& arm, base::Rng* rng) {
  ArmJoints joints;
  for (std::size_t i = 0; i < arm.lower().size(); ++i) {
    const bool is_limited = std::isfinite(arm.lower()[i]);
    joints.push_back(is_limited ? rng->Uniform(arm.lower()[i], arm.upper()[i])
                                : rng->Uniform(-geometry::kPi, geometry::kPi));
  }
  return joints;
}

void ExpectSamePose(const Pose3& a, const Pose3& b, double position, double angle) {
  EXPECT_LE((a.translation - b.translation).norm(), position);
  EXPECT_LE(a.rotation.angularDistance(b.rotation), angle);
}

void ExpectWithinLimits(const ArmKinematics& arm, const ArmJoints& joints) {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    EXPECT_GE(joints[i], arm.lower()[i]);
    EXPECT_LE(joints[i], arm.upper()[i]);
  }
}

/// The robot model's own forward kinematics: the other road.
Pose3 ToolPoseOfModel(const std::string& arm, const robot::JointPositions& posture) {
  const auto X_R = robot::ForwardKinematics(Pr2().model, posture);
  const std::string& tool = Pr2().profile.upper_body->arms.at(arm).tool_link;
  return X_R[*Pr2().model.FindLink(Pr2().profile.base_link)].Inverse() *
         X_R[*Pr2().model.FindLink(tool)];
}

class ArmKinematicsTest : public ::testing::TestWithParam<std::string> {
 protected:
  ArmKinematics arm_{Pr2(), GetParam()};
  robot::JointPositions posture_ = Pr2().profile.joints;
};

TEST_P(ArmKinematicsTest, ToolPoseAgreesWithTheRobotModel) {
  base::Rng rng(1);
  for (int i = 0; i < 100; ++i) {
    posture_["torso_lift_joint"] = rng.Uniform(0.0, 0.33);
    const ArmJoints joints = RandomJoints(arm_, &rng);
    const Pose3 X_BT = arm_.ToolPose(posture_, joints);
    arm_.SetJoints(joints, &posture_);
    ExpectSamePose(X_BT, ToolPoseOfModel(GetParam(), posture_), 1e-12, 1e-7);
  }
}

TEST_P(ArmKinematicsTest, SolvesForThePoseOfEveryRandomPosture) {
  const InverseParams params;
  base::Rng rng(2);
  for (int i = 0; i < 1000; ++i) {
    const Pose3 X_BT = arm_.ToolPose(posture_, RandomJoints(arm_, &rng));
    const auto solutions = arm_.Solve(posture_, X_BT, arm_.JointsOf(posture_), i);
    ASSERT_THAT(solutions, Not(IsEmpty())) << "posture " << i;
    for (const ArmJoints& solution : solutions) {
      ExpectWithinLimits(arm_, solution);
      ExpectSamePose(arm_.ToolPose(posture_, solution), X_BT, params.position_tolerance + 1e-9,
                     params.angle_tolerance + 1e-7);
    }
  }
}

TEST_P(ArmKinematicsTest, FindsSeveralSolutionsNearestFirst) {
  const ArmJoints near = arm_.JointsOf(posture_);
  base::Rng rng(3);
  const Pose3 X_BT = arm_.ToolPose(posture_, RandomJoints(arm_, &rng));
  const auto solutions = arm_.Solve(posture_, X_BT, near, 0);
  ASSERT_THAT(solutions, SizeIs(testing::Ge(3)));
  const auto distance = [&](const ArmJoints& q) {
    double largest = 0.0;
    for (std::size_t k = 0; k < q.size(); ++k)
      largest = std::max(largest, std::abs(q[k] - near[k]));
    return largest;
  };
  for (std::size_t i = 1; i < solutions.size(); ++i) {
    EXPECT_LE(distance(solutions[i - 1]), distance(solutions[i]));
  }
}

TEST_P(ArmKinematicsTest, APostureThatSolvesAlreadyComesBackFirst) {
  base::Rng rng(4);
  for (int i = 0; i < 20; ++i) {
    const ArmJoints joints = RandomJoints(arm_, &rng);
    const auto solutions = arm_.Solve(posture_, arm_.ToolPose(posture_, joints), joints, i);
    ASSERT_THAT(solutions, Not(IsEmpty()));
    EXPECT_THAT(solutions.front(), Pointwise(DoubleNear(1e-9), joints));
  }
}

TEST_P(ArmKinematicsTest, ContinuousJointsStayWithinHalfATurnOfTheGivenOnes) {
  base::Rng rng(5);
  ArmJoints near = arm_.JointsOf(posture_);
  near[4] += 6.0 * geometry::kPi;
  near[6] -= 5.0 * geometry::kPi;
  const Pose3 X_BT = arm_.ToolPose(posture_, RandomJoints(arm_, &rng));
  for (const ArmJoints& solution : arm_.Solve(posture_, X_BT, near, 0)) {
    EXPECT_LE(std::abs(solution[4] - near[4]), geometry::kPi + 1e-12);
    EXPECT_LE(std::abs(solution[6] - near[6]), geometry::kPi + 1e-12);
  }
}

TEST_P(ArmKinematicsTest, SameSeedGivesTheSameBitsAndAnotherSeedOtherSolutions) {
  base::Rng rng(6);
  const Pose3 X_BT = arm_.ToolPose(posture_, RandomJoints(arm_, &rng));
  const ArmJoints near = arm_.JointsOf(posture_);
  EXPECT_EQ(arm_.Solve(posture_, X_BT, near, 9), arm_.Solve(posture_, X_BT, near, 9));
  EXPECT_NE(arm_.Solve(posture_, X_BT, near, 9), arm_.Solve(posture_, X_BT, near, 10));
}

/// Pose and solution of random postures; each sequence of its own for another `seed`.
std::vector<ArmJoints> AnswersOf(const ArmKinematics& arm, std::uint64_t seed) {
  base::Rng rng(seed);
  std::vector<ArmJoints> answers;
  for (int i = 0; i < 50; ++i) {
    const robot::JointPositions& posture = Pr2().profile.joints;
    const Pose3 X_BT = arm.ToolPose(posture, RandomJoints(arm, &rng));
    for (auto& solution : arm.Solve(posture, X_BT, RandomJoints(arm, &rng), seed, {})) {
      answers.push_back(std::move(solution));
    }
  }
  return answers;
}

TEST_P(ArmKinematicsTest, ThreadsThatShareItDoNotDisturbEachOther) {
  std::vector<std::future<std::vector<ArmJoints>>> shared;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    shared.push_back(
        std::async(std::launch::async, [this, seed] { return AnswersOf(arm_, seed); }));
  }
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const ArmKinematics own(Pr2(), GetParam());
    EXPECT_EQ(shared[seed].get(), AnswersOf(own, seed));
  }
}

TEST_P(ArmKinematicsTest, BeyondItsReachThereIsNoSolution) {
  Pose3 X_BT;
  X_BT.translation = {1.5, 0.0, 1.0};
  EXPECT_THAT(arm_.Solve(posture_, X_BT, arm_.JointsOf(posture_), 0), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Arms, ArmKinematicsTest, testing::Values("leftarm1", "rightarm1"));

std::string ErrorOf(const robot::Robot& robot, const std::string& arm) {
  try {
    ArmKinematics kinematics(robot, arm);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(ArmKinematicsErrorsTest, AnUnknownArmIsNamedWithThoseThatExist) {
  EXPECT_THAT(ErrorOf(Pr2(), "rightarm"), AllOf(HasSubstr("'rightarm'"), HasSubstr("rightarm1")));
}

TEST(ArmKinematicsErrorsTest, ARobotWithoutUpperBodyHasNoArms) {
  robot::Robot robot = Pr2();
  robot.profile.upper_body.reset();
  EXPECT_THAT(ErrorOf(robot, "rightarm1"), HasSubstr("no upper_body"));
}

TEST(ArmKinematicsErrorsTest, AMissingJointIsShownBesideTheWholeList) {
  robot::Robot robot = Pr2();
  auto& joints = robot.profile.upper_body->arms.at("rightarm1").joints;
  joints.erase(joints.begin() + 3);
  EXPECT_THAT(ErrorOf(robot, "rightarm1"), HasSubstr("r_elbow_flex_joint"));
}

TEST(ArmKinematicsErrorsTest, AToolOfTheOtherArmIsNoChain) {
  robot::Robot robot = Pr2();
  robot.profile.upper_body->arms.at("rightarm1").tool_link = "l_gripper_tool_frame";
  EXPECT_THAT(ErrorOf(robot, "rightarm1"),
              AllOf(HasSubstr("l_gripper_tool_frame"), HasSubstr("r_shoulder_pan_joint")));
}

TEST(ArmKinematicsErrorsTest, AnUnknownJointInThePostureIsNamed) {
  const ArmKinematics arm(Pr2(), "rightarm1");
  EXPECT_THROW(arm.ToolPose({{"r_shoulder_pam_joint", 0.0}}, ArmJoints(7, 0.0)), base::ConfigError);
  EXPECT_THROW(arm.ToolPose({}, ArmJoints(6, 0.0)), std::logic_error);
}

}  // namespace
}  // namespace hires::manipulation::arm_kinematics_test
