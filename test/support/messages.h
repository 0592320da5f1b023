#pragma once

#include <string>

#include "hires/base/error.h"

namespace hires::test_support {

/// The message of the base::ConfigError that `run` throws, or a text that says that none came.
template <typename Run>
std::string ConfigErrorOf(Run run) {
  try {
    run();
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "(no ConfigError was thrown)";
}

}  // namespace hires::test_support
