#include "hires/sensing/drive_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "hires/geometry/angles.h"
#include "support/fake_frame_tree.h"
#include "support/messages.h"
#include "support/simulated_drive.h"

namespace hires::sensing::drive_builder_test {
namespace {

using geometry::Pose2;
using geometry::Pose3;
using localisation::RobotLog;
using test_support::ConfigErrorOf;
using test_support::FakeFrameTree;
using testing::AllOf;
using testing::HasSubstr;

const robot::ScanReading kScan{-1.0, 0.5, 0.02, {3.0F, 3.1F, 3.2F, 3.3F, 3.4F}, 30.0};

Pose3 At(double x) { return {{x, 0.0, 0.3}, Eigen::Quaterniond::Identity()}; }

void TellOdometry(DriveBuilder* builder) {
  for (const double time : {10.0, 11.0, 12.0, 13.0})
    builder->OnOdometry(time, "base_link", {{time - 10.0, 0.0, 0.0}, {}});
}

TEST(DriveBuilderTest, ScanWaitsUntilTheLasersPlaceAtItsStampIsKnown) {
  FakeFrameTree tree;
  DriveBuilder builder("a.bag", {}, false, tree);
  TellOdometry(&builder);
  builder.OnScan(11.5, "/laser", kScan);
  tree.Tell("base_link", "laser", 11.0, At(0.1));
  builder.OnTransforms();
  tree.Tell("base_link", "laser", 12.0, At(0.2));
  builder.OnTransforms();
  tree.Tell("base_link", "laser", 12.5, At(0.3));
  builder.OnTransforms();
  const RobotLog log = builder.Take();
  ASSERT_EQ(log.scans.size(), 1u);
  EXPECT_EQ(log.scans[0].X_BL.x, 0.1) << "the fake tree holds what it was told until it is told";
  EXPECT_EQ(log.scans[0].time, 11.5);
  EXPECT_EQ(log.odometry.size(), 4u);
}

TEST(DriveBuilderTest, ScanThatComesBeforeAllThatIsKnownOfItsLaserIsLeftOut) {
  FakeFrameTree tree;
  DriveBuilder builder("a.bag", {}, false, tree);
  TellOdometry(&builder);
  builder.OnScan(10.5, "laser", kScan);
  tree.Tell("base_link", "laser", 11.0, At(0.1));
  builder.OnTransforms();
  EXPECT_THAT(ConfigErrorOf([&] { builder.Take(); }),
              HasSubstr("left out: 1 scans of a laser whose place in the base is not known then"));
}

TEST(DriveBuilderTest, ScanInTheBasesOwnFrameNeedsNoTransforms) {
  const FakeFrameTree tree;
  DriveBuilder builder("a.bag", {}, false, tree);
  TellOdometry(&builder);
  builder.OnScan(10.5, "base_link", kScan);
  EXPECT_EQ(builder.Take().scans[0].X_BL.x, 0.0);
}

TEST(DriveBuilderTest, ScanOfAnUnknownFrameHoldsUpNoOther) {
  const FakeFrameTree tree;
  DriveBuilder builder("a.bag", {}, false, tree);
  TellOdometry(&builder);
  builder.OnScan(10.5, "nowhere", kScan);
  builder.OnScan(10.6, "base_link", kScan);
  EXPECT_EQ(builder.Take().scans.size(), 1u);
}

TEST(DriveBuilderTest, OdometryOfTransformsIsReadInTheFramesThatAreConnected) {
  FakeFrameTree tree;
  tree.TellFixed("base_footprint", "laser", At(0.3));
  DriveBuilder builder("a.bag", {}, true, tree);
  for (const double time : {10.0, 11.0, 12.0}) {
    tree.Tell("odom_combined", "base_footprint", time, At(time));
    builder.OnTransforms();
    builder.OnTransforms();
    builder.OnScan(time, "laser", kScan);
  }
  const RobotLog log = builder.Take();
  ASSERT_EQ(log.odometry.size(), 3u) << "each moment once";
  EXPECT_EQ(log.odometry[1].time, 11.0);
  EXPECT_EQ(log.odometry[1].reading.X_OB.x, 11.0);
  EXPECT_EQ(log.scans[2].X_BL.x, 0.3);
}

TEST(DriveBuilderTest, NothingAtAllIsAnError) {
  const FakeFrameTree tree;
  DriveBuilder heard("a.bag", {}, false, tree);
  EXPECT_THAT(ConfigErrorOf([&] { heard.Take(); }),
              HasSubstr("a.bag: no reading of its odometry can be used"));
  DriveBuilder seen("a.bag", {}, true, tree);
  EXPECT_THAT(ConfigErrorOf([&] { seen.Take(); }),
              AllOf(HasSubstr("a.bag: has no odometry"), HasSubstr("--odometry-frame")));
}

TEST(DriveBuilderTest, RangesThatAreNoLimitsAreTakenAsUnsaid) {
  const FakeFrameTree tree;
  DriveBuilder builder("a.bag", {}, false, tree);
  TellOdometry(&builder);
  robot::ScanReading scan = kScan;
  scan.range_min = scan.range_max = std::numeric_limits<double>::quiet_NaN();
  builder.OnScan(10.5, "base_link", scan);
  const RobotLog log = builder.Take();
  EXPECT_EQ(log.scans[0].reading.range_min, 0.0);
  EXPECT_EQ(log.scans[0].reading.range_max, 0.0);
}

/// Drivers that say 3.5 m where nothing is met, and 30 m or infinity as range_max: else the map has
/// walls that go along with the robot.
TEST(DriveBuilderTest, WhatStandsForNothingIsKnownByItsFrequency) {
  test_support::SimulatedDriveParams params;
  params.range_max = 3.5;
  const RobotLog drive =
      test_support::DriveThrough(test_support::RoomsWithShelf(),
                                 test_support::CourseThroughTwoRooms(), params, base::Rng(3))
          .log;
  for (const double said : {0.0, 30.0, std::numeric_limits<double>::infinity()}) {
    const FakeFrameTree tree;
    DriveBuilder builder("a.bag", {}, false, tree);
    for (const RobotLog::Odometry& odometry : drive.odometry)
      builder.OnOdometry(10.0 + odometry.time, "base_link", odometry.reading);
    for (const RobotLog::Scan& scan : drive.scans) {
      robot::ScanReading reading = scan.reading;
      reading.range_max = said;
      builder.OnScan(10.0 + scan.time, "base_link", reading);
    }
    testing::internal::CaptureStderr();
    const RobotLog log = builder.Take();
    EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("3.5 m is the largest range"));
    ASSERT_GT(log.scans.size(), 100u);
    for (const RobotLog::Scan& scan : log.scans) ASSERT_EQ(scan.reading.range_max, 3.5) << said;
  }
}

// ---------------------------------------------------------------- inertial units

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const UnitReading kRate{{}, {0.0, 0.0, 0.5}};

/// A drive with a scan; units hang in the base as the tree says.
RobotLog LogWith(const std::function<void(DriveBuilder*)>& tell, const FrameTree& tree) {
  DriveBuilder builder("a.bag", {}, false, tree);
  TellOdometry(&builder);
  builder.OnScan(10.5, "base_link", kScan);
  tell(&builder);
  return builder.Take();
}

/// What is said on standard error, too.
std::string WarningsOf(const std::function<void(DriveBuilder*)>& tell, const FrameTree& tree,
                       std::size_t left) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(LogWith(tell, tree).inertia.size(), left);
  return testing::internal::GetCapturedStderr();
}

