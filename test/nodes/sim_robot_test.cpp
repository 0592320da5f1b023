#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/ros/imagination/truth_messages.h"
#include "hires/ros/robot/robot_messages.h"
#include "hires/ros/values/geometry_messages.h"
#include "hires/simulation/command_inbox.h"
#include "hires/simulation/scan_ghosts.h"
#include "hires/simulation/truth_record.h"
#include "nodes/sim_worker/sensor_messages.h"
#include "nodes/sim_worker/sim_robot_params.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires_ros::sim_robot_test {
namespace {

using hires::geometry::Polygon;
using ::testing::HasSubstr;

// What controllers are told
// --------------------------------------------------------------------------

hires::robot::Command Drive(double vx) {
  hires::robot::Command command;
  command.base_velocity = hires::geometry::Twist2{vx, 0.0, 0.0};
  return command;
}

TEST(CommandInboxTest, LaterCommandsReplaceEarlierOnesOfTheSameKindOnly) {
  hires::simulation::CommandInbox inbox;
  inbox.Add("a", Drive(0.1));
  hires::robot::Command grip;
  grip.grippers["leftarm1"] = {0.05, 10.0};
  inbox.Add("a", grip);
  inbox.Add("a", Drive(0.2));
  const auto taken = inbox.Take();
  EXPECT_EQ(taken.base_velocity->vx, 0.2);
  EXPECT_EQ(taken.grippers.at("leftarm1").gap, 0.05);
  EXPECT_FALSE(inbox.Take().base_velocity);
}

TEST(CommandInboxTest, EachSenderIsCountedForItself) {
  hires::simulation::CommandInbox inbox;
  inbox.Add("a", Drive(0.1));
  inbox.Add("a", Drive(0.1));
  inbox.Add("b", Drive(0.1));
  EXPECT_EQ(inbox.num_from("a"), 2u);
  inbox.CountOff("a", 1);
  inbox.CountOff("b", 7);  // announced more than it has sent
  EXPECT_EQ(inbox.num_from("a"), 1u);
  EXPECT_EQ(inbox.num_from("b"), 0u);
  EXPECT_EQ(inbox.num_from("nobody"), 0u);
}

trajectory_msgs::JointTrajectory Trajectory(const std::vector<std::string>& joints,
                                            const std::vector<double>& times) {
  trajectory_msgs::JointTrajectory msg;
  msg.joint_names = joints;
  for (const double time : times) {
    trajectory_msgs::JointTrajectoryPoint point;
    point.positions.assign(joints.size(), 0.5);
    point.time_from_start = ros::Duration(time);
    msg.points.push_back(point);
  }
  return msg;
}

std::string Refusal(const trajectory_msgs::JointTrajectory& msg) {
  return hires::test_support::ConfigErrorOf([&] {
    FromMsg(msg, {"elbow", "wrist"}, "arm/command");
  });
}

TEST(TrajectoryTest, TravelsBothWaysUnchanged) {
  hires::robot::JointTrajectory trajectory{{"elbow", "wrist"},
                                           {{0.5, {0.1, 0.2}, {}}, {1.25, {0.3, 0.4}, {0.0, 1.0}}}};
  const auto back = FromMsg(ToMsg(trajectory), {"elbow", "wrist"}, "arm/command");
  ASSERT_EQ(back.points.size(), 2u);
  EXPECT_EQ(back.joints, trajectory.joints);
  EXPECT_EQ(back.points[1].time, 1.25);
  EXPECT_EQ(back.points[1].positions, trajectory.points[1].positions);
  EXPECT_EQ(back.points[1].velocities, trajectory.points[1].velocities);
}

TEST(TrajectoryTest, WhatMakesNoSenseIsNamed) {
  EXPECT_THAT(Refusal(Trajectory({}, {1.0})), HasSubstr("names no joints"));
  EXPECT_THAT(Refusal(Trajectory({"elbow"}, {})), HasSubstr("has no points"));
  EXPECT_THAT(Refusal(Trajectory({"elbowe"}, {1.0})), HasSubstr("elbow"));
  EXPECT_THAT(Refusal(Trajectory({"elbow", "elbow"}, {1.0})), HasSubstr("'elbow' twice"));
  EXPECT_THAT(Refusal(Trajectory({"elbow"}, {1.0, 1.0})), HasSubstr("point 1 comes at 1 s"));
  EXPECT_THAT(Refusal(Trajectory({"elbow"}, {-1.0})), HasSubstr("point 0 comes at -1 s"));
  auto msg = Trajectory({"elbow"}, {1.0});
  msg.points[0].positions.push_back(0.0);
  EXPECT_THAT(Refusal(msg), HasSubstr("2 positions for 1 joints"));
  msg = Trajectory({"elbow", "wrist"}, {1.0});
  msg.points[0].velocities = {0.0};
  EXPECT_THAT(Refusal(msg), HasSubstr("1 velocities for 2 joints"));
  msg = Trajectory({"elbow"}, {1.0});
  msg.points[0].positions[0] = std::nan("");
  EXPECT_THAT(Refusal(msg), HasSubstr("not finite"));
}

// Laser
// ----------------------------------------------------------------------------------------------

TEST(SimLaserTest, ARayMeetsTheNearestEdge) {
  const Polygon square{{1.0, -1.0}, {2.0, -1.0}, {2.0, 1.0}, {1.0, 1.0}};
  EXPECT_NEAR(hires::simulation::DistanceTo(square, {0.0, 0.0}, {2.0, 0.0}), 1.0, 1e-12);
  EXPECT_NEAR(hires::simulation::DistanceTo(square, {0.0, 0.0}, {1.0, 0.5}), std::hypot(1.0, 0.5),
              1e-12);
  EXPECT_TRUE(std::isinf(hires::simulation::DistanceTo(square, {0.0, 0.0}, {-1.0, 0.0})));
  EXPECT_TRUE(std::isinf(hires::simulation::DistanceTo(square, {0.0, 0.0}, {0.0, 1.0})));
  EXPECT_EQ(hires::simulation::DistanceTo(square, {1.5, 0.0}, {1.0, 0.0}), 0.0);
}

TEST(SimLaserTest, AGhostStandsBeforeWhatIsReallyThere) {
  hires::simulation::LaserParams params;
  params.num_beams = 3;
  params.angle_min = -M_PI / 2;
  params.angle_max = M_PI / 2;
  params.range_max = 4.0;
  const Polygon near{{2.3, 1.4}, {2.4, 1.4}, {2.4, 1.6}, {2.3, 1.6}};
  const Polygon far{{7.0, 1.4}, {7.1, 1.4}, {7.1, 1.6}, {7.0, 1.6}};
  std::vector<double> ranges{1.5, INFINITY, 2.5};
  hires::simulation::AddGhosts({near, far}, params, {1.3, 1.5, 0.0}, &ranges);
  EXPECT_EQ(ranges[0], 1.5);
  EXPECT_NEAR(ranges[1], 1.0, 1e-12);
  EXPECT_EQ(ranges[2], 2.5);
}

TEST(ObjectTruthTest, SurvivesBothWays) {
  hires::simulation::ObjectFate fate;
  fate.X_MO = hires::geometry::Lift({1.0 / 3.0, 2.0, 0.0}, 0.73);
  fate.attached_to = "l_gripper_palm_link";
  fate.tilt = 0.1;
  fate.max_tilt = 1.0 / 7.0;
  fate.falls = 2;
  fate.first_fall = hires::world::Fall::kSlid;
  fate.stands = true;
  const hires::ObjectTruth msg = ToMsg("mug1", fate);
  EXPECT_EQ(msg.name, "mug1");
  const auto back = FromMsg(msg);
  EXPECT_EQ(back.X_MO.translation, fate.X_MO.translation);
  EXPECT_EQ(back.attached_to, fate.attached_to);
  EXPECT_EQ(back.tilt, fate.tilt);
  EXPECT_EQ(back.max_tilt, fate.max_tilt);
  EXPECT_EQ(back.falls, 2);
  EXPECT_EQ(back.first_fall, hires::world::Fall::kSlid);
  EXPECT_TRUE(back.stands);
}

/// As the node odometry_filter reads it.
TEST(ImuMessageTest, AUnitThatHangsUpsideDownTellsTheBasesHeading) {
  const Eigen::Quaterniond R_BI(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()));
  const sensor_msgs::Imu msg = ToMsg(hires::robot::ImuReading{0.7, 0.2}, R_BI);
  geometry_msgs::Pose pose;
  pose.orientation = msg.orientation;
  EXPECT_NEAR(hires::geometry::YawOf(FromMsg(pose).rotation * R_BI.inverse()), 0.7, 1e-12);
  EXPECT_NEAR(msg.angular_velocity.z, -0.2, 1e-12);
  EXPECT_GE(msg.orientation_covariance[0], 0.0);
  EXPECT_EQ(msg.linear_acceleration_covariance[0], -1.0);
}

