#include "geometry/mesh_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/box_mesh.h"

namespace hires::geometry::mesh_pieces_test {
namespace {

/// Its triangles counter-clockwise from outside.
void AddBox(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper, TriangleMesh* mesh) {
  hires::test_support::AddBox(lower, upper, false, mesh);
}

/// An L seen from above, 2 m long each way and 1 m thick and high, as one closed surface.
TriangleMesh LShape() {
  const double outline[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  TriangleMesh mesh;
  for (const double z : {0.0, 1.0}) {
    for (const auto& p : outline) mesh.vertices.emplace_back(p[0], p[1], z);
  }
  for (int i = 0; i < 6; ++i) {
    const int next = (i + 1) % 6;
    mesh.triangles.push_back({i, next, next + 6});
    mesh.triangles.push_back({i, next + 6, i + 6});
  }
  for (const std::array<int, 3>& t :
       {std::array<int, 3>{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}) {
    mesh.triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
    mesh.triangles.push_back({t[2], t[1], t[0]});
  }
  return mesh;
}

bool AnyContains(const std::vector<Polygon>& outlines, double x, double y) {
  return std::any_of(outlines.begin(), outlines.end(), [&](const Polygon& outline) {
    return Contains(outline, {x, y});
  });
}

TEST(MeshPiecesTest, SeparateBoxesAreSeparateConvexParts) {
  TriangleMesh mesh;
  AddBox({0, 0, 0}, {1, 1, 1}, &mesh);
  AddBox({5, 0, 0}, {6, 1, 1}, &mesh);
  const auto parts = ConnectedParts(mesh);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].vertices.size(), 8u);
  EXPECT_EQ(parts[1].triangles.size(), 12u);
  EXPECT_TRUE(IsConvex(parts[0]));
  EXPECT_FALSE(IsConvex(mesh));
}

TEST(MeshPiecesTest, RoomBetweenTheWallsOfOneMeshStaysOpen) {
  TriangleMesh mesh;
  AddBox({0, 0, 0}, {10, 0.2, 2}, &mesh);
  AddBox({0, 5, 0}, {10, 5.2, 2}, &mesh);
  const auto outlines = MeshOutlinesInBand(mesh, {}, 0.3, 0.3);
  EXPECT_EQ(outlines.size(), 2u);
  EXPECT_TRUE(AnyContains(outlines, 5, 0.1));
  EXPECT_FALSE(AnyContains(outlines, 5, 2.5));
}

/// Rooms without a door: what is between the walls is free, however many there are.
TEST(MeshPiecesTest, ACavityInAClosedBoxStaysOpen) {
  TriangleMesh mesh;
  AddBox({0, 0, 0}, {10, 5, 3}, &mesh);
  AddBox({20, 0, 0}, {21, 1, 1}, &mesh);
  TriangleMesh rooms;
  AddBox({0.2, 0.2, 0.2}, {4, 4.8, 2.8}, &rooms);
  AddBox({4.2, 0.2, 0.2}, {9.8, 4.8, 2.8}, &rooms);
  const int first = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), rooms.vertices.begin(), rooms.vertices.end());
  for (const auto& t : rooms.triangles) {
    mesh.triangles.push_back({t[0] + first, t[2] + first, t[1] + first});
  }
  const auto parts = ConnectedParts(mesh);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_FALSE(IsSolid(parts[0]));
  EXPECT_TRUE(IsSolid(parts[1]));
  const auto outlines = MeshOutlinesInBand(mesh, {}, 1.0, 1.5);
  EXPECT_FALSE(AnyContains(outlines, 2, 2));
  EXPECT_FALSE(AnyContains(outlines, 7, 2));
  for (const double wall : {0.0, 4.0, 4.2, 10.0}) EXPECT_TRUE(AnyContains(outlines, wall, 2));
  EXPECT_TRUE(AnyContains(outlines, 20.5, 0.5));
}

TEST(MeshPiecesTest, HollowCornerOfAnLStaysOpenAndItsSidesClosed) {
  const TriangleMesh mesh = LShape();
  EXPECT_EQ(ConnectedParts(mesh).size(), 1u);
  EXPECT_FALSE(IsConvex(mesh));
  const auto outlines = MeshOutlinesInBand(mesh, {}, 0.5, 0.5);
  EXPECT_FALSE(AnyContains(outlines, 1.5, 1.5));
  for (double t = 0.05; t < 1.0; t += 0.1) {
    EXPECT_TRUE(AnyContains(outlines, 1.0 + t, 1.0)) << t;
    EXPECT_TRUE(AnyContains(outlines, 1.0, 1.0 + t)) << t;
    EXPECT_TRUE(AnyContains(outlines, 2.0 * t, 0.0)) << t;
  }
}

TEST(MeshPiecesTest, NothingLiesAboveTheMesh) {
  EXPECT_TRUE(MeshOutlinesInBand(LShape(), {}, 1.5, 2.0).empty());
  EXPECT_TRUE(ConnectedParts(TriangleMesh{}).empty());
}

TEST(MeshPiecesTest, ASurfaceGoesOnceRoundWhatItHolds) {
  TriangleMesh house;  // 4 m wide, its room 3 m
  hires::test_support::AddBox({-2, -2, 0}, {2, 2, 3}, false, &house);
  hires::test_support::AddBox({-1.5, -1.5, 0.5}, {1.5, 1.5, 2.5}, true, &house);
  EXPECT_NEAR(WindingNumber(house, {1.7, 0.3, 1.0}), 1.0, 1e-12) << "in a wall";
  EXPECT_NEAR(WindingNumber(house, {0.4, -0.2, 1.0}), 0.0, 1e-12) << "in the room";
  EXPECT_NEAR(WindingNumber(house, {5.0, 1.0, 1.0}), 0.0, 1e-12) << "outside";
  TriangleMesh plate;  // one side of a cube: a sixth of all directions
  plate.vertices = {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_NEAR(WindingNumber(plate, {0, 0, 0}), 1.0 / 6.0, 1e-12);
}

}  // namespace
}  // namespace hires::geometry::mesh_pieces_test
