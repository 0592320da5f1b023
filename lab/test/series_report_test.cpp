#include "lab/src/series/series_report.h"

#include <gmock/gmock.h>

#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "hires/base/text.h"
#include "hires/temporal/interval.h"
#include "knowledge/support/store_world.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::lab::series_report_test {
namespace {

using hires::test_support::ConfigErrorOf;
using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

ordered_json Achieved(const std::string& outcome, bool has_begun) {
  ordered_json step{{"action", "move_base"}, {"started", nullptr}};
  if (has_begun) step["started"] = 2.0;
  return {{"outcome", outcome},
          {"reason", "no path"},
          {"failure", {{"failure", "no_path"}}},
          {"duration", 100.0},
          {"steps", {{{"action", "imagine"}, {"started", 1.0}}, step}},
          {"in_truth",
           {{"virtual_seconds", 103.5},
            {"touched", "chair1"},
            {"objects", {{"mug1", {{"falls", 0}}}, {"mug2", {{"falls", 2}}}}}}}};
}

SeriesRun Taken(const std::string& outcome, bool has_begun = true) {
  SeriesRun run;
  TakeAchieveReport(Achieved(outcome, has_begun), "result.json", &run);
  return run;
}

TEST(TakeAchieveReportTest, TellsOutcomesApart) {
  EXPECT_EQ(Taken("succeeded").outcome, "succeeded");
  EXPECT_EQ(Taken("succeeded").cause, "");
  EXPECT_EQ(Taken("failed").outcome, "failed");
  EXPECT_EQ(Taken("failed").cause, "no path");
  EXPECT_EQ(Taken("failed").failure, "no_path");
  EXPECT_EQ(Taken("no_plan", false).outcome, "impossible");
  EXPECT_EQ(Taken("no_plan", true).outcome, "failed") << "it was begun";
  EXPECT_EQ(Taken("preempted").outcome, "broken") << "nobody asked for that";
  EXPECT_EQ(Taken("preempted").cause, "preempted: no path");
}

TEST(TakeAchieveReportTest, TakesTimeAndWhatHappenedInTruth) {
  const SeriesRun run = Taken("failed");
  EXPECT_EQ(run.simulated_seconds, 103.5);
  EXPECT_EQ(run.touched, "chair1");
  EXPECT_THAT(run.fallen, ElementsAre("mug2"));
  SeriesRun other;
  EXPECT_THAT(ConfigErrorOf([&] {
                TakeAchieveReport({{"outcome", 3}}, "r.json", &other);
              }),
              HasSubstr("r.json: field 'outcome'"));
}

SeriesRun RunOf(int number, std::vector<int> choices, const std::string& outcome) {
  SeriesRun run;
  run.run = number;
  run.choices = std::move(choices);
  run.instruction = "achieve serve_coffee_to_guest_Task guest1";
  run.outcome = outcome;
  run.simulated_seconds = 300.21;
  run.fluents = 381;
  if (outcome != "broken") run.episode = "replace_" + std::to_string(number);
  if (outcome == "failed") run.cause = "no path, \"none\"";
  return run;
}

SeriesReport Report() {
  SeriesReport report;
  report.series.name = "replace";
  report.series.groups = {{"g", 2, {"poseA"}}};
  knowledge::PoseModification modification;
  modification.instance = "poseA";
  modification.group = "g";
  modification.choices = 2;
  modification.modifications = {{"hasX", {0.0, 1.5}}};
  report.series.modifications = {modification};
  report.runs = {RunOf(1, {0}, "succeeded"), RunOf(2, {1}, "failed"), RunOf(3, {0}, "broken"),
                 RunOf(4, {1}, "impossible")};
  report.runs[2].broken_tries = {"signal 9 (Killed)", "exit code 1"};
  report.stored = 37;
  report.repository = "sim_run1";
  return report;
}

TEST(RunSummaryTest, IsLaidOutAsListing52) {
  EXPECT_EQ(RunSummary(Report().runs[0]),
            "= RUN 1 SUMMARY =\n"
            "=[ INFO]: Scenario episode is: 'replace_1'\n"
            "=[ INFO]: Scenario instruction: 'achieve serve_coffee_to_guest_Task guest1'\n"
            "=[ INFO]: Total (sim) time used: 300.21 seconds\n"
            "=[ INFO]: Total number of Fluents used: 381\n"
            "=[ INFO]: Average ratio of (Fluents/sec): 1.27\n"
            "=[ INFO]: Outcome: succeeded\n");
  EXPECT_THAT(RunSummary(Report().runs[2]),
              AllOf(HasSubstr("none was kept"), HasSubstr("broke down: signal 9 (Killed)")));
}

TEST(SeriesSummaryTest, WhatReallyHappenedCountsBesideWhatTheRobotBelieves) {
  SeriesReport report = Report();
  report.runs.push_back(RunOf(5, {0}, "succeeded"));
  report.runs.push_back(RunOf(6, {0}, "succeeded"));
  report.runs[4].touched = "base_link/body touches table1";
  report.runs[5].fallen = {"mug1"};
  const nlohmann::ordered_json json = ToJson(report);
  EXPECT_EQ(json["outcomes"]["succeeded"], 3);
  EXPECT_EQ(json["outcomes"]["succeeded_in_truth"], 1);
  EXPECT_EQ(json["shares"][0]["succeeded"], 1);
  EXPECT_EQ(json["shares"][0]["played"], 3);
  EXPECT_THAT(SeriesSummary(report), AllOf(HasSubstr("base_link/body touches table1"),
                                           HasSubstr("mug1 fell"), HasSubstr("in truth")));
  EXPECT_DOUBLE_EQ(json["mean_simulated_seconds"], 300.21);
  EXPECT_NEAR(json["mean_fluents_per_second"].get<double>(), 381.0 / 300.21, 1e-9);
}

/// A long run that succeeded, a short one that failed, one that broke; 150 fluents known before.
SeriesReport LongAndShort() {
  SeriesReport report = Report();
  report.runs.resize(3);
  report.runs[0].simulated_seconds = 100.0;
  report.runs[0].fluents = 400;
  report.runs[1].simulated_seconds = 10.0;
  report.runs[1].fluents = 200;
  report.runs[0].known_fluents = report.runs[1].known_fluents = 150;
  return report;
}

TEST(SeriesAveragesTest, ARateIsAllFluentsPerAllSecondsNotTheMeanOfRates) {
  const SeriesReport report = LongAndShort();
  const SeriesAverages all = AveragesOf(report.runs);
  EXPECT_EQ(all.runs, 2) << "of the broken one no episode was kept";
  EXPECT_DOUBLE_EQ(all.simulated_seconds, 55.0);
  EXPECT_DOUBLE_EQ(all.fluents, 300.0);
  EXPECT_DOUBLE_EQ(all.fluents_per_second, 600.0 / 110.0) << "the mean of 4 and 20 would be 12";
  EXPECT_DOUBLE_EQ(all.new_fluents.value(), 150.0);
  EXPECT_DOUBLE_EQ(all.new_fluents_per_second.value(), 300.0 / 110.0);
  const ordered_json json = ToJson(report);
  EXPECT_EQ(json["mean_simulated_seconds"], 55.0);
  EXPECT_EQ(json["mean_fluents"], 300.0);
  EXPECT_EQ(json["mean_fluents_per_second"], json["averages"]["all"]["fluents_per_second"]);
  EXPECT_EQ(json["averages"]["all"]["runs"], 2);
}

TEST(SeriesAveragesTest, ThoseThatSucceededStandBesideAll) {
  const SeriesReport report = LongAndShort();
  EXPECT_EQ(ToJson(report)["averages"]["succeeded"],
            ordered_json({{"runs", 1},
                          {"mean_simulated_seconds", 100.0},
                          {"mean_fluents", 400.0},
                          {"fluents_per_second", 4.0},
                          {"mean_new_fluents", 250.0},
                          {"new_fluents_per_second", 2.5}}));
  const std::string text = SeriesSummary(report);
  for (const auto& [which, numbers] : std::map<std::string, std::vector<std::string>>{
           {"all runs", {"2", "55.0", "s", "300.0", "5.45", "150.0", "2.73"}},
           {"those that succeeded", {"1", "100.0", "s", "400.0", "4.00", "250.0", "2.50"}}}) {
    const std::size_t begin = text.find(which);
    ASSERT_NE(begin, std::string::npos) << text;
    std::istringstream rest(
        text.substr(begin + which.size(), text.find('\n', begin) - begin - which.size()));
    EXPECT_EQ(std::vector<std::string>(std::istream_iterator<std::string>(rest), {}), numbers);
  }
}

TEST(SeriesAveragesTest, OfNoRunsTheyAreNull) {
  SeriesReport report = LongAndShort();
  report.runs[0].outcome = "failed";
  const ordered_json none = ToJson(report)["averages"]["succeeded"];
  EXPECT_EQ(none["runs"], 0);
  EXPECT_TRUE(none["mean_simulated_seconds"].is_null());
  EXPECT_TRUE(none["new_fluents_per_second"].is_null());
}

TEST(SeriesAveragesTest, OneRunThatDoesNotTellWhatWasKnownLeavesNewFluentsUnknown) {
  SeriesReport report = LongAndShort();
  report.runs[1].known_fluents.reset();
  const ordered_json json = ToJson(report)["averages"];
  EXPECT_TRUE(json["all"]["mean_new_fluents"].is_null());
  EXPECT_EQ(json["all"]["mean_fluents"], 300.0);
  EXPECT_EQ(json["succeeded"]["mean_new_fluents"], 250.0) << "that run tells";
  EXPECT_THAT(SeriesSummary(report), HasSubstr("unknown"));
}

TEST(TakeBlackboardTest, FluentsLoadedAsKnowledgeAreToldApart) {
  using test_support::At;
  using test_support::MakeFluent;
  using test_support::PoseAt;
  knowledge::Store store(":memory:", test_support::SmallOntology());
  store.Add({MakeFluent("Mug", "mug1"), PoseAt("poseMug1", 1.0)},
            At(-temporal::kForever, 0, knowledge::Source::kKnowledge));
  store.Add({PoseAt("poseMug1", 2.0), PoseAt("poseVase1", 3.0)}, At(4.0));
  store.Remove({"mug1"}, At(5.0));
  SeriesRun run;
  TakeBlackboard(store, &run);
  EXPECT_EQ(run.fluents, 4u) << "ended ones included";
  EXPECT_EQ(run.known_fluents, 2u);
}

TEST(SeriesSummaryTest, CountsEpisodesOutcomesAndShares) {
  SeriesReport report = Report();
  const std::string text = SeriesSummary(report);
  EXPECT_THAT(text, HasSubstr("= TEST SUMMARY =\n=[ INFO]: 3 episodes created during test with "
                              "names: 'replace_1' 'replace_2' 'replace_4'\n"
                              "=[ INFO]: Average Fluents per episode: 381.00\n"
                              "=[ INFO]: 37 episodes are now in repository 'sim_run1'\n"));
  report.stored = 1;
  EXPECT_THAT(SeriesSummary(report), HasSubstr("=[ INFO]: 1 episode is now in repository"));
  EXPECT_THAT(text, AllOf(HasSubstr("poseA hasX 1.5"), HasSubstr("poseA as it is")));
}

TEST(SharesByChoiceTest, BrokenRunsSayNothingOfAChoice) {
  const std::vector<ChoiceShare> shares = SharesByChoice(Report());
  ASSERT_THAT(shares, SizeIs(2));
  EXPECT_EQ(shares[0].succeeded, 1);
  EXPECT_EQ(shares[0].played, 1);
  EXPECT_EQ(shares[1].succeeded, 0);
  EXPECT_EQ(shares[1].played, 2);
  EXPECT_EQ(shares[1].share.upper, WilsonInterval(0, 2).upper);
}

TEST(SeriesCsvTest, HasAColumnForEachGroupAndQuotesWhatNeedsIt) {
  const std::vector<std::string> lines = base::Split(SeriesCsv(Report()), '\n');
  ASSERT_THAT(lines, SizeIs(6));
  EXPECT_THAT(lines[0], AllOf(HasSubstr("run,g,seed,"), HasSubstr(",fluents,known_fluents,")));
  EXPECT_THAT(lines[2], AllOf(HasSubstr("2,1,"), HasSubstr("\"no path, \"\"none\"\"\"")));
  EXPECT_THAT(lines[3], HasSubstr(",1,,300.21"));  // of two tries that broke one was a restart
}

TEST(SeriesJsonTest, SaysAllOfEachRun) {
  const ordered_json json = ToJson(Report());
  EXPECT_EQ(json["outcomes"]["failed"], 1);
  EXPECT_EQ(json["shares"][1]["members"][0], "poseA hasX 1.5");
  const SeriesRun back = ParseSeriesRun(json["runs"][2], "x");
  EXPECT_EQ(ToJson(back), json["runs"][2]);
  SeriesRun known = RunOf(1, {0}, "succeeded");
  known.known_fluents = 182;
  EXPECT_EQ(ParseSeriesRun(ToJson(known), "x").known_fluents, 182u);
}

TEST(SeriesJournalTest, GoesOnWithOneThatDoesNotTellWhatWasKnown) {
  const test_support::TemporaryFolder folder;
  const std::string path = (folder.path() / "old.journal").string();
  ordered_json old = ToJson(RunOf(1, {0}, "succeeded"));
  ASSERT_EQ(old.erase("known_fluents"), 1u);
  RunJournal(path, {{"journal", "hires_lab scenarios 1"}, {"seed", 1}},
             [](const ordered_json&, const std::string&) {})
      .Append(old);
  SeriesRun next = RunOf(2, {1}, "succeeded");
  next.known_fluents = 182;
  const ordered_json setting{{"seed", 1}};
  SeriesJournal(path, setting).Append(next);
  const SeriesJournal journal(path, setting);
  ASSERT_THAT(journal.runs(), SizeIs(2));
  EXPECT_EQ(journal.runs()[0].fluents, 381u);
  EXPECT_FALSE(journal.runs()[0].known_fluents.has_value());
  EXPECT_EQ(journal.runs()[1].known_fluents, 182u);
}

TEST(SeriesJournalTest, KeepsRunsAndRefusesGaps) {
  const test_support::TemporaryFolder folder;
  const std::string path = (folder.path() / "a.journal").string();
  const ordered_json setting{{"seed", 1}};
  {
    SeriesJournal journal(path, setting);
    journal.Append(RunOf(1, {0}, "succeeded"));
    journal.Append(RunOf(2, {1}, "failed"));
  }
  {
    const SeriesJournal again(path, setting);
    ASSERT_THAT(again.runs(), SizeIs(2));
    EXPECT_EQ(ToJson(again.runs()[1]), ToJson(RunOf(2, {1}, "failed")));
  }
  const std::string other = (folder.path() / "b.journal").string();
  {
    SeriesJournal journal(other, setting);
    journal.Append(RunOf(2, {1}, "failed"));
  }
  EXPECT_THAT(ConfigErrorOf([&] { SeriesJournal(other, setting); }),
              AllOf(HasSubstr("line 2"), HasSubstr("is run 2, wanted run 1")));
  EXPECT_THAT(ConfigErrorOf([&] { SeriesJournal(path, {{"seed", 2}}); }), HasSubstr("seed"));
}

}  // namespace
}  // namespace hires::lab::series_report_test
