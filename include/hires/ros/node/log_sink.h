#pragma once

namespace hires_ros {

/// Carries core log lines (base::Log), and how far long reading has come (base::ReportProgress), to
/// rosout while it lives.
class ScopedLogSink {
 public:
  ScopedLogSink();
  ~ScopedLogSink();
  ScopedLogSink(const ScopedLogSink&) = delete;
  ScopedLogSink& operator=(const ScopedLogSink&) = delete;
};

}  // namespace hires_ros
