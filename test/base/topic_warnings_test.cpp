#include "hires/base/topic_warnings.h"

#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "hires/base/log.h"

namespace hires::base::topic_warnings_test {
namespace {

/// What is told in the time of `last`, by calls of `tell` every tenth of a second.
template <typename F>
std::vector<std::string> ToldWithin(double last, const F& tell) {
  std::vector<std::string> lines;
  SetLogSink([&](LogLevel level, const std::string& line) {
    EXPECT_EQ(level, LogLevel::kWarn);
    lines.push_back(line);
  });
  for (int i = 0; i <= std::lround(last / 0.1); ++i) tell(100.0 + 0.1 * i, i);
  SetLogSink({});
  return lines;
}

TEST(TopicWarningsTest, EachTopicIsWarnedOfOnceInASecond) {
  TopicWarnings warnings;
  const auto lines = ToldWithin(0.5, [&](double now, int) {
    warnings.Tell("scan", "dropped", "no ranges", now);
    warnings.Tell("scan", "dropped", "another type", now);
    warnings.Tell("tf", "doubtful", "two publishers", now);
  });
  EXPECT_THAT(lines, testing::ElementsAre("topic=scan dropped why=no ranges",
                                          "topic=tf doubtful why=two publishers"));
}

TEST(TopicWarningsTest, WhatStaysWrongIsSaidWithGrowingPausesWhateverItsNumbers) {
  for (const bool is_numbered : {false, true}) {
    TopicWarnings warnings;
    const auto lines = ToldWithin(3600.0, [&](double now, int i) {
      const std::string number = is_numbered ? std::to_string(-0.5 * i) : "";
      warnings.Tell("scan", "dropped", "comes too late " + number, now);
    });
    EXPECT_LE(lines.size(), 13u);
    EXPECT_GE(lines.size(), 10u);
  }
}

TEST(TopicWarningsTest, ReasonsThatChangeAreSaidAndThoseThatTakeTurnsNotForEver) {
  TopicWarnings warnings;
  const auto two = ToldWithin(600.0, [&](double now, int i) {
    warnings.Tell("scan", "dropped", i % 2 == 0 ? "no ranges" : "another type", now);
  });
  EXPECT_LE(two.size(), 22u);
  EXPECT_THAT(two, testing::Contains("topic=scan dropped why=another type"));
  EXPECT_EQ(
      ToldWithin(0.0, [&](double, int) { warnings.Tell("scan", "dropped", "a third", 1000.0); })
          .size(),
      1u);
}

TEST(TopicWarningsTest, AfterACalmItIsSaidAtOnce) {
  TopicWarnings warnings;
  const auto tell = [&](double now, int) { warnings.Tell("scan", "dropped", "no ranges", now); };
  EXPECT_GT(ToldWithin(300.0, tell).size(), 5u);
  EXPECT_EQ(ToldWithin(0.0, [&](double, int) { tell(412.0, 0); }).size(), 1u);
}

}  // namespace
}  // namespace hires::base::topic_warnings_test
