#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "hires/evaluation/recognition/recognition_experiment.h"
#include "hires/evaluation/report_table.h"
#include "hires/evaluation/statistics.h"
#include "hires/geometry/angles.h"

namespace hires::evaluation {
namespace {

using nlohmann::ordered_json;
using perception::RecognitionSums;
using perception::ThingVerdict;

constexpr double kFoundGoal = 0.98, kNamedGoal = 0.95, kUnknownGoal = 0.95;
constexpr double kErrorGoal = 0.005;                         // [m] median
constexpr double kBands[] = {0.0, 1.1, 1.3, 1.5, 1.7, 9.9};  // [m] from the camera
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

std::vector<Part> PartsOf(const std::vector<ThingVerdict>& things) {
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
  parts.erase(std::remove_if(parts.begin(), parts.end(),
                             [](const Part& part) { return part.things.empty(); }),
              parts.end());
  return parts;
}

std::string ShareText(int hits, int all) {
  if (all == 0) return "-";
  const Interval share = ShareInterval(hits, all);
  return fmt::format("{:.1f} ({:.1f} .. {:.1f})", 100 * share.estimate, 100 * share.lower,
                     100 * share.upper);
}

std::string BareShare(int hits, int all) {
  return all == 0 ? "-" : fmt::format("{:.1f}", 100.0 * hits / all);
}

ordered_json ShareToJson(int hits, int all) {
  const Interval share = ShareInterval(hits, all);
  return {{"hits", hits}, {"all", all}, {"lower", share.lower}, {"upper", share.upper}};
}

std::vector<std::string> RowOf(const Part& part) {
  const RecognitionSums sums = perception::SumsOf(part.things);
  return {part.name,
          std::to_string(sums.num_things),
          ShareText(sums.num_found, sums.num_things),
          ShareText(sums.num_named, sums.num_known),
          BareShare(sums.num_named, sums.num_known_found),
          BareShare(sums.num_own_label, sums.num_known),
          ShareText(sums.num_unknown_so_called, sums.num_unknown),
          BareShare(sums.num_unknown_so_called, sums.num_unknown_found),
          fmt::format("{:.1f} / {:.1f}", 1e3 * sums.median_error, 1e3 * sums.error_95),
          fmt::format("{:.1f} / {:.1f}", 1e3 * sums.median_error_B, 1e3 * sums.error_B_95),
          fmt::format("{:.1f}", sums.median_turn * 180.0 / geometry::kPi)};
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
  const RecognitionSums sums = perception::SumsOf(things);
  std::string text = fmt::format(
      "kinds left out of the catalogue: {} things, found {} %, called unknown {} %, {} % of "
      "found\n",
      sums.num_things, ShareText(sums.num_found, sums.num_things),
      ShareText(sums.num_unknown_so_called, sums.num_things),
      BareShare(sums.num_unknown_so_called, sums.num_found));
  std::map<std::pair<std::string, std::string>, int> wrong;
  for (const ThingVerdict& thing : things)
    if (thing.is_found() && !thing.is_right()) ++wrong[{thing.model, thing.called}];
  for (const auto& [names, count] : wrong)
    text += fmt::format("  {} x {} called {}\n", count, names.first, names.second);
  return text;
}

std::string GoalsText(const RecognitionSums& sums) {
  const auto verdict = [](bool is_met) { return is_met ? "met" : "missed"; };
  return fmt::format(
      "goals: found {:.0f} % {}, named {:.0f} % {}, unknown {:.0f} % {}, median error {:.0f} mm "
      "{}\n",
      100 * kFoundGoal, verdict(sums.num_found >= kFoundGoal * sums.num_things), 100 * kNamedGoal,
      verdict(sums.num_named >= kNamedGoal * sums.num_known), 100 * kUnknownGoal,
      verdict(sums.num_unknown_so_called >= kUnknownGoal * sums.num_unknown), 1e3 * kErrorGoal,
      verdict(sums.median_error < kErrorGoal));
}

}  // namespace

bool MeetsGoals(const RecognitionReport& report) {
  const RecognitionSums sums = perception::SumsOf(report.score.things());
  return sums.num_found >= kFoundGoal * sums.num_things &&
         sums.num_named >= kNamedGoal * sums.num_known &&
         sums.num_unknown_so_called >= kUnknownGoal * sums.num_unknown &&
         sums.median_error < kErrorGoal;
}

std::string ReportText(const RecognitionReport& report) {
  const std::vector<ThingVerdict>& things = report.score.things();
  std::vector<std::vector<std::string>> rows{
      {"things of 400 points or more", "number", "found [%]",
       "named rightly up to equal geometry [%]", "... of found", "by its own label [%]",
       "unknown so called [%]", "... of found", "error by the sensor alone: median / 95 % [mm]",
       "... with the camera's mount", "turned [deg]"}};
  for (const Part& part : PartsOf(things)) rows.push_back(RowOf(part));
  std::string text = fmt::format(
      "{} random tables from seed {} on, simulated; 95 % intervals in brackets [Clopper, Pearson "
      "1934]; shares are of all things but where they say of found ones\n\n{}\n",
      report.tables, report.seed, FormatTable(rows));
  text += GoalsText(perception::SumsOf(things));
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
    parts.push_back(
        {{"part", part.name},
         {"found", ShareToJson(sums.num_found, sums.num_things)},
         {"named", ShareToJson(sums.num_named, sums.num_known)},
         {"named_of_found", ShareToJson(sums.num_named, sums.num_known_found)},
         {"own_label", ShareToJson(sums.num_own_label, sums.num_known)},
         {"unknown", ShareToJson(sums.num_unknown_so_called, sums.num_unknown)},
         {"unknown_of_found", ShareToJson(sums.num_unknown_so_called, sums.num_unknown_found)},
         {"median_error", sums.median_error},
         {"error_95", sums.error_95},
         {"median_error_base", sums.median_error_B},
         {"error_95_base", sums.error_B_95},
         {"median_turn", sums.median_turn}});
  }
  for (const auto& [names, count] : ConfusionsOf(things))
    confusions.push_back({{"kind", names.first}, {"called", names.second}, {"count", count}});
  const RecognitionSums left_out = perception::SumsOf(report.left_out);
  return {{"schema", "hires/recognition_experiment"},
          {"version", 2},
          {"tables", report.tables},
          {"seed", report.seed},
          {"parts", parts},
          {"left_out",
           {{"found", ShareToJson(left_out.num_found, left_out.num_things)},
            {"unknown", ShareToJson(left_out.num_unknown_so_called, left_out.num_things)}}},
          {"surplus", report.score.num_surplus()},
          {"detections", report.score.num_detections()},
          {"confusions", confusions},
          {"meets_goals", MeetsGoals(report)},
          {"seconds_per_cloud", report.seconds}};
}

}  // namespace hires::evaluation