TEST(DriveBuilderTest, RateOfAUnitIsTurnedIntoTheBase) {
  FakeFrameTree tree;
  const auto mount = [&](const std::string& frame, double roll, double pitch, double yaw) {
    tree.TellFixed("base_link", frame,
                   {{0.1, 0.0, 0.4}, geometry::RotationFromRpy(roll, pitch, yaw)});
  };
  mount("level", 0.0, 0.0, 1.0);
  mount("upside_down", geometry::kPi, 0.0, 0.3);
  mount("on_its_side", geometry::kPi / 2.0, 0.0,
        0.0);  // its z is the base's -y, its y the base's z
  const RobotLog log = LogWith(
      [](DriveBuilder* builder) {
        builder->OnInertia(11.0, "/level", {{}, {0.1, 0.2, 0.5}});
        builder->OnInertia(11.1, "upside_down", {{}, {0.1, 0.2, -0.5}});
        builder->OnInertia(11.2, "on_its_side", {{}, {0.1, 0.5, 0.2}});
        builder->OnInertia(11.3, "base_link", {{}, {0.1, 0.2, 0.5}});
      },
      tree);
  ASSERT_EQ(log.inertia.size(), 4u);
  for (const RobotLog::Inertia& inertia : log.inertia) {
    EXPECT_NEAR(inertia.yaw_rate, 0.5, 1e-9) << inertia.time;
    EXPECT_FALSE(inertia.yaw);
  }
}

