#include "hires/ros/knowledge/remote_view.h"

#include <fmt/format.h>
#include <hires/ChangesSince.h>
#include <hires/QueryFluents.h>

#include <utility>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/ros/knowledge/blackboard_messages.h"
#include "hires/ros/names/topic_names.h"

namespace hires_ros {
namespace {

namespace knowledge = hires::knowledge;
using hires::base::Log;
using hires::base::LogLevel;

constexpr std::uint32_t kPage = 10'000;        // fluents or changes
constexpr std::uint32_t kMessageQueue = 1000;  // what is dropped beyond is asked for

/// False if nobody answers, or not with what was asked for.
template <typename Service>
bool Ask(ServiceLinks* blackboard, const char* service, Service* call) {
  if (!blackboard->Ask(service, call)) return false;
  if (call->response.error.code == hires::BlackboardError::NONE) return true;
  Log(LogLevel::kWarn, fmt::format("service={} error={}", blackboard->NameOf(service),
                                   call->response.error.message));
  return false;
}

}  // namespace

RemoteView::RemoteView(const ros::NodeHandle& nh, Listener listener, double check_period)
    : listener_(std::move(listener)),
      view_(std::vector<knowledge::Fluent>(), 0),
      blackboard_(nh, std::string(kBlackboard) + "/"),
      nh_(nh),
      spinner_(1, &queue_) {
  nh_.setCallbackQueue(&queue_);
  subscriber_ = nh_.subscribe(kBlackboardChanges, kMessageQueue, &RemoteView::OnMessage, this,
                              ros::TransportHints().tcpNoDelay());
  const auto check = [this](const ros::SteadyTimerEvent&) { CatchUp(); };
  timer_ = nh_.createSteadyTimer(ros::WallDuration(check_period), check);
  const auto first = [this](const ros::SteadyTimerEvent&) { CatchUp(); };
  first_timer_ = nh_.createSteadyTimer(ros::WallDuration(1e-3), first, true);
  spinner_.start();
}

RemoteView::~RemoteView() {
  timer_.stop();
  first_timer_.stop();
  subscriber_.shutdown();
  spinner_.stop();
}

bool RemoteView::CatchUp() {
  const std::lock_guard<std::mutex> lock(synchronising_);
  return Synchronise();
}

void RemoteView::OnMessage(const hires::FluentChangesConstPtr& message) {
  const std::lock_guard<std::mutex> lock(synchronising_);
  if (!is_known_ || message->previous > sequence_) {
    Synchronise();  // this message is among what was missed
    return;
  }
  if (message->last_sequence > sequence_) Take(*message);
}

/// Asks how far the Blackboard is, which costs it next to nothing, and then for what is missing.
bool RemoteView::Synchronise() {
  hires::QueryFluents question;
  question.request.query.limit = 1;
  is_connected_ = Ask(&blackboard_, "query", &question);
  if (!is_connected_) return false;
  const std::uint64_t theirs = question.response.sequence;
  if (is_known_ && theirs == sequence_) return true;
  // Fewer changes than we know of: another store took its place.
  is_connected_ = is_known_ && theirs > sequence_ ? LoadMissed() : LoadAll();
  return is_connected_;
}

bool RemoteView::LoadAll() {
  std::vector<knowledge::Fluent> fluents;
  hires::QueryFluents page;
  page.request.query.limit = kPage;
  std::uint64_t sequence = 0;
  do {
    page.request.query.cursor = page.response.next;
    page.response = {};
    if (!Ask(&blackboard_, "query", &page)) return false;
    if (fluents.empty()) sequence = page.response.sequence;
    for (knowledge::Fluent& fluent : FromMessages(page.response.fluents)) {
      fluents.push_back(std::move(fluent));
    }
  } while (!page.response.next.empty());
  {
    const std::unique_lock<std::shared_mutex> lock(view_mutex_);
    view_ = knowledge::LiveView(std::move(fluents), sequence);
    sequence_ = sequence;  // never behind what the view shows
  }
  is_known_ = true;
  Tell({true, {}, sequence});
  return true;
}

bool RemoteView::LoadMissed() {
  hires::ChangesSince call;
  do {
    call.request.sequence = sequence_;
    call.request.limit = kPage;
    call.response = {};
    if (!Ask(&blackboard_, "changes_since", &call)) return false;
    for (const hires::FluentChanges& message : call.response.messages) Take(message);
  } while (call.response.more);
  return true;
}

void RemoteView::Take(const hires::FluentChanges& message) {
  Update update;
  for (const hires::FluentChange& change : message.changes) {
    if (!change.imagined && change.sequence > sequence_) {
      update.changes.push_back(FromMessage(change));
    }
  }
  {
    const std::unique_lock<std::shared_mutex> lock(view_mutex_);
    for (const knowledge::Change& change : update.changes) view_.Apply(change);
    sequence_ = message.last_sequence;
  }
  update.sequence = message.last_sequence;
  Tell(std::move(update));
}

void RemoteView::Tell(Update update) {
  if (listener_) listener_(update);
}

}  // namespace hires_ros
