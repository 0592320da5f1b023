#include "hires/ros/node/log_sink.h"

#include <ros/console.h>

#include <cmath>
#include <string>

#include "hires/base/log.h"
#include "hires/base/process.h"
#include "hires/base/progress.h"

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
  hires::base::SetProgressSink(
      [pace = hires::base::ProgressPace(false)](const std::string& task, double share) mutable {
        if (!pace.IsDue(task, hires::base::SteadyNow())) return;
        ROS_INFO_STREAM(task << ": " << std::lround(100.0 * share) << " %");
      });
}

ScopedLogSink::~ScopedLogSink() {
  hires::base::SetLogSink({});
  hires::base::SetProgressSink({});
}

}  // namespace hires_ros
