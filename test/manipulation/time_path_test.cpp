#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/manipulation/arm_path.h"

namespace hires::manipulation::time_path_test {
namespace {

using robot::JointTrajectory;
using robot::TrajectoryPoint;
using ::testing::AllOf;
using ::testing::DoubleEq;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::SizeIs;

/// Joints j0, j1, ... with a velocity limit each, all with one acceleration limit.
robot::Robot RobotWith(const std::vector<double>& velocities, double acceleration) {
  robot::Robot robot;
  robot.model.name = "test";
  robot.model.links.push_back({"base", std::nullopt, std::nullopt, {}});
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    robot::Joint joint;
    joint.name = "j" + std::to_string(i);
    joint.type = robot::JointType::kRevolute;
    joint.parent = 0;
    joint.limits = robot::JointLimits{-10.0, 10.0, velocities[i], 1.0};
    robot.model.links.push_back({"link" + std::to_string(i), joint, std::nullopt, {}});
  }
  robot.profile.upper_body.emplace().default_acceleration = acceleration;
  return robot;
}

/// Time for `way` from rest to rest: up at full acceleration, on at full speed, down.
double TrapezoidTime(double way, double velocity, double acceleration) {
  const double ramp = velocity * velocity / acceleration;  // both ramps together
  return way < ramp ? 2.0 * std::sqrt(way / acceleration)
                    : way / velocity + velocity / acceleration;
}

/// Position, velocity and acceleration on the cubic between two points.
struct Moment {
  double position, velocity, acceleration;
};
Moment At(const TrajectoryPoint& a, const TrajectoryPoint& b, std::size_t joint, double t) {
  const double h = b.time - a.time, p0 = a.positions[joint], p1 = b.positions[joint];
  const double v0 = a.velocities[joint], v1 = b.velocities[joint];
  const double c2 = (3.0 * (p1 - p0) / h - 2.0 * v0 - v1) / h;
  const double c3 = (2.0 * (p0 - p1) / h + v0 + v1) / (h * h);
  return {p0 + t * (v0 + t * (c2 + t * c3)), v0 + t * (2.0 * c2 + 3.0 * t * c3),
          2.0 * c2 + 6.0 * t * c3};
}

void ExpectWithinLimits(const JointTrajectory& trajectory, const robot::Robot& robot,
                        double speed = 1.0) {
  const double acceleration = speed * speed * robot.profile.upper_body->default_acceleration;
  for (std::size_t i = 1; i < trajectory.points.size(); ++i) {
    const auto &a = trajectory.points[i - 1], &b = trajectory.points[i];
    ASSERT_GT(b.time, a.time);
    for (std::size_t j = 0; j < trajectory.joints.size(); ++j) {
      const double velocity = speed * robot.model.links[j + 1].joint->limits->velocity;
      for (int k = 0; k <= 20; ++k) {
        const Moment moment = At(a, b, j, (b.time - a.time) * k / 20);
        ASSERT_LE(std::abs(moment.velocity), velocity * (1.0 + 1e-9)) << "t = " << a.time;
        ASSERT_LE(std::abs(moment.acceleration), acceleration * (1.0 + 1e-9)) << "t = " << a.time;
      }
    }
  }
}

std::vector<std::vector<double>> RandomPath(int dimension, int points, base::Rng* rng) {
  std::vector<std::vector<double>> path;
  for (int i = 0; i < points; ++i) {
    path.emplace_back();
    for (int j = 0; j < dimension; ++j) path.back().push_back(rng->Uniform(-2.0, 2.0));
  }
  return path;
}

std::vector<std::string> Names(int dimension) {
  std::vector<std::string> names;
  for (int j = 0; j < dimension; ++j) names.push_back("j" + std::to_string(j));
  return names;
}

TEST(TimePathTest, OneJointTakesTheTimeOfTheTrapezoid) {
  for (const double way : {0.001, 0.05, 0.4, 1.0, 3.0}) {
    for (const double velocity : {0.5, 2.0}) {
      const robot::Robot robot = RobotWith({velocity}, 2.0);
      const JointTrajectory trajectory = TimePath(robot, {"j0"}, {{0.2}, {0.2 + way}});
      const double closed_form = TrapezoidTime(way, velocity, 2.0);
      EXPECT_GE(trajectory.duration(), closed_form * (1.0 - 1e-9));
      EXPECT_LE(trajectory.duration(), closed_form * 1.01) << way << " m at " << velocity;
      ExpectWithinLimits(trajectory, robot);
    }
  }
}

TEST(TimePathTest, TheSlowestJointSetsThePaceOfAStraightWay) {
  const robot::Robot robot = RobotWith({2.0, 0.5, 3.0}, 2.0);
  const auto trajectory = TimePath(robot, Names(3), {{0, 0, 0}, {1.0, -1.0, 1.0}});
  EXPECT_NEAR(trajectory.duration(), TrapezoidTime(1.0, 0.5, 2.0), 0.03);
  ExpectWithinLimits(trajectory, robot);
}

TEST(TimePathTest, LimitsHoldEverywhereOnRandomPaths) {
  base::Rng rng(1);
  const robot::Robot robot = RobotWith({2.088, 2.082, 3.27, 3.3, 3.6, 3.078, 3.6}, 2.0);
  for (int i = 0; i < 100; ++i) {
    const auto path = RandomPath(7, 2 + rng.Index(8), &rng);
    const double speed = rng.Uniform(0.2, 1.0);
    ExpectWithinLimits(TimePath(robot, Names(7), path, speed), robot, speed);
  }
}

TEST(TimePathTest, EndsAreExactAndStill) {
  base::Rng rng(2);
  const robot::Robot robot = RobotWith({1.0, 2.0}, 2.0);
  for (int i = 0; i < 20; ++i) {
    const auto path = RandomPath(2, 4, &rng);
    const auto points = TimePath(robot, Names(2), path).points;
    EXPECT_EQ(points.front().time, 0.0);
    EXPECT_EQ(points.front().positions, path.front());
    EXPECT_EQ(points.back().positions, path.back());
    EXPECT_THAT(points.front().velocities, Each(DoubleEq(0.0)));
    EXPECT_THAT(points.back().velocities, Each(DoubleEq(0.0)));
  }
}

TEST(TimePathTest, PointsAreNoFartherApartThanThePeriod) {
  const robot::Robot robot = RobotWith({0.013}, 0.1);
  const auto trajectory = TimePath(robot, {"j0"}, {{0.0}, {0.3}}, 1.0, 0.05);
  for (std::size_t i = 1; i < trajectory.points.size(); ++i) {
    // The last stretching of times may widen the gaps by what the limits ask for.
    EXPECT_LE(trajectory.points[i].time - trajectory.points[i - 1].time, 0.0505);
  }
}

TEST(TimePathTest, EveryPointOfThePathIsPassedWithinTheDeviation) {
  base::Rng rng(3);
  const robot::Robot robot = RobotWith({2.0, 3.0, 2.5}, 2.0);
  for (int i = 0; i < 20; ++i) {
    const auto path = RandomPath(3, 5, &rng);
    const auto points = TimePath(robot, Names(3), path).points;
    for (const auto& wanted : path) {
      double nearest = 1e9;
      for (std::size_t k = 1; k < points.size(); ++k) {
        for (int m = 0; m <= 50; ++m) {
          double largest = 0.0;
          for (std::size_t j = 0; j < 3; ++j) {
            const double t = (points[k].time - points[k - 1].time) * m / 50;
            const double p = At(points[k - 1], points[k], j, t).position;
            largest = std::max(largest, std::abs(p - wanted[j]));
          }
          nearest = std::min(nearest, largest);
        }
      }
      EXPECT_LE(nearest, 0.006);
    }
  }
}

TEST(TimePathTest, AGentleCornerIsNoStop) {
  const robot::Robot robot = RobotWith({1.0, 1.0}, 2.0);
  const double round = TimePath(robot, Names(2), {{0, 0}, {1, 0}, {2, 0.05}}).duration();
  const double straight = TrapezoidTime(2.0, 1.0, 2.0);
  EXPECT_LT(round, straight * 1.05);
}

TEST(TimePathTest, AReversalIsAStop) {
  const robot::Robot robot = RobotWith({1.0}, 2.0);
  const auto trajectory = TimePath(robot, {"j0"}, {{0.0}, {1.0}, {0.0}});
  EXPECT_NEAR(trajectory.duration(), 2.0 * TrapezoidTime(1.0, 1.0, 2.0), 0.03);
  ExpectWithinLimits(trajectory, robot);
  bool is_turning_point_there = false;
  for (const TrajectoryPoint& point : trajectory.points) {
    is_turning_point_there |=
        std::abs(point.positions[0] - 1.0) < 1e-9 && std::abs(point.velocities[0]) < 1e-9;
  }
  EXPECT_TRUE(is_turning_point_there);
}

TEST(TimePathTest, PointsOnALineChangeNothing) {
  const robot::Robot robot = RobotWith({1.0, 2.0}, 2.0);
  const double direct = TimePath(robot, Names(2), {{0, 0}, {1, 2}}).duration();
  const double dotted =
      TimePath(robot, Names(2), {{0, 0}, {0.25, 0.5}, {0.25, 0.5}, {0.5, 1.0}, {1, 2}}).duration();
  EXPECT_NEAR(dotted, direct, 0.02 * direct);
}

TEST(TimePathTest, HalfTheSpeedTakesTwiceTheTime) {
  base::Rng rng(4);
  const robot::Robot robot = RobotWith({1.0, 2.0, 1.5}, 2.0);
  const auto path = RandomPath(3, 4, &rng);
  const double full = TimePath(robot, Names(3), path, 1.0).duration();
  EXPECT_NEAR(TimePath(robot, Names(3), path, 0.5).duration(), 2.0 * full, 0.02 * full);
}

TEST(TimePathTest, StandingStillTakesNoTime) {
  const robot::Robot robot = RobotWith({1.0}, 2.0);
  const auto trajectory = TimePath(robot, {"j0"}, {{0.3}, {0.3}});
  EXPECT_THAT(trajectory.points, SizeIs(1));
  EXPECT_EQ(trajectory.duration(), 0.0);
}

/// A path that goes on in one direction, with bends.
std::vector<std::vector<double>> GentlePath(int points, base::Rng* rng) {
  std::vector<std::vector<double>> path{{0.0, 0.0, 0.0}};
  for (int i = 1; i < points; ++i) {
    path.push_back({0.5 * i, rng->Uniform(-0.1, 0.1), rng->Uniform(-0.1, 0.1)});
  }
  return path;
}

double StoppingTime(const robot::Robot& robot, const std::vector<std::vector<double>>& path) {
  double time = 0.0;
  for (std::size_t k = 1; k < path.size(); ++k) {
    time += TimePath(robot, Names(3), {path[k - 1], path[k]}).duration();
  }
  return time;
}

TEST(TimePathTest, GentleBendsTakeFarLessThanStopsAndSharpOnesNoMore) {
  base::Rng rng(5);
  const robot::Robot robot = RobotWith({2.0, 2.0, 2.0}, 2.0);
  for (int i = 0; i < 20; ++i) {
    const auto gentle = GentlePath(6, &rng), sharp = RandomPath(3, 6, &rng);
    EXPECT_LT(TimePath(robot, Names(3), gentle).duration(), 0.9 * StoppingTime(robot, gentle));
    EXPECT_LT(TimePath(robot, Names(3), sharp).duration(), 1.01 * StoppingTime(robot, sharp));
  }
}

TEST(TimePathErrorsTest, WhatIsMissingIsNamed) {
  robot::Robot robot = RobotWith({1.0}, 2.0);
  const auto error_of = [&](const std::string& joint) -> std::string {
    try {
      TimePath(robot, {joint}, {{0.0}, {1.0}});
    } catch (const base::ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(error_of("j1"), AllOf(HasSubstr("'j1'"), HasSubstr("j0")));
  robot.model.links[1].joint->limits->velocity = 0.0;
  EXPECT_THAT(error_of("j0"), AllOf(HasSubstr("'j0'"), HasSubstr("velocity")));
}

TEST(TimePathErrorsTest, BrokenPreconditionsAreTheCallersFault) {
  const robot::Robot robot = RobotWith({1.0}, 2.0);
  EXPECT_THROW(TimePath(robot, {"j0"}, {}), std::logic_error);
  EXPECT_THROW(TimePath(robot, {"j0"}, {{0.0, 1.0}}), std::logic_error);
  EXPECT_THROW(TimePath(robot, {"j0"}, {{0.0}, {1.0}}, 1.5), std::logic_error);
  EXPECT_THROW(TimePath(robot, {"j0"}, {{0.0}, {1.0}}, 1.0, 0.0), std::logic_error);
}

}  // namespace
}  // namespace hires::manipulation::time_path_test
