#include "cli/verbs/list/list_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/exit_code.h"
#include "cli/list_rows.h"
#include "cli/outputs.h"
#include "cli/verbs/imagine/imagine_start.h"
#include "hires/base/error.h"
#include "hires/base/param_reader.h"
#include "hires/base/text.h"
#include "hires/imagination/client_config.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/imagination/uncertainty.h"
#include "hires/robot/load_robot.h"
#include "hires/skills/action_loader.h"
#include "hires/translation/areas.h"
#include "hires/world/object_catalogue.h"
#include "hires/world/occupancy_grid.h"
#include "imagination/area_file.h"
#include "sim_robot/scenario.h"

namespace hires::cli {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

using Rows = ListRows;

/// The files that are listed.
struct Sources {
  imagination::SetupConfig setup;
  std::string package_folder;
};

double Rounded(double value) { return std::round(value * 1e4) / 1e4; }

std::string KindOf(translation::AreaKind kind) {
  switch (kind) {
    case translation::AreaKind::kStanding:
      return "standing";
    case translation::AreaKind::kRoom:
      return "room";
    case translation::AreaKind::kSeat:
      return "seat";
    case translation::AreaKind::kPlacing:
      return "placing";
    case translation::AreaKind::kTray:
      return "tray";
  }
  return "";
}

/// Lower case -> as a file spells it.
using Spelling = std::map<std::string, std::string>;

void Note(const base::ParamReader& in, Spelling* spelling) {
  for (const std::string& key : in.Keys()) (*spelling)[base::ToLower(key)] = key;
}

/// Names in a robot's profile; lookups ignore case, people type what they read.
Spelling SpellingOf(const std::string& robot) {
  Spelling spelling;
  if (!robot::IsProfile(robot)) return spelling;
  base::ParamReader in = base::ParamReader::FromFile(robot);
  if (in.Has("motion_sets")) Note(in.Sub("motion_sets"), &spelling);
  if (!in.Has("upper_body")) return spelling;
  base::ParamReader body = in.Sub("upper_body");
  base::ParamReader arms = body.Sub("arms");
  Note(arms, &spelling);
  for (const std::string& arm : arms.Keys()) Note(arms.Sub(arm).Sub("postures"), &spelling);
  Note(body.Sub("torso").Sub("postures"), &spelling);
  return spelling;
}

/// @param name  lower case
std::string Spelled(const std::string& name, const Spelling& spelling) {
  const auto found = spelling.find(name);
  return found == spelling.end() ? name : found->second;
}

/// What the map shows at an area.
std::string PlaceOn(const world::OccupancyGrid& map, const Eigen::Vector2d& p) {
  const Eigen::Vector2d cell = (p - map.origin) / map.resolution;
  const bool is_inside = cell.minCoeff() >= 0.0 && cell.x() < map.width && cell.y() < map.height;
  if (!is_inside) return "outside";
  switch (map.at(static_cast<int>(cell.x()), static_cast<int>(cell.y()))) {
    case world::Cell::kFree:
      return "free";
    case world::Cell::kOccupied:
      return "occupied";
    default:
      return "unknown";
  }
}

ordered_json AreaRow(const std::string& name, const std::string& kind, const std::string& frame,
                     const Eigen::Vector3d& p, double yaw) {
  return {{"area", name},        {"for", kind},         {"frame", frame},     {"x", Rounded(p.x())},
          {"y", Rounded(p.y())}, {"z", Rounded(p.z())}, {"yaw", Rounded(yaw)}};
}

/// What the map shows there, and its own corners.
void AddMapColumns(const world::OccupancyGrid& map, Rows* rows) {
  for (ordered_json& row : *rows) {
    const Eigen::Vector2d p(row["x"].get<double>(), row["y"].get<double>());
    row["on the map"] = row["frame"] == "map" ? PlaceOn(map, p) : "";
  }
  const Eigen::Vector2d upper =
      map.origin + map.resolution * Eigen::Vector2d(map.width, map.height);
  const auto add_corner = [&](const std::string& name, const Eigen::Vector2d& p) {
    rows->push_back(AreaRow(name, "extent", "map", {p.x(), p.y(), 0.0}, 0.0));
    rows->back()["on the map"] = "";
  };
  add_corner("(lower left corner)", map.origin);
  add_corner("(upper right corner)", upper);
}

Rows Areas(const Sources& sources) {
  std::optional<world::OccupancyGrid> map;
  if (!sources.setup.map.empty()) map = world::LoadMap(sources.setup.map);
  world::World world =
      map ? world::World() : world::LoadWorldWithAreas(sources.setup.world, sources.setup.areas);
  if (map) world::AddAreas(sources.setup.areas, &world);
  const robot::Robot robot = robot::LoadAnyRobot(sources.setup.robot);
  Spelling spelling{world.frame_names.begin(), world.frame_names.end()};
  spelling.emplace(translation::kTrayArea, "trayArea1");  // as the ontology's knowledge spells it
  Rows rows;
  for (const translation::Area& area : translation::AreasOf(world, robot).all) {
    if (area.name == translation::kFloorArea && world.frames.count(area.name) == 0) continue;
    rows.push_back(AreaRow(Spelled(area.name, spelling), KindOf(area.kind),
                           area.link.empty() ? "map" : area.link, area.X_FA.translation,
                           geometry::YawOf(area.X_FA.rotation)));
  }
  if (map) AddMapColumns(*map, &rows);
  return rows;
}

Eigen::Vector3d SizeOf(const world::ObjectModel& model) {
  geometry::Aabb box;
  for (const geometry::Collision& collision : model.collisions) {
    box.Include(geometry::BoundsOf(collision.shape, collision.X_BS));
  }
  return box.upper - box.lower;
}

ordered_json ObjectRow(const std::string& instance, const world::ObjectModel& model,
                       const std::string& from) {
  const Eigen::Vector3d size = SizeOf(model);
  return {{"object", instance},
          {"model", model.name},
          {"mass", Rounded(model.mass_properties.mass)},
          {"depth", Rounded(size.x())},
          {"width", Rounded(size.y())},
          {"height", Rounded(size.z())},
          {"from", from}};
}

Rows Objects(const Sources& sources) {
  Rows rows;
  for (const auto& [instance, model] : world::LoadCatalogueModels(sources.setup.objects)) {
    rows.push_back(ObjectRow(instance, *model, "catalogue"));
  }
  if (!sources.setup.map.empty()) return rows;  // a map has walls alone
  const world::World world = world::LoadWorld(sources.setup.world);
  for (const world::ObjectState& object : world.initial.objects) {
    rows.push_back(ObjectRow(object.name, *world.ModelOf(object), "world"));
  }
  return rows;
}

/// "object", or "from (area)" where the name does not say the kind.
std::string Described(const actions::Parameter& parameter) {
  std::string kind = actions::ToString(parameter.kind);
  std::replace(kind.begin(), kind.end(), ' ', '_');
  return parameter.name == kind ? kind : fmt::format("{} ({})", parameter.name, kind);
}

Rows Actions(const Sources& sources) {
  Rows rows;
  const auto set = skills::LoadActionSet(sources.setup.action_libraries);
  for (const auto& [name, spec] : set->catalogue().specs()) {
    std::vector<std::string> arguments, failures;
    for (const actions::Parameter& parameter : spec.parameters) {
      arguments.push_back(Described(parameter));
    }
    for (const base::FailureCode code : spec.failures) failures.push_back(base::ToString(code));
    rows.push_back({{"action", name},
                    {"arguments", arguments},
                    {"moves", spec.detail == actions::Detail::kBase ? "base" : "upper body"},
                    {"may fail by", failures}});
  }
  return rows;
}

Rows MotionSets(const Sources& sources) {
  const robot::RobotProfile profile = robot::LoadAnyRobot(sources.setup.robot).profile;
  const Spelling spelling = SpellingOf(sources.setup.robot);
  Rows rows;
  for (const auto& [name, set] : profile.motion_sets) {
    rows.push_back({{"motion set", Spelled(name, spelling)},
                    {"default", name == profile.default_motion_set},
                    {"m/s", set.max_linear_velocity},
                    {"m/s^2", set.max_linear_acceleration},
                    {"rad/s", set.max_angular_velocity},
                    {"rad/s^2", set.max_angular_acceleration}});
  }
  return rows;
}

Rows Postures(const Sources& sources) {
  const robot::RobotProfile profile = robot::LoadAnyRobot(sources.setup.robot).profile;
  Rows rows;
  if (!profile.upper_body) return rows;
  const Spelling spelling = SpellingOf(sources.setup.robot);
  for (const auto& [name, height] : profile.upper_body->torso_postures) {
    rows.push_back({{"posture", Spelled(name, spelling)}, {"of", "torso1"}});
  }
  for (const auto& [arm, description] : profile.upper_body->arms) {
    for (const auto& [name, variants] : description.postures) {
      rows.push_back({{"posture", Spelled(name, spelling)}, {"of", Spelled(arm, spelling)}});
    }
  }
  return rows;
}

/// Files of the package with that ending, by name.
std::vector<fs::path> FilesIn(const Sources& sources, const std::string& folder,
                              const std::string& ending) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(sources.package_folder + "/" + folder)) {
    if (entry.path().extension() == ending) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

Rows Robots(const Sources& sources) {
  Rows rows;
  for (const fs::path& file : FilesIn(sources, "config/robots", ".yaml")) {
    if (!base::ParamReader::FromFile(file).Has("urdf")) continue;  // names of topics
    const robot::RobotProfile profile = robot::LoadRobot(file).profile;
    const Spelling spelling = SpellingOf(file.string());
    std::vector<std::string> arms, motion_sets;
    if (profile.upper_body) {
      for (const auto& [arm, description] : profile.upper_body->arms)
        arms.push_back(Spelled(arm, spelling));
    }
    for (const auto& [name, set] : profile.motion_sets)
      motion_sets.push_back(Spelled(name, spelling));
    rows.push_back({{"robot", file.string()},
                    {"tray", profile.tray_link},
                    {"arms", arms},
                    {"motion sets", motion_sets}});
  }
  return rows;
}

Rows Worlds(const Sources& sources) {
  Rows rows;
  for (const fs::path& file : FilesIn(sources, "worlds", ".world")) {
    const world::World world = world::LoadWorld(file);
    rows.push_back({{"world", file.string()},
                    {"areas", world.frames.size()},
                    {"fixed bodies", world.statics.size()},
                    {"loose objects", world.initial.objects.size()}});
  }
  return rows;
}

Rows Scenarios(const Sources& sources) {
  Rows rows;
  for (const fs::path& file : FilesIn(sources, "config/scenarios", ".yaml")) {
    const sim_robot::Scenario scenario = sim_robot::ReadScenario(file);
    rows.push_back({{"scenario", scenario.name},
                    {"task", scenario.task},
                    {"objects", scenario.objects.size()},
                    {"file", file.string()}});
  }
  return rows;
}

Rows Truths(const Sources& sources) {
  Rows rows;
  for (const fs::path& file : FilesIn(sources, "config/truths", ".yaml")) {
    rows.push_back({{"truth", file.stem().string()}, {"file", file.string()}});
  }
  return rows;
}

/// What a file for --uncertainty may name, and how the scene has it.
Rows Quantities(const Sources& sources) {
  const imagination::Uncertainty configured = imagination::LoadUncertaintyOf(sources.setup);
  Rows rows;
  for (const imagination::QuantityInfo& quantity : imagination::KnownQuantities()) {
    const auto found = configured.quantities.find(quantity.name);
    const bool is_certain = found == configured.quantities.end();
    rows.push_back({{"quantity", quantity.name},
                    {"unit", quantity.unit},
                    {"drawn", is_certain ? "certain" : imagination::ToString(found->second)},
                    {"may be", fmt::format("{:g} .. {:g}", quantity.lower, quantity.upper)},
                    {"what it is", quantity.what}});
  }
  return rows;
}

const std::map<std::string, std::function<Rows(const Sources&)>>& Listers() {
  static const std::map<std::string, std::function<Rows(const Sources&)>> listers{
      {"areas", Areas},       {"objects", Objects},
      {"actions", Actions},   {"motion_sets", MotionSets},
      {"postures", Postures}, {"robots", Robots},
      {"worlds", Worlds},     {"scenarios", Scenarios},
      {"truths", Truths},     {"uncertainty", Quantities}};
  return listers;
}

Sources SourcesOf(const ListOptions& o, const std::string& package_folder) {
  Sources sources;
  sources.package_folder = package_folder;
  const auto client =
      imagination::ReadClientConfig(package_folder + "/config/imagination_client.yaml");
  sources.setup = imagination::ReadSetupConfig(o.scene.empty() ? client.scene : o.scene);
  imagination::OverridePaths(o.world, o.robot, o.objects, o.uncertainty, &sources.setup);
  sources.setup.map = o.map;
  sources.setup.areas = ReadAreas(o.areas);
  sources.setup.action_libraries = o.action_libraries;
  return sources;
}

constexpr char kTasks[] = "tasks";

std::vector<std::string> Kinds(bool with_tasks) {
  std::vector<std::string> kinds;
  for (const auto& [kind, lister] : Listers()) kinds.push_back(kind);
  if (with_tasks) kinds.push_back(kTasks);
  std::sort(kinds.begin(), kinds.end());
  return kinds;
}

/// What a list is made of is not written over by it.
void CheckListFiles(const ListOptions& o, const Sources& sources) {
  const imagination::SetupConfig& setup = sources.setup;
  std::vector<VerbFile> inputs = SceneFiles(setup.world, setup.map, setup.robot, o.areas);
  for (const VerbFile& input :
       {VerbFile{"scene", o.scene}, VerbFile{"objects", setup.objects},
        VerbFile{"uncertainty", setup.uncertainty},
        VerbFile{"uncertainty over it", setup.uncertainty_over}, VerbFile{"domain", o.domain}}) {
    inputs.push_back(input);
  }
  for (const std::string& library : o.action_libraries) inputs.push_back({"actions", library});
  CheckOutputs({{"--json", o.json, true}}, inputs);
}

/// @throws base::ConfigError naming what can be listed.
Rows ListRowsOf(const ListOptions& options, const std::string& package_folder,
                const TaskLister& tasks) {
  if (options.what == kTasks) {
    if (!tasks)
      throw base::ConfigError("list: this program plans nothing; 'hires list tasks' does");
    const std::string domain = options.domain.empty()
                                   ? package_folder + "/config/domains/restaurant.lisp"
                                   : options.domain;
    CheckOutputs({{"--json", options.json, true}}, {{"domain", domain}});
    return tasks(domain);
  }
  const auto lister = Listers().find(options.what);
  if (lister == Listers().end()) {
    throw base::ConfigError(base::UnknownName("list", options.what, Kinds(bool(tasks))));
  }
  const Sources sources = SourcesOf(options, package_folder);
  CheckListFiles(options, sources);
  return lister->second(sources);
}

}  // namespace

