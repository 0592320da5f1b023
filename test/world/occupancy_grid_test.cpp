#include "hires/world/occupancy_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/geometry/angles.h"

namespace hires::world::occupancy_grid_test {
namespace {

using testing::HasSubstr;

geometry::Collision Shape(const geometry::Shape& shape, const Eigen::Vector3d& at = {0, 0, 0}) {
  geometry::Collision collision{"shape", shape, {}, 1.0, 0.0};
  collision.X_BS.translation = at;
  return collision;
}

World WorldOf(const std::vector<geometry::Collision>& shapes, double yaw = 0.0) {
  World world;
  world.statics.push_back(
      {"body", {Eigen::Vector3d::Zero(), geometry::RotationFromRpy(0, 0, yaw)}, shapes});
  return world;
}

int CountOccupied(const OccupancyGrid& grid) {
  return static_cast<int>(std::count(grid.cells.begin(), grid.cells.end(), Cell::kOccupied));
}

/// The cell that holds a point; free outside the grid.
Cell CellAt(const OccupancyGrid& grid, const Eigen::Vector2d& point) {
  const Eigen::Vector2d cell = (point - grid.origin) / grid.resolution;
  const int column = static_cast<int>(std::floor(cell.x()));
  const int row = static_cast<int>(std::floor(cell.y()));
  const bool is_inside = column >= 0 && row >= 0 && column < grid.width && row < grid.height;
  return is_inside ? grid.at(column, row) : Cell::kFree;
}

OccupancyGrid RandomGrid(base::Rng rng, double share) {
  OccupancyGrid grid;
  grid.resolution = 0.05;
  grid.width = 1 + rng.Index(30);
  grid.height = 1 + rng.Index(30);
  grid.origin = {0.05 * rng.Index(200) - 5.0, 0.05 * rng.Index(200) - 5.0};
  for (int i = 0; i < grid.width * grid.height; ++i) {
    grid.cells.push_back(rng.Bernoulli(share) ? Cell::kOccupied : Cell::kFree);
  }
  return grid;
}

TEST(OccupancyGridTest, CentreIsHalfACellInside) {
  OccupancyGrid grid;
  grid.origin = {1.0, 2.0};
  EXPECT_TRUE(grid.CentreOf(0, 0).isApprox(Eigen::Vector2d(1.025, 2.025)));
  EXPECT_TRUE(grid.CentreOf(9, 3).isApprox(Eigen::Vector2d(1.475, 2.175)));
}

TEST(SliceWorldTest, BoxOnCellEdgesCoversItsCellsOnly) {
  const World world = WorldOf({Shape(geometry::Box{{0.2, 0.1, 1.0}}, {0.1, 0.05, 0.5})});
  const OccupancyGrid grid = SliceWorld(world, 0.3, 0.3, 0.05, 0.1);
  EXPECT_EQ(grid.width, 8);
  EXPECT_EQ(grid.height, 6);
  EXPECT_TRUE(grid.origin.isApprox(Eigen::Vector2d(-0.1, -0.1), 1e-12));
  EXPECT_EQ(CountOccupied(grid), 4 * 2);
  EXPECT_EQ(grid.at(2, 2), Cell::kOccupied);
  EXPECT_EQ(grid.at(1, 2), Cell::kFree);
}

TEST(SliceWorldTest, CellsThatAreTouchedInPartAreOccupied) {
  const World world = WorldOf({Shape(geometry::Box{{0.12, 0.05, 1.0}}, {0.06, 0.025, 0.5})});
  EXPECT_EQ(CountOccupied(SliceWorld(world, 0.3, 0.3, 0.05)), 3);
}

TEST(SliceWorldTest, OnlyWhatReachesIntoTheBandCounts) {
  const World world = WorldOf({Shape(geometry::Box{{0.1, 0.1, 0.1}}, {0.05, 0.05, 0.65})});
  EXPECT_EQ(CountOccupied(SliceWorld(world, 0.0, 0.59)), 0);
  EXPECT_EQ(CountOccupied(SliceWorld(world, 0.0, 0.61)), 4);
  EXPECT_EQ(CountOccupied(SliceWorld(world, 0.65, 0.65)), 4);
}

TEST(SliceWorldTest, TurnedBoxCoversItsArea) {
  const World world =
      WorldOf({Shape(geometry::Box{{2.0, 1.0, 1.0}}, {0, 0, 0.5})}, geometry::kPi / 6);
  const OccupancyGrid grid = SliceWorld(world, 0.5, 0.5, 0.01);
  const double area = CountOccupied(grid) * 0.01 * 0.01;
  EXPECT_GT(area, 2.0);                              // all that is touched
  EXPECT_LT(area, 2.0 + 6.0 * 0.01 * std::sqrt(2));  // and no more than a cell around the rim
  EXPECT_EQ(CellAt(grid, {0.9 * std::cos(0.52), 0.9 * std::sin(0.52)}), Cell::kOccupied);
  EXPECT_EQ(CellAt(grid, {0.9 * std::cos(-0.52), 0.9 * std::sin(-0.52)}), Cell::kFree);
}

TEST(SliceWorldTest, EveryCellWithItsCentreInABodyIsOccupied) {
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(5).Fork(seed);
    const World world =
        WorldOf({Shape(geometry::Box{{rng.Uniform(0.01, 2), rng.Uniform(0.01, 2), 1}},
                       {rng.Uniform(-3, 3), rng.Uniform(-3, 3), 0.5})},
                rng.Uniform(-3, 3));
    const auto outlines = OutlinesInBand(world, nullptr, 0.5, 0.5);
    ASSERT_EQ(outlines.size(), 1u);
    const OccupancyGrid grid = SliceWorld(world, 0.5, 0.5);
    const double reach = 0.05 * std::sqrt(0.5) + 1e-9;  // centre to corner of a cell
    for (int row = 0; row < grid.height; ++row) {
      for (int column = 0; column < grid.width; ++column) {
        const Eigen::Vector2d p = grid.CentreOf(column, row);
        const bool is_occupied = grid.at(column, row) == Cell::kOccupied;
        EXPECT_TRUE(is_occupied || !geometry::Contains(outlines[0], p)) << "seed " << seed;
        EXPECT_TRUE(!is_occupied || geometry::Distance({p, p, p}, outlines[0]) <= reach) << seed;
      }
    }
  }
}

TEST(SliceWorldTest, EmptyWorldIsFree) {
  const OccupancyGrid grid = SliceWorld(World{}, 0.0, 1.0, 0.05, 0.0);
  EXPECT_EQ(grid.width, 1);
  EXPECT_EQ(CountOccupied(grid), 0);
}

TEST(SliceWorldTest, RefusesGridsThatWouldNotFit) {
  const World world = WorldOf({Shape(geometry::Box{{900, 900, 1}})});
  try {
    SliceWorld(world, 0.0, 1.0, 0.01);
    ADD_FAILURE() << "a grid of 8.1e9 cells was made";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("coarser resolution"));
  }
  EXPECT_THROW(SliceWorld(world, 0.0, 1.0, 0.0), std::logic_error);
  EXPECT_THROW(SliceWorld(world, 1.0, 0.0), std::logic_error);
}

