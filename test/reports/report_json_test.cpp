#include "reports/text/report_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "hires/base/text.h"
#include "hires/imagination/local_imagination.h"
#include "imagination/room_rollouts.h"
#include "reports/report_examples.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::reports::report_json_test {
namespace {

using hires::test_support::ConfigErrorOf;
using hires::test_support::TemporaryFolder;
using hires::test_support::TwoAlternatives;
using imagination::ImaginationOutcome;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(ReportJsonTest, MatchesTheGoldenFile) {
  const std::string golden =
      base::ReadTextFile(std::string(HIRES_SOURCE_DIR) + "/test/data/reports/report.json");
  EXPECT_EQ(ToJson(TwoAlternatives()).dump(2) + "\n", golden);
}

TEST(ReportJsonTest, NothingRecommendedIsNull) {
  imagination::Report report;
  report.outcome = ImaginationOutcome::kNoWorker;
  const auto json = ToJson(report);
  EXPECT_TRUE(json.at("recommended").is_null());
  EXPECT_TRUE(json.at("ranking").is_array());
  EXPECT_TRUE(json.at("ranking").empty());
  EXPECT_EQ(json.at("real_time_factor"), 0.0);
}

TEST(ReportJsonTest, WhatStandsBehindACostIsToldByPlacesOfTheRanking) {
  imagination::Report report = TwoAlternatives();
  imagination::CostReasons reasons;
  reasons.prices = {{base::FailureCode::kObjectFell, 600.0}};
  reasons.next = imagination::CostComparison{1, -5.75, -150.0, 12.5, false, 0.875};
  reasons.turning = imagination::TurningPrice{base::FailureCode::kObjectFell, 23.0, true, 1};
  reasons.probability = 0.75;
  reasons.regret = 1.5;
  reasons.until_settled = 250;
  report.by_cost = reasons;
  EXPECT_EQ(ToJson(report).at("by_cost").dump(),
            R"({"probability_best":0.75,"expected_regret":1.5,"rollouts_to_settle":250,)"
            R"("prices":[{"failure":"object_fell","price":600.0}],)"
            R"("next":{"place":1,"time_saved":-5.75,"failures_more":-150.0,)"
            R"("failures_more_upper":12.5,"neither_failed":false,"probability":0.875},)"
            R"("turns":{"failure":"object_fell","price":23.0,"when":"less","place":1}})");
  report.by_cost = imagination::CostReasons();
  EXPECT_EQ(ToJson(report).at("by_cost").dump(),
            R"({"probability_best":1.0,"expected_regret":0.0,"rollouts_to_settle":null,)"
            R"("prices":[],"next":null,"turns":null})");
}

TEST(ReportJsonTest, MinSuccessIsToldUnlessTheRuleAsksForNone) {
  imagination::Criteria criteria;
  criteria.min_success = 0.8;
  const auto json = ToJson(TwoAlternatives(), criteria);
  EXPECT_EQ(json.at("min_success"), 0.8);
  EXPECT_EQ(json.at("why"), ToJson(TwoAlternatives()).at("why"));
  criteria.rule = imagination::RankingRule::kThesis;
  EXPECT_TRUE(ToJson(TwoAlternatives(), criteria).at("min_success").is_null());
}

TEST(ReportJsonTest, OutcomesHaveNames) {
  imagination::Report report;
  const auto name = [&](ImaginationOutcome outcome, bool complete) {
    report.outcome = outcome;
    report.complete = complete;
    return OutcomeName(report);
  };
  EXPECT_EQ(name(ImaginationOutcome::kRanked, true), "ranked");
  EXPECT_EQ(name(ImaginationOutcome::kRanked, false), "ranked_at_deadline");
  EXPECT_EQ(name(ImaginationOutcome::kClose, true), "close");
  EXPECT_EQ(name(ImaginationOutcome::kClose, false), "close");
  EXPECT_EQ(name(ImaginationOutcome::kAllFailed, true), "all_failed");
  EXPECT_EQ(name(ImaginationOutcome::kUndecided, true), "undecided");
  EXPECT_EQ(name(ImaginationOutcome::kNoWorker, false), "no_worker");
  EXPECT_EQ(name(ImaginationOutcome::kNothingFinished, false), "nothing_finished");
  EXPECT_EQ(name(ImaginationOutcome::kCancelled, false), "cancelled");
}

TEST(ReportJsonTest, WritesAWholeFile) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "report.json").string();
  const auto json = ToJson(TwoAlternatives());
  WriteJson(json, path);
  EXPECT_EQ(base::ReadTextFile(path), json.dump(2) + "\n");
}

TEST(ReportJsonTest, ReplacesAnEarlierFileAndLeavesNothingElse) {
  const TemporaryFolder folder;
  const std::string path = folder.Write("report.json", "an earlier answer");
  WriteJson({{"a", 1}}, path);
  EXPECT_EQ(base::ReadTextFile(path), "{\n  \"a\": 1\n}\n");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(ReportJsonTest, WhatCannotBeReplacedStays) {
  const TemporaryFolder folder;
  EXPECT_THAT(ConfigErrorOf([&] {
                WriteJson({{"a", 1}}, folder.path().string());
              }),
              HasSubstr("cannot be written"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(ReportJsonTest, ADeviceIsWrittenStraight) {
  EXPECT_NO_THROW(WriteJson({{"a", 1}}, "/dev/null"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(ReportJsonTest, SaysWhereItCannotWrite) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "missing" / "report.json").string();
  EXPECT_THAT(ConfigErrorOf([&] { WriteJson(ToJson(TwoAlternatives()), path); }),
              AllOf(HasSubstr(path), HasSubstr("cannot be written"), HasSubstr("folder")));
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(ReportJsonTest, AFileWhereAFolderIsWantedIsCalledAFile) {
  const TemporaryFolder folder;
  const std::string file = folder.Write("file", ""), gone = (folder.path() / "gone").string();
  EXPECT_NO_THROW(RequireFolder("--clouds", folder.path().string()));
  EXPECT_EQ(ConfigErrorOf([&] { RequireFolder("--clouds", file); }),
            "--clouds: '" + file + "' is a file; wanted a folder");
  EXPECT_EQ(ConfigErrorOf([&] { RequireFolder("--clouds", gone); }),
            "--clouds: folder '" + gone + "' does not exist; make it");
  EXPECT_EQ(ConfigErrorOf([&] { RequireFolderOf(file + "/seen.json"); }),
            file + "/seen.json: cannot be written, '" + file + "' is a file; wanted a folder");
}

TEST(ReportJsonTest, TheNumberOfThreadsShowsNowhereButInTheWallsTime) {
  const imagination::RolloutSetup setup = hires::test_support::RoomRollouts(
      hires::test_support::Room(), "tower", hires::test_support::SomeUncertainty());
  const std::vector<base::ActionCall> actions{{"move_base_param", {"east", "fast"}},
                                              {"move_base_param", {"east", "slow"}}};
  imagination::SchedulerParams params;
  params.rollouts = 6;
  params.first_look = 3;
  const auto text = [&](int threads) {
    auto json = ToJson(imagination::ImagineLocally(setup, actions, params, threads));
    json.erase("wall_seconds");
    json.erase("real_time_factor");
    return json.dump(2);
  };
  const std::string one = text(1);
  EXPECT_EQ(text(2), one);
  EXPECT_EQ(text(3), one);
}

}  // namespace
}  // namespace hires::reports::report_json_test
