#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hires::base {

struct ProcessOptions {
  std::vector<std::string> command;      ///< program (see FindExecutable) and arguments
  std::vector<std::string> environment;  ///< "NAME=value" sets, "NAME" removes; the rest is kept
  int nice{0};                           ///< at least this niceness, -20 .. 19
  std::string output;  ///< file that takes both outputs, made new; empty: where this process writes
};

/// A program started by this process, in a process group of its own. The kernel kills it
/// (SIGKILL) when the thread that started it ends in whatever way, so start children only from
/// main(). What the program starts in turn is killed with its group as long as this object lives;
/// after a SIGKILL of this process it is on its own.
class ChildProcess {
 public:
  /// @throws ConfigError if the program is not found or cannot be executed.
  explicit ChildProcess(const ProcessOptions& options);
  ~ChildProcess();  ///< Kills the group and waits for the program's end.
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ChildProcess& operator=(ChildProcess&&) = delete;

  int pid() const { return pid_; }

  /// How the program ended ("exit code 1", "signal 9 (Killed)"), or nothing while it runs. At its
  /// end the rest of its group is killed.
  std::optional<std::string> Ended();

  void Signal(int signal) const;  ///< To the whole group; nothing happens after the end.

  /// Sends SIGTERM and waits until the program ended, at most `grace` [s]; true if it did.
  bool Terminate(double grace);

 private:
  int pid_{0};  // 0: moved from
  std::optional<std::string> ended_;
};

/// Path of a program: `name` itself if it has a '/', else beside this program, else on PATH.
/// @throws ConfigError naming where was looked.
std::string FindExecutable(const std::string& name);

/// Whether a server could listen at this address (dotted numbers) now.
bool IsPortFree(const std::string& address, int port);

/// [s] on a clock that never jumps.
double SteadyNow();

/// Takes SIGINT, SIGTERM, SIGHUP and SIGCHLD out of the usual way, to be read where the program
/// waits anyway. Make it first in main(): threads inherit it.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// Waits at most `seconds`, less if a signal comes. True once one of the first three has come.
  bool Wait(double seconds);

 private:
  int fd_;
  bool has_stopped_{false};
};

}  // namespace hires::base
