// How many simulated seconds does one core play in a second: navigation, physics and counting of a
// whole drive with the pepper mill? Target: 60.
#include <benchmark/benchmark.h>

#include "hires/imagination/imagination_setup.h"
#include "hires/imagination/rollout.h"

namespace hires::imagination {
namespace {

const ImaginationSetup& Setup() {
  static const ImaginationSetup setup =
      LoadImaginationSetup(ReadSetupConfig(HIRES_SOURCE_DIR "/config/scene.yaml"));
  return setup;
}

void PlayDrive(benchmark::State& state, const char* area, const char* motion_set) {
  const ImaginationSetup& setup = Setup();
  const RolloutSetup rollout = MakeRolloutSetup(
      setup, MakeStartState(setup, "preManipulationAreaEastCounter1", {"peppermill1"}), 7);
  const base::ActionCall action{"move_base_param", {area, motion_set}};
  PlayRollout(rollout, action, 0);  // caches warm
  double simulated = 0.0;
  int index = 0;
  for (auto _ : state) simulated += PlayRollout(rollout, action, index++ % 16)->simulated;
  state.counters["real_time_factor"] = benchmark::Counter(simulated, benchmark::Counter::kIsRate);
}

BENCHMARK_CAPTURE(PlayDrive, NorthTable1_slow, "preManipulationAreaNorthTable1", "slow")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(PlayDrive, NorthTable1_fast, "preManipulationAreaNorthTable1", "fast")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(PlayDrive, EastTable2_slow, "preManipulationAreaEastTable2", "slow")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(PlayDrive, EastTable2_fast, "preManipulationAreaEastTable2", "fast")
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::imagination
