#include "lab/src/experiment/experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "lab/src/experiment/chain.h"

namespace hires::lab::experiment_test {
namespace {

using testing::HasSubstr;

const std::string kRoot = HIRES_SOURCE_DIR;

/// A file of the package's with nothing uncertain but what is asked for.
ExperimentConfig Config(const std::string& name, const std::string& uncertainty_changes = "{}",
                        const ExperimentOverrides& overrides = {}) {
  ExperimentConfig config =
      ReadExperiment(kRoot + "/lab/config/experiments/" + name + ".yaml", overrides);
  config.uncertainty = "none";
  config.uncertainty_changes = uncertainty_changes;
  config.expect.clear();
  return config;
}

const char* const kSlippery =
    "wheel_slip: {distribution: uniform, lower: 0, upper: 0.03, unit: share, source: test}\n"
    "object_radius: {distribution: uniform, lower: 0.2, upper: 1, unit: factor, source: test}\n"
    "object_y: {distribution: uniform, lower: -0.01, upper: 0.01, unit: m, source: test}\n"
    "start_x: {distribution: uniform, lower: -0.1, upper: 0.1, unit: m, source: test}\n";

base::Crew CrewOf(int threads) {
  base::Crew crew;
  crew.threads = threads;
  return crew;
}

nlohmann::ordered_json Played(const ExperimentConfig& config, int threads = 2) {
  nlohmann::ordered_json json = ToJson(RunExperiment(config, CrewOf(threads)).value());
  json.erase("wall_seconds");
  return json;
}

/// A hall of 6 m x 4 m as map_server keeps it; the path of its YAML.
std::string Hall() {
  const std::string yaml = testing::TempDir() + "hall.yaml", pgm = testing::TempDir() + "hall.pgm";
  constexpr int kWidth = 120, kHeight = 80;
  std::ofstream image(pgm);
  image << "P2\n" << kWidth << ' ' << kHeight << "\n255\n";
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const bool is_wall = row < 2 || column < 2 || row >= kHeight - 2 || column >= kWidth - 2;
      image << (is_wall ? 0 : 254) << '\n';
    }
  }
  std::ofstream(yaml) << "image: hall.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n"
                         "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
  return yaml;
}

TEST(LegsExperimentTest, EachLegStartsWhereTheLastOneReallyEnded) {
  const auto json = Played(Config("legs_world", "{}", {{}, 3, ""}));
  ASSERT_EQ(json["rows"].size(), 3u);
  EXPECT_EQ(json["measures"]["reached"], 3.0);
  EXPECT_EQ(json["measures"]["contacts"], 0.0);
  EXPECT_EQ(json["rows"][0]["start_x"], 13.0);
  for (int i = 1; i < 3; ++i) {
    const auto &before = json["rows"][i - 1], &leg = json["rows"][i];
    EXPECT_EQ(leg["from"], before["to"]);
    const ExperimentConfig config = Config("legs_world");
    for (const Goal& goal : config.goals) {
      if (goal.name != leg["from"]) continue;
      EXPECT_NEAR(std::hypot(leg["start_x"].get<double>() - goal.X_MG.x,
                             leg["start_y"].get<double>() - goal.X_MG.y),
                  before["distance"].get<double>(), 1e-9);
    }
  }
}

TEST(LegsExperimentTest, OnAMapTheWallsAreTheMapsAndTheFurnitureIsGone) {
  ExperimentConfig config = Config("legs_map_sim", "{}", {{}, 2, Hall()});
  config.goals = {{"west", {1.5, 2.0, 0.0}}, {"east", {4.5, 2.0, 0.0}}};
  const auto json = Played(config);
  EXPECT_EQ(json["measures"]["reached"], 2.0);
  // Never farther from the long walls than half the hall, less half the robot.
  EXPECT_GT(json["measures"]["min_clearance"].get<double>(), 0.3);
  EXPECT_LT(json["measures"]["min_clearance"].get<double>(), 1.9);
}

TEST(LegsExperimentTest, AGoalInsideAWallIsRefusedBeforeAnythingIsPlayed) {
  ExperimentConfig config = Config("legs_map_sim", "{}", {{}, 2, Hall()});
  config.goals = {{"west", {1.5, 2.0, 0.0}}, {"wall", {5.95, 2.0, 0.0}}};
  try {
    RunExperiment(config, CrewOf(1));
    FAIL() << "accepted";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'legs_map_sim': robot starts in collision"));
    EXPECT_THAT(error.what(), HasSubstr("map_walls"));
  }
}

