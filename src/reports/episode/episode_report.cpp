#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/averages.h"
#include "hires/base/failure.h"
#include "hires/base/text.h"
#include "reports/episode/episode_compare.h"
#include "reports/text/report_json.h"
#include "reports/text/report_table.h"

namespace hires::reports {
namespace {

using nlohmann::ordered_json;

bool IsImagined(const ComparedStep& compared) {
  return compared.imagined.refusal.empty() && compared.imagined.evidence.num_rollouts > 0;
}

std::string NameOf(const EpisodeStep& step) {
  if (step.action.name.empty()) return step.motion;
  return base::ToString(step.action) + (step.motion.empty() ? "" : ": " + step.motion);
}

std::vector<std::string> ImaginedCells(const ComparedStep& compared) {
  if (!IsImagined(compared)) return {"", "", "", ""};
  const imagination::Evidence& e = compared.imagined.evidence;
  return {
      fmt::format("{:.0f} %", 100.0 * e.success.share),
      fmt::format("{:.0f} .. {:.0f} %", 100.0 * e.success.lower, 100.0 * e.success.upper),
      e.duration.mean > 0.0 ? fmt::format("{:.1f} ± {:.1f} s", e.duration.mean, e.duration.sd) : "",
      fmt::format("{}", e.num_rollouts)};
}

std::vector<std::string> RowOf(const ComparedStep& compared, std::size_t place) {
  const EpisodeStep& step = compared.step;
  std::vector<std::string> row{fmt::format("{}", place), NameOf(step)};
  for (std::string& cell : ImaginedCells(compared)) row.push_back(std::move(cell));
  row.push_back(step.failure ? ToString(step.failure) : ToString(step.fate));
  row.push_back(fmt::format("{:.1f} s", step.duration));
  row.push_back(compared.percentile ? fmt::format("{:.0f} %", *compared.percentile) : "");
  row.push_back(ToString(compared.verdict));
  return row;
}

/// What was played and did not succeed, where that is half of it or more; void rollouts always.
std::string FailuresOf(const imagination::Evidence& evidence) {
  const bool is_mostly = evidence.num_rollouts > 0 && evidence.success.share <= 0.5;
  std::vector<std::string> parts;
  for (const auto& [failure, count] : evidence.failures) {
    const bool is_void = failure.code == base::FailureCode::kPhysicsBroke;
    if (!is_mostly && !is_void) continue;
    parts.push_back(
        fmt::format("{} {} {}", count, is_void ? "void by" : "failed by", base::ToString(failure)));
  }
  return parts.empty() ? "" : "of its rollouts " + base::Join(parts, "; ");
}

/// "steps 1, 2: its result was not recorded"; what several have in common is said once.
std::string NotesOn(const std::vector<ComparedStep>& steps) {
  std::vector<std::pair<std::string, std::vector<std::string>>> notes;
  const auto add = [&](const std::string& note, std::size_t place) {
    if (note.empty()) return;
    auto same = std::find_if(notes.begin(), notes.end(),
                             [&](const auto& known) { return known.first == note; });
    if (same == notes.end()) same = notes.insert(same, {note, {}});
    same->second.push_back(std::to_string(place));
  };
  for (std::size_t i = 0; i < steps.size(); ++i) {
    add(steps[i].why, i + 1);
    add(FailuresOf(steps[i].imagined.evidence), i + 1);
  }
  std::string text;
  for (const auto& [note, places] : notes) {
    text += fmt::format("step{} {}: {}\n", places.size() > 1 ? "s" : "", base::Join(places, ", "),
                        note);
  }
  return text;
}

ordered_json ImaginedJson(const ComparedStep& compared) {
  if (!IsImagined(compared)) return nullptr;
  const imagination::Evidence& e = compared.imagined.evidence;
  return {{"success", e.success.share},       {"success_lower", e.success.lower},
          {"success_upper", e.success.upper}, {"action_failed_share", e.action_failed_share},
          {"fall_share", e.fall_share},       {"duration_mean", e.duration.mean},
          {"duration_sd", e.duration.sd},     {"duration_p50", e.duration.p50},
          {"duration_p95", e.duration.p95},   {"durations", e.durations},
          {"rollouts", e.num_rollouts},       {"failures", FailuresToJson(e.failures)}};
}

ordered_json StepJson(const ComparedStep& compared, std::size_t place) {
  const EpisodeStep& step = compared.step;
  ordered_json json{{"step", place},
                    {"action", step.action.name},
                    {"arguments", step.action.arguments},
                    {"motion", step.motion},
                    {"begin", step.begin},
                    {"happened", ToString(step.fate)},
                    {"failure", ToJson(step.failure)},
                    {"duration", step.duration},
                    {"imagined", ImaginedJson(compared)},
                    {"percentile", nullptr},
                    {"verdict", ToString(compared.verdict)},
                    {"why_not", compared.why}};
  if (compared.percentile) json["percentile"] = *compared.percentile;
  return json;
}

std::vector<double> DurationErrors(const std::vector<ComparedStep>& steps) {
  std::vector<double> errors;
  for (const ComparedStep& compared : steps) {
    if (compared.percentile) {
      errors.push_back(compared.step.duration - compared.imagined.evidence.duration.mean);
    }
  }
  return errors;
}

double MeanMagnitude(const std::vector<double>& values) {
  std::vector<double> magnitudes;
  for (const double value : values) magnitudes.push_back(std::abs(value));
  return base::Mean(magnitudes);
}

}  // namespace

std::string EpisodeTable(const std::vector<ComparedStep>& steps) {
  std::vector<std::vector<std::string>> rows{{"#", "step", "imagined", "95 % interval", "lasting",
                                              "n", "happened", "lasted", "percentile", "verdict"}};
  for (std::size_t i = 0; i < steps.size(); ++i) rows.push_back(RowOf(steps[i], i + 1));
  return FormatTable(rows) + NotesOn(steps);
}

std::string EpisodeSummary(const std::vector<ComparedStep>& steps) {
  std::map<StepVerdict, int> counts;
  for (const ComparedStep& compared : steps) ++counts[compared.verdict];
  std::string text = fmt::format("{} steps:", steps.size());
  const char* before = " ";
  for (const auto& [verdict, count] : counts) {
    text += fmt::format("{}{} {}", before, count, ToString(verdict));
    before = ", ";
  }
  const std::vector<double> errors = DurationErrors(steps);
  if (errors.empty()) return text + '\n';
  return text + fmt::format(
                    "\n{} durations: {:+.2f} s from what was imagined in the mean, {:.2f} s "
                    "in the mean of magnitudes\n",
                    errors.size(), base::Mean(errors), MeanMagnitude(errors));
}

ordered_json EpisodeJson(const std::vector<ComparedStep>& steps) {
  ordered_json all = ordered_json::array();
  for (std::size_t i = 0; i < steps.size(); ++i) all.push_back(StepJson(steps[i], i + 1));
  const std::vector<double> errors = DurationErrors(steps);
  return {{"steps", all},
          {"durations_compared", errors.size()},
          {"duration_error_mean", base::Mean(errors)},
          {"duration_error_magnitude", MeanMagnitude(errors)}};
}

}  // namespace hires::reports
