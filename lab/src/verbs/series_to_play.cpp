#include "lab/src/verbs/series_to_play.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "hires/base/error.h"
#include "hires/base/files/own_input.h"
#include "hires/base/hash.h"
#include "hires/base/run_processes.h"
#include "hires/base/text.h"
#include "reports/text/configuration_hash.h"
#include "lab/src/experiment/hypothesis.h"
#include "sim_robot/scenario.h"
#include "sim_robot/sim_robot_world.h"
#include "sim_robot/truth.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/robot/posture.h"
#include "hires/simulation/scene.h"
#include "hires/world/world.h"

namespace hires::lab {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr char kIdealTruth[] = "ideal";
constexpr char kDefaultTruth[] = "same";

std::string WholePath(const std::string& path) {
  return path.empty() ? path : fs::absolute(path).lexically_normal().string();
}

/// What is wrong with a value is told with the place where it stands.
template <typename Use>
auto UseFrom(const std::string& place, const Use& use) {
  try {
    return use();
  } catch (const base::ConfigError& error) {
    if (place.empty()) throw;
    throw base::ConfigError(fmt::format("{}: {}", place, error.what()));
  }
}

/// @param original  the world of the start as it is without the variation.
std::vector<Overlap> OverlapsIn(const imagination::ImaginationSetup& original,
                                            const SeriesStart& start,
                                            const VariantFiles& files) {
  const auto before = sim_robot::StartOf(original, start.scenario, "").robot;
  const auto after = sim_robot::StartOf(original, files.scenario, "").robot;
  const simulation::Scene& scene = *original.scene;
  const bool is_changed = files.world != start.world;  // a map stays what it is
  const world::World varied = is_changed ? world::LoadWorld(files.world) : scene.world;
  return NewOverlaps(
      {scene.world, before.X_MB}, {varied, after.X_MB}, scene.robot.model.name,
      simulation::FrozenShapes(scene.robot, robot::PostureOf(scene.robot, after.joints)));
}

}  // namespace

SeriesToPlay::SeriesToPlay(const ScenariosOptions& options, const std::string& package_folder)
    : options_(options),
      package_folder_(package_folder),
      series_(ReadScenarioSeries(options.file)),
      order_(options.order == "drawn" ? SeriesOrder::kDrawn
                                      : SeriesOrder::kAll),
      setting_(MakeSetting()) {
  base::Hasher hasher;
  hasher.Add(setting_.dump());
  name_ = series_.name + "_" + base::HexOf(hasher.value()).substr(0, 8);
}

SeriesRun SeriesToPlay::Expected(int number) const {
  SeriesRun run;
  run.run = number;
  run.choices = ChoicesOfRun(series_, order_, options_.seed, number);
  run.seed = SeedOfRun(options_.seed, number);
  const SeriesStart start = StartOf(run.choices);
  run.instruction = start.instruction;
  run.scenario = fs::path(start.scenario).stem().string();
  run.truth = start.truth;
  return run;
}

ScenarioOrder SeriesToPlay::Prepare(const SeriesRun& run, const std::string& folder) const {
  const SeriesStart start = StartOf(run.choices);
  ScenarioOrder order;
  order.task = TaskOfInstruction(start.instruction);
  order.files = WriteVariant(series_, run.choices,
                                         {start.scenario, order.task, start.world, folder});
  order.truth = start.truth;
  order.folder = folder;
  order.seed = run.seed;
  return order;
}

void SeriesToPlay::Check() {
  CheckOutputs();
  std::map<std::string, loop::LoopSetup> setups;  // by world
  for (int run = 1; run <= options_.runs; ++run) {
    const SeriesRun expected = Expected(run);
    if (overlaps_.count(expected.choices) > 0) continue;
    const SeriesStart start = StartOf(expected.choices);
    loop::LoopFiles files;
    files.world = start.world;
    const auto setup =
        setups.try_emplace(start.world, package_folder_ + "/config/loop.yaml", files).first;
    CheckInstruction(setup->second, start);
    UseFrom(PlaceOf(start, "Truth", "--truth", options_.truth),
            [&] { setup->second.ReadTruth(start.truth); });
    const base::RunFolder folder("");
    overlaps_[expected.choices] =
        OverlapsIn(setup->second.world(), start, Prepare(expected, folder.path()).files);
  }
}

void SeriesToPlay::CheckOutputs() const {
  for (const Input& input : Inputs()) {
    base::RefuseOwnInput("--json", options_.report.json, input.what, input.path);
    base::RefuseOwnInput("--csv", options_.csv, input.what, input.path);
  }
}

