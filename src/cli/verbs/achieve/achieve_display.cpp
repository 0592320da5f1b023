#include "cli/verbs/achieve/achieve_display.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hires/base/text.h"
#include "reports/text/report_table.h"

namespace hires::cli {
namespace {

using execution::StepPhase;
using execution::StepStatus;

constexpr char kClearLine[] = "\033[K";

std::string Seconds(double time) { return std::isfinite(time) ? fmt::format("{:.1f}", time) : ""; }

bool IsNews(const StepStatus& step) {
  return step.phase != StepPhase::kSkipped || step.started.has_value();
}

/// When it came into its phase, "" where that is not known.
std::string Since(const StepStatus& step, double begin) {
  if (step.finished) return Seconds(*step.finished - begin);
  if (step.started) return Seconds(*step.started - begin);
  return "";
}

std::string ExpectedEnd(const StepStatus& step, double begin) {
  return step.finished ? "" : Seconds(step.expected_finish - begin);
}

/// Of a dry run: what the robot would do, and not what was thought about it.
bool IsToBegin(const StepStatus& step) {
  return step.phase == StepPhase::kWaiting || step.phase == StepPhase::kReady;
}

const StepStatus* Find(const loop::AchieveStatus& status, const StepStatus& step) {
  for (const StepStatus& other : status.steps) {
    if (other.plan == step.plan && other.index == step.index) return &other;
  }
  return nullptr;
}

std::string NoteOf(const StepStatus& step) { return step.note.empty() ? "" : ": " + step.note; }

std::string StepLine(const StepStatus& step, double now, double begin) {
  double time = now;
  if (step.started && step.phase == StepPhase::kRunning) time = *step.started;
  if (step.finished) time = *step.finished;
  return fmt::format("{:8.1f} s  {:<8}  {}{}", time - begin, loop::ToString(step.phase),
                     ToString(step.action), NoteOf(step));
}

std::string ImaginedLine(const loop::ImaginedStep& step, double now, double begin) {
  const std::string what = ToString(step.action);
  if (step.outcome == loop::ImaginedOutcome::kRunning) {
    return fmt::format("{:8.1f} s  imagines  {}", step.requested - begin, what);
  }
  return fmt::format("{:8.1f} s  imagined  {}: {}{}", step.answered.value_or(now) - begin, what,
                     ToString(step.outcome), step.why.empty() ? "" : ": " + step.why);
}

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines = base::Split(text, '\n');
  while (!lines.empty() && lines.back().empty()) lines.pop_back();
  return lines;
}

std::vector<std::string> NewWarnings(const loop::AchieveStatus& before,
                                     const loop::AchieveStatus& after, double begin) {
  std::vector<std::string> lines;
  for (std::size_t i = before.warnings.size(); i < after.warnings.size(); ++i) {
    lines.push_back(fmt::format("{:8.1f} s  warning   {}", after.now - begin, after.warnings[i]));
  }
  return lines;
}

}  // namespace

std::string StepTable(const loop::AchieveStatus& status, double begin) {
  std::vector<std::vector<std::string>> rows{
      {"plan", "#", "state", "since", "end", "step", "note"}};
  for (const StepStatus& step : status.steps) {
    if (!IsNews(step)) continue;
    rows.push_back({std::to_string(step.plan + 1), std::to_string(step.index + 1),
                    loop::ToString(step.phase), Since(step, begin), ExpectedEnd(step, begin),
                    ToString(step.action), step.note});
  }
  return reports::FormatTable(rows);
}

std::string DryRunTable(const loop::AchieveStatus& status) {
  int last_plan = 0;
  for (const StepStatus& step : status.steps) last_plan = std::max(last_plan, step.plan);
  std::optional<double> begin;
  std::vector<std::vector<std::string>> rows{{"#", "step", "would begin", "would end", "expected"}};
  for (const StepStatus& step : status.steps) {
    if (step.plan != last_plan || !IsToBegin(step)) continue;
    if (!begin) begin = step.expected_start;
    rows.push_back({std::to_string(step.index + 1), ToString(step.action),
                    Seconds(step.expected_start - *begin), Seconds(step.expected_finish - *begin),
                    step.note});
  }
  return reports::FormatTable(rows);
}

std::vector<std::string> ChangeLines(const loop::AchieveStatus& before,
                                     const loop::AchieveStatus& after, double begin) {
  std::vector<std::string> lines = NewWarnings(before, after, begin);
  for (std::size_t i = 0; i < after.imaginations.size(); ++i) {
    const loop::ImaginedStep& step = after.imaginations[i];
    if (i < before.imaginations.size() && before.imaginations[i].outcome == step.outcome) continue;
    lines.push_back(ImaginedLine(step, after.now, begin));
  }
  for (const StepStatus& step : after.steps) {
    const StepStatus* known = Find(before, step);
    const bool is_quiet = step.phase == StepPhase::kWaiting || step.phase == StepPhase::kReady;
    if (!IsNews(step) || (known == nullptr && is_quiet && step.note.empty())) continue;
    if (known != nullptr && (known->phase == step.phase || is_quiet) && known->note == step.note) {
      continue;
    }
    lines.push_back(StepLine(step, after.now, begin));
  }
  return lines;
}

std::string AchieveDisplay::Show(const loop::AchieveStatus& status) {
  if (!begin_) begin_ = loop::BeginOf(status);
  std::string text;
  if (width_ > 0) {
    text = Redraw(status);
  } else {
    for (const std::string& line : ChangeLines(shown_, status, *begin_)) text += line + "\n";
  }
  shown_ = status;
  return text;
}

/// Warnings stay above, the table is drawn over the last one.
std::string AchieveDisplay::Redraw(const loop::AchieveStatus& status) {
  std::string text = lines_drawn_ > 0 ? fmt::format("\033[{}A\r", lines_drawn_) : "";
  for (const std::string& line : NewWarnings(shown_, status, *begin_)) {
    text += line + kClearLine + "\n";
  }
  const std::vector<std::string> lines = Lines(StepTable(status, *begin_));
  for (const std::string& line : lines) {
    text += line.substr(0, static_cast<std::size_t>(width_)) + kClearLine + "\n";
  }
  lines_drawn_ = static_cast<int>(lines.size());
  return text + "\033[J";
}

}  // namespace hires::cli
