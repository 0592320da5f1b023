#include "nodes/execution_monitor/execution_imagination.h"

#include <ros/init.h>
#include <ros/service.h>

#include <cmath>
#include <limits>
#include <utility>

#include "hires/ros/names/topic_names.h"
#include "hires/ros/values/action_messages.h"
#include "nodes/execution_monitor/execution_messages.h"

namespace hires_ros {
namespace {

namespace execution = hires::execution;
using Outcome = execution::ImagineAnswered::Outcome;

constexpr double kRetryPeriod = 0.05;      // [s] between two tries to reach the translator
constexpr double kTranslationLimit = 5.0;  // times the wait for a server: then it hangs

hires::ImaginationStatus StatusOf(const execution::StartImagination& command, double now) {
  hires::ImaginationStatus status;
  status.plan = static_cast<std::uint32_t>(command.plan);
  status.step = static_cast<std::uint32_t>(command.step);
  status.action = ToMsg(command.action);
  status.requested = now;
  status.answered = kNever;
  status.dispatch = kNever;
  status.deadline = command.deadline;
  status.recommended = -1;
  return status;
}

/// What was played, in numbers for people; the final states are left out, as no reader needs them
/// there.
void SetPlayed(const hires::ImagineResult& result, hires::ImaginationStatus* status) {
  status->wall_seconds = result.wall_seconds;
  status->simulated_seconds = result.simulated_seconds - result.simulated_seconds_kept;
  status->predictions = result.predictions;
  for (hires::Prediction& prediction : status->predictions) {
    prediction.final_world = {};
    prediction.final_robot = {};
  }
}

}  // namespace

ImagineRequests::ImagineRequests(const execution::ImaginingParams& imagining,
                                 const ActionLinkParams& params, ros::NodeHandle* nh, Post post,
                                 OnAnswer on_answer)
    : imagining_(imagining),
      params_(params),
      post_(post),
      on_answer_(std::move(on_answer)),
      link_(kImagineAction, params, nh, std::move(post),
            [this](int key, const hires::ImagineResultConstPtr& result, int,
                   const std::string& why) { OnEnd(key, result, why); }),
      translator_state_(std::make_shared<TranslatorState>()) {}

ImagineRequests::~ImagineRequests() { translator_state_->is_ending = true; }

void ImagineRequests::Start(const execution::StartImagination& command, double now) {
  const int key = next_key_++;
  Request& request = requests_[key];
  request.command = command;
  request.status = StatusOf(command, now);
  request.asked = hires::base::SteadyNow();
  Translate(key, command);
}

/// The translator may be away for a moment; its thread waits for it, nobody else does.
void ImagineRequests::Translate(int key, const execution::StartImagination& command) {
  hires::GenerateImagineState call;
  call.request.is_whole_state = true;
  for (const auto& atom : command.state) call.request.updated_fluents.push_back(ToMsg(atom));
  const double give_up = hires::base::SteadyNow() + params_.server_wait;
  translator_.Post([this, key, call, give_up, shared = translator_state_]() mutable {
    bool is_answered = shared->services.Call(kGenerateImagineState, &call);
    while (!is_answered && hires::base::SteadyNow() < give_up && !shared->is_ending && ros::ok()) {
      ros::WallDuration(kRetryPeriod).sleep();
      is_answered = shared->services.Call(kGenerateImagineState, &call);
    }
    shared->is_available = is_answered;
    post_(
        [this, key, is_answered, state = call.response] { OnTranslated(key, is_answered, state); });
  });
}

void ImagineRequests::OnTranslated(int key, bool is_answered, const State& state) {
  const auto found = requests_.find(key);
  if (found == requests_.end() || found->second.is_translated) return;
  if (!is_answered) return Refuse(key, Outcome::kUnavailable, "the translator does not answer");
  if (!state.error.empty()) return Refuse(key, Outcome::kInvalid, state.error);
  Request& request = found->second;
  request.state = state;
  request.is_translated = true;
  link_.Send(key, GoalOf(request.command, state, imagining_));
}

void ImagineRequests::Move(const execution::MoveDeadline& command) {
  const auto found = requests_.find(KeyOf(command.request));
  if (found == requests_.end()) return;  // answered just now
  found->second.command.deadline = command.deadline;
  found->second.status.deadline = command.deadline;
}

void ImagineRequests::Cancel(const execution::CancelImagination& command, double now) {
  const int key = KeyOf(command.request);
  if (key == kNone) return;
  Finish(key, "cancelled", now);
  link_.Cancel(key);
}

void ImagineRequests::CancelAll(double now) {
  while (!requests_.empty()) Cancel({requests_.begin()->second.command.request}, now);
}

void ImagineRequests::Tick(double now) {
  link_.Tick();
  for (const int key : Overdue(now)) {
    Request& request = requests_.at(key);
    if (!request.is_translated) {
      Refuse(key, Outcome::kNothingFinished, "its time was over before the state was translated");
    } else {
      request.is_late = true;
      link_.Cancel(key);
    }
  }
  for (const int key : Stuck()) {
    translator_state_->is_available = false;
    Refuse(key, Outcome::kUnavailable, "the translator hangs");
  }
}

/// Those that the translator should have answered long ago.
std::vector<int> ImagineRequests::Stuck() const {
  const double latest = hires::base::SteadyNow() - kTranslationLimit * params_.server_wait;
  std::vector<int> keys;
  for (const auto& [key, request] : requests_) {
    if (!request.is_translated && request.asked < latest) keys.push_back(key);
  }
  return keys;
}

std::vector<int> ImagineRequests::Overdue(double now) const {
  std::vector<int> keys;
  for (const auto& [key, request] : requests_) {
    if (!request.is_late && now >= request.command.deadline) keys.push_back(key);
  }
  return keys;
}

void ImagineRequests::OnEnd(int key, const hires::ImagineResultConstPtr& result,
                            const std::string& why) {
  const auto found = requests_.find(key);
  if (found == requests_.end()) return OnCancelled(key, result);
  Request& request = found->second;
  if (!result) {
    return Refuse(key, request.is_late ? Outcome::kNothingFinished : Outcome::kUnavailable, why);
  }
  SetPlayed(*result, &request.status);
  request.status.recommended = result->recommended;
  request.status.why = result->why;
  Answer(key, AnswerOf(request.command.request, *result, request.state, request.is_late));
}

/// Nobody wants the answer; what was played for it was played all the same.
void ImagineRequests::OnCancelled(int key, const hires::ImagineResultConstPtr& result) {
  const auto finished = finished_.find(key);
  if (result && finished != finished_.end()) SetPlayed(*result, &finished->second);
}

void ImagineRequests::Refuse(int key, Outcome outcome, const std::string& why) {
  execution::ImagineAnswered answer;
  answer.request = requests_.at(key).command.request;
  answer.outcome = outcome;
  answer.why = why;
  Answer(key, answer);
}

void ImagineRequests::Answer(int key, const execution::ImagineAnswered& answer) {
  hires::ImaginationStatus& status = requests_.at(key).status;
  if (status.why.empty()) status.why = answer.why;
  Finish(key, OutcomeName(answer.outcome), ros::Time::now().toSec());
  on_answer_(answer);
}

void ImagineRequests::Finish(int key, const std::string& outcome, double now) {
  hires::ImaginationStatus status = std::move(requests_.at(key).status);
  requests_.erase(key);
  status.answered = now;
  status.outcome = outcome;
  finished_[key] = std::move(status);
}

std::vector<hires::ImaginationStatus> ImagineRequests::Statuses() const {
  std::map<int, hires::ImaginationStatus> all = finished_;
  for (const auto& [key, request] : requests_) all[key] = request.status;
  std::vector<hires::ImaginationStatus> statuses;
  for (auto& [key, status] : all) statuses.push_back(std::move(status));
  return statuses;
}

int ImagineRequests::KeyOf(int request) const {
  for (const auto& [key, value] : requests_) {
    if (value.command.request == request) return key;
  }
  return kNone;
}

}  // namespace hires_ros
