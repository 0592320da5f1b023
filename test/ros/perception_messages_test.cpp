#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "hires/base/error.h"
#include "hires/ros/perception/cloud_messages.h"
#include "hires/ros/perception/detection_messages.h"

namespace hires_ros::perception_messages_test {
namespace {

using ::testing::HasSubstr;

/// Points of 20 bytes, "intensity" before x and the others in an order of their own.
sensor_msgs::PointCloud2 Cloud(std::uint32_t width, std::uint32_t height) {
  sensor_msgs::PointCloud2 msg;
  msg.width = width;
  msg.height = height;
  msg.point_step = 20;
  msg.row_step = width * msg.point_step + 4;  // rows may be padded
  std::uint32_t offset = 0;
  for (const char* name : {"intensity", "z", "x", "y"}) {
    msg.fields.emplace_back();
    msg.fields.back().name = name;
    msg.fields.back().offset = offset;
    msg.fields.back().datatype = sensor_msgs::PointField::FLOAT32;
    msg.fields.back().count = 1;
    offset += 4;
  }
  msg.data.resize(msg.row_step * height);
  return msg;
}

void Set(sensor_msgs::PointCloud2* msg, int column, int row, const Eigen::Vector3f& p) {
  std::uint8_t* point = &msg->data[row * msg->row_step + column * msg->point_step];
  const float values[] = {99.0f, p.z(), p.x(), p.y()};
  std::memcpy(point, values, sizeof values);
}

TEST(PointCloudMessageTest, FieldsAreFoundByNameInRowsThatMayBePadded) {
  sensor_msgs::PointCloud2 msg = Cloud(2, 2);
  for (int i = 0; i < 4; ++i) {
    Set(&msg, i % 2, i / 2, {1.0f + i, 10.0f + i, 100.0f + i});
  }
  Set(&msg, 1, 0, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  const hires::perception::PointCloud cloud = FromMsg(msg);
  EXPECT_EQ(cloud.width, 2);
  EXPECT_EQ(cloud.height, 2);
  ASSERT_EQ(cloud.points.size(), 4u);
  EXPECT_EQ(cloud.points[2], Eigen::Vector3f(3.0f, 12.0f, 102.0f));
  EXPECT_FALSE(hires::perception::IsMeasured(cloud.points[1]));
}

TEST(PointCloudMessageTest, AnEmptyCloudHasNoPoints) {
  EXPECT_TRUE(FromMsg(Cloud(0, 1)).points.empty());
}

void ExpectRefused(const sensor_msgs::PointCloud2& msg, const std::string& word) {
  try {
    FromMsg(msg);
    FAIL() << "was taken";
  } catch (const hires::base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr(word));
  }
}

TEST(PointCloudMessageTest, WhatDoesNotFitIsNamed) {
  auto without = Cloud(2, 1);
  without.fields.pop_back();
  ExpectRefused(without, "'y' is missing");
  auto doubles = Cloud(2, 1);
  doubles.fields[2].datatype = sensor_msgs::PointField::FLOAT64;
  ExpectRefused(doubles, "'x' has datatype 8");
  auto beyond = Cloud(2, 1);
  beyond.fields[1].offset = 18;
  ExpectRefused(beyond, "'z' has datatype 7 at 18 of 20 bytes");
  auto too_short = Cloud(2, 3);
  too_short.data.pop_back();
  ExpectRefused(too_short, "131 bytes of 2 x 3 points");
  auto narrow = Cloud(2, 1);
  narrow.row_step = 30;
  ExpectRefused(narrow, "row_step 30");
  auto big = Cloud(1, 1);
  big.is_bigendian = 1;
  ExpectRefused(big, "big-endian");
}

TEST(DetectionsMessageTest, WhatIsSeenComesBackAndBlindnessIsNoSight) {
  std_msgs::Header header;
  header.frame_id = "camera";
  hires::perception::Sighting seen;
  seen.detections.emplace_back();
  seen.detections[0].label = "mug";
  seen.detections[0].confidence = 0.75;
  seen.detections[0].alternatives = {{"cup", 0.25}};
  seen.detections[0].size = {0.08, 0.1, 0.12};
  seen.detections[0].num_points = 700;
  seen.table = {{0.0, 0.0, 1.0}, {1.0, 0.0, 1.0}, {1.0, 2.0, 1.5}};
  const hires::Detections msg = ToMsg(seen, header);
  EXPECT_EQ(msg.header.frame_id, "camera");
  const auto back = FromMsg(msg);
  ASSERT_TRUE(back && back->detections.size() == 1);
  EXPECT_EQ(back->table, seen.table);
  EXPECT_EQ(back->detections[0].label, "mug");
  EXPECT_EQ(back->detections[0].confidence, 0.75);
  EXPECT_EQ(back->detections[0].alternatives[0].label, "cup");
  EXPECT_EQ(back->detections[0].size, seen.detections[0].size);
  EXPECT_EQ(back->detections[0].num_points, 700);
  EXPECT_FALSE(FromMsg(ToMsg(std::optional<hires::perception::Sighting>(), header)));
}

}  // namespace
}  // namespace hires_ros::perception_messages_test
