#include "hires/base/process.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <map>
#include <utility>

#include "hires/base/check.h"
#include "hires/base/error.h"
#include "hires/base/text.h"

namespace hires::base {
namespace {

/// What the child needs, prepared before fork(): between fork and exec a threaded program may
/// only make plain system calls.
struct Prepared {
  std::string path;
  std::vector<std::string> arguments;
  std::vector<std::string> environment;
  std::vector<char*> argv;
  std::vector<char*> envp;
  int nice{0};
  int parent{0};
  int output{-1};  // takes both outputs, unless negative
};

std::vector<char*> Pointers(std::vector<std::string>* texts) {
  std::vector<char*> pointers;
  for (std::string& text : *texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::vector<std::string> EnvironmentWith(const std::vector<std::string>& changes) {
  std::map<std::string, std::string> variables;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text = *entry;
    variables[text.substr(0, text.find('='))] = text;
  }
  for (const std::string& change : changes) {
    const auto equals = change.find('=');
    const std::string name = change.substr(0, equals);
    variables.erase(name);
    if (equals != std::string::npos) variables[name] = change;
  }
  std::vector<std::string> environment;
  for (const auto& [name, text] : variables) environment.push_back(text);
  return environment;
}

/// Only system calls here. Never returns: tells an error number through `error_fd`.
[[noreturn]] void BecomeProgram(const Prepared& prepared, int error_fd) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != prepared.parent) _exit(127);  // died before the line above
  setpriority(PRIO_PROCESS, 0, std::max(getpriority(PRIO_PROCESS, 0), prepared.nice));
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGCHLD}) {
    ::signal(signal, SIG_DFL);
  }
  if (prepared.output >= 0) {
    dup2(prepared.output, STDOUT_FILENO);
    dup2(prepared.output, STDERR_FILENO);
  }
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  close_range(3, ~0U, CLOSE_RANGE_CLOEXEC);
  execve(prepared.path.c_str(), prepared.argv.data(), prepared.envp.data());
  const int error = errno;
  if (write(error_fd, &error, sizeof(error)) != sizeof(error)) _exit(126);
  _exit(127);
}

/// 0 when the program runs, else the error number of exec.
int ReadExecError(int fd) {
  int error = 0;
  while (true) {
    const auto size = read(fd, &error, sizeof(error));
    if (size < 0 && errno == EINTR) continue;
    return size == sizeof(error) ? error : 0;
  }
}

int StartProgram(const Prepared& prepared) {
  int fds[2];
  if (pipe2(fds, O_CLOEXEC) != 0)
    throw std::runtime_error("pipe2: " + std::string(strerror(errno)));
  const pid_t pid = fork();
  if (pid < 0) throw std::runtime_error("fork: " + std::string(strerror(errno)));
  if (pid == 0) BecomeProgram(prepared, fds[1]);
  setpgid(pid, pid);  // here and in the child, whichever comes first
  close(fds[1]);
  const int error = ReadExecError(fds[0]);
  close(fds[0]);
  if (error == 0) return pid;
  waitpid(pid, nullptr, 0);
  throw ConfigError(fmt::format("{} cannot be started: {}", prepared.path, strerror(error)));
}

std::string HowItEnded(const siginfo_t& info) {
  if (info.si_code == CLD_EXITED) return fmt::format("exit code {}", info.si_status);
  return fmt::format("signal {} ({})", info.si_status, strsignal(info.si_status));
}

/// -1 for an empty path.
int OpenOutput(const std::string& path) {
  if (path.empty()) return -1;
  const int fd = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd >= 0) return fd;
  throw ConfigError(fmt::format("{}: cannot be written: {}", path, strerror(errno)));
}

bool IsExecutable(const std::string& path) { return access(path.c_str(), X_OK) == 0; }

std::string OwnFolder() {
  std::array<char, 4096> path{};
  if (readlink("/proc/self/exe", path.data(), path.size() - 1) <= 0) return ".";
  const std::string text = path.data();
  return text.substr(0, text.rfind('/'));
}

}  // namespace

ChildProcess::ChildProcess(const ProcessOptions& options) {
  HIRES_CHECK(!options.command.empty(), "a command has at least the program");
  Prepared prepared;
  prepared.path = FindExecutable(options.command.front());
  prepared.arguments = options.command;
  prepared.environment = EnvironmentWith(options.environment);
  prepared.argv = Pointers(&prepared.arguments);
  prepared.envp = Pointers(&prepared.environment);
  prepared.nice = options.nice;
  prepared.parent = getpid();
  prepared.output = OpenOutput(options.output);
  try {
    pid_ = StartProgram(prepared);
  } catch (...) {
    if (prepared.output >= 0) close(prepared.output);
    throw;
  }
  if (prepared.output >= 0) close(prepared.output);
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, 0)), ended_(std::move(other.ended_)) {}

ChildProcess::~ChildProcess() {
  if (pid_ == 0 || Ended()) return;
  Signal(SIGKILL);
  waitpid(pid_, nullptr, 0);
}

std::optional<std::string> ChildProcess::Ended() {
  if (ended_) return ended_;
  siginfo_t info{};
  if (waitid(P_PID, pid_, &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid == 0) {
    return std::nullopt;
  }
  // Before the program is reaped, so that no other process can have its number yet.
  kill(-pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  ended_ = HowItEnded(info);
  return ended_;
}

void ChildProcess::Signal(int signal) const {
  if (pid_ != 0 && !ended_) kill(-pid_, signal);
}

bool ChildProcess::Terminate(double grace) {
  Signal(SIGTERM);
  const double end = SteadyNow() + grace;
  while (!Ended()) {
    if (SteadyNow() > end) return false;
    poll(nullptr, 0, 2);
  }
  return true;
}

std::string FindExecutable(const std::string& name) {
  if (name.find('/') != std::string::npos) {
    if (IsExecutable(name)) return name;
    throw ConfigError(fmt::format("{} is no executable file: {}", name, strerror(errno)));
  }
  const char* path = std::getenv("PATH");
  std::vector<std::string> folders = Split(path == nullptr ? "/usr/bin" : path, ':');
  folders.insert(folders.begin(), OwnFolder());
  for (const std::string& folder : folders) {
    const std::string candidate = folder + "/" + name;
    if (IsExecutable(candidate)) return candidate;
  }
  throw ConfigError(fmt::format(
      "the program '{}' is in none of {}; is it built, and is the workspace's setup.bash sourced?",
      name, Join(folders, ", ")));
}

bool IsPortFree(const std::string& address, int port) {
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, address.c_str(), &where.sin_addr) != 1) return false;
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));  // as the master's own server
  const bool is_free = bind(fd, reinterpret_cast<const sockaddr*>(&where), sizeof(where)) == 0;
  close(fd);
  return is_free;
}

double SteadyNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

StopSignals::StopSignals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  fd_ = signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
}

StopSignals::~StopSignals() { close(fd_); }

bool StopSignals::Wait(double seconds) {
  pollfd waiting{fd_, POLLIN, 0};
  if (!has_stopped_) poll(&waiting, 1, std::max(0, static_cast<int>(seconds * 1e3)));
  signalfd_siginfo info{};
  while (read(fd_, &info, sizeof(info)) == sizeof(info)) {
    has_stopped_ = has_stopped_ || info.ssi_signo != SIGCHLD;
  }
  return has_stopped_;
}

}  // namespace hires::base
