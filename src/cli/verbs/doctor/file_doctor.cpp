#include "cli/verbs/doctor/file_doctor.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "cli/verbs/imagine/imagine_start.h"
#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/spelling.h"
#include "hires/base/text.h"
#include "hires/imagination/client_config.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/imagination/rollout.h"
#include "hires/imagination/start_state.h"
#include "hires/robot/load_robot.h"
#include "hires/translation/areas.h"
#include "hires/world/occupancy_grid.h"
#include "hires/world/world.h"
#include "reports/film/picture_files.h"
#include "reports/film/top_view.h"

namespace hires::cli {
namespace {

using imagination::ImaginationSetup;
using Say = std::function<void(const Finding&)>;

/// Each text once, also where an earlier one says it with more around it.
class Told {
 public:
  explicit Told(Say say) : say_(std::move(say)) {}
  void operator()(const Finding& finding) {
    const auto says_it = [&](const std::string& text) {
      return text.find(finding.text) != std::string::npos;
    };
    if (std::any_of(texts_.begin(), texts_.end(), says_it)) return;
    texts_.push_back(finding.text);
    say_(finding);
  }

 private:
  Say say_;
  std::vector<std::string> texts_;
};

/// While it lives, warnings of this process are findings.
class WarningsAsFindings {
 public:
  explicit WarningsAsFindings(const Say& say) {
    base::SetLogSink([say](base::LogLevel level, const std::string& line) {
      if (level >= base::LogLevel::kWarn) say({FindingLevel::kWarning, line});
    });
  }
  ~WarningsAsFindings() { base::SetLogSink({}); }
  WarningsAsFindings(const WarningsAsFindings&) = delete;
  WarningsAsFindings& operator=(const WarningsAsFindings&) = delete;
};

/// What `look` says, or why it could not.
bool Try(const Say& say, const std::function<Finding()>& look) {
  try {
    say(look());
    return true;
  } catch (const std::exception& error) {
    say({FindingLevel::kFailed, error.what()});
    return false;
  }
}

Finding FindingOfWorld(const std::string& file, std::vector<std::string>* notes) {
  const world::World world = world::LoadWorld(file);
  *notes = world.notes;
  geometry::Aabb bounds;
  for (const world::StaticBody& body : world.statics)
    for (const geometry::Collision& shape : body.collisions)
      bounds.Include(geometry::BoundsOf(shape.shape, body.X_MB * shape.X_BS));
  std::string extent;
  if (!world.statics.empty()) {
    extent = fmt::format(", x {:.1f} m to {:.1f} m, y {:.1f} m to {:.1f} m, up to {:.1f} m high",
                         bounds.lower.x(), bounds.upper.x(), bounds.lower.y(), bounds.upper.y(),
                         bounds.upper.z());
  }
  return {FindingLevel::kOk,
          fmt::format("world {}: '{}' with {} bodies that stand, {} loose things, {} areas{}", file,
                      world.name, world.statics.size(), world.initial.objects.size(),
                      world.frames.size(), extent)};
}

Finding FindingOfMap(const std::string& file, std::vector<std::string>* notes) {
  const world::OccupancyGrid grid = world::LoadMap(file);
  *notes = grid.notes;
  return {FindingLevel::kOk,
          fmt::format("map {}: {} x {} cells of {} m, {:.1f} m x {:.1f} m, from x {:.1f} m, y "
                      "{:.1f} m on",
                      file, grid.width, grid.height, grid.resolution, grid.width * grid.resolution,
                      grid.height * grid.resolution, grid.origin.x(), grid.origin.y())};
}

Finding FindingOfRobot(const std::string& file, std::vector<std::string>* assumed) {
  const robot::Robot robot = robot::LoadAnyRobot(file);
  *assumed = robot.assumed;
  std::vector<std::string> sets;
  for (const auto& [name, set] : robot.profile.motion_sets) sets.push_back(name);
  return {FindingLevel::kOk,
          fmt::format("robot {}: '{}' with {} links, motion sets {}", file, robot.model.name,
                      robot.model.links.size(), base::Join(sets, ", "))};
}

std::vector<reports::MarkedPlace> PlacesToStand(const ImaginationSetup& setup) {
  std::vector<reports::MarkedPlace> places;
  const auto areas = translation::AreasOf(setup.scene->world, setup.scene->robot);
  for (const translation::Area& area : areas.all) {
    if (area.kind == translation::AreaKind::kStanding)
      places.push_back({area.name, geometry::Flatten(area.X_FA)});
  }
  return places;
}

/// Those that --area adds, where they are two or more, else all: a world's frames need be no places
/// to stand at.
std::vector<reports::MarkedPlace> ToDriveBetween(const std::vector<reports::MarkedPlace>& places,
                                                 const std::vector<imagination::NamedArea>& added) {
  std::vector<reports::MarkedPlace> own;
  std::copy_if(places.begin(), places.end(), std::back_inserter(own), [&](const auto& place) {
    return std::any_of(added.begin(), added.end(), [&](const auto& area) {
      return base::ToLower(area.name) == base::ToLower(place.name);
    });
  });
  return own.size() < 2 ? places : own;
}

/// None: there are no two.
std::optional<std::pair<reports::MarkedPlace, reports::MarkedPlace>> FarthestApart(
    const std::vector<reports::MarkedPlace>& places) {
  std::optional<std::pair<reports::MarkedPlace, reports::MarkedPlace>> farthest;
  double most = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = i + 1; j < places.size(); ++j) {
      const double apart = (places[i].X_MP.position() - places[j].X_MP.position()).norm();
      if (apart <= most) continue;
      most = apart;
      farthest = {places[i], places[j]};
    }
  }
  return farthest;
}

