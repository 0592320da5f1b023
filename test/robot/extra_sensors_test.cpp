#include "hires/robot/extra_sensors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/robot/robot_profile.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::robot::extra_sensors_test {
namespace {

using test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kPr2 = HIRES_SOURCE_DIR "/config/robots/pr2.yaml";

const Robot& Pr2() {
  static const Robot robot = LoadRobot(kPr2);
  return robot;
}

TEST(PhaseAtTest, NodsEvenlyAndGoesBackFaster) {
  const TiltingLaser laser{"l", "j", 1.0, -1.0, 2.0, 0.5};
  EXPECT_DOUBLE_EQ(PhaseAt(laser, 0.0).angle, 1.0);
  EXPECT_DOUBLE_EQ(PhaseAt(laser, 0.5).angle, 0.5);
  EXPECT_DOUBLE_EQ(PhaseAt(laser, 2.0).angle, -1.0);
  EXPECT_TRUE(PhaseAt(laser, 2.0).is_sweeping);
  EXPECT_NEAR(PhaseAt(laser, 2.125).angle, -0.5, 1e-12);
  EXPECT_FALSE(PhaseAt(laser, 2.125).is_sweeping);
  EXPECT_EQ(PhaseAt(laser, 2.125).sweep, 0);
}

TEST(PhaseAtTest, EachSweepBeginsWhereTheFirstDid) {
  const TiltingLaser laser{"l", "j", 1.0, -1.0, 2.0, 0.5};
  for (long sweep = 0; sweep < 1000; ++sweep) {
    const TiltPhase phase = PhaseAt(laser, 2.5 * static_cast<double>(sweep));
    ASSERT_EQ(phase.sweep, sweep);
    ASSERT_TRUE(phase.is_sweeping);
    ASSERT_NEAR(phase.angle, 1.0, 1e-9);
  }
  EXPECT_THROW(PhaseAt(laser, -0.1), std::logic_error);
}

TEST(TiltingLaserTest, ThePr2sLaserLooksDownAtPositiveAngles) {
  const TiltingLaser& laser = *Pr2().profile.sensors.tilting_laser;
  EXPECT_EQ(ParentOf(Pr2().model, laser), "torso_lift_link");
  const geometry::Pose3 X_TL = X_ParentLaser(Pr2().model, laser, 0.5);
  const Eigen::Vector3d ahead = X_TL.rotation * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(ahead.z(), -std::sin(0.5), 1e-9);
  EXPECT_NEAR(ahead.x(), std::cos(0.5), 1e-9);
  // 0.03 m along the mount's z axis, which turns with it.
  EXPECT_NEAR(X_TL.translation.x(), 0.09893 + 0.03 * std::sin(0.5), 1e-9);
  EXPECT_NEAR(X_TL.translation.z(), 0.227 + 0.03 * std::cos(0.5), 1e-9);
}

/// The PR2 of its file with one text in another's place.
Robot LoadAfter(const std::string& from, const std::string& to) {
  std::string text = base::ReadTextFile(kPr2);
  const auto replace = [&text](const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    if (at == std::string::npos) throw std::logic_error("pr2.yaml has no " + what);
    text.replace(at, what.size(), by);
  };
  replace(from, to);
  const test_support::TemporaryFolder folder;
  const auto root = std::filesystem::relative("/", folder.path()).string();
  replace("../../urdf", root + HIRES_SOURCE_DIR "/urdf");
  return LoadRobot(folder.Write("robot.yaml", text));
}

std::string ErrorAfter(const std::string& from, const std::string& to) {
  return ConfigErrorOf([&] { LoadAfter(from, to); });
}

TEST(ExtraSensorsFile, WhatTheRobotDoesNotHaveIsNamed) {
  EXPECT_THAT(ErrorAfter("thermal_camera: thermal_cam_frame", "thermal_camera: thermal_cam"),
              AllOf(HasSubstr("sensors.thermal_camera"), HasSubstr("thermal_cam_frame")));
  EXPECT_THAT(ErrorAfter("tray_laser: base_tray_laser_link", "tray_laser: tray_laser"),
              HasSubstr("sensors.tray_laser"));
  EXPECT_THAT(ErrorAfter("inertial_unit: imu_link", "inertial_unit: imu"),
              HasSubstr("sensors.inertial_unit"));
  EXPECT_THAT(ErrorAfter("joint: laser_tilt_mount_joint", "joint: laser_tilt_joint"),
              AllOf(HasSubstr("sensors.tilting_laser.joint"), HasSubstr("turns")));
  EXPECT_THAT(ErrorAfter("joint: laser_tilt_mount_joint", "joint: head_tilt_joint"),
              HasSubstr("does not carry link 'laser_tilt_link'"));
}

TEST(ExtraSensorsFile, ASweepBeyondTheJointsLimitsIsRefused) {
  EXPECT_THAT(ErrorAfter("to: -0.7 ", "to: -0.8 "),
              AllOf(HasSubstr("sensors.tilting_laser.to"), HasSubstr("-0.7854")));
  EXPECT_THAT(ErrorAfter("to: -0.7 ", "to: 1.05 "), HasSubstr("another angle"));
  EXPECT_THAT(ErrorAfter("sweep_time: 1.8", "sweep_time: 0"), HasSubstr("sweep_time"));
  EXPECT_THAT(ErrorAfter("sweep_time: 1.8", "sweep: 1.8"), HasSubstr("sweep_time"));
}

TEST(ExtraSensorsFile, DoNotChangeWhatRolloutsRestOn) {
  const Robot without = LoadAfter("tray_laser: base_tray_laser_link", "tray_laser: \"\"");
  EXPECT_EQ(without.profile.sensors.tray_laser_link, "");
  EXPECT_EQ(Pr2().profile.sensors.tray_laser_link, "base_tray_laser_link");
  EXPECT_EQ(Pr2().profile.sensors.inertial_unit_link, "imu_link");
  EXPECT_EQ(without.hash(), Pr2().hash());
}

}  // namespace
}  // namespace hires::robot::extra_sensors_test
