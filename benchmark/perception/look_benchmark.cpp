#include <benchmark/benchmark.h>

#include <cmath>

#include "hires/geometry/angles.h"
#include "hires/perception/depth_sensor.h"
#include "hires/perception/detector.h"
#include "hires/perception/picture_scene.h"
#include "hires/perception/warm_objects.h"
#include "hires/world/object_catalogue.h"

namespace hires::perception {
namespace {

const world::World& Restaurant() {
  static const world::World restaurant = [] {
    world::World world = world::LoadWorld(HIRES_SOURCE_DIR "/worlds/restaurant.world");
    return world::WithModel(
        world, world::FindObjectModel("mug1", HIRES_SOURCE_DIR "/worlds/objects.yaml"));
  }();
  return restaurant;
}

/// Mugs on and round table1, which the robot looks at from its south.
std::vector<world::ObjectState> Mugs(int num_mugs) {
  base::Rng rng(1);
  std::vector<world::ObjectState> mugs(num_mugs);
  for (int i = 0; i < num_mugs; ++i) {
    mugs[i].name = "mug" + std::to_string(i);
    mugs[i].model = "coffee_cup";
    mugs[i].X_MO.translation = {rng.Uniform(7.4, 8.1), rng.Uniform(11.2, 11.8), 0.73};
  }
  return mugs;
}

void BM_Surroundings(benchmark::State& state) {  // what is made once for a world
  for (auto _ : state) benchmark::DoNotOptimize(Surroundings(Restaurant()));
}
BENCHMARK(BM_Surroundings)->Unit(benchmark::kMillisecond);

/// Shapes of the robot, a scene, and what is seen in it.
void Look(benchmark::State& state, const DetectorParams& params) {
  const robot::Robot pr2 = robot::LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml");
  const auto surroundings = std::make_shared<Surroundings>(Restaurant());
  const auto mugs = Mugs(static_cast<int>(state.range(0)));
  robot::JointPositions posture = pr2.profile.joints;
  posture[pr2.profile.upper_body->head_tilt_joint] = 0.5;
  const geometry::Pose2 X_MB{7.73, 10.3, geometry::kPi / 2};
  base::Rng rng(2);
  std::size_t num_seen = 0;
  for (auto _ : state) {
    const LineOfSight sight(surroundings, mugs, ShapesOf(pr2, X_MB, posture));
    num_seen = Detect(sight, ViewOf(pr2, X_MB, posture), mugs, params, &rng).size();
  }
  state.counters["seen"] = static_cast<double>(num_seen);
}

void BM_Look(benchmark::State& state) { Look(state, {}); }
BENCHMARK(BM_Look)->Arg(1)->Arg(8)->Arg(20)->Unit(benchmark::kMicrosecond);

void BM_LookThatErrs(benchmark::State& state) {  // as the recogniser was found to
  DetectorParams params;
  params.errors = std::make_shared<const DetectorErrors>(
      ReadDetectorErrors(HIRES_SOURCE_DIR "/config/detector.yaml"));
  Look(state, params);
}
BENCHMARK(BM_LookThatErrs)->Arg(1)->Arg(8)->Arg(20)->Unit(benchmark::kMicrosecond);

/// The head's camera, 640 x 480 pixels of 58 degrees, looks at a table with mugs.
struct HeadCamera {
  HeadCamera() {
    posture[pr2.profile.upper_body->head_tilt_joint] = 0.5;
    camera.X_MC = ViewOf(pr2, X_MB, posture).X_MC;
    camera.width = 640;
    camera.height = 480;
    camera.focal_length = 577.3;
  }
  LineOfSight Sight() const { return {surroundings, mugs, ShapesOf(pr2, X_MB, posture)}; }

  const robot::Robot pr2 = robot::LoadRobot(HIRES_SOURCE_DIR "/config/robots/pr2.yaml");
  const std::shared_ptr<const Surroundings> surroundings =
      std::make_shared<Surroundings>(Restaurant());
  const std::vector<world::ObjectState> mugs = Mugs(8);
  const geometry::Pose2 X_MB{7.73, 10.3, geometry::kPi / 2};
  robot::JointPositions posture = pr2.profile.joints;
  PinholeCamera camera;
};

void BM_RangePicture(benchmark::State& state) {  // what is there, without noise
  const HeadCamera head;
  const LineOfSight sight = head.Sight();
  for (auto _ : state) benchmark::DoNotOptimize(sight.Look(head.camera, 5.0));
}
BENCHMARK(BM_RangePicture)->Unit(benchmark::kMillisecond);

void BM_MeasuredCloud(benchmark::State& state) {  // what the sensor makes of it
  const HeadCamera head;
  const RangePicture picture = head.Sight().Look(head.camera, 5.0);
  base::Rng rng(3);
  for (auto _ : state) benchmark::DoNotOptimize(Measure(picture, head.camera, {}, &rng));
}
BENCHMARK(BM_MeasuredCloud)->Unit(benchmark::kMillisecond);

void BM_WarmObjects(benchmark::State& state) {  // which of eight mugs are warm; half of them are
  const HeadCamera head;
  const RangePicture picture = head.Sight().Look(head.camera, 5.0);
  std::map<std::string, double> temperatures;
  std::vector<std::string> names;
  for (const world::ObjectState& mug : head.mugs) {
    temperatures[mug.name] = names.size() % 2 == 0 ? 340.0 : 293.15;
    names.push_back(mug.name);
  }
  base::Rng rng(4);
  const HeatPicture heat = MeasureHeat(picture, temperatures, {}, &rng);
  std::size_t num_regions = 0;
  for (auto _ : state) num_regions = ReadHeat(heat, picture, names, {}).regions.size();
  state.counters["regions"] = static_cast<double>(num_regions);
}
BENCHMARK(BM_WarmObjects)->Unit(benchmark::kMillisecond);

void BM_ColourPicture(benchmark::State& state) {  // the same view in colours, with shadows
  const HeadCamera head;
  std::vector<PaintedBody> fixed, moving;
  for (const world::StaticBody& body : Restaurant().statics) {
    fixed.push_back({body.collisions, body.X_MB, {200, 180, 140}});
  }
  for (const world::ObjectState& mug : head.mugs) {
    moving.push_back({Restaurant().models.at(mug.model)->collisions, mug.X_MO, {220, 80, 30}});
  }
  moving.push_back({ShapesOf(head.pr2, head.X_MB, head.posture), {}, {110, 130, 170}});
  const PictureScene scene(fixed, moving);
  for (auto _ : state) benchmark::DoNotOptimize(scene.Draw(head.camera, moving));
}
BENCHMARK(BM_ColourPicture)->Unit(benchmark::kMillisecond);

void BM_LaserScan(benchmark::State& state) {  // 640 beams of the PR2's base laser
  const auto surroundings = std::make_shared<Surroundings>(Restaurant());
  const LineOfSight sight(surroundings, Mugs(20));
  double sum = 0.0;
  for (auto _ : state) {
    for (int beam = 0; beam < 640; ++beam) {
      const double angle = -2.2689 + beam * 2.0 * 2.2689 / 639.0;
      sum += std::min(30.0, sight.Cast({7.73, 10.3, 0.303}, {std::cos(angle), std::sin(angle), 0}));
    }
  }
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(state.iterations() * 640);  // beams per second
}
BENCHMARK(BM_LaserScan)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hires::perception
