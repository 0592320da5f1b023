#include "hires/control/stop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "hires/base/rng.h"
#include "hires/robot/load_robot.h"
#include "support/scenes.h"

namespace hires::control::stop_test {
namespace {

using geometry::Twist2;

constexpr double kCycle = 0.02;  // [s]

double LinearSpeed(const Twist2& V) { return std::hypot(V.vx, V.vy); }

/// What a base that does as it is told is commanded until it counts as stopped.
std::vector<Twist2> CommandsFrom(const Twist2& V_begin, const StopParams& params) {
  const robot::Robot robot = hires::test_support::TrayRobot();
  Stop stop(robot, {"base"}, params);
  robot::Observation seen;
  seen.V_B = V_begin;
  std::vector<Twist2> commands;
  for (int cycle = 0; cycle < 1000 && !stop.is_over(); ++cycle) {
    commands.push_back(stop.Update(7.0 + cycle * kCycle, seen).base_velocity.value());
    seen.V_B = commands.back();
  }
  EXPECT_TRUE(stop.is_over());
  return commands;
}

/// [m/s^2], [rad/s^2] at most between two commands.
Twist2 LargestChange(const std::vector<Twist2>& commands) {
  Twist2 most;
  for (std::size_t i = 1; i < commands.size(); ++i) {
    const Twist2 &a = commands[i - 1], &b = commands[i];
    most.vx = std::max(most.vx, std::hypot(b.vx - a.vx, b.vy - a.vy) / kCycle);
    most.wz = std::max(most.wz, std::abs(b.wz - a.wz) / kCycle);
  }
  return most;
}

// In closed form: all components become zero together, along a line, at the first moment at which
// neither deceleration is more than its limit.
TEST(StopTest, TheBaseComesToRestAlongALineWhereverItDrivesAndTurns) {
  const StopParams params;
  base::Rng rng(1);
  for (int round = 0; round < 300; ++round) {
    Twist2 V{rng.Uniform(-1.0, 1.0), rng.Uniform(-1.0, 1.0), rng.Uniform(-2.0, 2.0)};
    if (round % 3 == 0) V.vx = V.vy = 0.0;  // turns on the spot
    if (round % 3 == 1) V.wz = 0.0;
    const std::vector<Twist2> commands = CommandsFrom(V, params);
    const double needed = std::max(LinearSpeed(V) / params.linear_deceleration,
                                   std::abs(V.wz) / params.angular_deceleration);
    const Twist2 change = LargestChange(commands);
    EXPECT_LE(change.vx, params.linear_deceleration + 1e-9) << V.vx << ' ' << V.vy << ' ' << V.wz;
    EXPECT_LE(change.wz, params.angular_deceleration + 1e-9) << V.vx << ' ' << V.vy << ' ' << V.wz;
    const std::size_t middle = static_cast<std::size_t>(needed / 2.0 / kCycle);
    ASSERT_LT(middle, commands.size());
    const double share = 1.0 - static_cast<double>(middle) * kCycle / needed;
    EXPECT_NEAR(commands[middle].vx, share * V.vx, 1e-9);
    EXPECT_NEAR(commands[middle].vy, share * V.vy, 1e-9);
    EXPECT_NEAR(commands[middle].wz, share * V.wz, 1e-9);
    EXPECT_LE(static_cast<double>(commands.size()) * kCycle, needed + 3.0 * kCycle);
  }
}

TEST(StopTest, ABaseThatDoesNotObeyIsGivenUpAfterPatience) {
  StopParams params;
  params.patience = 0.5;
  const robot::Robot robot = hires::test_support::TrayRobot();
  Stop stop(robot, {"base"}, params);
  robot::Observation seen;
  seen.V_B.wz = -1.0;
  for (const double time : {0.0, 0.3, 0.5}) {
    stop.Update(time, seen);
    EXPECT_FALSE(stop.is_over()) << time;
  }
  stop.Update(0.6, seen);
  EXPECT_TRUE(stop.is_over());
}

class StoppedArmTest : public testing::Test {
 protected:
  /// The way [rad] that a joint goes from `position` at `velocity`, and how long it takes.
  struct Halt {
    double way, duration;
  };
  Halt HaltOf(const std::string& joint, double position, double velocity) const {
    Stop stop(robot_, {"leftarm1"}, {});
    robot::Observation seen;
    for (const std::string& name : robot_.profile.upper_body->arms.at("leftarm1").joints) {
      seen.joints[name] = 0.0;
      seen.joint_velocities[name] = 0.0;
    }
    seen.joints[joint] = position;
    seen.joint_velocities[joint] = velocity;
    const robot::Command command = stop.Update(0.0, seen);
    EXPECT_FALSE(command.base_velocity);
    const robot::JointTrajectory& halt = command.trajectories.at("leftarm1");
    const auto at = std::find(halt.joints.begin(), halt.joints.end(), joint) - halt.joints.begin();
    EXPECT_EQ(halt.points.size(), 1U);
    EXPECT_EQ(halt.points[0].velocities.at(at), 0.0);
    return {halt.points[0].positions.at(at) - position, halt.points[0].time};
  }

  const robot::Robot robot_ = robot::LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml");
};

// v^2 / 2a, to either side.
TEST_F(StoppedArmTest, AJointStopsWithinItsAcceleration) {
  const std::string joint = "l_shoulder_pan_joint";
  const double acceleration = robot::AccelerationOf(*robot_.profile.upper_body, joint);
  const double fast = 0.5 * acceleration;  // takes longer than the shortest halt
  for (const double velocity : {fast, -fast}) {
    const Halt halt = HaltOf(joint, 0.5, velocity);
    EXPECT_NEAR(halt.duration, 0.5, 1e-9);
    EXPECT_NEAR(halt.way, 0.5 * velocity * 0.5, 1e-9);
  }
}

TEST_F(StoppedArmTest, AJointStopsAtItsLimitAtTheLatest) {
  const std::string joint = "l_elbow_flex_joint";
  const auto link =
      std::find_if(robot_.model.links.begin(), robot_.model.links.end(),
                   [&](const robot::Link& one) { return one.joint && one.joint->name == joint; });
  ASSERT_NE(link, robot_.model.links.end());
  EXPECT_NEAR(HaltOf(joint, link->joint->limits->upper - 0.001, 1.0).way, 0.001, 1e-9);
  EXPECT_NEAR(HaltOf(joint, link->joint->limits->lower + 0.001, -1.0).way, -0.001, 1e-9);
}

}  // namespace
}  // namespace hires::control::stop_test
