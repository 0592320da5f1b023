#include "cli/reading_display.h"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <string>

#include "hires/base/process.h"

namespace hires::cli {

base::ProgressSink ShowReadingOn(std::ostream* out, bool is_drawn_over,
                                 const std::function<double()>& now) {
  return
      [=, pace = base::ProgressPace(is_drawn_over)](const std::string& task, double share) mutable {
        if (!pace.IsDue(task, now())) return;
        const std::string line = fmt::format("{}: {:.0f} %", task, 100.0 * share);
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
