// How fast is the Blackboard's store? Writing: fluents a second, in batches and one by one, to a
// file on disk. Reading: at a million fluents, what it takes to open the file, to ask for a concept
// with all below it at a moment (a page of 100), and for the state of a moment; and at 100,000 that
// hold at once, for a few of them. Counter `found`: fluents in the answer; `visited`: rows looked
// at.
#include <benchmark/benchmark.h>
#include <stdlib.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/knowledge/store.h"

namespace hires::knowledge {
namespace {

constexpr int kPoses = 2000;      // things whose poses are observed
constexpr int kPlaced = 500;      // things that stand on an area
constexpr int kRows = 1'000'000;  // fluents of the big store

std::shared_ptr<const Ontology> RestaurantOntology() {
  const std::string folder = HIRES_SOURCE_DIR "/config/ontology/";
  static const auto ontology = std::make_shared<const Ontology>(
      Ontology::FromFiles({folder + "upper.ttl", folder + "race.ttl"}));
  return ontology;
}

/// A folder that is gone in the end.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "hires_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
    path_ = name;
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string File() const { return path_ / "blackboard.db"; }

 private:
  std::filesystem::path path_;
};

Fluent Pose(int index, base::Rng* rng) {
  Fluent fluent;
  fluent.concept_name = "Pose";
  fluent.instance = "pose" + std::to_string(index);
  for (const char* role : {"hasX", "hasY", "hasZ", "hasYaw"}) {
    fluent.properties.push_back({role, "xsd:float", rng->Uniform(-10.0, 10.0)});
  }
  return fluent;
}

Fluent On(int index, base::Rng* rng) {
  Fluent fluent;
  fluent.concept_name = "On";
  fluent.instance = "on" + std::to_string(index);
  fluent.properties = {{"hasPhysicalEntity", "Mug", "mug" + std::to_string(index)},
                       {"hasArea", "PlacingArea", "placingArea" + std::to_string(rng->Index(40))}};
  return fluent;
}

Fluent Activity(int index, const char* result) {
  Fluent fluent;
  fluent.concept_name = index % 2 == 0 ? "MoveBaseActivity" : "PickUpObjectActivity";
  fluent.instance = "activity" + std::to_string(index);
  fluent.properties = {{"hasResult", "xsd:string", std::string(result)}};
  return fluent;
}

/// What a robot sees in a moment: mostly poses, some changes of place.
std::vector<Fluent> Observed(int size, int* turn, base::Rng* rng) {
  std::vector<Fluent> fluents;
  for (int i = 0; i < size; ++i, ++*turn) {
    fluents.push_back(*turn % 5 == 4 ? On(*turn / 5 % kPlaced, rng) : Pose(*turn % kPoses, rng));
  }
  return fluents;
}

void BM_AddBatch(benchmark::State& state) {
  const Folder folder;
  Store store(folder.File(), RestaurantOntology());
  base::Rng rng(7);
  const int size = static_cast<int>(state.range(0));
  int turn = 0;
  double time = 0.0;
  store.Add(Observed(2 * kPoses, &turn, &rng), {Source::kObservation, 0, time});
  for (auto _ : state) {
    state.PauseTiming();
    const std::vector<Fluent> fluents = Observed(size, &turn, &rng);
    state.ResumeTiming();
    time += 0.01;
    benchmark::DoNotOptimize(store.Add(fluents, {Source::kObservation, 0, time}));
  }
  state.SetItemsProcessed(state.iterations() * size);
}
BENCHMARK(BM_AddBatch)->Arg(1)->Arg(50)->Arg(200)->Arg(1000)->UseRealTime();

void BM_AddWithPowerDurability(benchmark::State& state) {
  const Folder folder;
  StoreOptions options;
  options.durability = Durability::kPower;
  Store store(folder.File(), RestaurantOntology(), options);
  base::Rng rng(7);
  const int size = static_cast<int>(state.range(0));
  int turn = 0;
  double time = 0.0;
  for (auto _ : state) {
    time += 0.01;
    benchmark::DoNotOptimize(
        store.Add(Observed(size, &turn, &rng), {Source::kObservation, 0, time}));
  }
  state.SetItemsProcessed(state.iterations() * size);
}
BENCHMARK(BM_AddWithPowerDurability)->Arg(1)->Arg(200)->UseRealTime();

/// A million fluents: long histories of poses and places, and many activities that came and went.
class BigStore {
 public:
  BigStore() {
    Store store(folder_.File(), RestaurantOntology());
    base::Rng rng(11);
    int turn = 0;
    for (int activity = 0; store.Stats().fluents < kRows; ++activity) {
      end_ += 1.0;
      store.Add(Observed(450, &turn, &rng), {Source::kObservation, 0, end_});
      std::vector<Fluent> started, finished;
      std::vector<std::string> ended;
      for (int i = 0; i < 25; ++i) started.push_back(Activity(25 * activity + i, "running"));
      for (int i = 0; i < 25; ++i) finished.push_back(Activity(25 * activity + i, "succeeded"));
      for (int i = 0; i < 25; ++i) ended.push_back(finished[static_cast<std::size_t>(i)].instance);
      store.Add(started, {Source::kMonitor, 0, end_});
      store.Add(finished, {Source::kMonitor, 0, end_ + 0.5});
      store.Remove(ended, {Source::kMonitor, 0, end_ + 0.6});
    }
  }
  static BigStore& Get() {
    static BigStore store;
    return store;
  }
  std::string File() const { return folder_.File(); }
  Store Open() const {
    StoreOptions options;
    options.read_only = true;
    return Store(File(), RestaurantOntology(), options);
  }
  double end() const { return end_; }  ///< [s] of its time

