#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "lab/src/experiment/report.h"

namespace hires::lab::experiment_report_test {
namespace {

using testing::HasSubstr;
using Relation = Expectation::Relation;

std::vector<Expectation> Read(const std::string& yaml) {
  base::ParamReader in = base::ParamReader::FromString(yaml, "e.yaml");
  auto expectations = ReadExpectations(&in);
  in.RejectUnknownKeys();
  return expectations;
}

std::string ErrorOf(const std::string& yaml) {
  try {
    Read(yaml);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

ExperimentReport SomeReport() {
  ExperimentReport report;
  report.name = "walk";
  report.kind = "legs";
  report.seed = 7;
  report.findings.tables = {{"Legs", {{"to", "n"}, {"NT1", "3"}}}, {"Problems", {{"leg"}}}};
  report.findings.measures = {{"reached", 3.0}, {"ratio", std::numeric_limits<double>::infinity()}};
  report.findings.intervals = {{"ratio", {2.0, 1.5, std::numeric_limits<double>::infinity()}}};
  report.findings.rows.push_back({{"to", "NT1"}, {"reason", "a, \"b\""}, {"duration", 0.1}});
  report.findings.rows.push_back({{"to", "ST1"}, {"reason", ""}, {"duration", 12.0}});
  report.checks =
      CheckExpectations({{"reached", Relation::kAtLeast, 3.0}}, report.findings.measures);
  return report;
}

TEST(ExpectationTest, EveryRelationHoldsAndBreaksAtItsBound) {
  const auto holds = [](Relation relation, double value) {
    return Expectation{"x", relation, 2.0}.HoldsFor(value);
  };
  EXPECT_TRUE(holds(Relation::kAtLeast, 2.0));
  EXPECT_FALSE(holds(Relation::kAtLeast, 1.9));
  EXPECT_TRUE(holds(Relation::kAtMost, 2.0));
  EXPECT_FALSE(holds(Relation::kAtMost, 2.1));
  EXPECT_TRUE(holds(Relation::kAbove, 2.1));
  EXPECT_FALSE(holds(Relation::kAbove, 2.0));
  EXPECT_TRUE(holds(Relation::kBelow, 1.9));
  EXPECT_FALSE(holds(Relation::kBelow, 2.0));
}

TEST(ExpectationTest, NoNumberHoldsNothing) {
  for (const Relation relation :
       {Relation::kAtLeast, Relation::kAtMost, Relation::kAbove, Relation::kBelow}) {
    EXPECT_FALSE((Expectation{"x", relation, 2.0}).HoldsFor(std::nan("")));
  }
}

TEST(ExpectationTest, IsReadWithItsRelation) {
  const auto read = Read("expect: [{measure: a, at_most: 3}, {measure: b, above: -0.5}]");
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(ToString(read[0]), "a at most 3");
  EXPECT_EQ(ToString(read[1]), "b above -0.5");
  EXPECT_TRUE(Read("expect: []").empty());
}

TEST(ExpectationTest, NoneOrTwoRelationsAreRefused) {
  EXPECT_THAT(ErrorOf("expect: [{measure: a}]"), HasSubstr("exactly one of at_least"));
  EXPECT_THAT(ErrorOf("expect: [{measure: a, above: 1, below: 2}]"),
              HasSubstr("expect[0].measure is 'a', wanted with it exactly one"));
}

TEST(ExpectationTest, UnknownKeysAndNoNumbersAreRefused) {
  EXPECT_THAT(ErrorOf("expect: [{measure: a, at_leas: 1, above: 0}]"),
              HasSubstr("key 'expect[0].at_leas' is unknown"));
  EXPECT_THAT(ErrorOf("expect: [{measure: a, above: much}]"), HasSubstr("wanted a number"));
  EXPECT_THAT(ErrorOf("measures: []"), HasSubstr("expect is missing"));
}

TEST(ExpectationTest, AMeasureThatDoesNotExistIsRefusedWithNamesLikeIt) {
  try {
    CheckExpectations({{"reachd", Relation::kAtLeast, 1.0}}, {{"reached", 1.0}});
    FAIL() << "accepted";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("measure 'reachd' is unknown; did you mean 'reached'"));
  }
}

TEST(ReportTest, PassesOnlyWhenEveryExpectationHolds) {
  ExperimentReport report = SomeReport();
  EXPECT_TRUE(report.passed());
  report.checks.push_back({{"reached", Relation::kAbove, 3.0}, 3.0, false});
  EXPECT_FALSE(report.passed());
}

TEST(ReportTest, TextShowsTablesWithRowsOnly) {
  const std::string text = ReportText(SomeReport());
  EXPECT_THAT(text, HasSubstr("walk (legs), seed 7, parameters 0000000000000000"));
  EXPECT_THAT(text, HasSubstr("NT1"));
  EXPECT_THAT(text, HasSubstr("ok  reached at least 3      3"));
  EXPECT_THAT(text, testing::Not(HasSubstr("Problems")));
}

TEST(ReportTest, CsvQuotesWhatNeedsIt) {
  EXPECT_EQ(ReportCsv(SomeReport()), "to,reason,duration\nNT1,\"a, \"\"b\"\"\",0.1\nST1,,12.0\n");
}

TEST(ReportTest, JsonHasNullForWhatIsNoNumber) {
  const auto json = ToJson(SomeReport());
  EXPECT_EQ(json["measures"]["reached"], 3.0);
  EXPECT_TRUE(json["measures"]["ratio"].is_null());
  EXPECT_EQ(json["intervals"]["ratio"]["estimate"], 2.0);
  EXPECT_EQ(json["intervals"]["ratio"]["lower"], 1.5);
  EXPECT_TRUE(json["intervals"]["ratio"]["upper"].is_null());
  EXPECT_EQ(json["expectations"][0]["expected"], "reached at least 3");
  EXPECT_EQ(json["passed"], true);
  EXPECT_EQ(json["rows"].size(), 2u);
}

}  // namespace
}  // namespace hires::lab::experiment_report_test
