#include <benchmark/benchmark.h>

#include "sim_robot/sim_robot_sensors.h"

/// What the sensors of the simulated robot cost that other programs look through, in the
/// restaurant.
namespace hires::sim_robot {
namespace {

const imagination::ImaginationSetup& Restaurant() {
  static const imagination::ImaginationSetup setup = imagination::LoadImaginationSetup(
      imagination::ReadSetupConfig(HIRES_SOURCE_DIR "/config/scene.yaml"));
  return setup;
}

/// The robot of the scenario serve_coffee before table 1, which its camera looks at.
struct BeforeTheTable {
  static imagination::StartState Start() {
    imagination::StartState start =
        StartOf(Restaurant(), HIRES_SOURCE_DIR "/config/scenarios/serve_coffee.yaml", "");
    start.robot.X_MB = {7.73, 10.0, 1.5708};
    start.robot.joints["head_tilt_joint"] = 0.4;
    return start;
  }

  SimRobotWorld world{Restaurant(), Start(), 1};
  SimRobotSensors sensors{
      ReadSimSensorParams(base::ParamReader::FromFile(HIRES_SOURCE_DIR "/config/sim_robot.yaml")),
      1, world.scene()};
};

void BM_DepthCloud(benchmark::State& state) {  // a cloud of 640 x 480 points, noise included
  BeforeTheTable robot;
  for (auto _ : state) benchmark::DoNotOptimize(robot.sensors.cameras().Cloud(robot.world));
}
BENCHMARK(BM_DepthCloud)->Unit(benchmark::kMillisecond);

void BM_ColoursOfTheCloud(benchmark::State& state) {  // its picture
  BeforeTheTable robot;
  for (auto _ : state) benchmark::DoNotOptimize(robot.sensors.cameras().Colours(robot.world));
}
BENCHMARK(BM_ColoursOfTheCloud)->Unit(benchmark::kMillisecond);

void BM_HeatPicture(benchmark::State& state) {
  BeforeTheTable robot;
  for (auto _ : state) benchmark::DoNotOptimize(robot.sensors.cameras().Heat(robot.world));
}
BENCHMARK(BM_HeatPicture)->Unit(benchmark::kMillisecond);

void BM_TiltScan(benchmark::State& state) {  // 640 beams of eight rays, among the robot's links
  BeforeTheTable robot;
  for (auto _ : state) benchmark::DoNotOptimize(robot.sensors.lasers().TiltScan(robot.world));
}
BENCHMARK(BM_TiltScan)->Unit(benchmark::kMicrosecond);

void BM_TrayScan(benchmark::State& state) {
  BeforeTheTable robot;
  for (auto _ : state) benchmark::DoNotOptimize(robot.sensors.lasers().TrayScan(robot.world));
}
BENCHMARK(BM_TrayScan)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hires::sim_robot
