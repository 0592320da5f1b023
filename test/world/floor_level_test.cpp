#include "world/floor_level.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>

#include "hires/base/rng.h"
#include "hires/world/floor.h"
#include "hires/world/occupancy_grid.h"
#include "support/box_mesh.h"
#include "support/rounds.h"
#include "support/scenes.h"

namespace hires::world::floor_level_test {
namespace {

using hires::test_support::Block;
using hires::test_support::Rounds;
using ::testing::AllOf;
using ::testing::HasSubstr;

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

/// A slab in the world of an area, x of its ends, and where the file has its top.
World Ending(double from, double to, double width, double top, double thickness) {
  World world;
  world.statics = {Block("slab", {to - from, width, thickness},
                         {0.5 * (from + to), 0.0, top - 0.5 * thickness})};
  world.frames["a"] = {{0.0, 0.0, top}, Eigen::Quaterniond::Identity()};
  return world;
}

TEST(FloorLevelTest, AFloorEndsWhereItsFacesDo) {
  base::Rng rng(3);
  for (int i = 0; i < Rounds(100); ++i) {
    const double top = rng.Uniform(-1.0, 1.0), thickness = rng.Uniform(0.05, 0.5);
    const double depth = rng.Uniform(0.0, 0.2);
    const World slab = Ending(-2.0, rng.Uniform(1.0, 3.0), 4.0, top, thickness);
    for (const bool has_plane : {false, true}) {
      const World world = OnItsFloor(slab, has_plane);
      const bool is_above = has_plane || (top > 0.0 && top >= thickness);
      const double below = is_above ? std::max(0.0, top) : 1e9;
      if (std::abs(below - depth) < kFloorStep || std::abs(below) < 2.0 * kFloorStep) continue;
      const auto holes = FloorHoles(world, depth);
      ASSERT_EQ(holes.has_value(), below > depth) << top << " " << thickness << " " << depth;
      EXPECT_EQ(world.notes.size(), 1u);
      if (!holes) continue;
      for (int row = 0; row < holes->height; ++row) {
        for (int column = 0; column < holes->width; ++column) {
          const Eigen::Vector2d p = holes->CentreOf(column, row);
          const double x = std::abs(p.x() - slab.statics[0].X_MB.translation.x());
          const auto& box = std::get<geometry::Box>(slab.statics[0].collisions[0].shape);
          const double beyond = std::max(x - 0.5 * box.size.x(), std::abs(p.y()) - 2.0);
          if (std::abs(beyond) <= 0.02) continue;  // of a cell that the end runs through
          ASSERT_EQ(holes->at(column, row) == Cell::kOccupied, beyond > 0.0) << p.transpose();
        }
      }
    }
  }
}

TEST(FloorLevelTest, WorldsWithoutAFloorFaceHaveAFloorWithoutEnd) {
  World world = Ending(-2.0, 2.0, 4.0, 0.0, 0.1);
  world.frames["a"].translation.z() = 0.3;
  for (const World& after : {OnItsFloor(world), OnItsFloor(World()),
                             OnItsFloor(Ending(-2.0, 2.0, 4.0, 0.0, 0.1), true)}) {
    EXPECT_EQ(after.ground_depth, 0.0);
    EXPECT_TRUE(after.notes.empty());
    EXPECT_FALSE(FloorHoles(after, 0.0));
  }
}

TEST(FloorLevelTest, JointsAndShallowRecessesAreNoHoles) {
  base::Rng rng(4);
  for (int i = 0; i < Rounds(60); ++i) {
    const double joint = rng.Uniform(0.0, 0.01), recess = rng.Uniform(0.0, 0.15);
    World world;
    for (int x = -2; x < 2; ++x) {
      for (int y = -2; y < 2; ++y) {
        const double low = x == 1 && y == 1 ? recess : 0.0;
        world.statics.push_back(Block(fmt::format("tile{}{}", x, y),
                                      {1.0 - joint, 1.0 - joint, 0.1},
                                      {x + 0.5, y + 0.5, 0.35 - low}));
      }
    }
    world.frames["a"] = {{0.0, 0.0, 0.4}, Eigen::Quaterniond::Identity()};  // on a joint
    const World after = OnItsFloor(world);
    ASSERT_NEAR(after.lowered_by, 0.4, 1e-9) << joint;
    const auto holes = FloorHoles(after, 0.08, 0.05, 0.0);
    ASSERT_TRUE(holes);
    for (int row = 0; row < holes->height; ++row) {
      for (int column = 0; column < holes->width; ++column) {
        const Eigen::Vector2d p = holes->CentreOf(column, row);
        const bool is_in_recess = p.x() > 1.05 && p.y() > 1.05;
        if (p.cwiseAbs().maxCoeff() > 1.95 || (!is_in_recess && p.minCoeff() > 0.95)) continue;
        const bool is_hole = is_in_recess && recess > 0.08;
        ASSERT_EQ(holes->at(column, row) == Cell::kOccupied, is_hole)
            << p.transpose() << " joint " << joint << " recess " << recess;
      }
    }
  }
}

TEST(FloorLevelTest, CorridorsDiscsAndStrayFramesLeaveAFloorOne) {
  base::Rng rng(5);
  for (int i = 0; i < Rounds(60); ++i) {
    const double top = rng.Uniform(0.1, 0.5);
    World corridor = Ending(-2.0, 4.0, rng.Uniform(0.45, 1.4), top, 0.1);
    World stray = Ending(-2.0, 4.0, 4.0, top, 0.1);
    stray.frames["below"] = {{0.0, 3.0, -rng.Uniform(0.1, 3.0)}, Eigen::Quaterniond::Identity()};
    World disc = corridor;
    disc.statics[0].collisions[0].shape = geometry::Cylinder{rng.Uniform(3.0, 8.0), 0.1};
    World table = corridor;
    table.statics[0].collisions[0].shape = geometry::Box{{1.8, rng.Uniform(0.5, 1.0), 0.1}};
    table.statics[0].X_MB.translation.x() = 0.0;
    const double yaw = rng.Uniform(-3.0, 3.0);
    for (World* world : {&corridor, &stray, &disc, &table}) {
      for (auto& [name, X_MF] : world->frames) X_MF = geometry::Lift({0.0, 0.0, yaw}) * X_MF;
      for (StaticBody& body : world->statics) body.X_MB = geometry::Lift({0, 0, yaw}) * body.X_MB;
      const double lowered = world == &table ? 0.0 : top;
      EXPECT_NEAR(OnItsFloor(*world).lowered_by, lowered, 1e-9) << i;
    }
  }
}

TEST(FloorLevelTest, AreasOfAnotherStoreyAndBuriedOnesAreTold) {
  base::Rng rng(6);
  for (int i = 0; i < Rounds(60); ++i) {
    const double height = rng.Uniform(0.2, 3.0), base = rng.Uniform(0.1, 0.5);
    World world = Ending(-6.0, 6.0, 12.0, base, 0.1);
    world.statics.push_back(Block("mezzanine", {3.0, 3.0, 0.1}, {4.0, 0.0, base + height - 0.05}));
    for (const double x : {3.0, 4.0})
      world.frames[x == 4.0 ? "up" : "table"] = {{x, 0.0, base + height - (x == 4.0 ? 0.0 : 0.1)},
                                                 Eigen::Quaterniond::Identity()};
    const World after = OnItsFloor(world);
    EXPECT_EQ(WhyElsewhere(after, "a", 0.08), "");
    EXPECT_EQ(WhyElsewhere(after, "table", 0.08), "");
    EXPECT_EQ(WhyElsewhere(after, "up", height + 0.01), "");
    EXPECT_THAT(WhyElsewhere(after, "up", 0.08),
                AllOf(HasSubstr("'up' stands on 'mezzanine'"),
                      HasSubstr(fmt::format("{:.2f} m higher", height)), HasSubstr("one level")));
    EXPECT_EQ(WhyInFloor(after, "slab", {0.0, 0.0}), "");
    world.frames = {{"a", {{0.0, 0.0, 0.0}, Eigen::Quaterniond::Identity()}}};
    EXPECT_THAT(WhyInFloor(OnItsFloor(world), "slab", {0.0, 0.0}),
                AllOf(HasSubstr(fmt::format("z {:.3f} m of the world's file, is a floor", base)),
                      HasSubstr("'a', has z 0.000 m")));
  }
}

/// A slab, a roof whose top lies `storey` above it, and a table between them.
World Storeys(double top, double bottom, double storey) {
  World world;
  world.statics = {
      Block("slab", {14.0, 14.0, top - bottom}, {2.0, 0.0, 0.5 * (top + bottom)}),
      Block("roof", {14.0, 14.0, 0.1}, {2.0, 0.0, top + storey - 0.05}),
      Block("table", {1.0, 1.0, 0.05}, {2.0, 3.0, top + 0.7}),
  };
  return world;
}

TEST(FloorLevelTest, AddedAreasStandOnWhatIsUnderThem) {
  base::Rng rng(7);
  for (int i = 0; i < Rounds(60); ++i) {
    const double bottom = rng.Uniform(-1.0, 1.0), top = bottom + rng.Uniform(0.006, 0.5);
    const double storey = rng.Uniform(1.0, 3.0);
    World world = Storeys(top, bottom, storey);
    if (i % 3 == 0) {
      auto& shape = world.statics[0].collisions.front().shape;
      shape = hires::test_support::BoxMesh(Eigen::Vector3d(std::get<geometry::Box>(shape).size));
    }
    const FloorPlane plane{rng.Uniform(bottom, top - 0.0055), 0.7, "w.world:1"};
    std::vector<NamedArea> areas{{"a", {0.0, 0.0, 0.3}}, {"b", {4.0, -2.0, 0.0}}};
    const World after = OnItsFloor(world, plane, areas);
    EXPECT_NEAR(after.lowered_by, top, 1e-9) << plane.height;
    EXPECT_NEAR(after.frames.at("a").translation.z(), 0.0, 1e-9);
    EXPECT_NEAR(after.ground_depth, top - plane.height, 1e-9);
    // Heights say which storey, however roughly.
    const double off = rng.Uniform(-0.3, 0.3);
    for (NamedArea& area : areas) area.z = top + storey + off;
    EXPECT_NEAR(OnItsFloor(world, plane, areas).lowered_by, top + storey, 1e-9);
    for (NamedArea& area : areas) area.z = top + off;
    EXPECT_NEAR(OnItsFloor(world, plane, areas).lowered_by, top, 1e-9);
  }
}

TEST(FloorLevelTest, AddedAreasStandOnTheGroundWhereThereIsRoom) {
  base::Rng rng(8);
  for (int i = 0; i < Rounds(60); ++i) {
    const double height = rng.Uniform(0.35, 3.0), table = rng.Uniform(0.1, 0.9);
    World world = Ending(-6.0, 6.0, 12.0, height + 0.05, 0.05);  // a storey on pillars
    world.statics.push_back(Block("table", {0.8, 1.2, 0.1}, {0.0, 0.0, table}));
    world.frames.clear();
    const FloorPlane plane{0.0, 0.7, ""};
    const World after = OnItsFloor(world, plane, {{"a", {3.0, 0.0, 0.0}}, {"t", {0.0, 0.0, 0.0}}});
    EXPECT_EQ(after.lowered_by, 0.0);
    for (const char* name : {"a", "t"}) EXPECT_EQ(after.frames.at(name).translation.z(), 0.0);
    EXPECT_EQ(after.frame_names.at("a"), "a");
    // Where the world's own areas stand, added ones do.
    world.frames["own"] = {{3.0, 1.0, height + 0.05}, Eigen::Quaterniond::Identity()};
    const World up = OnItsFloor(world, plane, {{"a", {3.0, 0.0, 0.0}}});
    EXPECT_NEAR(up.lowered_by, height + 0.05, 1e-9);
    EXPECT_NEAR(up.frames.at("a").translation.z(), 0.0, 1e-9);
  }
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
