#include "hires/ros/robot/controller_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace hires_ros::controller_messages_test {
namespace {

using ::testing::HasSubstr;

template <typename Message>
std::string Bytes(const Message& message) {
  const ros::SerializedMessage out = ros::serialization::serializeMessage(message);
  return {out.message_start, out.message_start + (out.num_bytes - 4)};
}

template <typename Message>
Message Again(std::string bytes) {
  Message message;
  ros::serialization::IStream in(reinterpret_cast<uint8_t*>(bytes.data()),
                                 static_cast<uint32_t>(bytes.size()));
  ros::serialization::deserialize(in, message);
  EXPECT_EQ(in.getLength(), 0u);
  return message;
}

std::string Number(double value) { return {reinterpret_cast<const char*>(&value), sizeof(value)}; }

TEST(ControllerMessagesTest, AGripperCommandIsLaidOutAsPublished) {
  GripperCommandActionGoal goal;
  goal.position = 0.07;
  goal.max_effort = 40.0;
  // Header: seq, stamp, frame's length; goal id: stamp, id's length. All empty.
  EXPECT_EQ(Bytes(goal),
            std::string(16, '\0') + std::string(12, '\0') + Number(0.07) + Number(40.0));
  const auto again = Again<GripperCommandActionGoal>(Bytes(goal));
  EXPECT_EQ(again.position, 0.07);
  EXPECT_EQ(again.max_effort, 40.0);
}

TEST(ControllerMessagesTest, ATrajectoryComesBackWithItsTolerances) {
  FollowJointTrajectoryActionGoal goal;
  goal.goal_id.id = "goal 1";
  goal.trajectory.joint_names = {"elbow"};
  goal.trajectory.points.resize(2);
  goal.trajectory.points[1].positions = {0.5};
  goal.trajectory.points[1].time_from_start = ros::Duration(2.5);
  goal.path_tolerance = {{"elbow", 0.1, 0.2, 0.3}};
  goal.goal_time_tolerance = ros::Duration(0.5);
  const auto again = Again<FollowJointTrajectoryActionGoal>(Bytes(goal));
  EXPECT_EQ(again.goal_id.id, "goal 1");
  EXPECT_EQ(again.trajectory.points[1].positions, std::vector<double>{0.5});
  EXPECT_EQ(again.trajectory.points[1].time_from_start, ros::Duration(2.5));
  ASSERT_EQ(again.path_tolerance.size(), 1u);
  EXPECT_EQ(again.path_tolerance[0].name, "elbow");
  EXPECT_EQ(again.path_tolerance[0].acceleration, 0.3);
  EXPECT_TRUE(again.goal_tolerance.empty());
  EXPECT_EQ(again.goal_time_tolerance, ros::Duration(0.5));
}

TEST(ControllerMessagesTest, DefinitionsTellEveryPart) {
  const std::string trajectory = ros::message_traits::definition<FollowJointTrajectoryActionGoal>();
  for (const char* type :
       {"MSG: control_msgs/FollowJointTrajectoryGoal\n", "MSG: control_msgs/JointTolerance\n",
        "MSG: trajectory_msgs/JointTrajectory\n", "MSG: trajectory_msgs/JointTrajectoryPoint\n",
        "MSG: actionlib_msgs/GoalID\n", "MSG: std_msgs/Header\n"}) {
    EXPECT_THAT(trajectory, HasSubstr(type));
  }
  EXPECT_THAT(ros::message_traits::definition<GripperCommandActionGoal>(),
              HasSubstr("MSG: control_msgs/GripperCommand\nfloat64 position"));
}

}  // namespace
}  // namespace hires_ros::controller_messages_test
