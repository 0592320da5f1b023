// How fast are experiences written, asked for by state and exported? Five hours at 20 Hz are
// 360,000 parts. Goals: 20,000 parts/s written, asked for by state in under 1 s, exported in under
// 10 s.
#include <benchmark/benchmark.h>
#include <stdlib.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "hires/knowledge/experience.h"

namespace hires::knowledge {
namespace {

constexpr int kLeg = 300;        // parts of a drive
constexpr int kParts = 360'000;  // of five hours

/// A file that is gone in the end.
class File {
 public:
  File() {
    std::string name = (std::filesystem::temp_directory_path() / "hires_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
    folder_ = name;
  }
  ~File() { std::filesystem::remove_all(folder_); }
  std::string path() const { return folder_ / "experiences.db"; }

 private:
  std::filesystem::path folder_;
};

ExperienceBatch LegAt(int first) {
  ExperienceBatch batch{"fast/0", "move_base_param(nt1, fast)", {}};
  for (int i = 0; i < kLeg; ++i) {
    ToppleEpisodePart part;
    part.time = 0.05 * (first + i);
    part.alpha = 1e-3 * i;
    part.state = (first + i) % 400 == 0 ? ToppleState::kTopple : ToppleState::kNoTopple;
    batch.parts.push_back(part);
  }
  return batch;
}

void Fill(ExperienceStore* store) {
  for (int first = 0; first < kParts; first += kLeg) store->Write(LegAt(first));
}

void BM_Write(benchmark::State& state) {
  const File file;
  ExperienceStore store(file.path(), ExperienceStore::Mode::kWrite);
  int first = 0;
  for (auto _ : state) {
    store.Write(LegAt(first));
    first += kLeg;
  }
  state.SetItemsProcessed(state.iterations() * kLeg);
  state.counters["bytes_per_part"] =
      static_cast<double>(store.bytes()) / static_cast<double>(store.num_parts());
}
BENCHMARK(BM_Write)->Unit(benchmark::kMillisecond);

/// @param is_all  every part as CSV, else those of state topple.
void AskAndExport(benchmark::State& state, bool is_all) {
  const File file;
  ExperienceStore store(file.path(), ExperienceStore::Mode::kWrite);
  Fill(&store);
  ExperienceQuery query;
  if (!is_all) query.state = ToppleState::kTopple;
  std::size_t found = 0, bytes = 0;
  for (auto _ : state) {
    found = 0;
    store.ForEach(query, [&](const ExperienceStore::Stored& stored) {
      ++found;
      bytes += CsvOf(stored.part).size();
    });
  }
  benchmark::DoNotOptimize(bytes);
  state.counters["found"] = static_cast<double>(found);
}
BENCHMARK_CAPTURE(AskAndExport, topple, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(AskAndExport, all, true)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::knowledge