void SeriesToPlay::CheckInstruction(const loop::LoopSetup& setup, const SeriesStart& start) const {
  std::string place = PlaceOf(start, "Instruction", "--instruction", options_.instruction);
  if (place.empty()) place = start.scenario + ": task";
  UseFrom(fmt::format("{} '{}'", place, start.instruction), [&] {
    loop::RequireTask(setup, start.scenario, TaskOfInstruction(start.instruction));
  });
}

std::string SeriesToPlay::PlaceOf(const SeriesStart& start, const std::string& key,
                                  const std::string& option, const std::string& typed) const {
  if (!typed.empty()) return option;
  const auto place = start.places.find(key);
  return place == start.places.end() ? "" : place->second + ": " + key;
}

SeriesStart SeriesToPlay::StartOf(const std::vector<int>& choices) const {
  SeriesStart start = StartOfRun(series_, choices);
  if (!options_.scenario.empty()) start.scenario = options_.scenario;
  if (start.scenario.empty()) {
    throw base::ConfigError(options_.file +
                            ": says in no !Scenario document from which Scenario it begins; add "
                            "one, or --scenario NAME");
  }
  start.scenario = UseFrom(PlaceOf(start, "Scenario", "--scenario", options_.scenario), [&] {
    return WholePath(
        sim_robot::ScenarioPath(start.scenario, package_folder_ + "/config/scenarios"));
  });
  if (!options_.instruction.empty()) start.instruction = options_.instruction;
  if (start.instruction.empty()) {
    start.instruction = "achieve " + sim_robot::ReadScenario(start.scenario).task;
  }
  if (!options_.truth.empty()) start.truth = options_.truth;
  if (options_.is_ideal) start.truth = kIdealTruth;
  if (start.truth.empty()) start.truth = kDefaultTruth;
  if (!options_.world.empty()) start.world = options_.world;
  if (start.world.empty()) {
    start.world = imagination::ReadSetupConfig(package_folder_ + "/config/scene.yaml").world;
  }
  start.world = WholePath(start.world);
  return start;
}

/// Choices with which the starts differ: of each group that `!Scenario` documents name, all.
std::vector<std::vector<int>> SeriesToPlay::ChoicesOfStarts() const {
  const std::vector<int> first(series_.groups.size(), 0);
  std::vector<std::vector<int>> all{first};
  for (const auto& setting : series_.settings) {
    for (std::size_t g = 0; g < first.size(); ++g) {
      if (series_.groups[g].name != setting.group) continue;
      for (int choice = 1; choice < setting.choices; ++choice) {
        all.push_back(first);
        all.back()[g] = choice;
      }
    }
  }
  return all;
}

std::vector<SeriesToPlay::Input> SeriesToPlay::Inputs() const {
  std::vector<Input> inputs{{"series", options_.file, ""}};
  for (const std::vector<int>& choices : ChoicesOfStarts()) {
    const SeriesStart start = StartOf(choices);
    inputs.push_back(
        {"scenario", start.scenario, PlaceOf(start, "Scenario", "--scenario", options_.scenario)});
    for (const std::string& knowledge : sim_robot::ReadScenario(start.scenario).knowledge) {
      inputs.push_back({"knowledge", knowledge, start.scenario + ": knowledge"});
    }
    inputs.push_back({"world", start.world, PlaceOf(start, "World", "--world", options_.world)});
    const std::string place = PlaceOf(start, "Truth", "--truth", options_.truth);
    inputs.push_back({"truth",
                      UseFrom(place,
                              [&] {
                                return sim_robot::TruthPath(start.truth,
                                                             package_folder_ + "/config/truths");
                              }),
                      place});
  }
  return inputs;
}

/// Of all files that runs may begin from: who changes one has another series.
std::string SeriesToPlay::InputsHash() const {
  base::Hasher hasher;
  for (const Input& input : Inputs()) {
    hasher.Add(UseFrom(input.place, [&] { return base::ReadTextFile(input.path); }));
  }
  return base::HexOf(hasher.value());
}

ordered_json SeriesToPlay::MakeSetting() const {
  return {{"series", options_.file},
          {"inputs", InputsHash()},
          {"files", reports::ConfigurationHash(package_folder_)},
          {"scenario", options_.scenario},
          {"instruction", options_.instruction},
          {"truth", options_.is_ideal ? kIdealTruth : options_.truth},
          {"world", options_.world},
          {"order", options_.order},
          {"seed", options_.seed},
          {"restarts", options_.restarts},
          {"hang_after", options_.player.hang_after},
          {"graph", options_.player.is_graph},
          {"pace", options_.player.is_graph ? options_.player.pace : 0.0},
          {"workers", options_.player.is_graph ? options_.player.workers : 0}};
}

}  // namespace hires::lab
