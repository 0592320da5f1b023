#include <gtest/gtest.h>

#include "hires/base/error.h"
#include "hires/geometry/angles.h"
#include "hires/mapping/map_judge.h"
#include "mapping/draw_grid.h"
#include "mapping/odometry_track.h"
#include "mapping/pose_graph.h"
#include "mapping/scan_matcher.h"

namespace hires::mapping::mapping_parts_test {
namespace {

using geometry::kPi;
using geometry::Pose2;
using localisation::RobotLog;

RobotLog::Scan ScanOf(const std::vector<float>& ranges, double angle_min, double increment) {
  RobotLog::Scan scan;
  scan.reading.angle_min = angle_min;
  scan.reading.angle_increment = increment;
  scan.reading.ranges = ranges;
  scan.reading.range_max = 30.0;
  return scan;
}

/// Of a laser in the origin that looks at two walls, x = 3 and y = 2.
RobotLog::Scan CornerScan(const Pose2& X_MB = {}) {
  std::vector<float> ranges;
  for (int i = 0; i <= 90; ++i) {
    const double angle = X_MB.yaw + i * kPi / 180.0;
    const double to_x = std::cos(angle) > 1e-9 ? (3.0 - X_MB.x) / std::cos(angle) : 100.0;
    const double to_y = std::sin(angle) > 1e-9 ? (2.0 - X_MB.y) / std::sin(angle) : 100.0;
    ranges.push_back(static_cast<float>(std::min(to_x, to_y)));
  }
  return ScanOf(ranges, 0.0, kPi / 180.0);
}

TEST(ScanPointsTest, WallsFaceTheLaser) {
  const SurfacePoints points = PointsOf(CornerScan(), 30.0);
  ASSERT_EQ(points.size(), 91u);
  EXPECT_NEAR(points[10].p.x(), 3.0, 1e-6);
  EXPECT_NEAR(points[10].n.x(), -1.0, 1e-6);
  EXPECT_NEAR(points[80].n.y(), -1.0, 1e-6);
}

TEST(ScanPointsTest, WhatIsNoMeasurementIsNoPoint) {
  const float nan = std::nanf("");
  const SurfacePoints points = PointsOf(
      ScanOf({nan, 0.0F, -1.0F, 30.0F, 25.0F, 1.0F, std::numeric_limits<float>::infinity()}, 0.0,
             0.1),
      20.0);
  ASSERT_EQ(points.size(), 1u);
  EXPECT_FALSE(points[0].has_normal());
}

/// A range of a file, in `float`, is seldom the number that its `range_max` is in `double`.
TEST(ScanPointsTest, WhatIsAsLongAsTheLaserSeesIsNoPoint) {
  for (const double range_max : {4.095, 5.6, 8.183, 8.19, 8.191, 16.38, 18.3, 29.9}) {
    for (const double off : {-0.01, -0.001, 0.0, 0.001, 0.01}) {
      auto scan = ScanOf({2.0F, static_cast<float>(range_max + off), 2.5F}, 0.0, 0.1);
      scan.reading.range_max = range_max;
      EXPECT_EQ(PointsOf(scan, 30.0).size(), 2u) << range_max << " " << off;
    }
  }
}

TEST(ScanMatcherTest, PoseIsFoundAgainFromBesideIt) {
  const SurfacePoints seen = PointsOf(CornerScan(), 30.0);
  const SurfaceMap map(std::vector<PlacedPoints>{{&seen, {}}});
  const Pose2 X_MB{0.2, -0.1, 0.05};
  const SurfacePoints points = PointsOf(CornerScan(X_MB), 30.0);
  const Pose2 searched = SearchMatch(map, points, {}, {0.4, 0.2}).X_MB;
  const ScanMatch match = RefineMatch(map, points, searched, std::nullopt, 0.03);
  EXPECT_NEAR(match.X_MB.x, X_MB.x, 0.005);
  EXPECT_NEAR(match.X_MB.y, X_MB.y, 0.005);
  EXPECT_NEAR(match.X_MB.yaw, X_MB.yaw, 0.002);
  EXPECT_GT(match.fit, 0.9);
}

/// Half of what a scan meets lies where nobody looked before; the rest tells whether it lies right.
TEST(ScanMatcherTest, FitIsThatOfWhatWasSeenBefore) {
  const SurfacePoints points = PointsOf(CornerScan(), 30.0);
  SurfacePoints wall;  // x = 3, the half of them
  for (const SurfacePoint& point : points)
    if (point.n.x() < -0.9) wall.push_back(point);
  const SurfaceMap map(std::vector<PlacedPoints>{{&wall, {}}});
  const FitWhereSeen right = FitWhereSeenAt(map, points, {});
  EXPECT_GT(right.num_points, static_cast<int>(wall.size()) - 5);
  EXPECT_LT(right.num_points, static_cast<int>(points.size()) - 15);
  EXPECT_GT(right.fit, 0.85);
  EXPECT_LT(*FitAt(map, points, {}), 0.6);
  const FitWhereSeen beside = FitWhereSeenAt(map, points, {0.3, 0.0, 0.0});
  EXPECT_GT(beside.num_points, 20);
  EXPECT_LT(beside.fit, 0.2);
  EXPECT_EQ(FitWhereSeenAt(map, points, {9.0, 0.0, 0.0}).num_points, 0);
}

TEST(ScanMatcherTest, AlongAWallThePriorDecides) {
  std::vector<float> ranges;
  for (int i = -30; i <= 30; ++i)
    ranges.push_back(static_cast<float>(2.0 / std::cos(i * kPi / 180.0)));
  const SurfacePoints wall = PointsOf(ScanOf(ranges, -kPi / 6.0, kPi / 180.0), 30.0);
  const SurfaceMap map(std::vector<PlacedPoints>{{&wall, {}}});
  const PosePrior prior{{0.05, 0.3, 0.0}, 0.05, 0.02};
  const ScanMatch match = RefineMatch(map, wall, prior.X_MB, prior, 0.03);
  EXPECT_NEAR(match.X_MB.x, 0.0, 0.003) << "the wall stands ahead";
  EXPECT_NEAR(match.X_MB.y, 0.3, 0.003) << "and runs from right to left";
  EXPECT_LT(match.information(1, 1), 0.1 * match.information(0, 0));
}

PoseGraph::Edge Ahead(int from, int to) {
  return {from, to, {1.0, 0.0, kPi / 2.0}, Eigen::Matrix3d::Identity() * 100.0};
}

TEST(PoseGraphTest, ErrorOfALoopIsSpreadOverIt) {
  PoseGraph graph;  // a square that odometry closes badly
  for (int i = 0; i < 4; ++i) graph.AddPose({0.1 * i, 0.2 * i, 1.5 * i});
  for (int i = 0; i < 4; ++i) graph.AddEdge(Ahead(i, (i + 1) % 4));
  graph.Optimise(50);
  const std::vector<Pose2> square{
      {0.0, 0.0, 0.0}, {1.0, 0.0, kPi / 2}, {1.0, 1.0, kPi}, {0.0, 1.0, -kPi / 2}};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(graph.pose(i).x, square[i].x, 1e-6) << i;
    EXPECT_NEAR(graph.pose(i).y, square[i].y, 1e-6) << i;
    EXPECT_NEAR(geometry::WrapToPi(graph.pose(i).yaw - square[i].yaw), 0.0, 1e-6) << i;
  }
}

TEST(PoseGraphTest, WrongLoopIsOverruled) {
  PoseGraph graph;
  for (int i = 0; i < 20; ++i) graph.AddPose({1.0 * i, 0.0, 0.0});
  for (int i = 0; i < 19; ++i)
    graph.AddEdge({i, i + 1, {1.0, 0.0, 0.0}, Eigen::Matrix3d::Identity() * 1e4});
  graph.CloseLoop({0, 19, {5.0, 0.0, 0.0}, Eigen::Matrix3d::Identity() * 1e4}, false);
  EXPECT_NEAR(graph.pose(19).x, 19.0, 0.05);
}

/// A long way whose steps are each a little wrong may be off by metres.
TEST(PoseGraphTest, LargeLoopIsMetFirst) {
  for (const bool is_large : {false, true}) {
    PoseGraph graph;
    for (int i = 0; i < 100; ++i) graph.AddPose({0.3 * i, 0.0, 0.0});
    for (int i = 0; i < 99; ++i)
      graph.AddEdge({i, i + 1, {0.3, 0.0, 0.0}, Eigen::Vector3d(1e3, 1e3, 1e5).asDiagonal()});
    const Eigen::Matrix3d exact = Eigen::Vector3d(1e4, 1e4, 1e5).asDiagonal();
    EXPECT_TRUE(graph.CloseLoop({0, 99, {29.7, 3.0, 0.1}, exact}, is_large));
    EXPECT_NEAR(graph.pose(99).y, is_large ? 3.0 : 0.0, 0.1);
  }
}

TEST(PoseGraphTest, LargeLoopThatIsWrongIsOverruledByOthers) {
  PoseGraph graph;
  for (int i = 0; i < 20; ++i) graph.AddPose({1.0 * i, 0.0, 0.0});
  const Eigen::Matrix3d exact = Eigen::Matrix3d::Identity() * 1e4;
  for (int i = 0; i < 19; ++i) graph.AddEdge({i, i + 1, {1.0, 0.0, 0.0}, exact});
  graph.CloseLoop({0, 18, {18.0, 0.0, 0.0}, exact}, false);
  graph.CloseLoop({1, 19, {18.0, 0.0, 0.0}, exact}, false);
  EXPECT_FALSE(graph.CloseLoop({0, 19, {19.0, 3.0, 0.0}, exact}, true));
  EXPECT_NEAR(graph.pose(19).y, 0.0, 0.1);
}

TEST(OdometryTrackTest, PosesBetweenReadingsAreInterpolated) {
  OdometryTrack track(2.0, 6.0);
  EXPECT_FALSE(track.At(1.0).has_value());
  track.Add(1.0, {0.0, 0.0, 3.0});
  track.Add(2.0, {1.0, 0.0, -3.0});
  EXPECT_EQ(track.At(0.5)->x, 0.0);
  EXPECT_NEAR(track.At(1.5)->x, 0.5, 1e-12);
  EXPECT_NEAR(std::abs(track.At(1.5)->yaw), kPi, 1e-9) << "the short way round";
  EXPECT_EQ(track.At(5.0)->x, 1.0);
  EXPECT_THROW(track.Add(1.5, {}), std::logic_error);
}

TEST(OdometryTrackTest, PosesGoOnWhereAResetCameBetween) {
  OdometryTrack track(2.0, 6.0);
  EXPECT_EQ(track.num_resets(), 0);
  track.Add(1.0, {1.0, 0.0, 0.0});
  track.Add(1.1, {1.1, 0.0, 0.0});
  track.Add(1.2, {0.0, 0.0, kPi});  // reset, and turned
  track.Add(1.3, {-0.1, 0.0, kPi});
  EXPECT_NEAR(track.At(1.15)->x, 1.1, 1e-12);
  EXPECT_NEAR(track.At(1.15)->yaw, 0.0, 1e-12);
  EXPECT_EQ(track.num_resets(), 0);
  EXPECT_NEAR(track.At(1.2)->x, 1.1, 1e-12);
  EXPECT_EQ(track.num_resets(), 1);
  EXPECT_NEAR(track.At(1.3)->x, 1.2, 1e-12) << "ahead, as before";
  EXPECT_NEAR(track.At(1.3)->y, 0.0, 1e-12);
  EXPECT_EQ(track.num_resets(), 1);
}

/// A room of 2 m x 2 m, its walls one cell of 0.1 m thick.
world::OccupancyGrid SmallRoom() {
  world::OccupancyGrid grid{0.1, 22, 22, {-1.1, -1.1}, {}};
  for (int row = 0; row < 22; ++row)
    for (int column = 0; column < 22; ++column)
      grid.cells.push_back(row % 21 == 0 || column % 21 == 0 ? world::Cell::kOccupied
                                                             : world::Cell::kFree);
  return grid;
}

TEST(MapJudgeTest, FacesThatLookToTheLaserAreSeen) {
  // The end is behind a wall of one cell, nearer to its back.
  const auto seen = FacesThatWereSeen(SmallRoom(), {ScanOf({1.07F, 50.0F}, 0.0, kPi / 2.0)},
                                      {{0.0, {0.0, 0.02, 0.0}}}, 30.0);
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_NEAR(seen[0].x(), 1.0, 1e-9);
  EXPECT_NEAR(seen[0].y(), 0.05, 1e-9);
  EXPECT_TRUE(FacesThatWereSeen(SmallRoom(), {ScanOf({1.0F}, 0.0, 0.1)}, {{}}, 0.9).empty());
  EXPECT_TRUE(FacesThatWereSeen(SmallRoom(), {ScanOf({0.8F}, 0.0, 0.1)}, {{}}, 9.0).empty());
  EXPECT_THROW(FacesThatWereSeen(SmallRoom(), {}, {{}}, 9.0), std::logic_error);
}

TEST(MapJudgeTest, WallsAreHeldAgainstEachOtherBothWays) {
  const world::OccupancyGrid room = SmallRoom();
  std::vector<float> ranges;
  for (int i = 0; i < 720; ++i) {
    const double angle = i * kPi / 360.0;
    ranges.push_back(
        static_cast<float>(1.0 / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)))));
  }
  const auto seen = FacesThatWereSeen(room, {ScanOf(ranges, 0.0, kPi / 360.0)}, {{}}, 30.0);
  EXPECT_EQ(seen.size(), 80u) << "what is within, once each";

  const WallErrors same = JudgeWalls(room, room, {}, seen);
  EXPECT_EQ(same.to_world.count, 84u);
  EXPECT_NEAR(same.to_world.median, 0.05, 1e-9) << "half a cell";
  EXPECT_NEAR(same.to_map.median, 0.05, 1e-9);
  EXPECT_NEAR(same.to_map.most, 0.05, 1e-9);

  world::OccupancyGrid lacks = room;  // half of a wall
  for (int row = 1; row < 11; ++row) lacks.cells[row * 22] = world::Cell::kFree;
  EXPECT_NEAR(JudgeWalls(lacks, room, {}, seen).to_world.most, 0.05, 1e-9) << "not seen this way";
  EXPECT_GT(JudgeWalls(lacks, room, {}, seen).to_map.most, 0.25);

  world::OccupancyGrid more = room;  // something in the middle
  for (int row = 9; row < 12; ++row)
    for (int column = 9; column < 12; ++column)
      more.cells[row * 22 + column] = world::Cell::kOccupied;
  EXPECT_NEAR(JudgeWalls(more, room, {}, seen).to_map.most, 0.05, 1e-9) << "not seen this way";
  EXPECT_EQ(JudgeWalls(more, room, {}, seen).to_world.most, kFarthestWall);

  EXPECT_NEAR(JudgeWalls(room, room, {0.0, 0.2, 0.0}, seen).to_map.most, 0.25, 0.051);
  world::OccupancyGrid empty = room;
  empty.cells.assign(empty.cells.size(), world::Cell::kFree);
  EXPECT_EQ(JudgeWalls(empty, room, {}, seen).to_world.count, 0u);
  EXPECT_EQ(JudgeWalls(empty, room, {}, seen).to_world.median, kFarthestWall);
  EXPECT_EQ(JudgeWalls(empty, room, {}, seen).to_map.median, kFarthestWall);
}

