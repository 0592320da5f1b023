#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "hires/knowledge/store.h"

namespace hires::knowledge {

/// A request could not be taken on, though nothing is wrong with it.
class Unavailable : public std::runtime_error {
 public:
  enum class Reason { kBusy, kEnding };
  Unavailable(Reason why, const std::string& text) : std::runtime_error(text), reason(why) {}
  const Reason reason;
};

/// What a write came to, once it is committed.
struct Written {
  std::size_t num_changed{0};
  std::uint64_t sequence{0};  ///< last change in the store afterwards
};

/// The thread that owns the store that writes. Requests of many threads wait here; those that fit
/// together share a transaction, and each is answered after its commit. Where one of them spoils
/// the transaction, each gets its own.
class BlackboardWriter {
 public:
  struct Limits {
    int max_waiting{1000};  ///< requests
    int max_group{1000};    ///< fluents in a transaction of several requests
  };
  /// Called on the thread of the store after every commit that changed something, with these
  /// changes.
  using OnCommit = std::function<void(const Store&, const std::vector<Change>&)>;
  using Clock = std::function<double()>;  ///< [s] main ROS time

  BlackboardWriter(Store store, const Limits& limits, Clock now, OnCommit on_commit);
  ~BlackboardWriter();  ///< Callers that wait are told that it ends.
  BlackboardWriter(const BlackboardWriter&) = delete;
  BlackboardWriter& operator=(const BlackboardWriter&) = delete;

  /// From any thread but the store's own; they wait. A time of 0 is the moment of writing.
  /// @throws ConfigError as the store, Unavailable.
  Written Add(std::vector<Fluent> fluents, const Assertion& by);
  Written Update(std::vector<Fluent> fluents, const Assertion& by);
  Written Remove(std::vector<std::string> instances, const Assertion& by);

  /// Anything else that needs the store, in its turn: reads, or writes and says what changed.
  using Task = std::function<std::vector<Change>(Store*)>;
  /// @throws what the task throws, Unavailable.
  void Run(Task task);
  /// The same for what must not be turned away.
  void RunAlways(Task task);

  int num_waiting() const { return num_waiting_; }
  double Now() const { return now_(); }

 private:
  enum class Kind { kAdd, kUpdate, kRemove, kTask };
  struct Job {
    Kind kind{Kind::kTask};
    std::vector<Fluent> fluents;
    std::vector<std::string> instances;
    Assertion by;
    Task task;
    std::promise<Written> written;

    std::size_t size() const { return fluents.size() + instances.size(); }
  };
  using Jobs = std::deque<Job>;
  using Group = std::vector<Job*>;

  Written Post(Job job, bool always);
  void Loop();
  Jobs TakeAll();  ///< waits; none at the end
  void Work(Jobs* jobs);
  std::size_t GroupEnd(const Jobs& jobs, std::size_t begin) const;
  void WorkGroup(const Group& group);
  void WorkTask(Job* job);
  std::vector<Change> Write(const Group& group);
  void Acknowledge(const Group& group, const std::vector<Change>& changes);

  Store store_;  // of the thread
  const Limits limits_;
  const Clock now_;
  const OnCommit on_commit_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  Jobs waiting_;           // guarded
  bool is_ending_{false};  // guarded
  std::atomic<int> num_waiting_{0};
  std::thread thread_;
};

}  // namespace hires::knowledge