/// Slow, where the robot has that.
std::string MotionSetOf(const robot::Robot& robot) {
  const auto& sets = robot.profile.motion_sets;
  return sets.count("slow") > 0 || sets.empty() ? "slow" : sets.begin()->first;
}

/// @param way  [m] that is driven.
Finding PlayDrive(const ImaginationSetup& setup, const reports::MarkedPlace& from,
                  const reports::MarkedPlace& to, std::vector<Eigen::Vector2d>* way) {
  constexpr std::uint64_t kSeed = 1;
  const base::ActionCall drive{"move_base_param", {to.name, MotionSetOf(setup.scene->robot)}};
  const auto rollouts = imagination::MakeRolloutSetup(
      setup, imagination::MakeStartState(setup, from.name, {}), kSeed);
  imagination::CheckSetup(rollouts, drive);
  imagination::RolloutHooks hooks;
  double length = 0.0;
  hooks.on_begin = [&](const simulation::RobotSimulator&) {
    way->clear();
    length = 0.0;
  };
  hooks.on_sample = [&](const simulation::RobotSimulator& simulator, double) {
    way->push_back(simulator.base().X_MB.position());
    if (way->size() > 1) length += (way->back() - (*way)[way->size() - 2]).norm();
  };
  const auto result = imagination::PlayRollout(rollouts, drive, 0, hooks);
  const std::string name =
      fmt::format("drive from {} to {}, the areas that are farthest apart", from.name, to.name);
  const base::Failure failure = imagination::FailureOf(*result);
  if (failure) return {FindingLevel::kFailed, name + ": " + ToString(failure)};
  return {FindingLevel::kOk, fmt::format("{}: arrives after {:.1f} s, {:.1f} m (one rollout, seed "
                                         "{}; ask `hires imagine` for a probability)",
                                         name, result->duration, length, kSeed)};
}

imagination::SetupConfig ConfigOf(const FileDoctorOptions& options,
                                  const std::string& package_folder) {
  const auto client =
      imagination::ReadClientConfig(package_folder + "/config/imagination_client.yaml");
  imagination::SetupConfig config = imagination::ReadSetupConfig(client.scene);
  imagination::OverridePaths(options.world, options.robot, std::nullopt, std::nullopt, &config);
  if (options.world.empty()) config.map = options.map;
  return config;
}

/// Each file by itself, so that what is wrong with one hides nothing of the others.
/// @param[in,out] config  gets the areas.
/// @return whether all could be read.
bool LookAtFiles(const FileDoctorOptions& options, const Say& say,
                 imagination::SetupConfig* config) {
  bool is_whole = true;
  std::vector<std::string> notes;
  const auto tell = [&] {
    for (const std::string& note : notes) say({FindingLevel::kNote, note});
    notes.clear();
  };
  if (!options.world.empty())
    is_whole = Try(say, [&] { return FindingOfWorld(options.world, &notes); }) && is_whole;
  tell();
  if (!options.map.empty())
    is_whole = Try(say, [&] { return FindingOfMap(options.map, &notes); }) && is_whole;
  tell();
  is_whole = Try(say, [&] { return FindingOfRobot(config->robot, &notes); }) && is_whole;
  tell();
  const auto read_areas = [&] {
    config->areas = ReadAreas(options.areas);
    return Finding{FindingLevel::kOk,
                   "--area: " + base::Counted(config->areas.size(), "area") + " to stand at"};
  };
  if (!options.areas.empty()) is_whole = Try(say, read_areas) && is_whole;
  return is_whole;
}

}  // namespace

void ExamineFiles(const FileDoctorOptions& options, const std::string& package_folder,
                  const std::function<void(const Finding&)>& say_all) {
  Told told(say_all);
  const Say say = [&](const Finding& finding) { told(finding); };
  imagination::SetupConfig config = ConfigOf(options, package_folder);
  const WarningsAsFindings warnings(say);
  if (!LookAtFiles(options, say, &config)) return;
  std::optional<ImaginationSetup> setup;
  std::vector<reports::MarkedPlace> places;
  const bool is_set_up = Try(say, [&] {
    setup = imagination::LoadImaginationSetup(config);
    places = PlacesToStand(*setup);
    return Finding{
        FindingLevel::kOk,
        fmt::format("together they make a scene with {} areas to stand at", places.size())};
  });
  if (!is_set_up) return;
  std::vector<Eigen::Vector2d> way;
  if (const auto pair = FarthestApart(ToDriveBetween(places, config.areas))) {
    Try(say, [&] { return PlayDrive(*setup, pair->first, pair->second, &way); });
  } else {
    say({FindingLevel::kWarning,
         "no drive is played, as there are no two areas; name two: --area NAME:x,y,yaw [m, m, "
         "rad]"});
  }
  if (options.png.empty()) return;
  base::ReplaceTextFile(options.png, reports::ToPng(reports::TopView(*setup->scene, places, way)));
  say({FindingLevel::kOk, fmt::format("picture from above: {}", options.png)});
}

}  // namespace hires::cli
