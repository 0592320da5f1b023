#include "hires/planning/plan_report.h"

#include <gtest/gtest.h>

#include "support/messages.h"

namespace hires::planning::plan_report_test {
namespace {

using hires::test_support::ConfigErrorOf;

PlanResult Result(PlanOutcome outcome, const std::vector<double>& costs, bool exhausted = false) {
  PlanResult result;
  result.outcome = outcome;
  result.exhausted = exhausted;
  result.progress.expansions = 7;
  for (const double cost : costs) {
    result.plans.emplace_back();
    result.plans.back().cost = cost;
    result.plans.back().steps.resize(1);
  }
  return result;
}

TEST(PlanReportTest, WhatWasFoundIsSaidAsItWasAsked) {
  const auto sentence = [](Which which, const std::vector<double>& costs, bool exhausted) {
    return OutcomeSentence(Result(PlanOutcome::kFound, costs, exhausted), which);
  };
  EXPECT_EQ(sentence(Which::kFirst, {2.5}, false), "1 plan, 1 step, cost 2.5");
  EXPECT_EQ(sentence(Which::kFirst, {2.5}, true), "1 plan, 1 step, cost 2.5; there are no others");
  EXPECT_EQ(sentence(Which::kBest, {4.0}, true), "1 plan, 1 step, cost 4; none is cheaper");
  EXPECT_EQ(sentence(Which::kAll, {4.0, 3.0}, true),
            "2 plans, the cheapest costs 3; there are no others");
  EXPECT_EQ(sentence(Which::kAll, {4.0, 3.0}, false),
            "2 plans, the cheapest costs 3; there may be more");
}

TEST(PlanReportTest, EachWayToEndHasAnotherSentence) {
  const auto sentence = [](PlanOutcome outcome, const std::vector<double>& costs) {
    return OutcomeSentence(Result(outcome, costs), Which::kAll);
  };
  EXPECT_EQ(sentence(PlanOutcome::kNoPlan, {}), "there is no plan; every way was tried");
  EXPECT_EQ(sentence(PlanOutcome::kLimitTime, {}),
            "stopped at the time limit after 7 expansions: no plan found so far; allow more time");
  EXPECT_EQ(sentence(PlanOutcome::kLimitMemory, {3.0}),
            "stopped at the memory limit after 7 expansions: 1 plan, 1 step, cost 3 so far; allow "
            "more memory");
  EXPECT_EQ(sentence(PlanOutcome::kCancelled, {}),
            "cancelled after 7 expansions: no plan found so far");
  EXPECT_EQ(sentence(PlanOutcome::kLimitDepth, {}),
            "gave up paths at the depth limit after 7 expansions: no plan found so far; allow more "
            "depth");
  EXPECT_EQ(sentence(PlanOutcome::kLimitCost, {}),
            "gave up paths at the cost limit after 7 expansions: no plan found so far; allow a "
            "higher cost");
}

TEST(PlanReportTest, WhichIsReadAndRefused) {
  EXPECT_EQ(ParseWhich("first"), Which::kFirst);
  EXPECT_EQ(ParseWhich("all"), Which::kAll);
  EXPECT_EQ(ParseWhich("best"), Which::kBest);
  EXPECT_EQ(ConfigErrorOf([] { ParseWhich("bset"); }),
            "choice of plans 'bset' is unknown; did you mean 'best'?");
}

}  // namespace
}  // namespace hires::planning::plan_report_test
