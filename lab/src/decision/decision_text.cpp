#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "lab/src/decision/decision_report.h"
#include "reports/text/report_table.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;

constexpr char kTruthOfSame[] =
    "same is imagination's own model: it tests the plumbing, not whether decisions are right";

std::string IntervalText(const Interval& interval, int digits = 1) {
  return fmt::format("{:.{}f} ({:.{}f} .. {:.{}f})", interval.estimate, digits, interval.lower,
                     digits, interval.upper, digits);
}

std::string IntervalText(const std::optional<Interval>& interval) {
  return interval ? IntervalText(*interval) : "-";
}

/// The domain's default is a constant arm under another name, and says which.
std::string LabelOf(const std::string& arm, const DecisionSetting& setting) {
  return arm == kDefaultArm ? fmt::format("{} (always {})", arm, setting.default_motion_set) : arm;
}

std::string ArmTable(const DecisionReport& report, const ScaledVerdict& verdict) {
  std::vector<std::vector<std::string>> rows{
      {"arm", "cost [s] (95 %)", "expected cost [s]", "succeeded (95 %)", "falls", "regret [s]",
       "expected regret [s]", "undecided", "simulated", "wall", "processor"}};
  for (const std::string& name : report.setting.arms) {
    const DecisionArm& arm = verdict.arms.at(name);
    rows.push_back(
        {LabelOf(name, report.setting), IntervalText(arm.cost), IntervalText(arm.expected),
         IntervalText(arm.success, 3), std::to_string(arm.falls), IntervalText(arm.regret),
         IntervalText(arm.expected_regret), std::to_string(arm.num_undecided),
         fmt::format("{:.0f} s", arm.simulated_seconds), fmt::format("{:.0f} s", arm.wall_seconds),
         fmt::format("{:.0f} s", arm.processor_seconds)});
  }
  return reports::FormatTable(rows);
}

std::string RegretLine(const ScaledVerdict& verdict) {
  const auto mine = verdict.arms.find(kImaginationArm), best = verdict.arms.find(kOracleArm);
  if (mine == verdict.arms.end() || best == verdict.arms.end()) return "";
  const double least = best->second.expected->estimate;
  return fmt::format("expected regret of imagination: {:.1f} % of the oracle's expected cost\n",
                     100.0 * mine->second.expected_regret->estimate / least);
}

std::string ComparisonTable(const DecisionReport& report, const ScaledVerdict& verdict) {
  if (verdict.comparisons.empty()) return "";
  std::vector<std::vector<std::string>> rows{
      {"imagination -", "chose differently", "cost [s] (Student's t)", "p (sign flips)",
       "p (signs, exact)", "expected cost [s]", "p (sign flips)", "success only / only other",
       "p (McNemar, exact)"}};
  for (const ArmComparison& c : verdict.comparisons) {
    rows.push_back({LabelOf(c.arm, report.setting),
                    fmt::format("{} of {}", c.num_differ, c.success.num_pairs),
                    IntervalText(c.cost), fmt::format("{:.3g}", c.t_free_p_value),
                    fmt::format("{:.3g}", c.sign_p_value), IntervalText(c.expected),
                    c.expected ? fmt::format("{:.3g}", c.expected_p_value) : "-",
                    fmt::format("{} / {}", c.success.only_first, c.success.only_second),
                    fmt::format("{:.3g}", McNemarPValue(c.success))});
  }
  return "\n" + reports::FormatTable(rows);
}

ordered_json IntervalToJson(const Interval& interval) {
  return {{"mean", interval.estimate}, {"lower", interval.lower}, {"upper", interval.upper}};
}

ordered_json IntervalToJson(const std::optional<Interval>& interval) {
  return interval ? IntervalToJson(*interval) : ordered_json();
}

ordered_json TestToJson(const TestResult& test) {
  return {{"statistic", test.statistic}, {"p_value", test.p_value}};
}

ordered_json BrierToJson(const BrierParts& parts) {
  return {{"score", parts.score},
          {"reliability", parts.reliability},
          {"resolution", parts.resolution},
          {"uncertainty", parts.uncertainty},
          {"within", parts.within}};
}

