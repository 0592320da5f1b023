#include "lab/src/series/scenario_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/base/text.h"

namespace hires::lab {
namespace {

using knowledge::KnowledgeFile;
using knowledge::PoseModification;
using knowledge::ScenarioSetting;

constexpr std::int64_t kMostCombinations = 1'000'000'000;

void RequireVariations(const KnowledgeFile& file, const std::string& path) {
  if (!file.fluents.empty() || !file.topics.empty()) {
    throw base::ConfigError(path +
                            ": has a !Fluent or a !DemandTopic, which say what holds and not what "
                            "varies; put it into a "
                            "file that the scenario's `knowledge` names");
  }
  if (file.modifications.empty() && file.scenarios.empty()) {
    throw base::ConfigError(path +
                            ": is empty, wanted !FluentPoseModification and !Scenario documents");
  }
}

void RequireKeysOnce(const std::vector<ScenarioSetting>& settings) {
  std::map<std::string, std::string> seen;
  for (const ScenarioSetting& setting : settings) {
    for (const auto& [key, texts] : setting.values) {
      const auto [first, is_new] = seen.emplace(key, setting.where);
      if (is_new) continue;
      throw base::ConfigError(fmt::format("{}: {} is given already in {}; keep one", setting.where,
                                          key, first->second));
    }
  }
}

/// @param members  what of it takes the group's choice.
void AddTo(std::vector<SeriesGroup>* groups, const std::string& name, int choices,
           const std::vector<std::string>& members, const std::string& where) {
  auto group = std::find_if(groups->begin(), groups->end(),
                            [&](const SeriesGroup& other) { return other.name == name; });
  if (group == groups->end()) group = groups->insert(group, {name, choices, {}});
  if (group->choices != choices) {
    throw base::ConfigError(
        fmt::format("{}: Choices is {}, but group '{}' has {}; a group takes one choice for all, "
                    "so give all as "
                    "many",
                    where, choices, name, group->choices));
  }
  group->members.insert(group->members.end(), members.begin(), members.end());
}

std::vector<SeriesGroup> GroupsOf(const ScenarioSeries& series) {
  std::vector<SeriesGroup> groups;
  for (const PoseModification& each : series.modifications) {
    AddTo(&groups, each.group, each.choices, {each.instance}, each.where);
  }
  for (const ScenarioSetting& setting : series.settings) {
    if (setting.group.empty()) continue;
    std::vector<std::string> keys;
    for (const auto& [key, texts] : setting.values) keys.push_back(key);
    AddTo(&groups, setting.group, setting.choices, keys, setting.where);
  }
  return groups;
}

double ZOriginOf(const std::vector<ScenarioSetting>& settings) {
  double z_origin = 0.0;
  for (const ScenarioSetting& setting : settings) {
    if (setting.z_origin == 0.0) continue;
    if (z_origin != 0.0 || !setting.group.empty()) {
      throw base::ConfigError(setting.where +
                              ": ZOrigin holds for the whole file; give it once, in a document "
                              "without Group");
    }
    z_origin = setting.z_origin;
  }
  return z_origin;
}

void LowerBy(double z_origin, std::vector<PoseModification>* modifications) {
  for (PoseModification& modification : *modifications) {
    for (PoseModification::Delta& delta : modification.modifications) {
      if (delta.property != "hasZ") continue;
      for (double& z : delta.choices) z -= z_origin;
    }
  }
}

bool IsFile(const std::string& text) {
  const std::filesystem::path path(text);
  return path.has_parent_path() || path.has_extension();
}

std::string Resolved(const std::string& text, const std::string& series) {
  if (!IsFile(text)) return text;
  return (std::filesystem::absolute(series).parent_path() / text).lexically_normal().string();
}

}  // namespace

ScenarioSeries ReadScenarioSeries(const std::string& path) {
  KnowledgeFile file = knowledge::LoadKnowledge(path);
  RequireVariations(file, path);
  ScenarioSeries series;
  series.path = path;
  series.name = std::filesystem::path(path).stem().string();
  series.modifications = std::move(file.modifications);
  series.settings = std::move(file.scenarios);
  RequireKeysOnce(series.settings);
  LowerBy(ZOriginOf(series.settings), &series.modifications);
  series.groups = GroupsOf(series);
  return series;
}

std::int64_t NumCombinations(const ScenarioSeries& series) {
  std::int64_t number = 1;
  for (const SeriesGroup& group : series.groups) {
    number = std::min(kMostCombinations, number * group.choices);
  }
  return number;
}

std::vector<int> ChoicesOfRun(const ScenarioSeries& series, SeriesOrder order, std::uint64_t seed,
                              int run) {
  const base::Rng rng = base::Rng(seed).Fork(static_cast<std::uint64_t>(run));
  std::vector<int> choices;
  std::int64_t rest = run - 1;
  for (const SeriesGroup& group : series.groups) {
    choices.push_back(order == SeriesOrder::kDrawn ? rng.Fork(choices.size()).Index(group.choices)
                                                   : static_cast<int>(rest % group.choices));
    rest /= group.choices;
  }
  return choices;
}

std::map<std::string, int> ByGroup(const ScenarioSeries& series, const std::vector<int>& choices) {
  std::map<std::string, int> by_group;
  for (std::size_t i = 0; i < choices.size(); ++i) by_group[series.groups[i].name] = choices[i];
  return by_group;
}

SeriesStart StartOfRun(const ScenarioSeries& series, const std::vector<int>& choices) {
  const std::map<std::string, int> by_group = ByGroup(series, choices);
  std::map<std::string, std::string> texts, places;
  for (const ScenarioSetting& setting : series.settings) {
    const auto choice =
        setting.group.empty() ? 0 : static_cast<std::size_t>(by_group.at(setting.group));
    for (const auto& [key, values] : setting.values) {
      texts[key] = values.at(choice);
      places[key] = setting.where;
    }
  }
  return {Resolved(texts["Scenario"], series.path), texts["Instruction"],
          Resolved(texts["Truth"], series.path), Resolved(texts["World"], series.path),
          std::move(places)};
}

std::string TaskOfInstruction(const std::string& instruction) {
  constexpr char kSuffix[] = "_task";
  constexpr std::size_t kLength = sizeof(kSuffix) - 1;
  std::vector<std::string> words;
  for (const std::string& word : base::Split(instruction, ' ')) {
    if (!word.empty()) words.push_back(word);
  }
  if (!words.empty() && base::ToLower(words.front()) == "achieve") words.erase(words.begin());
  if (words.empty()) return "";
  std::string& name = words.front();
  const bool has_suffix = name.size() > kLength &&
                          base::ToLower(name).compare(name.size() - kLength, kLength, kSuffix) == 0;
  if (has_suffix) name.resize(name.size() - kLength);
  return base::Join(words, " ");
}

}  // namespace hires::lab
