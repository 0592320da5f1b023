#include "lab/src/series/scenario_variant.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "lab/src/series/belongings.h"
#include "lab/src/series/world_file.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "sim_robot/scenario.h"
#include "hires/geometry/angles.h"

namespace hires::lab {
namespace {

using base::ConfigError;
using base::ToLower;
using knowledge::Fluent;
using knowledge::KnowledgeFile;
using knowledge::PoseModification;
using knowledge::PoseMove;
using nlohmann::ordered_json;

constexpr double kSamePlace = 0.01;  // [m] and [rad] between knowledge and world
constexpr double kBelow = -0.001;    // [m]

using Moves = std::map<std::string, std::vector<PoseMove>>;

/// The poses that the series itself names, with where it does.
std::map<std::string, std::string> NamedPoses(const std::vector<PoseModification>& modifications) {
  std::map<std::string, std::string> named;  // as spelled -> where
  for (const PoseModification& each : modifications) {
    named.emplace(each.instance, each.where + ", Instance");
    for (const auto& attached : each.attachments)
      named.emplace(attached, each.where + ", Attachments");
  }
  return named;
}

/// What furniture takes along is attached to it as if the file had said so.
std::vector<PoseModification> WithBelongings(std::vector<PoseModification> modifications,
                                             const Belongings& known) {
  for (PoseModification& each : modifications) {
    std::vector<std::string> carried = known.PosesWith(each.instance);
    for (const std::string& attached : each.attachments) {
      const std::vector<std::string> more = known.PosesWith(attached);
      carried.insert(carried.end(), more.begin(), more.end());
    }
    each.attachments.insert(each.attachments.end(), carried.begin(), carried.end());
  }
  return modifications;
}

/// One run's world and knowledge, while things are moved in them.
class Variant {
 public:
  Variant(const ScenarioSeries& series, const VariantOrder& order)
      : series_(series),
        order_(order),
        scenario_(sim_robot::ReadScenario(order.scenario)),
        world_(order.world) {
    if (!order.task.empty()) scenario_.task = order.task;
    for (const std::string& path : scenario_.knowledge) {
      files_.push_back(knowledge::LoadKnowledge(path));
      fluents_.insert(fluents_.end(), files_.back().fluents.begin(), files_.back().fluents.end());
    }
  }

  void Move(const std::vector<int>& choices) {
    const Belongings known(fluents_);
    for (const auto& [pose, where] : NamedPoses(series_.modifications)) Require(pose, where, known);
    const Moves moves = knowledge::MovePoses(WithBelongings(series_.modifications, known),
                                             ByGroup(series_, choices), &fluents_);
    MoveHidden(moves, known);
    for (const auto& [pose, pose_moves] : moves) MoveOwners(pose, pose_moves, known);
    RequireFloor();
  }

  VariantFiles Write() const {
    VariantFiles files;
    files.world = world_.WriteTo(order_.folder);
    files.knowledge = WriteKnowledgeFiles();
    files.scenario = order_.folder + "/" + scenario_.name + ".yaml";
    base::ReplaceTextFile(files.scenario, ScenarioText(files.knowledge));
    return files;
  }

 private:
  sim_robot::ScenarioObject* FindObject(const std::string& name) {
    const auto found =
        std::find_if(scenario_.objects.begin(), scenario_.objects.end(),
                     [&](const sim_robot::ScenarioObject& object) { return object.name == ToLower(name); });
    return found == scenario_.objects.end() ? nullptr : &*found;
  }

  /// The pose is known, and so is whose it is in the world.
  void Require(const std::string& pose, const std::string& where, const Belongings& known) {
    const std::string prefix = "pose";
    if (!known.Has(pose)) {
      const bool has_prefix = ToLower(pose).rfind(prefix, 0) == 0;
      const std::string thing = has_prefix ? ToLower(pose.substr(prefix.size())) : ToLower(pose);
      const bool is_there = world_.Has(thing) || FindObject(thing) != nullptr;
      throw ConfigError(fmt::format(
          "{}: '{}' is in no knowledge file of {}{}", where, pose, order_.scenario,
          is_there
              ? fmt::format(": {} is in the world alone; tell the robot of it, or leave it where "
                            "it stands",
                            thing)
              : " and in no world either; is it spelt as there?"));
    }
    const auto owners = known.OwnersOf(pose);
    const bool is_there = std::any_of(owners.begin(), owners.end(), [&](const auto& owner) {
      return owner.second == "Robot" || world_.Has(ToLower(owner.first)) ||
             FindObject(owner.first) != nullptr;
    });
    if (is_there) return;
    throw ConfigError(
        fmt::format("{}: '{}' is in the knowledge alone: {} is neither a model or frame of {} nor "
                    "an object of {}; "
                    "put it there, or leave it out",
                    where, pose,
                    owners.empty() ? std::string("nothing has this pose, and its owner")
                                   : owners.begin()->first,
                    order_.world, order_.scenario));
  }

