#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "hires/base/failure.h"
#include "lab/src/experiment/hypothesis.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/imagination/scheduler.h"

// What a decision is worth: random tasks, the same ones for everybody who decides, judged by a
// truth that is played.
namespace hires::lab {

/// lab/config/decision.yaml: what tasks are drawn from.
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
  double processor_seconds{0.0};  ///< of the thread that played

  bool success() const { return failures.empty(); }
  bool fell() const;  ///< the load did
};
/// What a drive and its truth say, in the codes with which a rollout ends: the drive's own failure,
/// the load's first fall as world::CodeOf calls it, other things that fell, a touch.
TruthPlay JudgeDrive(const base::Failure& failure, double duration,
                     const simulation::RunTruth& truth, const std::string& load);

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

/// What imagination answered.
struct Advice {
  imagination::ImaginationOutcome outcome{imagination::ImaginationOutcome::kUndecided};
  std::string first;  ///< the motion set that leads the ranking
};

/// What an arm that imagines was told, and what that took.
struct Decided {
  std::vector<Advice> advice;     ///< per scale of prices
  double simulated_seconds{0.0};  ///< [s] of rollouts, at prices as they are
  double wall_seconds{0.0};       ///< likewise
  double processor_seconds{0.0};  ///< likewise
};

/// What was imagined of one task. It rests on the request alone, so all truths share it.
struct ImaginedTask {
  std::map<std::string, ImaginedDrive> drives;  ///< by motion set, at prices as they are
  std::map<std::string, Decided> decided;       ///< by arm, those that imagine
};

/// All that was played of one task. Arms share plays: a motion set is played once per seed.
struct DecisionRecord {
  DecisionTask task;
  std::map<std::string, TruthPlay> plays;                ///< by motion set, seed of the task
  std::map<std::string, std::vector<TruthPlay>> oracle;  ///< by motion set; empty: no such arm
  ImaginedTask imagined;                                 ///< empty: no arm imagines
};

/// Who decides.
inline constexpr char kImaginationArm[] = "imagination";    ///< expected cost of rollouts
inline constexpr char kDissertationArm[] = "dissertation";  ///< one rollout each, Eq. 6.1
inline constexpr char kSlowArm[] = "always_slow";
inline constexpr char kFastArm[] = "always_fast";
inline constexpr char kDefaultArm[] = "domain_default";
inline constexpr char kOracleArm[] = "oracle";  ///< the better one of many plays of the truth
const std::vector<std::string>& AllArms();
bool HasArm(const std::vector<std::string>& arms, const std::string& arm);

/// The motion sets between which is decided.
const std::vector<std::string>& DecisionAlternatives();

/// What the robot does with an answer: what leads the ranking, also where too few rollouts were
/// played to recommend it; nothing (""), where all fail; `by_default`, where nothing was played or
/// the ranking that finds no way is the dissertation's, which bans nothing.
std::string ChoiceOf(const Advice& advice, const std::string& arm, const std::string& by_default);

}  // namespace hires::lab
