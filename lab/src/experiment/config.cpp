#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/text.h"
#include "lab/src/experiment/experiment.h"
#include "hires/imagination/imagination_setup.h"

namespace hires::lab {
namespace {

using base::Between;
using base::ParamReader;

constexpr double kFar = 1000.0;     // [m] worlds are not larger
constexpr double kLongest = 1.0e7;  // [s] about four months
constexpr int kMostRuns = 1000000;
constexpr int kMostSamples = 1000000000;
const char* const kKinds[] = {"legs", "paired", "topple_loop", "durations", "braking"};

std::vector<Goal> ReadGoals(ParamReader* in) {
  std::vector<Goal> goals;
  std::set<std::string> seen;
  for (ParamReader& entry : in->SubList("goals")) {
    Goal goal;
    goal.name = entry.GetString("name");
    if (goal.name.empty()) entry.Fail("name", "wanted some text");
    if (!seen.insert(base::ToLower(goal.name)).second) entry.Fail("name", "wanted every name once");
    const std::vector<double> pose = entry.GetNumbers("pose", 3);
    if (std::abs(pose[0]) > kFar || std::abs(pose[1]) > kFar || std::abs(pose[2]) > 6.3) {
      entry.Fail("pose", "wanted x and y within 1000 m, yaw within 6.3 rad");
    }
    goal.X_MG = {pose[0], pose[1], pose[2]};
    goals.push_back(goal);
  }
  if (goals.size() < 2) in->Fail("goals", "wanted at least two goals");
  return goals;
}

std::vector<std::string> NamesOf(const std::vector<Goal>& goals) {
  std::vector<std::string> names;
  for (const Goal& goal : goals) names.push_back(goal.name);
  return names;
}

std::string GetGoal(ParamReader* in, const std::string& key, const std::vector<Goal>& goals) {
  return in->Get(key, base::OneOf(NamesOf(goals)));
}

std::vector<std::string> TwoMotionSets(ParamReader* in) {
  std::vector<std::string> sets = in->GetStrings("motion_sets");
  if (sets.size() != 2 || sets[0] == sets[1]) {
    in->Fail("motion_sets", "wanted two different motion sets");
  }
  return sets;
}

LegsConfig ReadLegs(ParamReader* in, const ExperimentOverrides& overrides) {
  LegsConfig legs;
  legs.legs = in->Get("legs", Between(1, kMostRuns));
  legs.chains = in->Get("chains", Between(1, kMostRuns));
  legs.motion_set = in->GetString("motion_set");
  if (overrides.runs) legs.legs = *overrides.runs;
  legs.chains = std::min(legs.chains, legs.legs);
  return legs;
}

PairedConfig ReadPaired(ParamReader* in, const std::vector<Goal>& goals,
                        const ExperimentOverrides& overrides) {
  PairedConfig paired;
  paired.pairs = in->Get("pairs", Between(1, kMostRuns));
  paired.from = GetGoal(in, "from", goals);
  paired.to = GetGoal(in, "to", goals);
  paired.motion_sets = TwoMotionSets(in);
  if (overrides.runs) paired.pairs = *overrides.runs;
  return paired;
}

ToppleReference ReadToppleReference(ParamReader in) {
  ToppleReference reference;
  reference.counts.notopple = in.Get("notopple", Between(0, kMostSamples));
  reference.counts.shaking = in.Get("shaking", Between(0, kMostSamples));
  reference.counts.topple = in.Get("topple", Between(0, kMostSamples));
  reference.duration = in.Get("duration", Between(0.0, kLongest));
  return reference;
}

std::vector<std::string> ReadRoute(ParamReader* in, const std::vector<Goal>& goals) {
  const std::vector<std::string> route = in->GetStrings("route"), known = NamesOf(goals);
  for (const std::string& name : route) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      in->Fail("route", base::UnknownName("goal", name, known));
    }
  }
  if (route.size() < 2) in->Fail("route", "wanted at least two goals");
  return route;
}

ToppleLoopConfig ReadToppleLoop(ParamReader* in, const std::vector<Goal>& goals,
                                const ExperimentOverrides& overrides) {
  ToppleLoopConfig loop;
  loop.duration = in->Get("duration", Between(0.1, kLongest));
  loop.chains = in->Get("chains", Between(1, kMostRuns));
  loop.one_truth_per_chain = in->Get("truth_per", base::OneOf({"leg", "chain"})) == "chain";
  loop.route = ReadRoute(in, goals);
  loop.motion_sets = TwoMotionSets(in);
  ParamReader reference = in->Sub("reference");
  for (const std::string& set : loop.motion_sets) {
    loop.references[set] = ReadToppleReference(reference.Sub(set));
  }
  if (overrides.runs) {
    loop.duration *= static_cast<double>(*overrides.runs) / loop.chains;
    loop.chains = *overrides.runs;
  }
  return loop;
}

