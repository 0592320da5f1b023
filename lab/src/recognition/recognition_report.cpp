#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "lab/src/recognition/recognition_boxes.h"
#include "lab/src/recognition/recognition_goals.h"
#include "lab/src/trial/random_tables.h"
#include "reports/text/known_number.h"
#include "reports/text/report_table.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;
using perception::RecognitionSums;
using perception::ThingVerdict;

constexpr double kBands[] = {0.0, 1.1, 1.3, 1.5, 1.7, 2.0,
                             2.5, 3.0, 3.5, 4.0, 9.9};  // [m] from the camera
const char* const kTorso[] = {"down", "half way", "up"};

/// Some of the things, and which.
struct Part {
  std::string name;
  std::vector<ThingVerdict> things;
};

Part PartOf(const std::vector<ThingVerdict>& things, const std::string& name,
            const std::function<bool(const ThingVerdict&)>& is_in) {
  Part part{name, {}};
  std::copy_if(things.begin(), things.end(), std::back_inserter(part.things), is_in);
  return part;
}

/// Those without things, too.
std::vector<Part> AllPartsOf(const std::vector<ThingVerdict>& things) {
  std::vector<Part> parts{{"all", things}};
  for (std::size_t band = 0; band + 1 < std::size(kBands); ++band) {
    const double from = kBands[band], to = kBands[band + 1];
    const bool is_first = band == 0, is_last = band + 2 == std::size(kBands);
    parts.push_back(PartOf(
        things,
        is_first  ? fmt::format("nearer than {:.1f} m", to)
        : is_last ? fmt::format("{:.1f} m and farther", from)
                  : fmt::format("{:.1f} m to {:.1f} m", from, to),
        [&](const ThingVerdict& thing) { return thing.distance >= from && thing.distance < to; }));
  }
  for (int torso = 0; torso < static_cast<int>(std::size(kTorso)); ++torso) {
    parts.push_back(PartOf(things, fmt::format("torso {}", kTorso[torso]),
                           [&](const ThingVerdict& thing) { return thing.torso == torso; }));
  }
  parts.push_back(PartOf(things, "more than 30 % hidden",
                         [](const ThingVerdict& thing) { return thing.view.part.share < 0.7; }));
  parts.push_back(PartOf(things, "fewer than 1000 points",
                         [](const ThingVerdict& thing) { return thing.num_points < 1000; }));
  return parts;
}

std::vector<Part> PartsOf(const std::vector<ThingVerdict>& things) {
  std::vector<Part> parts = AllPartsOf(things);
  parts.erase(std::remove_if(parts.begin(), parts.end(),
                             [](const Part& part) { return part.things.empty(); }),
              parts.end());
  return parts;
}

/// Which rows the table lacks, and why; empty where it lacks none.
std::string LeftOutRowsText(const std::vector<ThingVerdict>& things) {
  std::vector<std::string> names;
  for (const Part& part : AllPartsOf(things))
    if (part.things.empty()) names.push_back(part.name);
  return names.empty() ? "" : "left out, as no thing was so: " + base::Join(names, ", ") + "\n";
}

std::string BareShare(const std::vector<ThingVerdict>& things, const ThingShare& share) {
  const ClusterCounts sum = SumOf(CountsOf(things, share));
  return reports::NumberText(100.0 * sum.num_hits / sum.num_all, 1);
}

std::string ShareText(const std::vector<ThingVerdict>& things, const ThingShare& share) {
  const std::vector<ClusterCounts> tables = CountsOf(things, share);
  if (SumOf(tables).num_all == 0) return "-";
  const Interval interval = ClusteredShareInterval(tables);
  return fmt::format("{:.1f} ({:.1f} .. {:.1f})", 100 * interval.estimate, 100 * interval.lower,
                     100 * interval.upper);
}

ordered_json ShareToJson(const std::vector<ThingVerdict>& things, const ThingShare& share) {
  const std::vector<ClusterCounts> tables = CountsOf(things, share);
  const ClusterCounts sum = SumOf(tables);
  if (sum.num_all == 0) return {{"hits", 0}, {"all", 0}, {"lower", nullptr}, {"upper", nullptr}};
  const Interval interval = ClusteredShareInterval(tables);
  return {{"hits", sum.num_hits},
          {"all", sum.num_all},
          {"lower", interval.lower},
          {"upper", interval.upper}};
}

std::vector<std::string> RowOf(const Part& part) {
  const RecognitionSums sums = perception::SumsOf(part.things);
  return {part.name,
          std::to_string(sums.num_things),
          ShareText(part.things, kFound),
          ShareText(part.things, kNamed),
          BareShare(part.things, kNamedOfFound),
          BareShare(part.things, kOwnLabel),
          ShareText(part.things, kUnknown),
          BareShare(part.things, kUnknownOfFound),
          ShareText(part.things, kMisnamed),
          MillimetresText(sums.median_error, sums.error_95),
          MillimetresText(sums.median_error_B, sums.error_B_95),
          reports::NumberText(sums.median_turn * 180.0 / geometry::kPi, 1)};
}

using Confusions = std::map<std::pair<std::string, std::string>, int>;

/// What was called by another name, and what was not found (called nothing).
Confusions ConfusionsOf(const std::vector<ThingVerdict>& things) {
  Confusions confusions;
  for (const ThingVerdict& thing : things)
    if (!thing.is_right()) ++confusions[{thing.kind, thing.called}];
  return confusions;
}