World WithAreas(World world, const std::vector<Eigen::Vector2d>& areas) {
  for (const Eigen::Vector2d& p : areas) {
    const std::string name = "area" + std::to_string(world.frames.size());
    world.frames[name].translation = {p.x(), p.y(), 0.0};
  }
  return world;
}

TEST(MapRegionTest, GridsOfWorldsThatAreNotWideCoverAllWhateverAreasThereAre) {
  base::Rng rng(31);
  for (int i = 0; i < 100; ++i) {
    std::vector<geometry::Collision> shapes;
    for (int j = 1 + rng.Index(5); j > 0; --j) {
      shapes.push_back(Shape(geometry::Box{{rng.Uniform(0.1, 5), rng.Uniform(0.1, 5), 1}},
                             {rng.Uniform(-40, 40), rng.Uniform(-40, 40), rng.Uniform(-2, 9)}));
    }
    const World world = WorldOf(shapes);
    const OccupancyGrid all = SliceWorld(world, 0.1, 1.0, 0.5);
    const OccupancyGrid with = SliceWorld(WithAreas(world, {{1, 2}, {3, 4}}), 0.1, 1.0, 0.5);
    EXPECT_EQ(all.cells, with.cells);
    EXPECT_EQ(all.origin, with.origin);
    EXPECT_EQ(all.width, with.width);
  }
}

