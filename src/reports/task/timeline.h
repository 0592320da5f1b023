#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "loop/achieve.h"

namespace hires::reports {

/// A stretch of time in which the robot did a step, or imagined one. Times are [s] after the task's
/// begin.
struct TimelineBar {
  enum class Kind { kStep, kImagination } kind{Kind::kStep};
  int plan{0}, index{0};  ///< of the step; of an imagination, of the step that it is about
  std::string action;     ///< "move_base_param(area1, slow)"; alternatives joined by |
  std::string outcome;    ///< of a step its phase
  double begin{0.0}, end{0.0};
  std::optional<double> deadline;  ///< of an imagination, where it has one
  std::optional<double> dispatch;  ///< of an imagination: when the step that it is about began
  double wall_seconds{0.0}, simulated_seconds{0.0};  ///< of an imagination
  std::string note;
};

/// What was done when, as the dissertation's Fig. 6.13.
struct Timeline {
  std::string task;
  loop::AchieveOutcome outcome{loop::AchieveOutcome::kFailed};
  double duration{0.0};           ///< [s] from the first bar's begin to the last one's end
  std::vector<TimelineBar> bars;  ///< imaginations first, each kind by its begin
};
Timeline MakeTimeline(const loop::AchieveReport& report);

/// Bars of characters, one line each, `width` characters for the whole duration. Imagined steps and
/// the steps that they are about are marked.
std::string TimelineText(const Timeline& timeline, int width = 48);

/// What the imaginations took, as the dissertation's Table 6.7: seconds simulated, seconds of the
/// wall's clock, and whether the answer came before the step began. "" where there were none.
/// @param is_virtual  the wall's seconds are virtual ones, as configured.
std::string ImaginationTable(const loop::AchieveReport& report, bool is_virtual = false);

/// Comma-separated values with a head; the first line is the task itself.
std::string TimelineCsv(const Timeline& timeline);

/// Everything for machines.
nlohmann::ordered_json ToJson(const loop::AchieveReport& report);

}  // namespace hires::reports
