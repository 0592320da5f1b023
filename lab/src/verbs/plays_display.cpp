#include "lab/src/verbs/plays_display.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "cli/crew_display.h"
#include "cli/report_output.h"
#include "hires/base/error.h"
#include "hires/base/spelling.h"
#include "reports/text/report_table.h"

namespace hires::lab {

std::string PlaysFolder(const std::string& verb, const std::string& given) {
  if (!given.empty()) return given;
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  if (cache != nullptr && *cache != '\0') return std::string(cache) + "/hires/results";
  if (home != nullptr && *home != '\0') return std::string(home) + "/.cache/hires/results";
  throw base::ConfigError(verb +
                          ": neither XDG_CACHE_HOME nor HOME is set; name a folder with --results");
}

PlaysDisplay::PlaysDisplay() : is_terminal_(isatty(STDERR_FILENO) != 0) {}

void PlaysDisplay::Show(const PlaysProgress& progress) {
  const std::string text = fmt::format(
      "{} of {}, {}: {}", progress.number, progress.all, progress.play,
      cli::ProgressText(progress.done / (progress.done + progress.left), progress.done));
  if (is_terminal_) {
    std::cerr << '\r' << text << "\033[K" << std::flush;
  } else if (progress.play != told_) {
    std::cerr << text << std::endl;
  }
  told_ = progress.play;
}

void PlaysDisplay::Clear() const {
  if (is_terminal_ && !told_.empty()) std::cerr << "\r\033[K";
}

void PrintPlays(const std::vector<Play>& plays, PlayStore* store) {
  std::vector<std::vector<std::string>> rows{{"play", "answer", "time [s]", "command"}};
  double seconds = 0.0, missing = 0.0;
  for (const Play& play : plays) {
    store->KeyOf(play);
    const auto stored = store->Find(play);
    seconds += stored ? stored->seconds : play.seconds;
    if (!stored) missing += play.seconds;
    std::vector<std::string> words{ProgramNameOf(play)};
    words.insert(words.end(), play.command.begin(), play.command.end());
    rows.push_back({play.name,
                    !stored                           ? "missing"
                    : stored->build == store->build() ? "there"
                                                      : "there, of another build",
                    fmt::format("{:.0f}", stored ? stored->seconds : play.seconds),
                    cli::CommandText(words)});
  }
  std::cout << reports::FormatTable(rows)
            << fmt::format("{}, {:.0f} s in all; {:.0f} s are still to be played\n",
                           base::Counted(plays.size(), "play"), seconds, missing);
}

void SayOtherBuilds(const PlaysDone& done, const std::string& build) {
  const auto old = std::count_if(done.answers.begin(), done.answers.end(),
                                 [&](const auto& entry) { return entry.second.build != build; });
  if (old == 0) return;
  std::cout << fmt::format(
      "by another build of this version, from the same files: {} of {}; --again plays anew\n", old,
      base::Counted(done.answers.size(), "answer"));
}

}  // namespace hires::lab
