#include <benchmark/benchmark.h>

#include <string>

#include "lab/src/trial/random_tables.h"
#include "hires/robot/load_robot.h"

namespace hires::perception {
namespace {

RandomTables Tables() {
  const std::string source = HIRES_SOURCE_DIR;
  return {robot::LoadRobot(source + "/config/robots/pr2.yaml"),
          ReadRecogniserConfig(source + "/config/recogniser.yaml")};
}

/// A cloud of 640 x 480 points of a table with one to eight things, of 20 kinds; by table.
void BM_RecogniseTable(benchmark::State& state) {
  const RandomTables tables = Tables();
  const Recogniser recogniser(tables.catalogue());
  const RandomTable table = tables.Make(static_cast<std::uint64_t>(state.range(0)));
  std::size_t num_things = 0;
  for (auto _ : state) {
    const Recognition seen = recogniser.Recognise(table.cloud, table.stand, base::Rng(1));
    num_things = seen.detections.size();
  }
  state.counters["things"] = static_cast<double>(num_things);
}
BENCHMARK(BM_RecogniseTable)->DenseRange(2000, 2009)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::perception
