#include "reports/text/report_json.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::reports {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

ordered_json CostToJson(const std::optional<imagination::ExpectedCost>& cost) {
  if (!cost) return {};
  return {{"mean", cost->mean}, {"lower", cost->lower}, {"upper", cost->upper}};
}

ordered_json CausesToJson(const std::map<std::string, int>& causes) {
  ordered_json list = ordered_json::array();
  for (const auto& [cause, count] : causes) list.push_back({{"cause", cause}, {"count", count}});
  return list;
}

/// null where there is no such rollout.
ordered_json IndexToJson(int index) { return index < 0 ? ordered_json() : ordered_json(index); }

ordered_json RankedToJson(const imagination::Prediction& prediction) {
  const imagination::Evidence& e = prediction.evidence;
  return {{"action", prediction.action.name},
          {"arguments", prediction.action.arguments},
          {"confidence", {{"pooled", e.confidence_pooled}, {"mean", e.confidence_mean}}},
          {"success",
           {{"share", e.success.share},
            {"lower", e.success.lower},
            {"upper", e.success.upper},
            {"interval", imagination::ToString(e.success.kind)}}},
          {"expected_cost", CostToJson(e.cost)},
          {"fall_share", e.fall_share},
          {"counts",
           {{"notopple", e.counts.notopple},
            {"shaking", e.counts.shaking},
            {"topple", e.counts.topple}}},
          {"falls", e.falls},
          {"duration",
           {{"mean", e.duration.mean},
            {"sd", e.duration.sd},
            {"p50", e.duration.p50},
            {"p95", e.duration.p95},
            {"values", e.durations}}},
          {"max_tilt", {{"p50", e.max_tilt.p50}, {"p95", e.max_tilt.p95}, {"values", e.max_tilts}}},
          {"rollouts", e.num_rollouts},
          {"failures", FailuresToJson(e.failures)},
          {"first_causes", CausesToJson(e.first_causes)},
          {"worst_rollout", IndexToJson(e.worst_rollout)},
          {"median_rollout", IndexToJson(e.median_rollout)}};
}

ordered_json NextToJson(const std::optional<imagination::CostComparison>& next) {
  if (!next) return nullptr;
  return {{"place", next->other},
          {"time_saved", next->time_saved},
          {"failures_more", next->failures_more},
          {"failures_more_upper", next->failures_more_upper},
          {"neither_failed", next->neither_failed},
          {"probability", next->probability}};
}

ordered_json TurningToJson(const std::optional<imagination::TurningPrice>& turning) {
  if (!turning) return nullptr;
  return {{"failure", base::ToString(turning->code)},
          {"price", turning->price},
          {"when", turning->is_below ? "less" : "more"},
          {"place", turning->other}};
}

/// null where the recommendation is none by cost.
ordered_json ByCostToJson(const std::optional<imagination::CostReasons>& by_cost) {
  if (!by_cost) return nullptr;
  ordered_json prices = ordered_json::array();
  for (const auto& [code, price] : by_cost->prices) {
    prices.push_back({{"failure", base::ToString(code)}, {"price", price}});
  }
  return {{"probability_best", by_cost->probability},
          {"expected_regret", by_cost->regret},
          {"rollouts_to_settle",
           by_cost->until_settled ? ordered_json(*by_cost->until_settled) : ordered_json()},
          {"prices", prices},
          {"next", NextToJson(by_cost->next)},
          {"turns", TurningToJson(by_cost->turning)}};
}

/// @pre it is no folder.
std::string WhyNoFolder(const fs::path& folder) {
  return fs::exists(folder) ? fmt::format("'{}' is a file; wanted a folder", folder.string())
                            : fmt::format("folder '{}' does not exist; make it", folder.string());
}

}  // namespace

ordered_json ToJson(const base::Failure& failure) {
  if (!failure) return nullptr;
  return {{"failure", base::ToString(failure.code)},
          {"subjects", failure.subjects},
          {"detail", failure.detail}};
}

ordered_json FailuresToJson(const std::map<base::Failure, int>& failures) {
  ordered_json list = ordered_json::array();
  for (const auto& [failure, count] : failures) {
    list.push_back({{"failure", base::ToString(failure.code)},
                    {"subjects", failure.subjects},
                    {"detail", failure.detail},
                    {"count", count}});
  }
  return list;
}

std::string OutcomeName(const imagination::Report& report) {
  switch (report.outcome) {
    case imagination::ImaginationOutcome::kRanked:
      return report.complete ? "ranked" : "ranked_at_deadline";
    case imagination::ImaginationOutcome::kClose:
      return "close";
    case imagination::ImaginationOutcome::kAllFailed:
      return "all_failed";
    case imagination::ImaginationOutcome::kUndecided:
      return "undecided";
    case imagination::ImaginationOutcome::kNoWorker:
      return "no_worker";
    case imagination::ImaginationOutcome::kNothingFinished:
      return "nothing_finished";
    case imagination::ImaginationOutcome::kCancelled:
      return "cancelled";
  }
  return "";
}

nlohmann::ordered_json ToJson(const imagination::Report& report) {
  ordered_json ranking = ordered_json::array();
  for (const imagination::Prediction& prediction : report.ranking) {
    ranking.push_back(RankedToJson(prediction));
  }
  return {
      {"outcome", OutcomeName(report)},
      {"complete", report.complete},
      {"recommended", report.recommended < 0 ? ordered_json() : ordered_json(report.recommended)},
      {"why", report.why},
      {"by_cost", ByCostToJson(report.by_cost)},
      {"caveats", report.caveats},
      {"ranking", ranking},
      {"seed", report.seed},
      {"simulated_seconds", report.simulated_seconds},
      {"rollouts_kept", report.kept.rollouts},
      {"wall_seconds", report.wall_seconds},
      {"real_time_factor",
       report.wall_seconds > 0.0 ? report.played_seconds() / report.wall_seconds : 0.0}};
}

nlohmann::ordered_json ToJson(const imagination::Report& report,
                              const imagination::Criteria& criteria) {
  const bool has_minimum = criteria.rule != imagination::RankingRule::kThesis;
  ordered_json json = ToJson(report);
  json["min_success"] = has_minimum ? ordered_json(criteria.min_success) : ordered_json();
  return json;
}

void RequireFolderOf(const std::string& path) {
  const fs::path folder = fs::absolute(path).parent_path();
  if (fs::is_directory(folder)) return;
  throw base::ConfigError(fmt::format("{}: cannot be written, {}", path, WhyNoFolder(folder)));
}

void RequireFolder(const std::string& option, const std::string& folder) {
  if (fs::is_directory(folder)) return;
  throw base::ConfigError(fmt::format("{}: {}", option, WhyNoFolder(folder)));
}

void WriteJson(const nlohmann::ordered_json& json, const std::string& path) {
  RequireFolderOf(path);
  // Names in files of others may be no UTF-8.
  const std::string text =
      json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
  base::ReplaceTextFile(path, text);
}

}  // namespace hires::reports