TEST(LegsExperimentTest, AnUnknownMotionSetIsRefused) {
  ExperimentConfig config = Config("legs_world");
  std::get<LegsConfig>(config.kind).motion_set = "fsat";
  EXPECT_THROW(RunExperiment(config, CrewOf(1)), base::ConfigError);
}

TEST(ExperimentTest, AMeasureThatTheKindDoesNotHaveIsRefusedBeforeAnythingIsPlayed) {
  ExperimentConfig config = Config("legs_world");
  config.expect = {{"shaking_ratio", Expectation::Relation::kAbove, 1.0}};
  base::Crew crew = CrewOf(1);
  crew.on_progress = [](double, double) { FAIL() << "played"; };
  EXPECT_THROW(RunExperiment(config, crew), base::ConfigError);
}

TEST(ExperimentTest, GivesTheSameBitsForAnyNumberOfThreads) {
  ExperimentConfig legs = Config("legs_world_noise", kSlippery, {{}, 4, ""});
  std::get<LegsConfig>(legs.kind).chains = 3;
  ExperimentConfig loop = Config("topple_loop", kSlippery, {{}, 2, ""});
  std::get<ToppleLoopConfig>(loop.kind).duration = 40.0;
  for (const ExperimentConfig& config : {legs, loop, Config("paired", kSlippery, {{}, 2, ""}),
                                         Config("durations", kSlippery, {{}, 1, ""})}) {
    EXPECT_EQ(Played(config, 1), Played(config, 3)) << config.name;
  }
}

TEST(ExperimentTest, AnotherSeedGivesOtherRuns) {
  EXPECT_NE(Played(Config("paired", kSlippery, {1, 1, ""}))["rows"],
            Played(Config("paired", kSlippery, {2, 1, ""}))["rows"]);
}

TEST(ExperimentTest, ACancelledOneGivesNothing) {
  base::Crew crew = CrewOf(2);
  crew.cancelled = [] { return true; };
  EXPECT_FALSE(RunExperiment(Config("legs_world"), crew).has_value());
}

TEST(DurationsExperimentTest, EachPlannerDrivesAndTorsoAndArmsMoveOnce) {
  const auto json = Played(Config("durations", "{}", {{}, 1, ""}));
  std::map<std::string, std::vector<double>> durations;
  for (const auto& row : json["rows"]) {
    EXPECT_EQ(row["failure"], "");
    durations[row["action"].get<std::string>() + ' ' + row["planner"].get<std::string>()].push_back(
        row["duration"]);
  }
  EXPECT_EQ(durations["move_torso scene"].size(), 2u);
  EXPECT_EQ(durations["tuck_arms scene"].size(), 2u);
  EXPECT_EQ(durations.size(), 4u) << "no postures with another planner";
  const std::vector<double>&scaled = durations["move_base_param scene"],
        &unscaled = durations["move_base_param unscaled"];
  ASSERT_EQ(scaled.size(), 8u);
  ASSERT_EQ(unscaled.size(), 8u);
  EXPECT_LT(std::accumulate(unscaled.begin(), unscaled.end(), 0.0),
            std::accumulate(scaled.begin(), scaled.end(), 0.0));
}

TEST(DurationsExperimentTest, AnUnknownPostureIsRefusedBeforeAnythingIsPlayed) {
  ExperimentConfig config = Config("durations", "{}", {{}, 1, ""});
  auto& rows = std::get<DurationsConfig>(config.kind).rows;
  rows[8].from = rows[9].to = "TorsoLowPosture";
  base::Crew crew = CrewOf(1);
  crew.on_progress = [](double, double) { FAIL() << "played"; };
  try {
    RunExperiment(config, crew);
    FAIL() << "accepted";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("posture 'TorsoLowPosture' is unknown"));
    EXPECT_THAT(error.what(), HasSubstr("torsodownposture"));
  }
}

TEST(PairedExperimentTest, BothMotionSetsMeetTheSameTruth) {
  // With equal limits nothing is left that could differ.
  ExperimentConfig config = Config("paired", kSlippery, {{}, 2, ""});
  auto& paired = std::get<PairedConfig>(config.kind);
  paired.motion_sets = {"fast", "FAST"};
  const auto json = Played(config);
  EXPECT_EQ(json["measures"]["shaking_difference"], 0.0);
  EXPECT_EQ(json["rows"][0]["duration"], json["rows"][2]["duration"]);
}

