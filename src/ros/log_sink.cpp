#include "hires/ros/log_sink.h"

#include <ros/console.h>

#include "hires/base/log.h"

namespace hires_ros {

ScopedLogSink::ScopedLogSink() {
  hires::base::SetLogSink([](hires::base::LogLevel level, const std::string& line) {
    switch (level) {
      case hires::base::LogLevel::kDebug:
        ROS_DEBUG_STREAM(line);
        break;
      case hires::base::LogLevel::kInfo:
        ROS_INFO_STREAM(line);
        break;
      case hires::base::LogLevel::kWarn:
        ROS_WARN_STREAM(line);
        break;
      case hires::base::LogLevel::kError:
        ROS_ERROR_STREAM(line);
        break;
    }
  });
}

ScopedLogSink::~ScopedLogSink() { hires::base::SetLogSink({}); }

}  // namespace hires_ros
