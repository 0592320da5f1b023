#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "nodes/hires/data_port.h"
#include "nodes/hires/message_types.h"

namespace hires_ros::robot_questions_test {
namespace {

TEST(AskDataPortTest, ADeafNodeHasNone) {
  const int server = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in where{};
  where.sin_family = AF_INET;
  inet_pton(AF_INET, "127.0.0.1", &where.sin_addr);
  socklen_t size = sizeof(where);
  ASSERT_EQ(bind(server, reinterpret_cast<sockaddr*>(&where), size), 0);
  ASSERT_EQ(getsockname(server, reinterpret_cast<sockaddr*>(&where), &size), 0);
  ASSERT_EQ(listen(server, 5), 0);
  EXPECT_EQ(AskDataPort({"127.0.0.1", ntohs(where.sin_port)}, "/x", "/test", 0.1), std::nullopt);
  close(server);
}

TEST(MessageTypesTest, TheyAreThoseOfThePr2) {
  const hires::cli::RobotMessageTypes types = MessageTypesOfRobot();
  EXPECT_EQ(types.odometry.name, "nav_msgs/Odometry");
  EXPECT_EQ(types.odometry.md5, "cd5e73d190d741a2f92e81eda573aca7");
  EXPECT_TRUE(types.odometry.has_header);
  EXPECT_EQ(types.joint_states.name, "sensor_msgs/JointState");
  EXPECT_EQ(types.scan.name, "sensor_msgs/LaserScan");
  EXPECT_EQ(types.localisation.name, "geometry_msgs/PoseWithCovarianceStamped");
  EXPECT_EQ(types.motors_halted.name, "std_msgs/Bool");
  EXPECT_FALSE(types.motors_halted.has_header);
  EXPECT_EQ(types.map.name, "nav_msgs/OccupancyGrid");
  EXPECT_EQ(types.base_command.name, "geometry_msgs/Twist");
  EXPECT_EQ(types.trajectory.name, "trajectory_msgs/JointTrajectory");
  EXPECT_EQ(types.gripper.name, "pr2_controllers_msgs/Pr2GripperCommand");
}

TEST(MessageTypesTest, ControllersThatAreActionsAreLedByGoalsOfControlMsgs) {
  const hires::cli::RobotMessageTypes types = MessageTypesOfRobot();
  EXPECT_EQ(types.trajectory_goal.name, "control_msgs/FollowJointTrajectoryActionGoal");
  EXPECT_EQ(types.trajectory_goal.md5, "cff5c1d533bf2f82dd0138d57f4304bb");
  EXPECT_EQ(types.gripper_goal.name, "control_msgs/GripperCommandActionGoal");
  EXPECT_EQ(types.gripper_goal.md5, "aa581f648a35ed681db2ec0bf7a82bea");
}

}  // namespace
}  // namespace hires_ros::robot_questions_test
