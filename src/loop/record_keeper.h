#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "hires/execution/monitor.h"
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
  std::map<std::string, double> begun_;  // [s] by instance in lower case
};

}  // namespace hires::loop