TEST(ToppleLoopExperimentTest, RunsUntilTheTimeIsOverAndCountsAt20And10Hz) {
  ExperimentConfig config = Config("topple_loop", kSlippery, {{}, 1, ""});
  std::get<ToppleLoopConfig>(config.kind).duration = 30.0;
  const ExperimentReport report = RunExperiment(config, CrewOf(2)).value();
  double duration = 0.0, samples = 0.0;
  for (const auto& row : report.findings.rows) {
    if (row["motion_set"] != "fast") continue;
    if (row["leg"] == 0) {
      EXPECT_EQ(row["from"], "NT1");
    }
    duration += row["duration"].get<double>();
    samples += row["notopple"].get<int>() + row["shaking"].get<int>() + row["topple"].get<int>();
  }
  EXPECT_GE(duration, 30.0);
  EXPECT_NEAR(samples, 20.0 * duration, 10.0);
  const auto& counts = report.findings.tables[0].rows;
  EXPECT_NEAR(std::stoi(counts[3][1]), samples / 2.0, 10.0) << "at 10 Hz";
}

std::shared_ptr<const Stage> StageWithMill(const std::string& uncertainty_changes) {
  return std::make_shared<const Stage>(MakeStage(Config("topple_loop", uncertainty_changes)));
}

TEST(ChainTest, AMillThatStandsOnAPinheadFallsAndIsPutBack) {
  const auto stage = StageWithMill(
      "object_radius: {distribution: fixed, value: 0.2, unit: factor, source: test}\n");
  Chain chain(stage, "NT1", {"fast", 1, true, false});
  const Leg first = chain.Drive("ST1", {}).value();
  const Leg second = chain.Drive("WT2", {}).value();
  EXPECT_GT(first.result.falls, 1) << "it was put back during the leg and fell again";
  EXPECT_GT(second.result.falls, 0) << "it was there again on the next one";
}

TEST(ChainTest, WithoutPuttingBackItIsPutBackBetweenTheLegs) {
  const auto stage = StageWithMill(
      "object_radius: {distribution: fixed, value: 0.2, unit: factor, source: test}\n");
  Chain chain(stage, "NT1", {"fast", 1, false, false});
  const Leg first = chain.Drive("ST1", {}).value();
  EXPECT_EQ(first.result.falls, 1);
  EXPECT_TRUE(first.was_put_back);
  EXPECT_EQ(chain.Drive("WT2", {}).value().result.falls, 1);
}

TEST(ChainTest, AfterACollisionTheRobotIsPutToTheGoal) {
  // The robot believes to stand 0.5 m left of where it stands, and sees nothing of what is there.
  ExperimentConfig config = Config(
      "topple_loop", "localisation_y: {distribution: fixed, value: 0.5, unit: m, source: test}\n");
  config.obstacle_layer = "none";
  const auto stage = std::make_shared<const Stage>(MakeStage(config));
  Chain chain(stage, "NT1", {"fast", 1, true, false});
  for (const char* goal : {"ST1", "WT2", "ET2", "EC1", "NT1", "ST1"}) {
    const Leg leg = chain.Drive(goal, {}).value();
    if (leg.result.failure.code != base::FailureCode::kRobotCollision) continue;
    EXPECT_FALSE(leg.touched.empty());
    EXPECT_EQ(leg.clearance, 0.0);
    EXPECT_TRUE(leg.was_restarted);
    const Leg next = chain.Drive("EC1", {}).value();
    const auto X_MG = geometry::Flatten(*stage->setup.scene->world.FindFrame(goal));
    EXPECT_DOUBLE_EQ(next.X_MStart.x, X_MG.x);
    EXPECT_DOUBLE_EQ(next.X_MStart.y, X_MG.y);
    return;
  }
  FAIL() << "drove half a metre beside its way and touched nothing";
}

TEST(ChainTest, OneTruthStaysTheSameForAllLegsAndDiffersBetweenChains) {
  imagination::Uncertainty spread = imagination::ParseUncertainty(
      "object_mass: {distribution: uniform, lower: 0.5, upper: 2, unit: factor, source: test}\n",
      "test");
  const auto draw = [](const imagination::Uncertainty& uncertainty, int rng) {
    return imagination::SampleVariation(uncertainty, base::Rng(rng)).mass_factor;
  };
  const imagination::Uncertainty truth = OneTruth(spread, base::Rng(1));
  EXPECT_EQ(draw(truth, 1), draw(truth, 2));
  EXPECT_NE(draw(spread, 1), draw(spread, 2));
  EXPECT_NE(draw(truth, 1), draw(OneTruth(spread, base::Rng(2)), 1));
  EXPECT_EQ(draw(Without(spread, {"object_mass", "sway"}), 1), 1.0);
}

}  // namespace
}  // namespace hires::lab::experiment_test
