#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hires/execution/monitor.h"
#include "hires/imagination/report.h"

/// What the execution monitor is told of an imagination, wherever that ran.
namespace hires::imagination {

/// @param is_late  the request was cancelled because its time was over: what was found until then
///                 counts. A request that was cancelled otherwise has no answer.
/// @param things   names of what it rests on.
execution::ImagineAnswered AnswerOf(int request, const Report& report, bool is_late,
                                    const std::vector<std::string>& things);

/// When the step that was imagined began [s]. A step that a repair took over into a later plan,
/// where it has another number, is the first one there that does what was imagined.
/// @param plan, step  as of execution::StartImagination.
std::optional<double> DispatchOf(const std::vector<execution::StepStatus>& steps, int plan,
                                 int step, const base::ActionTemplate& action);

}  // namespace hires::imagination
