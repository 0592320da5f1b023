// What does a step of 1 ms cost at level `planar`?
#include <benchmark/benchmark.h>

#include "hires/simulation/laser_scanner.h"
#include "simulation/arm_scene.h"

namespace hires::simulation {
namespace {

using namespace test_arm;  // NOLINT: the scene's words

constexpr int kPeriod = 2000;  // steps of one swing to and fro

enum Kind { kStanding, kArmMoves, kMugInHand };

/// Other things that stand about on the table.
std::vector<world::ObjectState> Objects(int num_more) {
  std::vector<world::ObjectState> objects{MugAt()};
  for (int i = 0; i < num_more; ++i) {
    objects.push_back(
        MugAt({0.15 + 0.12 * (i / 4), 0.3 + 0.12 * (i % 4)}, "more" + std::to_string(i)));
  }
  return objects;
}

void Prepare(Kind kind, RobotSimulator* simulator) {
  if (kind == kMugInHand) {
    simulator->Send(Gripper(0.0));
    StepFor(simulator, 0.6);
  }
  simulator->Send(TorsoTo(kTorso + 0.05));
  StepFor(simulator, 4.5);
}

void BM_PlanarStep(benchmark::State& state) {
  const Kind kind = static_cast<Kind>(state.range(0));
  auto simulator = Simulator(Objects(static_cast<int>(state.range(1))));
  Prepare(kind, simulator.get());
  int step = 0;
  for (auto _ : state) {
    if (kind != kStanding && step % kPeriod == 0) {
      simulator->Send(JointTo("rightarm1", "r_shoulder_pan_joint",
                              step % (2 * kPeriod) == 0 ? -0.5 : 0.0, 1.9));
    }
    simulator->Step();
    ++step;
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["held"] = static_cast<double>(simulator->held().size());
  state.SetLabel(kind == kStanding ? "standing" : kind == kArmMoves ? "arm moves" : "mug in hand");
}
BENCHMARK(BM_PlanarStep)
    ->ArgsProduct({{kStanding, kArmMoves, kMugInHand}, {0, 4, 16}})
    ->Unit(benchmark::kMicrosecond);

/// What a rollout pays before its first step.
void BM_PlanarStart(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(Simulator({MugAt()}));
}
BENCHMARK(BM_PlanarStart)->Unit(benchmark::kMicrosecond);

/// 640 beams: 50 ms of real time are what it has.
void BM_LaserScan(benchmark::State& state) {
  auto simulator = Simulator(Objects(4));
  base::Rng rng(1);
  for (auto _ : state) benchmark::DoNotOptimize(ScanLaser(*simulator, {}, &rng));
}
BENCHMARK(BM_LaserScan)->Unit(benchmark::kMicrosecond);

void BM_SaveAndRestore(benchmark::State& state) {
  auto simulator = Simulator({MugAt()});
  for (auto _ : state) simulator->Restore(*simulator->Save());
}
BENCHMARK(BM_SaveAndRestore)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hires::simulation