ordered_json TasksToJson(const DecisionArm& arm, const std::vector<DecisionRecord>& records) {
  ordered_json tasks = ordered_json::array();
  for (std::size_t i = 0; i < arm.tasks.size(); ++i) {
    const ArmTask& task = arm.tasks[i];
    const DecisionTask& drawn = records[i].task;
    tasks.push_back(
        {{"task", drawn.number},
         {"cell", CellOf(drawn)},
         {"deadline", drawn.deadline ? ordered_json(*drawn.deadline) : ordered_json()},
         {"price_factor", drawn.price_factor},
         {"chosen", task.motion_set.empty() ? ordered_json() : ordered_json(task.motion_set)},
         {"cost", task.cost},
         {"expected_cost", task.expected},
         {"success", task.success},
         {"fell", task.fell}});
  }
  return tasks;
}

ordered_json DecisionArmToJson(const DecisionArm& arm) {
  return {{"cost", IntervalToJson(arm.cost)},
          {"expected_cost", IntervalToJson(arm.expected)},
          {"success", arm.success.estimate},
          {"success_interval", IntervalToJson(arm.success)},
          {"falls", arm.falls},
          {"regret", IntervalToJson(arm.regret)},
          {"expected_regret", IntervalToJson(arm.expected_regret)},
          {"simulated_seconds", arm.simulated_seconds},
          {"wall_seconds", arm.wall_seconds},
          {"processor_seconds", arm.processor_seconds},
          {"undecided", arm.num_undecided}};
}

ordered_json ComparisonToJson(const ArmComparison& c) {
  return {{"arm", c.arm},
          {"chose_differently", c.num_differ},
          {"cost", IntervalToJson(c.cost)},
          {"sign_flip_p_value", c.t_free_p_value},
          {"sign_p_value", c.sign_p_value},
          {"expected_cost", IntervalToJson(c.expected)},
          {"expected_sign_flip_p_value",
           c.expected ? ordered_json(c.expected_p_value) : ordered_json()},
          {"success_only_imagination", c.success.only_first},
          {"success_only_other", c.success.only_second},
          {"success_p_value", McNemarPValue(c.success)}};
}

ordered_json VerdictToJson(const ScaledVerdict& verdict) {
  ordered_json arms = ordered_json::object(), comparisons = ordered_json::array();
  for (const auto& [name, arm] : verdict.arms) arms[name] = DecisionArmToJson(arm);
  for (const ArmComparison& c : verdict.comparisons) comparisons.push_back(ComparisonToJson(c));
  return {{"prices_times", verdict.scale},
          {"best_constant", verdict.best_constant},
          {"arms", arms},
          {"imagination_minus", comparisons}};
}

ordered_json BinToJson(const ReliabilityBin& bin) {
  return {{"lower", bin.lower},           {"upper", bin.upper},
          {"steps", bin.count},           {"came", bin.came},
          {"forecast", bin.forecast},     {"share", bin.share},
          {"band_lower", bin.band_lower}, {"band_upper", bin.band_upper}};
}

ordered_json GroupToJson(const CalibrationReport::Group& group) {
  return {{"name", group.name},
          {"steps", group.num_steps},
          {"predicted", group.predicted},
          {"happened", IntervalToJson(group.success)},
          {"brier", BrierToJson(group.brier)}};
}

}  // namespace

std::string DecisionText(const DecisionReport& report) {
  std::string text = fmt::format("decision: truth {}, {} tasks, seed {}\n", report.setting.truth,
                                 report.records.size(), report.setting.seed);
  if (report.setting.truth == "same") text += fmt::format("({})\n", kTruthOfSame);
  for (const ScaledVerdict& verdict : report.verdicts) {
    text += fmt::format("\nprices times {:g}\n{}", verdict.scale, ArmTable(report, verdict));
    text += RegretLine(verdict) + ComparisonTable(report, verdict);
  }
  text +=
      "simulated, wall, processor: of deciding, summed over tasks and threads, the same for all "
      "prices and in no cost\n";
  return report.calibration ? text + "\n" + CalibrationText(*report.calibration) : text;
}

