#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/parallel.h"
#include "lab/src/experiment/braking.h"
#include "lab/src/experiment/report.h"
#include "hires/geometry/pose.h"
#include "hires/imagination/rollout_result.h"
#include "hires/knowledge/experience.h"
#include "hires/simulation/self_localisation.h"

namespace hires::lab {

/// A named pose of the robot's base in the map.
struct Goal {
  std::string name;
  geometry::Pose2 X_MG;
};

/// Legs between all goals: each goal once a round, in an order that is shuffled before each round.
/// Every leg starts where the last one really ended.
struct LegsConfig {
  int legs{100};           ///< in all
  int chains{1};           ///< the legs are spread over so many independent robots
  std::string motion_set;  ///< of the robot's profile
};

/// One action with two motion sets, the same truths for both.
struct PairedConfig {
  int pairs{512};
  std::string from, to;
  std::vector<std::string> motion_sets;  ///< two; differences are first - second
};

/// Counted samples of a reference.
struct ToppleReference {
  imagination::OutcomeCounts counts;
  double duration{0.0};  ///< [s]
};

/// The same goals in the same order, again and again, what falls is put back.
struct ToppleLoopConfig {
  double duration{18000.0};         ///< [s] simulated, for each motion set, over all chains
  int chains{10};                   ///< independent robots that share the duration
  bool one_truth_per_chain{false};  ///< mass, friction and so on: once per chain, or for each leg
  std::vector<std::string> route;
  std::vector<std::string> motion_sets;               ///< two; ratios are first / second
  std::map<std::string, ToppleReference> references;  ///< by motion set
};

/// Mean and standard deviation (1/N) of a duration [s].
struct DurationReference {
  double mean{0.0};
  double sigma{0.0};
};

/// How long drives and motions of torso and arms take, beside a simulated and a real reference.
struct DurationsConfig {
  struct Row {
    std::string action;      ///< move_base_param, move_torso or tuck_arms (both arms)
    std::string motion_set;  ///< of a drive; else empty
    std::string from, to;    ///< goals of a drive, else postures
    DurationReference simulated, real;
    bool IsDrive() const { return !motion_set.empty(); }
  };
  /// Whose local planner drives: the scene's, or one that never lets the footprint grow with speed
  /// (max_scaling_factor 0), as the original, which computes the growth and does not use it.
  enum class Planner { kScene, kUnscaled };
  int runs{20};             ///< of each row
  std::string postures_at;  ///< goal at which torso and arms move
  std::vector<Planner> planners{Planner::kScene};
  std::vector<Row> rows;  ///< each with its way back
};
const char* ToString(DurationsConfig::Planner planner);
/// Index of the row that goes back, with the same action and motion set.
/// @throws std::logic_error if there is none.
std::size_t WayBack(const DurationsConfig& durations, std::size_t row);

/// A static body of the world that stood elsewhere when the robot's map was made.
struct OldPlace {
  std::string body;
  geometry::Pose2 by;  ///< from where it stands to where it stood, about the body's own origin
};

/// One experiment, as its YAML file says. Relative paths in it count from the file's folder.
struct ExperimentConfig {
  std::string name;                 ///< the file's, without folder and ending
  std::string scene;                ///< path of a scene file, see imagination::SetupConfig
  std::string world{"scene"};       ///< "scene" (the scene's own), or path of an SDF world
  std::string uncertainty;          ///< "scene" (the scene's own), "none", or path
  std::string uncertainty_changes;  ///< YAML: quantities that replace or join those
  std::string map{"none"};          ///< "none": the scene's world; "given": by --map; or path
  double wall_height{2.5};          ///< [m] of the occupied cells of the map
  /// "none": the robot is told where it is, off as drawn; or path of a file like
  /// config/self_localisation.yaml: it finds its place by itself
  std::string self_localisation{"none"};
  /// What befalls such a robot: it is carried from another goal before each leg without a word;
  /// furniture was moved since its map was made; patches of the floor are wet.
  bool is_carried{false};
  std::vector<OldPlace> moved;
  std::vector<simulation::WetPatch> wet;
  /// "scene": as the scene has it; "none": by the map alone; or path of a file like
  /// config/obstacle_layer.yaml
  std::string obstacle_layer{"scene"};
  std::vector<Goal> goals;           ///< at least two
  std::vector<std::string> objects;  ///< on the tray
  std::uint64_t seed{1};
  std::variant<LegsConfig, PairedConfig, ToppleLoopConfig, DurationsConfig, BrakingConfig> kind;
  std::vector<Expectation> expect;
  std::uint64_t hash{0};  ///< of the file and of what overrode it
};

/// What the command line sets instead of the file.
struct ExperimentOverrides {
  std::optional<std::uint64_t> seed;
  std::optional<int>
      runs;         ///< legs, pairs, chains (with their share of the duration), runs, rollouts
  std::string map;  ///< path; empty: as in the file
};

/// @throws base::ConfigError naming file and key.
ExperimentConfig ReadExperiment(const std::string& path, const ExperimentOverrides& overrides = {});

/// "legs", "paired", "topple_loop", "durations", "braking".
std::string KindName(const ExperimentConfig& config);

/// Told by `topple_loop` at its end what each load went through, run by run, leg by leg: the same
/// for any number of threads. May be empty.
using OnExperience = std::function<void(const knowledge::ExperienceBatch&)>;

/// Plays and sums up. The same bits for any number of threads.
/// @return nothing when it was cancelled.  @throws base::ConfigError for what cannot be played.
std::optional<ExperimentReport> RunExperiment(const ExperimentConfig& config,
                                              const base::Crew& crew,
                                              const OnExperience& on_experience = {});

/// The report as it is before anything is played: name, kind, seed and hashes.
/// @throws base::ConfigError for what cannot be loaded.
ExperimentReport UnplayedReport(const ExperimentConfig& config);

}  // namespace hires::lab
