#include "sim_robot/scenario_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "hires/base/text.h"
#include "hires/knowledge/fluent_yaml.h"

namespace hires::sim_robot {
namespace {

using base::ToLower;
using knowledge::Fluent;

/// What the knowledge files name, as they spell it, by the names in lower case.
struct KnownNames {
  std::map<std::string, std::string> all;  ///< instances
  std::vector<std::string> places;         ///< instances that are somewhere
  std::map<std::string, std::string> on;   ///< objects of which On says where they are
};

std::vector<std::string> LinksOf(const Fluent& fluent, const std::string& role) {
  std::vector<std::string> links;
  for (const knowledge::Property& property : fluent.properties) {
    if (property.role == role && property.IsLink()) {
      links.push_back(std::get<std::string>(property.filler));
    }
  }
  return links;
}

KnownNames NamesOf(const std::vector<knowledge::KnowledgeFile>& files) {
  KnownNames known;
  for (const knowledge::KnowledgeFile& file : files) {
    for (const Fluent& fluent : file.fluents) {
      known.all[ToLower(fluent.instance)] = fluent.instance;
      if (!LinksOf(fluent, "hasPose").empty()) known.places.push_back(fluent.instance);
      if (fluent.concept_name != "On") continue;
      for (const std::string& object : LinksOf(fluent, "hasPhysicalEntity")) {
        known.on[ToLower(object)] = object;
      }
    }
  }
  return known;
}

void AddUnknownAreas(const knowledge::KnowledgeFile& file, const KnownNames& known,
                     std::vector<std::string>* misfits) {
  for (const Fluent& fluent : file.fluents) {
    if (fluent.concept_name != "RobotAt") continue;
    for (const std::string& area : LinksOf(fluent, "hasArea")) {
      if (known.all.count(ToLower(area)) > 0) continue;
      misfits->push_back(fmt::format("{}: fluent '{}' of RobotAt: {}", file.source, fluent.instance,
                                     base::UnknownName("area", area, known.places)));
    }
  }
}

std::set<std::string> WordsOf(const std::string& task) {
  std::string words = ToLower(task);
  std::replace_if(
      words.begin(), words.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  const std::vector<std::string> parts = base::Split(words, ' ');
  return {parts.begin(), parts.end()};
}

}  // namespace

std::vector<std::string> NamesThatDoNotFit(const Scenario& scenario, const std::string& path,
                                           const std::string& task,
                                           const std::vector<std::string>& areas) {
  if (scenario.knowledge.empty()) return {};
  std::vector<knowledge::KnowledgeFile> files;
  for (const std::string& file : scenario.knowledge) {
    files.push_back(knowledge::LoadKnowledge(file));
  }
  KnownNames known = NamesOf(files);
  for (const std::string& area : areas) {
    known.all.emplace(ToLower(area), area);
    known.places.push_back(area);
  }
  std::vector<std::string> misfits, there;
  for (const auto& file : files) AddUnknownAreas(file, known, &misfits);
  for (const ScenarioObject& object : scenario.objects) there.push_back(object.name);

  std::vector<std::string> missing;  // of the objects that On speaks of
  for (const auto& [lower, name] : known.on) {
    if (std::count(there.begin(), there.end(), lower) == 0) missing.push_back(name);
  }
  for (const ScenarioObject& object : scenario.objects) {
    if (!object.is_told || known.all.count(object.name) > 0) continue;
    misfits.push_back(fmt::format("{}: objects: in the knowledge files {} Or move it to `hidden`",
                                  path, base::UnknownName("object", object.name, missing)));
  }
  const std::set<std::string> words = WordsOf(task);
  for (const std::string& name : missing) {
    if (words.count(ToLower(name)) == 0) continue;
    misfits.push_back(fmt::format(
        "{}: task: the knowledge files say where it is, but among the scenario's objects {}", path,
        base::UnknownName("object", name, there)));
  }
  return misfits;
}

}  // namespace hires::sim_robot
