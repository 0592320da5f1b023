#include "hires/imagination/imagination_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <optional>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/perception/recogniser_config.h"
#include "hires/robot/load_robot.h"
#include "hires/simulation/pose_error.h"
#include "hires/simulation/stuck_things.h"
#include "hires/skills/action_loader.h"
#include "hires/world/object_catalogue.h"
#include "hires/world/occupancy_grid.h"
#include "imagination/area_file.h"
#include "imagination/physics_hash.h"
#include "imagination/uncertainty_layers.h"
#include "world/content_hash.h"
#include "world/mend_object.h"

namespace hires::imagination {
namespace {

namespace fs = std::filesystem;
using base::Between;
using base::ParamReader;

navigation::DwaParams ReadDwa(ParamReader in) {
  navigation::DwaParams p;
  p.control_period = in.Get("control_period", Between(0.01, 1.0));
  p.min_linear_velocity = in.Get("min_linear_velocity", Between(0.0, 5.0));
  p.max_lateral_velocity = in.Get("max_lateral_velocity", Between(0.0, 5.0));
  p.min_angular_velocity = in.Get("min_angular_velocity", Between(0.0, 10.0));
  p.sim_time = in.Get("sim_time", Between(0.1, 10.0));
  p.sim_granularity = in.Get("sim_granularity", Between(0.001, 1.0));
  p.angular_sim_granularity = in.Get("angular_sim_granularity", Between(0.001, 1.0));
  p.path_distance_bias = in.Get("path_distance_bias", Between(0.0, 1000.0));
  p.goal_distance_bias = in.Get("goal_distance_bias", Between(0.0, 1000.0));
  p.obstacle_scale = in.Get("obstacle_scale", Between(0.0, 1000.0));
  p.stop_time_buffer = in.Get("stop_time_buffer", Between(0.0, 10.0));
  p.forward_point_distance = in.Get("forward_point_distance", Between(0.0, 5.0));
  p.scaling_speed = in.Get("scaling_speed", Between(0.0, 10.0));
  p.max_scaling_factor = in.Get("max_scaling_factor", Between(0.0, 5.0));
  p.oscillation_reset_distance = in.Get("oscillation_reset_distance", Between(0.0, 5.0));
  p.oscillation_reset_angle = in.Get("oscillation_reset_angle", Between(0.0, 3.2));
  p.xy_goal_tolerance = in.Get("xy_goal_tolerance", Between(0.001, 5.0));
  p.yaw_goal_tolerance = in.Get("yaw_goal_tolerance", Between(0.001, 3.2));
  p.stopped_linear_velocity = in.Get("stopped_linear_velocity", Between(0.0001, 1.0));
  p.stopped_angular_velocity = in.Get("stopped_angular_velocity", Between(0.0001, 1.0));
  p.vx_samples = in.Get("vx_samples", Between(1, 1000));
  p.vy_samples = in.Get("vy_samples", Between(1, 1000));
  p.vtheta_samples = in.Get("vtheta_samples", Between(1, 1000));
  return p;
}

skills::MoveBaseParams ReadDriving(ParamReader in) {
  skills::MoveBaseParams p;
  ParamReader costmap = in.Sub("costmap");
  p.costmap.inflation_radius = costmap.Get("inflation_radius", Between(0.0, 5.0));
  p.costmap.cost_scaling_factor = costmap.Get("cost_scaling_factor", Between(0.0, 1000.0));
  p.costmap.unknown_is_lethal = costmap.GetBool("unknown_is_lethal");
  ParamReader planner = in.Sub("planner");
  p.planner.neutral_cost = planner.Get("neutral_cost", Between(1.0, 252.0));
  p.planner.cost_factor = planner.Get("cost_factor", Between(0.0, 10.0));
  p.local = ReadDwa(in.Sub("local"));
  p.min_obstacle_height = in.Get("min_obstacle_height", Between(0.0, 1.0));
  p.map_resolution = in.Get("map_resolution", Between(0.01, 0.5));
  p.replanning_period = in.Get("replanning_period", Between(0.0, 60.0));
  p.progress_timeout = in.Get("progress_timeout", Between(0.1, 300.0));
  p.controller_patience = in.Get("controller_patience", Between(0.1, 300.0));
  p.oscillation_timeout = in.Get("oscillation_timeout", Between(0.1, 300.0));
  p.oscillation_distance = in.Get("oscillation_distance", Between(0.001, 10.0));
  return p;
}

skills::SeenPlaceParams ReadSeenPlace(ParamReader in) {
  skills::SeenPlaceParams p;
  p.match.reach = in.Get("reach", Between(0.5, 30.0));
  p.match.gate = in.Get("gate", Between(0.01, 1.0));
  p.match.noise = in.Get("noise", Between(0.001, 0.5));
  p.match.independent = in.Get("independent", Between(0.001, 1.0));
  p.match.least_view = in.Get("least_view", Between(0.0, 6.2));
  p.told_sd = in.Get("told_sd", Between(0.001, 1.0));
  p.told_yaw_sd = in.Get("told_yaw_sd", Between(0.001, 1.0));
  p.drift = in.Get("drift", Between(0.0, 1.0));
  p.walk = in.Get("walk", Between(0.0, 0.1));
  return p;
}

skills::LostParams ReadLost(ParamReader in) {
  skills::LostParams p;
  p.max_position_sd = in.Get("max_position_sd", Between(0.01, 100.0));
  p.patience = in.Get("patience", Between(0.0, 3600.0));
  p.turning = in.Get("turning", Between(0.0, 4.0));
  p.room = in.Get("room", Between(0.0, 10.0));
  return p;
}

skills::MoveBaseBlindParams ReadBlind(ParamReader in) {
  skills::MoveBaseBlindParams p;
  p.period = in.Get("period", Between(0.005, 1.0));
  p.max_velocity = in.Get("max_velocity", Between(0.01, 2.0));
  p.max_angular_velocity = in.Get("max_angular_velocity", Between(0.01, 4.0));
  p.deceleration = in.Get("deceleration", Between(0.01, 5.0));
  p.reaction_time = in.Get("reaction_time", Between(0.0, 1.0));
  p.xy_tolerance = in.Get("xy_tolerance", Between(0.001, 1.0));
  p.yaw_tolerance = in.Get("yaw_tolerance", Between(0.001, 1.0));
  p.stuck_timeout = in.Get("stuck_timeout", Between(0.1, 100.0));
  return p;
}

physics::PhysicsParams ReadPhysics(ParamReader in) {
  physics::PhysicsParams p;
  p.time_step = in.Get("time_step", Between(0.0001, 0.005));
  p.erp = in.Get("erp", Between(0.01, 1.0));
  p.cfm = in.Get("cfm", Between(0.0, 1.0));
  p.surface_layer = in.Get("surface_layer", Between(0.0, 0.01));
  p.max_correcting_velocity = in.Get("max_correcting_velocity", Between(0.001, 1e6));
  p.restitution_threshold = in.Get("restitution_threshold", Between(0.0, 10.0));
  return p;
}

constexpr double kWallHeight = 2.5;  // [m] of what a map has

bool AreOneKind(const world::ObjectModel& a, const world::ObjectModel& b) {
  base::Hasher one, other;
  world::AddTo(&one, a);
  world::AddTo(&other, b);
  return one.value() == other.value();
}

/// Whether a model of a world, which keeps its origin there, is that kind wherever its origin is.
bool IsThatKind(world::ObjectModel of_world, const world::ObjectModel& kind) {
  world::PutOriginAtUnderside(&of_world);
  return AreOneKind(of_world, kind);
}

/// A kind of the world's own that has the name of another one goes on under a name that is free.
/// Where its origin alone is another one, it is that kind, and what is there is moved to that
/// origin.
void KeepApart(const world::ObjectModel& other, world::World* world) {
  const auto known = world->models.find(other.name);
  const auto is_of_it = [&](const world::ObjectState& object) {
    return object.model == other.name;
  };
  const auto& objects = world->initial.objects;
  const bool is_used = std::any_of(objects.begin(), objects.end(), is_of_it);
  if (known == world->models.end() || !is_used || AreOneKind(*known->second, other)) return;
  if (IsThatKind(*known->second, other)) {
    const double lowest = world::LowestOf(*known->second);
    for (world::ObjectState& object : world->initial.objects) {
      if (is_of_it(object))
        object.X_MO.translation += object.X_MO.rotation * Eigen::Vector3d(0.0, 0.0, lowest);
    }
    return;
  }
  std::string free = other.name;
  for (int i = 2; world->FindModel(free) != nullptr; ++i)
    free = fmt::format("{}_{}", other.name, i);
  auto renamed = std::make_shared<world::ObjectModel>(*known->second);
  renamed->name = free;
  world->models[free] = std::move(renamed);
  for (world::ObjectState& object : world->initial.objects) {
    if (is_of_it(object)) object.model = free;
  }
}

/// An object of one's own must not become what others are called.
void RefuseTaken(const world::ObjectModel& model, const std::string& path,
                 const world::World& world, const std::map<std::string, std::string>& instances) {
  const auto known = world.models.find(model.name);
  const bool is_other = known != world.models.end() && !IsThatKind(*known->second, model);
  const auto instance = instances.find(base::ToLower(model.name));
  const bool is_instance = instance != instances.end() && instance->second != model.name;
  if (is_instance || is_other) {
    throw base::ConfigError(fmt::format(
        "{}: the object is called '{}', as another one is in world or catalogue; rename it", path,
        model.name));
  }
}

/// The world with every object model that a request may name.
/// @param map  whose walls are the world, if there is one.
world::World LoadWorldWithObjects(const SetupConfig& config,
                                  const std::optional<world::OccupancyGrid>& map,
                                  std::map<std::string, std::string>* object_models) {
  world::World world =
      map ? world::ExtrudeMap(*map, kWallHeight)
          : simulation::HoldWhatIsStuck(world::LoadWorldWithAreas(config.world, config.areas));
  if (map) world::AddAreas(config.areas, &world);
  const auto add = [&](const std::string& instance,
                       const std::shared_ptr<const world::ObjectModel>& model) {
    KeepApart(*model, &world);
    (*object_models)[base::ToLower(instance)] = model->name;
    world.models[model->name] = model;
  };
  for (const auto& [instance, model] : world::LoadCatalogueModels(config.objects)) {
    add(instance, model);
  }
  for (const std::string& path : config.extra_objects) {
    const auto model =
        std::make_shared<const world::ObjectModel>(world::FindObjectModel(path, config.objects));
    RefuseTaken(*model, path, world, *object_models);
    add(model->name, model);
  }
  world.hash = world.ComputeHash();
  return world;
}

/// @param hasher  what the robot sees by is added to it.
simulation::Sight LoadSight(const SetupConfig& config, base::Hasher* hasher) {
  simulation::Sight sight;
  sight.scans = config.scans;
  if (config.detector != "none") {
    sight.errors = std::make_shared<const perception::DetectorErrors>(
        perception::ReadDetectorErrors(config.detector));
    hasher->Add(perception::ToYaml(*sight.errors));
  }
  if (config.recogniser != "none") {
    const auto known = perception::ReadRecogniserConfig(config.recogniser, config.objects);
    sight.recogniser =
        std::make_shared<const perception::Recogniser>(known.catalogue, known.params);
    hasher->Add(base::ReadTextFile(config.recogniser, 1u << 20));
  }
  return sight;
}

/// How the robot errs about its place that is said to be in this world.
/// @param hasher  that is added to it.
std::shared_ptr<const simulation::Scene> WithPlace(std::shared_ptr<const simulation::Scene> scene,
                                                   const SetupConfig& config,
                                                   base::Hasher* hasher) {
  if (config.localisation == "drawn") return scene;
  if (!scene->laser_height) {
    throw base::ConfigError(fmt::format(
        "localisation: {} is for a robot with a base laser (laser_link of its profile), this one "
        "has none; wanted drawn",
        config.localisation));
  }
  const std::string hash =
      simulation::PlaceHash(config.self_localisation, scene->world, *scene->laser_height);
  hasher->Add(config.localisation + hash);
  if (config.localisation == "filter") {
    return simulation::FindingItsPlace(
        *scene, simulation::LoadSelfLocalisation(config.self_localisation), scene->world);
  }
  const simulation::PoseErrorFile file = simulation::ReadPoseError(config.localisation_error);
  if (file.hash != hash) {
    throw base::ConfigError(fmt::format(
        "{}: fitted_to is {}, wanted {}: it is of another world, laser or filter than {} and the "
        "scene have; write it anew with `hires_lab experiment localisation`, or set localisation: "
        "drawn",
        config.localisation_error, file.hash, hash, config.self_localisation));
  }
  hasher->Add(simulation::ToYaml(file));
  auto told = std::make_shared<simulation::Scene>(*scene);
  told->pose_error = std::make_shared<const simulation::PoseErrorParams>(file.params);
  return told;
}

/// With the guard late commands end in its ramp, whatever the base's controller would do.
/// @return the robot's hash: client and worker must agree about the guard, too.
std::uint64_t PutGuardBefore(bool is_there, robot::Robot* robot) {
  bool& stops = robot->profile.base_controller.stops_at_timeout;
  if (!is_there || !stops) return robot->hash();
  stops = false;
  base::Hasher hasher;
  hasher.Add(robot->hash());
  hasher.Add("base_guard");
  return hasher.value();
}

/// [m] By which the drawn place may put the robot's outline off its true place; more in one of 80
/// draws of a coordinate.
double PlaceMargin(const Uncertainty& uncertainty, const geometry::Polygon& footprint) {
  constexpr double kScore = 2.5;  // standard deviations
  const auto largest = [&](const char* name) {
    const auto found = uncertainty.quantities.find(name);
    if (found == uncertainty.quantities.end()) return 0.0;
    return std::max(std::abs(found->second.AtScore(kScore)),
                    std::abs(found->second.AtScore(-kScore)));
  };
  return std::hypot(std::max(largest("localisation_x"), largest("localisation_y")),
                    geometry::CircumscribedRadius(footprint) * largest("localisation_yaw"));
}

/// Whoever has no base laser drives by the map alone.
SetupConfig ForRobot(SetupConfig config, const robot::Robot& robot) {
  if (!config.driving.obstacle_layer || !robot.profile.laser_link.empty()) return config;
  base::Log(
      base::LogLevel::kInfo,
      fmt::format("{}: no base laser (laser_link), so it drives by the map alone", config.robot));
  SetObstacleLayer("none", &config);
  return config;
}

}  // namespace

std::string ResolvePath(const std::string& path, const std::string& config_path) {
  if (path.empty() || path == "none" || fs::path(path).is_absolute()) return path;
  return (fs::path(config_path).parent_path() / path).lexically_normal().string();
}

void OverridePaths(const std::optional<std::string>& world, const std::optional<std::string>& robot,
                   const std::optional<std::string>& objects,
                   const std::optional<std::string>& uncertainty, SetupConfig* config) {
  const auto override_one = [](const std::optional<std::string>& given, std::string* path) {
    if (given && !given->empty()) *path = *given;
  };
  override_one(world, &config->world);
  override_one(robot, &config->robot);
  override_one(objects, &config->objects);
  const bool is_none = uncertainty && *uncertainty == "none";
  if (is_none) config->uncertainty_over.clear();
  override_one(uncertainty, is_none ? &config->uncertainty : &config->uncertainty_over);
}

Uncertainty LoadUncertaintyOf(const SetupConfig& config) {
  const Uncertainty uncertainty =
      config.uncertainty == "none" ? NoUncertainty() : LoadUncertainty(config.uncertainty);
  if (config.uncertainty_over.empty()) return uncertainty;
  return LaidOver(uncertainty, LoadUncertainty(config.uncertainty_over));
}

SetupConfig ReadSetupConfig(const std::string& path) {
  ParamReader in = ParamReader::FromFile(path);
  SetupConfig config;
  config.world = ResolvePath(in.GetString("world"), path);
  config.robot = ResolvePath(in.GetString("robot"), path);
  config.objects = ResolvePath(in.GetString("objects"), path);
  config.uncertainty = ResolvePath(in.GetString("uncertainty"), path);
  config.detector = ResolvePath(in.GetString("detector"), path);
  config.recogniser = ResolvePath(in.GetString("recogniser"), path);
  config.localisation = in.Get("localisation", base::OneOf({"drawn", "fitted", "filter"}));
  config.self_localisation = ResolvePath(in.GetString("self_localisation"), path);
  config.localisation_error = ResolvePath(in.GetString("localisation_error"), path);
  const std::string layer = ResolvePath(in.GetString("obstacle_layer"), path);
  config.has_base_guard = in.GetBool("base_guard");
  config.driving = ReadDriving(in.Sub("driving"));
  config.blind = ReadBlind(in.Sub("blind_driving"));
  config.driving.lost = config.blind.lost = ReadLost(in.Sub("lost"));
  config.manipulation = skills::ReadManipulationParams(in.Sub("manipulation"));
  config.sensing = sensing::ReadSensingParams(in.Sub("sensing"));
  config.physics = ReadPhysics(in.Sub("physics"));
  config.rollout = ReadRolloutParams(in.Sub("rollout"));
  config.standing = world::ReadStandingCriterion(in.Sub("standing"));
  config.classify = translation::ReadClassifyParams(in.Sub("classify"));
  if (config.standing.hold_time > config.rollout.aftermath) {
    in.Sub("standing")
        .Fail("hold_time",
              fmt::format("wanted no more than rollout.aftermath, {:g} s: a fall at the end "
                          "of a rollout would not be seen",
                          config.rollout.aftermath));
  }
  in.RejectUnknownKeys();
  base::Hasher hasher;
  for (const char* section : {"driving", "blind_driving", "manipulation", "sensing"}) {
    hasher.Add(in.Sub(section).Canonical());
  }
  // Who is told its place as drawn is never lost.
  if (config.localisation != "drawn") hasher.Add(in.Sub("lost").Canonical());
  config.params_hash = hasher.value();
  SetObstacleLayer(layer, &config);
  return config;
}

void SetObstacleLayer(const std::string& path, SetupConfig* config) {
  config->driving.obstacle_layer.reset();
  config->driving.seen_place.reset();
  config->scans.reset();
  config->layer_hash = 0;
  if (path == "none") return;
  ParamReader in = ParamReader::FromFile(path);
  navigation::ObstacleLayerParams& layer = config->driving.obstacle_layer.emplace();
  layer.obstacle_range = in.Get("obstacle_range", Between(0.1, 10.0));
  layer.raytrace_range = in.Get("raytrace_range", Between(0.1, 10.0));
  layer.keep = in.Get("keep", Between(0.0, 3600.0));
  if (in.Has("seen_place")) config->driving.seen_place = ReadSeenPlace(in.Sub("seen_place"));
  ParamReader laser = in.Sub("laser");
  simulation::ScanParams& scans = config->scans.emplace();
  scans.laser = simulation::ReadBeams(&laser);
  scans.period = laser.Get("period", Between(0.05, 10.0));
  in.RejectUnknownKeys();
  base::Hasher hasher;
  hasher.Add(in.Canonical());
  config->layer_hash = hasher.value();
}

ImaginationSetup LoadImaginationSetup(const SetupConfig& scene) {
  ImaginationSetup setup;
  robot::Robot robot = robot::LoadAnyRobot(scene.robot);
  SetupConfig config = ForRobot(scene, robot);
  setup.uncertainty = std::make_shared<const Uncertainty>(LoadUncertaintyOf(config));
  // Where the place is drawn, and nothing that is seen now corrects what the map has.
  if (!config.driving.obstacle_layer && config.localisation == "drawn")
    config.driving.place_margin = PlaceMargin(*setup.uncertainty, robot.profile.footprint);
  std::optional<world::OccupancyGrid> map;
  if (!config.map.empty()) map = world::LoadMap(config.map);
  setup.catalogue = config.objects;
  world::World world = LoadWorldWithObjects(config, map, &setup.object_models);
  setup.robot_hash = PutGuardBefore(config.has_base_guard, &robot);
  skills::SkillSet skills =
      skills::MakeSkillSet(world, robot, config.driving, config.blind, config.manipulation,
                           config.standing, skills::LoadActionSet(config.action_libraries));
  if (map) {  // it also knows what is unknown
    skills.driving = std::make_shared<const skills::DrivingContext>(
        skills::MakeDrivingContext(*map, robot, config.driving));
  }
  setup.skills = std::make_shared<const skills::SkillSet>(std::move(skills));
  setup.actions_hash = setup.skills->actions->hash();
  base::Hasher hasher;
  hasher.Add(world.hash);
  hasher.Add(config.params_hash);
  hasher.Add(config.layer_hash);
  if (config.driving.place_margin > 0.0) hasher.Add(config.driving.place_margin);
  setup.physics_hash = PhysicsHash(config.physics, config.rollout, config.standing);
  setup.scene = simulation::MakeScene(std::move(world), std::move(robot), config.sensing.memory,
                                      LoadSight(config, &hasher));
  setup.scene = WithPlace(std::move(setup.scene), config, &hasher);
  setup.world_hash = hasher.value();
  setup.sensing = config.sensing;
  // The scene keeps them; the translator only looks.
  setup.translator.object_models = setup.object_models;
  setup.translator.world = {setup.scene, &setup.scene->world};
  setup.translator.robot = {setup.scene, &setup.scene->robot};
  setup.translator.areas = translation::AreasOf(setup.scene->world, setup.scene->robot);
  setup.rollout = config.rollout;
  setup.physics = config.physics;
  setup.standing = config.standing;
  setup.translator.standing = config.standing;
  setup.translator.classify = config.classify;
  setup.translator.slot_distance = config.manipulation.place.slot_distance;
  return setup;
}

std::string ImaginationSetup::ModelOf(const std::string& instance_or_model) const {
  const auto instance = object_models.find(base::ToLower(instance_or_model));
  if (instance != object_models.end()) return instance->second;
  const std::string kin = translator.FindModel(instance_or_model);
  if (!kin.empty()) return kin;
  if (scene->world.FindModel(instance_or_model)) return instance_or_model;  // it says its box
  if (instance_or_model.find_first_of("./") != std::string::npos) {
    throw base::ConfigError(
        fmt::format("object '{}' is a file: load it with the scene (SetupConfig::extra_objects), "
                    "and call it by "
                    "its model's name",
                    instance_or_model));
  }
  std::vector<std::string> known;
  for (const auto& [name, model] : object_models) known.push_back(name);
  for (const auto& [name, model] : scene->world.models) {
    if (base::ToLower(name) == base::ToLower(instance_or_model)) return name;
    known.push_back(name);
  }
  throw base::ConfigError(
      fmt::format("{}{}{}", catalogue, catalogue.empty() ? "" : ": ",
                  base::UnknownName("object", instance_or_model, known, "hires list objects")));
}

RolloutSetup MakeRolloutSetup(const ImaginationSetup& setup, const StartState& start,
                              std::uint64_t seed) {
  return {setup.scene, setup.skills,  setup.uncertainty, start.world,   start.robot,
          seed,        setup.rollout, setup.physics,     setup.standing};
}

}  // namespace hires::imagination
