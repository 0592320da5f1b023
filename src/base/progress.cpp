#include "hires/base/progress.h"

#include <mutex>
#include <utility>

namespace hires::base {
namespace {

constexpr double kFirstLine = 1.0;     // [s] after the first report of a task
constexpr double kBetweenLines = 5.0;  // [s]

struct Shared {
  std::mutex mutex;
  ProgressSink sink;
};

Shared& TheShared() {
  static Shared shared;
  return shared;
}

}  // namespace

void ReportProgress(const std::string& task, double share) {
  const std::lock_guard<std::mutex> lock(TheShared().mutex);
  if (TheShared().sink) TheShared().sink(task, share);
}

void SetProgressSink(ProgressSink sink) {
  const std::lock_guard<std::mutex> lock(TheShared().mutex);
  TheShared().sink = std::move(sink);
}

bool ProgressPace::IsDue(const std::string& task, double now) {
  if (task != task_) {
    task_ = task;
    next_ = now + kFirstLine;
  }
  if (now < next_) return false;
  if (!is_drawn_over_) next_ = now + kBetweenLines;
  return true;
}

}  // namespace hires::base
