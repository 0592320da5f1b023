#include "cli/crew_display.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <thread>

namespace hires::cli {

base::Crew MakeCrew(int threads, bool is_quiet, const std::function<bool()>& cancelled) {
  base::Crew crew;
  crew.threads =
      threads > 0 ? threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  crew.cancelled = cancelled;
  if (!is_quiet && isatty(STDERR_FILENO) != 0) {
    crew.on_progress = [](double fraction, double elapsed) {
      std::cerr << '\r' << ProgressText(fraction, elapsed) << "\033[K" << std::flush;
    };
  }
  return crew;
}

std::string ProgressText(double fraction, double elapsed) {
  constexpr int kBar = 24;
  const int filled = std::clamp(static_cast<int>(fraction * kBar + 0.5), 0, kBar);
  std::string text = fmt::format("[{}{}] {:3.0f} %", std::string(filled, '#'),
                                 std::string(kBar - filled, '.'), 100.0 * fraction);
  if (fraction > 0.0) {
    text += fmt::format(", {:.0f} s left", elapsed * (1.0 - fraction) / fraction);
  }
  return text;
}

}  // namespace hires::cli
