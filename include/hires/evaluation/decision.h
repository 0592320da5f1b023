#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/failure.h"
#include "hires/evaluation/experiment_hypothesis.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/imagination/scheduler.h"

// What a decision is worth: random tasks, the same ones for everybody who decides, judged by a
// truth that is played.
namespace hires::evaluation {

/// config/decision.yaml: what tasks are drawn from.
struct DecisionConfig {
  struct Load {
    std::string model;
    std::vector<std::string> torso;  ///< postures, lower case
  };
  struct Route {
    std::string from, to;  ///< areas, lower case
  };
  std::vector<Load> loads;
  std::vector<Route> routes;
  double deadline_share{0.5};                        ///< of tasks that have a deadline
  double deadline_lower{8.0}, deadline_upper{30.0};  ///< [s] after the drive's begin
  double factor_lower{0.02}, factor_upper{1.0};      ///< of the prices of things
  int oracle_plays{50};                              ///< of each motion set
};
/// @throws base::ConfigError naming file and key.
DecisionConfig ReadDecisionConfig(const std::string& path);

/// One load over one route.
struct DecisionTask {
  int number{1};  ///< 1, 2, ...
  std::string load, from, to, torso;
  std::optional<double> deadline;     ///< [s] after the drive's begin
  double price_factor{1.0};           ///< of the prices of things
  std::uint64_t truth_seed{1};        ///< of the truth; one for all arms
  std::uint64_t imagination_seed{1};  ///< of all rollouts
  std::uint64_t oracle_seed{1};       ///< of the oracle's plays; tasks of one cell share it
};
/// Load, route and height: what a truth depends on beside its seed. In one word.
std::string CellOf(const DecisionTask& task);
/// The same for the same seed and number, whatever else is drawn.
DecisionTask DrawTask(const DecisionConfig& config, std::uint64_t seed, int number);

/// Where the robot believes to begin: at the area, its arms tucked, the load on its tray.
/// @throws base::ConfigError for names that the setup does not know.
imagination::StartState StartOf(const imagination::ImaginationSetup& setup,
                                const DecisionTask& task);
base::ActionCall ActionOf(const DecisionTask& task, const std::string& motion_set);

/// What came of one drive in a truth.
struct TruthPlay {
  std::vector<base::FailureCode> failures;  ///< all that went wrong; none: it is done well
  double duration{0.0};                     ///< [s] of the drive
  double virtual_seconds{0.0};              ///< [s] of the whole play
  double wall_seconds{0.0};

  bool success() const { return failures.empty(); }
  bool fell() const;  ///< the load did
};
/// What a drive and its truth say, in the codes with which a rollout ends: the drive's own failure,
/// the load that fell or slid (level, but away from its place), other things that fell, a touch.
/// @param start  the world at the drive's begin.
TruthPlay JudgeDrive(const base::Failure& failure, double duration, const RunTruth& truth,
                     const std::string& load, const world::WorldState& start,
                     const world::StandingCriterion& standing);

/// What things, lateness and all else cost in a task, failures and lateness `scale` times as much.
imagination::Prices PricesOf(const DecisionTask& task, const imagination::Prices& prices,
                             double scale);
/// [s] duration, lateness and the price of all that went wrong.
double CostOf(const TruthPlay& play, const imagination::Prices& prices);

/// Prices as they are, halved and doubled: how a verdict moves.
const std::vector<double>& PriceScales();

/// What imagination expects of one motion set.
struct ImaginedDrive {
  int num_rollouts{0}, num_success{0};
  double lower{0.0}, upper{1.0};  ///< interval of success
  double cost{0.0};               ///< [s] expected
  std::vector<double> durations;  ///< [s] of the rollouts that succeeded
};

/// What an arm decided, and what deciding took.
struct Decided {
  std::vector<std::string> motion_sets;  ///< per scale of prices; empty: the task is not begun
  double simulated_seconds{0.0};         ///< [s] of rollouts, at prices as they are
  double wall_seconds{0.0};              ///< likewise
};

/// All that was played of one task. Arms share plays: a motion set is played once per seed.
struct DecisionRecord {
  DecisionTask task;
  std::map<std::string, TruthPlay> plays;                ///< by motion set, seed of the task
  std::map<std::string, std::vector<TruthPlay>> oracle;  ///< by motion set; empty: no such arm
  std::map<std::string, ImaginedDrive> imagined;         ///< by motion set, at prices as they are
  std::map<std::string, Decided> decided;                ///< by arm, those that imagine
};
nlohmann::ordered_json ToJson(const DecisionRecord& record);
/// @throws base::ConfigError naming `where` and the field.
DecisionRecord ParseDecisionRecord(const nlohmann::ordered_json& json, const std::string& where);

/// Who decides.
inline constexpr char kImaginationArm[] = "imagination";    ///< expected cost of rollouts
inline constexpr char kDissertationArm[] = "dissertation";  ///< one rollout each, Eq. 6.1
inline constexpr char kSlowArm[] = "always_slow";
inline constexpr char kFastArm[] = "always_fast";
inline constexpr char kDefaultArm[] = "domain_default";
inline constexpr char kOracleArm[] = "oracle";  ///< the better one of many plays of the truth
const std::vector<std::string>& AllArms();

/// The motion sets between which is decided.
const std::vector<std::string>& DecisionAlternatives();

/// Plays one drive in the truth.  @return nothing when cancelled.
using PlayTruth = std::function<std::optional<TruthPlay>(
    const DecisionTask& task, const std::string& motion_set, std::uint64_t seed)>;

/// What one task is decided and played with.
struct DecisionParts {
  const imagination::ImaginationSetup& setup;
  imagination::SchedulerParams scheduler;      ///< with prices
  std::string default_motion_set{};            ///< the domain's: where imagination has no answer
  int oracle_plays{0};                         ///< 0: no oracle
  bool imagines{true}, is_dissertation{true};  ///< the arms that imagine
  PlayTruth play{};
  std::function<bool()> cancelled{};
};
/// Imagines, decides and plays.  @param known  plays of the oracle of the same cell, or nullptr.
/// @return nothing when cancelled.  @throws base::ConfigError for a task that makes no sense.
std::optional<DecisionRecord> PlayDecision(const DecisionTask& task, const DecisionParts& parts,
                                           const DecisionRecord* known);

}  // namespace hires::evaluation
