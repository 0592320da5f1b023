#include "hires/geometry/bearing_face.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <utility>

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

TEST(BearingFaceTest, AnUndersideBearsNothingHoweverMuchLargerItIs) {
  for (const bool turned : {false, true}) {
    auto tub = std::make_shared<TriangleMesh>();  // walls of 0.1 m
    AddBox({-0.3, -0.25, 0.0}, {0.3, 0.25, 0.04}, turned, tub.get());
    AddBox({-0.3, -0.25, 0.0}, {-0.2, 0.25, 0.2}, turned, tub.get());
    AddBox({0.2, -0.25, 0.0}, {0.3, 0.25, 0.2}, turned, tub.get());
    tub->triangles.erase(tub->triangles.begin() + 2, tub->triangles.begin() + 4);
    // The floor's upper side lies between the walls alone.
    const int first = static_cast<int>(tub->vertices.size());
    tub->vertices.insert(
        tub->vertices.end(),
        {{-0.2, -0.25, 0.04}, {0.2, -0.25, 0.04}, {0.2, 0.25, 0.04}, {-0.2, 0.25, 0.04}});
    for (const auto& [b, c] : {std::pair<int, int>{1, 2}, {2, 3}}) {
      tub->triangles.push_back(turned ? std::array<int, 3>{first, first + c, first + b}
                                      : std::array<int, 3>{first, first + b, first + c});
    }
    const Aabb bounds = BearingBounds(std::shared_ptr<const TriangleMesh>(tub), {});
    EXPECT_TRUE(bounds.upper.isApprox(Vector3d(0.2, 0.25, 0.04))) << bounds.upper.transpose();
  }
}

TEST(BearingFaceTest, ASheetBearsWhicheverWayItIsWound) {
  for (const bool turned : {false, true}) {
    auto sheet = std::make_shared<TriangleMesh>();  // a floor and one wall
    sheet->vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0.5}, {1, 0, 0.5}};
    sheet->triangles = {{0, 1, 2}, {0, 2, 3}, {0, 5, 1}, {0, 4, 5}};
    for (auto& [a, b, c] : sheet->triangles)
      if (turned) std::swap(b, c);
    EXPECT_EQ(BearingBounds(std::shared_ptr<const TriangleMesh>(sheet), {}).upper.z(), 0.0);
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