 private:
  Folder folder_;
  double end_{0.0};
};

void BM_Open(benchmark::State& state) {
  const std::string file = BigStore::Get().File();
  std::uint64_t fluents = 0;
  for (auto _ : state) {
    const Store store(file, RestaurantOntology());
    fluents = store.Stats().fluents;
  }
  state.counters["fluents"] = static_cast<double>(fluents);
  state.counters["MB"] = static_cast<double>(std::filesystem::file_size(file)) / 1e6;
}
BENCHMARK(BM_Open)->Unit(benchmark::kMillisecond);

FluentQuery AtMoment(double share) {
  FluentQuery query;
  query.time.kind = FluentQuery::TimeFilter::Kind::kAt;
  query.time.at = share * BigStore::Get().end();
  return query;
}

void Count(const FluentPage& page, benchmark::State* state) {
  state->counters["found"] = static_cast<double>(page.fluents.size());
  state->counters["visited"] = static_cast<double>(page.visited);
}

void Run(const FluentQuery& query, benchmark::State* state) {
  const Store store = BigStore::Get().Open();
  store.Query(query);  // fills the cache
  for (auto _ : *state) benchmark::DoNotOptimize(store.Query(query));
  Count(store.Query(query), state);
}

// The argument is where in the store's time the moment lies, in percent; 100 is now.
void BM_ConceptAtMoment(benchmark::State& state) {
  FluentQuery query = AtMoment(0.01 * static_cast<double>(state.range(0)));
  query.concepts = {{"State", FluentQuery::ConceptFilter::Reach::kBelow}};
  query.limit = 100;
  Run(query, &state);
}
BENCHMARK(BM_ConceptAtMoment)->Arg(1)->Arg(50)->Arg(100)->Unit(benchmark::kMillisecond);

void BM_StateAtMoment(benchmark::State& state) {
  FluentQuery query = AtMoment(0.01 * static_cast<double>(state.range(0)));
  query.limit = 100'000;
  Run(query, &state);
}
BENCHMARK(BM_StateAtMoment)->Arg(1)->Arg(50)->Arg(100)->Unit(benchmark::kMillisecond);

void BM_StateNow(benchmark::State& state) {
  FluentQuery query;
  query.limit = 100'000;
  Run(query, &state);
}
BENCHMARK(BM_StateNow)->Unit(benchmark::kMillisecond);

void BM_OneInstanceAtMoment(benchmark::State& state) {
  FluentQuery query = AtMoment(0.3);
  query.instance = "pose77";
  Run(query, &state);
}
BENCHMARK(BM_OneInstanceAtMoment)->Unit(benchmark::kMicrosecond);

void BM_ConceptEver(benchmark::State& state) {  // a page of 100 out of some 180,000
  FluentQuery query;
  query.time.kind = FluentQuery::TimeFilter::Kind::kEver;
  query.concepts = {{"On", FluentQuery::ConceptFilter::Reach::kBelow}};
  query.limit = 100;
  Run(query, &state);
}
BENCHMARK(BM_ConceptEver)->Unit(benchmark::kMillisecond);

void BM_ChangesSince(benchmark::State& state) {
  const Store store = BigStore::Get().Open();
  std::size_t found = 0;
  for (auto _ : state) found = store.ChangesSince(kRows / 2, 1000).size();
  state.counters["found"] = static_cast<double>(found);
}
BENCHMARK(BM_ChangesSince)->Unit(benchmark::kMillisecond);

/// 100,000 poses and three mugs hold, 30,000 activities came and went, the last two go on.
class WideStore {
 public:
  WideStore() {
    constexpr int kBatch = 1000;
    for (int i = 0; i < 100; ++i)
      AddAll(kBatch, [&](int k) { return Pose(kBatch * i + k, &rng_); });
    AddAll(3, [&](int k) { return Mug(k); });
    for (int i = 0; i < 30; ++i) {
      AddAll(kBatch, [&](int k) { return Activity(kBatch * i + k, "running"); });
      std::vector<std::string> ended;
      for (int k = 0; k < kBatch; ++k) ended.push_back(Activity(kBatch * i + k, "").instance);
      store.Remove(ended, {Source::kMonitor, 0, ++time_});
    }
    AddAll(2, [&](int k) { return Activity(k, "running"); });
  }
  static WideStore& Get() {
    static WideStore store;
    return store;
  }
  double time() const { return time_; }