/// What stands there is of the catalogue, but the recogniser does not know its form.
std::string LeftOutText(const std::vector<ThingVerdict>& things) {
  std::string text = fmt::format(
      "kinds left out of the catalogue: {} things, found {} %, called unknown {} %, {} % of "
      "found\n",
      things.size(), ShareText(things, kFound), ShareText(things, kUnknown),
      BareShare(things, kUnknownOfFound));
  std::map<std::pair<std::string, std::string>, int> wrong;
  for (const ThingVerdict& thing : things)
    if (thing.is_found() && !thing.is_right()) ++wrong[{thing.model, thing.called}];
  for (const auto& [names, count] : wrong)
    text += fmt::format("  {} x {} called {}\n", count, names.first, names.second);
  return text;
}

std::string GoalText(const RecognitionGoal& goal) {
  const double scale = goal.is_length ? 1e3 : 100.0;
  const char* unit = goal.is_length ? "mm" : "%";
  const std::string interval =
      goal.interval ? fmt::format(" ({:.1f} .. {:.1f})", scale * goal.interval->lower,
                                  scale * goal.interval->upper)
                    : "";
  return fmt::format("goal: {} {} {:.0f} {}: {}, {}\n", goal.name,
                     goal.is_length ? "at most" : "at least", scale * goal.bound, unit,
                     reports::NumberText(scale * goal.value, 1) + interval,
                     ToString(goal.verdict()));
}

ordered_json GoalsToJson(const RecognitionReport& report) {
  ordered_json goals = ordered_json::array();
  for (const RecognitionGoal& goal : GoalsOf(report)) {
    goals.push_back({{"goal", goal.name},
                     {goal.is_length ? "at_most" : "at_least", goal.bound},
                     {"value", reports::NumberOrNull(goal.value)},
                     {"verdict", ToString(goal.verdict())}});
  }
  return goals;
}

}  // namespace

std::string ReportText(const RecognitionReport& report) {
  const std::vector<ThingVerdict>& things = report.score.things();
  std::vector<std::vector<std::string>> rows{
      {"things of 400 points or more", "number", "found [%]",
       "named rightly up to equal geometry [%]", "... of found", "by its own label [%]",
       "unknown so called [%]", "... of found", "wrong name, of found [%]",
       "error by the sensor alone: median / 95 % [mm]", "... with the camera's mount",
       "turned [deg]"}};
  for (const Part& part : PartsOf(things)) rows.push_back(RowOf(part));
  std::string text = fmt::format(
      "{} random tables from seed {} on, simulated; 95 % intervals in brackets, by table [Korn, "
      "Graubard 1998]; shares are of all things but where they say of found ones; found: by what "
      "has at least half of its points, and of whose points at least half are its own; distances "
      "are from the camera to the thing, the robot's base stands up to {:.1f} m before the table's "
      "middle\n\n{}{}\n",
      report.tables, report.seed, report.variety.farthest, reports::FormatTable(rows),
      LeftOutRowsText(things));
  text += BoxesText(report) + "\n";
  for (const RecognitionGoal& goal : GoalsOf(report)) text += GoalText(goal);
  text += LeftOutText(report.left_out);
  text += fmt::format("surplus: {} of {} detections\n", report.score.num_surplus(),
                      report.score.num_detections());
  for (const auto& [names, count] : ConfusionsOf(things)) {
    text += fmt::format("{} x {} {}\n", count, names.first,
                        names.second.empty() ? "not found" : "called " + names.second);
  }
  return text + fmt::format("{:.0f} ms of processor time for each cloud\n", 1e3 * report.seconds);
}

ordered_json ToJson(const RecognitionReport& report) {
  const std::vector<ThingVerdict>& things = report.score.things();
  ordered_json parts = ordered_json::array(), confusions = ordered_json::array();
  for (const Part& part : PartsOf(things)) {
    const RecognitionSums sums = perception::SumsOf(part.things);
    ordered_json one{{"part", part.name}};
    for (const ThingShare* share :
         {&kFound, &kNamed, &kNamedOfFound, &kOwnLabel, &kUnknown, &kUnknownOfFound, &kMisnamed})
      one[share->name] = ShareToJson(part.things, *share);
    one["median_error"] = reports::NumberOrNull(sums.median_error);
    one["error_95"] = reports::NumberOrNull(sums.error_95);
    one["median_error_base"] = reports::NumberOrNull(sums.median_error_B);
    one["error_95_base"] = reports::NumberOrNull(sums.error_B_95);
    one["median_turn"] = reports::NumberOrNull(sums.median_turn);
    parts.push_back(one);
  }
  for (const auto& [names, count] : ConfusionsOf(things))
    confusions.push_back({{"kind", names.first}, {"called", names.second}, {"count", count}});
  return {{"schema", "hires/recognition_experiment"},
          {"version", 4},
          {"tables", report.tables},
          {"seed", report.seed},
          {"farthest", report.variety.farthest},
          {"parts", parts},
          {"left_out",
           {{"found", ShareToJson(report.left_out, kFound)},
            {"unknown", ShareToJson(report.left_out, kUnknown)}}},
          {"boxes", BoxesToJson(report)},
          {"goals", GoalsToJson(report)},
          {"surplus", report.score.num_surplus()},
          {"detections", report.score.num_detections()},
          {"confusions", confusions},
          {"meets_goals", MeetsGoals(report)},
          {"seconds_per_cloud", report.seconds}};
}

}  // namespace hires::lab