// Parameters
// -----------------------------------------------------------------------------------------

class SimRobotParamsTest : public ::testing::Test {
 protected:
  const std::string config_ = std::string(HIRES_SOURCE_DIR) + "/config/";

  /// The file with one line changed.
  std::string With(const std::string& from, const std::string& to) {
    std::string text = hires::base::ReadTextFile(config_ + "sim_robot.yaml");
    const auto replace = [&](const std::string& a, const std::string& b) {
      const auto at = text.find(a);
      ASSERT_NE(at, std::string::npos) << a;
      text.replace(at, a.size(), b);
    };
    replace("scene: scene.yaml", "scene: " + config_ + "scene.yaml");
    replace("truth: same", "truth: " + config_ + "truths/same.yaml");
    replace(from, to);
    return text;
  }
  std::string Refusal(const std::string& from, const std::string& to) {
    const std::string path = folder_.Write("sim_robot.yaml", With(from, to));
    return hires::test_support::ConfigErrorOf([&] { ReadSimRobotParams(path); });
  }
  hires::test_support::TemporaryFolder folder_;
};

TEST_F(SimRobotParamsTest, TheFileOfThePackageIsComplete) {
  const SimRobotParams params = ReadSimRobotParams(config_ + "sim_robot.yaml");
  EXPECT_EQ(params.pace, 1.0);
  EXPECT_EQ(params.sensors.laser.num_beams, 640);
  EXPECT_TRUE(params.scenario.empty());
  EXPECT_EQ(params.truth.name, "same");
  EXPECT_TRUE(params.tells_place);
}

TEST_F(SimRobotParamsTest, WhatMakesNoSenseIsNamed) {
  EXPECT_THAT(Refusal("pace: 1.0", "pace: -1.0"), HasSubstr("pace is '-1.0'"));
  EXPECT_THAT(Refusal("pace: 1.0", "speed: 1.0"), HasSubstr("pace"));
  EXPECT_THAT(Refusal("period: 0.5", "period: 0.12"), HasSubstr("multiple of 0.05 s"));
  EXPECT_THAT(Refusal("beams: 640", "beams: 1"), HasSubstr("laser.beams is '1'"));
  EXPECT_THAT(Refusal("hold: false", "hold: maybe"), HasSubstr("hold"));
  EXPECT_THAT(Refusal("truths/same.yaml", "truths/sane.yaml"), HasSubstr("truths/sane.yaml"));
}

}  // namespace
}  // namespace hires_ros::sim_robot_test
