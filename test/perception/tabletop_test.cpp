#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "hires/perception/depth_sensor.h"
#include "hires/perception/line_of_sight.h"
#include "hires/perception/segmentation.h"
#include "perception/patches/convex_patches.h"
#include "perception/tabletop/surfels.h"
#include "support/rounds.h"

namespace hires::perception::tabletop_test {
namespace {

using Eigen::Vector3d;

constexpr double kTableHeight = 0.75;

/// A table of 1.2 m by 0.8 m and things on it, seen by a camera 0.6 m above it.
class TableScene {
 public:
  explicit TableScene(double width = 0.8) : TableScene(width, -0.6, 0.6) {}
  /// The table from `right` to `left` along y.
  TableScene(double width, double right, double left) {
    Put(geometry::Box{{width, left - right, 0.04}}, {0.0, 0.5 * (left + right), -0.02});
  }
  /// Of what stands on the table at z = 0.
  TableScene& Put(const geometry::Shape& shape, const Vector3d& p_T, double yaw = 0.0) {
    world::StaticBody body;
    body.name = "thing" + std::to_string(world_.statics.size());
    body.X_MB.translation = p_T + Vector3d(0.0, 0.0, kTableHeight);
    body.X_MB.rotation = Eigen::AngleAxisd(yaw, Vector3d::UnitZ());
    body.collisions.emplace_back();
    body.collisions.back().shape = shape;
    world_.statics.push_back(body);
    return *this;
  }
  TableScene& PutBox(const Vector3d& size, double x, double y, double z = 0.0, double yaw = 0.0) {
    return Put(geometry::Box{size}, {x, y, z + size.z() / 2.0}, yaw);
  }
  PointCloud Seen(int seed = 1, double max_range = 1.4) const {
    DepthSensorParams sensor;
    sensor.min_range = 0.4;
    sensor.max_range = max_range;  // 1.4: before the floor, a larger plane than a small table
    const LineOfSight sight(std::make_shared<Surroundings>(world_), {});
    base::Rng rng(seed);
    return Measure(sight.Look(camera(), 5.0), camera(), sensor, &rng);
  }
  static PinholeCamera camera() {
    return LookAt({-0.7, 0.0, kTableHeight + 0.6}, {0.0, 0.0, kTableHeight}, 320, 240, 1.0);
  }
  static Vector3d Up() {  // in the optical frame: x right, y down, z forward
    const Vector3d up_C = camera().X_MC.rotation.conjugate() * Vector3d::UnitZ();
    return {-up_C.y(), -up_C.z(), up_C.x()};
  }
  static CameraStand Stand() { return {Up(), kTableHeight + 0.6}; }

