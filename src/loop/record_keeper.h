#pragma once

#include <cstdint>
#include <string>

#include "hires/execution/monitor.h"
#include "hires/execution/record_fluent.h"
#include "hires/knowledge/fluent.h"
#include "loop/blackboard.h"

namespace hires::loop {

/// Writes what the execution monitor knows to the Blackboard, in an episode of the task.
class RecordKeeper {
 public:
  explicit RecordKeeper(Blackboard* blackboard) : blackboard_(*blackboard) {}

  // Times are [s].
  void BeginEpisode(const std::string& task, double time);
  void Write(const execution::Record& record, double time);
  void EndEpisode(const std::string& outcome, double time);
  std::int64_t episode() const { return episode_.id; }

 private:
  Blackboard& blackboard_;
  knowledge::Episode episode_;
  execution::EpisodeRecords records_;
};

}  // namespace hires::loop
