#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "lab/src/experiment/braking.h"
#include "lab/src/experiment/experiment.h"
#include "lab/src/experiment/stage.h"

namespace hires::lab::experiment_braking_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Kind = BrakingWay::Kind;

const std::string kFile = std::string(HIRES_SOURCE_DIR) + "/lab/config/experiments/braking.yaml";

ExperimentConfig Config() {
  ExperimentConfig config = ReadExperiment(kFile);
  config.uncertainty = "none";
  config.expect.clear();
  return config;
}

BrakingConfig& BrakingOf(ExperimentConfig* config) { return std::get<BrakingConfig>(config->kind); }

double ValueOf(const Findings& findings, const std::string& name) {
  for (const Measure& measure : findings.measures) {
    if (measure.name == name) return measure.value;
  }
  ADD_FAILURE() << "no measure " << name;
  return std::nan("");
}

/// What is wrong with the file once a piece of it is replaced.
std::string ErrorWith(const std::string& from, const std::string& to) {
  std::string yaml = base::ReadTextFile(kFile);
  const std::size_t at = yaml.find(from);
  if (at == std::string::npos) return "no '" + from + "' in the file";
  const std::string path = testing::TempDir() + "changed_braking.yaml";
  std::ofstream(path) << yaml.replace(at, from.size(), to);
  try {
    ReadExperiment(path);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(BrakingConfigTest, WaysAreWordsOrDecelerations) {
  ExperimentConfig config = Config();
  const auto& ways = BrakingOf(&config).ways;
  ASSERT_EQ(ways.size(), 6u);
  EXPECT_EQ(ways[0].kind, Kind::kRamp);
  EXPECT_EQ(ways[1].kind, Kind::kConstant);
  EXPECT_EQ(ways[1].deceleration, 0.0);
  EXPECT_EQ(ways[2].kind, Kind::kSilence);
  EXPECT_EQ(ways[4].kind, Kind::kConstant);
  EXPECT_EQ(ways[4].deceleration, 10.0);
  EXPECT_EQ(ways[5].kind, Kind::kAtOnce);
}

TEST(BrakingConfigTest, WhatMakesNoSenseIsNamed) {
  EXPECT_THAT(ErrorWith("- at_once", "- slowly"),
              AllOf(HasSubstr("braking.ways"), HasSubstr("'slowly'"), HasSubstr("at_once")));
  EXPECT_THAT(ErrorWith("\"10\"", "\"-10\""), HasSubstr("'-10'"));
  EXPECT_THAT(ErrorWith("\"10\"", "\"10x\""), HasSubstr("'10x'"));
  EXPECT_THAT(ErrorWith("[peppermill1, race_peppermill, race_peppermill1]", "[]"),
              HasSubstr("braking.loads"));
  EXPECT_THAT(ErrorWith("linear: 0.55", "linear: 5.5"), HasSubstr("linear"));
  EXPECT_THAT(ErrorWith("run_up: 0.5", "run_up: 0"), HasSubstr("run_up"));
}

const BrakingCell& Cell(const std::vector<BrakingPlay>& plays, const std::string& load,
                        double linear, const std::string& way) {
  for (const BrakingPlay& play : plays) {
    const BrakingCell& cell = play.cell;
    const bool is_straight = cell.motion.angular == 0.0;
    if (cell.load == load && cell.motion.linear == linear && is_straight && cell.way.name == way) {
      return cell;
    }
  }
  throw std::logic_error("no cell " + load + " " + way);
}

TEST(BrakingCellsTest, ClosedFormsSpeakOfEachStraightStop) {
  ExperimentConfig config = Config();
  const auto plays = BrakingCells(BrakingOf(&config), MakeStage(config));
  EXPECT_EQ(plays.size(), 3u * 3u * 6u);
  // Tips at 2.65 m/s^2; from 0.37 m/s on a sudden stop topples it.
  const BrakingCell& controller = Cell(plays, "peppermill1", 0.55, "controller");
  EXPECT_TRUE(controller.is_comparable);
  EXPECT_FALSE(controller.is_predicted_to_tip);
  EXPECT_EQ(controller.deceleration, 2.0);
  const BrakingCell& slow = Cell(plays, "peppermill1", 0.30, "at_once");
  EXPECT_TRUE(slow.is_predicted_to_tip);
  EXPECT_FALSE(slow.is_predicted_to_fall);
  EXPECT_TRUE(Cell(plays, "peppermill1", 0.55, "at_once").is_predicted_to_fall);
  EXPECT_TRUE(Cell(plays, "peppermill1", 0.55, "silence").is_predicted_to_fall);
  EXPECT_FALSE(Cell(plays, "peppermill1", 0.55, "ramp").is_comparable);
}

// config/robots/pr2.yaml: radius, mass with the wheels' spinning, gain of version 2, damping,
// effort.
constexpr double kRadius = 0.074792, kMass = 268.37 + 8.0 * 0.0152182 / (kRadius * kRadius);
constexpr double kGain = 5.0, kDamping = 0.25, kEffort = 7.0;

/// From a speed [m/s] to 0.01 m/s, step by step.
struct SteppedStop {
  explicit SteppedStop(double v) {
    constexpr double kStep = 1e-6;
    for (; v > 0.01; time += kStep) {
      const double effort = std::min(kEffort, kGain * v / kRadius) + kDamping * v / kRadius;
      distance += kStep * v;
      v -= kStep * 8.0 * effort / (kRadius * kMass);
    }
    distance += v * kMass * kRadius * kRadius / (8.0 * (kGain + kDamping));  // what is left to roll
  }
  double time{0.0}, distance{0.0};
};

TEST(BrakingCellsTest, StatedDistancesIncludeTheLagOfTheWheels) {
  ExperimentConfig config = Config();
  const auto plays = BrakingCells(BrakingOf(&config), MakeStage(config));
  const double lag = 0.001 + kMass * kRadius * kRadius / (8.0 * (kGain + kDamping));
  const double v = 0.30 * kGain / (kGain + kDamping);
  const BrakingCell& controller = Cell(plays, "peppermill1", 0.30, "controller");
  EXPECT_NEAR(controller.stated_distance, v * v / 4.0 + v * lag, 1e-12);
  EXPECT_NEAR(controller.stated_time, v / 2.0 + lag, 1e-12);
  const BrakingCell& silence = Cell(plays, "peppermill1", 0.30, "silence");
  const SteppedStop stop(v);
  EXPECT_NEAR(silence.stated_distance, v * 0.201 + stop.distance, 1e-5);
  EXPECT_NEAR(silence.stated_time, 0.201 + stop.time, 1e-4);
  const BrakingCell& ramp = Cell(plays, "peppermill1", 0.55, "ramp");
  EXPECT_NEAR(ramp.stated_distance, navigation::StoppingDistance(0.55, ramp.limits) + 0.55 * lag,
              1e-9);
  // No casters brake with 5 m/s^2: then the base has none, nor any lag but its command's.
  const BrakingCell& hard = Cell(plays, "peppermill1", 0.30, "5");
  EXPECT_NEAR(hard.stated_distance, 0.30 * 0.30 / 10.0 + 0.30 * 0.001, 1e-12);
}

TEST(BrakingCellsTest, AnUnknownLoadIsRefused) {
  ExperimentConfig config = Config();
  BrakingOf(&config).loads = {"peppermil1"};
  try {
    RunExperiment(config, {});
    FAIL() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("peppermil1"), HasSubstr("peppermill1")));
  }
}

