#include "hires/ros/execution/step_messages.h"

#include <algorithm>
#include <cmath>

#include "hires/ros/values/action_messages.h"
#include "hires/ros/values/failure_messages.h"

namespace hires_ros {
namespace {

namespace execution = hires::execution;

}  // namespace

std::optional<double> MomentOf(double time) {
  return std::isnan(time) ? std::nullopt : std::optional<double>(time);
}

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
  step.started = MomentOf(message.started);
  step.finished = MomentOf(message.finished);
  step.start = {message.earliest_start, message.latest_start};
  step.finish = {message.earliest_finish, message.latest_finish};
  step.expected_start = message.expected_start;
  step.expected_finish = message.expected_finish;
  step.note = message.note;
  step.failure = FromMsg(message.failure);
  return step;
}

}  // namespace hires_ros
