#include <benchmark/benchmark.h>

#include "hires/geometry/angles.h"
#include "hires/perception/depth_sensor.h"
#include "hires/perception/line_of_sight.h"
#include "hires/perception/self_filter.h"
#include "hires/world/world.h"

namespace hires::perception {
namespace {

/// How long 640 x 480 points of the PR2's head camera take against its 53 shapes, while it looks at
/// its tray (1.1 rad down) or ahead over a table (0.3).
void BM_SelfFilter(benchmark::State& state) {
  const robot::Robot pr2 = robot::LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml");
  const world::World restaurant = world::LoadWorld(HIRES_SOURCE_DIR "/worlds/restaurant.world");
  robot::JointPositions posture = pr2.profile.joints;
  posture[pr2.profile.upper_body->head_tilt_joint] = static_cast<double>(state.range(0)) / 10.0;
  const geometry::Pose2 X_MB{7.73, 10.3, geometry::kPi / 2};
  std::vector<geometry::Collision> shapes = ShapesOf(pr2, X_MB, posture);
  const LineOfSight sight(std::make_shared<Surroundings>(restaurant), {}, shapes);
  PinholeCamera camera{ViewOf(pr2, X_MB, posture).X_MC, 640, 480, 577.3};
  DepthSensorParams sensor;
  sensor.min_range = 0.1;
  base::Rng rng(1);
  const PointCloud measured = Measure(sight.Look(camera, 5.0), camera, sensor, &rng);
  const geometry::Pose3 X_SM = (camera.X_MC * OpticalFrame()).Inverse();
  for (geometry::Collision& shape : shapes) shape.X_BS = X_SM * shape.X_BS;
  SelfFilter filter({});
  int num_cut = 0;
  PointCloud cloud;
  for (auto _ : state) {
    state.PauseTiming();
    cloud = measured;
    state.ResumeTiming();
    num_cut = filter.Cut(shapes, &cloud);
  }
  state.counters["cut"] = num_cut;
  state.counters["shapes"] = static_cast<double>(shapes.size());
}
BENCHMARK(BM_SelfFilter)->Arg(11)->Arg(3)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::perception
