// How long does the search for a first plan take, reading apart: on the problems that come with
// SHOP3, and on random ones of up to ten times their size? Items are expansions (tasks decomposed
// or applied). Counters: steps of the plan, megabytes that the search held at most, and, where
// SHOP3's time is known, how many times faster we are.
#include <benchmark/benchmark.h>

#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/planning/planner.h"
#include "hires/planning/planning_files.h"
#include "hires/planning/shop2_reader.h"
#include "support/planning_problems.h"

namespace hires::planning {
namespace {

const std::string kShared = HIRES_SHARED_DATA "/htn/shop2/";
const std::string kDomains = HIRES_SOURCE_DIR "/benchmark/planning/domains/";

void Report(const PlanResult& result, std::uint64_t expansions, benchmark::State* state) {
  state->SetItemsProcessed(static_cast<std::int64_t>(expansions));
  state->counters["steps"] = static_cast<double>(result.plans.front().steps.size());
  state->counters["peak_mb"] = static_cast<double>(result.progress.bytes) / 1e6;
}

/// Searches for the first plan; no plan is an error, for a wrong answer has no speed.
void Search(const Domain& domain, const Problem& problem, benchmark::State* state) {
  PlanResult result, last;
  std::uint64_t expansions = 0;
  for (auto _ : *state) {
    result = FindPlans(domain, problem);
    state->PauseTiming();  // to free the last plan is not part of the next search
    expansions += result.progress.expansions;
    last = std::move(result);
    state->ResumeTiming();
  }
  if (last.plans.empty()) {
    state->SkipWithError(("no plan: " + std::string(ToString(last.outcome))).c_str());
    return;
  }
  Report(last, expansions, state);
}

// ------------------------------------------------------------------------------ SHOP3's problems

/// CPU seconds of SHOP3 4.3.1 for `find-plans :which :first`, median of 3, SBCL 2.2.9, one core.
/// Measured for this project on the same kind of machine (Debian 12).
const std::map<std::string, double> kSecondsOfShop3 = {{"blocks_100", 0.23},
                                                       {"depots_01", 0.028},
                                                       {"depots_07", 0.092},
                                                       {"logistics_15_1", 0.008},
                                                       {"logistics_30_1", 0.095}};

void SearchShared(benchmark::State& state, const std::string& name, const std::string& domain_path,
                  double seconds_of_shop3) {
  try {
    const Domain domain = LoadDomain(domain_path);
    const auto problems = LoadProblems(kShared + name + ".lisp", domain);
    Search(domain, problems.front(), &state);
    state.counters["times_shop3"] =
        benchmark::Counter(seconds_of_shop3, benchmark::Counter::kIsIterationInvariantRate);
  } catch (const std::exception& error) {
    state.SkipWithError(error.what());
  }
}

void Register(const std::string& name, const std::string& problem, const std::string& domain_path,
              double seconds) {
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    SearchShared(state, problem, domain_path, seconds);
  })->Unit(benchmark::kMillisecond);
}

/// With the domains they came with, and with those of this folder. None where the files are
/// missing.
bool RegisterShared() {
  for (const auto& [name, seconds] : kSecondsOfShop3) {
    if (!std::filesystem::exists(kShared + name + ".lisp")) continue;
    const std::string kind = base::Split(name, '_').front() + ".lisp";
    Register("BM_Shared/" + name, name, kShared + kind, seconds);
    if (!std::filesystem::exists(kDomains + kind)) continue;
    Register("BM_SharedOwnDomain/" + name, name, kDomains + kind, seconds);
  }
  return true;
}
const bool kRegistered = RegisterShared();

// ------------------------------------------------------------------------------ growth

void SearchText(const std::string& domain_name, const std::string& text, benchmark::State* state) {
  try {
    const Domain domain = LoadDomain(kDomains + domain_name);
    const auto problems = ReadShop2Problems(text, "random");
    Search(domain, problems.front(), state);
  } catch (const std::exception& error) {
    state->SkipWithError(error.what());
  }
}

constexpr std::uint64_t kSeed = 7;

void BM_LogisticsGrowth(benchmark::State& state) {  // argument: parcels
  const auto size = test_support::LogisticsOf(static_cast<int>(state.range(0)));
  SearchText("logistics.lisp", test_support::LogisticsProblem(size, base::Rng(kSeed)), &state);
}
BENCHMARK(BM_LogisticsGrowth)
    ->Arg(15)
    ->Arg(30)
    ->Arg(60)
    ->Arg(120)
    ->Arg(300)
    ->Unit(benchmark::kMillisecond);

void BM_BlocksGrowth(benchmark::State& state) {  // argument: blocks
  const int num_blocks = static_cast<int>(state.range(0));
  SearchText("blocks.lisp", test_support::BlocksProblem(num_blocks, base::Rng(kSeed)), &state);
}
BENCHMARK(BM_BlocksGrowth)->Arg(100)->Arg(200)->Arg(500)->Arg(1000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::planning