 private:
  world::World world_;
};

/// Label of most of the points within `reach` of a point on the table.
int LabelAround(const PointCloud& cloud, const Segmentation& out, const Vector3d& p_T,
                double reach = 0.02) {
  const Vector3d p_M = p_T + Vector3d(0.0, 0.0, kTableHeight);
  const Vector3d p = TableScene::camera().X_MC.Inverse() * p_M;
  const Eigen::Vector3f p_C(-p.y(), -p.z(), p.x());
  std::map<int, int> votes;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (IsMeasured(cloud.points[i]) && (cloud.points[i] - p_C).norm() < reach)
      ++votes[out.labels[i]];
  const auto most = std::max_element(
      votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == votes.end() ? -1 : most->first;
}

Segmentation Segment(const PointCloud& cloud) {
  return SegmentTabletop(cloud, TableScene::Stand(), {}, base::Rng(1));
}

/// The plate of 0.4 m by 0.3 m in the middle of the table, believed `higher` [m] and turned by
/// `tilt` [rad] about the camera's x axis.
Table PlateBelieved(double higher, double tilt) {
  Table plate;
  plate.normal = Eigen::AngleAxisd(tilt, Vector3d::UnitX()) * TableScene::Up();
  const Vector3d p = TableScene::camera().X_MC.Inverse() * Vector3d(0.0, 0.0, kTableHeight);
  const Vector3d middle_C(-p.y(), -p.z(), p.x());
  plate.offset = -plate.normal.dot(middle_C) - higher;
  plate.along_x = Vector3d::UnitX();
  plate.along_y = plate.normal.cross(plate.along_x);
  const Eigen::Vector2d middle = plate.FromAbove(middle_C);
  for (const auto& [x, y] :
       {std::pair(-0.2, -0.15), std::pair(0.2, -0.15), std::pair(0.2, 0.15), std::pair(-0.2, 0.15)})
    plate.outline.push_back(middle + Eigen::Vector2d(x, y));
  return plate;
}

/// A camera that sits 5 mm and 0.3 degrees otherwise than it is believed to.
TEST(PlateInTest, APlateThatIsBelievedElsewhereIsWhereTheCloudHasIt) {
  TableScene scene;
  scene.PutBox({0.1, 0.08, 0.12}, 0.05, 0.0);  // a tenth of it is covered
  const PointCloud cloud = scene.Seen();
  const Table truth = PlateBelieved(0.0, 0.0);
  for (const double higher : {-0.02, -0.008, 0.0, 0.008, 0.02}) {
    for (const double tilt : {-0.015, 0.0, 0.015}) {
      const Table found = PlateIn(cloud, PlateBelieved(higher, tilt), {});
      EXPECT_LT(std::acos(std::min(1.0, found.normal.dot(truth.normal))), 0.006)
          << higher << ", " << tilt;
      for (const Eigen::Vector2d& corner : found.outline)
        EXPECT_NEAR(truth.HeightOf(found.Lift(corner)), 0.0, 0.002) << higher << ", " << tilt;
    }
  }
}

TEST(PlateInTest, WhatIsFartherOffThanACalibrationIsLeftAsItWasBelieved) {
  const PointCloud cloud = TableScene().Seen();
  for (const double higher : {-0.06, 0.06}) {
    const Table believed = PlateBelieved(higher, 0.0);
    EXPECT_EQ(PlateIn(cloud, believed, {}).offset, believed.offset);
  }
  const Table believed = PlateBelieved(0.0, 0.0);
  EXPECT_EQ(PlateIn({}, believed, {}).offset, believed.offset);
  EXPECT_EQ(PlateIn({}, believed, {}).outline, believed.outline);
}

TEST(FindTableTest, ThePlaneIsFoundBesideWhatStandsOnIt) {
  TableScene scene;
  scene.PutBox({0.3, 0.4, 0.2}, 0.1, 0.0);
  const auto table = FindTable(scene.Seen(), std::nullopt, {});
  ASSERT_TRUE(table.has_value());
  EXPECT_LT(std::acos(table->normal.dot(TableScene::Up())), 0.003);
  EXPECT_NEAR(table->offset, 0.6, 0.001);
  EXPECT_FALSE(geometry::Contains(table->outline, table->FromAbove(-0.6 * table->normal)))
      << "the table begins 0.3 m in front of the camera's foot";
}

TEST(FindTableTest, WhatIsNoTableIsNotFound) {
  PointCloud cloud;
  EXPECT_FALSE(FindTable(cloud, std::nullopt, {}));
  cloud.points.assign(1000, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_FALSE(FindTable(cloud, std::nullopt, {}));
  cloud.points.assign(1000, Eigen::Vector3f(0.0F, 0.0F, 1.0F));
  EXPECT_FALSE(FindTable(cloud, std::nullopt, {})) << "one point, often";
  base::Rng rng(1);
  for (auto& p : cloud.points)
    p = Eigen::Vector3d(rng.Uniform(-0.5, 0.5), rng.Uniform(-0.5, 0.5), 1.0).cast<float>();
  EXPECT_TRUE(FindTable(cloud, std::nullopt, {}));
  EXPECT_FALSE(FindTable(cloud, CameraStand{-Vector3d::UnitY(), 1.0}, {})) << "a wall";
}

// The floor is the larger plane, and what is beside the table or high above it is no thing on it.
TEST(FindTableTest, TheLargerFloorIsNoTable) {
  TableScene scene(0.3);
  scene.PutBox({0.05, 0.05, 0.1}, 0.0, 0.0);
  scene.PutBox({0.3, 2.0, 2.0}, 0.9, 0.0, -kTableHeight);
  const PointCloud cloud = scene.Seen(1, 3.0);
  const auto blind = FindTable(cloud, std::nullopt, {});
  ASSERT_TRUE(blind.has_value());
  EXPECT_NEAR(blind->offset, 0.6, 0.003) << "also for who does not know how the camera stands";
  const Segmentation out = Segment(cloud);
  ASSERT_TRUE(out.table.has_value());
  EXPECT_NEAR(out.table->offset, 0.6, 0.003);
  EXPECT_EQ(out.num_things, 1);
  EXPECT_EQ(LabelAround(cloud, out, {0.0, 0.0, 0.1}), kLabelFirstThing);
  EXPECT_FALSE(FindTable(cloud, CameraStand{TableScene::Up(), 4.0}, {}))
      << "nothing level is as high as tables";
}

/// Two tables with a gap between them, the right one 0.05 m lower, and a box on each.
TableScene TwoTables(double left_length, double right_length, double gap) {
  TableScene scene(0.6, 0.5 * gap, 0.5 * gap + left_length);
  scene.PutBox({0.6, right_length, 0.04}, 0.0, -0.5 * (gap + right_length), -0.05 - 0.04);
  scene.PutBox({0.1, 0.1, 0.15}, 0.0, 0.25).PutBox({0.1, 0.1, 0.15}, 0.0, -0.25, -0.05);
  return scene;
}

TEST(FindTableTest, OfTwoTablesTheLargerOneIsFoundWithItsThingsAlone) {
  for (const double gap : {0.12, 0.16}) {
    for (int seed = 1; seed <= 5; ++seed) {
      const PointCloud left = TwoTables(0.40, 0.30, gap).Seen(seed);
      const PointCloud right = TwoTables(0.30, 0.40, gap).Seen(seed);
      const auto segment = [&](const PointCloud& cloud) {
        return SegmentTabletop(cloud, TableScene::Stand(), {}, base::Rng(seed));
      };
      const Segmentation of_left = segment(left), of_right = segment(right);
      ASSERT_TRUE(of_left.table && of_right.table) << gap << " " << seed;
      EXPECT_NEAR(of_left.table->offset, 0.60, 0.003) << gap << " " << seed;
      EXPECT_NEAR(of_right.table->offset, 0.65, 0.003) << gap << " " << seed;
      EXPECT_EQ(of_left.num_things, 1) << gap << " " << seed;
      EXPECT_EQ(of_right.num_things, 1) << gap << " " << seed;
      EXPECT_EQ(LabelAround(left, of_left, {0.0, 0.25, 0.15}), kLabelFirstThing);
      EXPECT_EQ(LabelAround(right, of_right, {0.0, -0.25, 0.10}), kLabelFirstThing);
      EXPECT_EQ(LabelAround(left, of_left, {0.0, -0.25, 0.10}), kLabelNone);
      EXPECT_EQ(LabelAround(right, of_right, {0.0, 0.25, 0.15}), kLabelNone);
      EXPECT_EQ(segment(left).labels, of_left.labels) << "the same bits each time";
    }
  }
}

// A wall crosses every plane, in a strip as long as it is, and goes on below it.
TEST(FindTableTest, AWallBehindTheTableIsNoPartOfIt) {
  constexpr double kEye = 1.5;                 // [m] above the floor
  for (const double wall : {1.9, 2.4, 3.1}) {  // [m] before the camera; the table ends at 1.9
    PointCloud cloud;
    base::Rng noise(1);
    const auto see = [&](double x, double y, double z) {
      const double depth = 1.0 + noise.Normal(0.0, DepthNoise(x)) / x;
      cloud.points.push_back((depth * Vector3d(-y, kEye - z, x)).cast<float>());
    };
    for (double y = -0.7; y < 0.7; y += 0.015)
      for (double x = 1.3; x < 1.9; x += 0.015) see(x, y, kTableHeight);
    for (double y = -1.6; y < 1.6; y += 0.01)
      for (double z = 0.5; z < 1.3; z += 0.01) see(wall, y, z);
    cloud.width = static_cast<int>(cloud.points.size());
    const auto table = FindTable(cloud, CameraStand{-Vector3d::UnitY(), kEye}, {});
    ASSERT_TRUE(table.has_value()) << wall;
    const auto is_on = [&](double x, double y) {
      return geometry::Contains(table->outline,
                                table->FromAbove(Vector3d(-y, kEye - kTableHeight, x)));
    };
    EXPECT_TRUE(is_on(1.4, 0.6) && is_on(1.8, -0.6)) << wall;
    EXPECT_FALSE(is_on(wall - 0.02, 1.0) || is_on(wall + 0.03, 0.0) || is_on(2.0, 0.0)) << wall;
  }
}

// Seen from afar it hides what of the wall is below its plane, as far as the sensor tells planes.
TEST(FindTableTest, AWallWhoseFootTheTableHidesIsNoPartOfIt) {
  constexpr double kEye = 1.5, kEdge = 2.75, kWall = kEdge + 0.09;  // [m]
  PointCloud cloud;
  base::Rng noise(1);
  const auto see = [&](double x, double y, double z) {
    const double depth = 1.0 + noise.Normal(0.0, DepthNoise(x)) / x;
    cloud.points.push_back((depth * Vector3d(-y, kEye - z, x)).cast<float>());
  };
  for (double y = -1.4; y < 1.4; y += 0.006) {
    for (double x = kEdge - 0.7; x < kEdge; x += 0.015) see(x, y, kTableHeight);
    const double hidden = kTableHeight - (kEye - kTableHeight) * (kWall / kEdge - 1.0);
    for (double z = hidden; z < 1.4; z += 0.006) see(kWall, y, z);
  }
  cloud.width = static_cast<int>(cloud.points.size());
  const Segmentation out =
      SegmentTabletop(cloud, CameraStand{-Vector3d::UnitY(), kEye}, {}, base::Rng(1));
  ASSERT_TRUE(out.table.has_value());
  const auto is_on = [&](double x, double y) {
    return geometry::Contains(out.table->outline,
                              out.table->FromAbove(Vector3d(-y, kEye - kTableHeight, x)));
  };
  EXPECT_TRUE(is_on(kEdge - 0.6, 1.3) && is_on(kEdge - 0.1, -1.3));
  EXPECT_FALSE(is_on(kEdge + 0.06, 0.0));
  EXPECT_EQ(out.num_things, 0);
}

TEST(FindTableTest, AWallAloneIsNoTable) {
  for (const double lowest : {0.0, 0.75, 1.0}) {  // [m] above the floor, that the camera sees
    for (int seed = 1; seed <= 10; ++seed) {
      PointCloud cloud;
      base::Rng noise(seed);
      for (double y = -1.0; y < 1.0; y += 0.01) {
        for (double z = lowest; z < lowest + 0.6; z += 0.01) {
          const double depth = 1.0 + noise.Normal(0.0, DepthNoise(3.0)) / 3.0;
          cloud.points.push_back((depth * Vector3d(-y, 1.5 - z, 3.0)).cast<float>());
        }
      }
      EXPECT_FALSE(FindTable(cloud, CameraStand{-Vector3d::UnitY(), 1.5}, {}))
          << lowest << ", " << seed;
    }
  }
}

TEST(FindTableTest, WithoutAStandTheTableIsFoundBeforeWallAndFloor) {
  for (int seed = 1; seed <= 12; ++seed) {
    base::Rng rng(seed);
    TableScene scene(rng.Uniform(0.5, 0.9), -0.5, rng.Uniform(0.3, 0.7));
    const double wall = rng.Uniform(0.5, 2.5);  // [m] behind the table's middle, or at its edge
    scene.Put(geometry::Box{{0.1, 8.0, 5.0}}, {wall, 0.0, 0.0});
    scene.PutBox({0.1, 0.1, 0.2}, 0.0, 0.0);
    const auto table = FindTable(scene.Seen(seed, 8.0), std::nullopt, {});
    ASSERT_TRUE(table) << seed;
    EXPECT_NEAR(table->offset, 0.6, 0.02) << seed;
    EXPECT_GT(table->normal.dot(TableScene::Up()), std::cos(0.03)) << seed;
  }
}

TEST(FindTableTest, WithoutAStandAWallIsNoTableUnlessItIsNearAndLookedAtStraightOn) {
  const auto wall = [](double pitch, double distance, int seed) {
    PointCloud cloud;
    base::Rng noise(seed);
    for (double x = -0.4; x < 0.4; x += 0.01) {
      for (double y = -0.4; y < 0.4; y += 0.01) {  // the ray (x, y, 1) of a camera that looks down
        const double z = distance / (std::cos(pitch) - y * std::sin(pitch));
        cloud.points.push_back(
            ((z + noise.Normal(0.0, DepthNoise(z))) * Vector3d(x, y, 1.0)).cast<float>());
      }
    }
    return cloud;
  };
  for (int seed = 1; seed <= 10; ++seed) {
    base::Rng rng(seed);
    EXPECT_FALSE(FindTable(wall(rng.Uniform(0.35, 1.0), rng.Uniform(1.0, 4.0), seed), {}, {}))
        << seed;
    EXPECT_FALSE(FindTable(wall(0.0, rng.Uniform(2.6, 5.0), seed), {}, {})) << seed;
    EXPECT_TRUE(FindTable(wall(0.0, rng.Uniform(0.6, 2.0), seed), {}, {})) << "from above";
  }
}

// A plane that leans is as high as a table below the camera, and lies on the floor where its points
// are.
TEST(FindTableTest, TheFloorIsNoTableForALeaningPlaneEither) {
  constexpr double kEye = 1.35;  // [m] above the floor
  for (int seed = 1; seed <= 20; ++seed) {
    PointCloud cloud;
    base::Rng noise(seed);
    for (double x = 1.2; x < 3.4; x += 0.02) {
      for (double y = -1.0; y < 1.0; y += 0.02) {
        const double z = noise.Normal(0.0, 0.003 * x * x);
        cloud.points.push_back(Vector3d(-y, kEye - z, x).cast<float>());
      }
    }
    cloud.width = static_cast<int>(cloud.points.size());
    EXPECT_FALSE(FindTable(cloud, CameraStand{-Vector3d::UnitY(), kEye}, {})) << seed;
  }
}

/// Points every 2 mm whose height is a function of x, seen from above.
template <typename Height>
PointCloud Profile(Height height, double noise = 0.0) {
  PointCloud cloud;
  base::Rng rng(1);
  for (double x = -0.1; x < 0.1; x += 0.002) {
    for (double y = -0.1; y < 0.1; y += 0.002) {
      cloud.points.push_back(
          Vector3d(x, y, 1.0 - height(x) + rng.Normal(0.0, noise)).cast<float>());
    }
  }
  cloud.width = static_cast<int>(cloud.points.size());
  return cloud;
}

std::vector<int> PatchesOf(const PointCloud& cloud, const std::vector<int>& indices) {
  const ConvexPartParams params;
  return FindConvexPatches(
      cloud.points, cloud.width, cloud.height, indices,
      {params.voxel, params.seed, params.max_concavity, params.max_step, params.min_supervoxels});
}

/// Of more than a hundred points.
int NumPatches(const PointCloud& cloud) {
  std::vector<int> all(cloud.points.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  std::map<int, int> sizes;
  for (const int patch : PatchesOf(cloud, all)) ++sizes[patch];
  sizes.erase(0);
  return static_cast<int>(
      std::count_if(sizes.begin(), sizes.end(), [](const auto& one) { return one.second > 100; }));
}

TEST(FindConvexPatchesTest, OnlyAConcaveEdgeDivides) {
  EXPECT_EQ(NumPatches(Profile([](double) { return 0.0; }, 0.001)), 1) << "a plane";
  EXPECT_EQ(NumPatches(Profile([](double x) { return -std::abs(x); }, 0.001)), 1) << "a roof";
  EXPECT_EQ(NumPatches(Profile([](double x) { return std::abs(x); }, 0.001)), 2) << "a valley";
}

TEST(FindConvexPatchesTest, NothingMakesNoPatches) {
  EXPECT_TRUE(PatchesOf({}, {}).empty());
  const PointCloud cloud = Profile([](double) { return 0.0; });
  EXPECT_EQ(PatchesOf(cloud, {}), std::vector<int>(cloud.points.size(), 0));
}

TEST(SegmentTabletopTest, ThingsAreToldFromTheTableAndFromEachOther) {
  TableScene scene;
  scene.PutBox({0.08, 0.08, 0.15}, 0.0, -0.2).PutBox({0.1, 0.1, 0.05}, 0.0, 0.2);
  scene.Put(geometry::Cylinder{0.04, 0.12}, {0.15, 0.0, 0.06});
  const PointCloud cloud = scene.Seen();
  const Segmentation out = Segment(cloud);
  EXPECT_EQ(out.num_things, 3);
  const std::set<int> labels{LabelAround(cloud, out, {0.0, -0.2, 0.15}),
                             LabelAround(cloud, out, {0.0, 0.2, 0.05}),
                             LabelAround(cloud, out, {0.15, 0.0, 0.12})};
  EXPECT_EQ(labels, (std::set<int>{2, 3, 4}));
  EXPECT_EQ(LabelAround(cloud, out, {-0.2, 0.0, 0.0}), kLabelTable);
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    ASSERT_TRUE(IsMeasured(cloud.points[i]) || out.labels[i] == kLabelNone);
}

TEST(SegmentTabletopTest, AThingOnAnotherIsAThing) {
  TableScene scene;
  scene.PutBox({0.25, 0.25, 0.08}, 0.0, 0.0).PutBox({0.12, 0.15, 0.08}, 0.05, 0.0, 0.08, 0.5);
  const PointCloud cloud = scene.Seen();
  const Segmentation out = Segment(cloud);
  EXPECT_EQ(out.num_things, 2);
  EXPECT_NE(LabelAround(cloud, out, {0.05, 0.0, 0.16}), LabelAround(cloud, out, {-0.1, 0.1, 0.08}));
}

TEST(SegmentTabletopTest, WhatGoesOnBehindSomethingIsOne) {
  TableScene scene;
  scene.PutBox({0.1, 0.4, 0.1}, 0.1, 0.0).PutBox({0.05, 0.06, 0.3}, -0.1, 0.0);
  const PointCloud cloud = scene.Seen();
  const Segmentation out = Segment(cloud);
  EXPECT_EQ(out.num_things, 2);
  EXPECT_EQ(LabelAround(cloud, out, {0.1, -0.15, 0.1}), LabelAround(cloud, out, {0.1, 0.15, 0.1}));
}

TEST(SegmentTabletopTest, TwoAlikeWithAGapBetweenThemAreTwo) {
  TableScene scene;
  scene.PutBox({0.1, 0.1, 0.1}, 0.1, -0.1).PutBox({0.1, 0.1, 0.1}, 0.1, 0.1);
  EXPECT_EQ(Segment(scene.Seen()).num_things, 2) << "their faces go on, but one looks between them";
}

/// Whether nothing else has a label that most of the points about these places have.
void ExpectApart(const PointCloud& cloud, const Segmentation& out, const std::vector<Vector3d>& p_T,
                 const std::string& what) {
  std::set<int> labels;
  for (const Vector3d& p : p_T) {
    const int label = LabelAround(cloud, out, p);
    EXPECT_GE(label, kLabelFirstThing) << what << ": a thing is lost at " << p.transpose();
    EXPECT_TRUE(labels.insert(label).second) << what << ": a thing is joined at " << p.transpose();
  }
}

// Their fronts are 5 cm behind each other by turns, and they nearly touch.
TEST(SegmentTabletopTest, BoxesOfARowAreSeveral) {
  for (int seed = 1; seed <= test_support::Rounds(16); ++seed) {
    base::Rng rng(seed);
    TableScene scene;
    std::vector<Vector3d> tops;
    double y = -0.42;
    for (int i = 0; y < 0.3; ++i) {
      const double width = rng.Uniform(0.13, 0.18), height = rng.Uniform(0.11, 0.15);
      const double x = i % 2 == 0 ? 0.0 : 0.05;
      y += width / 2.0;
      scene.PutBox({0.12, width, height}, x, y);
      tops.emplace_back(x, y, height);
      y += width / 2.0 + rng.Uniform(0.006, 0.012);
    }
    const PointCloud cloud = scene.Seen(seed);
    ExpectApart(cloud, Segment(cloud), tops, "seed " + std::to_string(seed));
  }
}

// No gap shows the table behind a row that crosses all of it.
TEST(SegmentTabletopTest, WhatStandsBehindWhereTheSeenTableEndsIsNotLost) {
  for (int seed = 1; seed <= test_support::Rounds(16); ++seed) {
    base::Rng rng(seed);
    TableScene scene;
    for (int i = 0; i < 7; ++i) scene.PutBox({0.08, 0.19, 0.16}, 0.1, -0.57 + 0.19 * i);
    std::vector<Vector3d> tops;
    for (double y = -0.35; y < 0.4; y += rng.Uniform(0.2, 0.25)) {
      const double height = rng.Uniform(0.2, 0.24);
      scene.Put(geometry::Cylinder{rng.Uniform(0.04, 0.05), height}, {0.3, y, height / 2.0});
      tops.emplace_back(0.3, y, height);
    }
    const PointCloud cloud = scene.Seen(seed, 1.6);
    const Segmentation out = Segment(cloud);
    ExpectApart(cloud, out, tops, "seed " + std::to_string(seed));
    for (const Vector3d& p : tops) {
      const int label = LabelAround(cloud, out, p);
      if (label >= kLabelFirstThing) {
        EXPECT_TRUE(out.may_be_beside.at(label - kLabelFirstThing));
      }
    }
  }
}

TEST(SegmentTabletopTest, OneFarPointChangesNothing) {
  for (int seed = 1; seed <= test_support::Rounds(16); ++seed) {
    base::Rng rng(seed);
    TableScene scene;
    scene.PutBox({0.08, 0.08, 0.15}, 0.0, rng.Uniform(-0.3, -0.1))
        .PutBox({0.1, 0.1, 0.05}, 0.0, 0.2);
    PointCloud cloud = scene.Seen(seed);
    const int stray = rng.Index(static_cast<int>(cloud.points.size()));
    cloud.points[stray].setConstant(std::numeric_limits<float>::quiet_NaN());
    const Segmentation without = Segment(cloud);
    const double distance = std::pow(10.0, rng.Uniform(1.1, 4.0));
    cloud.points[stray] =
        (distance * Vector3d(rng.Uniform(-0.5, 0.5), rng.Uniform(-0.4, 0.4), 1.0)).cast<float>();
    const Segmentation with = Segment(cloud);
    ASSERT_TRUE(without.table && with.table) << seed;
    EXPECT_EQ(with.labels, without.labels) << seed << ", " << distance;
    EXPECT_EQ(with.table->offset, without.table->offset) << seed << ", " << distance;
    EXPECT_EQ(with.table->outline, without.table->outline) << seed << ", " << distance;
  }
}

/// A tub of 16 thin walls.
void PutTub(TableScene* scene, double radius, double height) {
  constexpr int kWalls = 16;
  constexpr double kHalfTurn = EIGEN_PI;
  for (int i = 0; i < kWalls; ++i) {
    const double angle = 2.0 * kHalfTurn * i / kWalls;
    scene->Put(geometry::Box{{0.004, 2.02 * radius * std::tan(kHalfTurn / kWalls), height}},
               {radius * std::cos(angle), radius * std::sin(angle), height / 2.0}, angle);
  }
}

TEST(SegmentTabletopTest, AVesselIsOneWithItsFloor) {
  TableScene scene;
  PutTub(&scene, 0.12, 0.08);
  const PointCloud cloud = scene.Seen();
  const Segmentation out = Segment(cloud);
  EXPECT_EQ(out.num_things, 1);
  EXPECT_EQ(LabelAround(cloud, out, {0.03, 0.0, 0.0}), kLabelFirstThing) << "its floor";
  EXPECT_EQ(LabelAround(cloud, out, {-0.2, 0.0, 0.0}), kLabelTable) << "before it";
}

TEST(SegmentTabletopTest, WhatStandsInAVesselIsAThing) {
  TableScene scene;
  PutTub(&scene, 0.15, 0.06);
  scene.Put(geometry::Cylinder{0.035, 0.16}, {0.0, 0.0, 0.08});
  const PointCloud cloud = scene.Seen();
  const Segmentation out = Segment(cloud);
  EXPECT_NE(LabelAround(cloud, out, {0.0, 0.0, 0.16}), LabelAround(cloud, out, {0.15, 0.0, 0.05}));
}

TEST(SegmentTabletopTest, AnEmptyTableHasNoThings) {
  const Segmentation out = Segment(TableScene().Seen());
  EXPECT_TRUE(out.table.has_value());
  EXPECT_EQ(out.num_things, 0);
  const Segmentation nothing = Segment({});
  EXPECT_FALSE(nothing.table.has_value());
  EXPECT_TRUE(nothing.labels.empty());
}

// The camera sees over the edge that it goes on below the table's plane.
TEST(SegmentTabletopTest, WhatIsBesideTheTableIsNoThingOnIt) {
  for (int seed = 1; seed <= test_support::Rounds(16); ++seed) {
    base::Rng rng(seed);
    TableScene scene(0.4);
    const Vector3d size(rng.Uniform(0.05, 0.25), rng.Uniform(0.08, 0.3),
                        kTableHeight + rng.Uniform(0.05, 0.25));
    const double gap = rng.Uniform(0.1, 0.2);  // from the table's edge
    scene.PutBox(size, 0.2 + gap + size.x() / 2.0, rng.Uniform(-0.3, 0.3), -kTableHeight);
    scene.PutBox({0.08, 0.08, 0.1}, 0.1, 0.0);
    EXPECT_EQ(Segment(scene.Seen(seed)).num_things, 1) << seed;
  }
}

// The cloud's order is not used: who drives with a camera that gives lists of points gets the same.
TEST(SegmentTabletopTest, AnUnorganisedCloudIsDividedAlike) {
  TableScene scene;
  scene.PutBox({0.25, 0.25, 0.08}, 0.0, 0.0).PutBox({0.12, 0.15, 0.08}, 0.05, 0.0, 0.08, 0.5);
  const PointCloud cloud = scene.Seen();
  PointCloud list;
  for (auto it = cloud.points.rbegin(); it != cloud.points.rend(); ++it)
    if (IsMeasured(*it)) list.points.push_back(*it);
  list.width = static_cast<int>(list.points.size());
  const Segmentation out = Segment(list), again = Segment(list);
  EXPECT_EQ(out.num_things, 2);
  EXPECT_EQ(out.labels, again.labels);
}

// Of a wall of 0.3 m x 0.3 m, one point a millimetre.
TEST(SurfelTest, CellsGrowWhereThereWouldBeTooManySurfels) {
  PointCloud cloud{300, 300, {}};
  std::vector<int> all;
  for (int i = 0; i < 300 * 300; ++i) {
    cloud.points.emplace_back(1e-3F * (i % 300) + 5e-4F, 1e-3F * (i / 300) + 5e-4F, 1.0F);
    all.push_back(i);
  }
  SurfelParams params;
  params.cell = 0.005;
  params.max_cell = 0.01;
  const auto count = [&](int many) {
    params.many = many;
    return MakeSurfels(cloud, all, params).surfels.size();
  };
  EXPECT_EQ(count(60 * 60), 60u * 60u);
  EXPECT_NEAR(static_cast<double>(count(40 * 40)), 40.0 * 40.0, 2.0 * 40.0);
  EXPECT_EQ(count(10), 30u * 30u);
}

}  // namespace
}  // namespace hires::perception::tabletop_test
