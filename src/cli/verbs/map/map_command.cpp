#include "cli/verbs/map/map_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>
#include <utility>

#include "cli/drive_log.h"
#include "cli/exit_code.h"
#include "cli/outputs.h"
#include "cli/verbs/imagine/imagine_start.h"
#include "cli/whole_number.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/localisation/log_file.h"
#include "hires/localisation/path_error.h"
#include "hires/mapping/map_doubt.h"
#include "hires/mapping/map_judge.h"
#include "hires/mapping/mapper.h"
#include "hires/simulation/self_localisation.h"
#include "reports/text/report_json.h"
#include "sim_robot/map_drive.h"

namespace hires::cli {
namespace {

using mapping::MapResult;
using nlohmann::ordered_json;

constexpr double kJudgesCell = 0.01;  // [m]

/// Of the YAML file, as map_server has it.
std::string MapFile(const std::string& output) {
  const std::string extension = base::ToLower(std::filesystem::path(output).extension().string());
  if (extension == ".pgm" || extension == ".png") {
    throw base::ConfigError(fmt::format(
        "--output {}: is the name of a picture; name the map's YAML file, the picture comes beside "
        "it",
        output));
  }
  return extension == ".yaml" ? output : output + ".yaml";
}

long CountOf(const world::OccupancyGrid& grid, world::Cell cell) {
  return std::count(grid.cells.begin(), grid.cells.end(), cell);
}

/// Of a simulated drive, beside the map.
struct Judgement {
  std::string world;  // file
  std::vector<std::string> visited, missed;
  localisation::PathError trajectory;
  double odometry_rms{0.0};  // [m] what it would be by odometry alone
  mapping::WallErrors walls;
};

ordered_json ToJson(const mapping::WallError& error) {
  return {{"median", error.median}, {"most_of_95_percent", error.most}, {"count", error.count}};
}

ordered_json ToJson(const Judgement& judgement, const MapOptions& options) {
  const geometry::Pose2& X_WM = judgement.trajectory.X_TP;
  return {{"world", judgement.world},
          {"seed", options.seed},
          {"motion_set", options.motion_set},
          {"visited", judgement.visited},
          {"missed", judgement.missed},
          {"trajectory",
           {{"rms", judgement.trajectory.rms},
            {"max", judgement.trajectory.max},
            {"odometry_rms", judgement.odometry_rms}}},
          {"best_fit", {X_WM.x, X_WM.y, X_WM.yaw}},
          {"walls_to_world", ToJson(judgement.walls.to_world)},
          {"world_to_walls", ToJson(judgement.walls.to_map)}};
}

ordered_json ToJson(const MapResult& result, const MapOptions& options, const std::string& map) {
  const world::OccupancyGrid& grid = result.grid;
  const mapping::MapEvidence& evidence = result.evidence;
  return {{"schema", "hires/map"},
          {"version", 1},
          {"log", options.is_driven ? options.log_output : options.drive.log},
          {"map", map},
          {"trajectory", options.trajectory},
          {"resolution", grid.resolution},
          {"width", grid.width},
          {"height", grid.height},
          {"origin", {grid.origin.x(), grid.origin.y()}},
          {"cells",
           {{"free", CountOf(grid, world::Cell::kFree)},
            {"occupied", CountOf(grid, world::Cell::kOccupied)},
            {"unknown", CountOf(grid, world::Cell::kUnknown)}}},
          {"scans", result.trajectory.size()},
          {"length", localisation::LengthOf(result.trajectory)},
          {"keyframes", result.num_keyframes},
          {"loops", result.num_loops},
          {"lost", result.num_lost},
          {"odometry_jumps", result.odometry_jumps},
          {"odometry_contradicted", result.num_searched},
          {"breaks", result.num_breaks},
          {"returns", evidence.returns.num_judged},
          {"returns_apart", evidence.returns.num_apart},
          {"explained", evidence.explained},
          {"through_walls", evidence.through_walls},
          {"doubt", mapping::WhyDoubtful(result, evidence)}};
}

std::string Summary(const MapResult& result, const std::string& map) {
  const double duration = result.trajectory.back().time - result.trajectory.front().time;
  std::string text = fmt::format(
      "{} scans over {:.1f} m in {:.0f} s; places seen before tie the map together {} times\n"
      "{}: {} x {} cells of {} m\n",
      result.trajectory.size(), localisation::LengthOf(result.trajectory), duration,
      result.num_loops, map, result.grid.width, result.grid.height, result.grid.resolution);
  if (result.num_lost > 0)
    text += fmt::format("{} scans fitted nothing and stand where odometry says\n", result.num_lost);
  if (result.odometry_jumps > 0)
    text +=
        fmt::format("odometry jumped {} times, which counts as no motion\n", result.odometry_jumps);
  if (result.num_searched > 0) {
    text += fmt::format(
        "at {} scans laser and odometry disagreed by more than odometry may err; the laser was "
        "believed\n",
        result.num_searched);
  }
  return text;
}

/// The last line; empty for a map that nothing speaks against.
std::string Doubt(const MapResult& result, const std::string& map) {
  const std::string why = mapping::WhyDoubtful(result, result.evidence);
  if (why.empty()) return "";
  return fmt::format("{} is doubtful: {}; to do: {}\n", map, why,
                     mapping::WhatToDo(result, result.evidence));
}

std::string Summary(const Judgement& judgement) {
  std::string text;
  for (const std::string& missed : judgement.missed) text += "not reached: " + missed + "\n";
  const auto row = [](const std::string& what, const mapping::WallError& error) {
    return fmt::format("{:<42}median {:.3f} m, 95 % within {:.3f} m\n", what, error.median,
                       error.most);
  };
  return text +
         fmt::format("{:<42}{:.3f} m rms, {:.3f} m at most; by odometry alone {:.3f} m rms\n",
                     "error of the trajectory", judgement.trajectory.rms, judgement.trajectory.max,
                     judgement.odometry_rms) +
         row("walls of the map to walls of the world", judgement.walls.to_world) +
         row("walls of the world to walls of the map", judgement.walls.to_map);
}

mapping::MapperParams ParamsOf(const MapOptions& options) {
  mapping::MapperParams params;
  params.resolution = options.resolution;
  params.max_range = options.max_range;
  return params;
}

/// The world as the laser sees it, finer than any map of it.
world::OccupancyGrid JudgesMap(const imagination::ImaginationSetup& setup,
                               simulation::SelfLocalisationParams senses) {
  senses.map_resolution = kJudgesCell;
  return simulation::MapIn(senses, setup.scene->world, *setup.scene->laser_height);
}

Judgement Judge(const sim_robot::MapDrive& drive, const MapResult& result,
                const world::OccupancyGrid& world, double max_range) {
  Judgement judgement;
  judgement.visited = drive.visited;
  judgement.missed = drive.missed;
  judgement.trajectory = localisation::ErrorOf(result.trajectory, drive.truth);
  localisation::TimedPath odometry;
  for (const localisation::RobotLog::Scan& scan : drive.log.scans)
    odometry.push_back({scan.time, *scan.X_OB});
  judgement.odometry_rms = localisation::ErrorOf(odometry, drive.truth).rms;
  judgement.walls = mapping::JudgeWalls(
      result.grid, world, judgement.trajectory.X_TP,
      mapping::FacesThatWereSeen(world, drive.log.scans, drive.truth, max_range));
  return judgement;
}

/// Drives through the world, makes the map and holds it against the world; nothing when cancelled.
std::optional<std::pair<MapResult, Judgement>> DriveAndMap(const MapOptions& options,
                                                           const std::string& package_folder,
                                                           const std::function<bool()>& cancelled) {
  imagination::SetupConfig files = imagination::ReadSetupConfig(
      options.scene.empty() ? package_folder + "/config/scene.yaml" : options.scene);
  imagination::OverridePaths(options.world, options.robot, {}, "none", &files);
  files.map = options.map;
  files.areas = ReadAreas(options.areas);
  const std::string world = files.map.empty() ? files.world : files.map;
  files.localisation = "drawn";  // it is told, and exactly so: nothing is uncertain
  const imagination::ImaginationSetup setup = imagination::LoadImaginationSetup(files);
  sim_robot::MapDriveParams params;
  params.senses = simulation::LoadSelfLocalisation(files.self_localisation);
  params.motion_set = options.motion_set;
  params.seed = options.seed;
  const auto drive = sim_robot::DriveForMap(setup, params, "driving through " + world, cancelled);
  if (!drive) return std::nullopt;
  if (!options.log_output.empty()) localisation::WriteCarmenLog(drive->log, options.log_output);
  if (!options.truth_output.empty())
    localisation::WriteTumTrajectory(drive->truth, options.truth_output);
  mapping::MapperParams mapper = ParamsOf(options);
  mapper.X_MBegin = drive->truth.front().X_MB;
  MapResult result = mapping::MakeMap(drive->log, mapper, "mapping " + world);
  Judgement judgement = Judge(*drive, result, JudgesMap(setup, params.senses), options.max_range);
  judgement.world = world;
  return std::make_pair(std::move(result), std::move(judgement));
}

/// Of a simulated drive.
void AddDrivenOptions(CLI::App* verb, MapOptions* o) {
  CLI::Option* drive = verb->add_flag(
      "--drive", o->is_driven,
      "instead of a log: a simulated robot drives to all areas of a world, told where it is and "
      "by what is really there, and maps it by its wheels, inertial unit and laser, which err; "
      "then tells how true the map is");
  for (const char* of_logs :
       {"log", "--scan", "--odometry", "--imu", "--odometry-frame", "--base-frame", "--laser"})
    drive->excludes(verb->get_option(of_logs));
  const auto add = [&](const char* name, std::string* value, const char* help) {
    verb->add_option(name, *value, help)->needs(drive);
  };
  add("--world", &o->world, "with --drive: another world (SDF) than the scene's");
  add("--map", &o->map, "with --drive: a map_server map (its YAML) whose walls are the world");
  verb->get_option("--map")->excludes(verb->get_option("--world"));
  AddAreaOption(verb, &o->areas);
  verb->get_option("--area")->needs(drive);
  add("--robot", &o->robot, "with --drive: another robot, profile (.yaml), URDF or xacro file");
  add("--scene", &o->scene, "with --drive: another scene file instead of config/scene.yaml");
  add("--motion-set", &o->motion_set, "with --drive: of the robot's profile; default: fast");
  add("--log", &o->log_output, "with --drive: write what was recorded as a CARMEN log");
  add("--truth", &o->truth_output,
      "with --drive: write where the robot really was, as --trajectory");
  verb->add_option("--seed", o->seed, "with --drive: of all chance; equal seeds, equal maps")
      ->check(WholeNumber())
      ->needs(drive);
}

}  // namespace

void AddMapVerb(CLI::App* app, MapOptions* o) {
  CLI::App* verb = app->add_subcommand("map",
                                       "a map of what a laser saw on a recorded drive, or on "
                                       "one through a simulated world");
  AddDriveOptions(verb, &o->drive);
  verb->get_option("log")->required(false);  // see --drive
  verb->add_option("--output", o->output,
                   "the map's YAML file, as map_server reads it; its picture comes beside it")
      ->required();
  verb->add_option(
      "--trajectory", o->trajectory,
      "write where the robot was at each scan, lines t x y z qx qy qz qw (TUM format)");
  verb->add_option("--resolution", o->resolution, "[m] cell of the map")
      ->check(NumberBetween(0.01, 1.0));
  verb->add_option("--max-range", o->max_range, "[m] what is farther away is not used")
      ->check(NumberBetween(1.0, 100.0));
  verb->add_option("--json", o->json,
                   "write sizes and counts to this file; - : print them instead");
  verb->add_flag("--quiet", o->is_quiet, "no progress");
  AddDrivenOptions(verb, o);
  o->verb = verb;
}

int RunMapVerb(const MapOptions& options, const std::string& package_folder,
               const ReadDriveBag& read_bag, const std::function<bool()>& cancelled) {
  const std::string map = MapFile(options.output);
  std::vector<VerbFile> inputs =
      SceneFiles(options.world, options.map, options.robot, options.areas);
  inputs.push_back({"scene", options.scene});
  inputs.push_back({"log", options.drive.log});
  CheckOutputs({{"--output", map},
                {"picture of --output", world::PictureToSave(map)},
                {"--trajectory", options.trajectory},
                {"--json", options.json, true},
                {"--log", options.log_output},
                {"--truth", options.truth_output}},
               inputs);
  MapResult result;
  std::optional<Judgement> judgement;
  if (options.is_driven) {
    auto driven = DriveAndMap(options, package_folder, cancelled);
    if (!driven) {
      std::cerr << "hires map: cancelled; nothing is written\n";
      return kExitCancelled;
    }
    std::tie(result, judgement) = *std::move(driven);
  } else if (options.drive.log.empty()) {
    throw base::ConfigError("hires map: no log; wanted LOG, a recorded drive, or --drive");
  } else {
    result = mapping::MakeMap(ReadDrive(options.drive, package_folder, read_bag), ParamsOf(options),
                              "mapping " + options.drive.log);
  }
  world::SaveMap(result.grid, map);
  if (!options.trajectory.empty())
    localisation::WriteTumTrajectory(result.trajectory, options.trajectory);
  const std::string doubt = Doubt(result, map);
  ordered_json json = ToJson(result, options, map);
  if (judgement) json["judgement"] = ToJson(*judgement, options);
  if (options.json == "-") {
    std::cout << json.dump(2) << '\n';
  } else {
    std::cout << Summary(result, map) << (judgement ? Summary(*judgement) : "") << doubt;
    if (!options.json.empty()) reports::WriteJson(json, options.json);
  }
  return doubt.empty() ? kExitRecommended : kExitDoubtful;
}

}  // namespace hires::cli
