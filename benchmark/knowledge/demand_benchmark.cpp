// What do demand topics cost beside the writing? In a store that holds the restaurant, some things
// and their places: one transaction through every topic of config/knowledge/topics.yaml, and
// through one topic each of the kinds that differ. Arguments: poses that the transaction moves (and
// a fifth as many places), things. Counter `told`: changes in the messages of a transaction. And
// what does one moved pose cost a join after its ten things were taken away and put back so many
// times?
#include <benchmark/benchmark.h>

#include <memory>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/knowledge/demand.h"
#include "hires/knowledge/loading.h"

namespace hires::knowledge {
namespace {

std::shared_ptr<const Ontology> RestaurantOntology() {
  const std::string folder = HIRES_SOURCE_DIR "/config/ontology/";
  static const auto ontology = std::make_shared<const Ontology>(
      Ontology::FromFiles({folder + "upper.ttl", folder + "race.ttl"}));
  return ontology;
}

KnowledgeFile FileOf(const std::string& name) {
  return LoadKnowledge(HIRES_SOURCE_DIR "/config/knowledge/" + name);
}

Fluent Pose(int index, base::Rng* rng) {
  Fluent fluent;
  fluent.concept_name = "Pose";
  fluent.instance = "poseThing" + std::to_string(index);
  for (const char* role : {"hasX", "hasY", "hasZ", "hasYaw"}) {
    fluent.properties.push_back({role, "xsd:float", rng->Uniform(-10.0, 10.0)});
  }
  return fluent;
}

Fluent On(int index, base::Rng* rng) {
  Fluent fluent;
  fluent.concept_name = "On";
  fluent.instance = "onThing" + std::to_string(index);
  fluent.properties = {{"hasPhysicalEntity", "Mug", "thing" + std::to_string(index)},
                       {"hasArea", "PlacingArea", "area" + std::to_string(rng->Index(40))}};
  return fluent;
}

Fluent Thing(int index) {
  Fluent fluent;
  fluent.concept_name = "Mug";
  fluent.instance = "thing" + std::to_string(index);
  fluent.properties = {{"hasPose", "Pose", "poseThing" + std::to_string(index)}};
  return fluent;
}

/// A store, the topics on it, and time that goes on.
class Scene {
 public:
  Scene(const std::vector<DemandTopic>& topics, int num_things)
      : store_(":memory:", RestaurantOntology()), num_things_(num_things) {
    Load(FileOf("restaurant.yaml"), rng_, {Source::kKnowledge, 0, -temporal::kForever}, &store_);
    std::vector<Fluent> things;
    for (int i = 0; i < num_things_; ++i) {
      things.push_back(Pose(i, &rng_));
      things.push_back(Thing(i));
      things.push_back(On(i, &rng_));
    }
    store_.Add(things, {Source::kKnowledge, 0, 0.0});
    for (const DemandTopic& topic : topics) {
      demands_.emplace_back(topic, RestaurantOntology());
      demands_.back().Snapshot(store_);
    }
  }

  /// Observes so many poses, and some things at other places.
  std::vector<Change> Observe(int num_poses) {
    std::vector<Fluent> seen;
    for (int i = 0; i < num_poses; ++i) seen.push_back(Pose(++turn_ % num_things_, &rng_));
    for (int i = 0; i < num_poses / 5; ++i) seen.push_back(On(++turn_ % num_things_, &rng_));
    time_ += 0.01;
    return store_.Add(seen, {Source::kObservation, 0, time_});
  }
  /// Takes all things away and puts them back: the same state again, over links said before.
  void Repeat() {
    std::vector<Fluent> things;
    std::vector<std::string> names;
    for (int i = 0; i < num_things_; ++i) {
      things.push_back(Thing(i));
      names.push_back(things.back().instance);
    }
    time_ += 0.01;
    store_.Remove(names, {Source::kObservation, 0, time_});
    store_.Add(things, {Source::kObservation, 0, time_});
  }
  std::size_t Tell(const std::vector<Change>& changes) {
    std::size_t told = 0;
    for (Demand& demand : demands_) told += demand.Apply(changes, store_).changes.size();
    return told;
  }
  std::size_t Snapshots() {
    std::size_t told = 0;
    for (Demand& demand : demands_) told += demand.Snapshot(store_).changes.size();
    return told;
  }

 private:
  Store store_;
  const int num_things_;
  base::Rng rng_{7};
  std::vector<Demand> demands_;
  double time_{0.0};
  int turn_{0};
};

/// Only the telling is timed; the writing has a benchmark of its own.
void TellOnly(int num_poses, Scene* scene, benchmark::State* state) {
  std::size_t told = 0;
  std::size_t num_changes = 0;
  for (auto _ : *state) {
    state->PauseTiming();
    const std::vector<Change> changes = scene->Observe(num_poses);
    num_changes += changes.size();
    state->ResumeTiming();
    told += scene->Tell(changes);
  }
  state->SetItemsProcessed(static_cast<std::int64_t>(num_changes));
  state->counters["told"] =
      benchmark::Counter(static_cast<double>(told), benchmark::Counter::kAvgIterations);
}

void RunApply(const std::vector<DemandTopic>& topics, benchmark::State* state) {
  Scene scene(topics, static_cast<int>(state->range(1)));
  TellOnly(static_cast<int>(state->range(0)), &scene, state);
}

DemandTopic BelowPose() {
  DemandTopic topic;
  topic.name = "poses";
  topic.below = {"Pose"};
  return topic;
}

DemandTopic Joined() {
  DemandTopic topic;
  topic.name = "joined";
  topic.queries = {
      "select distinct ?thing where { ?thing a race:Mug ; upper:hasPose ?p . ?p upper:hasX ?x }"};
  return topic;
}

void BM_AllTopics(benchmark::State& state) { RunApply(FileOf("topics.yaml").topics, &state); }
BENCHMARK(BM_AllTopics)
    ->Args({10, 20})
    ->Args({10, 500})
    ->Args({50, 500})
    ->Unit(benchmark::kMicrosecond);

void BM_BelowAConcept(benchmark::State& state) { RunApply({BelowPose()}, &state); }
BENCHMARK(BM_BelowAConcept)
    ->Args({10, 20})
    ->Args({10, 500})
    ->Args({50, 500})
    ->Unit(benchmark::kMicrosecond);

void BM_Join(benchmark::State& state) { RunApply({Joined()}, &state); }
BENCHMARK(BM_Join)->Args({10, 20})->Args({10, 500})->Args({50, 500})->Unit(benchmark::kMicrosecond);

void BM_JoinAfterRepetitions(benchmark::State& state) {
  Scene scene({Joined()}, 10);
  for (int i = 0; i < state.range(0); ++i) scene.Repeat();
  TellOnly(1, &scene, &state);
}
BENCHMARK(BM_JoinAfterRepetitions)
    ->RangeMultiplier(10)
    ->Range(10, 10'000)
    ->Unit(benchmark::kMicrosecond);

void BM_Snapshots(benchmark::State& state) {
  Scene scene(FileOf("topics.yaml").topics, static_cast<int>(state.range(0)));
  std::size_t told = 0;
  for (auto _ : state) told = scene.Snapshots();
  state.counters["told"] = static_cast<double>(told);
}
BENCHMARK(BM_Snapshots)->Arg(20)->Arg(500)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hires::knowledge
