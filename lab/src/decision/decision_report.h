#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lab/src/decision/calibration.h"
#include "lab/src/decision/decision.h"
#include "lab/src/statistics.h"

namespace hires::lab {

/// What all tasks had in common.
struct DecisionSetting {
  std::string truth{"same"};
  std::uint64_t seed{1};
  std::vector<std::string> arms;
  std::string files;  ///< hash of configuration, worlds and robots
  std::string default_motion_set;
};

/// What one arm did in one task.
struct ArmTask {
  std::string motion_set;  ///< empty: the task was not begun
  double cost{0.0};        ///< [s] in the task's truth
  double expected{0.0};    ///< [s] mean cost of that choice over the oracle's plays; else as cost
  bool success{false};     ///< done, and nothing went wrong; being late is a matter of cost
  bool fell{false};
};

/// One arm over all tasks, at one scale of prices.
struct DecisionArm {
  std::vector<ArmTask> tasks;
  Interval cost;     ///< [s] mean with Student's t interval
  Interval success;  ///< share with the exact interval
  int falls{0};
  // None without an oracle.
  std::optional<Interval> expected;         ///< [s] mean expected cost
  std::optional<Interval> regret;           ///< [s] cost less the oracle's
  std::optional<Interval> expected_regret;  ///< [s] by expected costs
  double simulated_seconds{0.0};            ///< [s] of all plays behind its decisions
  double wall_seconds{0.0};                 ///< [s] likewise
  double processor_seconds{0.0};            ///< [s] likewise
  int num_undecided{0};  ///< tasks in which imagination was, and its first was taken
};

/// Imagination against another arm: differences are imagination - other.
struct ArmComparison {
  std::string arm;
  Interval cost;                     ///< [s] Student's t
  double t_free_p_value{1.0};        ///< of SignFlipPValue
  double sign_p_value{1.0};          ///< exact: cheaper as often as dearer
  std::optional<Interval> expected;  ///< [s] Student's t of expected costs; none without oracle
  double expected_p_value{1.0};      ///< of SignFlipPValue
  PairedCounts success;              ///< first: imagination
  int num_differ{0};                 ///< tasks in which both chose differently
};

/// One scale of prices.
struct ScaledVerdict {
  double scale{1.0};
  std::map<std::string, DecisionArm> arms;
  std::string best_constant;               ///< the cheaper one of always slow and always fast
  std::vector<ArmComparison> comparisons;  ///< empty where imagination is no arm
};

/// How well imagination's predictions fit what happened.
struct CalibrationReport {
  int num_steps{0};
  BrierParts brier;
  std::vector<ReliabilityBin> diagram;
  TestResult exchange;
  TestResult spiegelhalter;  ///< of shares (successes + 1/2) / (rollouts + 1)
  int num_durations{0};      ///< predicted successes that succeeded
  std::vector<int> pit;      ///< ten equal bins
  TestResult pit_uniform;
  Interval duration_coverage;  ///< of the middle 90 % of imagined durations
  struct Group {
    std::string name;
    int num_steps{0}, num_success{0};
    double predicted{0.0};  ///< mean share
    Interval success;       ///< of what happened, exact
    BrierParts brier;
  };
  std::vector<Group> groups;  ///< by motion set, then by load and motion set
  // Against the oracle's plays; empty without.
  int num_actions{0};          ///< load, route, height and motion set
  Interval correlation;        ///< Pearson's
  double rank_violation{0.0};  ///< mean maximum
  Interval success_coverage;   ///< intervals of success that hold the share of the oracle's plays
};

struct DecisionReport {
  DecisionSetting setting;
  std::vector<DecisionRecord> records;  ///< by number of the task
  std::vector<ScaledVerdict> verdicts;  ///< per PriceScales()
  std::optional<CalibrationReport> calibration;
};

/// @param prices  as configured.  @pre at least one record, and the arms of the setting were
/// played.
DecisionReport SumUpDecisions(const DecisionSetting& setting, std::vector<DecisionRecord> records,
                              const imagination::Prices& prices);

/// @param seed  of what is drawn among equal durations.
CalibrationReport Calibrate(const std::vector<DecisionRecord>& records, std::uint64_t seed);

std::string DecisionText(const DecisionReport& report);  ///< for people
std::string CalibrationText(const CalibrationReport& report);
/// For machines.  @param command  that repeats it.
nlohmann::ordered_json ToJson(const DecisionReport& report, const std::string& command);
nlohmann::ordered_json ToJson(const CalibrationReport& report);

}  // namespace hires::lab
