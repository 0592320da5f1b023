#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "hires/simulation/truth_record.h"
#include "hires/world/world.h"
#include "lab/src/statistics.h"
#include "loop/achieve.h"

// The project's hypothesis: a robot that imagines critical steps before it does them does its tasks
// more surely. Measured with the whole system, on equal hidden truths with and without imagination.
namespace hires::lab {

/// What counts as success in a scenario, and how long a run may take.
struct HypothesisGoal {
  std::vector<std::string> objects;  ///< one of these ...
  std::vector<std::string> areas;    ///< ... stands on one of these placing areas; lower case, both
  double time_limit{900.0};          ///< [s] simulated, from the system's start
  double start_limit{180.0};         ///< [s] of the wall's clock, until the system is there
  double wall_limit{3600.0};         ///< [s] likewise, for a whole run
};

/// Reads a file like lab/config/hypothesis.yaml.
/// @throws base::ConfigError naming file and key; for an unknown scenario, with names like it.
HypothesisGoal ReadHypothesisGoal(const std::string& path, const std::string& scenario);

/// One run that is to be played.
struct HypothesisOrder {
  std::string scenario;   ///< name of a file in config/scenarios
  int run{1};             ///< 1, 2, ...
  bool imagines{true};    ///< false: imagined steps take their default
  std::uint64_t seed{1};  ///< of hidden truth, noise and imagination; below 2^31, as ROS wants it
  double pace{1.0};       ///< simulated seconds per second; 0: as fast as it can
  int workers{1};         ///< simulators that imagine
  HypothesisGoal goal;
  std::string folder;  ///< for the run's logs; empty: nothing is kept
};

/// The seed of a run: both arms of the experiment share it.
std::uint64_t SeedOfRun(std::uint64_t seed, int run);

/// What became of one run.
struct HypothesisRun {
  int run{1};
  bool imagines{true};
  std::uint64_t seed{1};
  bool is_complete{false};  ///< the task came to an end, well or not; else the run broke down
  std::string outcome;      ///< as ToString(AchieveOutcome); or timed_out, system_died, not_started
  std::string reason;
  bool success{false};  ///< by what is really so, not by what the robot believes; false if broken
  std::string verdict;  ///< why: "mug1 stands on placingareawestrighttable1", "peppermill1 fell"
  std::vector<std::string> broken_rules;  ///< words of JudgeRule; empty where it succeeded
  int falls{0};                           ///< of all objects
  std::string contact;                    ///< first collision of the robot, or empty
  double duration{0.0};  ///< [s] simulated, from the first step's or imagination's begin to the end
  int steps{0};          ///< begun
  int replans{0};
  int imaginations{0};
  int dispatched{0};                  ///< imagined steps that were begun
  int in_time{0};                     ///< ... after a verdict, be it that all alternatives fail
  double imagination_wall{0.0};       ///< [s] of the wall's clock, all imaginations
  double imagination_simulated{0.0};  ///< [s] of all rollouts
  std::vector<std::string>
      recommended;           ///< "move_base_param(area1, slow)"; "none" where nothing was
  double wall_seconds{0.0};  ///< [s] of the whole run
};
nlohmann::ordered_json ToJson(const HypothesisRun& run);
/// @throws base::ConfigError naming `where` and the field.
HypothesisRun ParseHypothesisRun(const nlohmann::ordered_json& json, const std::string& where);

/// What a run must not break to be a success. At least as strict as a rollout is judged.
enum class JudgeRule {
  kFell,         ///< a thing that the task is about fell, be it that it was put up again
  kKnockedOver,  ///< any other thing did
  kTouched,      ///< the robot touched something
  kHeld,         ///< the thing is still in a hand
  kNotThere      ///< none of the things stands where the task wants it
};
/// "fell", "knocked_over", "touched", "held", "not_there".
std::string ToString(JudgeRule rule);
const std::vector<JudgeRule>& AllJudgeRules();

/// A place that the task is content with: on top of furniture.
struct WantedPlace {
  std::string name;  ///< lower case
  geometry::Pose3 X_MA;
  Eigen::AlignedBox2d extent_A;  ///< [m]
};
/// @param area_edge  [m] as rollouts are judged: skills::PlaceParams::area_edge.
/// @throws base::ConfigError for an area that the world does not have, with names like it.
std::vector<WantedPlace> PlacesOf(const HypothesisGoal& goal, const world::World& world,
                                  double area_edge);

/// Whether the object stands there: as the fall detector says, its origin (on its underside) over
/// the extent and within 0.02 m of the place's height.
bool StandsAt(const WantedPlace& place, const simulation::ObjectFate& object);

/// Success, verdict, broken rules, falls and contact of the run.
void Judge(const HypothesisGoal& goal, const std::vector<WantedPlace>& places,
           const simulation::RunTruth& truth, HypothesisRun* run);

/// What the execution monitor reports, counted.
void CountReport(const loop::AchieveReport& report, HypothesisRun* run);

/// Plays one run with a system of its own.
/// @return the record, also of a run that broke down; nothing when cancelled.
using PlayHypothesis = std::function<std::optional<HypothesisRun>(
    const HypothesisOrder& order, const std::function<bool()>& cancelled)>;

}  // namespace hires::lab
