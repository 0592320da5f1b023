#pragma once

#include <string>
#include <vector>

#include "cli/command_run.h"
#include "lab/src/verbs/command_line.h"

namespace hires::test_support {

/// `hires_lab VERBS WORDS`, with the package's files where `backends` name no others.
inline Ended RunLab(const std::vector<std::string>& verbs, const std::vector<std::string>& words = {},
                    lab::LabBackends backends = {}) {
  if (backends.package_folder.empty()) backends.package_folder = HIRES_SOURCE_DIR;
  std::vector<std::string> arguments{"hires_lab"};
  arguments.insert(arguments.end(), verbs.begin(), verbs.end());
  arguments.insert(arguments.end(), words.begin(), words.end());
  return Capture([&] { return lab::RunLabCommandLine(arguments, backends); });
}

}  // namespace hires::test_support
