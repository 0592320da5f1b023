// What does driving by the laser cost? A scan that marks and clears, and marks in a map.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "hires/navigation/costmap.h"
#include "hires/navigation/obstacle_layer.h"
#include "navigation/scenes.h"

namespace hires::navigation {
namespace {

using namespace test_support;

/// Of a robot in the middle of a square room, 4 m from wall to wall.
robot::ScanReading ScanOfARoom(int num_beams) {
  robot::ScanReading scan{-2.2689, 2 * 2.2689 / (num_beams - 1), 0.08, {}, 10.0};
  for (int i = 0; i < num_beams; ++i) {
    const double angle = scan.angle_min + i * scan.angle_increment;
    scan.ranges.push_back(
        static_cast<float>(2.0 / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)))));
  }
  return scan;
}

void BM_ObstacleLayerScan(benchmark::State& state) {
  ObstacleLayer layer({2.5, 3.0, 10.0}, 0.05);
  const robot::ScanReading scan = ScanOfARoom(static_cast<int>(state.range(0)));
  const geometry::Polygon footprint = Pr2Footprint();
  double time = 0.0;
  for (auto _ : state) layer.Insert(time += 0.2, scan, {}, {0.275, 0.0, 0.0}, footprint);
}
BENCHMARK(BM_ObstacleLayerScan)->Arg(120)->Arg(640)->Unit(benchmark::kMicrosecond);

void BM_CostmapWithMarks(benchmark::State& state) {  // walls of a square room
  const Costmap costmap(FreeGrid(289, 342), 0.34, {});
  std::vector<Eigen::Vector2d> marks;
  for (double along = 0.025; along < 4.0; along += 0.05) {
    marks.insert(marks.end(), {{5.0, 5.0 + along}, {9.0, 5.0 + along}, {5.0 + along, 5.0}});
  }
  for (auto _ : state) benchmark::DoNotOptimize(costmap.WithObstaclesAt(marks));
}
BENCHMARK(BM_CostmapWithMarks)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hires::navigation
