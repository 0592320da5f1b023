#pragma once

#include <functional>
#include <string>

namespace hires::base {

enum class LogLevel { kDebug, kInfo, kWarn, kError };

/// One line of `key=value` text. Goes to the sink that was set last, else to standard error
/// (warnings and errors only). Safe to call from any thread; sinks are called one at a time, so a
/// sink must not log itself.
void Log(LogLevel level, const std::string& line);

using LogSink = std::function<void(LogLevel, const std::string&)>;
/// Replaces the sink for the whole process; an empty function restores the default.
void SetLogSink(LogSink sink);

}  // namespace hires::base
