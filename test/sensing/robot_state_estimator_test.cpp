#include "hires/sensing/robot_state_estimator.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "support/fake_frame_tree.h"
#include "support/scenes.h"

namespace hires::sensing::robot_state_estimator_test {
namespace {

using geometry::Lift;
using geometry::Pose2;
using test_support::FakeFrameTree;
using test_support::TrayRobot;
using testing::HasSubstr;
using testing::SizeIs;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

void ExpectNear(const Pose2& a, const Pose2& b) {
  EXPECT_NEAR(a.x, b.x, 1e-12);
  EXPECT_NEAR(a.y, b.y, 1e-12);
  EXPECT_NEAR(a.yaw, b.yaw, 1e-12);
}

std::shared_ptr<const robot::Robot> Pr2() {
  static const auto pr2 = std::make_shared<const robot::Robot>(
      robot::LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml"));
  return pr2;
}

/// A robot whose odometry counts in `odom_combined`, with a joint `a` that its model does not have.
class EstimatorTest : public testing::Test {
 protected:
  explicit EstimatorTest(
      std::shared_ptr<const robot::Robot> robot = std::make_shared<const robot::Robot>(TrayRobot()))
      : robot_(std::move(robot)) {}

  Receipt Odometry(double stamp, const Pose2& X_OB = {}) {
    return state_.OnOdometry(stamp, frame_, "", {X_OB, {0.1, 0.2, 0.3}});
  }
  Receipt Joints(double stamp, double position = 1.0) {
    return state_.OnJoints(stamp, {{{"a", position}}, {{"a", 0.5}}});
  }
  Receipt Localise(double stamp, const Pose2& X_MO = {}) {
    tree_->Tell("map", "odom_combined", stamp, Lift(X_MO));
    return state_.OnTransforms(stamp);
  }
  void BaseByTree(double stamp, const Pose2& X_OB) {
    tree_->Tell("odom_combined", "base", stamp, Lift(X_OB));
    state_.OnTransforms(stamp);
  }
  void All(double stamp, const Pose2& X_OB = {}) {
    Odometry(stamp, X_OB);
    Localise(stamp);
    Joints(stamp);
  }

  std::shared_ptr<const robot::Robot> robot_;
  std::shared_ptr<FakeFrameTree> tree_ = std::make_shared<FakeFrameTree>();
  RobotStateEstimator state_{robot_, {"map", "odom_combined", "base"}, {}, {}, tree_};
  std::string frame_{"odom_combined"};
};

// ---- What is missing.

TEST_F(EstimatorTest, NothingIsKnownUntilBaseJointsAndPlaceAre) {
  EXPECT_FALSE(state_.CompleteUntil());
  EXPECT_EQ(state_.MissingNow(), Missing::kOdometry);
  EXPECT_TRUE(Odometry(1.0).is_taken());
  EXPECT_EQ(state_.MissingNow(), Missing::kJointStates);
  EXPECT_TRUE(Joints(1.0).is_taken());
  EXPECT_EQ(state_.MissingNow(), Missing::kLocalisation);
  EXPECT_TRUE(Localise(1.0).is_taken());
  EXPECT_EQ(state_.MissingNow(), Missing::kNothing);
  EXPECT_EQ(state_.CompleteUntil(), 1.0);
}

TEST_F(EstimatorTest, TheSlowestSensorSaysHowFarItIsComplete) {
  Localise(1.0);
  Odometry(1.0);
  Odometry(1.2);
  Joints(1.1);
  EXPECT_EQ(state_.CompleteUntil(), 1.1);
  EXPECT_FALSE(state_.At(1.15));
}

TEST_F(EstimatorTest, AnOldCorrectionCountsNoMore) {
  All(1.0);
  Odometry(1.3);
  Joints(1.3);
  EXPECT_TRUE(state_.CompleteUntil());
  Odometry(1.31);
  Joints(1.31);
  EXPECT_EQ(state_.MissingNow(), Missing::kLocalisation);
}

TEST_F(EstimatorTest, ACorrectionThatIsDatedAheadIsNoFresherForThat) {
  Odometry(1.0);
  Joints(1.0);
  Localise(3.0);  // came at 1.0
  Odometry(1.3);
  Joints(1.3);
  EXPECT_TRUE(state_.CompleteUntil());
  Odometry(1.31);
  Joints(1.31);
  EXPECT_FALSE(state_.CompleteUntil());
}

/// As amcl's on a PR2: each one is dated half a second ahead.
TEST_F(EstimatorTest, CorrectionsThatAreAllDatedAheadKeepTheStateKnown) {
  for (int i = 0; i <= 40; ++i) {
    const double stamp = 10.0 + 0.05 * i;
    Odometry(stamp);
    Joints(stamp);
    Localise(stamp + 0.5, {0.01 * i, 0.0, 0.0});
    EXPECT_EQ(state_.CompleteUntil(), stamp);
  }
  EXPECT_NEAR(state_.At(12.0)->X_WB.x, 0.01 * 30, 1e-9) << "the correction that is valid now";
}

TEST_F(EstimatorTest, WhereMapAndOdometryNeverMoveNoCorrectionGrowsOld) {
  tree_->TellFixed("map", "odom_combined", Lift({1.0, 0.0, 0.0}));
  EXPECT_TRUE(state_.OnTransforms(std::numeric_limits<double>::infinity()).is_taken());
  for (const double stamp : {10.0, 50.0}) {
    Odometry(stamp, {0.5, 0.0, 0.0});
    Joints(stamp);
    ASSERT_TRUE(state_.At(stamp));
    EXPECT_EQ(state_.At(stamp)->X_WB.x, 1.5);
    EXPECT_TRUE(state_.IsSettled(stamp));
  }
}

TEST_F(EstimatorTest, AMomentIsSettledOnceNoCorrectionCanComeAnyMore) {
  All(10.0);
  EXPECT_TRUE(state_.IsSettled(10.0));
  Odometry(10.1);
  Joints(10.1);
  EXPECT_FALSE(state_.IsSettled(10.1)) << "a correction may still come";
  Odometry(10.25);
  EXPECT_TRUE(state_.IsSettled(10.1));
  Odometry(10.3);
  EXPECT_FALSE(state_.IsSettled(10.3)) << "joint states of that time lack";
}

// ---- The state of a time.

TEST_F(EstimatorTest, ThePlaceIsOdometryCorrected) {
  Localise(1.0, {2.0, 1.0, M_PI / 2});
  Odometry(1.0, {0.5, 0.0, 0.0});
  Joints(1.0);
  Odometry(1.01, {9.0, 9.0, 0.0});  // later than asked for
  const auto at = state_.At(1.0);
  ASSERT_TRUE(at);
  ExpectNear(at->X_WB, {2.0, 1.5, M_PI / 2});
  EXPECT_EQ(at->V_B.vy, 0.2);
  EXPECT_EQ(at->joints.at("a"), 1.0);
  EXPECT_EQ(at->joint_velocities.at("a"), 0.5);
}

TEST_F(EstimatorTest, BetweenReadingsAllIsInterpolated) {
  Localise(1.0, {0.0, 0.0, 0.0});
  Localise(1.2, {0.4, 0.0, 0.0});
  Odometry(1.0, {1.0, 0.0, geometry::kPi - 0.1});
  Odometry(1.2, {3.0, 1.0, -geometry::kPi + 0.1});  // turned through pi
  Joints(1.0, 1.0);
  Joints(1.2, 2.0);
  const auto at = state_.At(1.05);
  ASSERT_TRUE(at);
  ExpectNear(at->X_OB, {1.5, 0.25, geometry::kPi - 0.05});
  EXPECT_NEAR(at->X_WB.x, 1.6, 1e-12);
  EXPECT_NEAR(at->joints.at("a"), 1.25, 1e-12);
}

TEST_F(EstimatorTest, AtAStampTheReadingItselfCountsToTheLastBit) {
  Localise(1.0);
  Odometry(1.0, {1.0 / 3.0, 0.1, 0.7});
  Joints(1.0, 0.1);
  Odometry(1.1, {1.0, 0.1, 0.7});
  Joints(1.1, 0.3);
  EXPECT_EQ(state_.At(1.0)->X_WB.x, 1.0 / 3.0);
  EXPECT_EQ(state_.At(1.0)->joints.at("a"), 0.1);
}

TEST_F(EstimatorTest, SeveralDriversMayTellOfJoints) {
  All(1.0);
  EXPECT_TRUE(state_.OnJoints(1.0, {{{"b", 2.0}}, {}}).is_taken());
  Odometry(1.1);
  Joints(1.1, 3.0);  // of `a` alone
  Localise(1.1);
  EXPECT_THAT(state_.At(1.0)->joints, SizeIs(2));
  EXPECT_EQ(state_.At(1.1)->joints.at("b"), 2.0);
  EXPECT_EQ(state_.At(1.1)->joints.at("a"), 3.0);
}

TEST_F(EstimatorTest, ALabourDividedAmongJointsIsRememberedForLong) {
  All(1.0);
  state_.OnJoints(1.0, {{{"b", 2.0}}, {}});
  for (double stamp = 1.1; stamp < 9.0; stamp += 0.1) All(stamp);
  EXPECT_EQ(state_.At(*state_.CompleteUntil())->joints.at("b"), 2.0);
}

TEST_F(EstimatorTest, APostureIsKnownNearJointStates) {
  All(10.0);
  Joints(10.2);
  EXPECT_TRUE(state_.IsPostureKnown(10.04));
  EXPECT_FALSE(state_.IsPostureKnown(10.1));
  EXPECT_TRUE(state_.IsPostureKnown(10.16));
}

TEST_F(EstimatorTest, TheWorldIsWhereTheMapLiesInIt) {
  geometry::MapToWorld map_to_world;
  map_to_world.X_WM = {10.0, 0.0, M_PI / 2};
  RobotStateEstimator state(robot_, {"map", "odom_combined", "base"}, {}, map_to_world, tree_);
  tree_->Tell("map", "odom_combined", 1.0, {});
  state.OnTransforms(1.0);
  state.OnOdometry(1.0, "odom_combined", "", {{2.0, 0.0, 0.0}, {}});
  state.OnJoints(1.0, {{{"a", 0.0}}, {}});
  ExpectNear(state.At(1.0)->X_WB, {10.0, 2.0, M_PI / 2});
  ExpectNear(state.At(1.0)->X_MB, {2.0, 0.0, 0.0});
}

// ---- The same messages in any order.

/// Shuffles what is at most three readings (0.15 s) apart: the order within a topic, too.
class InterleavedTest : public EstimatorTest {
 protected:
  void Play(base::Rng* rng) {
    std::vector<std::function<void()>> messages;
    for (int i = 0; i <= 40; ++i) {
      const double stamp = 10.0 + 0.05 * i;
      messages.push_back([=] { Odometry(stamp, {0.01 * i, std::sin(0.1 * i), 0.02 * i}); });
      messages.push_back([=] { Localise(stamp + 0.01, {0.001 * i * i, 0.0, 0.001 * i}); });
      messages.push_back([=] { Joints(stamp + 0.02, std::cos(0.1 * i)); });
      messages.push_back([=] { state_.OnJoints(stamp + 0.03, {{{"b", 0.1 * i}}, {}}); });
      if (i % 7 == 0) messages.push_back(messages.back());  // some come twice
    }
    for (std::size_t first = 0; first < messages.size(); first += 12) {
      const std::size_t last = std::min(first + 12, messages.size());
      for (std::size_t k = last; k > first + 1; --k) {
        std::swap(messages[k - 1], messages[first + rng->Index(static_cast<int>(k - first))]);
      }
    }
    for (const auto& message : messages) message();
  }
};

TEST_F(InterleavedTest, TheSameMessagesGiveTheSameStateInAnyOrder) {
  std::vector<RobotEstimate> wanted;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    *tree_ = {};
    state_ = RobotStateEstimator(robot_, {"map", "odom_combined", "base"}, {}, {}, tree_);
    base::Rng rng(seed);
    Play(&rng);
    for (int k = 0; k < 90; ++k) {
      const double time = 10.1 + 0.02 * k;
      const auto at = state_.At(time);
      ASSERT_TRUE(at) << "seed " << seed << ", time " << time;
      if (seed == 0) {
        wanted.push_back(*at);
        continue;
      }
      EXPECT_EQ(at->X_WB.x, wanted[k].X_WB.x) << "seed " << seed << ", time " << time;
      EXPECT_EQ(at->X_WB.yaw, wanted[k].X_WB.yaw) << "seed " << seed;
      EXPECT_EQ(at->joints, wanted[k].joints) << "seed " << seed;
      EXPECT_EQ(at->joint_velocities, wanted[k].joint_velocities) << "seed " << seed;
    }
  }
}

// ---- What is wrong with a message.

TEST_F(EstimatorTest, WhatIsNoNumberOrHasNoTimeIsRefusedByName) {
  EXPECT_EQ(Odometry(0.0).what, Reception::kNoStamp);
  EXPECT_EQ(Joints(kNan).what, Reception::kNoStamp);
  EXPECT_EQ(Odometry(1.0, {kNan, 0.0, 0.0}).what, Reception::kNotFinite);
  EXPECT_EQ(state_.OnOdometry(1.0, frame_, "", {{}, {kNan, 0.0, 0.0}}).subject, "twist");
  EXPECT_THAT(ToString(Joints(1.0, kNan)), HasSubstr("joint 'a'"));
  EXPECT_EQ(state_.MissingNow(), Missing::kOdometry);
  EXPECT_THAT(ToString(Odometry(0.0)), HasSubstr("header.stamp is 0"));
}

TEST_F(EstimatorTest, WhatComesTwiceOrLateIsEverydayLife) {
  All(10.0);
  EXPECT_EQ(Odometry(10.0, {5.0, 0.0, 0.0}).what, Reception::kRepeated);
  EXPECT_EQ(Joints(10.0, 9.0).what, Reception::kRepeated);
  EXPECT_EQ(Joints(6.9).what, Reception::kLate);
  EXPECT_FALSE(Joints(6.9).is_bad());
  EXPECT_TRUE(Odometry(9.9, {1.0, 0.0, 0.0}).is_taken()) << "late by a little: it fits in between";
  EXPECT_EQ(state_.At(10.0)->X_WB.x, 0.0);
  EXPECT_EQ(state_.At(10.0)->joints.at("a"), 1.0);
}

TEST_F(EstimatorTest, ALongHistoryHoldsWhatAComputerThatWasBusyLearnsTopicByTopic) {
  StateParams params;
  params.history = 10.0;
  RobotStateEstimator patient(robot_, {"map", "odom_combined", "base"}, params, {}, tree_);
  for (RobotStateEstimator* state : {&patient, &state_}) {
    for (double time = 1.0; time <= 9.0; time += 0.125) {
      tree_->Tell("map", "odom_combined", time, Lift(Pose2()));
      state->OnTransforms(time);
    }
    for (double time = 1.0; time <= 9.0; time += 0.125) {
      state->OnOdometry(time, frame_, "", {{time, 0.0, 0.0}, {}});
    }
    for (double time = 1.0; time <= 9.0; time += 0.125) {
      state->OnJoints(time, {{{"a", 10.0 * time}}, {}});
    }
  }
  ASSERT_TRUE(patient.At(2.0));
  EXPECT_EQ(patient.At(2.0)->X_WB.x, 2.0);
  EXPECT_EQ(patient.At(2.0)->joints.at("a"), 20.0);
  EXPECT_FALSE(state_.At(2.0)) << "it keeps 3 s";
  EXPECT_THAT(ToString(patient.OnJoints(30.0, {{{"a", 1.0}}, {}})), HasSubstr("10 s ahead"));
  EXPECT_THAT(ToString(Joints(30.0)), HasSubstr("3 s ahead"));
}

TEST_F(EstimatorTest, AStrayMessageOfAnotherClockHoldsUpNobody) {
  All(10.0);
  EXPECT_EQ(Joints(5000.0).what, Reception::kAhead);
  EXPECT_TRUE(Joints(5000.0).is_bad());
  EXPECT_EQ(Localise(5000.0).what, Reception::kAhead);
  All(10.05);
  EXPECT_EQ(state_.CompleteUntil(), 10.05);
}

TEST_F(EstimatorTest, AStrayMessageBeforeAnyOdometryHoldsUpNobody) {
  Joints(5000.0);
  All(10.0);
  All(10.05);
  EXPECT_EQ(state_.CompleteUntil(), 10.05);
}

TEST_F(EstimatorTest, AClockThatBeginsAgainIsFollowed) {
  All(500.0, {5.0, 0.0, 0.0});
  All(500.1, {5.0, 0.0, 0.0});
  All(0.05, {1.0, 0.0, 0.0});
  EXPECT_EQ(state_.num_restarts(), 1);
  EXPECT_EQ(state_.CompleteUntil(), 0.05);
  EXPECT_EQ(state_.At(0.05)->X_WB.x, 1.0);
  EXPECT_FALSE(state_.At(500.0));
}

TEST_F(EstimatorTest, AClockThatGoesBackByLittleIsFollowedOnceThatIsSure) {
  All(10.0, {5.0, 0.0, 0.0});
  All(8.0, {1.0, 0.0, 0.0});  // one that comes late
  EXPECT_EQ(state_.CompleteUntil(), 10.0);
  EXPECT_EQ(state_.num_restarts(), 0);
  for (double stamp = 8.05; stamp < 8.5; stamp += 0.05) All(stamp, {1.0, 0.0, 0.0});
  EXPECT_EQ(state_.num_restarts(), 1);
  EXPECT_NEAR(*state_.CompleteUntil(), 8.45, 0.051);
  EXPECT_EQ(state_.At(*state_.CompleteUntil())->X_WB.x, 1.0);
}

TEST_F(EstimatorTest, AClockThatJumpsAheadIsFollowed) {
  All(10.0);
  Joints(900.0);  // comes before the odometry of that time
  Odometry(900.0, {2.0, 0.0, 0.0});
  All(900.05, {2.0, 0.0, 0.0});
  EXPECT_EQ(state_.CompleteUntil(), 900.05);
}

/// As where a robot that stands still tells its place once, and its odometry is heard last.
TEST_F(EstimatorTest, WhatIsToldOnceWaitsForTheOdometryOfItsTime) {
  All(10.0);
  Joints(900.0, 7.0);
  Localise(900.0, {0.5, 0.0, 0.0});
  Odometry(900.0, {2.0, 0.0, 0.0});
  ASSERT_EQ(state_.CompleteUntil(), 900.0);
  EXPECT_EQ(state_.At(900.0)->X_MB.x, 2.5);
  EXPECT_EQ(state_.At(900.0)->joints.at("a"), 7.0);
}

TEST_F(EstimatorTest, WhatCameAfterAStrayMessageCountsAndNotTheStrayOne) {
  All(10.0);
  Joints(900.0, 7.0);
  Localise(900.0, {0.5, 0.0, 0.0});
  All(10.05);
  Odometry(900.0);
  EXPECT_EQ(state_.MissingNow(), Missing::kJointStates);
  Joints(900.0);
  EXPECT_EQ(state_.MissingNow(), Missing::kLocalisation);
}

TEST_F(EstimatorTest, AGapInTheOdometryIsNotBridged) {
  All(10.0);
  All(11.0, {7.0, 0.0, 0.0});
  EXPECT_EQ(state_.MissingAt(10.5), Missing::kOdometry);
  EXPECT_EQ(state_.MissingAt(11.0), Missing::kNothing);
}

// ---- Frames of the odometry.

TEST_F(EstimatorTest, ASlashBeforeAFrameMeansNothing) {
  frame_ = "/odom_combined";
  All(1.0, {1.0, 2.0, 0.3});
  EXPECT_EQ(state_.At(1.0)->X_WB.x, 1.0);
}

class OwnFrameTest : public EstimatorTest {
 protected:
  OwnFrameTest() { frame_ = "odom"; }
  Pose2 BaseAt(double stamp) {
    Localise(stamp);
    Joints(stamp);
    return state_.At(stamp)->X_OB;
  }
};

TEST_F(OwnFrameTest, WheelsInAFrameOfTheirOwnTellNoPlaceUntilTheTreeDoes) {
  const Receipt receipt = Odometry(1.0);
  EXPECT_EQ(receipt.what, Reception::kUnknownFrame);
  EXPECT_EQ(receipt.subject, "odom");
  Joints(1.0);
  Localise(1.0);
  EXPECT_EQ(state_.MissingNow(), Missing::kOdometryFrame);
  BaseByTree(1.0, {2.0, 0.0, M_PI / 2});
  EXPECT_TRUE(Odometry(1.01, {0.1, 0.0, 0.0}).is_taken());
  ExpectNear(BaseAt(1.01), {2.0, 0.1, M_PI / 2});  // the wheels say how it went on
}

TEST_F(OwnFrameTest, ALateTransformIsHeldAgainstTheReadingOfItsTime) {
  Odometry(1.00, {0.0, 0.0, 0.0});
  Odometry(1.01, {0.5, 0.0, 0.0});
  BaseByTree(1.0, {10.0, 0.0, 0.0});
  Odometry(1.02, {0.6, 0.0, 0.0});
  ExpectNear(BaseAt(1.02), {10.6, 0.0, 0.0});
}

TEST_F(OwnFrameTest, ATransformAheadOfTheWheelsIsHeldAgainstThemWhenTheyCome) {
  Odometry(1.00, {0.0, 0.0, 0.0});
  BaseByTree(1.05, {10.0, 0.0, 0.0});
  Odometry(1.05, {0.5, 0.0, 0.0});
  ExpectNear(BaseAt(1.05), {10.0, 0.0, 0.0});
  Odometry(1.06, {0.6, 0.0, 0.0});
  ExpectNear(BaseAt(1.06), {10.1, 0.0, 0.0});
}

TEST_F(OwnFrameTest, ATransformOfAnotherTimeTellsNothing) {
  BaseByTree(1.0, {10.0, 0.0, 0.0});
  Odometry(1.2);
  Joints(1.2);
  Localise(1.2);
  EXPECT_EQ(state_.MissingNow(), Missing::kOdometryFrame);
}

TEST_F(OwnFrameTest, OdometryByTopicAndByTreeAreOne) {
  for (int i = 0; i <= 20; ++i) {
    const double stamp = 10.0 + 0.05 * i;
    const Pose2 X_OB{0.1 * i, 0.02 * i, 0.03 * i};
    const Pose2 X_OR{3.0, -1.0, 0.4};  // where the wheels began to count
    Odometry(stamp, X_OR.Inverse() * X_OB);
    if (i % 3 == 0) BaseByTree(stamp, X_OB);
    if (i > 0) ExpectNear(BaseAt(stamp), X_OB);
  }
}

TEST_F(OwnFrameTest, AFrameThatTheTreeConnectsIsConverted) {
  frame_ = "start";
  tree_->TellFixed("odom_combined", "start", Lift({5.0, 0.0, M_PI / 2}));
  EXPECT_TRUE(Odometry(1.0, {1.0, 0.0, 0.0}).is_taken());
  ExpectNear(BaseAt(1.0), {5.0, 1.0, M_PI / 2});
}

TEST_F(EstimatorTest, OdometryOfAnotherPartOfTheRobotIsMovedToTheBase) {
  All(1.0);
  // The tray is 0.2 m ahead of the base, and swings sideways as it turns.
  const Receipt receipt =
      state_.OnOdometry(1.1, frame_, "tray", {{5.2, 0.0, 0.0}, {1.0, 0.2, 1.0}});
  EXPECT_TRUE(receipt.is_taken());
  Joints(1.1);
  Localise(1.1);
  const auto at = state_.At(1.1);
  ASSERT_TRUE(at);
  ExpectNear(at->X_WB, {5.0, 0.0, 0.0});
  EXPECT_NEAR(at->V_B.vx, 1.0, 1e-12);
  EXPECT_NEAR(at->V_B.vy, 0.0, 1e-12);
}

TEST_F(EstimatorTest, OdometryOfAFrameNobodyKnowsIsRefused) {
  const Receipt receipt = state_.OnOdometry(1.0, frame_, "trailer", {});
  EXPECT_EQ(receipt.what, Reception::kUnknownFrame);
  EXPECT_THAT(ToString(receipt), HasSubstr("frame 'trailer' is unknown"));
  EXPECT_EQ(state_.OnOdometry(1.0, "", "", {}).what, Reception::kUnknownFrame);
  EXPECT_FALSE(state_.now());
}

// ---- Frames of what sensors see.

class FramesTest : public EstimatorTest {
 protected:
  FramesTest() : EstimatorTest(Pr2()) {
    state_ = RobotStateEstimator(robot_, {"lab", "odom_combined", "base_footprint"}, {}, {}, tree_);
    tree_->Tell("lab", "odom_combined", 1.0, Lift({2.0, 1.0, 0.0}));
    state_.OnTransforms(1.0);
    state_.OnOdometry(1.0, frame_, "base_footprint", {{1.0, 0.0, 0.0}, {}});
    state_.OnJoints(1.0, {robot_->profile.joints, {}});
    at_ = *state_.At(1.0);
  }
  RobotEstimate at_;
};

TEST_F(FramesTest, TheMapMayBeCalledOtherwise) {
  ExpectNear(at_.X_WB, {3.0, 1.0, 0.0});
  const FramePose X_BM = state_.InBase("/lab", at_);
  ASSERT_TRUE(X_BM.is_found());
  ExpectNear(geometry::Flatten(X_BM.X_PC), {-3.0, -1.0, 0.0});
  EXPECT_EQ(state_.InBase("map", at_).status, FrameStatus::kUnknown);
}

TEST_F(FramesTest, LinksAreWhereTheJointsPutThem) {
  const std::string camera = robot_->profile.upper_body->camera_link;
  const double low = state_.InBase(camera, at_).X_PC.translation.z();
  auto lowered = at_;
  lowered.posture["torso_lift_joint"] -= 0.1;
  EXPECT_NEAR(state_.InBase(camera, lowered).X_PC.translation.z(), low - 0.1, 1e-9);
  EXPECT_NEAR(state_.LinkInWorld(camera, lowered).translation.z(), low - 0.1, 1e-9);
}

TEST_F(FramesTest, OtherFramesHangOnTheBaseOrOnTheMap) {
  tree_->TellFixed("base_footprint", "new_camera", Lift({0.3, 0.0, 0.0}, 1.2));
  EXPECT_NEAR(state_.InBase("new_camera", at_).X_PC.translation.x(), 0.3, 1e-12);
  tree_->TellFixed("lab", "table", Lift({4.0, 1.0, 0.0}, 0.7));
  EXPECT_NEAR(state_.InBase("table", at_).X_PC.translation.x(), 1.0, 1e-12);
  EXPECT_EQ(state_.InBase("crater", at_).status, FrameStatus::kUnknown);
  tree_->TellFixed("moon", "crater", {});
  EXPECT_EQ(state_.InBase("crater", at_).status, FrameStatus::kNotConnected);
  EXPECT_EQ(state_.InBase("", at_).status, FrameStatus::kUnknown);
}

// ---- Joints of a real robot.

/// A PR2's joint_states has 45 joints: those of its finger tips follow others.
TEST_F(FramesTest, JointsThatFollowOthersOrThatNobodyKnowsAreLeftOut) {
  robot::JointReading reading{robot_->profile.joints, {}};
  reading.positions["l_gripper_r_finger_tip_joint"] = 0.1;
  reading.velocities["l_gripper_r_finger_tip_joint"] = 0.1;
  reading.positions["gadget_joint"] = 1.0;
  reading.positions["fl_caster_rotation_joint"] = 0.5;
  state_.OnJoints(1.1, reading);
  state_.OnOdometry(1.1, frame_, "", {});
  const auto at = state_.At(1.1);
  ASSERT_TRUE(at);
  EXPECT_EQ(at->joints.count("l_gripper_r_finger_tip_joint"), 0u);
  EXPECT_EQ(at->joint_velocities.count("l_gripper_r_finger_tip_joint"), 0u);
  EXPECT_EQ(at->joints.count("gadget_joint"), 0u);
  EXPECT_EQ(at->joints.at("fl_caster_rotation_joint"), 0.5);
  EXPECT_NO_THROW(robot::ForwardKinematics(robot_->model, at->posture));
}

TEST_F(FramesTest, WhatASensorSeesBeyondAStopIsTheStop) {
  const robot::Joint& torso = *robot::FindJoint(robot_->model, "torso_lift_joint");
  state_.OnJoints(1.1, {{{"torso_lift_joint", torso.limits->upper + 0.01}}, {}});
  state_.OnOdometry(1.1, frame_, "", {});
  EXPECT_EQ(state_.At(1.1)->joints.at("torso_lift_joint"), torso.limits->upper);
}

TEST_F(FramesTest, AJointThatTurnsWithoutEndTakesTheShorterWay) {
  state_.OnJoints(1.1, {{{"r_wrist_roll_joint", 3.1}}, {}});
  state_.OnJoints(1.2, {{{"r_wrist_roll_joint", -3.1}}, {}});
  state_.OnOdometry(1.1, frame_, "", {});
  state_.OnOdometry(1.2, frame_, "", {});
  const double half = state_.At(1.15)->joints.at("r_wrist_roll_joint");
  EXPECT_NEAR(std::abs(geometry::WrapToPi(half)), geometry::kPi, 1e-9);
}

TEST_F(FramesTest, AnAngleThatWasMeasuredLeadsOverTheGapOfTheDrivingPosture) {
  const robot::ArmProfile& arm = robot_->profile.upper_body->arms.at("rightarm1");
  robot::JointReading reading{robot_->profile.joints, {}};
  reading.positions.erase(arm.gripper_joint);
  reading.positions[arm.finger_joint] = 0.3;
  RobotStateEstimator state(robot_, {"lab", "odom_combined", "base_footprint"}, {}, {}, tree_);
  state.OnTransforms(1.0);
  state.OnOdometry(1.0, frame_, "", {});
  state.OnJoints(1.0, reading);
  EXPECT_NEAR(state.At(1.0)->posture.at(arm.finger_joint), 0.3, 1e-9);
}

}  // namespace
}  // namespace hires::sensing::robot_state_estimator_test