TEST(DrawGridTest, BeamsClearTheirWayAndEndInWalls) {
  const RobotLog::Scan scan = ScanOf({1.02F, 50.0F}, 0.0, kPi / 2.0);
  const world::OccupancyGrid grid = DrawGrid({&scan}, {{0.05, 0.05, 0.0}}, 0.1, 30.0);
  const auto at = [&](double x, double y) {
    return grid.at(static_cast<int>(std::floor((x - grid.origin.x()) / 0.1 + 1e-9)),
                   static_cast<int>(std::floor((y - grid.origin.y()) / 0.1 + 1e-9)));
  };
  for (double x = 0.05; x < 0.95; x += 0.1) EXPECT_EQ(at(x, 0.05), world::Cell::kFree) << x;
  EXPECT_EQ(at(1.05, 0.05), world::Cell::kOccupied);
  EXPECT_EQ(at(1.15, 0.05), world::Cell::kUnknown);
  EXPECT_EQ(at(0.05, 0.45), world::Cell::kUnknown) << "what met nothing tells nothing";
}

TEST(DrawGridTest, AbsurdSizesAreRefused) {
  const RobotLog::Scan scan = ScanOf({1.0F}, 0.0, 0.1);
  EXPECT_THROW(DrawGrid({&scan, &scan}, {{}, {1e5, 1e5, 0.0}}, 0.05, 30.0), base::ConfigError);
}

}  // namespace
}  // namespace hires::mapping::mapping_parts_test
