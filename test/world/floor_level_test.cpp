#include "world/floor_level.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>

#include "hires/base/rng.h"
#include "support/box_mesh.h"
#include "support/rounds.h"
#include "support/scenes.h"

namespace hires::world::floor_level_test {
namespace {

using hires::test_support::Block;
using hires::test_support::Rounds;

/// A slab whose top lies at `top`, and areas on it; `as_mesh`: of triangles.
World OnSlab(double top, double thickness, bool as_mesh) {
  World world;
  StaticBody slab = Block("slab", {12.0, 12.0, thickness}, {0.0, 0.0, top - 0.5 * thickness});
  if (as_mesh) {
    const auto& box = std::get<geometry::Box>(slab.collisions.front().shape);
    slab.collisions.front().shape = hires::test_support::BoxMesh(Eigen::Vector3d(box.size));
  }
  slab.collisions.front().friction = 0.6;
  world.statics = {slab, Block("table", {1.0, 1.0, 0.05}, {3.0, 0.0, top + 0.7})};
  for (const auto& [name, x] : std::map<std::string, double>{{"a", 0.0}, {"b", 4.0}})
    world.frames[name] = {{x, 0.0, top}, Eigen::Quaterniond::Identity()};
  world.frames["on_table"] = {{3.0, 0.0, top + 0.725}, Eigen::Quaterniond::Identity()};
  return world;
}

TEST(FloorLevelTest, WhereAllAreasStandIsTheFloor) {
  base::Rng rng(1);
  for (int i = 0; i < Rounds(100); ++i) {
    const double top = rng.Uniform(-0.4, 0.4), thickness = rng.Uniform(0.01, 0.5);
    const World world = OnItsFloor(OnSlab(top, thickness, i % 2 == 0));
    EXPECT_NEAR(world.frames.at("a").translation.z(), 0.0, kFloorStep + 1e-12) << top;
    EXPECT_NEAR(world.frames.at("on_table").translation.z(), 0.725, kFloorStep + 1e-12);
    EXPECT_EQ(world.floor_friction, 0.6);
    if (std::abs(top) > kFloorStep) {
      EXPECT_NEAR(world.lowered_by, top, 1e-9);
    }
  }
}

TEST(FloorLevelTest, AreasThatNothingBearsLeaveTheWorldAlone) {
  World world = OnSlab(0.0, 0.1, false);
  for (auto& [name, X_MF] : world.frames) X_MF.translation.z() += 0.2;
  const World after = OnItsFloor(world);
  EXPECT_EQ(after.lowered_by, 0.0);
  EXPECT_EQ(after.floor_friction, 1.0);
}

TEST(FloorLevelTest, AMeshWithoutItsFloorKeepsItsWalls) {
  base::Rng rng(2);
  for (int i = 0; i < Rounds(100); ++i) {
    const double thickness = rng.Uniform(0.05, 0.4), wall_height = rng.Uniform(0.01, 3.0);
    auto floor = *hires::test_support::BoxMesh({6.0, 6.0, thickness});
    for (Eigen::Vector3d& p : floor.vertices) p.z() -= 0.5 * thickness;
    auto both = floor;
    const auto wall = *hires::test_support::BoxMesh({0.1, 6.0, wall_height});
    for (const auto& t : wall.triangles) {
      const int offset = static_cast<int>(floor.vertices.size());
      both.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    }
    for (const Eigen::Vector3d& p : wall.vertices)
      both.vertices.push_back(p + Eigen::Vector3d(2.0, 0.0, 0.5 * wall_height));
    const auto mesh = std::make_shared<const geometry::TriangleMesh>(both);
    const auto left = WithoutFloor(mesh, {}, kFloorStep);
    ASSERT_NE(left, nullptr);
    EXPECT_EQ(left->triangles.size(), wall.triangles.size());
    EXPECT_EQ(WithoutFloor(std::make_shared<const geometry::TriangleMesh>(floor), {}, kFloorStep),
              nullptr);
    const geometry::Pose3 raised{{0.0, 0.0, 1.0}, Eigen::Quaterniond::Identity()};
    EXPECT_EQ(WithoutFloor(mesh, raised, kFloorStep), mesh);
  }
}

}  // namespace
}  // namespace hires::world::floor_level_test
