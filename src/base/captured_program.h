#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hires::base {

/// What a program did and said until it ended.
struct ProgramOutput {
  std::string out;                  ///< its standard output
  std::string errors;               ///< what it wrote to the other
  std::optional<int> exit_code;     ///< nothing where a signal ended it
  bool has_run_out_of_time{false};  ///< it was killed, with all that it had started
};

/// Runs a program without a shell, its input empty, and waits until it ends.
/// @param command  program (a path, or a name on PATH) and arguments, as they are.
/// @param limit    [s] after which it is killed.
/// @throws ConfigError where it cannot be started, or writes more than 64 MB.
ProgramOutput RunAndCapture(const std::vector<std::string>& command, double limit);

/// Path of a program on PATH; "" where there is none.
std::string ProgramOnPath(const std::string& name);

}  // namespace hires::base
