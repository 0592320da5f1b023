#include "hires/ros/sensing/sensor_receiver.h"

#include <gmock/gmock.h>

#include <cmath>

#include "hires/ros/perception/detection_messages.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/ros/values/geometry_messages.h"
#include "hires/ros/world/world_messages.h"
#include "support/sight_scenes.h"

namespace hires_ros::sensor_receiver_test {
namespace {

using hires::geometry::Lift;
using hires::sensing::Missing;
using ::testing::SizeIs;

std::shared_ptr<const hires::robot::Robot> Pr2() {
  static const auto pr2 = std::make_shared<const hires::robot::Robot>(
      hires::robot::LoadRobot(std::string(HIRES_SOURCE_DIR) + "/config/robots/pr2.yaml"));
  return pr2;
}

class SensorReceiverTest : public ::testing::Test {
 protected:
  void Odometry(double stamp, const std::string& frame = "odom_combined") {
    nav_msgs::Odometry msg;
    msg.header.stamp.fromSec(stamp);
    msg.header.frame_id = frame;
    msg.child_frame_id = "base_footprint";
    msg.pose.pose = ToMsg(Lift({1.0, 2.0, 0.0}));
    sensors_.OnOdometry(msg);
  }
  void Joints(double stamp) {
    sensors_.OnJoints(
        ToMsg(hires::robot::JointReading{Pr2()->profile.joints, {}}, ros::Time(stamp)));
  }
  void Transform(const std::string& parent, const std::string& child, double stamp) {
    tf2_msgs::TFMessage msg;
    msg.transforms.push_back(MakeTransform(parent, child, {}, ros::Time(stamp)));
    sensors_.OnTransforms(msg, false);
  }
  void All(double stamp) {
    Odometry(stamp);
    Joints(stamp);
    Transform("map", "odom_combined", stamp);
  }