void AddListVerb(CLI::App* app, bool with_tasks, ListOptions* o) {
  const std::string kinds = base::Join(Kinds(with_tasks), ", ");
  CLI::App* verb = app->add_subcommand("list", "names that other verbs take: " + kinds);
  verb->add_option("what", o->what, kinds);
  CLI::Option* world =
      verb->add_option("--world", o->world, "another SDF world: its areas and objects");
  verb->add_option("--map", o->map, "a map_server map (its YAML) instead of a world: its extent")
      ->excludes(world);
  AddAreaOption(verb, &o->areas);
  verb->add_option(
      "--robot", o->robot,
      "another robot, profile (.yaml), URDF or xacro file: its tray, motion sets and postures");
  verb->add_option("--objects", o->objects, "another catalogue of objects (YAML)");
  verb->add_option("--scene", o->scene, "another scene file instead of config/scene.yaml");
  verb->add_option("--uncertainty", o->uncertainty, "a file that lies over the scene's, or none");
  verb->add_option("--actions", o->action_libraries, "library with more actions (.so)")
      ->allow_extra_args(false);
  if (with_tasks) {
    verb->add_option("--domain", o->domain,
                     "another planning domain: its tasks; default: the restaurant's");
  }
  verb->add_option("--json", o->json, "write the list to this file as well; - : print it instead");
  o->verb = verb;
}

int RunListVerb(const ListOptions& options, const std::string& package_folder,
                const TaskLister& tasks) {
  if (options.what.empty()) {
    throw base::ConfigError(fmt::format("list: nothing came, wanted one of '{}'",
                                        base::Join(Kinds(bool(tasks)), "', '")));
  }
  PrintList(options.what, ListRowsOf(options, package_folder, tasks), options.json);
  return kExitRecommended;
}

}  // namespace hires::cli