TEST(MapRegionTest, GridsOfWideWorldsHaveAllThatIsNearTheAreas) {
  base::Rng rng(32);
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector2d middle(rng.Uniform(-100, 100), rng.Uniform(-100, 100));
    std::vector<geometry::Collision> shapes{
        Shape(geometry::Box{{1, 1, 2}}, {-rng.Uniform(150, 900), -300, 1}),
        Shape(geometry::Box{{1, 1, 2}}, {rng.Uniform(150, 900), 300, 1}),
        Shape(geometry::Box{{9000, 9000, 1}}, {0, 0, -0.5}),
        Shape(geometry::Box{{9000, 1, 1}}, {0, 0, 20})};
    for (int j = 0; j < 30; ++j) {
      shapes.push_back(
          Shape(geometry::Cylinder{rng.Uniform(0.1, 3), 2},
                {middle.x() + rng.Uniform(-70, 70), middle.y() + rng.Uniform(-70, 70), 1}));
    }
    const World world = WithAreas(
        WorldOf(shapes), {middle, middle + Eigen::Vector2d(rng.Uniform(-9, 9), rng.Uniform(0, 9))});
    const OccupancyGrid grid = SliceWorld(world, 0.1, 1.0, 0.25, 2.0);
    EXPECT_LE(0.0625 * grid.width * grid.height, 1.1e4);
    const Eigen::Vector2d size = grid.resolution * Eigen::Vector2d(grid.width, grid.height);
    for (int j = 0; j < 500; ++j) {
      const Eigen::Vector2d p =
          grid.origin + size.cwiseProduct(Eigen::Vector2d(rng.Uniform(0, 1), rng.Uniform(0, 1)));
      bool is_in = false, is_close = false;
      for (std::size_t k = 4; k < shapes.size(); ++k) {
        const double radius = std::get<geometry::Cylinder>(shapes[k].shape).radius;
        const double off = (p - shapes[k].X_BS.translation.head<2>()).norm() - radius;
        is_in = is_in || off < 0.0;
        is_close = is_close || off < 0.4;
      }
      if (is_in) {
        EXPECT_EQ(CellAt(grid, p), Cell::kOccupied) << p.transpose();
      } else if (!is_close) {
        EXPECT_EQ(CellAt(grid, p), Cell::kFree) << p.transpose();
      }
    }
    for (const auto& [name, X_MF] : world.frames) {
      for (const double x : {-20.0, 20.0}) {
        const Eigen::Vector2d p = X_MF.translation.head<2>() + Eigen::Vector2d(x, 0.0);
        EXPECT_TRUE(((p - grid.origin).array() >= 0.0).all());
        EXPECT_TRUE(((grid.origin + size - p).array() >= 0.0).all());
      }
    }
  }
}

TEST(OutlinesInBandTest, ObjectsCountOnlyWhereAsked) {
  World world = WorldOf({Shape(geometry::Box{{1, 1, 1}})});
  ObjectModel mug{"mug", {}, {Shape(geometry::Cylinder{0.04, 0.1}, {0, 0, 0.05})}};
  world = WithModel(world, mug);
  WorldState state;
  state.objects.push_back({"mug1", "mug", {{3, 4, 0.2}, Eigen::Quaterniond::Identity()}, {}, ""});
  EXPECT_EQ(OutlinesInBand(world, nullptr, 0.2, 0.3).size(), 1u);
  const auto outlines = OutlinesInBand(world, &state, 0.2, 0.3);
  ASSERT_EQ(outlines.size(), 2u);
  EXPECT_TRUE(geometry::Contains(outlines[1], {3.039, 4.0}));
  EXPECT_FALSE(geometry::Contains(outlines[1], {3.05, 4.0}));
  EXPECT_EQ(OutlinesInBand(world, &state, 0.31, 0.4).size(), 1u);
  state.objects[0].model = "mog";
  EXPECT_THROW(OutlinesInBand(world, &state, 0.2, 0.3), base::ConfigError);
}

TEST(ExtrudeMapTest, EqualRunsBecomeOneBox) {
  OccupancyGrid grid;
  grid.width = 4;
  grid.height = 3;
  grid.resolution = 0.5;
  grid.cells.assign(12, Cell::kFree);
  for (const int i : {1, 2, 5, 6, 8, 9, 10}) grid.cells[i] = Cell::kOccupied;
  grid.cells[3] = Cell::kUnknown;
  const World world = ExtrudeMap(grid, 2.0);
  ASSERT_EQ(world.statics.size(), 1u);
  ASSERT_EQ(world.statics[0].collisions.size(), 2u);  // 2 x 2 cells and 3 x 1 cells
  const geometry::Collision& first = world.statics[0].collisions[0];
  EXPECT_EQ(std::get<geometry::Box>(first.shape).size, Eigen::Vector3d(1.0, 1.0, 2.0));
  EXPECT_EQ(first.X_BS.translation, Eigen::Vector3d(1.0, 0.5, 1.0));
  EXPECT_EQ(world.hash, world.ComputeHash());
  EXPECT_THROW(ExtrudeMap(grid, 0.0), std::logic_error);
}

TEST(ExtrudeMapTest, FreeMapHasNoWalls) {
  OccupancyGrid grid = RandomGrid(base::Rng(1), 0.0);
  EXPECT_TRUE(ExtrudeMap(grid, 1.0).statics.empty());
}

TEST(ExtrudeMapTest, SliceOfTheExtrudedMapIsTheMap) {
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(17).Fork(seed);
    const OccupancyGrid map = RandomGrid(rng.Fork(0), rng.Uniform(0.02, 0.98));
    const OccupancyGrid slice = SliceWorld(ExtrudeMap(map, 2.0), 0.3, 0.3, map.resolution, 0.1);
    ASSERT_EQ(CountOccupied(slice), CountOccupied(map)) << "seed " << seed;
    for (int row = 0; row < map.height; ++row) {
      for (int column = 0; column < map.width; ++column) {
        ASSERT_EQ(CellAt(slice, map.CentreOf(column, row)), map.at(column, row))
            << "seed " << seed << ", column " << column << ", row " << row;
      }
    }
  }
}

}  // namespace
}  // namespace hires::world::occupancy_grid_test
