// What does a step of 1 ms cost with pepper mills on a moving tray?
#include <benchmark/benchmark.h>

#include <cmath>

#include "hires/geometry/angles.h"
#include "physics/scenes.h"

namespace hires::physics {
namespace {

constexpr int kSettle = 500;   // steps
constexpr int kPeriod = 2000;  // steps of one swing to and fro

void Drive(PhysicsWorld* world, BodyId base, int step) {
  BodyState motion = world->GetState(base);
  motion.V_WB.linear.x() = 0.3 * std::sin(2.0 * geometry::kPi * step / kPeriod);
  world->SetMotion(base, motion);
  world->Step();
}

/// Counts steps per second while the base swings to and fro, each time from the same state.
void SwingForEver(benchmark::State& state, PhysicsWorld* world, BodyId base) {
  for (int i = 0; i < kSettle; ++i) world->Step();
  const PhysicsState settled = world->Save();
  int step = kPeriod;
  for (auto _ : state) {
    if (step == kPeriod) {
      world->Restore(settled);
      step = 0;
    }
    Drive(world, base, step++);
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["contacts"] = world->num_contacts();
}

/// The whole scene: floor, 60 boxes in the room, a base with a tray.
void BM_TrayStep(benchmark::State& state) {
  test_support::TrayScene scene(static_cast<int>(state.range(0)));
  SwingForEver(state, &scene.world, scene.base);
}
BENCHMARK(BM_TrayStep)->Arg(1)->Arg(4)->Arg(16);

/// Nothing but a plate and the mill, as in mujoco_benchmark.cpp.
void BM_PlateStep(benchmark::State& state) {
  PhysicsWorld world({});
  const BodyId plate = world.AddDriven(
      {test_support::MakeCollision(geometry::Box{{0.25, 0.658, 0.005}}, {0.0, 0.0, -0.0025})},
      geometry::Pose3());
  test_support::AddStandingCylinder(&world, {0.037, 0.274}, 0.14, Eigen::Vector3d::Zero());
  SwingForEver(state, &world, plate);
}
BENCHMARK(BM_PlateStep);

void BM_SaveAndRestore(benchmark::State& state) {
  test_support::TrayScene scene(1);
  for (int i = 0; i < kSettle; ++i) scene.world.Step();
  for (auto _ : state) {
    const PhysicsState saved = scene.world.Save();
    scene.world.Restore(saved);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_SaveAndRestore);

}  // namespace
}  // namespace hires::physics
