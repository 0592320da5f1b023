#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "cli/command_line.h"
#include "cli/exit_code.h"

namespace hires::test_support {

/// What the program printed, and how it ended.
struct Ended {
  int code{0};
  std::string out, err;
};

/// @param run  gives an exit code.
template <typename Run>
Ended Capture(const Run& run) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Ended ended;
  ended.code = run();
  ended.out = testing::internal::GetCapturedStdout();
  ended.err = testing::internal::GetCapturedStderr();
  return ended;
}

/// `hires VERBS WORDS`, with the package's files where `backends` name no others.
inline Ended RunHires(const std::vector<std::string>& verbs,
                      const std::vector<std::string>& words = {}, cli::Backends backends = {}) {
  if (backends.package_folder.empty()) backends.package_folder = HIRES_SOURCE_DIR;
  std::vector<std::string> arguments{"hires"};
  arguments.insert(arguments.end(), verbs.begin(), verbs.end());
  arguments.insert(arguments.end(), words.begin(), words.end());
  return Capture([&] { return cli::RunCommandLine(arguments, backends); });
}

}  // namespace hires::test_support
