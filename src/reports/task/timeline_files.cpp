#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "reports/task/timeline.h"
#include "reports/text/known_number.h"
#include "reports/text/report_json.h"

namespace hires::reports {
namespace {

using nlohmann::ordered_json;

ordered_json StepToJson(const execution::StepStatus& step) {
  return {{"plan", step.plan},
          {"index", step.index},
          {"action", step.action.name},
          {"arguments", step.action.arguments},
          {"phase", loop::ToString(step.phase)},
          {"started", NumberOrNull(step.started)},
          {"finished", NumberOrNull(step.finished)},
          {"earliest_start", NumberOrNull(step.start.earliest)},
          {"latest_start", NumberOrNull(step.start.latest)},
          {"earliest_finish", NumberOrNull(step.finish.earliest)},
          {"latest_finish", NumberOrNull(step.finish.latest)},
          {"expected_start", NumberOrNull(step.expected_start)},
          {"expected_finish", NumberOrNull(step.expected_finish)},
          {"note", step.note},
          {"failure", ToJson(step.failure)}};
}

ordered_json PredictionToJson(const imagination::Prediction& prediction) {
  const imagination::Evidence& evidence = prediction.evidence;
  return {{"action", prediction.action.name},
          {"arguments", prediction.action.arguments},
          {"rollouts", evidence.num_rollouts},
          {"success", evidence.success.share},
          {"success_lower", evidence.success.lower},
          {"success_upper", evidence.success.upper},
          {"confidence_mean", evidence.confidence_mean},
          {"confidence_pooled", evidence.confidence_pooled},
          {"falls", evidence.falls},
          {"duration_mean", evidence.duration.mean},
          {"duration_sd", evidence.duration.sd},
          {"failures", FailuresToJson(evidence.failures)}};
}

ordered_json ImaginedToJson(const loop::ImaginedStep& step) {
  ordered_json predictions = ordered_json::array();
  for (const auto& prediction : step.predictions) {
    predictions.push_back(PredictionToJson(prediction));
  }
  return {{"plan", step.plan},
          {"step", step.step},
          {"action", step.action.name},
          {"alternatives", step.action.alternatives},
          {"requested", step.requested},
          {"answered", NumberOrNull(step.answered)},
          {"dispatch", NumberOrNull(step.dispatch)},
          {"deadline", NumberOrNull(step.deadline)},
          {"wall_seconds", step.wall_seconds},
          {"simulated_seconds", step.simulated_seconds},
          {"outcome", ToString(step.outcome)},
          {"recommended", step.recommended},
          {"predictions", predictions},
          {"why", step.why}};
}

ordered_json BarToJson(const TimelineBar& bar) {
  const bool is_step = bar.kind == TimelineBar::Kind::kStep;
  return {{"kind", is_step ? "step" : "imagination"},
          {"plan", bar.plan},
          {"index", bar.index},
          {"action", bar.action},
          {"outcome", bar.outcome},
          {"begin", bar.begin},
          {"end", bar.end},
          {"dispatch", NumberOrNull(bar.dispatch)},
          {"note", bar.note}};
}

}  // namespace

ordered_json ToJson(const loop::AchieveReport& report) {
  ordered_json steps = ordered_json::array(), imaginations = ordered_json::array();
  ordered_json bars = ordered_json::array();
  const Timeline timeline = MakeTimeline(report);
  for (const TimelineBar& bar : timeline.bars) bars.push_back(BarToJson(bar));
  for (const auto& step : report.status.steps) steps.push_back(StepToJson(step));
  for (const auto& step : report.status.imaginations) imaginations.push_back(ImaginedToJson(step));
  return {{"task", report.task},
          {"outcome", ToString(report.outcome)},
          {"reason", report.reason},
          {"failure", ToJson(report.failure)},
          {"episode", report.episode},
          {"replans", report.status.replans},
          {"duration", timeline.duration},
          {"begin", loop::BeginOf(report.status)},
          {"steps", steps},
          {"imaginations", imaginations},
          {"timeline", bars},
          {"warnings", report.status.warnings}};
}

}  // namespace hires::reports
