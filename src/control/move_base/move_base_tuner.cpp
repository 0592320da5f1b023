#include "hires/control/move_base_tuner.h"

#include "hires/base/error.h"
#include "hires/base/log.h"

namespace hires::control {

using Phase = TunerState::Phase;
using base::LogLevel;

MoveBaseTuner::MoveBaseTuner(MotionSetKeeper keeper, std::chrono::milliseconds retry_period,
                             std::chrono::milliseconds farewell)
    : keeper_(std::move(keeper)),
      retry_period_(retry_period),
      farewell_(farewell),
      waiting_(Job{Kind::kRestore, 0, "", {}}),
      state_{Phase::kRestoring, 0, ""},
      thread_([this] { Run(); }) {}

MoveBaseTuner::~MoveBaseTuner() {
  {
    std::unique_lock<std::mutex> lock(mutex_);
    waiting_ = Job{Kind::kRestore, 0, "", {}};
    changed_.notify_all();
    changed_.wait_for(lock, farewell_, [this] { return !waiting_ && !is_working_; });
    is_ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void MoveBaseTuner::Apply(std::uint64_t request, const std::string& set_name,
                          const robot::MotionSet& set) {
  Post({Kind::kApply, request, set_name, set}, Phase::kApplying);
}

void MoveBaseTuner::Restore() { Post({Kind::kRestore, 0, "", {}}, Phase::kRestoring); }

void MoveBaseTuner::Post(Job job, Phase phase) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    state_ = {phase, job.request, ""};
    waiting_ = std::move(job);
  }
  changed_.notify_all();
}

void MoveBaseTuner::OnUpdate(const PlannerValues& values) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (state_.phase != Phase::kInForce || waiting_ || WhatDiffers(in_force_, values).empty()) {
      return;
    }
    waiting_ = Job{Kind::kVerify, state_.request, "", {}};
  }
  changed_.notify_all();
}

TunerState MoveBaseTuner::state() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return state_;
}

void MoveBaseTuner::Run() {
  while (const std::optional<Job> job = NextJob()) End(*job, WhyFailed(*job));
}

/// What is to be done next, or again; nothing at the end.
std::optional<MoveBaseTuner::Job> MoveBaseTuner::NextJob() {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto has_news = [this] { return is_ending_ || waiting_; };
  if (is_restore_owed_) {
    changed_.wait_for(lock, retry_period_, has_news);
  } else {
    changed_.wait(lock, has_news);
  }
  if (is_ending_) return std::nullopt;
  is_working_ = true;
  Job job = waiting_ ? std::move(*waiting_) : Job{Kind::kRestore, 0, "", {}, true};
  waiting_.reset();
  return job;
}

/// Does it; empty: it worked.
std::string MoveBaseTuner::WhyFailed(const Job& job) {
  try {
    if (job.kind == Kind::kApply) keeper_.Apply(job.set_name, job.set);
    if (job.kind == Kind::kRestore) keeper_.Restore();
    if (job.kind == Kind::kVerify) keeper_.Verify();
    return "";
  } catch (const base::ConfigError& error) {
    return error.what();
  }
}

void MoveBaseTuner::End(const Job& job, const std::string& why_failed) {
  const std::lock_guard<std::mutex> lock(mutex_);
  is_working_ = false;
  // An attempt to apply that failed may have left something too.
  is_restore_owed_ = !why_failed.empty() && job.kind != Kind::kVerify;
  in_force_ = keeper_.in_force();
  const TunerState now = StateAfter(job, why_failed);
  if (!now.reason.empty() && now.reason != state_.reason) {
    base::Log(LogLevel::kError, now.reason);
  }
  if (!waiting_) state_ = now;  // else another request came meanwhile
  changed_.notify_all();
}

TunerState MoveBaseTuner::StateAfter(const Job& job, const std::string& why_failed) const {
  // What failed for a request stays failed for it, though a repeated attempt tidies up after it.
  if (job.is_retry && state_.request != 0) return state_;
  if (!why_failed.empty()) return {Phase::kFailed, job.request, why_failed};
  if (job.kind == Kind::kRestore) return {};
  return {Phase::kInForce, job.request, ""};
}

}  // namespace hires::control
