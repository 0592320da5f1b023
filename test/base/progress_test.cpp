#include "hires/base/progress.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace hires::base::progress_test {
namespace {

TEST(ProgressTest, ReportsGoToTheSinkWhileThereIsOne) {
  std::vector<std::pair<std::string, double>> heard;
  SetProgressSink([&](const std::string& task, double share) { heard.push_back({task, share}); });
  ReportProgress("reading", 0.25);
  SetProgressSink({});
  ReportProgress("reading", 0.5);
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(heard[0].first, "reading");
  EXPECT_EQ(heard[0].second, 0.25);
}

TEST(ProgressPaceTest, WhatIsDoneWithinASecondHasNoLine) {
  ProgressPace pace(true);
  EXPECT_FALSE(pace.IsDue("reading", 100.0));
  EXPECT_FALSE(pace.IsDue("reading", 100.9));
}

TEST(ProgressPaceTest, ALineDrawnOverItselfFollowsEachReportAfterASecond) {
  ProgressPace pace(true);
  pace.IsDue("reading", 100.0);
  EXPECT_TRUE(pace.IsDue("reading", 101.0));
  EXPECT_TRUE(pace.IsDue("reading", 101.1));
}

TEST(ProgressPaceTest, LinesOfALogAreFiveSecondsApart) {
  ProgressPace pace(false);
  pace.IsDue("reading", 100.0);
  EXPECT_TRUE(pace.IsDue("reading", 101.0));
  EXPECT_FALSE(pace.IsDue("reading", 105.9));
  EXPECT_TRUE(pace.IsDue("reading", 106.0));
}

TEST(ProgressPaceTest, EachTaskHasAFirstSecondOfItsOwn) {
  ProgressPace pace(true);
  pace.IsDue("reading", 100.0);
  EXPECT_FALSE(pace.IsDue("writing", 110.0));
  EXPECT_TRUE(pace.IsDue("writing", 111.0));
}

}  // namespace
}  // namespace hires::base::progress_test
