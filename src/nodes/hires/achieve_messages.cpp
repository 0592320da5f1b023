#include "nodes/hires/achieve_messages.h"

#include "hires/ros/answer/report_messages.h"
#include "hires/ros/execution/step_messages.h"
#include "hires/ros/values/action_messages.h"

namespace hires_ros {
namespace {

namespace loop = hires::loop;

}  // namespace

hires::ImaginationStatus ToMsg(const loop::ImaginedStep& step) {
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
  const bool is_running = step.outcome == loop::ImaginedOutcome::kRunning;
  if (!is_running) message.outcome = ToString(step.outcome);
  for (const auto& prediction : step.predictions) message.predictions.push_back(ToMsg(prediction));
  message.recommended = step.recommended;
  message.why = step.why;
  return message;
}

loop::ImaginedStep FromMsg(const hires::ImaginationStatus& message) {
  loop::ImaginedStep step;
  step.plan = static_cast<int>(message.plan);
  step.step = static_cast<int>(message.step);
  step.action = FromMsg(message.action);
  step.requested = message.requested;
  step.answered = MomentOf(message.answered);
  step.dispatch = MomentOf(message.dispatch);
  step.deadline = message.deadline;
  step.wall_seconds = message.wall_seconds;
  step.simulated_seconds = message.simulated_seconds;
  step.outcome = loop::ParseImaginedOutcome(message.outcome);
  for (const hires::Prediction& prediction : message.predictions) {
    step.predictions.push_back(FromMsg(prediction));
  }
  step.recommended = message.recommended;
  step.why = message.why;
  return step;
}

}  // namespace hires_ros