  SensorReceiver sensors_{
      Pr2(),
      std::make_shared<const hires::perception::Surroundings>(hires::test_support::SightWorld()),
      hires::control::ReadRobotNames(std::string(HIRES_SOURCE_DIR) +
                                     "/config/robots/pr2_names.yaml"),
      {}};
};

/// The last word of a robot that has ended, and a new one whose clock begins.
TEST_F(SensorReceiverTest, ATransformOfAnotherClockHoldsUpNobody) {
  Transform("map", "odom_combined", 30.0);
  for (int i = 1; i <= 20; ++i) All(0.05 * i);
  EXPECT_EQ(sensors_.NameOf(sensors_.state().MissingNow()), "");
}

TEST_F(SensorReceiverTest, WhatIsMissingIsNamedAsTheRobotNamesIt) {
  const auto missing = [&] { return sensors_.NameOf(sensors_.state().MissingNow()); };
  EXPECT_EQ(missing(), "base_odometry/odom");
  Odometry(1.0);
  EXPECT_EQ(missing(), "joint_states");
  Joints(1.0);
  EXPECT_EQ(missing(), "map -> odom_combined");
  Transform("map", "odom_combined", 1.0);
  EXPECT_EQ(missing(), "");
  EXPECT_EQ(sensors_.NameOf(Missing::kOdometryFrame), "odom_combined -> base_footprint");
  EXPECT_EQ(sensors_.num_bad(), 0);
}

TEST_F(SensorReceiverTest, BadMessagesAreCountedAndLeftOut) {
  Odometry(0.0);
  EXPECT_EQ(sensors_.num_bad(), 1);
  sensor_msgs::JointState joints;
  joints.header.stamp.fromSec(1.0);
  joints.name = {"torso_lift_joint"};
  sensors_.OnJoints(joints);
  EXPECT_EQ(sensors_.num_bad(), 2);
  hires::Detections look;
  look.header.frame_id = "head_mount_kinect_ir_link";
  sensors_.OnDetections(look);  // without a time
  EXPECT_EQ(sensors_.num_bad(), 3);
  sensors_.OnKnownObjects({});  // without a frame
  EXPECT_EQ(sensors_.num_bad(), 4);
  EXPECT_EQ(sensors_.state().MissingNow(), Missing::kOdometry);
}

TEST_F(SensorReceiverTest, OneThatCouldNotLookIsNoLook) {
  All(1.0);
  hires::Detections look;
  look.header.stamp.fromSec(1.0);
  look.header.frame_id = "map";
  look.is_blind = 1;
  sensors_.OnDetections(look);
  EXPECT_EQ(sensors_.Update(*sensors_.state().At(1.0)).num_looks, 0);
  look.is_blind = 0;
  sensors_.OnDetections(look);
  EXPECT_EQ(sensors_.Update(*sensors_.state().At(1.0)).num_looks, 1);
}

TEST_F(SensorReceiverTest, DetectionsInTheMapAndWhatAnotherNodeRemembersBecomeObjects) {
  All(1.0);
  hires::Detections look;
  look.header.stamp.fromSec(1.0);
  look.header.frame_id = "/map";
  look.detections.emplace_back();
  look.detections[0].label = "mug";
  look.detections[0].instance = "Mug1";
  look.detections[0].pose = ToMsg(Lift({2.0, 2.0, 0.0}, 0.7));
  sensors_.OnDetections(look);
  hires::world::WorldState state;
  state.objects.push_back({"jug1", "jug", Lift({3.0, 2.0, 0.0}, 0.7), {}, ""});
  hires::WorldState known = ToMsg(state);
  known.header.frame_id = "map";
  sensors_.OnKnownObjects(known);
  const auto now = sensors_.state().At(1.0);
  ASSERT_TRUE(now);
  EXPECT_EQ(sensors_.Update(*now).num_looks, 1);
  const auto objects = sensors_.objects()->memory().Known(now->Body());
  ASSERT_THAT(objects, SizeIs(2));
  EXPECT_EQ(objects[0].name, "jug1");
  EXPECT_EQ(objects[1].name, "mug1");
  EXPECT_NEAR(objects[1].X_MO.translation.x(), 2.0, 1e-9);
  EXPECT_EQ(sensors_.num_bad(), 0);
}

/// Objects and detections in a frame three links away, turned and tilted.
class ConnectedFrameTest : public SensorReceiverTest {
 protected:
  /// map -> hall (3, 1, 0; yaw 90 deg) -> table (2, 0, 0.7) -> board (0, 0, 0.1; roll 90 deg): the
  /// board is at (3, 3, 0.8) in the map, its z axis along the map's x, its x axis along y.
  void TellBoard() {
    using hires::geometry::RotationFromRpy;
    Fixed("map", "hall", {{3.0, 1.0, 0.0}, RotationFromRpy(0.0, 0.0, M_PI / 2)});
    Fixed("hall", "table", {{2.0, 0.0, 0.7}, Eigen::Quaterniond::Identity()});
    Fixed("table", "board", {{0.0, 0.0, 0.1}, RotationFromRpy(M_PI / 2, 0.0, 0.0)});
  }
  void Fixed(const std::string& parent, const std::string& child,
             const hires::geometry::Pose3& X_PC) {
    tf2_msgs::TFMessage msg;
    msg.transforms.push_back(MakeTransform(parent, child, X_PC, ros::Time(0.5)));
    sensors_.OnTransforms(msg, true);
  }
  void State(const std::string& frame, double stamp) {
    hires::world::WorldState state;
    state.objects.push_back(
        {"jug1", "jug", {{0.5, 0.0, 0.25}, Eigen::Quaterniond::Identity()}, {}, ""});
    hires::WorldState known = ToMsg(state);
    known.header.frame_id = frame;
    known.header.stamp.fromSec(stamp);
    sensors_.OnKnownObjects(known);
  }
  std::vector<hires::robot::SeenObject> KnownAt(double time) {
    const auto now = sensors_.state().At(time);
    EXPECT_TRUE(now);
    if (!now) return {};
    sensors_.Update(*now);
    return sensors_.objects()->memory().Known(now->Body());
  }
};

TEST_F(ConnectedFrameTest, WhatAnotherNodeStatesThereIsPutIntoTheMap) {
  TellBoard();
  All(1.0);
  State("/board", 1.0);
  const auto objects = KnownAt(1.0);
  ASSERT_THAT(objects, SizeIs(1));
  EXPECT_LT((objects[0].X_MO.translation - Eigen::Vector3d(3.25, 3.5, 0.8)).norm(), 1e-9);
  EXPECT_EQ(sensors_.num_bad(), 0);
}

TEST_F(ConnectedFrameTest, ALookThereIsPutIntoTheMap) {
  TellBoard();
  All(1.0);
  hires::Detections look;
  look.header.stamp.fromSec(1.0);
  look.header.frame_id = "board";
  look.detections.emplace_back();
  look.detections[0].label = "mug";
  look.detections[0].instance = "mug1";
  look.detections[0].pose =
      ToMsg(hires::geometry::Pose3{{0.5, 0.0, 0.25}, Eigen::Quaterniond::Identity()});
  sensors_.OnDetections(look);
  const auto objects = KnownAt(1.0);
  ASSERT_THAT(objects, SizeIs(1));
  EXPECT_LT((objects[0].X_MO.translation - Eigen::Vector3d(3.25, 3.5, 0.8)).norm(), 1e-9);
}

TEST_F(ConnectedFrameTest, WhatIsStatedInAFrameThatLeadsNowhereIsLeftOut) {
  All(1.0);
  Fixed("moon", "crater", {});
  for (const char* frame : {"crater", "nowhere"}) {
    State(frame, 1.0);
    const int num_bad = sensors_.num_bad();
    EXPECT_THAT(KnownAt(1.0), SizeIs(0)) << frame;
    EXPECT_EQ(sensors_.num_bad(), num_bad + 1) << frame;
  }
}

TEST_F(ConnectedFrameTest, ATransformThatComesAMomentLateIsWaitedFor) {
  All(1.0);
  Transform("map", "cart", 0.9);
  State("cart", 1.0);
  EXPECT_THAT(KnownAt(1.0), SizeIs(0));
  EXPECT_EQ(sensors_.num_bad(), 0);
  Transform("map", "cart", 1.1);
  All(1.1);
  EXPECT_THAT(KnownAt(1.1), SizeIs(1));
  State("cart", 1.3);  // and no other comes
  All(1.3);
  KnownAt(1.3);
  EXPECT_EQ(sensors_.num_bad(), 0);
  All(1.5);
  KnownAt(1.5);
  EXPECT_EQ(sensors_.num_bad(), 1);
}

TEST(DetectionMessageTest, SurvivesBothWays) {
  hires::perception::Detection detection{"mug1", "mug", Lift({1.0, 2.0, 0.5}, 0.7), 0.5};
  detection.category = "Mug";
  detection.confidence = 0.75;
  detection.alternatives = {{"jug", 0.25}};
  detection.size = {0.1, 0.2, 0.3};
  detection.num_points = 77;
  detection.may_be_beside = true;
  const auto back = FromMsg(ToMsg(detection));
  EXPECT_EQ(back.instance, detection.instance);
  EXPECT_EQ(back.label, "mug");
  EXPECT_EQ(back.X_CO.translation, detection.X_CO.translation);
  EXPECT_EQ(back.visible_share, 0.5);
  EXPECT_EQ(back.category, "Mug");
  EXPECT_EQ(back.confidence, 0.75);
  ASSERT_THAT(back.alternatives, SizeIs(1));
  EXPECT_EQ(back.alternatives[0].label, "jug");
  EXPECT_EQ(back.alternatives[0].confidence, 0.25);
  EXPECT_EQ(back.size, detection.size);
  EXPECT_EQ(back.num_points, 77);
  EXPECT_TRUE(back.may_be_beside);
}

TEST(DetectionMessageTest, WhatIsNotToldIsNotKnown) {
  const auto detection = FromMsg(hires::Detection());
  EXPECT_FALSE(detection.instance);
  EXPECT_EQ(detection.confidence, 1.0);
  EXPECT_FALSE(detection.may_be_beside);
}

}  // namespace
}  // namespace hires_ros::sensor_receiver_test
