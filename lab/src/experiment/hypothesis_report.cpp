#include "lab/src/experiment/hypothesis_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

#include "hires/base/check.h"
#include "hires/base/text.h"
#include "lab/src/experiment/report.h"
#include "reports/text/known_number.h"
#include "reports/text/report_table.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;

constexpr char kMethod[] =
    "score interval for the difference of paired shares, 95 % [Tango 1998, Statistics in Medicine "
    "17:891-908]";

PairedCounts PairsOf(const std::vector<HypothesisRun>& runs, int num_pairs) {
  std::map<int, std::pair<int, int>> successes;  // with, without
  for (const HypothesisRun& run : runs) {
    auto& [with, without] = successes[run.run];
    (run.imagines ? with : without) += run.success ? 1 : 0;
  }
  PairedCounts pairs;
  pairs.num_pairs = num_pairs;
  for (const auto& [run, pair] : successes) {
    pairs.only_first += pair.first > pair.second ? 1 : 0;
    pairs.only_second += pair.first < pair.second ? 1 : 0;
  }
  return pairs;
}

bool IsComplete(const HypothesisRun& run) { return run.is_complete; }
bool IsSuccess(const HypothesisRun& run) { return run.is_complete && run.success; }

/// [s] with - without, of the pairs whose runs both count.
std::vector<double> DurationDifferences(const std::vector<HypothesisRun>& runs,
                                        bool (*counts)(const HypothesisRun&)) {
  std::map<int, std::pair<const HypothesisRun*, const HypothesisRun*>> pairs;
  for (const HypothesisRun& run : runs) {
    auto& [with, without] = pairs[run.run];
    if (counts(run)) (run.imagines ? with : without) = &run;
  }
  std::vector<double> differences;
  for (const auto& [number, pair] : pairs) {
    if (pair.first == nullptr || pair.second == nullptr) continue;
    differences.push_back(pair.first->duration - pair.second->duration);
  }
  return differences;
}

ordered_json PairedDurationJson(const std::vector<HypothesisRun>& runs,
                                bool (*counts)(const HypothesisRun&)) {
  const std::vector<double> differences = DurationDifferences(runs, counts);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const Interval mean =
      differences.empty() ? Interval{kNone, kNone, kNone} : MeanInterval(differences);
  return {{"pairs", differences.size()},
          {"mean", reports::NumberOrNull(mean.estimate)},
          {"lower", reports::NumberOrNull(mean.lower)},
          {"upper", reports::NumberOrNull(mean.upper)},
          {"method", "Student's t, 95 %"}};
}

ordered_json ArmToJson(const HypothesisArm& arm) {
  return {{"runs", arm.runs},
          {"complete", arm.complete},
          {"successes", arm.successes},
          {"success",
           {{"share", arm.success.estimate},
            {"lower", arm.success.lower},
            {"upper", arm.success.upper}}},
          {"falls", arm.falls},
          {"broken_rules", arm.broken_rules},
          {"duration", {{"mean", arm.duration_mean}, {"sd", arm.duration_sd}}},
          {"steps", arm.steps},
          {"replans", arm.replans},
          {"imagination",
           {{"wall_seconds", arm.imagination_wall},
            {"dispatched", arm.dispatched},
            {"in_time", arm.in_time}}}};
}

std::string Share(const HypothesisArm& arm) {
  return fmt::format("{} of {} ({:.2f} .. {:.2f})", arm.successes, arm.runs, arm.success.lower,
                     arm.success.upper);
}

std::vector<std::string> Row(const std::string& name, const HypothesisArm& arm) {
  return {name,
          Share(arm),
          std::to_string(arm.falls),
          fmt::format("{:.1f} +- {:.1f} s", arm.duration_mean, arm.duration_sd),
          fmt::format("{:.1f}", arm.steps),
          fmt::format("{:.1f}", arm.replans),
          fmt::format("{:.1f} s", arm.imagination_wall),
          fmt::format("{} of {}", arm.in_time, arm.dispatched),
          std::to_string(arm.runs - arm.complete)};
}

/// How many runs broke which rule of the judge; a run may break several.
std::string RulesText(const HypothesisReport& report) {
  std::vector<std::vector<std::string>> rows{{"rule", "with", "without"}};
  for (const JudgeRule rule : AllJudgeRules()) {
    const std::string word = ToString(rule);
    const int with = report.with.broken_rules.at(word);
    const int without = report.without.broken_rules.at(word);
    if (with + without == 0) continue;
    rows.push_back({word, std::to_string(with), std::to_string(without)});
  }
  return rows.size() == 1 ? "" : "\nruns that broke a rule:\n" + reports::FormatTable(rows);
}

std::string FailureLines(const std::vector<HypothesisRun>& runs) {
  std::map<std::string, int> counts;
  for (const HypothesisRun& run : runs) {
    if (run.success) continue;
    std::string what = run.is_complete ? run.verdict : "";
    if (!run.reason.empty()) what += (what.empty() ? "" : "; ") + run.reason;
    ++counts[fmt::format("{} imagination: {}: {}", run.imagines ? "with" : "without", run.outcome,
                         what)];
  }
  std::string text;
  for (const auto& [what, count] : counts) text += fmt::format("  {} x {}\n", count, what);
  return text.empty() ? "" : "not succeeded:\n" + text;
}

