#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>

#include "hires/base/rng.h"
#include "hires/manipulation/grasp.h"
#include "manipulation/restaurant_scene.h"

namespace hires::manipulation {
namespace {

using namespace test_support;

/// The right arm of the PR2 at the counter with two mugs and a mill on it, arms to side.
struct AtCounter {
  AtCounter() {
    scene.SetObjects({Standing("mug1", "coffee_cup", 5.37, 10.26, 0.75),
                      Standing("mug2", "coffee_cup", 5.37, 9.94, 0.75),
                      Standing("peppermill1", "peppermill_thesis", 5.47, 10.16, 0.75)},
                     X_MB, posture);
  }
  ArmScene In() const { return {&arm, &scene, X_MB, posture, std::nullopt}; }
  geometry::Pose3 Target(base::Rng* rng) const {
    geometry::Pose3 X_MT;
    X_MT.translation = {rng->Uniform(5.25, 5.55), rng->Uniform(9.85, 10.45),
                        rng->Uniform(0.85, 1.05)};
    geometry::Pose3 X_BT = geometry::Lift(X_MB).Inverse() * X_MT;
    X_BT.rotation = geometry::RotationFromRpy(0.0, 0.0, rng->Uniform(-0.6, 1.2));
    return X_BT;
  }

  ArmKinematics arm{*Pr2(), "rightarm1"};
  CollisionScene scene = RestaurantScene();
  geometry::Pose2 X_MB = Area("manipulationAreaEastCounter1");
  robot::JointPositions posture = Posture("armtosideposture", 0.295);
};

/// What does it cost to ask whether one posture is free?
void BM_FindTouch(benchmark::State& state) {
  const AtCounter at;
  const bool is_masked = state.range(0) != 0;
  const LinkMask arm = at.scene.MovedBy(at.arm.joint_names());
  for (auto _ : state) {
    benchmark::DoNotOptimize(is_masked ? at.scene.FindTouch(at.X_MB, at.posture, arm)
                                       : at.scene.FindTouch(at.X_MB, at.posture));
  }
}
BENCHMARK(BM_FindTouch)->ArgName("arm_only")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

/// What does it cost to find all solutions for a tool pose (40 starts)?
void BM_Solve(benchmark::State& state) {
  const AtCounter at;
  base::Rng rng(1);
  const ArmJoints near = at.arm.JointsOf(at.posture);
  std::uint64_t seed = 0;
  double found = 0.0;
  for (auto _ : state) {
    found += at.arm.Solve(at.posture, at.Target(&rng), near, ++seed).size();
  }
  state.counters["solutions"] = benchmark::Counter(found, benchmark::Counter::kAvgIterations);
}
BENCHMARK(BM_Solve)->Unit(benchmark::kMillisecond);

/// Goals over the counter that no free straight way leads to from "to side".
std::vector<ArmJoints> HardGoals(const AtCounter& at, std::size_t count) {
  base::Rng rng(2);
  std::vector<ArmJoints> goals;
  while (goals.size() < count) {
    for (const ArmJoints& goal :
         at.arm.Solve(at.posture, at.Target(&rng), at.arm.JointsOf(at.posture), 1)) {
      const ArmPathResult result = PlanArmPath(at.In(), {goal}, 1);
      if (result.status != ArmPathStatus::kFound || result.path.size() < 3) continue;
      goals.push_back(goal);
      break;
    }
  }
  return goals;
}

/// What does a path cost that RRT-Connect has to find? Every iteration takes the next goal; the
/// median and the worst of them are counters.
void BM_PlanArmPath(benchmark::State& state) {
  const AtCounter at;
  const std::vector<ArmJoints> goals = HardGoals(at, 100);
  std::vector<double> times;  // [s]
  for (auto _ : state) {
    const auto start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(
        PlanArmPath(at.In(), {goals[times.size() % goals.size()]}, times.size()));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    times.push_back(took.count());
  }
  std::sort(times.begin(), times.end());
  state.counters["median_s"] = times[times.size() / 2];
  state.counters["worst_s"] = times.back();
}
BENCHMARK(BM_PlanArmPath)->Unit(benchmark::kMillisecond)->Iterations(100);

/// What does it cost to time a path, and how long does the motion take?
void BM_TimePath(benchmark::State& state) {
  const AtCounter at;
  base::Rng rng(2);
  ArmPathResult result;
  while (result.path.size() < 3) {
    const auto goals = at.arm.Solve(at.posture, at.Target(&rng), at.arm.JointsOf(at.posture), 1);
    if (!goals.empty()) result = PlanArmPath(at.In(), {goals.front()}, 1);
  }
  robot::JointTrajectory trajectory;
  for (auto _ : state) trajectory = TimePath(*Pr2(), at.arm.joint_names(), result.path);
  state.counters["duration"] = trajectory.duration();
  state.counters["points"] = static_cast<double>(trajectory.points.size());
}
BENCHMARK(BM_TimePath)->Unit(benchmark::kMicrosecond);

/// What does a scene cost to build and to copy?
void BM_BuildScene(benchmark::State& state) {
  Restaurant();
  for (auto _ : state) {
    const CollisionScene scene(Restaurant(), Pr2(), CollisionParams{});
    benchmark::DoNotOptimize(&scene);
  }
}
BENCHMARK(BM_BuildScene)->Unit(benchmark::kMillisecond);

void BM_CloneScene(benchmark::State& state) {
  const AtCounter at;
  for (auto _ : state) benchmark::DoNotOptimize(at.scene.Clone());
}
BENCHMARK(BM_CloneScene)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hires::manipulation
