#include "hires/sensing/drive_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "support/fake_frame_tree.h"
#include "support/messages.h"

namespace hires::sensing::drive_builder_test {
namespace {

using geometry::Pose2;
using geometry::Pose3;
using localisation::RobotLog;
using test_support::ConfigErrorOf;
using test_support::FakeFrameTree;
using testing::AllOf;
using testing::HasSubstr;

const robot::ScanReading kScan{-1.0, 0.5, 0.02, {3, 3, 3, 3, 3}, 30.0};

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

}  // namespace
}  // namespace hires::sensing::drive_builder_test
