#include "hires/evaluation/recognition/recognition_experiment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/evaluation/recognition/torso_poses.h"
#include "hires/robot/load_robot.h"

namespace hires::evaluation::recognition_experiment_test {
namespace {

const std::string kSource = HIRES_SOURCE_DIR;

Crew CrewOf(int threads) {
  Crew crew;
  crew.threads = threads;
  return crew;
}

RecognitionOrder SmallOrder() {
  RecognitionOrder order;
  order.tables = 5;
  order.robot = robot::LoadRobot(kSource + "/config/robots/pr2.yaml");
  order.recogniser = perception::ReadRecogniserConfig(kSource + "/config/recogniser.yaml");
  return order;
}

/// All numbers but those of time.
nlohmann::ordered_json NumbersOf(const RecognitionReport& report) {
  nlohmann::ordered_json json = ToJson(report);
  json.erase("seconds_per_cloud");
  return json;
}

TEST(RecognitionExperimentTest, AnyNumberOfThreadsGivesTheSameNumbers) {
  const RecognitionOrder order = SmallOrder();
  const auto one = TryRecogniser(order, CrewOf(1)), two = TryRecogniser(order, CrewOf(2));
  ASSERT_TRUE(one && two);
  EXPECT_EQ(NumbersOf(*one), NumbersOf(*two));
  const auto things = perception::SumsOf(one->score.things());
  EXPECT_GT(things.num_things, 8);
  EXPECT_GT(things.num_named, 5);
  EXPECT_EQ(ToJson(*one).at("parts").at(0).at("found").at("all"), things.num_things);
}

TEST(RecognitionExperimentTest, OwnLabelsLeftOutKindsAndTheMountAreCountedApart) {
  RecognitionOrder order = SmallOrder();
  order.tables = 12;
  const auto report = TryRecogniser(order, CrewOf(2));
  ASSERT_TRUE(report);
  const auto sums = perception::SumsOf(report->score.things());
  EXPECT_LT(sums.num_own_label, sums.num_named) << "of things that look alike one label is told";
  EXPECT_LE(sums.num_named, sums.num_known_found);
  EXPECT_GT(sums.median_error_B, 2.0 * sums.median_error);
  EXPECT_GE(report->left_out.size(), 6u);
  for (const auto& thing : report->left_out) {
    EXPECT_EQ(thing.kind, perception::kUnknownLabel);
    EXPECT_NE(thing.called, thing.model);
  }
  EXPECT_NE(ReportText(*report).find("kinds left out of the catalogue"), std::string::npos);
}

TEST(RecognitionExperimentTest, OneThatRecognisesNothingMissesItsGoals) {
  RecognitionOrder order = SmallOrder();
  order.recogniser.params.min_quality = 1.0;
  const auto report = TryRecogniser(order, CrewOf(2));
  ASSERT_TRUE(report);
  const auto sums = perception::SumsOf(report->score.things());
  EXPECT_EQ(sums.num_named, 0);
  EXPECT_EQ(sums.num_unknown_so_called, sums.num_unknown);
  EXPECT_FALSE(MeetsGoals(*report));
  EXPECT_NE(ReportText(*report).find("named 95 % missed"), std::string::npos);
}

TEST(RecognitionExperimentTest, ItIsCancelled) {
  Crew crew = CrewOf(1);
  crew.cancelled = [] { return true; };
  EXPECT_FALSE(TryRecogniser(SmallOrder(), crew));
}

TorsoPosesOrder OneMill() {
  TorsoPosesOrder order;
  order.setup = imagination::LoadImaginationSetup(
      imagination::ReadSetupConfig(kSource + "/config/scene.yaml"));
  order.recogniser = perception::ReadRecogniserConfig(kSource + "/config/recogniser.yaml");
  auto& known = order.recogniser.catalogue;
  known.erase(std::remove_if(known.begin(), known.end(),
                             [](const auto& one) { return one.label != "peppermill_thesis"; }),
              known.end());
  order.looks = 1;
  return order;
}

TEST(TorsoPosesTest, AMillIsGraspedAndSeenBetterFromAboveForAnyNumberOfThreads) {
  const TorsoPosesOrder order = OneMill();
  const auto one = PlayTorsoPoses(order, CrewOf(1)), two = PlayTorsoPoses(order, CrewOf(2));
  ASSERT_TRUE(one && two);
  EXPECT_EQ(ToJson(*one), ToJson(*two));
  ASSERT_EQ(one->trials.size(), 12u);
  EXPECT_FALSE(one->at(0, 0, 0, 0).grasp) << "torso down: the forearm meets the table";
  EXPECT_TRUE(one->at(2, 0, 0, 0).grasp);
  EXPECT_EQ(one->at(0, 0, 0, 0).recognised, 0.0) << "nearer than the camera measures";
  EXPECT_GT(one->at(2, 3, 0, 0).recognised, 0.5);
}

TEST(TorsoPosesTest, PlacesThatThereAreNotAreNamed) {
  TorsoPosesOrder order = OneMill();
  order.stand = "manipulationAreaSouthTable9";
  try {
    PlayTorsoPoses(order, CrewOf(1));
    FAIL() << "was taken";
  } catch (const base::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("manipulationAreaSouthTable9"), std::string::npos);
  }
}

}  // namespace
}  // namespace hires::evaluation::recognition_experiment_test
