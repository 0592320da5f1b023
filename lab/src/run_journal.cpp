#include "lab/src/run_journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/base/hash.h"
#include "hires/base/log.h"
#include "hires/base/text.h"

namespace hires::lab {
namespace {

using nlohmann::ordered_json;

std::string LineOf(const ordered_json& json) {
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

ordered_json ParseLine(const std::string& line, const std::string& where) {
  ordered_json json = ordered_json::parse(line, nullptr, false);
  if (json.is_object()) return json;
  throw base::ConfigError(fmt::format(
      "{}: is no JSON object; the journal is broken, move it away or repair this line", where));
}

/// Of the program that runs now: another build has another.
std::string ProgramHash() {
  static const std::string hash = [] {
    base::Hasher hasher;
    hasher.Add(base::ReadTextFile("/proc/self/exe", 1u << 30));
    return base::HexOf(hasher.value());
  }();
  return hash;
}

/// Code may have changed what a run does, though most changes do not: it is said, not refused.
void WarnOfOtherProgram(const ordered_json& head, const std::string& path) {
  if (head.value("program", std::string()) == ProgramHash()) return;
  base::Log(
      base::LogLevel::kWarn,
      fmt::format("journal={} holds runs of another build of this program, which are taken as "
                  "they are; move it away to play them again",
                  path));
}

void RequireSame(const ordered_json& head, const ordered_json& wanted, const std::string& path) {
  if (!head.contains("journal") || head["journal"] != wanted["journal"]) {
    throw base::ConfigError(fmt::format(
        "{}: line 1: this is no journal of this experiment; name another file by --resume", path));
  }
  for (const auto& [key, value] : wanted.items()) {
    const ordered_json has = head.contains(key) ? head[key] : ordered_json();
    if (has == value) continue;
    throw base::ConfigError(fmt::format(
        "{}: its runs have {} {}, now it is {}; repeat the command as it was, name another file by "
        "--resume, or move this one away",
        path, key, has.dump(), value.dump()));
  }
}

[[noreturn]] void FailWith(const std::string& path, const char* what) {
  throw base::ConfigError(fmt::format("{}: {}: {}", path, what, strerror(errno)));
}

/// Whether something that is closed must not keep the file: this is its only owner.
int OpenAlone(const std::string& path) {
  const int fd = open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (fd < 0) FailWith(path, "the journal cannot be opened; check folder and rights");
  if (flock(fd, LOCK_EX | LOCK_NB) == 0) return fd;
  close(fd);
  throw base::ConfigError(fmt::format(
      "{}: another run of this experiment writes to it; wait for its end, or name another file by "
      "--resume",
      path));
}

}  // namespace

RunJournal::RunJournal(const std::string& path, const ordered_json& head, const OnRun& on_run)
    : path_(path), fd_(OpenAlone(path)) {
  try {
    Load(head, on_run);
  } catch (...) {
    close(fd_);
    throw;
  }
}

RunJournal::~RunJournal() { close(fd_); }

void RunJournal::Load(const ordered_json& head, const OnRun& on_run) {
  const std::string text = base::ReadTextFile(path_);
  // What stands behind the last end of a line was being written when the program ended.
  const std::size_t whole = text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1;
  if (whole < text.size() && whole == 0 && text.front() != '{') {
    throw base::ConfigError(fmt::format(
        "{}: line 1: this is no journal of this experiment; name another file by --resume", path_));
  }
  if (whole < text.size() && ftruncate(fd_, static_cast<off_t>(whole)) != 0) {
    FailWith(path_, "its broken last line cannot be cut off");
  }
  if (whole == 0) {
    ordered_json begun = head;
    begun["program"] = ProgramHash();
    return AppendText(LineOf(begun));
  }
  const std::vector<std::string> lines = base::Split(text.substr(0, whole - 1), '\n');
  const ordered_json begun = ParseLine(lines[0], path_ + ": line 1");
  RequireSame(begun, head, path_);
  WarnOfOtherProgram(begun, path_);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::string where = fmt::format("{}: line {}", path_, i + 1);
    on_run(ParseLine(lines[i], where), where);
  }
}

void RunJournal::Append(const ordered_json& run) { AppendText(LineOf(run)); }

void RunJournal::AppendText(const std::string& line) {
  std::size_t written = 0;
  while (written < line.size()) {
    const ssize_t size = write(fd_, line.data() + written, line.size() - written);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) FailWith(path_, "the journal cannot be written");
    written += static_cast<std::size_t>(size);
  }
  if (fsync(fd_) != 0 && errno != EINVAL) FailWith(path_, "the journal cannot be written");
}

}  // namespace hires::lab
