#include "loop/task_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "hires/knowledge/fluent_yaml.h"
#include "hires/planning/request.h"

namespace hires::loop {
namespace {

std::string WithoutNumber(const std::string& name) {
  return name.substr(0, name.find_last_not_of("0123456789") + 1);
}

/// Long names are misspelt; short ones, and those that a number tells apart (guest1, guest2), may
/// as well be others that a domain of somebody else takes.
bool IsSlip(const std::string& name, const std::string& known) {
  constexpr std::size_t kLong = 8;
  return name.size() >= kLong && WithoutNumber(name) != WithoutNumber(known) &&
         base::AreSpeltAlike(name, known);
}

/// Names as files spell them, by the names in lower case; the first spelling stays.
class KnownNames {
 public:
  void Add(const std::string& name) { names_.emplace(base::ToLower(name), name); }
  /// A word of domain or ontology: it may stand in a task, but nobody misspells a thing for it.
  void AddWord(const std::string& word) { words_.insert(base::ToLower(word)); }
  template <typename Map>
  void AddKeys(const Map& map) {
    for (const auto& entry : map) Add(entry.first);
  }
  bool Has(const std::string& name) const {
    const std::string lower = base::ToLower(name);
    return names_.count(lower) > 0 || words_.count(lower) > 0;
  }
  std::vector<std::string> Like(const std::string& name) const {
    std::vector<std::string> alike;
    for (const auto& [lower, spelt] : names_) {
      if (IsSlip(base::ToLower(name), lower)) alike.push_back(spelt);
    }
    return alike;
  }
  std::vector<std::string> All() const {
    std::vector<std::string> all;
    for (const auto& [lower, spelt] : names_) all.push_back(spelt);
    return all;
  }

 private:
  std::map<std::string, std::string> names_;
  std::set<std::string> words_;
};

void AddWorld(const imagination::ImaginationSetup& setup, KnownNames* known) {
  const world::World& world = setup.scene->world;
  for (const auto& [lower, spelt] : world.frame_names) known->Add(spelt);
  for (const translation::Area& area : setup.translator.areas.all) known->Add(area.name);
  for (const world::StaticBody& body : world.statics) known->Add(body.name);
  for (const world::ObjectState& object : world.initial.objects) known->Add(object.name);
  known->AddKeys(world.models);
  known->AddKeys(setup.object_models);
}

void AddRobot(const robot::RobotProfile& profile, KnownNames* known) {
  known->AddKeys(profile.motion_sets);
  if (!profile.upper_body) return;
  known->AddKeys(profile.upper_body->torso_postures);
  known->AddKeys(profile.upper_body->arms);
  for (const auto& [arm, description] : profile.upper_body->arms) {
    known->AddKeys(description.postures);
  }
}

void AddKnowledge(const std::string& path, KnownNames* known) {
  for (const knowledge::Fluent& fluent : knowledge::LoadKnowledge(path).fluents) {
    known->Add(fluent.instance);
    for (const knowledge::Property& property : fluent.properties) {
      const auto* text = std::get_if<std::string>(&property.filler);
      if (text != nullptr) known->Add(*text);
    }
  }
}

void AddPlanning(const planning::PlanningKnowledge& planning, KnownNames* known) {
  for (const std::string& name : planning::SymbolsOf(planning.domain, {})) known->AddWord(name);
  for (const planning::Problem& problem : planning.problems) {
    for (const std::string& name : planning::SymbolsOf({}, problem)) known->Add(name);
  }
}

/// A symbol as the task was typed; the planner's are in lower case.
std::string Typed(const std::string& symbol, const std::string& task) {
  const std::size_t place = base::ToLower(task).find(base::ToLower(symbol));
  return place == std::string::npos ? symbol : task.substr(place, symbol.size());
}

KnownNames NamesOf(const LoopSetup::Parts& parts, const sim_robot::Scenario& scenario) {
  KnownNames known;
  for (const std::string& file : scenario.knowledge) AddKnowledge(file, &known);
  AddWorld(parts.world, &known);
  AddRobot(parts.world.scene->robot.profile, &known);
  for (const std::string& name : parts.ontology->ConceptNames()) known.AddWord(name);
  for (const sim_robot::ScenarioObject& object : scenario.objects) known.Add(object.name);
  AddPlanning(parts.planning, &known);
  return known;
}

planning::Problem ProblemOf(const LoopSetup::Parts& parts, const std::string& task) {
  planning::Problem problem;
  try {
    planning::SetTasks(task, parts.planning.domain, &problem);
  } catch (const base::ConfigError& error) {
    throw base::ConfigError(
        fmt::format("{} (domain {})", error.what(), parts.config.execution.domain));
  }
  return problem;
}

}  // namespace

void RequireKnownNames(const LoopSetup::Parts& parts, const sim_robot::Scenario& scenario,
                       const std::string& task, StrangeArgument strange) {
  const planning::Problem problem = ProblemOf(parts, task);
  // HDDL declares its objects, and its reader has compared them.
  if (parts.planning.domain.language == planning::Domain::Language::kHddl) return;
  const KnownNames known = NamesOf(parts, scenario);
  for (const std::string& name : planning::ArgumentSymbols(problem.tasks)) {
    const bool is_kin = !parts.context.FindModel(name).empty();  // mug3 is what mug1 is
    if (known.Has(name) || is_kin) continue;
    std::vector<std::string> alike = known.Like(name);
    if (alike.empty() && strange == StrangeArgument::kRefused) alike = known.All();
    if (!alike.empty()) {
      throw base::ConfigError(base::UnknownName("task argument", Typed(name, task), alike));
    }
    base::Log(base::LogLevel::kWarn,
              fmt::format("task argument '{}' stands in no file: no knowledge, world, catalogue or "
                          "domain names it",
                          Typed(name, task)));
  }
}

}  // namespace hires::loop
