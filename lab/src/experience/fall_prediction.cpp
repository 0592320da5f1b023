#include "lab/src/experience/fall_prediction.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "lab/src/experience/separation.h"
#include "lab/src/interval_json.h"
#include "reports/text/known_number.h"

namespace hires::lab {
namespace {

using knowledge::ToppleEpisodePart;
using nlohmann::ordered_json;

constexpr std::size_t kAhead = 10;   // [parts] before a fall at which the window ends: 0.5 s
constexpr std::size_t kWindow = 10;  // [parts] of the window: 0.5 s
constexpr std::size_t kStride = 40;  // [parts] between windows without a fall: 2 s
constexpr std::size_t kCalm = 60;    // [parts] around them in which nothing falls: 3 s
constexpr std::size_t kRocPoints = 60;

struct Feature {
  const char* name;
  double (*of)(const ToppleEpisodePart&);
};
const Feature kFeatures[] = {
    {"base |v|", [](const auto& p) { return p.base.v; }},
    {"base |a|", [](const auto& p) { return std::abs(p.base.a); }},
    {"base |j|", [](const auto& p) { return std::abs(p.base.j); }},
    {"base angular |v|", [](const auto& p) { return p.base.angular_v; }},
    {"base angular |a|", [](const auto& p) { return std::abs(p.base.angular_a); }},
    {"base angular |j|", [](const auto& p) { return std::abs(p.base.angular_j); }},
    {"base v times angular v", [](const auto& p) { return p.base.v * p.base.angular_v; }},
    {"tilt of the load", [](const auto& p) { return p.alpha; }},
};

double LargestIn(const Stretch& stretch, std::size_t end, const Feature& feature) {
  double largest = 0.0;
  for (std::size_t i = end - kWindow; i < end; ++i) {
    largest = std::max(largest, feature.of(stretch[i]));
  }
  return largest;
}

bool IsCalm(const Stretch& stretch, std::size_t at) {
  const std::size_t from = at < kCalm ? 0 : at - kCalm;
  const std::size_t to = std::min(stretch.size(), at + kCalm);
  return std::none_of(
      stretch.begin() + static_cast<std::ptrdiff_t>(from),
      stretch.begin() + static_cast<std::ptrdiff_t>(to),
      [](const ToppleEpisodePart& part) { return part.state == knowledge::ToppleState::kTopple; });
}

void AddStretch(const Stretch& stretch, const Feature& feature, RunScores* scores) {
  constexpr std::size_t kReach = kAhead + kWindow;
  for (const std::size_t at : OnsetsOf(stretch)) {
    if (at >= kReach) scores->positive.push_back(LargestIn(stretch, at - kAhead, feature));
  }
  for (std::size_t at = kReach; at < stretch.size(); at += kStride) {
    if (IsCalm(stretch, at)) scores->negative.push_back(LargestIn(stretch, at - kAhead, feature));
  }
}

/// By motion set what each run has of it.
std::map<std::string, std::vector<RunScores>> ByMotionSet(const std::vector<ExperienceRun>& runs,
                                                          const Feature& feature) {
  std::map<std::string, std::vector<RunScores>> by_set;
  for (const ExperienceRun& run : runs) {
    std::map<std::string, RunScores> of_run;
    for (std::size_t i = 0; i < run.stretches.size(); ++i) {
      AddStretch(run.stretches[i], feature, &of_run[MotionSetOf(run.actions[i])]);
    }
    for (auto& [set, scores] : of_run) by_set[set].push_back(std::move(scores));
  }
  return by_set;
}

/// Motion sets that only one run has are left out, as one run says nothing of others.
Strata MotionSetsToCompare(const std::vector<ExperienceRun>& runs, const Feature& feature) {
  Strata strata;
  for (auto& [set, of_set] : ByMotionSet(runs, feature)) {
    if (of_set.size() > 1) strata.push_back(std::move(of_set));
  }
  return strata;
}

std::vector<RunScores> ScoresOf(const std::vector<ExperienceRun>& runs, const Feature& feature) {
  std::vector<RunScores> scores(runs.size());
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (const Stretch& stretch : runs[r].stretches) AddStretch(stretch, feature, &scores[r]);
  }
  return scores;
}

/// Every other run, beginning with the one of that number.
std::vector<RunScores> EveryOther(const std::vector<RunScores>& runs, std::size_t first) {
  std::vector<RunScores> half;
  for (std::size_t r = first; r < runs.size(); r += 2) half.push_back(runs[r]);
  return half;
}

std::size_t CountOf(const std::vector<RunScores>& runs, std::vector<double> RunScores::*kind) {
  std::size_t count = 0;
  for (const RunScores& run : runs) count += (run.*kind).size();
  return count;
}

/// How rare falls are among the windows, which are the same for each feature.
ordered_json MotionSetsJson(const std::vector<ExperienceRun>& runs) {
  ordered_json sets = ordered_json::array();
  for (const auto& [set, of_set] : ByMotionSet(runs, kFeatures[0])) {
    sets.push_back({{"motion_set", set},
                    {"runs", of_set.size()},
                    {"falls", CountOf(of_set, &RunScores::positive)},
                    {"calm_windows", CountOf(of_set, &RunScores::negative)}});
  }
  return sets;
}

ordered_json FeatureJson(const Feature& feature, const std::vector<ExperienceRun>& experiences,
                         const std::vector<RunScores>& runs, const base::Rng& rng) {
  const RocPoint judged =
      JudgedAt(EveryOther(runs, 1), BestThreshold(EveryOther(runs, 0)).threshold);
  ordered_json alarms = ordered_json::array(), hits = ordered_json::array();
  for (const RocPoint& point : RocOf(runs, kRocPoints)) {
    alarms.push_back(reports::NumberOrNull(point.false_alarms));
    hits.push_back(reports::NumberOrNull(point.hits));
  }
  return {{"feature", feature.name},
          {"area", IntervalJson(AreaInterval(StrataOf(runs, MotionSetsOf(experiences)), rng))},
          {"area_within",
           IntervalJson(AreaIntervalWithin(MotionSetsToCompare(experiences, feature), rng))},
          {"judged",
           {{"threshold", reports::NumberOrNull(judged.threshold)},
            {"hits", reports::NumberOrNull(judged.hits)},
            {"false_alarms", reports::NumberOrNull(judged.false_alarms)}}},
          {"roc", {{"false_alarms", alarms}, {"hits", hits}}}};
}

}  // namespace

ordered_json PredictFalls(const std::vector<ExperienceRun>& runs, const base::Rng& rng) {
  ordered_json features = ordered_json::array();
  std::size_t falls = 0, calm = 0, all_falls = 0;
  for (const Feature& feature : kFeatures) {
    const std::vector<RunScores> scores = ScoresOf(runs, feature);
    falls = CountOf(scores, &RunScores::positive);
    calm = CountOf(scores, &RunScores::negative);
    features.push_back(FeatureJson(feature, runs, scores, rng));
  }
  for (const ExperienceRun& run : runs) {
    for (const Stretch& stretch : run.stretches) all_falls += OnsetsOf(stretch).size();
  }
  return {{"ahead", knowledge::kExperiencePeriod * kAhead},
          {"window", knowledge::kExperiencePeriod * kWindow},
          {"falls", falls},
          {"falls_too_early", all_falls - falls},
          {"calm_windows", calm},
          {"motion_sets", MotionSetsJson(runs)},
          {"resamples", kAreaResamples},
          {"features", features}};
}

}  // namespace hires::lab
