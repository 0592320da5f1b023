#include "hires/sensing/object_estimator.h"

#include <gmock/gmock.h>

#include "hires/perception/camera_view.h"
#include "hires/robot/gripper.h"
#include "support/fake_frame_tree.h"
#include "support/sight_scenes.h"

namespace hires::sensing::object_estimator_test {
namespace {

using geometry::Lift;
using geometry::Pose2;
using geometry::Pose3;
using perception::Detection;
using test_support::At;
using test_support::EmptyRoom;
using test_support::FakeFrameTree;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

std::shared_ptr<const robot::Robot> Pr2() {
  static const auto pr2 = std::make_shared<const robot::Robot>(
      robot::LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml"));
  return pr2;
}

/// A PR2 whose sensors speak at 20 Hz, and things that it sees.
class ObjectEstimatorTest : public testing::Test {
 protected:
  ObjectEstimatorTest() {
    joints_ = Pr2()->profile.joints;
    joints_["head_pan_joint"] = 0.0;
    joints_["head_tilt_joint"] = 0.5;
    SetGap(0.0);
    const robot::ArmProfile& left = Pr2()->profile.upper_body->arms.at("leftarm1");
    robot::SetGap(Pr2()->profile.upper_body->gripper, left, 0.0, &joints_);
    PutArm("leftarm1", "armtosideposture");
    PutArm("rightarm1", "armtosideposture");
    Tick();
  }
  void PutArm(const std::string& name, const std::string& posture) {
    const robot::ArmProfile& arm = Pr2()->profile.upper_body->arms.at(name);
    const auto& positions = arm.postures.at(posture)[0];
    for (std::size_t i = 0; i < positions.size(); ++i) joints_[arm.joints[i]] = positions[i];
  }
  void SetGap(double gap) {
    const robot::UpperBodyProfile& upper = *Pr2()->profile.upper_body;
    robot::SetGap(upper.gripper, upper.arms.at("rightarm1"), gap, &joints_);
  }
  /// Sensors of the next moment, and what the estimator makes of it.
  LookNews Tick(double dt = 0.05) {
    Sense(time_ + dt);
    return Update();
  }
  void Sense(double time) {
    time_ = time;
    tree_->Tell("map", "odom_combined", time_, {});
    state_.OnTransforms(time_);
    state_.OnOdometry(time_, "odom_combined", "base_footprint", {X_MB_, {}});
    state_.OnJoints(time_, {joints_, {}});
  }
  LookNews Update() { return objects_.Update(*state_.At(time_)); }
  LookNews Rest(int ticks = 10) {
    LookNews all;
    for (int i = 0; i < ticks; ++i) {
      all.has_changed_hands = Tick().has_changed_hands || all.has_changed_hands;
    }
    return all;
  }
  Pose3 InWorld(const std::string& link) const {
    return state_.LinkInWorld(link, *state_.At(time_));
  }
  static Detection Mug(const Pose3& X_FO, const std::string& name = "mug1") {
    return {name, "mug", X_FO, 1.0};
  }
  std::vector<std::string> See(const std::string& frame, const std::vector<Detection>& detections) {
    return objects_.OnLook({time_, frame, detections});
  }
  std::vector<robot::SeenObject> Known() const {
    return objects_.memory().Known(state_.At(time_)->Body());
  }
  void ExpectMugAt(const Eigen::Vector3d& p_M) const {
    const auto known = Known();
    ASSERT_THAT(known, SizeIs(1));
    EXPECT_NEAR((known[0].X_MO.translation - p_M).norm(), 0.0, 1e-9);
  }
  /// Has the right hand take a mug that is seen between its fingers.
  void Grasp() {
    PutArm("rightarm1", "armuntuckedposture");
    SetGap(0.09);
    Tick();
    Pose3 X_MO;
    X_MO.translation = InWorld("r_gripper_tool_frame").translation - Eigen::Vector3d(0, 0, 0.05);
    See("map", {Mug(X_MO)});
    Rest();
    SetGap(0.079);
    ASSERT_TRUE(Rest().has_changed_hands);
    ASSERT_TRUE(objects_.memory().objects().at("mug1").is_held);
  }

  const std::string camera_ = Pr2()->profile.upper_body->camera_link;
  std::shared_ptr<FakeFrameTree> tree_ = std::make_shared<FakeFrameTree>();
  RobotStateEstimator state_{Pr2(), {"map", "odom_combined", "base_footprint"}, {}, {}, tree_};
  ObjectEstimator objects_{EmptyRoom(), Pr2(), {}, &state_};
  robot::JointPositions joints_;
  Pose2 X_MB_{3.0, 2.0, 0.5};
  double time_{10.0};
};

// ---- Frames.

TEST_F(ObjectEstimatorTest, ADetectionMayBeInAnyFrameThatIsConnected) {
  const Pose3 X_MO = Lift({4.5, 2.8, 0.0}, 0.7);
  tree_->TellFixed("base_footprint", "new_camera", Lift({0.2, 0.0, 0.3}, 1.1));
  const Pose3 X_MN = Lift(X_MB_) * Lift({0.2, 0.0, 0.3}, 1.1);
  const std::map<std::string, Pose3> X_MF{{camera_, InWorld(camera_)},
                                          {"/" + camera_, InWorld(camera_)},
                                          {"map", {}},
                                          {"odom_combined", {}},
                                          {"base_footprint", Lift(X_MB_)},
                                          {"torso_lift_link", InWorld("torso_lift_link")},
                                          {"new_camera", X_MN}};
  for (const auto& [frame, pose] : X_MF) {
    ObjectEstimator fresh(EmptyRoom(), Pr2(), {}, &state_);
    EXPECT_THAT(fresh.OnLook({time_, frame, {Mug(pose.Inverse() * X_MO)}}), IsEmpty());
    EXPECT_EQ(fresh.Update(*state_.At(time_)).num_looks, 1) << frame;
    const auto known = fresh.memory().Known(state_.At(time_)->Body());
    ASSERT_THAT(known, SizeIs(1)) << frame;
    EXPECT_LT((known[0].X_MO.translation - X_MO.translation).norm(), 1e-9) << frame;
  }
}

TEST_F(ObjectEstimatorTest, ALookInAFrameNobodyKnowsIsDroppedWithAWarning) {
  EXPECT_THAT(See("", {Mug({})}), ElementsAre(HasSubstr("frame '' is unknown")));
  See("submarine", {Mug({})});
  const LookNews news = Tick();
  EXPECT_EQ(news.num_looks, 0);
  EXPECT_THAT(news.warnings, ElementsAre(HasSubstr("frame 'submarine' is unknown")));
  EXPECT_THAT(Known(), IsEmpty()) << "not as if it were the map";
  EXPECT_EQ(objects_.num_dropped(), 1);
}

TEST_F(ObjectEstimatorTest, ALookInAFrameThatHangsOnNothingIsDroppedWithAWarning) {
  tree_->TellFixed("moon", "crater", {});
  tree_->TellFixed("base_footprint", "screw", {});
  See("crater", {Mug({})});
  EXPECT_THAT(Tick().warnings, ElementsAre(HasSubstr("frame 'crater' is not connected")));
}

TEST_F(ObjectEstimatorTest, ALookWaitsAWhileForTheTransformOfItsFrame) {
  tree_->Tell("base_footprint", "arm_camera", time_ - 0.05, Lift({0.1, 0.0, 0.0}));
  See("arm_camera", {Mug(At(1.0, 0.0, 0.7))});
  EXPECT_EQ(objects_.NextLook(time_), time_) << "nobody has looked at it";
  EXPECT_EQ(Update().num_looks, 0);
  EXPECT_FALSE(objects_.NextLook(time_));
  EXPECT_EQ(objects_.DropUntil(time_), 0) << "it was known how the robot stood";
  tree_->Tell("base_footprint", "arm_camera", time_, Lift({0.2, 0.0, 0.0}));
  EXPECT_EQ(Update().num_looks, 1);
  ExpectMugAt(Lift(X_MB_) * Eigen::Vector3d(1.2, 0.0, 0.7));
  See("arm_camera", {Mug(At(1.0, 0.0, 0.7))});
  tree_->Tell("base_footprint", "arm_camera", time_, {});
  Tick();
  See("arm_camera", {Mug(At(1.0, 0.0, 0.7))});
  const int looks = Tick().num_looks + Tick().num_looks;
  EXPECT_EQ(looks, 0);
  EXPECT_THAT(Tick(0.2).warnings, ElementsAre(HasSubstr("arm_camera")));
}

// ---- Bad input.

TEST_F(ObjectEstimatorTest, ABadDetectionIsLeftOutAndTheOthersAreTaken) {
  Pose3 nowhere;
  nowhere.translation.x() = std::nan("");
  Detection teapot = Mug(At(1.0, 0.0, 0.0), "teapot1");
  teapot.label = "teapot";
  const auto left_out =
      See("base_footprint", {teapot, Mug(nowhere, "mug2"), Mug(At(1.0, 0.0, 0.7))});
  EXPECT_THAT(left_out, ElementsAre(HasSubstr("'teapot' is unknown"), HasSubstr("'mug2'")));
  Tick();
  EXPECT_THAT(Known(), SizeIs(1));
}

TEST_F(ObjectEstimatorTest, ALookWithoutATimeOrOfAnotherClockIsRefused) {
  EXPECT_THAT(objects_.OnLook({0.0, camera_, {}}), ElementsAre(HasSubstr("header.stamp is 0")));
  EXPECT_THAT(objects_.OnLook({5000.0, camera_, {}}), ElementsAre(HasSubstr("ahead")));
  EXPECT_THAT(objects_.OnLook({time_, camera_, {}, {{0, 0, 1}, {1, 0, 1}}}),
              ElementsAre(HasSubstr("table has 2 corners, wanted none or at least 3")));
  perception::Detection doubtful = Mug(At(1.5, 0.1, 0.0));
  doubtful.confidence = 1.5;
  EXPECT_THAT(objects_.OnLook({time_, camera_, {doubtful}}),
              ElementsAre(HasSubstr("confidence is 1.5, wanted 0 (not told) .. 1")));
}

TEST_F(ObjectEstimatorTest, WhatIsStatedOfALinkNobodyHasIsRefusedByName) {
  world::WorldState stated;
  stated.objects.push_back({"Mug1", "mug", At(5.0, 1.0, 0.7), {}, "tail_link"});
  EXPECT_THAT(objects_.OnStated(stated, *state_.At(time_)), ElementsAre(HasSubstr("tail_link")));
  EXPECT_THAT(Known(), IsEmpty());
}

// ---- Time.

TEST_F(ObjectEstimatorTest, ALookAheadOfTheOtherSensorsWaitsForThem) {
  objects_.OnLook({time_ + 0.05, camera_, {Mug(At(1.0, 0.0, 0.0))}});
  EXPECT_EQ(objects_.NextLook(time_), time_ + 0.05);
  EXPECT_EQ(Update().num_looks, 0);
  const LookNews news = Tick();
  EXPECT_EQ(news.num_looks, 1);
  EXPECT_EQ(news.newest_look, time_);
  EXPECT_FALSE(objects_.NextLook(time_));
}

TEST_F(ObjectEstimatorTest, ALookIsJudgedWithThePostureOfItsTime) {
  const double then = time_;
  const Pose3 X_MCthen = InWorld(camera_);
  for (int i = 0; i < 20; ++i) {
    X_MB_.x += 0.05;
    joints_["head_pan_joint"] += 0.04;
    Tick();
  }
  objects_.OnLook({then, camera_, {Mug(At(1.5, 0.1, 0.0))}});  // recognising took a second
  Tick();
  ExpectMugAt(X_MCthen * Eigen::Vector3d(1.5, 0.1, 0.0));
  EXPECT_EQ(Known()[0].time, then);
}

TEST_F(ObjectEstimatorTest, ALookOfATimeWithoutJointStatesIsDropped) {
  Sense(time_ + 0.25);
  objects_.OnLook({time_ - 0.12, camera_, {Mug(At(1.0, 0.0, 0.0))}});
  EXPECT_THAT(Update().warnings,
              ElementsAre(HasSubstr("the posture of the robot when the picture was taken")));
  EXPECT_THAT(Known(), IsEmpty());
}

TEST_F(ObjectEstimatorTest, ALookOfBeforeAHandTookSomethingSaysNothingOfNow) {
  Grasp();
  const double before = time_ - 0.5;
  objects_.OnLook({before, "map", {Mug(At(3.0, 3.0, 0.7))}});
  EXPECT_EQ(Tick().num_looks, 0);
  EXPECT_EQ(objects_.num_outdated(), 1);
  EXPECT_TRUE(objects_.memory().objects().at("mug1").is_held);
}

TEST_F(ObjectEstimatorTest, LooksOfATimeThatNobodyWillKnowAreDroppedAndComeUpNoMore) {
  const double then = time_;
  See(camera_, {Mug(At(1.0, 0.0, 0.0))});
  objects_.OnLook({then + 0.05, camera_, {}});
  ASSERT_EQ(objects_.NextLook(then), then);
  EXPECT_EQ(objects_.DropUntil(then), 1);
  EXPECT_EQ(objects_.NextLook(then), then + 0.05);
  EXPECT_EQ(objects_.num_dropped(), 1);
  EXPECT_EQ(objects_.DropUntil(then), 0);
}

TEST_F(ObjectEstimatorTest, AClockThatBeginsAgainIsFollowed) {
  Grasp();
  objects_.OnLook({time_ + 0.2, camera_, {}});
  Sense(1.0);
  Tick();  // what came before the odometry told of the new clock is lost
  EXPECT_FALSE(objects_.NextLook(0.0)) << "a look of the old clock";
  EXPECT_TRUE(objects_.memory().objects().at("mug1").is_held);
  SetGap(0.09);
  EXPECT_TRUE(Rest().has_changed_hands);
  objects_.OnLook({time_, "map", {Mug(At(4.0, 3.0, 0.7))}});
  EXPECT_EQ(Tick().num_looks, 1);
}

// ---- What is remembered.

TEST_F(ObjectEstimatorTest, WhatAHandHoldsMovesWithTheHand) {
  Grasp();
  const Pose3 X_LO = InWorld("r_gripper_palm_link").Inverse() * Known()[0].X_MO;
  X_MB_ = {1.0, 1.0, -1.0};
  joints_["r_shoulder_lift_joint"] -= 0.2;
  Tick();
  ASSERT_THAT(Known(), SizeIs(1));
  EXPECT_EQ(Known()[0].attached_to, "r_gripper_palm_link");
  const Pose3 X_LOnow = InWorld("r_gripper_palm_link").Inverse() * Known()[0].X_MO;
  EXPECT_LT((X_LOnow.translation - X_LO.translation).norm(), 1e-9);
}

TEST_F(ObjectEstimatorTest, WhatOthersStateCountsUntilItIsTakenBackOrSeenOtherwise) {
  world::WorldState stated;
  stated.objects.push_back({"Mug1", "mug", At(5.0, 1.0, 0.7), {}, ""});
  EXPECT_THAT(objects_.OnStated(stated, *state_.At(time_)), IsEmpty());
  ExpectMugAt({5.0, 1.0, 0.7});
  objects_.OnStated(world::WorldState(), *state_.At(time_));
  EXPECT_THAT(Known(), IsEmpty());
  See("map", {Mug(At(4.0, 2.5, 0.7))});
  Tick();
  objects_.OnStated(stated, *state_.At(time_));
  ExpectMugAt({4.0, 2.5, 0.7});
}

TEST_F(ObjectEstimatorTest, LooksThatComeInAnyOrderAreRememberedInTheOrderOfTime) {
  const double first = time_;
  Tick();
  objects_.OnLook({time_, "map", {Mug(At(4.0, 2.5, 0.7))}});
  objects_.OnLook({first, "map", {Mug(At(5.0, 2.5, 0.7))}});
  EXPECT_EQ(Update().num_looks, 2);
  ExpectMugAt({4.0, 2.5, 0.7});
}

// ---- The tray.

TEST_F(ObjectEstimatorTest, ScansOfTheTrayAreUsedTenTimesASecondWhenTheirTimeIsKnown) {
  const robot::ScanReading empty{-1.4, 2.8 / 639, 0.08, std::vector<float>(640, 5.0F)};
  const std::string laser = "base_tray_laser_link";
  const Pose3 X_MT = InWorld("base_tray_link");
  world::WorldState stated;
  stated.objects.push_back({"Mug1", "mug", X_MT * At(0.15, 0.0, 0.0), {}, ""});
  objects_.OnStated(stated, *state_.At(time_));
  See("map", {Mug(X_MT * At(0.15, 0.0, 0.0))});
  Tick();
  ASSERT_EQ(objects_.memory().objects().at("mug1").link, "base_footprint");
  EXPECT_THAT(objects_.OnTrayScan(time_ + 0.05, laser, empty), IsEmpty());
  Update();
  EXPECT_EQ(objects_.num_scans(), 0) << "the robot's state of that time is not known yet";
  for (int i = 0; i < 10; ++i) {
    EXPECT_THAT(objects_.OnTrayScan(time_ + 0.05, laser, empty), IsEmpty());
    Tick();
  }
  EXPECT_EQ(objects_.num_scans(), 5);
  EXPECT_THAT(objects_.memory().Vanished(), ElementsAre("mug1"));
}

TEST_F(ObjectEstimatorTest, BadScansOfTheTrayAreNamed) {
  const robot::ScanReading good{-1.4, 2.8 / 639, 0.08, std::vector<float>(640, 5.0F)};
  const std::string laser = "base_tray_laser_link";
  robot::ScanReading bad = good;
  bad.ranges.clear();
  EXPECT_THAT(objects_.OnTrayScan(time_, laser, bad), ElementsAre(HasSubstr("no ranges")));
  bad = good;
  bad.angle_increment = 0.0;
  EXPECT_THAT(objects_.OnTrayScan(time_, laser, bad), ElementsAre(HasSubstr("angle_increment")));
  bad = good;
  bad.range_min = std::nan("");
  EXPECT_THAT(objects_.OnTrayScan(time_, laser, bad), ElementsAre(HasSubstr("range_min is nan")));
  EXPECT_THAT(objects_.OnTrayScan(0.0, laser, good), ElementsAre(HasSubstr("stamp")));
  EXPECT_THAT(objects_.OnTrayScan(time_ + 100.0, laser, good), SizeIs(1));
  // What can be told only when it is used comes with the next one.
  const auto after = [&](const std::string& frame) {
    Tick();
    Tick();
    EXPECT_THAT(objects_.OnTrayScan(time_, frame, good), IsEmpty());
    Update();
    Tick();
    Tick();
    return objects_.OnTrayScan(time_, laser, good);
  };
  EXPECT_THAT(after("nowhere"), ElementsAre(HasSubstr("nowhere")));
  Update();
  EXPECT_THAT(after("head_tilt_link"), ElementsAre(HasSubstr("leans")));
  EXPECT_THAT(Known(), IsEmpty());
}

TEST_F(ObjectEstimatorTest, ARobotWithoutACameraSaysSo) {
  const auto cart = std::make_shared<const robot::Robot>(test_support::TrayRobot());
  ObjectEstimator blind(EmptyRoom(), cart, {}, &state_);
  EXPECT_THAT(blind.OnLook({time_, camera_, {}}), ElementsAre(HasSubstr("has no camera")));
}

}  // namespace
}  // namespace hires::sensing::object_estimator_test
