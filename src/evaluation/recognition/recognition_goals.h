#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/evaluation/recognition/recognition_experiment.h"
#include "hires/evaluation/statistics.h"

namespace hires::evaluation {

/// A share of some things, and what it is a share of.
struct ThingShare {
  const char* name;  ///< in the report's numbers
  bool (*is_in)(const perception::ThingVerdict&);
  bool (*is_hit)(const perception::ThingVerdict&);
};
extern const ThingShare kFound, kNamed, kNamedOfFound, kOwnLabel, kUnknown, kUnknownOfFound;

/// By table.
std::vector<ClusterCounts> CountsOf(const std::vector<perception::ThingVerdict>& things,
                                    const ThingShare& share);

/// Undecided: the 95 % interval of a share holds the bound.
enum class GoalVerdict { kMet, kMissed, kUndecided, kNoValue };

/// "met", "missed", "undecided", "no value".
std::string ToString(GoalVerdict verdict);

/// What was wanted of a recogniser, and what came.
struct RecognitionGoal {
  std::string name;
  double value{0.0};      ///< share or [m]; not a number where nothing tells it
  double bound{0.0};      ///< likewise
  bool is_length{false};  ///< [m] of at most the bound; else a share of at least the bound
  std::optional<Interval> interval{};  ///< of the value; without one it is judged as it is
  GoalVerdict verdict() const;
};

/// Those of RecognitionReport's docstring for MeetsGoals, in its order.
std::vector<RecognitionGoal> GoalsOf(const RecognitionReport& report);

}  // namespace hires::evaluation
