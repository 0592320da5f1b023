#include "cli/verbs/localise/localise_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/drive_log.h"
#include "cli/exit_code.h"
#include "cli/outputs.h"
#include "cli/whole_number.h"
#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/localisation/localise_log.h"
#include "hires/localisation/log_file.h"
#include "hires/world/occupancy_grid.h"
#include "reports/text/report_json.h"

namespace hires::cli {
namespace {

using geometry::Pose2;
using localisation::LocalisedLog;
using nlohmann::ordered_json;
using world::OccupancyGrid;

/// What the verb was given, and what came of it.
struct Answer {
  std::optional<Pose2> initial;
  double duration{0.0};  // [s]
  std::size_t num_scans{0};
  LocalisedLog localised;
  double through{0.0};   // share of beams
  double in_walls{0.0};  // share of the path's poses: the base's middle in an occupied cell

  /// What speaks against this map; empty: nothing does.
  std::string doubt() const {
    std::string against = localisation::WhyDoubtful(localised);
    // Of maps of the place 2 to 4 % were seen, of others 10 to 35 %.
    if (through <= 0.1) return against;
    if (!against.empty()) against += ", ";
    return against + fmt::format("{:.0f} % of the beams go through its obstacles", 100.0 * through);
  }
  std::string gap() const { return localisation::WhyPartial(localised); }
  bool is_localised() const { return status() == "good"; }
  std::string status() const {
    if (!doubt().empty()) return "doubtful";
    if (localised.rival)
      return localisation::ToString(localisation::LocalisationStatus::kAmbiguous);
    const bool is_partial =
        localised.last.status == localisation::LocalisationStatus::kGood && !gap().empty();
    return is_partial ? "partial" : localisation::ToString(localised.last.status);
  }
  bool has_path() const { return !localised.path.empty() && doubt().empty() && !localised.rival; }
  Eigen::Vector3d sd() const {
    return localised.last.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  }
};

OccupancyGrid ReadMap(const std::string& file) {
  OccupancyGrid map = world::LoadMap(file);
  const std::string why = localisation::WhyUseless(map);
  if (!why.empty()) throw base::ConfigError(file + ": " + why);
  return map;
}

void RefuseOutside(const Pose2& X_MB, const OccupancyGrid& map, const std::string& file) {
  const Eigen::Vector2d size(map.width * map.resolution, map.height * map.resolution);
  const Eigen::Vector2d upper = map.origin + size, p = X_MB.position();
  if ((p.array() >= map.origin.array()).all() && (p.array() <= upper.array()).all()) return;
  throw base::ConfigError(fmt::format(
      "--initial: ({:g}, {:g}) lies outside of {}, which reaches from ({:g}, {:g}) to ({:g}, {:g})",
      p.x(), p.y(), file, map.origin.x(), map.origin.y(), upper.x(), upper.y()));
}

double ShareInWalls(const localisation::TimedPath& path, const OccupancyGrid& map) {
  const auto is_in_wall = [&](const localisation::TimedPose& pose) {
    const Eigen::Vector2d at = (pose.X_MB.position() - map.origin) / map.resolution;
    const int column = static_cast<int>(std::floor(at.x())),
              row = static_cast<int>(std::floor(at.y()));
    const bool is_inside = column >= 0 && column < map.width && row >= 0 && row < map.height;
    return is_inside && map.at(column, row) == world::Cell::kOccupied;
  };
  if (path.empty()) return 0.0;
  return static_cast<double>(std::count_if(path.begin(), path.end(), is_in_wall)) /
         static_cast<double>(path.size());
}

/// A robot may touch what moved since the map was made; it does not drive through its walls.
std::string WarningOfWalls(const Answer& answer, const LocaliseOptions& options) {
  constexpr double kMost = 0.1;
  if (answer.in_walls <= kMost) return "";
  return fmt::format(
      "{:.0f} % of the poses lie in occupied cells: is `negate` of {} right, and is it the map of "
      "this drive?",
      100.0 * answer.in_walls, options.map);
}

/// "odometry jumped 1, no ranges 2"; "" for none.
std::string BadScans(const LocalisedLog& localised) {
  std::vector<std::string> parts;
  for (const auto& [outcome, count] : localised.outcomes) {
    if (localisation::IsBad(outcome))
      parts.push_back(fmt::format("{} {}", localisation::ToString(outcome), count));
  }
  if (localised.num_without_odometry > 0)
    parts.push_back(fmt::format("without odometry {}", localised.num_without_odometry));
  return base::Join(parts, ", ");
}

ordered_json ToJson(const Pose2& pose) { return {pose.x, pose.y, pose.yaw}; }

template <typename Number>
ordered_json OrNull(const std::optional<Number>& number) {
  return number ? ordered_json(*number) : ordered_json(nullptr);
}

ordered_json ToJson(const std::optional<localisation::Rival>& rival) {
  if (!rival) return nullptr;
  return {{"pose", ToJson(rival->X_MB)},
          {"explained", rival->explained},
          {"explained_here", rival->explained_here}};
}

ordered_json ToJson(const Answer& answer, const LocaliseOptions& options) {
  const LocalisedLog& localised = answer.localised;
  const Eigen::Vector3d sd = answer.sd();
  ordered_json outcomes = ordered_json::object(), statuses = ordered_json::object();
  for (const auto& [outcome, count] : localised.outcomes)
    outcomes[localisation::ToString(outcome)] = count;
  for (const auto& [status, count] : localised.statuses)
    statuses[localisation::ToString(status)] = count;
  return {{"schema", "hires/localisation"},
          {"version", 1},
          {"log", options.drive.log},
          {"map", options.map},
          {"trajectory", answer.has_path() ? options.trajectory : ""},
          {"seed", options.seed},
          {"initial", answer.initial ? ToJson(*answer.initial) : ordered_json(nullptr)},
          {"scans", answer.num_scans},
          {"poses", localised.path.size()},
          {"duration", answer.duration},
          {"length", localisation::LengthOf(localised.path)},
          {"status", answer.status()},
          {"doubt", answer.doubt()},
          {"rival", ToJson(localised.rival)},
          {"pose", ToJson(localised.last.X_MB)},
          {"sd", {sd.x(), sd.y(), sd.z()}},
          {"explained", localised.explained},
          {"through_obstacles", answer.through},
          {"in_walls", answer.in_walls},
          {"localised_after", OrNull(localised.localised_after)},
          {"way_known", localised.way_known},
          {"contradicted", localised.contradicted.size()},
          {"relocations", localised.num_relocations},
          {"relocated_after", OrNull(localised.relocated_after)},
          {"scans_by_outcome", outcomes},
          {"scans_by_status", statuses},
          {"without_odometry", localised.num_without_odometry}};
}

std::string Line(const std::string& name, const std::string& text) {
  return fmt::format("{:<12}{}\n", name, text);
}

std::string WhenLocalised(const Answer& answer) {
  const LocalisedLog& localised = answer.localised;
  if (!localised.localised_after) return "never: no trajectory is written";
  std::string text = fmt::format("after {:.1f} s; poses of {} scans", *localised.localised_after,
                                 localised.path.size());
  if (localised.num_relocations > 0) {
    text += fmt::format("; found elsewhere {} times, last after {:.1f} s",
                        localised.num_relocations, *localised.relocated_after);
  }
  if (!localised.contradicted.empty()) {
    text += fmt::format(": {} poses that the last ones contradict are left out",
                        localised.contradicted.size());
  }
  return text;
}

/// The last line; empty: nothing is.
std::string WhatIsDoubtful(const Answer& answer, const LocaliseOptions& options) {
  if (answer.doubt().empty()) return "";
  constexpr double kOften = 0.2;  // of the scans
  const auto jumped = answer.localised.outcomes.find(localisation::ScanOutcome::kOdometryJumped);
  const int num_jumped = jumped == answer.localised.outcomes.end() ? 0 : jumped->second;
  if (num_jumped > kOften * answer.num_scans) {
    return fmt::format(
        "{}: odometry jumped at {} of {} scans: is it in metres and radians, not in millimetres or "
        "degrees? ({}); no trajectory is written\n",
        options.drive.log, num_jumped, answer.num_scans, answer.doubt());
  }
  return fmt::format(
      "{} is probably not a map of where {} was recorded: {}; no trajectory is written\n",
      options.map, options.drive.log, answer.doubt());
}

/// The last line; empty: no other place fits.
std::string WhatElseFits(const Answer& answer, const LocaliseOptions& options) {
  if (answer.status() != "ambiguous" || !answer.localised.rival) return "";
  const localisation::Rival& rival = *answer.localised.rival;
  return fmt::format(
      "ambiguous: {} fits {} nearly as well elsewhere, with the robot at x {:.3f} m, y {:.3f} m, "
      "yaw {:.3f} rad after the path's last scan: {:.1f} % of the beams are explained there, "
      "{:.1f} % here; say where it began with --initial; no trajectory is written\n",
      options.map, options.drive.log, rival.X_MB.x, rival.X_MB.y, rival.X_MB.yaw,
      100.0 * rival.explained, 100.0 * rival.explained_here);
}

std::string Summary(const Answer& answer, const LocaliseOptions& options) {
  const LocalisedLog& localised = answer.localised;
  const Pose2& X_MB = localised.last.X_MB;
  const Eigen::Vector3d sd = answer.sd();
  const std::string bad = BadScans(localised), walls = WarningOfWalls(answer, options);
  return Line("start", answer.initial
                           ? fmt::format("x {:.3f} m, y {:.3f} m, yaw {:.3f} rad",
                                         answer.initial->x, answer.initial->y, answer.initial->yaw)
                           : "anywhere on the map: global localisation") +
         Line("scans", fmt::format("{} in {:.1f} s", answer.num_scans, answer.duration)) +
         (bad.empty() ? "" : Line("not used", bad)) + Line("localised", WhenLocalised(answer)) +
         Line("distance", fmt::format("{:.1f} m", localisation::LengthOf(localised.path))) +
         Line("final pose",
              fmt::format("x {:.3f} m, y {:.3f} m, yaw {:.3f} rad", X_MB.x, X_MB.y, X_MB.yaw)) +
         Line("its sd",
              fmt::format("x {:.3f} m, y {:.3f} m, yaw {:.3f} rad", sd.x(), sd.y(), sd.z())) +
         Line("explained", fmt::format("{:.0f} % of the beams", 100.0 * localised.explained)) +
         (walls.empty() ? "" : Line("in walls", walls)) + Line("status", answer.status()) +
         Line("seed", std::to_string(options.seed)) +
         (answer.status() == "partial" ? "partial: " + answer.gap() + "\n" : "") +
         WhatElseFits(answer, options) + WhatIsDoubtful(answer, options);
}

Answer Localise(const LocaliseOptions& options, const localisation::MonteCarloParams& defaults,
                const std::string& package_folder, const ReadDriveBag& read_bag) {
  const OccupancyGrid map = ReadMap(options.map);
  Answer answer;
  localisation::MonteCarloParams params = defaults;
  if (options.initial) {
    answer.initial = PoseIn(*options.initial, "--initial", "of the base in the map");
    RefuseOutside(*answer.initial, map, options.map);
    params.initial_pose = *answer.initial;
  }
  const localisation::RobotLog log = ReadDrive(options.drive, package_folder, read_bag);
  const base::Rng rng(options.seed);
  const std::string task = "localising " + options.drive.log;
  answer.num_scans = log.scans.size();
  answer.duration = log.scans.back().time - log.scans.front().time;
  answer.localised =
      answer.initial
          ? LocaliseLog(log, localisation::MonteCarloLocalisation(map, params, rng), task)
          : LocaliseAnywhere(log, map, params, rng, task);
  if (answer.localised.outcomes.count(localisation::ScanOutcome::kUpdated) == 0) {
    throw base::ConfigError(
        fmt::format("{}: no scan could be used ({}); wanted a drive on which a laser met walls",
                    options.drive.log, BadScans(answer.localised)));
  }
  answer.through = ShareThroughObstacles(log, answer.localised.path, map, params);
  answer.in_walls = ShareInWalls(answer.localised.path, map);
  return answer;
}

}  // namespace

void AddLocaliseVerb(CLI::App* app, LocaliseOptions* o) {
  CLI::App* verb = app->add_subcommand("localise", "where in a map a recorded drive went");
  AddDriveOptions(verb, &o->drive);
  verb->add_option("--map", o->map, "a map_server map (YAML with PGM or PNG)")->required();
  verb->add_option("--initial", o->initial,
                   "\"x y yaw\" [m, m, rad] of the base in the map when the log begins, give or "
                   "take what the configuration says; without it, it may be anywhere");
  verb->add_option("--trajectory", o->trajectory,
                   "write where the robot was at each scan from when it knew, lines "
                   "t x y z qx qy qz qw (TUM format)")
      ->required();
  verb->add_option("--seed", o->seed, "of all chance; equal seeds give equal answers")
      ->check(WholeNumber());
  verb->add_option("--config", o->config, "another file instead of config/localisation.yaml");
  verb->add_option("--json", o->json,
                   "write the answer for machines to this file; - : print it instead");
  verb->add_flag("--quiet", o->is_quiet, "no progress");
  o->verb = verb;
}

int RunLocaliseVerb(const LocaliseOptions& options, const std::string& package_folder,
                    const ReadDriveBag& read_bag) {
  const std::string config_path =
      options.config.empty() ? package_folder + "/config/localisation.yaml" : options.config;
  CheckOutputs({{"--trajectory", options.trajectory}, {"--json", options.json, true}},
               {{"log", options.drive.log},
                {"map", options.map},
                PictureFile(options.map),
                {"configuration", config_path}});
  const auto config =
      localisation::ReadLocalisationConfig(base::ParamReader::FromFile(config_path));
  const Answer answer = Localise(options, config.filter, package_folder, read_bag);
  if (answer.has_path())
    localisation::WriteTumTrajectory(answer.localised.path, options.trajectory);
  if (!answer.has_path() && std::filesystem::exists(options.trajectory)) {
    std::cerr << "hires localise: " << options.trajectory
              << " is not written now; what stands there is older\n";
  }
  if (options.json == "-") {
    std::cout << ToJson(answer, options).dump(2) << '\n';
  } else {
    std::cout << Summary(answer, options);
    if (!options.json.empty()) reports::WriteJson(ToJson(answer, options), options.json);
  }
  return answer.is_localised() ? kExitRecommended : kExitUndecided;
}

}  // namespace hires::cli
