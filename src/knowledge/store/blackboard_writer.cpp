#include "hires/knowledge/blackboard_writer.h"

#include <fmt/format.h>

#include <map>
#include <set>
#include <utility>

#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::knowledge {
namespace {

namespace knowledge = hires::knowledge;
using base::ToLower;

bool SameWord(const Assertion& a, const Assertion& b) {
  return a.source == b.source && a.episode == b.episode && a.time == b.time;
}

std::vector<std::string> InstancesOf(const std::vector<Fluent>& fluents,
                                     const std::vector<std::string>& instances) {
  std::vector<std::string> names;
  for (const Fluent& fluent : fluents) names.push_back(ToLower(fluent.instance));
  for (const std::string& instance : instances) names.push_back(ToLower(instance));
  return names;
}

}  // namespace

BlackboardWriter::BlackboardWriter(Store store, const Limits& limits, Clock now, OnCommit on_commit)
    : store_(std::move(store)),
      limits_(limits),
      now_(std::move(now)),
      on_commit_(std::move(on_commit)),
      thread_([this] { Loop(); }) {}

BlackboardWriter::~BlackboardWriter() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_ending_ = true;
  }
  arrived_.notify_all();
  thread_.join();
  for (Job& job : waiting_) {
    job.written.set_exception(std::make_exception_ptr(
        Unavailable(Unavailable::Reason::kEnding, "the Blackboard ends; nothing was written")));
  }
}

Written BlackboardWriter::Add(std::vector<Fluent> fluents, const Assertion& by) {
  Job job;
  job.kind = Kind::kAdd;
  job.fluents = std::move(fluents);
  job.by = by;
  return Post(std::move(job), false);
}

Written BlackboardWriter::Update(std::vector<Fluent> fluents, const Assertion& by) {
  Job job;
  job.kind = Kind::kUpdate;
  job.fluents = std::move(fluents);
  job.by = by;
  return Post(std::move(job), false);
}

Written BlackboardWriter::Remove(std::vector<std::string> instances, const Assertion& by) {
  Job job;
  job.kind = Kind::kRemove;
  job.instances = std::move(instances);
  job.by = by;
  return Post(std::move(job), false);
}

void BlackboardWriter::Run(Task task) {
  Job job;
  job.task = std::move(task);
  Post(std::move(job), false);
}

void BlackboardWriter::RunAlways(Task task) {
  Job job;
  job.task = std::move(task);
  Post(std::move(job), true);
}

Written BlackboardWriter::Post(Job job, bool always) {
  std::future<Written> written = job.written.get_future();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (is_ending_) throw Unavailable(Unavailable::Reason::kEnding, "the Blackboard ends");
    if (!always && num_waiting_ >= limits_.max_waiting) {
      throw Unavailable(
          Unavailable::Reason::kBusy,
          fmt::format("{} requests wait already; ask again later", limits_.max_waiting));
    }
    waiting_.push_back(std::move(job));
    ++num_waiting_;
    arrived_.notify_one();  // still locked: at the end, nobody touches it who is not waited for
  }
  return written.get();
}

BlackboardWriter::Jobs BlackboardWriter::TakeAll() {
  std::unique_lock<std::mutex> lock(mutex_);
  arrived_.wait(lock, [this] { return is_ending_ || !waiting_.empty(); });
  if (is_ending_) return {};
  return std::exchange(waiting_, {});
}

void BlackboardWriter::Loop() {
  for (Jobs jobs = TakeAll(); !jobs.empty(); jobs = TakeAll()) Work(&jobs);
}

void BlackboardWriter::Work(Jobs* jobs) {
  for (std::size_t begin = 0; begin < jobs->size();) {
    const std::size_t end = GroupEnd(*jobs, begin);
    Group group;
    for (; begin < end; ++begin) group.push_back(&(*jobs)[begin]);
    num_waiting_ -= static_cast<int>(group.size());
    if (group[0]->kind == Kind::kTask) {
      WorkTask(group[0]);
    } else {
      WorkGroup(group);
    }
  }
}

/// Jobs of one kind and one word that speak of different instances, so that it can be told which of
/// them changed what.
std::size_t BlackboardWriter::GroupEnd(const Jobs& jobs, std::size_t begin) const {
  const Job& first = jobs[begin];
  if (first.kind == Kind::kTask) return begin + 1;
  std::set<std::string> taken;
  std::size_t size = 0;
  std::size_t end = begin;
  for (; end < jobs.size(); ++end) {
    const Job& job = jobs[end];
    size += job.size();
    if (job.kind != first.kind || !SameWord(job.by, first.by)) break;
    if (end > begin && size > static_cast<std::size_t>(limits_.max_group)) break;
    const std::vector<std::string> names = InstancesOf(job.fluents, job.instances);
    const auto is_taken = [&](const std::string& name) { return taken.count(name) > 0; };
    if (std::any_of(names.begin(), names.end(), is_taken)) break;
    taken.insert(names.begin(), names.end());
  }
  return end;
}

void BlackboardWriter::WorkGroup(const Group& group) {
  std::vector<Change> changes;
  try {
    changes = Write(group);
  } catch (...) {
    if (group.size() > 1) {
      for (Job* job : group) WorkGroup({job});
    } else {
      group[0]->written.set_exception(std::current_exception());
    }
    return;
  }
  Acknowledge(group, changes);
  if (!changes.empty()) on_commit_(store_, changes);
}

std::vector<Change> BlackboardWriter::Write(const Group& group) {
  std::vector<Fluent> fluents;
  std::vector<std::string> instances;
  for (const Job* job : group) {  // copied: each may have to be written on its own
    fluents.insert(fluents.end(), job->fluents.begin(), job->fluents.end());
    instances.insert(instances.end(), job->instances.begin(), job->instances.end());
  }
  Assertion by = group[0]->by;
  if (by.time == 0.0) by.time = now_();
  switch (group[0]->kind) {
    case Kind::kAdd:
      return store_.Add(fluents, by);
    case Kind::kUpdate:
      return store_.Update(fluents, by);
    default:
      return store_.Remove(instances, by);
  }
}

void BlackboardWriter::Acknowledge(const Group& group, const std::vector<Change>& changes) {
  std::map<std::string, std::size_t> changed;
  for (const Change& change : changes) ++changed[ToLower(change.fluent.instance)];
  for (Job* job : group) {
    Written written;
    written.sequence = store_.last_sequence();
    for (const std::string& name : InstancesOf(job->fluents, job->instances)) {
      written.num_changed += std::exchange(changed[name], 0);
    }
    job->written.set_value(written);
  }
}

void BlackboardWriter::WorkTask(Job* job) {
  std::vector<Change> changes;
  try {
    changes = job->task(&store_);
  } catch (...) {
    job->written.set_exception(std::current_exception());
    return;
  }
  job->written.set_value({changes.size(), store_.last_sequence()});
  if (!changes.empty()) on_commit_(store_, changes);
}

}  // namespace hires::knowledge
