#include "hires/evaluation/decision.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "evaluation/decision_examples.h"
#include "hires/base/error.h"
#include "hires/imagination/client_config.h"

namespace hires::evaluation::decision_test {
namespace {

using base::FailureCode;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kConfig = HIRES_SOURCE_DIR "/config/";

DecisionConfig Configured() { return ReadDecisionConfig(kConfig + "decision.yaml"); }

const imagination::ImaginationSetup& TheSetup() {
  static const imagination::ImaginationSetup setup =
      imagination::LoadImaginationSetup(imagination::ReadSetupConfig(kConfig + "scene.yaml"));
  return setup;
}

simulation::ObjectFate Fate(double z, double max_tilt, int falls) {
  simulation::ObjectFate fate;
  fate.X_MO.translation.z() = z;
  fate.max_tilt = max_tilt;
  fate.falls = falls;
  return fate;
}

/// A mill that began on a tray 0.35 m high.
TruthPlay Judged(const base::Failure& failure, const RunTruth& truth) {
  world::WorldState start;
  start.objects.push_back({"mill", "mill", {}, {}, ""});
  start.objects.back().X_MO.translation.z() = 0.35;
  return JudgeDrive(failure, 12.0, truth, "Mill", start, world::StandingCriterion());
}

TEST(DrawTaskTest, IsTheSameForTheSameNumberAndAnotherForAnother) {
  const DecisionConfig config = Configured();
  DecisionRecord first, again, other;
  first.task = DrawTask(config, 1, 7);
  again.task = DrawTask(config, 1, 7);
  other.task = DrawTask(config, 1, 8);
  EXPECT_EQ(ToJson(first), ToJson(again));
  EXPECT_NE(first.task.truth_seed, other.task.truth_seed);
  EXPECT_NE(DrawTask(config, 2, 7).truth_seed, first.task.truth_seed);
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

TEST(JudgeDriveTest, SaysInWhatWayTheLoadWentWrong) {
  EXPECT_THAT(Judged({}, {{{"mill", Fate(0.35, 0.1, 0)}}, ""}).failures, IsEmpty());
  EXPECT_THAT(Judged({}, {{{"mill", Fate(0.35, 1.5, 1)}}, ""}).failures,
              ElementsAre(FailureCode::kObjectFell));
  EXPECT_THAT(Judged({}, {{{"mill", Fate(0.02, 0.1, 1)}}, ""}).failures,
              ElementsAre(FailureCode::kObjectFell));
  EXPECT_THAT(Judged({}, {{{"mill", Fate(0.35, 0.1, 1)}}, ""}).failures,
              ElementsAre(FailureCode::kObjectSlid));
}

TEST(JudgeDriveTest, NamesAllThatWentWrong) {
  const TruthPlay play =
      Judged(FailureCode::kStuck,
             {{{"mill", Fate(0.0, 1.5, 2)}, {"mug1", Fate(0.0, 1.5, 1)}}, "base touches chair1"});
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

TEST(DecisionRecordTest, ComesBackFromText) {
  DecisionRecord record = DecisionOf(3, "", true);
  record.task.deadline = 9.5;
  const auto json = ToJson(record);
  EXPECT_EQ(ToJson(ParseDecisionRecord(json, "j")), json);
  EXPECT_EQ(ParseDecisionRecord(json, "j").plays.at("fast").failures,
            record.plays.at("fast").failures);
}

TEST(DecisionRecordTest, SaysWhatIsWrongWithALine) {
  const auto error = [](const std::string& field, const nlohmann::ordered_json& value) {
    auto json = ToJson(DecisionOf(3, "slow", true));
    json[field] = value;
    try {
      ParseDecisionRecord(json, "j: line 4");
    } catch (const base::ConfigError& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(error("task", 1), HasSubstr("j: line 4"));
  EXPECT_THAT(error("plays", nlohmann::ordered_json::object()), HasSubstr("lacks a motion set"));
  EXPECT_THAT(error("plays", {{"slow", {1.0, "odd", 1.0, 1.0}}}), HasSubstr("'odd'"));
}

/// Imagination itself on few rollouts; the truth is made up.
class PlayDecisionTest : public ::testing::Test {
 protected:
  DecisionParts Parts() {
    DecisionParts parts{
        TheSetup(), imagination::ReadClientConfig(kConfig + "imagination_client.yaml").scheduler};
    parts.scheduler.rollouts = 8;
    parts.default_motion_set = "fast";
    parts.oracle_plays = 2;
    parts.play = [this](const DecisionTask&, const std::string& set, std::uint64_t seed) {
      plays.push_back(set + std::to_string(seed));
      return std::make_optional(TruthPlay{{}, set == "fast" ? 10.0 : 20.0, 25.0, 0.1});
    };
    return parts;
  }
  static DecisionTask Block() {
    DecisionTask task;
    task.load = "block";
    task.from = "premanipulationareaeastcounter1";
    task.to = "premanipulationareasouthtable1";
    task.torso = "torsomiddleposture";
    return task;
  }
  std::vector<std::string> plays;
};

TEST_F(PlayDecisionTest, AllArmsShareRolloutsAndPlays) {
  const auto record = PlayDecision(Block(), Parts(), nullptr);
  ASSERT_TRUE(record);
  EXPECT_EQ(record->imagined.at("slow").num_rollouts, 8);
  EXPECT_EQ(record->imagined.at("fast").num_success,
            static_cast<int>(record->imagined.at("fast").durations.size()));
  EXPECT_EQ(record->decided.at(kImaginationArm).motion_sets.size(), PriceScales().size());
  EXPECT_LT(record->decided.at(kDissertationArm).simulated_seconds,
            record->decided.at(kImaginationArm).simulated_seconds / 4.0);
  EXPECT_EQ(plays.size(), 2U + 4U) << "one of each motion set, two of each for the oracle";
  EXPECT_EQ(plays[2].substr(4), plays[4].substr(4)) << "the oracle's seeds are those of both";
}

TEST_F(PlayDecisionTest, WhatIsKnownOfACellIsNotPlayedAgain) {
  DecisionParts parts = Parts();
  parts.imagines = parts.is_dissertation = false;
  const auto first = PlayDecision(Block(), parts, nullptr);
  plays.clear();
  const auto second = PlayDecision(Block(), parts, &*first);
  EXPECT_EQ(plays.size(), 2U);
  EXPECT_EQ(ToJson(*second)["oracle"], ToJson(*first)["oracle"]);
  EXPECT_THAT(second->decided, IsEmpty());
}

TEST_F(PlayDecisionTest, IsNothingWhenCancelled) {
  DecisionParts parts = Parts();
  parts.cancelled = [] { return true; };
  EXPECT_FALSE(PlayDecision(Block(), parts, nullptr));
}

}  // namespace
}  // namespace hires::evaluation::decision_test
