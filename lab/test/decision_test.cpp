#include "lab/src/decision/decision.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>
#include <tuple>

#include "hires/world/fall_code.h"
#include "lab/test/decision_examples.h"

namespace hires::lab::decision_test {
namespace {

using base::FailureCode;
using testing::ElementsAre;
using testing::IsEmpty;
using world::Fall;

const std::string kConfig = HIRES_SOURCE_DIR "/config/";

DecisionConfig Configured() {
  return ReadDecisionConfig(HIRES_SOURCE_DIR "/lab/config/decision.yaml");
}

const imagination::ImaginationSetup& TheSetup() {
  static const imagination::ImaginationSetup setup =
      imagination::LoadImaginationSetup(imagination::ReadSetupConfig(kConfig + "scene.yaml"));
  return setup;
}

simulation::ObjectFate Fate(Fall first, int falls = 1) {
  simulation::ObjectFate fate;
  fate.first_fall = first;
  fate.falls = first == Fall::kNone ? 0 : falls;
  return fate;
}

TruthPlay Judged(const base::Failure& failure, const simulation::RunTruth& truth) {
  return JudgeDrive(failure, 12.0, truth, "Mill");
}

TEST(DrawTaskTest, IsTheSameForTheSameNumberAndAnotherForAnother) {
  const DecisionConfig config = Configured();
  const auto told = [](const DecisionTask& task) {
    return std::make_tuple(CellOf(task), task.number, task.deadline, task.price_factor,
                           task.truth_seed, task.imagination_seed, task.oracle_seed);
  };
  const DecisionTask first = DrawTask(config, 1, 7);
  EXPECT_EQ(told(first), told(DrawTask(config, 1, 7)));
  EXPECT_NE(first.truth_seed, DrawTask(config, 1, 8).truth_seed);
  EXPECT_NE(first.truth_seed, DrawTask(config, 2, 7).truth_seed);
}

TEST(DrawTaskTest, DrawsEveryLoadAndRouteWithinTheBounds) {
  const DecisionConfig config = Configured();
  std::set<std::string> loads, routes;
  int with_deadline = 0;
  for (int number = 1; number <= 400; ++number) {
    const DecisionTask task = DrawTask(config, 1, number);
    loads.insert(task.load);
    routes.insert(task.from + task.to);
    with_deadline += task.deadline ? 1 : 0;
    EXPECT_GE(task.price_factor, config.factor_lower);
    EXPECT_LE(task.price_factor, config.factor_upper);
    EXPECT_GE(task.deadline.value_or(config.deadline_lower), config.deadline_lower);
    EXPECT_LT(task.deadline.value_or(config.deadline_lower), config.deadline_upper);
  }
  EXPECT_EQ(loads.size(), config.loads.size());
  EXPECT_GE(loads.size(), 8U);
  EXPECT_EQ(routes.size(), config.routes.size());
  EXPECT_NEAR(with_deadline, 200, 40) << "four deviations of the binomial";
}

TEST(DrawTaskTest, TasksOfOneCellShareTheOraclesPlays) {
  const DecisionConfig config = Configured();
  std::map<std::string, std::uint64_t> seeds;
  for (int number = 1; number <= 400; ++number) {
    const DecisionTask task = DrawTask(config, 1, number);
    EXPECT_EQ(seeds.emplace(CellOf(task), task.oracle_seed).first->second, task.oracle_seed);
  }
  EXPECT_LT(seeds.size(), 130U);
}

TEST(DecisionStartTest, EveryLoadRouteAndHeightCanBeBegun) {
  const DecisionConfig config = Configured();
  std::set<std::string> seen;
  for (const auto& load : config.loads) {
    for (const std::string& torso : load.torso) {
      const auto& route = config.routes.at(seen.size() % config.routes.size());
      DecisionTask task;
      task.load = load.model;
      task.from = route.from;
      task.to = route.to;
      task.torso = torso;
      seen.insert(CellOf(task));
      const auto start = StartOf(TheSetup(), task);
      EXPECT_NO_THROW(imagination::CheckSetup(imagination::MakeRolloutSetup(TheSetup(), start, 1),
                                              ActionOf(task, "slow")))
          << CellOf(task);
    }
  }
}

TEST(JudgeDriveTest, CallsTheLoadsFirstFallAsImaginationDoes) {
  EXPECT_THAT(Judged({}, {{{"mill", Fate(Fall::kNone)}}, ""}).failures, IsEmpty());
  for (const Fall fall : {Fall::kLost, Fall::kToppled, Fall::kDropped, Fall::kSlid}) {
    // How often it fell, how far it leant and where it lies in the end do not matter.
    simulation::ObjectFate fate = Fate(fall, 2);
    fate.max_tilt = 1.5;
    EXPECT_THAT(Judged({}, {{{"mill", fate}}, ""}).failures,
                ElementsAre(world::CodeOf(fall, world::FallenThing::kLoad)));
  }
}

TEST(JudgeDriveTest, NamesAllThatWentWrong) {
  const TruthPlay play = Judged(
      FailureCode::kStuck,
      {{{"mill", Fate(Fall::kToppled, 2)}, {"mug1", Fate(Fall::kSlid)}}, "base touches chair1"});
  EXPECT_THAT(play.failures, ElementsAre(FailureCode::kStuck, FailureCode::kObjectFell,
                                         FailureCode::kKnockedOver, FailureCode::kRobotCollision));
  EXPECT_TRUE(play.fell());
  EXPECT_FALSE(play.success());
  EXPECT_EQ(play.duration, 12.0);
}

TEST(DecisionPricesTest, TheTasksFactorIsOfThingsAlone) {
  DecisionTask task;
  task.price_factor = 0.5;
  task.deadline = 8.0;
  const imagination::Prices prices = PricesOf(task, SimplePrices(), 2.0);
  EXPECT_EQ(prices.of.at(FailureCode::kObjectFell), 100.0);
  EXPECT_EQ(prices.of.at(FailureCode::kRobotCollision), 1800.0);
  EXPECT_EQ(prices.not_done, 120.0);
  const TruthPlay play{{FailureCode::kObjectFell, FailureCode::kRobotCollision}, 10.0, 15.0, 0.1};
  EXPECT_EQ(CostOf(play, prices), 10.0 + 2.0 * 2.0 * 2.0 + 100.0 + 1800.0);
}

TEST(DecisionChoiceTest, WhatLeadsIsTakenUnlessAllFail) {
  using Outcome = imagination::ImaginationOutcome;
  const auto choice = [](Outcome outcome, const char* arm) {
    return ChoiceOf({outcome, "slow"}, arm, "fast");
  };
  EXPECT_EQ(choice(Outcome::kRanked, kImaginationArm), "slow");
  EXPECT_EQ(choice(Outcome::kUndecided, kImaginationArm), "slow") << "cheaper, as far as is known";
  EXPECT_EQ(choice(Outcome::kAllFailed, kImaginationArm), "");
  EXPECT_EQ(choice(Outcome::kAllFailed, kDissertationArm), "fast") << "it bans nothing";
  EXPECT_EQ(choice(Outcome::kNothingFinished, kImaginationArm), "fast") << "nothing is known";
}

}  // namespace
}  // namespace hires::lab::decision_test
