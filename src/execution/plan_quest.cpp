#include "execution/plan_quest.h"

#include <fmt/format.h>

#include <algorithm>

namespace hires::execution {
namespace {

constexpr double kRetryPeriod = 1.0;  // [s] between two looks for a planner that is not there

}  // namespace

void PlanQuest::Begin(std::vector<Try> tries, const Facts& state) {
  Cancel();
  tries_ = std::move(tries);
  state_ = state.Atoms();
  at_ = 0;
  is_under_way_ = true;
  outcome_ = Outcome::kAsking;
  why_.clear();
  unavailable_.reset();
  was_slow_ = false;
  Ask();
}

void PlanQuest::Cancel() {
  if (request_ != 0) session_.outbox().Send(CancelPlanning{request_});
  request_ = 0;
  retry_.reset();
  is_under_way_ = false;
}

void PlanQuest::Ask() {
  request_ = session_.outbox().NewRequest();
  asked_ = session_.now();
  retry_.reset();
  session_.outbox().Send(
      StartPlanning{request_, tries_[at_].tasks, state_, session_.exclusions().Atoms()});
}

void PlanQuest::End(Outcome outcome, const std::string& why) {
  is_under_way_ = false;
  outcome_ = outcome;
  why_ = why;
}

void PlanQuest::OnAnswer(const PlanArrived& answer) {
  if (request_ == 0 || answer.request != request_) return;
  request_ = 0;
  if (answer.outcome == PlanArrived::Outcome::kUnavailable) {
    if (!unavailable_) unavailable_ = asked_;
    retry_ = session_.now() + kRetryPeriod;
    why_ = answer.why;
    return Update();
  }
  unavailable_.reset();
  if (answer.outcome != PlanArrived::Outcome::kFound) return Next(answer);
  plan_ = answer.plan;
  End(Outcome::kFound, answer.why);
}

/// The next try changes more of the plan.
void PlanQuest::Next(const PlanArrived& answer) {
  if (at_ + 1 < tries_.size()) {
    ++at_;
    return Ask();
  }
  const bool is_none = answer.outcome == PlanArrived::Outcome::kNoPlan;
  End(is_none ? Outcome::kNoPlan : Outcome::kFailed,
      answer.why.empty() ? "there is no plan" : answer.why);
}

void PlanQuest::Update() {
  const double patience = session_.params().planning_timeout;
  if (unavailable_ && session_.now() >= *unavailable_ + patience) {
    retry_.reset();
    return End(Outcome::kFailed, fmt::format("there was no planner for {} s: {}", patience, why_));
  }
  if (retry_ && session_.now() >= *retry_) return Ask();
  if (request_ == 0 || session_.now() < asked_ + patience) return;
  session_.outbox().Send(CancelPlanning{request_});
  request_ = 0;
  if (was_slow_) {
    return End(Outcome::kFailed,
               fmt::format("the planner did not answer within {} s, twice", patience));
  }
  was_slow_ = true;
  session_.outbox().Warning(
      fmt::format("the planner has not answered for {} s; it is asked once more", patience));
  Ask();
}

std::optional<double> PlanQuest::WakeAt() const {
  if (!is_under_way_) return std::nullopt;
  const double patience = session_.params().planning_timeout;
  if (request_ != 0) {
    const double slow = asked_ + patience;
    return unavailable_ ? std::min(slow, *unavailable_ + patience) : slow;
  }
  if (!retry_) return std::nullopt;
  return unavailable_ ? std::min(*retry_, *unavailable_ + patience) : *retry_;
}

}  // namespace hires::execution
