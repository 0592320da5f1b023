#include "reports/task/timeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/text.h"
#include "reports/text/report_table.h"

namespace hires::reports {
namespace {

constexpr std::size_t kLongestName = 58;  // characters in the text

TimelineBar BarOf(const loop::ImaginedStep& step, double begin, double end) {
  TimelineBar bar;
  bar.kind = TimelineBar::Kind::kImagination;
  bar.plan = step.plan;
  bar.index = step.step;
  bar.action = ToString(step.action);
  bar.outcome = ToString(step.outcome);
  bar.begin = step.requested - begin;
  bar.end = step.answered.value_or(end) - begin;
  if (std::isfinite(step.deadline)) bar.deadline = step.deadline - begin;
  if (step.dispatch) bar.dispatch = *step.dispatch - begin;
  bar.wall_seconds = step.wall_seconds;
  bar.simulated_seconds = step.simulated_seconds;
  bar.note = step.why;
  return bar;
}

TimelineBar BarOf(const execution::StepStatus& step, double begin, double end) {
  TimelineBar bar;
  bar.plan = step.plan;
  bar.index = step.index;
  bar.action = ToString(step.action);
  bar.outcome = loop::ToString(step.phase);
  bar.begin = *step.started - begin;
  bar.end = step.finished.value_or(end) - begin;
  bar.note = step.note;
  return bar;
}

/// A step that only has another one imagined; the imagination itself has a bar.
bool IsImagining(const execution::StepStatus& step) { return step.action.name == "imagine"; }

void SortByBegin(std::vector<TimelineBar>::iterator first,
                 std::vector<TimelineBar>::iterator last) {
  std::stable_sort(first, last,
                   [](const TimelineBar& a, const TimelineBar& b) { return a.begin < b.begin; });
}

bool IsImagined(const Timeline& timeline, const TimelineBar& step) {
  return std::any_of(timeline.bars.begin(), timeline.bars.end(), [&](const TimelineBar& bar) {
    return bar.kind == TimelineBar::Kind::kImagination && bar.plan == step.plan &&
           bar.index == step.index;
  });
}

std::string BarText(const TimelineBar& bar, double duration, int width) {
  const auto place = [&](double time) {
    const double share = duration > 0.0 ? std::clamp(time / duration, 0.0, 1.0) : 0.0;
    return static_cast<int>(std::lround(share * width));
  };
  const int first = std::min(place(bar.begin), width - 1);
  const int length = std::max(1, place(bar.end) - first);
  const char fill = bar.kind == TimelineBar::Kind::kImagination ? '~' : '#';
  return std::string(static_cast<std::size_t>(first), ' ') +
         std::string(static_cast<std::size_t>(length), fill) +
         std::string(static_cast<std::size_t>(std::max(0, width - first - length)), ' ');
}

std::string Cut(const std::string& text) {
  return text.size() <= kLongestName ? text : text.substr(0, kLongestName - 3) + "...";
}

std::string Quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string Seconds(const std::optional<double>& time) {
  return time ? fmt::format("{:.3f}", *time) : "";
}

std::string CsvLine(const TimelineBar& bar) {
  const bool is_step = bar.kind == TimelineBar::Kind::kStep;
  return fmt::format("{},{},{},{},{},{:.3f},{:.3f},{},{},{},{},{}\n",
                     is_step ? "step" : "imagination", bar.plan, bar.index, Quoted(bar.action),
                     Quoted(bar.outcome), bar.begin, bar.end, Seconds(bar.deadline),
                     Seconds(bar.dispatch), is_step ? "" : fmt::format("{:.3f}", bar.wall_seconds),
                     is_step ? "" : fmt::format("{:.3f}", bar.simulated_seconds), Quoted(bar.note));
}

std::string InTime(const loop::ImaginedStep& step) {
  if (!step.dispatch) return "never begun";
  if (!step.answered) return "no";
  return fmt::format("{:+.1f} s", *step.dispatch - *step.answered);
}

std::string Ratio(double part, double whole) {
  return whole > 0.0 ? fmt::format("{:.2f}", part / whole) : "";
}

int RolloutsOf(const loop::ImaginedStep& step) {
  int rollouts = 0;
  for (const auto& prediction : step.predictions) rollouts += prediction.evidence.num_rollouts;
  return rollouts;
}

}  // namespace

Timeline MakeTimeline(const loop::AchieveReport& report) {
  const loop::AchieveStatus& status = report.status;
  const double begin = loop::BeginOf(status);
  Timeline timeline;
  timeline.task = report.task;
  timeline.outcome = report.outcome;
  for (const loop::ImaginedStep& step : status.imaginations) {
    timeline.bars.push_back(BarOf(step, begin, status.now));
  }
  const auto num_imaginations = static_cast<std::ptrdiff_t>(timeline.bars.size());
  for (const execution::StepStatus& step : status.steps) {
    if (step.started && !IsImagining(step)) {
      timeline.bars.push_back(BarOf(step, begin, status.now));
    }
  }
  SortByBegin(timeline.bars.begin(), timeline.bars.begin() + num_imaginations);
  SortByBegin(timeline.bars.begin() + num_imaginations, timeline.bars.end());
  for (const TimelineBar& bar : timeline.bars) {
    timeline.duration = std::max(timeline.duration, bar.end);
  }
  return timeline;
}

std::string TimelineText(const Timeline& timeline, int width) {
  std::string text;
  for (const TimelineBar& bar : timeline.bars) {
    const bool is_imagination = bar.kind == TimelineBar::Kind::kImagination;
    const char mark = is_imagination ? '~' : IsImagined(timeline, bar) ? '>' : ' ';
    text += fmt::format("{} {:<{}} |{}| {:7.1f} .. {:7.1f} s  {}\n", mark, Cut(bar.action),
                        kLongestName, BarText(bar, timeline.duration, width), bar.begin, bar.end,
                        bar.outcome);
  }
  return text;
}

std::string ImaginationTable(const loop::AchieveReport& report, bool is_virtual) {
  const double duration = MakeTimeline(report).duration;
  if (report.status.imaginations.empty()) return "";
  // In virtual time imagining takes as long as config/loop.yaml says: there is nothing to measure.
  const std::string took = is_virtual ? "virtual" : "wall";
  std::vector<std::vector<std::string>> rows{{"imagined", "outcome", "rollouts", "simulated", took,
                                              is_virtual ? "as configured" : "factor",
                                              took + " / task", "before its step"}};
  for (const loop::ImaginedStep& step : report.status.imaginations) {
    rows.push_back({ToString(step.action), ToString(step.outcome), std::to_string(RolloutsOf(step)),
                    fmt::format("{:.1f} s", step.simulated_seconds),
                    fmt::format("{:.1f} s", step.wall_seconds),
                    Ratio(step.simulated_seconds, step.wall_seconds),
                    Ratio(step.wall_seconds, duration), InTime(step)});
  }
  return FormatTable(rows);
}

std::string TimelineCsv(const Timeline& timeline) {
  std::string csv =
      "kind,plan,index,action,outcome,begin,end,deadline,dispatch,wall_seconds,simulated_seconds,"
      "note\n";
  csv += fmt::format("task,,,{},{},0.000,{:.3f},,,,,\n", Quoted(timeline.task),
                     ToString(timeline.outcome), timeline.duration);
  for (const TimelineBar& bar : timeline.bars) csv += CsvLine(bar);
  return csv;
}

}  // namespace hires::reports
