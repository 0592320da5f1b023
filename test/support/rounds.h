#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace hires::test_support {

/// Whether all is played, as `scripts/test --long` does.
inline bool IsLongRun() { return std::getenv("HIRES_LONG_TESTS") != nullptr; }

/// How often a test draws and looks: all of it with HIRES_LONG_TESTS in the environment, as
/// `scripts/test --long` has it; else a quarter, the first of them.
inline int Rounds(int all) { return IsLongRun() ? all : std::max(1, all / 4); }

/// First line of a test that takes long and seldom breaks: it plays only in the long run.
#define HIRES_LONG_CASE() \
  if (!hires::test_support::IsLongRun()) GTEST_SKIP() << "only in scripts/test --long"

}  // namespace hires::test_support
