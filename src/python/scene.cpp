#include "python/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <thread>

#include "base/trimmed.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/world/object_catalogue.h"
#include "imagination/area_file.h"

namespace hires::python {
namespace {

/// What no name of an object has, and every file of one.
bool IsFile(const std::string& object) {
  return object.find('/') != std::string::npos || object.find('.') != std::string::npos;
}

base::Atom ParseFact(const std::string& text) {
  const std::size_t open = text.find('('), close = text.find(')');
  const std::string predicate = base::Trimmed(text.substr(0, open));
  const bool is_fact = !predicate.empty() && open != std::string::npos &&
                       close != std::string::npos && open < close &&
                       base::Trimmed(text.substr(close + 1)).empty();
  if (!is_fact) {
    throw base::ConfigError(
        fmt::format("facts: '{}' is no fact; write it as 'Holding(rightArm1, mug1)'", text));
  }
  base::Atom atom{predicate, {}};
  for (const std::string& name : base::Split(text.substr(open + 1, close - open - 1), ',')) {
    atom.arguments.push_back(base::Trimmed(name));
  }
  return atom;
}

/// @param name_of  what an object is called that is given by its file.
std::vector<base::Atom> AtomsOf(const StartOfAction& start,
                                const std::function<std::string(const std::string&)>& name_of) {
  std::vector<base::Atom> atoms{{"RobotAt", {start.robot_at}}};
  for (const std::string& object : start.on_tray) atoms.push_back({"On", {object, "trayArea1"}});
  for (const std::string& fact : start.facts) {
    base::Atom atom = ParseFact(fact);
    for (std::string& argument : atom.arguments) argument = name_of(argument);
    atoms.push_back(std::move(atom));
  }
  return atoms;
}

std::vector<imagination::PutObject> PutObjectsOf(const StartOfAction& start) {
  std::vector<imagination::PutObject> objects;
  for (const auto& [name, pose] : start.put) {
    objects.push_back({name, "", geometry::Lift({pose[0], pose[1], pose[3]}, pose[2])});
  }
  return objects;
}

imagination::SetupConfig ConfigOf(const SceneFiles& files, const std::string& scene) {
  imagination::SetupConfig config = imagination::ReadSetupConfig(scene);
  if (!files.world.empty() && !files.map.empty()) {
    throw base::ConfigError("world and map are both given; name one of them");
  }
  imagination::OverridePaths(files.world, files.robot, files.catalogue, files.uncertainty, &config);
  config.map = files.map;
  config.extra_objects = files.objects;
  config.action_libraries = files.actions;
  for (const auto& [name, pose] : files.areas) {
    config.areas.push_back({name, {pose[0], pose[1], pose[2]}});
  }
  for (const std::string& file : files.area_files) {
    const auto more = imagination::ReadAreaFile(file);
    config.areas.insert(config.areas.end(), more.begin(), more.end());
  }
  return config;
}

/// What is not given stays as the configuration says.
imagination::SchedulerParams ParamsOf(const Request& request, imagination::SchedulerParams params) {
  if (request.rollouts != 0) params.rollouts = request.rollouts;
  if (request.deadline != 0.0) params.deadline = request.deadline;
  if (!request.ranking.empty()) {
    params.criteria.rule = imagination::ParseRankingRule(request.ranking);
  }
  if (request.min_success != 0.0) params.criteria.min_success = request.min_success;
  if (request.max_regret != 0.0) params.criteria.max_regret = request.max_regret;
  if (!request.early_stop) params.early_stop = false;
  imagination::CheckParams(params);
  return params;
}

void CheckLimit(const std::string& set, const std::string& limit, const char* unit, double value,
                double most) {
  if (value > 0.0 && value <= most) return;
  throw base::ConfigError(fmt::format(
      "motion set '{}': {} is {:g} {}, wanted more than 0 and at most {:g}, what the robot's "
      "base controller allows",
      set, limit, value, unit, most));
}

}  // namespace

Scene::Scene(const SceneFiles& files)
    : config_(imagination::ReadClientConfig(files.config)), files_(files) {
  Load();
}

void Scene::Load() const {
  const imagination::SetupConfig config = ConfigOf(files_, config_.scene);
  imagination::ImaginationSetup setup = imagination::LoadImaginationSetup(config);
  auto skills = std::make_shared<skills::SkillSet>(*setup.skills);
  skills->motion_sets.insert(own_sets_.begin(), own_sets_.end());
  setup.skills = std::move(skills);
  for (const std::string& file : files_.objects)
    own_names_[file] = world::FindObjectModel(file, config.objects).name;
  setup_ = std::move(setup);
}

std::string Scene::NameOf(const std::string& object) const {
  if (!IsFile(object)) return object;
  const std::lock_guard lock(*mutex_);
  const auto known = own_names_.find(object);
  if (known != own_names_.end()) return known->second;
  files_.objects.push_back(object);
  try {
    Load();
  } catch (...) {
    files_.objects.pop_back();
    throw;
  }
  return own_names_.at(object);
}

StartOfAction Scene::Named(StartOfAction start) const {
  for (std::string& object : start.on_tray) object = NameOf(object);
  std::map<std::string, std::array<double, 4>> put;
  for (const auto& [object, pose] : start.put) {
    const std::string name = NameOf(object);
    if (put.emplace(name, pose).second) continue;
    throw base::ConfigError(fmt::format("put: '{}' has two places; name it once", name));
  }
  start.put = std::move(put);
  return start;
}

std::vector<std::string> Scene::Areas() const {
  std::vector<std::string> names;
  for (const auto& [name, X_MArea] : setup_.skills->areas) {
    const auto as_written = setup_.scene->world.frame_names.find(name);
    names.push_back(as_written == setup_.scene->world.frame_names.end() ? name
                                                                        : as_written->second);
  }
  return names;
}

std::vector<std::string> Scene::Objects() const {
  std::vector<std::string> names;
  for (const auto& [instance, model] : setup_.object_models) names.push_back(instance);
  for (const auto& [name, model] : setup_.scene->world.models) {
    if (setup_.object_models.count(base::ToLower(name)) == 0) names.push_back(name);
  }
  return names;
}

std::map<std::string, std::pair<double, double>> Scene::MotionSets() const {
  std::map<std::string, std::pair<double, double>> sets;
  for (const auto& [name, set] : setup_.skills->motion_sets) {
    sets[name] = {set.max_linear_velocity, set.max_linear_acceleration};
  }
  return sets;
}

void Scene::AddMotionSet(const std::string& name, double speed, double acceleration,
                         double turn_speed, double turn_acceleration) {
  const robot::MotionSet& most = setup_.scene->robot.profile.base_controller.limits;
  CheckLimit(name, "speed", "m/s", speed, most.max_linear_velocity);
  CheckLimit(name, "acceleration", "m/s^2", acceleration, most.max_linear_acceleration);
  CheckLimit(name, "turn_speed", "rad/s", turn_speed, most.max_angular_velocity);
  CheckLimit(name, "turn_acceleration", "rad/s^2", turn_acceleration,
             most.max_angular_acceleration);
  // A copy, so that requests that are being played keep theirs.
  const std::lock_guard lock(*mutex_);
  auto skills = std::make_shared<skills::SkillSet>(*setup_.skills);
  const robot::MotionSet set{speed, turn_speed, acceleration, turn_acceleration};
  if (!skills->motion_sets.emplace(base::ToLower(name), set).second) {
    throw base::ConfigError(fmt::format(
        "motion set '{}' is there already, wanted a new name; call it otherwise", name));
  }
  own_sets_.emplace(base::ToLower(name), set);
  setup_.skills = std::move(skills);
}

base::ActionTemplate Scene::OfOwnObjects(base::ActionTemplate action) const {
  const std::lock_guard lock(*mutex_);
  for (std::vector<std::string>& alternatives : action.alternatives) {
    for (std::string& argument : alternatives) {
      const auto known = own_names_.find(argument);
      if (known != own_names_.end()) argument = known->second;
    }
  }
  return action;
}

imagination::RolloutSetup Scene::SetupOf(const StartOfAction& given, std::uint64_t seed) const {
  const StartOfAction start = Named(given);
  const std::vector<base::Atom> atoms =
      AtomsOf(start, [this](const std::string& object) { return NameOf(object); });
  const imagination::ImaginationSetup setup = [this] {
    const std::lock_guard lock(*mutex_);
    return setup_;
  }();
  return imagination::MakeRolloutSetup(
      setup, imagination::MakeStartState(setup, atoms, PutObjectsOf(start)), seed);
}

Answer Scene::Imagine(const StartOfAction& start, const base::ActionTemplate& action,
                      const Request& request, const Cancelled& cancelled) const {
  const imagination::RolloutSetup rollouts = SetupOf(start, request.seed);
  const std::vector<base::ActionCall> actions = base::Combinations(OfOwnObjects(action));
  Answer answer;
  const imagination::SchedulerParams params = ParamsOf(request, config_.scheduler);
  answer.criteria = params.criteria;
  if (request.threads < 0 || request.threads > 256) {
    throw base::ConfigError(
        fmt::format("threads is {}, wanted 1 to 256, or 0 for one per core", request.threads));
  }
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  answer.report = imagination::ImagineLocally(
      rollouts, actions, params, request.threads > 0 ? request.threads : cores, {}, cancelled);
  imagination::AddCaveats(rollouts, actions, config_.validated, &answer.report);
  return answer;
}

std::optional<imagination::RolloutRecording> Scene::Record(const StartOfAction& start,
                                                           const base::ActionCall& action,
                                                           int rollout, std::uint64_t seed,
                                                           const Cancelled& cancelled) const {
  if (rollout < 0) {
    throw base::ConfigError(fmt::format("rollout is {}, wanted 0 or more", rollout));
  }
  base::ActionTemplate choices{action.name, {}};
  for (const std::string& argument : action.arguments) choices.alternatives.push_back({argument});
  const imagination::RolloutSetup rollouts = SetupOf(start, seed);
  const base::ActionCall call =
      base::Combinations(OfOwnObjects(choices)).front();  // as `Imagine` writes it
  imagination::CheckSetup(rollouts, call);
  return imagination::RecordRollout(rollouts, call, rollout, cancelled);
}

}  // namespace hires::python
