#include "hires/ros/robot/scan_messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace hires_ros::scan_messages_test {
namespace {

sensor_msgs::LaserScan HalfTurn() {
  sensor_msgs::LaserScan scan;
  scan.angle_min = -1.5f;
  scan.angle_max = 1.5f;
  scan.range_min = 0.1f;
  scan.range_max = 30.0f;
  scan.ranges = {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f};
  return scan;
}

TEST(ScanMessagesTest, TheAngleBetweenBeamsIsWhatTheMessageSays) {
  sensor_msgs::LaserScan scan = HalfTurn();
  scan.angle_increment = 0.25f;  // whatever its angle_max
  EXPECT_EQ(ReadingOf(scan).angle_increment, 0.25);
  EXPECT_EQ(ReadingOf(scan).angle_min, -1.5);
  EXPECT_EQ(ReadingOf(scan).range_max, 30.0);
  EXPECT_EQ(ReadingOf(scan).ranges, scan.ranges);
}

TEST(ScanMessagesTest, WhereItIsLeftZeroTheLastAngleTellsIt) {
  sensor_msgs::LaserScan scan = HalfTurn();
  EXPECT_EQ(ReadingOf(scan).angle_increment, 0.5);
  std::swap(scan.angle_min, scan.angle_max);  // a laser that hangs upside down
  EXPECT_EQ(ReadingOf(scan).angle_increment, -0.5);
}

TEST(ScanMessagesTest, WhatNothingTellsStaysZero) {
  for (const float angle_max : {0.0f, -1.5f, NAN, INFINITY}) {
    sensor_msgs::LaserScan scan = HalfTurn();
    scan.angle_max = angle_max;
    EXPECT_EQ(ReadingOf(scan).angle_increment, 0.0) << angle_max;
  }
  sensor_msgs::LaserScan single = HalfTurn();
  single.ranges = {1.0f};
  EXPECT_EQ(ReadingOf(single).angle_increment, 0.0);
}

}  // namespace
}  // namespace hires_ros::scan_messages_test
