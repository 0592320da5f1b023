#include "reports/text/report_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hires/base/text.h"
#include "reports/report_examples.h"

namespace hires::reports::report_table_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(FormatTableTest, TextGoesLeftNumbersGoRight) {
  EXPECT_EQ(FormatTable({{"name", "n"}, {"a", "1"}, {"longer", "200"}}),
            "name    n\n"
            "-----------\n"
            "a         1\n"
            "longer  200\n");
}

TEST(FormatTableTest, CountsCharactersNotBytes) {
  EXPECT_EQ(FormatTable({{"a"}, {"1 ± 2"}, {"10.5"}}),
            "a\n"
            "-----\n"
            "1 ± 2\n"
            " 10.5\n");
}

TEST(FormatTableTest, EmptyAndRaggedRowsAreFine) {
  EXPECT_EQ(FormatTable({}), "");
  EXPECT_EQ(FormatTable({{"a"}, {"b", "c"}}), "a\n----\nb  c\n");
}

TEST(RankingTableTest, MatchesTheGoldenFile) {
  const std::string golden =
      base::ReadTextFile(std::string(HIRES_SOURCE_DIR) + "/test/data/reports/ranking.txt");
  EXPECT_EQ(RankingTable(test_support::TwoAlternatives().ranking, 0), golden);
}

TEST(RankingTableTest, ShowsCostsWhereTheyDecide) {
  const auto ranking = test_support::TwoAlternatives().ranking;
  EXPECT_THAT(RankingTable(ranking, 0), Not(HasSubstr("cost")));
  const std::string table = RankingTable(ranking, 0, true);
  EXPECT_THAT(table, HasSubstr("cost"));
  EXPECT_THAT(table, HasSubstr("20.0 s  16.0 .. 32.5 s"));
  EXPECT_THAT(table, Not(HasSubstr("seconds;")));
  EXPECT_THAT(RankingTable(ranking, 0, true, "a fall costs 600 s"),
              HasSubstr("\ncost: seconds; a fall costs 600 s\n"));
}

TEST(RankingTableTest, SaysWhatKindOfIntervalsItShows) {
  auto ranking = test_support::TwoAlternatives().ranking;
  for (auto& prediction : ranking) {
    prediction.evidence.success.kind = imagination::IntervalKind::kClopperPearson;
  }
  EXPECT_THAT(RankingTable(ranking, 0),
              HasSubstr("Clopper-Pearson (the number of rollouts was fixed beforehand)"));
  EXPECT_THAT(RankingTable({}, -1), Not(HasSubstr("intervals")));
}

TEST(RankingTableTest, MarksTheRecommendedLineAlone) {
  const auto ranking = test_support::TwoAlternatives().ranking;
  EXPECT_THAT(RankingTable(ranking, -1), Not(HasSubstr(">")));
  EXPECT_THAT(RankingTable(ranking, 1), HasSubstr("\n>  move_base_param(east, fast)"));
}

TEST(FailureLinesTest, SentencesStandBelowTheTableAndNotInIt) {
  using Code = base::FailureCode;
  auto ranking = test_support::TwoAlternatives().ranking;
  const std::string sentence = "the way ends at x 2.85 m, y 2.05 m; beyond it is a wall of the map";
  for (auto& prediction : ranking)
    prediction.evidence.failures = {{{Code::kNoPath, {}, sentence}, 4}};
  ranking[1].evidence.failures[{Code::kRobotCollision,
                                {"base", "house::coat_stand"},
                                "base touches house::coat_stand at x 0.15 m, y 0.00 m"}] = 2;
  ranking[1].evidence.failures[{Code::kObjectFell, {"stick"}}] = 3;
  const std::string table = RankingTable(ranking, -1);
  EXPECT_THAT(table, HasSubstr("robot_collision: base touches house::coat_stand 2"));
  EXPECT_THAT(table, HasSubstr("object_fell: stick 3"));
  EXPECT_THAT(table, Not(HasSubstr("the way ends")));
  EXPECT_EQ(FailureLines(ranking), "no_path: " + ToString(ranking[0].action) + ", " +
                                       ToString(ranking[1].action) + ": " + sentence +
                                       "\nrobot_collision: " + ToString(ranking[1].action) +
                                       ": base touches house::coat_stand at x 0.15 m, y 0.00 m\n");
  EXPECT_EQ(FailureLines(test_support::TwoAlternatives().ranking), "");
}

imagination::Progress ProgressOf(int done, int total, std::optional<double> left = {}) {
  return {done, total, static_cast<double>(done) / total, left};
}

TEST(ProgressLineTest, ShowsBarShareAndTimeLeft) {
  EXPECT_EQ(ProgressLine(ProgressOf(32, 64, 4.2)),
            "[############............]  50 %  32 of 64 rollouts, 4 s left");
  EXPECT_EQ(ProgressLine(ProgressOf(0, 64)), "[........................]   0 %  0 of 64 rollouts");
  EXPECT_EQ(ProgressLine(ProgressOf(64, 64, 0.0)),
            "[########################] 100 %  64 of 64 rollouts, 0 s left");
}

TEST(ProgressLineTest, AnEarlyEndIsFullAlthoughNotAllWasPlayed) {
  imagination::Progress progress = ProgressOf(32, 64);
  progress.fraction = 1.0;
  EXPECT_THAT(ProgressLine(progress), HasSubstr("] 100 %  32 of 64"));
}

TEST(ProgressLineTest, KeepsToItsWidth) {
  EXPECT_EQ(ProgressLine(ProgressOf(32, 64), 20), "[############.......");
  EXPECT_EQ(ProgressLine(ProgressOf(32, 64), 0), "");
}

}  // namespace
}  // namespace hires::reports::report_table_test
