#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>

#include "hires/execution/monitor.h"
#include "hires/execution/record_fluent.h"
#include "hires/knowledge/fluent.h"
#include "hires/knowledge/ontology.h"
#include "hires/ros/node/service_links.h"

namespace hires_ros {

/// Writes what the execution monitor knows to the Blackboard, in order, on a thread of its own.
/// While the Blackboard is away, records wait; they are written when it is back.
class RecordWriter {
 public:
  explicit RecordWriter(std::shared_ptr<const hires::knowledge::Ontology> ontology);
  ~RecordWriter();  ///< Writes what it can without waiting for a Blackboard that is away.
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;

  // Times are main ROS time [s].
  void BeginEpisode(const std::string& task, double time);
  void Write(hires::execution::Record record, double time);
  void EndEpisode(const std::string& outcome, double time);

  std::int64_t episode() const { return episode_; }  ///< the running or last one; 0: not begun yet
  int num_waiting() const;
  int num_written() const { return num_written_; }
  int num_refused() const { return num_refused_; }

 private:
  struct Begin {
    std::string task;
    int number;  ///< the first, the second, ...
  };
  struct End {
    std::string outcome;
  };
  struct Item {
    std::variant<Begin, hires::execution::Record, End> what;
    double time;
  };
  enum class Answer { kDone, kRefused, kAgain };

  void Post(Item item);
  void Announce(int number);
  void Run();
  bool Pause();
  Answer Carry(const Item& item);
  Answer Carry(const Begin& begin, double time);
  Answer Carry(const hires::execution::Record& record, double time);
  Answer Carry(const End& end, double time);
  Answer WriteFluent(const char* service, const hires::knowledge::Fluent& fluent, double time);
  Answer Remove(const std::string& instance, double time);
  template <typename Service>
  Answer Ask(const char* name, Service* call);

  const std::shared_ptr<const hires::knowledge::Ontology> ontology_;
  std::atomic<std::int64_t> episode_{0};
  std::atomic<int> num_written_{0}, num_refused_{0};

  // Of the writer's thread.
  ServiceLinks blackboard_;
  std::int64_t current_{0};  // episode that is written; 0: it was refused
  hires::execution::EpisodeRecords records_;
  bool is_updated_{
      false};  // of the item under way: its last properties are in, only its end is not
  bool is_repeated_{false};  // a call of the item under way had no answer, and may have been heard
  bool is_away_{false};

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  int num_begun_{0};          // guarded: episodes asked for
  std::deque<Item> waiting_;  // guarded
  bool is_ending_{false};     // guarded
  std::thread thread_;
};

}  // namespace hires_ros
