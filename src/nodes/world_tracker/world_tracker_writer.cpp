#include "nodes/world_tracker/world_tracker_writer.h"

#include <fmt/format.h>
#include <hires/ObservationProgress.h>
#include <hires/RemoveFluents.h>
#include <hires/WriteFluents.h>

#include <chrono>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/process.h"
#include "hires/ros/knowledge/blackboard_messages.h"
#include "hires/ros/names/topic_names.h"

namespace hires_ros {
namespace {

namespace knowledge = hires::knowledge;
namespace translation = hires::translation;
using hires::base::Log;
using hires::base::LogLevel;
using Seconds = std::chrono::duration<double>;

constexpr double kRetryPeriod = 0.2;    // [s] while the Blackboard is away or refuses
constexpr double kWarningPeriod = 1.0;  // [s]

}  // namespace

ObservationWriter::ObservationWriter(const translation::TranslatorContext* context,
                                     const WorldTrackerParams& params, const ros::NodeHandle& nh,
                                     RemoteView::Listener on_view)
    : context_(context),
      params_(params),
      on_view_(std::move(on_view)),
      blackboard_(nh, std::string(kBlackboard) + "/"),
      progress_(ros::NodeHandle(nh).advertise<hires::ObservationProgress>(kObservationProgress, 10,
                                                                          true)),
      view_(nh, [this](const RemoteView::Update& update) { OnView(update); }),
      thread_([this] { Run(); }) {}

ObservationWriter::~ObservationWriter() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void ObservationWriter::OnView(const RemoteView::Update& update) {
  for (const knowledge::Change& change : update.changes) {
    if (change.source == knowledge::Source::kMonitor) episode_ = change.episode;
  }
  if (on_view_) on_view_(update);
}

void ObservationWriter::Post(double time, translation::ObservedWorld observed) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    posted_ = {time, std::move(observed)};
  }
  changed_.notify_all();
}

std::string ObservationWriter::last_failure() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return last_failure_;
}

translation::TranslatorContext ObservationWriter::ContextNow(
    const knowledge::FluentView& view) const {
  return translation::WithKnowledge(*context_, view);
}

void ObservationWriter::Run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!is_ending_) {
    changed_.wait(lock, [this] { return is_ending_ || posted_.has_value(); });
    if (is_ending_) return;
    const Posted posted = std::move(*posted_);
    posted_.reset();
    lock.unlock();
    const Written written = Write(posted.observed);
    if (written == Written::kAll) TellProgress(posted.time);
    lock.lock();
    // What could not be written waits, unless something newer has come.
    if (written == Written::kNotNow && !posted_) posted_ = posted;
    const Seconds pause(written == Written::kNotNow ? kRetryPeriod : params_.write_period);
    changed_.wait_for(lock, pause, [this] { return is_ending_; });
  }
}

/// Whether the Blackboard says now what was observed.
ObservationWriter::Written ObservationWriter::Write(const translation::ObservedWorld& observed) {
  if (!view_.is_known() && !view_.CatchUp()) return Written::kNotNow;
  translation::FluentUpdate update;
  try {
    update = view_.Read([&](const knowledge::FluentView& view) {
      return translation::ChangesFrom(ContextNow(view), view, observed, params_.changes);
    });
  } catch (const hires::base::ConfigError& error) {
    Fail(error.what());
    return Written::kNever;  // trying again makes it no better
  }
  if (update.empty()) return Written::kAll;
  const bool is_sent = Send(update);
  // Also after a refusal: the view may have been behind.
  const bool is_known = view_.CatchUp();
  return is_sent && is_known ? Written::kAll : Written::kNotNow;
}

/// The view has what was written, so that a view as new as this one has it, too.
void ObservationWriter::TellProgress(double time) {
  hires::ObservationProgress progress;
  progress.header.stamp.fromSec(time);
  progress.sequence = view_.sequence();
  progress_.publish(progress);
}

/// What is new comes before what ends, so that a hand is full before a place is empty, and no
/// reader sees an object without a place.
bool ObservationWriter::Send(const translation::FluentUpdate& update) {
  const knowledge::Assertion by{knowledge::Source::kObservation, episode_, 0.0};
  hires::WriteFluents add, replace;
  hires::RemoveFluents remove;
  add.request.by = replace.request.by = remove.request.by = ToMessage(by);
  add.request.fluents = ToMessages(update.added);
  replace.request.fluents = ToMessages(update.updated);
  remove.request.instances = update.removed;
  if (!update.added.empty() && !Call("add", &add)) return false;
  if (!update.updated.empty() && !Call("update", &replace)) return false;
  if (!update.removed.empty() && !Call("remove", &remove)) return false;
  num_written_ += add.response.changed + replace.response.changed + remove.response.changed;
  return true;
}

template <typename Service>
bool ObservationWriter::Call(const char* service, Service* call) {
  if (!blackboard_.Call(service, call)) {
    Fail(fmt::format("no service answers at '{}'", blackboard_.NameOf(service)));
    return false;
  }
  if (call->response.error.code == hires::BlackboardError::NONE) return true;
  // An episode that has ended takes nothing more, and what is seen just after its end is no fault.
  // It is told again without an episode; only what is wrong then, too, is worth a warning.
  std::int64_t episode = call->request.by.episode;
  const bool is_refused = call->response.error.code == hires::BlackboardError::REFUSED;
  if (is_refused && episode != 0) {
    episode_.compare_exchange_strong(episode, 0);  // the monitor may have named another meanwhile
    return false;
  }
  Fail(fmt::format("{}/{}: {}", kBlackboard, service, call->response.error.message));
  return false;
}

void ObservationWriter::Fail(const std::string& why) {
  ++num_failures_;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    last_failure_ = why;
  }
  if (hires::base::SteadyNow() - last_warning_ < kWarningPeriod) return;
  last_warning_ = hires::base::SteadyNow();
  Log(LogLevel::kWarn, fmt::format("observation=unwritten why={}", why));
}

}  // namespace hires_ros
