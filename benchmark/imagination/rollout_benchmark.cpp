// How many simulated seconds does one core play in a second: navigation, arm paths, physics and
// counting? Goal: 200 for a drive with the pepper mill and for what arms do. And what does it cost
// to drive by what the laser sees? Goal: at least 0.7 of the speed by the map alone.
#include <benchmark/benchmark.h>

#include "hires/base/resource_use.h"
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

/// The same rollouts by what the laser sees, as the scene says, and by the map alone, in turn.
void LaserAgainstMap(benchmark::State& state, const char* area, const char* motion_set) {
  struct Way {
    explicit Way(const ImaginationSetup& setup)
        : rollout(MakeRolloutSetup(
              setup, MakeStartState(setup, "preManipulationAreaEastCounter1", {"peppermill1"}),
              7)) {}
    void Play(const base::ActionCall& action, int index) {
      const double start = base::ThreadCpuSeconds();
      simulated += PlayRollout(rollout, action, index)->simulated;
      seconds += base::ThreadCpuSeconds() - start;
    }
    double Speed() const { return simulated / seconds; }
    RolloutSetup rollout;
    double simulated = 0.0, seconds = 0.0;
  };
  SetupConfig config = ReadSetupConfig(HIRES_SOURCE_DIR "/config/scene.yaml");
  SetObstacleLayer("none", &config);
  const ImaginationSetup blind = LoadImaginationSetup(config);
  const base::ActionCall action{"move_base_param", {area, motion_set}};
  Way laser(Setup()), map(blind);
  PlayRollout(laser.rollout, action, 0);  // caches warm
  PlayRollout(map.rollout, action, 0);
  int index = 0;
  for (auto _ : state) {
    laser.Play(action, index);
    map.Play(action, index);
    index = (index + 1) % 16;
  }
  state.counters["by_laser"] = laser.Speed();
  state.counters["by_map"] = map.Speed();
  state.counters["ratio"] = laser.Speed() / map.Speed();
}

BENCHMARK_CAPTURE(LaserAgainstMap, NorthTable1_slow, "preManipulationAreaNorthTable1", "slow")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(LaserAgainstMap, EastTable2_fast, "preManipulationAreaEastTable2", "fast")
    ->Unit(benchmark::kMillisecond);

/// The robot at furniture, torso up, arms beside its body.
std::vector<base::Atom> ReadyAt(const char* area) {
  return {{"RobotAt", {area}},
          {"HasTorsoPosture", {"TorsoUpPosture"}},
          {"HasArmPosture", {"leftArm1", "ArmToSidePosture"}},
          {"HasArmPosture", {"rightArm1", "ArmToSidePosture"}}};
}

PutObject Occupant(const char* name, double x, double y) {
  return {name, "", geometry::Lift({x, y, 0.0}, 0.73)};
}

void PlayArm(benchmark::State& state, std::vector<base::Atom> atoms, const base::Atom& mug,
             const std::vector<PutObject>& put, const base::ActionCall& action) {
  const ImaginationSetup& setup = Setup();
  atoms.push_back(mug);
  const RolloutSetup rollout = MakeRolloutSetup(setup, MakeStartState(setup, atoms, put), 7);
  PlayRollout(rollout, action, 0);  // caches warm
  double simulated = 0.0;
  int index = 0;
  for (auto _ : state) simulated += PlayRollout(rollout, action, index++ % 16)->simulated;
  state.counters["real_time_factor"] = benchmark::Counter(simulated, benchmark::Counter::kIsRate);
}

const base::Atom kMugInHand{"Holding", {"rightArm1", "mug1"}};
const base::Atom kMugOnCounter{"On", {"mug1", "placingAreaEastRightCounter1"}};
const base::ActionCall kPlace{"place_object", {"mug1", "rightArm1", "placingAreaWestRightTable1"}};
const base::ActionCall kPick{"pick_up_object", {"mug1", "rightArm1"}};

BENCHMARK_CAPTURE(PlayArm, PlaceOnFreeTable, ReadyAt("manipulationAreaSouthTable1"), kMugInHand, {},
                  kPlace)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(PlayArm, PlaceBesideOneBook, ReadyAt("manipulationAreaSouthTable1"), kMugInHand,
                  {Occupant("book1", 7.481, 11.384)}, kPlace)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(PlayArm, PlaceOnOccupiedTable, ReadyAt("manipulationAreaSouthTable1"), kMugInHand,
                  {Occupant("bowl1", 7.539, 11.241), Occupant("book1", 7.481, 11.384),
                   Occupant("book2", 7.613, 11.405)},
                  kPlace)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(PlayArm, PickUp, ReadyAt("manipulationAreaEastCounter1"), kMugOnCounter, {},
                  kPick)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::imagination