std::string CalibrationText(const CalibrationReport& report) {
  const BrierParts& brier = report.brier;
  std::string text = fmt::format(
      "calibration: {} imagined steps\nBrier {:.4f} = reliability {:.4f} - resolution {:.4f} + "
      "uncertainty {:.4f} + within bins {:.4f}\n"
      "what happened as one more rollout: {:+.1f} successes, p = {:.3g} (exact); Spiegelhalter's z "
      "{:+.2f}, p = {:.3g}\n",
      report.num_steps, brier.score, brier.reliability, brier.resolution, brier.uncertainty,
      brier.within, report.exchange.statistic, report.exchange.p_value,
      report.spiegelhalter.statistic, report.spiegelhalter.p_value);
  text += fmt::format(
      "durations: {} steps, middle 90 % hold {}, PIT Kolmogorov-Smirnov D {:.3f}, p = {:.3g}\n",
      report.num_durations, IntervalText(report.duration_coverage, 3), report.pit_uniform.statistic,
      report.pit_uniform.p_value);
  if (report.num_actions > 0) {
    text += fmt::format(
        "ranking of {} actions: Pearson {}, mean maximum rank violation {:.3f}; {} of the "
        "intervals "
        "of success hold the share of the oracle's plays\n",
        report.num_actions, IntervalText(report.correlation, 3), report.rank_violation,
        IntervalText(report.success_coverage, 3));
  }
  std::vector<std::vector<std::string>> rows{{"predicted", "steps", "mean", "happened", "band"}};
  for (const ReliabilityBin& bin : report.diagram) {
    rows.push_back({fmt::format("{:.1f} .. {:.1f}", bin.lower, bin.upper),
                    std::to_string(bin.count), fmt::format("{:.3f}", bin.forecast),
                    fmt::format("{:.3f}", bin.share),
                    fmt::format("{:.3f} .. {:.3f}", bin.band_lower, bin.band_upper)});
  }
  text += "\n" + reports::FormatTable(rows);
  rows = {{"action", "steps", "predicted", "happened (95 %)", "Brier"}};
  for (const CalibrationReport::Group& group : report.groups) {
    rows.push_back({group.name, std::to_string(group.num_steps),
                    fmt::format("{:.3f}", group.predicted), IntervalText(group.success, 3),
                    fmt::format("{:.4f}", group.brier.score)});
  }
  return text + "\n" + reports::FormatTable(rows);
}

ordered_json ToJson(const DecisionReport& report, const std::string& command) {
  ordered_json arms = ordered_json::object(), verdicts = ordered_json::array();
  const ScaledVerdict& first = report.verdicts.front();
  for (const std::string& name : report.setting.arms) {
    arms[name] = DecisionArmToJson(first.arms.at(name));
    arms[name]["tasks"] = TasksToJson(first.arms.at(name), report.records);
  }
  for (const ScaledVerdict& verdict : report.verdicts) verdicts.push_back(VerdictToJson(verdict));
  return {{"experiment", "decision"},
          {"truth", report.setting.truth},
          {"runs", report.records.size()},
          {"seed", report.setting.seed},
          {"files", report.setting.files},
          {"command", command},
          {"arms", arms},
          {"verdicts", verdicts},
          {"calibration", report.calibration ? ToJson(*report.calibration) : ordered_json()}};
}

ordered_json ToJson(const CalibrationReport& report) {
  ordered_json diagram = ordered_json::array(), groups = ordered_json::array();
  for (const ReliabilityBin& bin : report.diagram) diagram.push_back(BinToJson(bin));
  for (const auto& group : report.groups) groups.push_back(GroupToJson(group));
  ordered_json ranking;
  if (report.num_actions > 0) {
    ranking = {{"actions", report.num_actions},
               {"pearson", IntervalToJson(report.correlation)},
               {"mean_maximum_rank_violation", report.rank_violation},
               {"success_interval_coverage", IntervalToJson(report.success_coverage)}};
  }
  return {{"steps", report.num_steps},
          {"brier", BrierToJson(report.brier)},
          {"reliability_diagram", diagram},
          {"exchange_test", TestToJson(report.exchange)},
          {"spiegelhalter_test", TestToJson(report.spiegelhalter)},
          {"durations",
           {{"steps", report.num_durations},
            {"pit", report.pit},
            {"uniform_test", TestToJson(report.pit_uniform)},
            {"coverage_of_90", IntervalToJson(report.duration_coverage)}}},
          {"ranking", ranking},
          {"groups", groups}};
}

}  // namespace hires::lab
