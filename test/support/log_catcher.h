#pragma once

#include <string>
#include <vector>

#include "hires/base/log.h"

namespace hires::test_support {

/// Collects what is logged while it lives, from a level on.
class LogCatcher {
 public:
  explicit LogCatcher(base::LogLevel least = base::LogLevel::kDebug) {
    base::SetLogSink([this, least](base::LogLevel level, const std::string& line) {
      if (level >= least) lines.push_back(line);
    });
  }
  ~LogCatcher() { base::SetLogSink({}); }
  LogCatcher(const LogCatcher&) = delete;
  LogCatcher& operator=(const LogCatcher&) = delete;

  std::vector<std::string> lines;
};

}  // namespace hires::test_support
