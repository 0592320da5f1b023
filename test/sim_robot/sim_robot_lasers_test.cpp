#include "sim_robot/sim_robot_lasers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim_robot/sensor_scenes.h"
#include "sim_robot/sim_robot_sensors.h"

namespace hires::sim_robot::sim_robot_lasers_test {
namespace {

using geometry::Pose3;
using hires::test_support::PlateSetup;
using hires::test_support::PlateStart;

constexpr int kScansOfASweep = 72;  // 1.8 s at 40 Hz

SimRobotLasers LasersIn(const SimRobotWorld& world) {
  SimSensorParams params;
  DropNoise(&params);
  params.lasers.tilting.sees_robot = params.lasers.tray.sees_robot = true;
  params.lasers.tilting.angle_min = -1.3963;
  params.lasers.tilting.angle_max = 1.3963;
  return {params.lasers, base::Rng(1), world.scene()};
}

/// The cloud of a sweep, the first scan of which is the `first`-th, while the robot drives ahead.
std::optional<perception::PointCloud> Swept(int first, double speed) {
  SimRobotWorld world(PlateSetup(), PlateStart(), 1);
  const SimRobotLasers lasers = LasersIn(world);
  SweepCloud sweep(kScansOfASweep);
  SensorReadings readings = world.Sense();
  for (int scan = 0; scan < 80; ++scan) {
    if (world.milliseconds() % 100 == 0) {
      robot::Command command;
      command.base_velocity = geometry::Twist2{speed, 0.0, 0.0};
      world.Apply(command);
    }
    if (world.milliseconds() % kSensorTick == 0) readings = world.Sense();
    if (scan >= first) {
      auto cloud = sweep.Add(lasers.TiltPhase(world), lasers.tilting(), lasers.TiltScan(world),
                             lasers.X_OTilt(world, readings));
      if (cloud) return cloud;
    }
    world.Advance(25);
  }
  return std::nullopt;
}

TEST(SimRobotLasersTest, TheTraysLaserSeesWhatStandsOnTheTray) {
  const SimRobotWorld world(PlateSetup(), PlateStart(), 1);
  const SimRobotLasers lasers = LasersIn(world);
  ASSERT_TRUE(lasers.has_tray_laser());
  const Pose3 X_ML = world.simulator().X_MLink("base_tray_laser_link");
  const Pose3 X_MO = world.simulator().GetWorldState().Find("mill1")->X_MO;
  const double nearest = (X_MO.translation - X_ML.translation).head<2>().norm() - 0.037;
  const auto scan = lasers.TrayScan(world);
  EXPECT_NEAR(*std::min_element(scan.begin(), scan.end()), nearest, 2e-3);
}

TEST(SimRobotLasersTest, TheNoddingLaserMeetsTheFloorWhereItsAngleSays) {
  SimRobotWorld world(PlateSetup(), PlateStart(), 1);
  const SimRobotLasers lasers = LasersIn(world);
  world.Advance(575);  // 1.05 - 1.75 * 0.575 / 1.8
  const double angle = lasers.TiltPhase(world).angle;
  EXPECT_NEAR(angle, 0.49097, 1e-5);
  const auto scan = lasers.TiltScan(world);
  const double height = lasers.X_OTilt(world, world.Sense()).translation.z();
  EXPECT_GT(height, 1.0);
  EXPECT_NEAR(scan[scan.size() / 2], height / std::sin(angle), 5e-3);
}

TEST(SimRobotLasersTest, ScansAreDueFortyTimesASecond) {
  SimRobotWorld world(PlateSetup(), PlateStart(), 1);
  simulation::TruthRecord truth{{}};
  const SimRobotLasers lasers = LasersIn(world);
  int num_due = 0;
  for (int tick = 0; tick < 100; ++tick) {  // 1 s
    PlayJointTick(&world, &truth, [&] { num_due += lasers.IsTiltDue(world) ? 1 : 0; });
  }
  EXPECT_EQ(num_due, 40);
}

/// Also while the robot drives: each scan is put where it was taken.
TEST(SweepCloudTest, WallAndFloorArePlanes) {
  for (const double speed : {0.0, 0.3}) {
    const auto cloud = Swept(0, speed);
    ASSERT_TRUE(cloud) << speed;
    EXPECT_EQ(cloud->width, static_cast<int>(cloud->points.size()));
    EXPECT_EQ(cloud->height, 1);
    int on_floor = 0, on_wall = 0, wrong = 0;
    for (const Eigen::Vector3f& p_O : cloud->points) {
      on_floor += std::abs(p_O.z()) < 0.02F ? 1 : 0;
      on_wall += std::abs(p_O.x() - 3.0F) < 0.02F ? 1 : 0;
      wrong += p_O.z() < -0.02F || (p_O.x() > 3.02F && std::abs(p_O.y()) < 3.9F) ? 1 : 0;
    }
    EXPECT_GT(on_floor, 3000) << speed;
    EXPECT_GT(on_wall, 3000) << speed;
    EXPECT_EQ(wrong, 0) << speed;
  }
}

TEST(SweepCloudTest, ASweepThatWasNotSeenWholeGivesNoCloud) {
  EXPECT_TRUE(Swept(0, 0.0));
  EXPECT_FALSE(Swept(3, 0.0));
}

// Between an edge and the wall behind it a beam that meets both measures neither.
TEST(SweepCloudTest, PointsThatVeilAnEdgeAreLeftOut) {
  SweepCloud sweep(1);
  simulation::LaserParams laser;
  laser.num_beams = 101;
  laser.angle_min = -0.22;
  laser.angle_max = 0.22;
  std::vector<double> ranges(101, 2.0);
  std::fill(ranges.begin(), ranges.begin() + 50, 1.0);
  ranges[50] = 1.25;
  ranges[51] = 1.75;
  sweep.Add({0.0, 0, true}, laser, ranges, {});
  const auto cloud = sweep.Add({0.0, 0, false}, laser, ranges, {});
  ASSERT_TRUE(cloud);
  int near = 0, far = 0;
  for (const Eigen::Vector3f& p : cloud->points) {
    const float range = p.norm();
    near += std::abs(range - 1.0F) < 1e-5F ? 1 : 0;
    far += std::abs(range - 2.0F) < 1e-5F ? 1 : 0;
  }
  EXPECT_EQ(near, 50) << "the edge itself stays";
  EXPECT_GE(far, 25);
  EXPECT_EQ(near + far, static_cast<int>(cloud->points.size()));
}

TEST(SweepCloudTest, EachSweepBeginsAnew) {
  SweepCloud sweep(2);
  simulation::LaserParams laser;
  laser.num_beams = 2;
  const std::vector<double> ranges{1.0, INFINITY};
  const auto add = [&](long number, bool is_sweeping) {
    return sweep.Add({0.0, number, is_sweeping}, laser, ranges, {});
  };
  EXPECT_FALSE(add(0, true));
  EXPECT_FALSE(add(1, true)) << "of the first sweep nothing is left";
  EXPECT_FALSE(add(1, true));
  const auto cloud = add(1, false);
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->points.size(), 2u) << "beams that met nothing are left out";
  EXPECT_FALSE(add(1, false)) << "it is handed out once";
}

}  // namespace
}  // namespace hires::sim_robot::sim_robot_lasers_test
