#include <benchmark/benchmark.h>

#include <cmath>

#include "hires/sensing/object_memory.h"
#include "hires/sensing/tray_objects.h"
#include "sensing/ground/ground_obstacles.h"
#include "support/scenes.h"
#include "support/sight_scenes.h"
#include "support/tilt_sweep.h"

namespace hires::sensing {
namespace {

/// How long a sweep of 640 x 100 points takes, before a chair and a box in a room.
void BM_GroundObstacles(benchmark::State& state) {
  const geometry::Pose2 X_MB{3.0, 2.0, 0.0};
  const geometry::Pose3 X_BL = test_support::At(0.1, 0.0, 1.2);
  world::World room = test_support::Room();
  const GroundObstacles finder(
      std::make_shared<const navigation::Costmap>(world::SliceWorld(room, 0.1, 0.9), 0.25,
                                                  navigation::CostmapParams{}),
      test_support::TrayRobot().profile.footprint, {}, {});
  room.statics.push_back(test_support::Block("seat", {0.4, 0.4, 0.04}, {4.2, 2.3, 0.47}));
  room.statics.push_back(test_support::Block("box", {0.4, 0.6, 0.3}, {4.5, 1.0, 0.15}));
  const perception::LineOfSight sight(std::make_shared<perception::Surroundings>(room), {});
  base::Rng rng(1);
  const perception::PointCloud cloud =
      test_support::TiltSweep{}.Measure(sight, geometry::Lift(X_MB) * X_BL, &rng);
  std::size_t num_squares = 0;
  for (auto _ : state) {
    num_squares = finder.Find(cloud, X_BL, X_MB, 1.4, &rng).spots.size();
  }
  state.counters["squares"] = static_cast<double>(num_squares);
}
BENCHMARK(BM_GroundObstacles)->Unit(benchmark::kMillisecond);

/// How long 640 beams over a tray with three mugs take, all of which are believed there.
void BM_TrayObjects(benchmark::State& state) {
  const auto models = test_support::EmptyRoom();
  const geometry::Pose3 X_TL = test_support::At(-0.1, 0.0, 0.02);
  const geometry::Polygon tray_T{{-0.1, -0.32}, {0.15, -0.32}, {0.15, 0.32}, {-0.1, 0.32}};
  std::vector<world::ObjectState> mugs;
  std::vector<BelievedOnTray> believed;
  for (int i = 0; i < 3; ++i) {
    mugs.push_back(test_support::Thing("mug" + std::to_string(i), "mug",
                                       test_support::At(0.05, 0.13 * (i - 1), 0.0)));
    believed.push_back({mugs[i].name, mugs[i].X_MO, models->Model("mug").collisions});
  }
  const perception::LineOfSight sight(models, mugs);
  robot::ScanReading scan{-1.4, 2.8 / 639, 0.04, {}};
  base::Rng rng(1);
  for (int i = 0; i < 640; ++i) {
    const double angle = scan.angle_min + i * scan.angle_increment;
    const double range = sight.Cast(X_TL.translation, {std::cos(angle), std::sin(angle), 0.0});
    scan.ranges.push_back(static_cast<float>(range + rng.Normal(0.0, 0.005)));
  }
  std::size_t num_things = 0;
  for (auto _ : state) num_things = ReadTray(scan, X_TL, tray_T, believed, {}).things.size();
  state.counters["things"] = static_cast<double>(num_things);
}
BENCHMARK(BM_TrayObjects)->Unit(benchmark::kMillisecond);

/// How long it takes a PR2 to make use of a scan of its tray, on which two mugs and a jug stand
/// that it remembers a few millimetres beside.
void BM_TrayMemory(benchmark::State& state) {
  const auto models = test_support::EmptyRoom();
  const auto pr2 = std::make_shared<const robot::Robot>(
      robot::LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml"));
  BodyReading body{1.0, {}, pr2->profile.joints};
  const auto X_RL = robot::ForwardKinematics(pr2->model, body.joints);
  const geometry::Pose3 X_BR = X_RL[*pr2->model.FindLink(pr2->profile.base_link)].Inverse();
  const geometry::Pose3 X_BT = X_BR * X_RL[*pr2->model.FindLink("base_tray_link")];
  const geometry::Pose3 X_BL = X_BR * X_RL[*pr2->model.FindLink("base_tray_laser_link")];
  ObjectMemory fresh(models, pr2);
  std::vector<world::ObjectState> truth;
  for (int i = 0; i < 3; ++i) {
    truth.push_back(test_support::Thing("thing" + std::to_string(i), i == 1 ? "jug" : "mug",
                                        X_BT * test_support::At(0.17, 0.17 * (i - 1), 0.0002)));
    fresh.Believe(truth[i].name, truth[i].model, pr2->profile.base_link,
                  X_BT * test_support::At(0.175, 0.17 * (i - 1) + 0.004, 0.0002));
  }
  const perception::LineOfSight sight(models, truth);
  robot::ScanReading scan{-1.4, 2.8 / 639, 0.08, {}};
  base::Rng rng(1);
  for (int i = 0; i < 640; ++i) {
    const double angle = scan.angle_min + i * scan.angle_increment;
    const double range = sight.Cast(X_BL.translation, {std::cos(angle), std::sin(angle), 0.0});
    scan.ranges.push_back(static_cast<float>(range + rng.Normal(0.0, 0.005)));
  }
  for (auto _ : state) {
    ObjectMemory memory = fresh;
    benchmark::DoNotOptimize(memory.ScanTray(body, scan, X_BL));
    state.counters["things"] = static_cast<double>(memory.tray()->reading.things.size());
  }
}
BENCHMARK(BM_TrayMemory)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::sensing
