#include "lab/src/recognition/recognition_experiment.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/robot/load_robot.h"
#include "lab/src/recognition/recognition_goals.h"
#include "lab/src/recognition/torso_poses.h"

namespace hires::lab::recognition_experiment_test {
namespace {

using perception::ThingVerdict;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const std::string kSource = HIRES_SOURCE_DIR;

base::Crew CrewOf(int threads) {
  base::Crew crew;
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
  // Those who lack a form call it unknown for the most part, who knows it hardly ever does.
  const perception::RecognitionScore kinds(order.recogniser.catalogue);
  int called_unknown = 0, known_called_unknown = 0;
  for (const auto& thing : report->left_out) {
    EXPECT_EQ(thing.kind, perception::kUnknownLabel);
    EXPECT_THAT(kinds.LabelsLike(thing.model), Not(Contains(thing.label)));
    called_unknown += thing.called == perception::kUnknownLabel ? 1 : 0;
  }
  for (const auto& thing : report->score.things())
    known_called_unknown += thing.is_known() && thing.called == perception::kUnknownLabel ? 1 : 0;
  EXPECT_GE(3 * called_unknown, 2 * static_cast<int>(report->left_out.size()));
  EXPECT_LE(10 * known_called_unknown, sums.num_known);
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
  EXPECT_THAT(ReportText(*report),
              AllOf(HasSubstr("goal: named at least 95 %: 0.0 (0.0 .. "), HasSubstr("), missed")));
  EXPECT_THAT(ReportText(*report), HasSubstr("goal: median error at most 5 mm: -, no value"));
}

TEST(RecognitionExperimentTest, WhereNothingStandsNoGoalHasAValueAndNoneIsMet) {
  const RecognitionReport empty{1, 1, perception::RecognitionScore({})};
  const auto json = ToJson(empty);
  EXPECT_EQ(json.at("version"), 3);
  ASSERT_EQ(json.at("goals").size(), 12u);
  for (const auto& goal : json.at("goals")) {
    EXPECT_TRUE(goal.at("value").is_null()) << goal;
    EXPECT_EQ(goal.at("verdict"), "no value") << goal;
  }
  EXPECT_TRUE(json.at("left_out").at("found").at("lower").is_null());
  EXPECT_TRUE(json.at("boxes").at(0).at("middle").at("median").is_null());
  EXPECT_FALSE(MeetsGoals(empty));
  EXPECT_EQ(json.at("meets_goals"), false);
  EXPECT_THAT(ReportText(empty), HasSubstr("goal: found at least 98 %: -, no value"));
}

TEST(RecognitionExperimentTest, RowsThatTheTableLacksAreNamedBelowIt) {
  RecognitionOrder order = SmallOrder();
  order.tables = 1;
  const auto report = TryRecogniser(order, CrewOf(1));
  ASSERT_TRUE(report && !report->score.things().empty());
  const std::string text = ReportText(*report);
  const std::size_t at = text.find("left out, as no thing was so: ");
  ASSERT_NE(at, std::string::npos) << "one table is seen with one posture of the torso";
  const std::string left_out = text.substr(at, text.find('\n', at) - at);
  std::vector<std::string> shown;
  const auto json = ToJson(*report);
  for (const auto& part : json.at("parts")) shown.push_back(part.at("part"));
  for (const char* torso : {"torso down", "torso half way", "torso up"}) {
    const bool is_shown = std::count(shown.begin(), shown.end(), torso) > 0;
    EXPECT_NE(is_shown, left_out.find(torso) != std::string::npos) << torso << "; " << left_out;
  }
  EXPECT_THAT(text, HasSubstr("distances are from the camera to the thing, the robot's base stands "
                              "up to 1.4 m before the table's middle"));
}

TEST(RecognitionGoalTest, AValueAtItsBoundMeetsItAndOneBeyondDoesNot) {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  const auto verdict = [](double value, double bound, bool is_length) {
    return ToString(RecognitionGoal{"", value, bound, is_length}.verdict());
  };
  EXPECT_EQ(verdict(0.98, 0.98, false), "met");
  EXPECT_EQ(verdict(0.979, 0.98, false), "missed");
  EXPECT_EQ(verdict(0.005, 0.005, true), "met");
  EXPECT_EQ(verdict(0.0051, 0.005, true), "missed");
  EXPECT_EQ(verdict(kNothing, 0.98, false), "no value");
  EXPECT_EQ(verdict(kNothing, 0.005, true), "no value");
}

TEST(RecognitionGoalTest, AShareWhoseIntervalHoldsTheBoundDecidesNothing) {
  const auto verdict = [](double value, double lower, double upper) {
    return ToString(
        RecognitionGoal{"", value, 0.98, false, Interval{value, lower, upper}}.verdict());
  };
  EXPECT_EQ(verdict(0.99, 0.98, 1.0), "met");
  EXPECT_EQ(verdict(1.0, 0.8, 1.0), "undecided");
  EXPECT_EQ(verdict(0.97, 0.96, 0.98), "undecided");
  EXPECT_EQ(verdict(0.97, 0.96, 0.979), "missed");
}

// Without a miss each of equal tables is one case: 0.025^(1/n) >= bound for n >= log 0.025 / log
// bound. Unequal ones are (sum of m)^2 / sum of m^2 cases: 144 / 66 of the three of 4, 1 and 7.
TEST(RecognitionGoalTest, SoManyTablesDecideAsTheClosedFormSays) {
  const std::vector<ClusterCounts> flawless{{4, 4}, {4, 4}, {4, 4}};
  EXPECT_EQ(TablesToDecide(flawless, 3, 0.98), 183);
  EXPECT_EQ(TablesToDecide(flawless, 3, 0.95), 72);
  EXPECT_EQ(TablesToDecide(flawless, 6, 0.95), 144) << "every other one has no case";
  EXPECT_EQ(TablesToDecide({{4, 4}, {1, 1}, {7, 7}}, 3, 0.98), 252);
  EXPECT_EQ(TablesToDecide({{0, 5}, {0, 5}}, 2, 0.98), 2) << "a miss is certain";
  EXPECT_EQ(TablesToDecide({{1, 2}}, 1, 0.5), std::nullopt) << "the bound itself";
}

TEST(RecognitionGoalTest, ItSaysWhyGoalsAreNotMet) {
  RecognitionReport report{3, 1, perception::RecognitionScore({})};
  EXPECT_THAT(WhyGoalsAreNotMet(report),
              testing::StartsWith("without a value, as no thing on these tables tells it: found; "
                                  "named; unknown; median error; box of unknown, middle, median;"));
  RecognitionOrder order = SmallOrder();
  order.tables = 3;
  const auto few = TryRecogniser(order, CrewOf(2));
  ASSERT_TRUE(few);
  EXPECT_THAT(WhyGoalsAreNotMet(*few), HasSubstr("undecided, as the 95 % interval holds the goal: "
                                                 "found; named"));
  EXPECT_THAT(WhyGoalsAreNotMet(*few),
              HasSubstr("about 258 tables (--tables) would decide, if all went as these 3 did\n"));
  order.recogniser.params.min_quality = 1.0;
  const auto none = TryRecogniser(order, CrewOf(2));
  ASSERT_TRUE(none);
  EXPECT_THAT(WhyGoalsAreNotMet(*none), HasSubstr("missed: named"));
}

TEST(RecognitionGoalTest, ThingsAreCountedByTheirTable) {
  const auto thing = [](int table, const char* kind, const char* called) {
    ThingVerdict verdict;
    verdict.table = table;
    verdict.kind = kind;
    verdict.called = called;
    return verdict;
  };
  const std::vector<ThingVerdict> things{thing(0, "mug", "mug"), thing(0, "mug", "bowl"),
                                         thing(2, "mug", ""), thing(2, "unknown", "unknown")};
  const auto named = CountsOf(things, kNamed), of_found = CountsOf(things, kNamedOfFound);
  ASSERT_EQ(named.size(), 3u);
  EXPECT_EQ(named[0].num_all, 2);
  EXPECT_EQ(named[0].num_hits, 1);
  EXPECT_EQ(named[1].num_all, 0);
  EXPECT_EQ(named[2].num_all, 1);
  EXPECT_EQ(named[2].num_hits, 0);
  EXPECT_EQ(of_found.size(), 1u) << "what is not found does not count";
  EXPECT_EQ(CountsOf(things, kUnknown)[2].num_hits, 1);
}

// Two things that go alike on each of 40 tables, against things on 80 tables.
TEST(RecognitionGoalTest, ThingsOfOneTableSayLessThanThoseOfMany) {
  std::vector<ThingVerdict> things(80);
  for (int i = 0; i < 80; ++i) {
    things[i].kind = "mug";
    things[i].called = i % 40 < 20 ? "mug" : "";
    things[i].table = i % 40;
  }
  const Interval pairs = ClusteredShareInterval(CountsOf(things, kNamed));
  for (int i = 0; i < 80; ++i) things[i].table = i;
  const Interval single = ClusteredShareInterval(CountsOf(things, kNamed));
  EXPECT_DOUBLE_EQ(pairs.estimate, single.estimate);
  EXPECT_GT(pairs.upper - pairs.lower, 1.3 * (single.upper - single.lower));
}

TEST(RecognitionExperimentTest, ItIsCancelled) {
  base::Crew crew = CrewOf(1);
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
}  // namespace hires::lab::recognition_experiment_test
