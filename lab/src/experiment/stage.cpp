#include "lab/src/experiment/stage.h"

#include <algorithm>
#include <string>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/text.h"
#include "hires/simulation/pose_error.h"
#include "hires/simulation/self_localisation.h"
#include "hires/world/occupancy_grid.h"

namespace hires::lab {
namespace {

using imagination::ImaginationSetup;
using imagination::Uncertainty;

void ChangeUncertainty(const std::string& changes, const std::string& where,
                       ImaginationSetup* setup) {
  Uncertainty changed = *setup->uncertainty;
  const Uncertainty more = imagination::ParseUncertainty(changes, where);
  for (const auto& [name, distribution] : more.quantities) {
    changed.quantities[name] = distribution;
  }
  setup->uncertainty = std::make_shared<const Uncertainty>(std::move(changed));
}

/// Walls where the map is occupied, and no furniture; the robot drives by the same map.
void ReplaceByMap(const ExperimentConfig& config, const skills::MoveBaseParams& driving,
                  world::World* world, skills::SkillSet* skills, const robot::Robot& robot) {
  const world::OccupancyGrid map = world::LoadMap(config.map);
  world::World walls = world::ExtrudeMap(map, config.wall_height);
  world->statics = std::move(walls.statics);
  skills->driving = std::make_shared<const skills::DrivingContext>(
      skills::MakeDrivingContext(map, robot, driving));
}

void AddGoals(const std::vector<Goal>& goals, world::World* world, skills::SkillSet* skills) {
  for (const Goal& goal : goals) {
    const std::string key = base::ToLower(goal.name);
    world->frames[key] = geometry::Lift(goal.X_MG);
    world->frame_names[key] = goal.name;
    skills->areas[key] = goal.X_MG;
  }
}

/// The world as it was when the map was made.
world::World AsMapped(world::World world, const ExperimentConfig& config) {
  std::vector<std::string> names;
  for (const world::StaticBody& body : world.statics) names.push_back(body.name);
  for (const OldPlace& moved : config.moved) {
    const auto body = std::find_if(world.statics.begin(), world.statics.end(),
                                   [&](const auto& other) { return other.name == moved.body; });
    if (body == world.statics.end())
      throw base::ConfigError(config.name +
                              ": moved: " + base::UnknownName("static body", moved.body, names));
    body->X_MB.translation += Eigen::Vector3d(moved.by.x, moved.by.y, 0.0);
    body->X_MB.rotation = geometry::RotationFromRpy(0.0, 0.0, moved.by.yaw) * body->X_MB.rotation;
  }
  world.hash = world.ComputeHash();
  return world;
}

/// How the robot finds its place, and what befalls it.
simulation::SelfLocalisationParams Befallen(const ExperimentConfig& config) {
  auto params = simulation::LoadSelfLocalisation(config.self_localisation);
  if (config.is_carried)
    for (const Goal& goal : config.goals) params.mistaken_for.push_back(goal.X_MG);
  params.wet = config.wet;
  return params;
}

/// @param place  of what finds the robot's place; "": it is told.
std::uint64_t HashOf(const ImaginationSetup& setup, const std::string& place) {
  base::Hasher hasher;
  hasher.Add(place);
  hasher.Add(setup.world_hash);
  hasher.Add(setup.scene->world.hash);  // differs from that of the scene file where there is a map
  hasher.Add(setup.robot_hash);
  hasher.Add(setup.physics_hash);
  imagination::AddTo(&hasher, setup.uncertainty->quantities);
  return hasher.value();
}

}  // namespace

Stage MakeStage(const ExperimentConfig& config) {
  imagination::SetupConfig scene = imagination::ReadSetupConfig(config.scene);
  if (config.world != "scene") scene.world = config.world;
  if (config.uncertainty != "scene")
    imagination::OverridePaths({}, {}, {}, config.uncertainty, &scene);
  if (config.obstacle_layer != "scene")
    imagination::SetObstacleLayer(config.obstacle_layer, &scene);
  Stage stage;
  ImaginationSetup& setup = stage.setup;
  setup = imagination::LoadImaginationSetup(scene);
  ChangeUncertainty(config.uncertainty_changes, config.name + ": uncertainty_changes", &setup);
  world::World world = setup.scene->world;
  skills::SkillSet skills = *setup.skills;
  const skills::MoveBaseParams driving = skills.driving->params;  // as this robot has it
  if (config.map != "none") {
    ReplaceByMap(config, driving, &world, &skills, setup.scene->robot);
  }
  std::optional<world::World> mapped;
  if (!config.moved.empty()) {
    mapped = AsMapped(world, config);
    skills.driving = std::make_shared<const skills::DrivingContext>(
        skills::MakeDrivingContext(*mapped, setup.scene->robot, driving));
  }
  AddGoals(config.goals, &world, &skills);
  world.hash = world.ComputeHash();
  auto with_goals = std::make_shared<simulation::Scene>(*simulation::MakeScene(
      std::move(world), setup.scene->robot, setup.scene->memory, setup.scene->sight));
  with_goals->self_localisation = setup.scene->self_localisation;
  with_goals->pose_error = setup.scene->pose_error;
  setup.scene = std::move(with_goals);
  std::string place;
  if (config.self_localisation != "none") {
    const world::World& known = mapped ? *mapped : setup.scene->world;
    auto finding = simulation::FindingItsPlace(*setup.scene, Befallen(config), known);
    place = simulation::PlaceHash(config.self_localisation, known, *finding->laser_height);
    setup.scene = std::move(finding);
  }
  setup.skills = std::make_shared<const skills::SkillSet>(std::move(skills));
  stage.objects = config.objects;
  stage.xy_tolerance = driving.local.xy_goal_tolerance;
  stage.yaw_tolerance = driving.local.yaw_goal_tolerance;
  stage.params_hash = HashOf(setup, place);
  return stage;
}

imagination::RolloutSetup SetupAt(const Stage& stage, const std::string& goal, std::uint64_t seed) {
  return imagination::MakeRolloutSetup(
      stage.setup, imagination::MakeStartState(stage.setup, goal, stage.objects), seed);
}

base::ActionCall DriveTo(const std::string& goal, const std::string& motion_set) {
  return {"move_base_param", {goal, motion_set}};
}

Uncertainty Without(Uncertainty uncertainty, const std::set<std::string>& names) {
  for (const std::string& name : names) uncertainty.quantities.erase(name);
  return uncertainty;
}

Uncertainty OneTruth(Uncertainty uncertainty, const base::Rng& rng) {
  for (auto& [name, distribution] : uncertainty.quantities) {
    base::Hasher stream;  // one for each quantity: common random numbers
    stream.Add(name);
    base::Rng own = rng.Fork(stream.value());
    distribution = {imagination::Distribution::Kind::kFixed, distribution.Sample(&own), 0.0};
  }
  return uncertainty;
}

}  // namespace hires::lab
