#include "base/captured_program.h"

#include <gmock/gmock.h>

#include "hires/base/process.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::base::captured_program_test {
namespace {

using hires::test_support::ConfigErrorOf;
using ::testing::HasSubstr;

TEST(RunAndCaptureTest, KeepsBothOutputsAndTheExitCode) {
  const ProgramOutput result =
      RunAndCapture({"/bin/sh", "-c", "echo out; echo errors >&2; exit 3"}, 30.0);
  EXPECT_EQ(result.out, "out\n");
  EXPECT_EQ(result.errors, "errors\n");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_FALSE(result.has_run_out_of_time);
}

TEST(RunAndCaptureTest, TakesLongOutputsOfBoth) {
  const ProgramOutput result = RunAndCapture(
      {"/bin/sh", "-c", "head -c 300000 /dev/zero; head -c 200000 /dev/zero >&2; cat"}, 30.0);
  EXPECT_EQ(result.out.size(), 300000u);
  EXPECT_EQ(result.errors.size(), 200000u);
  EXPECT_EQ(result.exit_code, 0);
}

TEST(RunAndCaptureTest, EndsWhatTakesTooLong) {
  const double begin = SteadyNow();
  EXPECT_TRUE(RunAndCapture({"/bin/sh", "-c", "sleep 300 | sleep 300"}, 0.2).has_run_out_of_time);
  EXPECT_TRUE(
      RunAndCapture({"/bin/sh", "-c", "exec >&- 2>&-; sleep 300"}, 0.2).has_run_out_of_time);
  EXPECT_LT(SteadyNow() - begin, 60.0);
}

TEST(RunAndCaptureTest, WhatASignalEndsHasNoExitCode) {
  EXPECT_FALSE(RunAndCapture({"/bin/sh", "-c", "kill -9 $$"}, 30.0).exit_code.has_value());
}

TEST(RunAndCaptureTest, ArgumentsAreNoShells) {
  EXPECT_EQ(RunAndCapture({"printf", "%s", "$(id); 'x' `y`"}, 30.0).out, "$(id); 'x' `y`");
}

TEST(RunAndCaptureTest, AProgramThatIsMissingIsNamed) {
  EXPECT_THAT(ConfigErrorOf([] { RunAndCapture({"/no/such/program"}, 1.0); }),
              HasSubstr("/no/such/program cannot be started"));
  EXPECT_EQ(ProgramOnPath("no_such_program_anywhere"), "");
  EXPECT_THAT(ProgramOnPath("sh"), HasSubstr("/sh"));
}

}  // namespace
}  // namespace hires::base::captured_program_test
