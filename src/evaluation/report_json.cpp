#include "hires/evaluation/report_json.h"

#include <fmt/format.h>

#include <fstream>

#include "hires/base/error.h"

namespace hires::evaluation {
namespace {

using nlohmann::ordered_json;

ordered_json ToJson(const imagination::Prediction& prediction) {
  const imagination::Evidence& e = prediction.evidence;
  ordered_json failures = ordered_json::object();
  for (const auto& [reason, count] : e.failures) failures[reason] = count;
  return {{"action", prediction.action.name},
          {"arguments", prediction.action.arguments},
          {"confidence", {{"pooled", e.confidence_pooled}, {"mean", e.confidence_mean}}},
          {"success",
           {{"share", e.success.share}, {"lower", e.success.lower}, {"upper", e.success.upper}}},
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
            {"p95", e.duration.p95}}},
          {"max_tilt", {{"p50", e.max_tilt.p50}, {"p95", e.max_tilt.p95}}},
          {"rollouts", e.num_rollouts},
          {"failures", failures}};
}

}  // namespace

std::string OutcomeName(const imagination::Report& report) {
  switch (report.outcome) {
    case imagination::ImaginationOutcome::kRanked:
      return report.complete ? "ranked" : "ranked_at_deadline";
    case imagination::ImaginationOutcome::kAllFailed:
      return "all_failed";
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
    ranking.push_back(ToJson(prediction));
  }
  return {
      {"outcome", OutcomeName(report)},
      {"recommended", report.recommended < 0 ? ordered_json() : ordered_json(report.recommended)},
      {"why", report.why},
      {"ranking", ranking},
      {"seed", report.seed},
      {"simulated_seconds", report.simulated_seconds},
      {"wall_seconds", report.wall_seconds},
      {"real_time_factor",
       report.wall_seconds > 0.0 ? report.simulated_seconds / report.wall_seconds : 0.0}};
}

void WriteJson(const nlohmann::ordered_json& json, const std::string& path) {
  std::ofstream file(path);
  file << json.dump(2) << '\n';
  if (!file.flush()) {
    throw base::ConfigError(fmt::format(
        "{}: cannot be written; check that its folder exists and may be written", path));
  }
}

}  // namespace hires::evaluation
