#include "cli/reading_display.h"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <string>

#include "hires/base/process.h"

namespace hires::cli {
namespace {

constexpr double kTellsTimeLeft = 3.0;  // [s] of work from which on its pace is known

/// What is left of a task, if it goes on as it went.
class TimeLeft {
 public:
  void Hear(const std::string& task, double share, double now) {
    if (task == task_) return;
    task_ = task;
    first_share_ = share;
    begin_ = now;
  }
  std::string Text(double share, double now) const {
    const double passed = now - begin_, done = share - first_share_;
    if (passed < kTellsTimeLeft || done <= 0.0 || share >= 1.0) return "";
    return fmt::format(", {:.0f} s left", passed * (1.0 - share) / done);
  }

 private:
  std::string task_;
  double first_share_{0.0}, begin_{0.0};
};

}  // namespace

base::ProgressSink ShowReadingOn(std::ostream* out, bool is_drawn_over,
                                 const std::function<double()>& now) {
  return [=, pace = base::ProgressPace(is_drawn_over), left = TimeLeft()](const std::string& task,
                                                                          double share) mutable {
    left.Hear(task, share, now());
    if (!pace.IsDue(task, now())) return;
    const std::string line =
        fmt::format("{}: {:.0f} %{}", task, 100.0 * share, left.Text(share, now()));
    if (!is_drawn_over) {
      *out << line << std::endl;
    } else {
      *out << '\r' << (share < 1.0 ? line : "") << "\033[K" << std::flush;
    }
  };
}

ReadingDisplay::ReadingDisplay(bool is_quiet) {
  if (is_quiet) return;
  base::SetProgressSink(
      ShowReadingOn(&std::cerr, isatty(STDERR_FILENO) != 0, [] { return base::SteadyNow(); }));
}

ReadingDisplay::~ReadingDisplay() { base::SetProgressSink({}); }

}  // namespace hires::cli
