#include "hires/geometry/bearing_face.h"

#include <gtest/gtest.h>

#include <memory>

#include "support/box_mesh.h"

namespace hires::geometry::bearing_face_test {
namespace {

using Eigen::Vector3d;

using hires::test_support::AddBox;
using hires::test_support::Basket;

TEST(BearingFaceTest, OfABasketTheFloorBears) {
  for (const bool turned : {false, true}) {
    const Pose3 X_WS{{1.0, 2.0, 0.5}, Eigen::Quaterniond::Identity()};
    const Aabb bounds = BearingBounds(Basket(turned), X_WS);
    EXPECT_TRUE(bounds.lower.isApprox(Vector3d(0.8, 1.85, 0.5))) << bounds.lower.transpose();
    EXPECT_TRUE(bounds.upper.isApprox(Vector3d(1.2, 2.15, 0.51))) << bounds.upper.transpose();
  }
}

TEST(BearingFaceTest, OfAPlateWithAFootTheTopBearsAndOfABoxAll) {
  auto plate = std::make_shared<TriangleMesh>();
  AddBox({-0.3, -0.3, 0.4}, {0.3, 0.3, 0.42}, false, plate.get());
  AddBox({-0.05, -0.05, 0.0}, {0.05, 0.05, 0.4}, false, plate.get());
  EXPECT_DOUBLE_EQ(BearingBounds(std::shared_ptr<const TriangleMesh>(plate), {}).upper.z(), 0.42);
  EXPECT_DOUBLE_EQ(BearingBounds(Box{{1.0, 1.0, 0.2}}, {}).upper.z(), 0.1);
}

TEST(BearingFaceTest, WhereNothingIsLevelTheWholeCounts) {
  auto roof = std::make_shared<TriangleMesh>();
  roof->vertices = {{-1, 0, 0}, {1, 0, 0}, {0, 1, 1}, {0, -1, 1}};
  roof->triangles = {{0, 1, 2}, {0, 3, 1}};
  EXPECT_DOUBLE_EQ(BearingBounds(std::shared_ptr<const TriangleMesh>(roof), {}).upper.z(), 1.0);
}

TEST(BearingFaceTest, AFaceIsFoundUnderAndOverAPointAndNotBesideIt) {
  const auto basket = Basket(false);
  EXPECT_TRUE(HasFaceAt(*basket, {}, {0.05, 0.02, 0.03}, 0.03));
  EXPECT_TRUE(HasFaceAt(*basket, {}, {0.05, 0.02, -0.01}, 0.03));
  EXPECT_FALSE(HasFaceAt(*basket, {}, {0.05, 0.02, 0.1}, 0.03)) << "too high";
  EXPECT_FALSE(HasFaceAt(*basket, {}, {0.25, 0.02, 0.01}, 0.03)) << "beside it";
  EXPECT_TRUE(HasFaceAt(*basket, {}, {0.19, 0.0, 0.16}, 0.03)) << "on its rim";
}

}  // namespace
}  // namespace hires::geometry::bearing_face_test
