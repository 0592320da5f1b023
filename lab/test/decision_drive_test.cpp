#include "lab/src/decision/decision_drive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>

#include "lab/src/decision/decision_play.h"
#include "support/rounds.h"

namespace hires::lab::decision_drive_test {
namespace {

const loop::LoopSetup& TheSetup() {
  static const loop::LoopSetup setup(HIRES_SOURCE_DIR "/config/loop.yaml");
  return setup;
}

DecisionTask Carrying(const std::string& load) {
  DecisionTask task;
  task.load = load;
  task.from = "premanipulationareanorthtable1";
  task.to = "premanipulationareaeastcounter1";
  task.torso = "torsoupposture";
  return task;
}

/// What is certain about the world of a test, in imagination and in truth.
using Certain = std::map<std::string, imagination::Distribution>;

imagination::ImaginationSetup WorldWith(const Certain& certain) {
  imagination::ImaginationSetup world = TheSetup().world();
  imagination::Uncertainty uncertainty = *world.uncertainty;
  for (const auto& [name, distribution] : certain) uncertainty.quantities[name] = distribution;
  world.uncertainty = std::make_shared<const imagination::Uncertainty>(uncertainty);
  return world;
}

/// Sixteen rollouts decide, as fewer leave it open where one of them fails; three plays of the
/// truth tell who was right.
DecisionRecord Decide(const DecisionTask& task, const Certain& certain) {
  const imagination::ImaginationSetup world = WorldWith(certain);
  sim_robot::Truth truth = TheSetup().ReadTruth("same");
  truth.changes = certain;
  DecisionParts parts{world, TheSetup().imagination().scheduler};
  parts.scheduler.rollouts = 16;
  parts.oracle_plays = 3;
  parts.play = [&](const DecisionTask& drive, const std::string& set, std::uint64_t seed) {
    return PlayDrive(TheSetup(), truth, drive, set, seed);
  };
  DecisionRecord record;
  record.imagined = *Imagine(task, parts);
  for (const std::string& set : DecisionAlternatives()) {
    record.oracle[set] = *PlayForOracle(task, set, parts);
  }
  return record;
}

/// What imagination recommends; nothing where it is not sure.
std::string Recommended(const DecisionRecord& record) {
  const auto& advice = record.imagined.decided.at(kImaginationArm).advice.front();
  return advice.outcome == imagination::ImaginationOutcome::kRanked ? advice.first : "";
}

int NumFallen(const std::vector<TruthPlay>& plays) {
  return static_cast<int>(
      std::count_if(plays.begin(), plays.end(), [](const TruthPlay& play) { return play.fell(); }));
}

double MeanCost(const DecisionTask& task, const std::vector<TruthPlay>& plays) {
  const auto prices = PricesOf(task, TheSetup().imagination().scheduler.criteria.prices, 1.0);
  double sum = 0.0;
  for (const TruthPlay& play : plays) sum += CostOf(play, prices);
  return sum / static_cast<double>(plays.size());
}

// A mill on a foot of 0.7 times its radius tips from 1.85 m/s^2 on: fast may accelerate by 2.5 and
// the base does so by 2.0, slow by 1.4.
TEST(DecisionDriveTest, SlowWinsWithALoadThatFallsWhereTheRobotIsFast) {
  const DecisionTask task = Carrying("peppermill_thesis");
  const auto fixed = imagination::Distribution::Kind::kFixed;
  const DecisionRecord record = Decide(
      task, {{"object_radius", {fixed, 0.7, 0.0}}, {"late_cycle_probability", {fixed, 0.0, 0.0}}});
  EXPECT_EQ(Recommended(record), "slow");
  EXPECT_LT(NumFallen(record.oracle.at("slow")), NumFallen(record.oracle.at("fast")));
  EXPECT_LT(MeanCost(task, record.oracle.at("slow")), MeanCost(task, record.oracle.at("fast")));
}

TEST(DecisionDriveTest, FastWinsWithALoadThatCannotFall) {
  HIRES_LONG_CASE();
  const DecisionTask task = Carrying("block");
  const DecisionRecord record = Decide(task, {});
  EXPECT_EQ(Recommended(record), "fast");
  EXPECT_EQ(NumFallen(record.oracle.at("fast")), 0);
  EXPECT_LT(MeanCost(task, record.oracle.at("fast")), MeanCost(task, record.oracle.at("slow")));
}

}  // namespace
}  // namespace hires::lab::decision_drive_test