TEST(DriveBuilderTest, OrientationOfAUnitIsTurnedIntoTheBase) {
  FakeFrameTree tree;
  const Eigen::Quaterniond R_BI = geometry::RotationFromRpy(geometry::kPi, 0.0, 0.3);
  tree.TellFixed("base_link", "imu", {{0.0, 0.0, 0.4}, R_BI});
  const Eigen::Quaterniond R_WB = geometry::RotationFromRpy(0.0, 0.0, 1.2);
  const RobotLog log = LogWith(
      [&](DriveBuilder* builder) {
        builder->OnInertia(11.0, "imu", {R_WB * R_BI, {kNan, kNan, kNan}});
      },
      tree);
  ASSERT_EQ(log.inertia.size(), 1u);
  EXPECT_NEAR(log.inertia[0].yaw.value(), 1.2, 1e-9);
}

TEST(DriveBuilderTest, MountOfAUnitMayBeToldLate) {
  FakeFrameTree tree;
  const RobotLog log = LogWith(
      [&](DriveBuilder* builder) {
        builder->OnInertia(11.0, "imu", kRate);
        tree.Tell("base_link", "imu", 12.0, At(0.1));
        builder->OnInertia(13.0, "imu", kRate);
      },
      tree);
  EXPECT_EQ(log.inertia.size(), 2u);
}

TEST(DriveBuilderTest, UnitOfWhichTheTransformsTellNothingIsLeftOut) {
  FakeFrameTree tree;
  tree.TellFixed("torso", "imu", At(0.1));
  const std::string said = WarningsOf(
      [](DriveBuilder* builder) {
        builder->OnInertia(11.0, "imu", kRate);
        builder->OnInertia(11.1, "nowhere", kRate);
        builder->OnInertia(11.2, "", kRate);
      },
      tree, 0);
  EXPECT_THAT(said, HasSubstr("a.bag: left out 3 readings of an inertial unit whose place in the "
                              "base is not known"));
}

TEST(DriveBuilderTest, BrokenReadingsOfAUnitAreLeftOut) {
  const FakeFrameTree tree;
  const std::string said = WarningsOf(
      [](DriveBuilder* builder) {
        builder->OnInertia(0.0, "base_link", kRate);
        builder->OnInertia(kNan, "base_link", kRate);
        builder->OnInertia(11.0, "base_link", {{}, {0.0, 0.0, kNan}});
        builder->OnInertia(11.0, "base_link", {{}, {0.0, 0.0, 1e3}});
        builder->OnInertia(11.0, "base_link", {Eigen::Quaterniond(kNan, 0.0, 0.0, 0.0)});
        builder->OnInertia(11.0, "base_link", kRate);
        builder->OnInertia(11.0, "base_link", kRate);
      },
      tree, 1);
  EXPECT_THAT(
      said, AllOf(HasSubstr("left out 2 readings of the inertial unit whose header.stamp is zero"),
                  HasSubstr("left out 3 readings of the inertial unit that are no numbers "
                            "within 100 rad/s"),
                  HasSubstr("left out 1 readings with the stamp of another one")));
}

TEST(DriveBuilderTest, ReadingsOfAUnitThatComeLateArePutInOrder) {
  const FakeFrameTree tree;
  const RobotLog log = LogWith(
      [](DriveBuilder* builder) {
        for (const double time : {11.0, 11.9, 11.2})
          builder->OnInertia(time, "base_link", {{}, {0.0, 0.0, 0.01 * time}});
      },
      tree);
  ASSERT_EQ(log.inertia.size(), 3u);
  EXPECT_EQ(log.inertia[1].time, 11.2);
  EXPECT_NEAR(log.inertia[1].yaw_rate, 0.112, 1e-9);
}

TEST(DriveBuilderTest, TimeOfAUnitThatJumpsBackIsRefused) {
  const FakeFrameTree tree;
  DriveBuilder builder("a.bag", {}, false, tree);
  builder.OnInertia(11.0, "imu", kRate);
  EXPECT_THAT(ConfigErrorOf([&] { builder.OnInertia(9.5, "imu", kRate); }),
              HasSubstr("a.bag: header.stamp 9.500000 of the inertial unit is 1.500 s before"));
}

}  // namespace
}  // namespace hires::sensing::drive_builder_test
