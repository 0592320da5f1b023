#include "hires/base/log.h"

#include <iostream>
#include <mutex>
#include <utility>

namespace hires::base {
namespace {

struct Sink {
  std::recursive_mutex mutex;  // a sink may log itself
  LogSink function;
};

Sink& TheSink() {
  static Sink sink;
  return sink;
}

}  // namespace

void Log(LogLevel level, const std::string& line) {
  Sink& sink = TheSink();
  const std::lock_guard<std::recursive_mutex> lock(sink.mutex);
  if (sink.function) {
    sink.function(level, line);
  } else if (level >= LogLevel::kWarn) {
    std::cerr << (level == LogLevel::kWarn ? "warning: " : "error: ") << line << '\n';
  }
}

void SetLogSink(LogSink function) {
  Sink& sink = TheSink();
  const std::lock_guard<std::recursive_mutex> lock(sink.mutex);
  sink.function = std::move(function);
}

}  // namespace hires::base
