#include "python/answer.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "reports/text/report_json.h"

namespace hires::python {

std::string JsonOf(const Answer& answer) {
  return reports::ToJson(answer.report, answer.criteria).dump(2);
}

std::map<std::string, int> FailuresOf(const imagination::Prediction& prediction) {
  std::map<std::string, int> failures;
  for (const auto& [failure, count] : prediction.evidence.failures) {
    failures[base::ToString(failure)] += count;
  }
  return failures;
}

std::string TextOf(const imagination::Prediction& prediction) {
  const imagination::Evidence& e = prediction.evidence;
  return fmt::format("{}: {:.1f} % of {} ({:.0f} .. {:.0f} %), {}",
                     base::ToString(prediction.action), 100.0 * e.success.share, e.num_rollouts,
                     100.0 * e.success.lower, 100.0 * e.success.upper,
                     e.durations.empty() ? "never ends" : fmt::format("{:.1f} s", e.duration.mean));
}

std::vector<std::pair<double, std::string>> EventsOf(
    const imagination::RolloutRecording& recording) {
  std::vector<std::pair<double, std::string>> events;
  for (const imagination::RolloutEvent& event : recording.events) {
    events.emplace_back(event.time, event.text);
  }
  return events;
}

std::string FailureTextOf(const imagination::RolloutRecording& recording) {
  return base::ToString(imagination::FailureOf(recording.result));
}

}  // namespace hires::python
