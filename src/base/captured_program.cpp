#include "base/captured_program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/process.h"
#include "hires/base/text.h"

namespace hires::base {
namespace {

constexpr std::size_t kMostOutput = 64u << 20;  // [bytes]

/// A pipe, closed with its owner.
class Pipe {
 public:
  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
      throw std::runtime_error("pipe2: " + std::string(strerror(errno)));
    read_ = ends[0];
    write_ = ends[1];
  }
  ~Pipe() {
    CloseWriting();
    close(read_);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  void CloseWriting() {
    if (write_ >= 0) close(write_);
    write_ = -1;
  }
  int reading() const { return read_; }
  int writing() const { return write_; }

 private:
  int read_{-1}, write_{-1};
};

/// In a process group of its own, with the usual signals.
pid_t Spawn(const std::vector<std::string>& command, const Pipe& out, const Pipe& errors) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, out.writing(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors.writing(), STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, usual;
  sigemptyset(&none);
  sigemptyset(&usual);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGCHLD}) sigaddset(&usual, signal);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::vector<std::string> words = command;
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t pid = 0;
  const int error = posix_spawnp(&pid, argv.front(), &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error == 0) return pid;
  throw ConfigError(fmt::format("{} cannot be started: {}", command.front(), strerror(error)));
}

/// @return whether more may come.
bool Take(int fd, std::string* text) {
  std::array<char, 65536> part;
  const ssize_t size = read(fd, part.data(), part.size());
  if (size < 0) return errno == EINTR || errno == EAGAIN;
  text->append(part.data(), static_cast<std::size_t>(size));
  return size > 0;
}

/// Reads both until they are closed.  @return false when time is up, or too much came.
bool ReadBoth(const Pipe& out, const Pipe& errors, double deadline, ProgramOutput* result) {
  std::array<pollfd, 2> waited{{{out.reading(), POLLIN, 0}, {errors.reading(), POLLIN, 0}}};
  while (waited[0].fd >= 0 || waited[1].fd >= 0) {
    const double left = deadline - SteadyNow();
    if (left <= 0.0) {
      result->has_run_out_of_time = true;
      return false;
    }
    poll(waited.data(), waited.size(), static_cast<int>(1000.0 * left) + 1);
    if (waited[0].revents != 0 && !Take(waited[0].fd, &result->out)) waited[0].fd = -1;
    if (waited[1].revents != 0 && !Take(waited[1].fd, &result->errors)) waited[1].fd = -1;
    for (pollfd& one : waited) one.revents = 0;
    if (result->out.size() + result->errors.size() > kMostOutput) return false;
  }
  return true;
}

/// @return whether it ended in time.
bool WaitUntil(pid_t pid, double deadline) {
  const int fd = static_cast<int>(syscall(SYS_pidfd_open, pid, 0));
  if (fd < 0) return true;  // an old kernel: it closed its outputs, so that it is about to end
  pollfd waited{fd, POLLIN, 0};
  bool has_ended = false;
  while (!has_ended) {
    const double left = deadline - SteadyNow();
    if (left <= 0.0) break;
    has_ended = poll(&waited, 1, static_cast<int>(1000.0 * left) + 1) > 0;
  }
  close(fd);
  return has_ended;
}

}  // namespace

std::string ProgramOnPath(const std::string& name) {
  const char* path = std::getenv("PATH");
  for (const std::string& folder : Split(path == nullptr ? "" : path, ':')) {
    const std::string file = (folder.empty() ? "." : folder) + "/" + name;
    if (access(file.c_str(), X_OK) == 0) return file;
  }
  return "";
}

ProgramOutput RunAndCapture(const std::vector<std::string>& command, double limit) {
  HIRES_CHECK(!command.empty(), "a command names a program");
  const double deadline = SteadyNow() + limit;
  Pipe out, errors;
  const pid_t pid = Spawn(command, out, errors);
  out.CloseWriting();
  errors.CloseWriting();
  ProgramOutput result;
  const bool is_whole = ReadBoth(out, errors, deadline, &result);
  if (is_whole) result.has_run_out_of_time = !WaitUntil(pid, deadline);
  if (!is_whole || result.has_run_out_of_time) kill(-pid, SIGKILL);
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (!is_whole && !result.has_run_out_of_time) {
    throw ConfigError(fmt::format("{} writes more than {} MB, which no file here has",
                                  command.front(), kMostOutput >> 20));
  }
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  return result;
}

}  // namespace hires::base
