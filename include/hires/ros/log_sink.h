#pragma once

namespace hires_ros {

/// Carries core log lines (base::Log) to rosout while it lives.
class ScopedLogSink {
 public:
  ScopedLogSink();
  ~ScopedLogSink();
  ScopedLogSink(const ScopedLogSink&) = delete;
  ScopedLogSink& operator=(const ScopedLogSink&) = delete;
};

}  // namespace hires_ros
