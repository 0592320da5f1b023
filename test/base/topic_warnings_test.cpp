#include "hires/base/topic_warnings.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "hires/base/log.h"

namespace hires::base::topic_warnings_test {
namespace {

TEST(TopicWarningsTest, EachTopicIsWarnedOfOnceInASecond) {
  std::vector<std::string> lines;
  SetLogSink([&](LogLevel level, const std::string& line) {
    EXPECT_EQ(level, LogLevel::kWarn);
    lines.push_back(line);
  });
  TopicWarnings warnings;
  for (int i = 0; i < 3; ++i) {
    warnings.Tell("scan", "dropped", "no ranges");
    warnings.Tell("tf", "doubtful", "two publishers");
  }
  SetLogSink({});
  EXPECT_THAT(lines, testing::ElementsAre("topic=scan dropped why=no ranges",
                                          "topic=tf doubtful why=two publishers"));
}

}  // namespace
}  // namespace hires::base::topic_warnings_test
