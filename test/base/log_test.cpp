#include "hires/base/log.h"

#include <gmock/gmock.h>

#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace hires::base::log_test {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

/// Gives the process its default sink back when a test ends, however it ends.
class LogTest : public ::testing::Test {
 protected:
  ~LogTest() override { SetLogSink({}); }
  void CollectLines() {
    SetLogSink(
        [this](LogLevel level, const std::string& line) { lines_.emplace_back(level, line); });
  }
  std::vector<std::pair<LogLevel, std::string>> lines_;
};

TEST_F(LogTest, TheSinkGetsEveryLevelAsItCame) {
  CollectLines();
  Log(LogLevel::kDebug, "step=1");
  Log(LogLevel::kError, "rollout=17 outcome=lost");
  EXPECT_THAT(lines_, ElementsAre(Pair(LogLevel::kDebug, "step=1"),
                                  Pair(LogLevel::kError, "rollout=17 outcome=lost")));
}

TEST_F(LogTest, WithoutASinkWarningsAndErrorsGoToStandardError) {
  ::testing::internal::CaptureStderr();
  Log(LogLevel::kDebug, "quiet");
  Log(LogLevel::kInfo, "quiet");
  Log(LogLevel::kWarn, "odd=1");
  Log(LogLevel::kError, "broken=1");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "warning: odd=1\nerror: broken=1\n");
}

TEST_F(LogTest, AnEmptySinkRestoresTheDefault) {
  CollectLines();
  SetLogSink({});
  ::testing::internal::CaptureStderr();
  Log(LogLevel::kWarn, "odd=1");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "warning: odd=1\n");
  EXPECT_TRUE(lines_.empty());
}

TEST_F(LogTest, ASinkThatThrowsLeavesTheLogUsable) {
  SetLogSink([](LogLevel, const std::string&) { throw std::runtime_error("sink"); });
  EXPECT_THROW(Log(LogLevel::kInfo, "a"), std::runtime_error);
  CollectLines();
  Log(LogLevel::kInfo, "b");
  EXPECT_THAT(lines_, ElementsAre(Pair(LogLevel::kInfo, "b")));
}

TEST_F(LogTest, ASinkMayLogItself) {
  SetLogSink([this](LogLevel level, const std::string& line) {
    if (lines_.empty()) {
      lines_.emplace_back(level, line);
      Log(LogLevel::kWarn, "from within");
    } else {
      lines_.emplace_back(level, line);
    }
  });
  Log(LogLevel::kInfo, "a");
  EXPECT_THAT(lines_,
              ElementsAre(Pair(LogLevel::kInfo, "a"), Pair(LogLevel::kWarn, "from within")));
}

TEST_F(LogTest, NoLineOfManyThreadsIsLost) {
  CollectLines();  // the sink needs no lock of its own
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([t] {
      for (int i = 0; i < 500; ++i) Log(LogLevel::kInfo, std::to_string(t));
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(lines_.size(), 2000u);
}

}  // namespace
}  // namespace hires::base::log_test
