#include "hires/imagination/rollout_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/messages.h"

namespace hires::imagination::rollout_choice_test {
namespace {

using hires::test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::HasSubstr;
using Kind = RolloutChoice::Kind;

/// Eight rollouts each: `worst` leaned most, `failed` is the first failure, or -1.
Prediction Of(const std::string& name, int worst, int failed) {
  Prediction prediction;
  prediction.action = {name, {}};
  prediction.evidence.num_rollouts = 8;
  prediction.evidence.worst_rollout = worst;
  prediction.evidence.first_failed = failed;
  prediction.evidence.median_rollout = 3;
  return prediction;
}

double TiltOf(const base::ActionCall& action, int index) {
  if (action.name == "calm") return 9.0;  // most of all, but nothing failed
  return action.name == "wild" && index == 5 ? 2.0 : 1.0;
}

PickedRollout Pick(const std::string& text, const std::vector<Prediction>& ranking) {
  return PickRollout(ParseRolloutChoice(text), ranking, TiltOf);
}

std::string ErrorOf(const std::string& text, const std::vector<Prediction>& ranking) {
  return ConfigErrorOf([&] { Pick(text, ranking); });
}

const std::vector<Prediction> kRanking{Of("calm", 1, -1), Of("mild", 4, 2), Of("wild", 5, 0),
                                       Of("rough", 6, 0)};

TEST(ParseRolloutChoiceTest, NamesAndNumbersOfEachRank) {
  EXPECT_EQ(ParseRolloutChoice("worst").kind, Kind::kWorst);
  EXPECT_FALSE(ParseRolloutChoice("worst").rank);
  EXPECT_EQ(ParseRolloutChoice("median@2").kind, Kind::kMedian);
  EXPECT_EQ(ParseRolloutChoice("median@2").rank, 2);
  EXPECT_EQ(ParseRolloutChoice("first_fall").kind, Kind::kFirstFailed);
  EXPECT_EQ(ParseRolloutChoice("37@4").index, 37);
  EXPECT_EQ(ParseRolloutChoice("37@4").rank, 4);
}

TEST(RequireRolloutTest, RefusesWhatNoAnswerCanHave) {
  const auto error = [](const std::string& text) {
    return ConfigErrorOf([&] { RequireRollout(ParseRolloutChoice(text), 4, 8); });
  };
  for (const char* text : {"worst", "median@4", "7", "7@4"}) {
    EXPECT_NO_THROW(RequireRollout(ParseRolloutChoice(text), 4, 8)) << text;
  }
  EXPECT_THAT(error("worst@5"), HasSubstr("rank 5 of 4 alternatives"));
  EXPECT_THAT(error("8"), AllOf(HasSubstr("no rollout 8"), HasSubstr("--rollouts")));
}

TEST(ParseRolloutChoiceTest, AnythingElseIsRefused) {
  for (const char* text : {"", "best", "-1", "1.5", "3@", "worst@x", "37 "}) {
    EXPECT_THAT(ConfigErrorOf([&] { ParseRolloutChoice(text); }),
                AllOf(HasSubstr(std::string("'") + text + "'"), HasSubstr("first_fall")))
        << text;
  }
  EXPECT_THAT(ConfigErrorOf([] { ParseRolloutChoice("worst@0"); }), HasSubstr("from 1"));
}

TEST(PickRolloutTest, TheWorstOfAllLeanedMostAmongFailures) {
  const PickedRollout worst = Pick("worst", kRanking);
  EXPECT_EQ(worst.rank, 3);
  EXPECT_EQ(worst.index, 5);
}

TEST(PickRolloutTest, WhereNothingFailedTheWorstOfAllLeanedMost) {
  const PickedRollout worst = Pick("worst", {Of("mild", 4, -1), Of("wild", 5, -1)});
  EXPECT_EQ(worst.rank, 2);
  EXPECT_EQ(worst.index, 5);
}

TEST(PickRolloutTest, ARankOrAnotherWordMeansOneAlternative) {
  EXPECT_EQ(Pick("worst@1", kRanking).index, 1);
  EXPECT_EQ(Pick("median", kRanking).rank, 1);
  EXPECT_EQ(Pick("median", kRanking).index, 3);
  EXPECT_EQ(Pick("first_fall@2", kRanking).index, 2);
  EXPECT_EQ(Pick("7@4", kRanking).rank, 4);
}

TEST(PickRolloutTest, WhatIsNotThereIsRefusedAndSaidWhereItIs) {
  EXPECT_THAT(ErrorOf("first_fall", kRanking),
              AllOf(HasSubstr("alternative 1"), HasSubstr("all 8 rollouts succeeded"),
                    HasSubstr("@2, @3, @4")));
  EXPECT_THAT(ErrorOf("first_fall", {Of("calm", 1, -1)}), HasSubstr("no alternative has one"));
  EXPECT_THAT(ErrorOf("8", kRanking), HasSubstr("no rollout 8: 8 were played"));
  EXPECT_THAT(ErrorOf("worst@5", kRanking), HasSubstr("rank 5 of 4"));
  EXPECT_THAT(ErrorOf("worst", {Of("stuck", -1, -1)}), HasSubstr("no rollout finished"));
}

}  // namespace
}  // namespace hires::imagination::rollout_choice_test