DurationReference ReadDurationReference(ParamReader in) {
  DurationReference reference;
  reference.mean = in.Get("mean", Between(0.0, kLongest));
  reference.sigma = in.Get("sigma", Between(0.0, kLongest));
  return reference;
}

DurationsConfig::Row ReadDurationsRow(ParamReader* in, const std::vector<Goal>& goals) {
  DurationsConfig::Row row;
  row.action = in->Get("action", base::OneOf({"move_base_param", "move_torso", "tuck_arms"}));
  if (row.action == "move_base_param") {
    row.motion_set = in->GetString("motion_set");
    row.from = GetGoal(in, "from", goals);
    row.to = GetGoal(in, "to", goals);
  } else {
    row.from = in->GetString("from");
    row.to = in->GetString("to");
  }
  row.simulated = ReadDurationReference(in->Sub("simulated"));
  row.real = ReadDurationReference(in->Sub("real"));
  return row;
}

bool IsWayBack(const DurationsConfig::Row& a, const DurationsConfig::Row& b) {
  return a.action == b.action && a.motion_set == b.motion_set && a.from == b.to && a.to == b.from;
}

/// Tables can be read as from/to and as to/from: rows are compared with their way back.
void CheckWaysBack(const ParamReader& in, const DurationsConfig& durations) {
  for (const DurationsConfig::Row& row : durations.rows) {
    const auto num_back = std::count_if(durations.rows.begin(), durations.rows.end(),
                                        [&](const auto& other) { return IsWayBack(row, other); });
    if (num_back == 1 && row.from != row.to) continue;
    in.Fail("actions", fmt::format("wanted one way back of {} {} from {} to {}", row.action,
                                   row.motion_set, row.from, row.to));
  }
}

std::vector<DurationsConfig::Planner> ReadDurationPlanners(ParamReader* in) {
  std::vector<DurationsConfig::Planner> planners;
  for (const std::string& name : in->GetStrings("planners")) {
    if (name != "scene" && name != "unscaled") {
      in->Fail("planners", base::UnknownName("planner", name, {"scene", "unscaled"}));
    }
    planners.push_back(name == "scene" ? DurationsConfig::Planner::kScene
                                       : DurationsConfig::Planner::kUnscaled);
  }
  const std::set<DurationsConfig::Planner> different(planners.begin(), planners.end());
  if (planners.empty() || different.size() < planners.size()) {
    in->Fail("planners", "wanted at least one, and each once");
  }
  return planners;
}

DurationsConfig ReadDurations(ParamReader* in, const std::vector<Goal>& goals,
                              const ExperimentOverrides& overrides) {
  DurationsConfig durations;
  durations.runs = overrides.runs.value_or(in->Get("runs", Between(1, kMostRuns)));
  durations.postures_at = GetGoal(in, "postures_at", goals);
  durations.planners = ReadDurationPlanners(in);
  for (ParamReader& row : in->SubList("actions")) {
    durations.rows.push_back(ReadDurationsRow(&row, goals));
  }
  if (durations.rows.empty()) in->Fail("actions", "wanted at least one action");
  CheckWaysBack(*in, durations);
  return durations;
}

void ReadKind(const std::string& kind, const std::string& path, ParamReader* in,
              const ExperimentOverrides& overrides, ExperimentConfig* config) {
  if (kind == "legs") config->kind = ReadLegs(in, overrides);
  if (kind == "paired") config->kind = ReadPaired(in, config->goals, overrides);
  if (kind == "topple_loop") config->kind = ReadToppleLoop(in, config->goals, overrides);
  if (kind == "durations") config->kind = ReadDurations(in, config->goals, overrides);
  if (kind == "braking") config->kind = ReadBraking(in, path, overrides);
}

/// As text, for the reader of uncertainties, which says what is wrong with a quantity.
std::string ReadUncertaintyChanges(ParamReader in) {
  for (const std::string& name : in.Keys()) {
    ParamReader quantity = in.Sub(name);
    for (const std::string& key : quantity.Keys()) quantity.GetString(key);
  }
  return in.Canonical();
}

