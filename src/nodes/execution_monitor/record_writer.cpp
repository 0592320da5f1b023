#include "nodes/execution_monitor/record_writer.h"

#include <fmt/format.h>
#include <hires/FinishEpisode.h>
#include <hires/RemoveFluents.h>
#include <hires/StartEpisode.h>
#include <hires/WriteFluents.h>
#include <ros/service.h>

#include <chrono>
#include <cmath>
#include <utility>

#include "hires/base/log.h"
#include "hires/ros/knowledge/blackboard_messages.h"
#include "hires/ros/names/topic_names.h"

namespace hires_ros {
namespace {

namespace execution = hires::execution;
namespace knowledge = hires::knowledge;
using hires::base::Log;
using hires::base::LogLevel;

constexpr double kPause = 0.2;  // [s] before the Blackboard is tried again

}  // namespace

RecordWriter::RecordWriter(std::shared_ptr<const knowledge::Ontology> ontology)
    : ontology_(std::move(ontology)),
      blackboard_(ros::NodeHandle(), std::string(kBlackboard) + "/"),
      thread_([this] { Run(); }) {}

RecordWriter::~RecordWriter() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void RecordWriter::BeginEpisode(const std::string& task, double time) {
  int number = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    number = ++num_begun_;
    episode_ = 0;
  }
  Post({Begin{task, number}, time});
}
void RecordWriter::Write(execution::Record record, double time) { Post({std::move(record), time}); }
void RecordWriter::EndEpisode(const std::string& outcome, double time) {
  Post({End{outcome}, time});
}

int RecordWriter::num_waiting() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return static_cast<int>(waiting_.size());
}

void RecordWriter::Post(Item item) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.push_back(std::move(item));
  }
  changed_.notify_one();
}

void RecordWriter::Run() {
  while (true) {
    Item item;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return is_ending_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      item = waiting_.front();  // stays until it is written
    }
    const Answer answer = Carry(item);
    if (answer == Answer::kAgain) {
      if (!Pause()) return;
      continue;
    }
    is_updated_ = false;
    is_repeated_ = false;
    ++(answer == Answer::kDone ? num_written_ : num_refused_);
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.pop_front();
  }
}

/// False at the end.
bool RecordWriter::Pause() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, std::chrono::duration<double>(kPause), [this] { return is_ending_; });
  if (!is_ending_) return true;
  Log(LogLevel::kError,
      fmt::format("records_lost={} the Blackboard is away at the end", waiting_.size()));
  return false;
}

RecordWriter::Answer RecordWriter::Carry(const Item& item) {
  return std::visit([&](const auto& what) { return Carry(what, item.time); }, item.what);
}

RecordWriter::Answer RecordWriter::Carry(const Begin& begin, double time) {
  hires::StartEpisode call;
  call.request.task = begin.task;
  call.request.time = time;
  const Answer answer = Ask("start_episode", &call);
  if (answer == Answer::kAgain) return answer;
  current_ = answer == Answer::kDone ? call.response.episode.id : 0;
  records_.Begin(call.response.episode.name);
  Announce(begin.number);
  return answer;
}

/// Unless the next episode is asked for already: its number is not known yet then.
void RecordWriter::Announce(int number) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (number == num_begun_) episode_ = current_;
}

RecordWriter::Answer RecordWriter::Carry(const End& end, double time) {
  if (current_ == 0) return Answer::kRefused;  // it was not begun: said already
  hires::FinishEpisode call;
  call.request.id = current_;
  call.request.outcome = end.outcome;
  call.request.time = time;
  return Ask("finish_episode", &call);
}

RecordWriter::Answer RecordWriter::Carry(const execution::Record& record, double time) {
  const hires::execution::RecordWrites writes = records_.WritesOf(record, time, *ontology_);
  if (writes.added) return WriteFluent("add", *writes.added, time);
  if (!is_updated_ && writes.updated) {
    const Answer answer = WriteFluent("update", *writes.updated, time);
    if (answer != Answer::kDone) return answer;
    is_updated_ = true;
  }
  if (!writes.ended) return Answer::kDone;
  const Answer answer = Remove(*writes.ended, time);
  if (answer != Answer::kAgain) records_.Forget(*writes.ended);
  return answer;
}

RecordWriter::Answer RecordWriter::WriteFluent(const char* service, const knowledge::Fluent& fluent,
                                               double time) {
  hires::WriteFluents call;
  call.request.fluents.push_back(ToMessage(fluent));
  call.request.by = ToMessage(knowledge::Assertion{knowledge::Source::kMonitor, current_, time});
  return Ask(service, &call);
}

RecordWriter::Answer RecordWriter::Remove(const std::string& instance, double time) {
  hires::RemoveFluents call;
  call.request.instances.push_back(instance);
  call.request.by = ToMessage(knowledge::Assertion{knowledge::Source::kMonitor, current_, time});
  return Ask("remove", &call);
}

template <typename Service>
RecordWriter::Answer RecordWriter::Ask(const char* name, Service* call) {
  const bool is_there = blackboard_.Call(name, call);
  if (!is_there && !std::exchange(is_away_, true)) {
    Log(LogLevel::kWarn, "the Blackboard does not answer; records wait until it is back");
  }
  if (!is_there) {
    is_repeated_ = true;
    return Answer::kAgain;
  }
  if (std::exchange(is_away_, false)) Log(LogLevel::kInfo, "the Blackboard answers again");
  switch (call->response.error.code) {
    case hires::BlackboardError::NONE:
      return Answer::kDone;
    case hires::BlackboardError::BUSY:
    case hires::BlackboardError::ENDING:
      return Answer::kAgain;
    default:
      if (is_repeated_) {  // it had been written before the Blackboard's answer was lost
        Log(LogLevel::kInfo,
            fmt::format("record=repeated service={} {}", name, call->response.error.message));
        return Answer::kDone;
      }
      Log(LogLevel::kError,
          fmt::format("record=refused service={} {}", name, call->response.error.message));
      return Answer::kRefused;
  }
}

}  // namespace hires_ros
