// What does it cost to read the restaurant, alone and with every object that a request may name?
// A worker that starts with a master of its own pays it before its first rollout.
#include <benchmark/benchmark.h>

#include <string>

#include "hires/world/object_catalogue.h"
#include "hires/world/world.h"

namespace hires::world {
namespace {

const std::string kWorlds = HIRES_SOURCE_DIR "/worlds";

void BM_LoadRestaurant(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(LoadWorld(kWorlds + "/restaurant.world"));
}
BENCHMARK(BM_LoadRestaurant)->Unit(benchmark::kMillisecond);

void BM_LoadRestaurantAndCatalogue(benchmark::State& state) {
  const std::string catalogue = kWorlds + "/objects.yaml";
  for (auto _ : state) {
    benchmark::DoNotOptimize(LoadWorld(kWorlds + "/restaurant.world"));
    benchmark::DoNotOptimize(LoadCatalogueModels(catalogue));
  }
}
BENCHMARK(BM_LoadRestaurantAndCatalogue)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::world
