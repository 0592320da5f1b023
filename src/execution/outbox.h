#pragma once

#include <string>
#include <utility>
#include <vector>

#include "hires/execution/monitor.h"

namespace hires::execution {

/// The commands that go out with the monitor's next answer, and the numbers they are known by.
class Outbox {
 public:
  template <typename C>
  void Send(C command) {
    commands_.emplace_back(std::move(command));
  }
  void Warning(std::string text) { Send(Warn{std::move(text)}); }
  std::vector<Command> Take() { return std::exchange(commands_, {}); }

  int NewRequest() { return ++last_request_; }
  int NewRecord() { return ++last_record_; }

 private:
  std::vector<Command> commands_;
  int last_request_{0}, last_record_{0};
};

}  // namespace hires::execution
