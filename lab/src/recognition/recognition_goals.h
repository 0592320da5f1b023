#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lab/src/recognition/recognition_experiment.h"
#include "lab/src/statistics.h"

namespace hires::lab {

/// A share of some things, and what it is a share of.
struct ThingShare {
  const char* name;  ///< in the report's numbers
  bool (*is_in)(const perception::ThingVerdict&);
  bool (*is_hit)(const perception::ThingVerdict&);
};
extern const ThingShare kFound, kNamed, kNamedOfFound, kOwnLabel, kUnknown, kUnknownOfFound,
    kMisnamed;

/// By table.
std::vector<ClusterCounts> CountsOf(const std::vector<perception::ThingVerdict>& things,
                                    const ThingShare& share);

/// How many tables it takes until the interval of the share does not hold the bound, if all go as
/// these did: the counts are repeated as a whole.
/// @param num_tables  that were looked at, also those without a case.
/// @return nothing where no number up to 100,000 does.
std::optional<int> TablesToDecide(const std::vector<ClusterCounts>& tables, int num_tables,
                                  double bound);

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
  /// How many tables decide it, if others go as those that were looked at; where it is undecided,
  /// and so many are found.
  std::optional<int> enough_tables{};
  GoalVerdict verdict() const;
};

/// Those of RecognitionReport's docstring for MeetsGoals, in its order.
std::vector<RecognitionGoal> GoalsOf(const RecognitionReport& report);

}  // namespace hires::lab
