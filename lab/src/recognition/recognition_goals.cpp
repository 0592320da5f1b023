#include "lab/src/recognition/recognition_goals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hires/base/text.h"

namespace hires::lab {
namespace {

using perception::ErrorQuantiles;
using perception::ThingVerdict;

constexpr double kFoundGoal = 0.98, kNamedGoal = 0.95, kUnknownGoal = 0.95;
constexpr double kErrorGoal = 0.005;  // [m] median
// Of boxes, which are what an arm keeps away from and what things are put beside: half within the
// distance that arms keep (0.01 m), 95 % within half of the room that is left for fingers (0.05 m).
constexpr double kBoxGoal = 0.01, kBoxGoal95 = 0.025;  // [m]

RecognitionGoal ShareGoal(const char* name, const RecognitionReport& report,
                          const ThingShare& share, double bound) {
  const std::vector<ClusterCounts> tables = CountsOf(report.score.things(), share);
  if (SumOf(tables).num_all == 0) {
    return {name, std::numeric_limits<double>::quiet_NaN(), bound, false};
  }
  const Interval interval = ClusteredShareInterval(tables);
  RecognitionGoal goal{name, interval.estimate, bound, false, interval};
  if (goal.verdict() == GoalVerdict::kUndecided)
    goal.enough_tables = TablesToDecide(tables, report.tables, bound);
  return goal;
}

bool HoldsBound(const Interval& interval, double bound) {
  return interval.lower < bound && interval.upper >= bound;
}

std::string NamesOf(const std::vector<RecognitionGoal>& goals, GoalVerdict verdict) {
  std::vector<std::string> names;
  for (const RecognitionGoal& goal : goals)
    if (goal.verdict() == verdict) names.push_back(goal.name);
  return base::Join(names, "; ");
}

/// What to do about goals that are undecided.
std::string EnoughText(const std::vector<RecognitionGoal>& goals, int num_tables) {
  int enough = 0;
  for (const RecognitionGoal& goal : goals) {
    if (goal.verdict() != GoalVerdict::kUndecided) continue;
    if (!goal.enough_tables) return "100000 tables would not decide, if all went as these did";
    enough = std::max(enough, *goal.enough_tables);
  }
  return fmt::format("about {} tables (--tables) would decide, if all went as these {} did", enough,
                     num_tables);
}

void AddBoxGoals(const perception::BoxSums& boxes, std::vector<RecognitionGoal>* goals) {
  const std::pair<const char*, ErrorQuantiles> parts[]{{"middle", boxes.middle},
                                                       {"longer side", boxes.longer},
                                                       {"shorter side", boxes.shorter},
                                                       {"height", boxes.height}};
  for (const auto& [name, error] : parts) {
    const std::string box = std::string("box of unknown, ") + name;
    goals->push_back({box + ", median", error.median, kBoxGoal, true});
    goals->push_back({box + ", 95 %", error.share_95, kBoxGoal95, true});
  }
}

bool IsKnown(const ThingVerdict& thing) { return thing.is_known(); }
bool IsKnownAndFound(const ThingVerdict& thing) { return thing.is_known() && thing.is_found(); }
bool IsUnknown(const ThingVerdict& thing) { return !thing.is_known(); }
bool IsUnknownAndFound(const ThingVerdict& thing) { return !thing.is_known() && thing.is_found(); }
bool WasFound(const ThingVerdict& thing) { return thing.is_found(); }
bool IsRight(const ThingVerdict& thing) { return thing.is_right(); }
/// Called by the name of something else, which "unknown" is not.
bool IsMisnamed(const ThingVerdict& thing) {
  return thing.is_found() && !thing.is_right() && thing.called != perception::kUnknownLabel;
}
bool IsAny(const ThingVerdict&) { return true; }
bool HasOwnLabel(const ThingVerdict& thing) {
  return thing.is_right() && thing.label == thing.model;
}

}  // namespace

const ThingShare kFound{"found", IsAny, WasFound};
const ThingShare kNamed{"named", IsKnown, IsRight};
const ThingShare kNamedOfFound{"named_of_found", IsKnownAndFound, IsRight};
const ThingShare kOwnLabel{"own_label", IsKnown, HasOwnLabel};
const ThingShare kUnknown{"unknown", IsUnknown, IsRight};
const ThingShare kUnknownOfFound{"unknown_of_found", IsUnknownAndFound, IsRight};
const ThingShare kMisnamed{"misnamed_of_found", WasFound, IsMisnamed};

std::vector<ClusterCounts> CountsOf(const std::vector<ThingVerdict>& things,
                                    const ThingShare& share) {
  std::vector<ClusterCounts> tables;
  for (const ThingVerdict& thing : things) {
    if (!share.is_in(thing)) continue;
    if (thing.table >= static_cast<int>(tables.size())) tables.resize(thing.table + 1);
    ++tables[thing.table].num_all;
    tables[thing.table].num_hits += share.is_hit(thing) ? 1 : 0;
  }
  return tables;
}

std::optional<int> TablesToDecide(const std::vector<ClusterCounts>& tables, int num_tables,
                                  double bound) {
  constexpr int kMost = 100'000;
  const auto is_decided = [&](int times) {
    std::vector<ClusterCounts> repeated;
    for (int i = 0; i < times; ++i) repeated.insert(repeated.end(), tables.begin(), tables.end());
    return !HoldsBound(ClusteredShareInterval(repeated), bound);
  };
  const int most = kMost / num_tables;
  int too_few = 0, enough = 1;
  while (!is_decided(enough)) {
    if (enough >= most) return std::nullopt;
    too_few = enough;
    enough = std::min(2 * enough, most);
  }
  while (enough - too_few > 1) {
    const int middle = too_few + (enough - too_few) / 2;
    (is_decided(middle) ? enough : too_few) = middle;
  }
  return enough * num_tables;
}

std::string ToString(GoalVerdict verdict) {
  switch (verdict) {
    case GoalVerdict::kMet:
      return "met";
    case GoalVerdict::kMissed:
      return "missed";
    case GoalVerdict::kUndecided:
      return "undecided";
    case GoalVerdict::kNoValue:
      break;
  }
  return "no value";
}

GoalVerdict RecognitionGoal::verdict() const {
  if (std::isnan(value)) return GoalVerdict::kNoValue;
  if (interval && HoldsBound(*interval, bound)) return GoalVerdict::kUndecided;
  const bool is_met = is_length ? value <= bound : value >= bound;
  return is_met ? GoalVerdict::kMet : GoalVerdict::kMissed;
}

std::vector<RecognitionGoal> GoalsOf(const RecognitionReport& report) {
  const perception::RecognitionSums sums = perception::SumsOf(report.score.things());
  std::vector<RecognitionGoal> goals{ShareGoal("found", report, kFound, kFoundGoal),
                                     ShareGoal("named", report, kNamed, kNamedGoal),
                                     ShareGoal("unknown", report, kUnknown, kUnknownGoal),
                                     {"median error", sums.median_error, kErrorGoal, true}};
  AddBoxGoals(sums.boxes, &goals);
  return goals;
}

bool MeetsGoals(const RecognitionReport& report) {
  const std::vector<RecognitionGoal> goals = GoalsOf(report);
  return std::all_of(goals.begin(), goals.end(), [](const RecognitionGoal& goal) {
    return goal.verdict() == GoalVerdict::kMet;
  });
}

std::string WhyGoalsAreNotMet(const RecognitionReport& report) {
  const std::vector<RecognitionGoal> goals = GoalsOf(report);
  std::string text;
  if (const std::string names = NamesOf(goals, GoalVerdict::kMissed); !names.empty())
    text += "missed: " + names + "\n";
  if (const std::string names = NamesOf(goals, GoalVerdict::kUndecided); !names.empty()) {
    text += fmt::format("undecided, as the 95 % interval holds the goal: {}; {}\n", names,
                        EnoughText(goals, report.tables));
  }
  if (const std::string names = NamesOf(goals, GoalVerdict::kNoValue); !names.empty())
    text += fmt::format("without a value, as no thing on these tables tells it: {}\n", names);
  return text;
}

}  // namespace hires::lab
