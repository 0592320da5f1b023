#pragma once

#include <algorithm>
#include <cstdlib>

namespace hires::test_support {

/// How often a test draws and looks: all of it with HIRES_LONG_TESTS in the environment, as
/// `scripts/test --long` has it; else a quarter, the first of them.
inline int Rounds(int all) {
  return std::getenv("HIRES_LONG_TESTS") != nullptr ? all : std::max(1, all / 4);
}

}  // namespace hires::test_support