  Store store{":memory:", RestaurantOntology()};

 private:
  template <typename Make>
  void AddAll(int count, const Make& make) {
    std::vector<Fluent> fluents;
    for (int k = 0; k < count; ++k) fluents.push_back(make(k));
    store.Add(fluents, {Source::kObservation, 0, ++time_});
  }
  static Fluent Mug(int index) {
    Fluent fluent;
    fluent.concept_name = "Mug";
    fluent.instance = "mug" + std::to_string(index);
    fluent.properties = {{"hasPose", "Pose", "pose" + std::to_string(index)}};
    return fluent;
  }

  base::Rng rng_{13};
  double time_{0.0};
};

void RunWide(FluentQuery query, bool now, benchmark::State* state) {
  WideStore& wide = WideStore::Get();
  if (!now) query.time.kind = FluentQuery::TimeFilter::Kind::kAt;
  query.time.at = wide.time();
  for (auto _ : *state) benchmark::DoNotOptimize(wide.store.Query(query));
  Count(wide.store.Query(query), state);
}

// The argument says whether what holds now is asked for (1), or at a moment (0).
void BM_FewOfAConcept(benchmark::State& state) {
  FluentQuery query;
  query.concepts = {{"Mug", FluentQuery::ConceptFilter::Reach::kBelow}};
  RunWide(query, state.range(0) == 1, &state);
}
BENCHMARK(BM_FewOfAConcept)->Arg(1)->Arg(0)->Unit(benchmark::kMicrosecond);

void BM_FewThatGoOn(benchmark::State& state) {
  FluentQuery query;
  query.concepts = {{"RobotActivity", FluentQuery::ConceptFilter::Reach::kBelow}};
  RunWide(query, state.range(0) == 1, &state);
}
BENCHMARK(BM_FewThatGoOn)->Arg(1)->Arg(0)->Unit(benchmark::kMicrosecond);

void BM_FewByText(benchmark::State& state) {
  FluentQuery query;
  query.properties = {{"hasResult", Filler(std::string("running"))}};
  RunWide(query, state.range(0) == 1, &state);
}
BENCHMARK(BM_FewByText)->Arg(1)->Arg(0)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace hires::knowledge