/// Of a robot that finds its place by itself.
void ReadMishaps(ParamReader* in, ExperimentConfig* config) {
  if (in->Has("carried")) config->is_carried = in->GetBool("carried");
  if (in->Has("moved")) {
    for (ParamReader& body : in->SubList("moved")) {
      const std::string name = body.GetString("body");
      const std::vector<double> by = body.GetNumbers("by", 3);
      config->moved.push_back({name, {by[0], by[1], by[2]}});
    }
  }
  if (in->Has("wet")) {
    for (ParamReader& patch : in->SubList("wet")) {
      constexpr double kFarthest = 1000.0;  // [m]
      const double x = patch.Get("x", Between(-kFarthest, kFarthest));
      const double y = patch.Get("y", Between(-kFarthest, kFarthest));
      const double radius = patch.Get("radius", Between(0.01, kFarthest));
      config->wet.push_back({{x, y}, radius, patch.Get("spin", Between(0.0, 10.0))});
    }
  }
  const bool has_any = config->is_carried || !config->moved.empty() || !config->wet.empty();
  if (has_any && config->self_localisation == "none")
    in->Fail(
        "self_localisation",
        "is none: only a robot that finds its place by itself can be carried, have an old map, or "
        "slip; wanted a file like config/self_localisation.yaml");
}

void ReadPlace(const std::string& path, ParamReader* in, const ExperimentOverrides& overrides,
               ExperimentConfig* config) {
  config->scene = imagination::ResolvePath(in->GetString("scene"), path);
  if (in->Has("world")) config->world = imagination::ResolvePath(in->GetString("world"), path);
  config->uncertainty = in->GetString("uncertainty");
  if (config->uncertainty != "scene") {
    config->uncertainty = imagination::ResolvePath(config->uncertainty, path);
  }
  config->uncertainty_changes = ReadUncertaintyChanges(in->Sub("uncertainty_changes"));
  config->map = in->GetString("map");
  config->wall_height = in->Get("wall_height", Between(0.1, 100.0));
  if (in->Has("self_localisation")) config->self_localisation = in->GetString("self_localisation");
  if (config->self_localisation != "none")
    config->self_localisation = imagination::ResolvePath(config->self_localisation, path);
  ReadMishaps(in, config);
  if (in->Has("obstacle_layer")) config->obstacle_layer = in->GetString("obstacle_layer");
  if (config->obstacle_layer != "scene")
    config->obstacle_layer = imagination::ResolvePath(config->obstacle_layer, path);
  if (!overrides.map.empty()) {
    config->map = overrides.map;
  } else if (config->map == "given") {
    in->Fail("map", "wanted with it a map_server YAML on the command line: --map FILE");
  } else if (config->map != "none") {
    config->map = imagination::ResolvePath(config->map, path);
  }
}

std::uint64_t HashOf(const ParamReader& in, const ExperimentOverrides& overrides) {
  base::Hasher hasher;
  hasher.Add(in.Canonical());
  hasher.Add(static_cast<std::uint64_t>(overrides.runs.value_or(0)));
  return hasher.value();
}

void CheckOverrides(const ExperimentOverrides& overrides) {
  if (overrides.runs && (*overrides.runs < 1 || *overrides.runs > kMostRuns)) {
    throw base::ConfigError(fmt::format("runs is {}, wanted a whole number between 1 and {}",
                                        *overrides.runs, kMostRuns));
  }
}

}  // namespace

ExperimentConfig ReadExperiment(const std::string& path, const ExperimentOverrides& overrides) {
  CheckOverrides(overrides);
  ParamReader in = ParamReader::FromFile(path);
  ExperimentConfig config;
  config.name = std::filesystem::path(path).stem().string();
  const std::string kind = in.Get("kind", base::OneOf({std::begin(kKinds), std::end(kKinds)}));
  ReadPlace(path, &in, overrides, &config);
  config.seed = static_cast<std::uint64_t>(in.Get("seed", Between(0, 2147483647)));
  if (overrides.seed) config.seed = *overrides.seed;
  config.goals = ReadGoals(&in);
  config.objects = in.GetStrings("objects");
  ParamReader own = in.Sub(kind);
  ReadKind(kind, path, &own, overrides, &config);
  config.expect = ReadExpectations(&in);
  in.RejectUnknownKeys();
  if (!std::filesystem::exists(config.scene)) {
    in.Fail("scene", fmt::format("which counts from this file's folder, where it is {}: there is no "
                                 "such file; write where the scene lies from here, or all of its "
                                 "path",
                                 config.scene));
  }
  config.hash = HashOf(in, overrides);
  return config;
}

const char* ToString(DurationsConfig::Planner planner) {
  return planner == DurationsConfig::Planner::kScene ? "scene" : "unscaled";
}

std::size_t WayBack(const DurationsConfig& durations, std::size_t row) {
  std::size_t back = 0;
  while (back < durations.rows.size() && !IsWayBack(durations.rows[row], durations.rows[back])) {
    ++back;
  }
  HIRES_CHECK(back < durations.rows.size(), "every row has its way back");
  return back;
}

std::string KindName(const ExperimentConfig& config) { return kKinds[config.kind.index()]; }

}  // namespace hires::lab