/// Two stops of one mill from 0.55 m/s, along the ramp, by the time-out, and at once.
ExperimentConfig Short() {
  ExperimentConfig config = Config();
  BrakingConfig& braking = BrakingOf(&config);
  braking.rollouts = 2;
  braking.loads = {"peppermill1"};
  braking.motions = {{0.55, 0.0}};
  braking.ways = {{Kind::kRamp, 0.0, "ramp"},
                  {Kind::kSilence, 0.0, "silence"},
                  {Kind::kAtOnce, 0.0, "at_once"}};
  return config;
}

TEST(BrakingExperimentTest, TheRampSavesAMillThatASuddenStopTopples) {
  const auto report = RunExperiment(Short(), {}).value();
  EXPECT_EQ(ValueOf(report.findings, "falls_ramp"), 0.0);
  EXPECT_EQ(ValueOf(report.findings, "falls_at_once"), 2.0);
  EXPECT_EQ(ValueOf(report.findings, "closed_form_disagreements"), 0.0);
  EXPECT_LT(ValueOf(report.findings, "max_tilt_ramp"), 0.05);
  EXPECT_LT(ValueOf(report.findings, "distance_error_ramp"), 0.02);
  EXPECT_LT(ValueOf(report.findings, "distance_error_silence"), 0.005);
}

TEST(BrakingExperimentTest, AnyNumberOfThreadsGivesTheSameBits) {
  ExperimentConfig config = Short();
  config.uncertainty = "scene";
  const auto played = [&](int threads) {
    base::Crew crew;
    crew.threads = threads;
    nlohmann::ordered_json json = ToJson(RunExperiment(config, crew).value());
    json.erase("wall_seconds");
    return json.dump();
  };
  EXPECT_EQ(played(1), played(2));
}

TEST(BrakingExperimentTest, CancellingGivesNothing) {
  base::Crew crew;
  crew.cancelled = [] { return true; };
  EXPECT_FALSE(RunExperiment(Short(), crew).has_value());
}

TEST(BrakingReportTest, CountsFallsAndErrors) {
  BrakingConfig braking;
  braking.rollouts = 2;
  braking.ways = {{Kind::kConstant, 5.0, "5"}};
  BrakingPlay play;
  play.cell.load = "mill";
  play.cell.motion = {0.5, 0.0};
  play.cell.way = braking.ways[0];
  play.cell.stated_distance = 0.10;
  play.cell.stated_time = 0.3;
  play.cell.is_comparable = play.cell.is_predicted_to_tip = true;
  play.stops = {{true, 1.2, 0.0, 0.02, 0.12, 0.4, 5.0}, {false, 0.1, 0.0, 0.01, 0.10, 0.3, 5.0}};
  play.ideal = BrakingStop{false, 0.001, 0.0, 0.0, 0.1, 0.3, 5.0};  // it does not even tip
  const Findings findings = SumUpBraking(braking, {play});
  EXPECT_EQ(ValueOf(findings, "falls_5"), 1.0);
  EXPECT_EQ(ValueOf(findings, "max_tilt_5"), 1.2);
  EXPECT_EQ(ValueOf(findings, "max_slide_5"), 0.02);
  EXPECT_EQ(ValueOf(findings, "max_distance_5"), 0.12);
  EXPECT_NEAR(ValueOf(findings, "distance_error_5"), 0.01, 1e-12);
  EXPECT_NEAR(ValueOf(findings, "time_error_5"), 0.05, 1e-12);
  EXPECT_EQ(ValueOf(findings, "closed_form_disagreements"), 1.0);
  EXPECT_EQ(findings.rows.size(), 2u);
  EXPECT_EQ(findings.simulated_seconds, 10.0);
}

}  // namespace
}  // namespace hires::lab::experiment_braking_test
