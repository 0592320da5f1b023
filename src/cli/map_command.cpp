#include "cli/map_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/drive_log.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/cli/command_line.h"
#include "hires/cli/whole_number.h"
#include "hires/evaluation/report_json.h"
#include "hires/localisation/log_file.h"
#include "hires/mapping/mapper.h"

namespace hires::cli {
namespace {

using mapping::MapResult;
using nlohmann::ordered_json;

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

ordered_json ToJson(const MapResult& result, const MapOptions& options, const std::string& map) {
  const world::OccupancyGrid& grid = result.grid;
  return {{"schema", "hires/map"},
          {"version", 1},
          {"log", options.drive.log},
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
          {"odometry_jumps", result.odometry_jumps}};
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
  return text;
}

}  // namespace

void AddMapVerb(CLI::App* app, MapOptions* o) {
  CLI::App* verb = app->add_subcommand("map", "a map of what a laser saw on a recorded drive");
  AddDriveOptions(verb, &o->drive);
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
  o->verb = verb;
}

int RunMapVerb(const MapOptions& options, const std::string& package_folder,
               const ReadDriveBag& read_bag) {
  const std::string map = MapFile(options.output);
  for (const std::string& file : {map, options.trajectory, options.json})
    if (!file.empty() && file != "-") evaluation::RequireFolderOf(file);
  const localisation::RobotLog log = ReadDrive(options.drive, package_folder, read_bag);
  mapping::MapperParams params;
  params.resolution = options.resolution;
  params.max_range = options.max_range;
  const MapResult result = mapping::MakeMap(log, params, "mapping " + options.drive.log);
  world::SaveMap(result.grid, map);
  if (!options.trajectory.empty())
    localisation::WriteTumTrajectory(result.trajectory, options.trajectory);
  if (options.json == "-") {
    std::cout << ToJson(result, options, map).dump(2) << '\n';
    return kExitRecommended;
  }
  std::cout << Summary(result, map);
  if (!options.json.empty()) evaluation::WriteJson(ToJson(result, options, map), options.json);
  return kExitRecommended;
}

}  // namespace hires::cli