std::vector<ordered_json> RowsOf(const std::vector<HypothesisRun>& runs) {
  std::vector<ordered_json> rows;
  for (const HypothesisRun& run : runs) rows.push_back(ToJson(run));
  return rows;
}

std::string HowPlayed(const HypothesisSetting& setting) {
  if (setting.is_local) return fmt::format("truth {}, in virtual time", setting.truth);
  return fmt::format("truth {}, pace {:g}, {} worker{}", setting.truth, setting.pace,
                     setting.workers, setting.workers == 1 ? "" : "s");
}

}  // namespace

HypothesisArm SumUpArm(const std::vector<HypothesisRun>& runs, bool imagines) {
  HypothesisArm arm;
  for (const JudgeRule rule : AllJudgeRules()) arm.broken_rules[ToString(rule)] = 0;
  std::vector<double> durations, steps, replans, walls;
  for (const HypothesisRun& run : runs) {
    if (run.imagines != imagines) continue;
    ++arm.runs;
    arm.successes += run.success ? 1 : 0;
    arm.falls += run.falls;
    if (!run.is_complete) continue;
    ++arm.complete;
    for (const std::string& rule : run.broken_rules) ++arm.broken_rules[rule];
    arm.dispatched += run.dispatched;
    arm.in_time += run.in_time;
    durations.push_back(run.duration);
    steps.push_back(run.steps);
    replans.push_back(run.replans);
    walls.push_back(run.imagination_wall);
  }
  arm.success = ShareInterval(arm.successes, arm.runs);
  arm.duration_mean = base::Mean(durations);
  arm.duration_sd = Deviation(durations);
  arm.steps = base::Mean(steps);
  arm.replans = base::Mean(replans);
  arm.imagination_wall = base::Mean(walls);
  return arm;
}

HypothesisReport SumUpHypothesis(const HypothesisSetting& setting,
                                 std::vector<HypothesisRun> runs) {
  std::sort(runs.begin(), runs.end(), [](const HypothesisRun& a, const HypothesisRun& b) {
    return std::make_tuple(a.run, !a.imagines) < std::make_tuple(b.run, !b.imagines);
  });
  HypothesisReport report;
  report.setting = setting;
  report.with = SumUpArm(runs, true);
  report.without = SumUpArm(runs, false);
  HIRES_CHECK(report.with.runs == setting.runs && report.without.runs == setting.runs,
              "a run is missing, or there twice");
  report.pairs = PairsOf(runs, setting.runs);
  report.difference = PairedScoreInterval(report.pairs);
  report.runs = std::move(runs);
  return report;
}

std::string HypothesisText(const HypothesisReport& report) {
  const HypothesisSetting& setting = report.setting;
  std::string text = fmt::format("hypothesis: {}, {} runs each, seed {}, {}\n\n", setting.scenario,
                                 setting.runs, setting.seed, HowPlayed(setting));
  text += reports::FormatTable({{"imagination", "succeeded (95 %)", "falls", "duration", "steps",
                                 "repairs", "imagining", "in time", "broke down"},
                                Row("with", report.with),
                                Row("without", report.without)});
  text += fmt::format(
      "\nsuccess with - without: {:+.2f} ({:+.2f} .. {:+.2f}); {} runs succeeded only with, {} "
      "only "
      "without; p = {:.3g} (McNemar's exact test)\n{}\n",
      report.difference.estimate, report.difference.lower, report.difference.upper,
      report.pairs.only_first, report.pairs.only_second, McNemarPValue(report.pairs), kMethod);
  text += RulesText(report);
  const std::string failures = FailureLines(report.runs);
  return failures.empty() ? text : text + '\n' + failures;
}

std::string HypothesisCsv(const HypothesisReport& report) {
  ExperimentReport table;
  table.findings.rows = RowsOf(report.runs);
  for (ordered_json& row : table.findings.rows) {
    for (const char* list : {"broken_rules", "recommended"}) {
      row[list] = base::Join(row[list].get<std::vector<std::string>>(), "; ");
    }
  }
  return ReportCsv(table);
}

ordered_json ToJson(const HypothesisReport& report, const std::string& command) {
  const HypothesisSetting& setting = report.setting;
  return {{"experiment", "hypothesis"},
          {"scenario", setting.scenario},
          {"runs", setting.runs},
          {"seed", setting.seed},
          {"pace", setting.pace},
          {"workers", setting.workers},
          {"files", setting.files},
          {"local", setting.is_local},
          {"truth", setting.truth},
          {"command", command},
          {"with_imagination", ArmToJson(report.with)},
          {"without_imagination", ArmToJson(report.without)},
          {"paired_difference",
           {{"mean", report.difference.estimate},
            {"lower", report.difference.lower},
            {"upper", report.difference.upper},
            {"only_with", report.pairs.only_first},
            {"only_without", report.pairs.only_second},
            {"p_value", McNemarPValue(report.pairs)},
            {"method", kMethod}}},
          {"paired_duration", PairedDurationJson(report.runs, IsComplete)},
          {"paired_duration_of_successes", PairedDurationJson(report.runs, IsSuccess)},
          {"list", RowsOf(report.runs)}};
}

}  // namespace hires::lab