  void MoveOwners(const std::string& pose, const std::vector<PoseMove>& moves,
                  const Belongings& known) {
    for (const auto& [owner, concept_name] : known.OwnersOf(pose)) {
      const std::string name = ToLower(owner);
      if (concept_name == "Robot") scenario_.X_MB = Moved(scenario_.X_MB, moves);
      if (sim_robot::ScenarioObject* object = FindObject(name)) object->X_MO = Moved(object->X_MO, moves);
      if (!world_.Has(name)) continue;
      RequireSamePlace(pose, name, known);
      world_.Move(name, moves);
      if (!world_.IsFrame(name)) bodies_.push_back(name);
    }
  }

  /// What nobody told the robot of stands on furniture that goes away below it.
  void MoveHidden(const Moves& moves, const Belongings& known) {
    for (sim_robot::ScenarioObject& object : scenario_.objects) {
      if (known.Has(object.name)) continue;
      for (const auto& [pose, pose_moves] : moves) {
        if (!known.IsOn(pose, object.X_MO.translation)) continue;
        object.X_MO = Moved(object.X_MO, pose_moves);
        break;
      }
    }
  }

  void RequireSamePlace(const std::string& pose, const std::string& name,
                        const Belongings& known) const {
    const geometry::Pose3 a = known.PoseOf(pose), b = world_.PoseOf(name);
    const double apart = (a.translation - b.translation).norm();
    const double turned = a.rotation.angularDistance(b.rotation);
    if (apart <= kSamePlace && turned <= kSamePlace) return;
    throw ConfigError(
        fmt::format("{}: {} stands {:.3f} m and {:.3f} rad from where the knowledge of {} has it "
                    "({}); correct one "
                    "of them before both are moved",
                    order_.world, name, apart, turned, order_.scenario, pose));
  }

  void RequireFloor() const {
    for (const std::string& name : bodies_) {
      const double z = world_.PoseOf(name).translation.z();
      if (z >= kBelow) continue;
      throw ConfigError(fmt::format(
          "{}: hasZ puts {} at z {:g} m, below the floor; poses are of the underside here, in the "
          "original's files of the middle of a box: say `ZOrigin: {:g}` in a !Scenario document",
          series_.path, name, z, z));
    }
  }

  std::vector<std::string> WriteKnowledgeFiles() const {
    std::vector<std::string> paths;
    std::size_t begin = 0;
    for (const KnowledgeFile& original : files_) {
      KnowledgeFile file = original;
      const auto first = fluents_.begin() + static_cast<std::ptrdiff_t>(begin);
      begin += file.fluents.size();
      file.fluents.assign(first, first + static_cast<std::ptrdiff_t>(file.fluents.size()));
      paths.push_back(fmt::format("{}/knowledge_{}.yaml", order_.folder, paths.size() + 1));
      base::ReplaceTextFile(paths.back(), knowledge::WriteKnowledge(file));
    }
    return paths;
  }

  /// JSON, which is YAML, too.
  std::string ScenarioText(const std::vector<std::string>& knowledge) const {
    ordered_json json{{"task", scenario_.task}, {"knowledge", ordered_json::array()}};
    for (const std::string& path : knowledge) {
      json["knowledge"].push_back(std::filesystem::path(path).filename().string());
    }
    const geometry::Pose2& X_MB = scenario_.X_MB;
    json["robot"]["pose"] = {X_MB.x, X_MB.y, geometry::WrapToPi(X_MB.yaw)};
    if (!scenario_.torso.empty()) json["robot"]["torso"] = scenario_.torso;
    if (!scenario_.arms.empty()) json["robot"]["arms"] = scenario_.arms;
    json["objects"] = json["hidden"] = ordered_json::array();
    for (const sim_robot::ScenarioObject& object : scenario_.objects) {
      json[object.is_told ? "objects" : "hidden"].push_back(ObjectJson(object));
    }
    return json.dump(2) + '\n';
  }

  static ordered_json ObjectJson(const sim_robot::ScenarioObject& object) {
    const Eigen::Vector3d& p = object.X_MO.translation;
    ordered_json json{{"name", object.name},
                      {"pose", {p.x(), p.y(), p.z(), geometry::YawOf(object.X_MO.rotation)}}};
    if (!object.model.empty()) json["model"] = object.model;
    if (object.temperature) json["temperature"] = *object.temperature;
    return json;
  }

  const ScenarioSeries& series_;
  const VariantOrder& order_;
  sim_robot::Scenario scenario_;
  WorldFile world_;
  std::vector<KnowledgeFile> files_;
  std::vector<Fluent> fluents_;      // of all files, one behind the other
  std::vector<std::string> bodies_;  // of the world that were moved
};

}  // namespace

VariantFiles WriteVariant(const ScenarioSeries& series, const std::vector<int>& choices,
                          const VariantOrder& order) {
  Variant variant(series, order);
  variant.Move(choices);
  return variant.Write();
}

}  // namespace hires::lab
