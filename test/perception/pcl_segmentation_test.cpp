#include "perception/pcl_segmentation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace hires::perception::pcl_segmentation_test {
namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr double kFocalLength = 300.0;  // [pixels]

/// A table 1 m below a camera that looks straight down; what is higher, by its height at (x, y) on
/// the table [m].
PointCloud FromAbove(const std::function<double(double, double)>& height) {
  PointCloud cloud;
  cloud.width = kWidth;
  cloud.height = kHeight;
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const double x = (column - 159.5) / kFocalLength, y = (row - 119.5) / kFocalLength;
      const double z = 1.0 - height(x, y);
      cloud.points.emplace_back(x * z, y * z, z);
    }
  }
  return cloud;
}

/// What is seen in the middle row, at x on the table.
int LabelAt(const Segmentation& out, double x) {
  return out.labels[(kHeight / 2) * kWidth + static_cast<int>(x * kFocalLength + 159.5)];
}

bool IsWithin(double x, double y, double width) { return std::abs(x) < width && std::abs(y) < 0.2; }

double TwoBoxes(double x, double y) {
  return IsWithin(x + 0.2, y, 0.1) || IsWithin(x - 0.2, y, 0.1) ? 0.1 : 0.0;
}
double Valley(double x, double y) { return IsWithin(x, y, 0.2) ? 0.1 + 0.7 * std::abs(x) : 0.0; }
double Ridge(double x, double y) { return IsWithin(x, y, 0.2) ? 0.24 - 0.7 * std::abs(x) : 0.0; }

TEST(SegmentByPclClustersTest, ThingsApartAreClustersOnTheirTable) {
  const Segmentation out = SegmentByPclClusters(FromAbove(TwoBoxes), {});
  ASSERT_TRUE(out.table.has_value());
  EXPECT_NEAR(out.table->offset, 1.0, 1e-3);
  EXPECT_NEAR(out.table->normal.z(), -1.0, 1e-3);
  EXPECT_EQ(out.num_things, 2);
  EXPECT_EQ(LabelAt(out, 0.0), kLabelTable);
  EXPECT_GE(LabelAt(out, -0.2), kLabelFirstThing);
  EXPECT_GE(LabelAt(out, 0.2), kLabelFirstThing);
  EXPECT_NE(LabelAt(out, -0.2), LabelAt(out, 0.2));
}

TEST(SegmentByPclClustersTest, ConcaveThingsStayTogether) {
  EXPECT_EQ(SegmentByPclClusters(FromAbove(Valley), {}).num_things, 1);
}

TEST(SegmentByPclPatchesTest, ThingsAreDividedWhereTheyAreConcaveAlone) {
  const Segmentation valley = SegmentByPclPatches(FromAbove(Valley), {});
  EXPECT_NE(LabelAt(valley, -0.1), LabelAt(valley, 0.1));
  EXPECT_NE(LabelAt(valley, -0.1), LabelAt(valley, -0.4));
  const Segmentation ridge = SegmentByPclPatches(FromAbove(Ridge), {});
  EXPECT_EQ(LabelAt(ridge, -0.1), LabelAt(ridge, 0.1));
  EXPECT_NE(LabelAt(ridge, -0.1), LabelAt(ridge, -0.4));
}

TEST(PclSegmentationTest, NothingMeasuredIsNothing) {
  PointCloud cloud = FromAbove(TwoBoxes);
  for (auto& point : cloud.points) point.setConstant(std::numeric_limits<float>::quiet_NaN());
  for (const Segmentation& out :
       {SegmentByPclClusters(cloud, {}), SegmentByPclPatches(cloud, {})}) {
    EXPECT_FALSE(out.table.has_value());
    EXPECT_EQ(out.labels, std::vector<int>(cloud.points.size(), kLabelNone));
  }
}

}  // namespace
}  // namespace hires::perception::pcl_segmentation_test
