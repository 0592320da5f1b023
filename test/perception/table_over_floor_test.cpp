#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "hires/perception/depth_sensor.h"
#include "hires/perception/line_of_sight.h"
#include "hires/perception/segmentation.h"
#include "perception/tabletop/level_patches.h"

namespace hires::perception::table_over_floor_test {
namespace {

using Eigen::Vector3d;

constexpr double kHeight = 0.75;  // [m] of the plane that things stand on
constexpr double kOver = 0.5;     // [m] of the camera above it

/// Furniture on the floor z = 0 before a camera that looks along x, 15 to 20 degrees down.
class Room {
 public:
  Room& Put(const Vector3d& size, const Vector3d& middle) {
    world::StaticBody body;
    body.name = "body" + std::to_string(world_.statics.size());
    body.X_MB.translation = middle;
    body.collisions.emplace_back();
    body.collisions.back().shape = geometry::Box{size};
    world_.statics.push_back(body);
    return *this;
  }
  Room& PutTable(double x, double depth, double width) {
    return Put({depth, width, 0.03}, {x, 0.0, kHeight - 0.015});
  }
  Room& PutThing(double x, double y, double height = 0.2) {
    return Put({0.1, 0.1, height}, {x, y, kHeight + 0.5 * height});
  }
  /// @param sd  [m] of depths, of a laser; 0: DepthNoise
  PointCloud Seen(double sd, int seed, int width = 320) const {
    const Vector3d eye(0.0, 0.0, kHeight + kOver);
    const PinholeCamera camera =
        LookAt(eye, eye + Vector3d(1.0, 0.0, -0.3), width, width * 3 / 4, 1.1);
    const RangePicture picture =
        LineOfSight(std::make_shared<Surroundings>(world_), {}).Look(camera, 12.0);
    PointCloud cloud;
    cloud.width = picture.width;
    cloud.height = picture.height;
    base::Rng noise(seed);
    for (int i = 0; i < picture.width * picture.height; ++i) {
      const double z = picture.depth[i];
      const double measured = z + noise.Normal(0.0, sd > 0.0 ? sd : DepthNoise(std::min(z, 8.0)));
      const Vector3d ray((i % picture.width + 0.5 - 0.5 * picture.width) / camera.focal_length,
                         (i / picture.width + 0.5 - 0.5 * picture.height) / camera.focal_length,
                         1.0);
      cloud.points.push_back(
          z < 8.0 ? Eigen::Vector3f((measured * ray).cast<float>())
                  : Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
    }
    return cloud;
  }

 private:
  world::World world_;
};

Room LaidTable() {
  return Room().PutTable(1.3, 0.8, 1.1).PutThing(1.1, -0.3).PutThing(1.2, 0.0).PutThing(1.1, 0.3);
}

/// The board of a shelf with a back and sides, which hold most of what is seen above the floor.
Room Shelf() {
  Room room;
  room.PutTable(1.3, 0.35, 1.2).Put({0.05, 1.4, 2.4}, {1.5, 0.0, 1.2});
  for (const double y : {-0.6, 0.6}) room.Put({0.35, 0.02, 2.4}, {1.3, y, 1.2});
  return room.Put({0.3, 1.2, 0.03}, {1.35, 0.0, kHeight + 0.42});
}

double SharesOf(const PointCloud& cloud, double height) {
  double on_it = 0.0, all = 0.0;
  for (const Eigen::Vector3f& p : cloud.points) {
    if (!IsMeasured(p)) continue;
    const Vector3d axis = Vector3d(1.0, 0.0, -0.3).normalized();  // of the camera, in the room
    const double up = p.z() * axis.z() - p.y() * axis.x();
    ++all;
    on_it += std::abs(kHeight + kOver + up - height) < 0.01;
  }
  return on_it / all;
}

TEST(TableOverFloorTest, DepthsThatScatterAreJudgedByTheirOwnScatter) {
  for (const double sd : {0.008, 0.015, 0.025}) {
    for (int seed = 1; seed <= 4; ++seed) {
      const auto table = FindTable(LaidTable().Seen(sd, seed), std::nullopt, {});
      ASSERT_TRUE(table) << sd << ", " << seed;
      EXPECT_NEAR(table->offset, kOver, 0.01) << sd << ", " << seed;
    }
  }
  const auto noisy = FindTable(LaidTable().Seen(0.015, 1), std::nullopt, {});
  EXPECT_GT(noisy->noise, 1.5) << "5 mm across the table, where a depth camera has 2 mm";
  EXPECT_LT(noisy->noise, 3.0);
  EXPECT_EQ(FindTable(LaidTable().Seen(0.0, 1), std::nullopt, {})->noise, 1.0);
}

TEST(TableOverFloorTest, OfNoiseNothingStandsOnTheTable) {
  for (int seed = 1; seed <= 4; ++seed) {
    const Segmentation out = SegmentTabletop(Room().PutTable(1.3, 0.8, 1.1).Seen(0.015, seed),
                                             std::nullopt, {}, base::Rng(1));
    ASSERT_TRUE(out.table);
    EXPECT_EQ(out.num_things, 0) << seed;
    EXPECT_LT(out.num_over, 100) << seed;
  }
}

TEST(TableOverFloorTest, AFarOneHoldsFewPointsAndIsTheTableWhereThingsStandOnIt) {
  const auto table = [] { return Room().PutTable(4.0, 1.0, 1.6); };
  for (int seed = 1; seed <= 4; ++seed) {
    const PointCloud laid =
        table().PutThing(3.8, -0.4).PutThing(3.8, 0.0).PutThing(3.8, 0.4).Seen(0.0, seed, 640);
    ASSERT_LT(SharesOf(laid, kHeight), TableParams().min_share);
    const auto found = FindTable(laid, std::nullopt, {});
    ASSERT_TRUE(found) << seed;
    EXPECT_NEAR(found->offset, kOver, 0.02) << seed;
    const auto floor = FindTable(table().Seen(0.0, seed, 640), std::nullopt, {});
    ASSERT_TRUE(floor) << seed;
    EXPECT_NEAR(floor->offset, kOver + kHeight, 0.03) << "nothing tells that it is one";
  }
}

TEST(TableOverFloorTest, ABoardOfAShelfIsTheTableAndTheShelfNoThingOnIt) {
  for (int seed = 1; seed <= 4; ++seed) {
    const PointCloud cloud = Shelf()
                                 .PutThing(1.25, -0.35, 0.15)
                                 .PutThing(1.25, 0.0, 0.15)
                                 .PutThing(1.25, 0.35, 0.15)
                                 .Seen(0.0, seed);
    const Segmentation out = SegmentTabletop(cloud, std::nullopt, {}, base::Rng(1));
    ASSERT_TRUE(out.table) << seed;
    EXPECT_NEAR(out.table->offset, kOver, 0.01) << seed;
    int of_shelf = 0, of_things = 0;
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      if (out.labels[i] < kLabelFirstThing) continue;
      const Vector3d p = cloud.points[i].cast<double>();
      ++(std::abs(p.x()) > 0.55 || out.table->HeightOf(p) > 0.2 ? of_shelf : of_things);
    }
    EXPECT_GE(out.num_things, 3) << seed;
    EXPECT_GT(of_things, 1000) << seed;
    EXPECT_LT(of_shelf, of_things / 5) << seed;
  }
}

/// A wall shelf that holds a few points and a few things, over a desk with things.
TEST(TableOverFloorTest, AShelfOverALaidDeskIsNotTheTable) {
  for (int seed = 1; seed <= 4; ++seed) {
    Room room = LaidTable();
    room.Put({0.15, 0.5, 0.03}, {1.9, 0.0, kHeight + 0.46});
    for (const double y : {-0.15, 0.0, 0.15})
      room.Put({0.08, 0.06, 0.12}, {1.9, y, kHeight + 0.535});
    room.Put({4.0, 8.0, 0.6}, {1.0, 0.0, 0.3});  // so the floor is not seen
    const auto table = FindTable(room.Seen(0.0, seed), std::nullopt, {});
    ASSERT_TRUE(table) << seed;
    EXPECT_LT(std::abs(table->offset - kOver), 0.2) << seed;
  }
}

TEST(TableOverFloorTest, WhatStandsThereIsCountedWhereItIsOfNoThing) {
  PointCloud cloud = LaidTable().Seen(0.0, 1);
  EXPECT_EQ(SegmentTabletop(cloud, std::nullopt, {}, base::Rng(1)).num_over, 0) << "things are";
  std::vector<Eigen::Vector3f> few;
  for (std::size_t i = 0; i < cloud.points.size(); i += 7) few.push_back(cloud.points[i]);
  cloud.width = static_cast<int>(few.size());
  cloud.height = 1;
  cloud.points = few;
  const Segmentation out = SegmentTabletop(cloud, std::nullopt, {}, base::Rng(1));
  ASSERT_TRUE(out.table);
  EXPECT_NEAR(out.table->offset, kOver, 0.01);
  EXPECT_EQ(out.num_things, 0);
  EXPECT_GT(out.num_over, 100);
}

/// Points of a level plane 0.5 m below and 0.6 to 1.6 m before the camera.
std::vector<Vector3d> LevelPlane(double sd, int seed) {
  base::Rng rng(seed);
  std::vector<Vector3d> points;
  for (int i = 0; i < 5000; ++i)
    points.emplace_back(rng.Uniform(-0.5, 0.5), 0.5 + rng.Normal(0.0, sd), rng.Uniform(0.6, 1.6));
  return points;
}

TEST(LevelPatchesTest, TellTheScatterOfAPlaneAmongThings) {
  for (const double sd : {0.001, 0.004, 0.01}) {
    std::vector<Vector3d> points = LevelPlane(sd, 1);
    for (int i = 0; i < 1500; ++i) {  // upright, at every other place along the plane
      const double x = -0.4 + 0.2 * (i % 5), z = 0.7 + 0.2 * (i / 5 % 5);
      points.emplace_back(x, 0.5 - 0.0005 * (i / 5), z);
    }
    double least = 1e9, most = 0.0;
    for (const LevelPatch& patch : LevelPatchesIn(points, -Vector3d::UnitY(), 0.3)) {
      if (std::abs(patch.p_C.y() - 0.5) > 0.01) continue;
      least = std::min(least, patch.scatter);
      most = std::max(most, patch.scatter);
    }
    EXPECT_GT(least, 0.6 * sd);
    EXPECT_LT(most, 2.5 * sd + 0.005);
    const double scatter =
        ScatterOn(LevelPatchesIn(points, -Vector3d::UnitY(), 0.3), -Vector3d::UnitY(), 0.5);
    EXPECT_GT(scatter, 0.7 * sd / DepthNoise(1.4));
    EXPECT_LT(scatter, 1.3 * sd / DepthNoise(0.9));
  }
}

TEST(LevelPatchesTest, AWallHasNone) {
  std::vector<Vector3d> points = LevelPlane(0.002, 1);
  for (Vector3d& p : points) p = {p.x(), p.z() - 1.0, 1.0 + p.y()};
  EXPECT_TRUE(LevelPatchesIn(points, -Vector3d::UnitY(), 0.3).empty());
  EXPECT_EQ(ScatterOf({}), 0.0);
}

}  // namespace
}  // namespace hires::perception::table_over_floor_test
