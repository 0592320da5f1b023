#pragma once

#include <string>

namespace hires::base {

/// Makes this process the parent of whatever its descendants leave behind: what roslaunch starts
/// lives in process groups of its own and would outlive it otherwise.
void AdoptOrphans();

/// Has the kernel send SIGTERM, rather than SIGKILL, when the process that started this one ends.
void StopWithParent();

/// Kills all descendants, until there are none. @pre AdoptOrphans was called, no ChildProcess
/// lives.
void KillDescendants();

/// A block of ports that are free on loopback, and claimed: no two claims in this network namespace
/// overlap as long as they live, in whichever process.
class PortClaim {
 public:
  /// @param size  1 .. kPortBlock.
  /// @throws ConfigError if nothing is free.
  explicit PortClaim(int size);
  ~PortClaim();
  PortClaim(const PortClaim&) = delete;
  PortClaim& operator=(const PortClaim&) = delete;

  int first() const { return first_; }

 private:
  bool Claim(int first, int size);

  int first_{0};
  int lock_{-1};  // a socket whose name says which block is taken
};
constexpr int kPortBlock = 100;

/// What a process said last: the last line of that file; "" where it is missing or empty.
std::string LastLineOf(const std::string& path);

/// A new folder; gone with its owner unless it was given by name.
class RunFolder {
 public:
  /// @param path  Made where it is missing; empty: a new one among the temporary files.
  /// @throws ConfigError if it cannot be made.
  explicit RunFolder(const std::string& path);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
  bool is_temporary_;
};

}  // namespace hires::base
