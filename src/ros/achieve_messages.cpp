#include "hires/ros/achieve_messages.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "hires/ros/conversions.h"

namespace hires_ros {
namespace {

namespace evaluation = hires::evaluation;
namespace execution = hires::execution;

std::optional<double> Moment(double time) {
  return std::isnan(time) ? std::nullopt : std::optional<double>(time);
}

}  // namespace

hires::StepStatus ToMsg(const execution::StepStatus& status) {
  hires::StepStatus message;
  message.plan = static_cast<std::uint32_t>(status.plan);
  message.index = static_cast<std::uint32_t>(status.index);
  message.action = ToMsg(status.action);
  message.phase = static_cast<std::uint8_t>(status.phase);  // in the same order
  message.started = status.started.value_or(kNever);
  message.finished = status.finished.value_or(kNever);
  message.earliest_start = status.start.earliest;
  message.latest_start = status.start.latest;
  message.earliest_finish = status.finish.earliest;
  message.latest_finish = status.finish.latest;
  message.expected_start = status.expected_start;
  message.expected_finish = status.expected_finish;
  message.note = status.note;
  message.failure = ToMsg(status.failure);
  return message;
}

execution::StepStatus FromMsg(const hires::StepStatus& message) {
  execution::StepStatus step;
  step.plan = static_cast<int>(message.plan);
  step.index = static_cast<int>(message.index);
  step.action = FromMsg(message.action);
  step.phase = static_cast<execution::StepPhase>(
      std::min<std::uint8_t>(message.phase, hires::StepStatus::SKIPPED));  // in the same order
  step.started = Moment(message.started);
  step.finished = Moment(message.finished);
  step.start = {message.earliest_start, message.latest_start};
  step.finish = {message.earliest_finish, message.latest_finish};
  step.expected_start = message.expected_start;
  step.expected_finish = message.expected_finish;
  step.note = message.note;
  step.failure = FromMsg(message.failure);
  return step;
}

hires::ImaginationStatus ToMsg(const evaluation::ImaginedStep& step) {
  hires::ImaginationStatus message;
  message.plan = static_cast<std::uint32_t>(step.plan);
  message.step = static_cast<std::uint32_t>(step.step);
  message.action = ToMsg(step.action);
  message.requested = step.requested;
  message.answered = step.answered.value_or(kNever);
  message.dispatch = step.dispatch.value_or(kNever);
  message.deadline = step.deadline;
  message.wall_seconds = step.wall_seconds;
  message.simulated_seconds = step.simulated_seconds;
  const bool is_running = step.outcome == evaluation::ImaginedOutcome::kRunning;
  if (!is_running) message.outcome = ToString(step.outcome);
  for (const auto& prediction : step.predictions) message.predictions.push_back(ToMsg(prediction));
  message.recommended = step.recommended;
  message.why = step.why;
  return message;
}

evaluation::ImaginedStep FromMsg(const hires::ImaginationStatus& message) {
  evaluation::ImaginedStep step;
  step.plan = static_cast<int>(message.plan);
  step.step = static_cast<int>(message.step);
  step.action = FromMsg(message.action);
  step.requested = message.requested;
  step.answered = Moment(message.answered);
  step.dispatch = Moment(message.dispatch);
  step.deadline = message.deadline;
  step.wall_seconds = message.wall_seconds;
  step.simulated_seconds = message.simulated_seconds;
  step.outcome = evaluation::ParseImaginedOutcome(message.outcome);
  for (const hires::Prediction& prediction : message.predictions) {
    step.predictions.push_back(FromMsg(prediction));
  }
  step.recommended = message.recommended;
  step.why = message.why;
  return step;
}

}  // namespace hires_ros
