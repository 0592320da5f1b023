#include "hires/ros/imagination/imagine_request.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hires/ros/answer/report_messages.h"
#include "hires/ros/robot/robot_state_messages.h"
#include "hires/ros/values/failure_messages.h"
#include "hires/ros/world/world_messages.h"
#include "support/log_catcher.h"
#include "support/messages.h"

namespace hires_ros::imagine_request_test {
namespace {

namespace imagination = hires::imagination;
using hires::test_support::ConfigErrorOf;
using testing::ElementsAre;
using testing::HasSubstr;

const imagination::ImaginationSetup& Restaurant() {
  static const auto setup = imagination::LoadImaginationSetup(
      imagination::ReadSetupConfig(std::string(HIRES_SOURCE_DIR) + "/config/scene.yaml"));
  return setup;
}

hires::Atom MakeAtom(const std::string& predicate, const std::vector<std::string>& arguments) {
  hires::Atom atom;
  atom.predicate = predicate;
  atom.arguments = arguments;
  return atom;
}

/// Drive blindly with the mill to one of two tables.
hires::ImagineGoal Goal() {
  hires::ImagineGoal goal;
  goal.steps.resize(1);
  goal.steps[0].name = "move_base_blind";
  goal.steps[0].alternatives.resize(1);
  goal.steps[0].alternatives[0].values = {"preManipulationAreaSouthTable1",
                                          "preManipulationAreaNorthTable1"};
  goal.updated_fluents = {MakeAtom("RobotAt", {"preManipulationAreaEastCounter1"}),
                          MakeAtom("On", {"peppermill1", "trayArea1"})};
  goal.rollouts = 8;
  goal.seed = 7;
  return goal;
}

ImagineRequest Request(const hires::ImagineGoal& goal) { return RequestOf(goal, Restaurant(), {}); }

std::string ErrorOf(const hires::ImagineGoal& goal) {
  return ConfigErrorOf([&] { Request(goal); });
}

TEST(ImagineRequestTest, AGoalInSymbolsStartsWhereItSays) {
  const ImagineRequest request = Request(Goal());
  const auto wanted =
      imagination::MakeStartState(Restaurant(), "preManipulationAreaEastCounter1", {"peppermill1"});
  EXPECT_EQ(request.actions.size(), 2u);
  EXPECT_EQ(request.actions[0].arguments[0], "premanipulationareasouthtable1");
  EXPECT_EQ(request.setup.seed, 7u);
  EXPECT_EQ(request.setup.robot_state.X_MB.x, wanted.robot.X_MB.x);
  ASSERT_EQ(request.setup.world_state.objects.size(), 1u);
  EXPECT_EQ(request.setup.world_state.objects[0].X_MO.translation,
            wanted.world.objects[0].X_MO.translation);
  EXPECT_EQ(request.setup.uncertainty, Restaurant().uncertainty);
}

TEST(ImagineRequestTest, AGoalWithStatesStartsInThem) {
  hires::ImagineGoal goal = Goal();
  imagination::StartState start =
      imagination::MakeStartState(Restaurant(), "preManipulationAreaEastCounter1", {"peppermill1"});
  start.robot.X_MB.x += 0.01;
  goal.updated_fluents.clear();
  goal.world_state = ToMsg(start.world);
  goal.robot_state = ToMsg(start.robot);
  EXPECT_EQ(Request(goal).setup.robot_state.X_MB.x, start.robot.X_MB.x);
  goal.world_state.world_hash = Restaurant().world_hash;
  EXPECT_EQ(Request(goal).setup.world_state.objects.size(), 1u);
}

TEST(ImagineRequestTest, WhatAStateSaysInVainIsRefused) {
  hires::ImagineGoal goal = Goal();
  const auto start =
      imagination::MakeStartState(Restaurant(), "preManipulationAreaEastCounter1", {"peppermill1"});
  goal.updated_fluents.clear();
  goal.world_state = ToMsg(start.world);
  goal.robot_state = ToMsg(start.robot);
  goal.robot_state.joints = {};
  EXPECT_THAT(ErrorOf(goal), HasSubstr("no ConfigError"));
  goal.robot_state.postures.resize(1);
  goal.robot_state.postures[0].name = "torso1";
  goal.robot_state.postures[0].value = "TorsoUpPosture";
  EXPECT_THAT(ErrorOf(goal), HasSubstr("robot_state.joints is empty"));
  goal.robot_state.postures.clear();
  goal.world_state.objects[0].name.clear();
  EXPECT_THAT(ErrorOf(goal), HasSubstr("world_state.objects[0].name is empty"));
}

TEST(ImagineRequestTest, WhatHangsOrLiesBelowTheFloorIsWarnedOf) {
  const auto start =
      imagination::MakeStartState(Restaurant(), "preManipulationAreaEastCounter1", {"peppermill1"});
  const auto warnings = [&](double height) {
    hires::ImagineGoal goal = Goal();
    goal.updated_fluents.clear();
    goal.request_id = std::string(100000, 'i');
    goal.world_state = ToMsg(start.world);
    goal.robot_state = ToMsg(start.robot);
    hires::ObjectState& mill = goal.world_state.objects[0];
    mill.pose.position.x += 2.0;  // off the tray
    mill.pose.position.z = height;
    const hires::test_support::LogCatcher log(hires::base::LogLevel::kWarn);
    Request(goal);
    std::vector<std::string> lines;
    for (const std::string& line : log.lines)
      if (line.find("world_state: ") != std::string::npos) lines.push_back(line);
    return lines;
  };
  for (const auto& [height, why] :
       {std::pair(5.0, "would hang"), std::pair(-5.0, "below the floor")}) {
    const std::vector<std::string> lines = warnings(height);
    ASSERT_EQ(lines.size(), 1u) << why;
    EXPECT_THAT(lines[0], testing::AllOf(HasSubstr("'peppermill1'"), HasSubstr(why)));
    EXPECT_LT(lines[0].size(), 5000u);
  }
}

TEST(ImagineRequestTest, ARobotThatFliesIsRefused) {
  hires::WorldState world;
  world.header.frame_id = "map";
  hires::RobotState robot;
  for (const double height : {2.0, -2.0, 1e9}) {
    robot.pose.position.z = height;
    EXPECT_THAT(ConfigErrorOf([&] { RequireSoundState(world, robot); }),
                HasSubstr("robot_state.pose.position.z is"));
  }
  for (const double height : {0.0, 0.05, -0.3}) {
    robot.pose.position.z = height;
    EXPECT_THAT(ConfigErrorOf([&] { RequireSoundState(world, robot); }),
                HasSubstr("no ConfigError"));
  }
}

TEST(ImagineRequestTest, AGoalWithoutAStartIsToldHowToGiveOne) {
  hires::WorldState world;
  const auto error = [&] {
    return ConfigErrorOf([&] { RequireSoundState(world, hires::RobotState()); });
  };
  EXPECT_THAT(error(), HasSubstr("RobotAt(area)"));
  world.objects.resize(1);
  EXPECT_THAT(error(), HasSubstr("header.frame_id is ''"));
  world.header.frame_id = "odom";
  EXPECT_THAT(error(), HasSubstr("header.frame_id is 'odom'"));
  for (const char* map : {"map", "/map"}) {
    world.header.frame_id = map;
    EXPECT_THAT(error(), HasSubstr("no ConfigError"));
  }
}

/// Put the mug down, which the right hand holds.
hires::ImagineGoal PlaceGoal() {
  hires::ImagineGoal goal = Goal();
  goal.steps[0].name = "place_object";
  goal.steps[0].alternatives.resize(3);
  goal.steps[0].alternatives[0].values = {"mug1"};
  goal.steps[0].alternatives[1].values = {"rightArm1"};
  goal.steps[0].alternatives[2].values = {"placingAreaWestRightTable1"};
  goal.updated_fluents = {MakeAtom("RobotAt", {"manipulationAreaSouthTable1"}),
                          MakeAtom("HasTorsoPosture", {"TorsoUpPosture"}),
                          MakeAtom("HasArmPosture", {"leftArm1", "ArmToSidePosture"}),
                          MakeAtom("HasArmPosture", {"rightArm1", "ArmToSidePosture"}),
                          MakeAtom("Holding", {"rightArm1", "mug1"})};
  return goal;
}

TEST(ImagineRequestTest, WhatAHandHoldsAndHowTheArmsAreTravelsAsAState) {
  const ImagineRequest in_symbols = Request(PlaceGoal());
  hires::ImagineGoal goal = PlaceGoal();
  goal.updated_fluents.clear();
  goal.world_state = ToMsg(in_symbols.setup.world_state);
  goal.robot_state = ToMsg(in_symbols.setup.robot_state);
  const ImagineRequest in_numbers = Request(goal);
  EXPECT_TRUE(in_numbers.setup.robot_state == in_symbols.setup.robot_state);
  EXPECT_GT(in_numbers.setup.robot_state.joints.count("r_gripper_joint"), 0u);
  ASSERT_EQ(in_numbers.setup.world_state.objects.size(), 1u);
  const auto& mug = in_numbers.setup.world_state.objects[0];
  EXPECT_EQ(mug.attached_to, "r_gripper_palm_link");
  EXPECT_EQ(mug.X_MO.translation, in_symbols.setup.world_state.objects[0].X_MO.translation);
}

TEST(ImagineRequestTest, AFinalStateIsAStart) {
  const ImagineRequest request = Request(PlaceGoal());
  const auto result = imagination::PlayRollout(request.setup, request.actions[0], 0);
  ASSERT_TRUE(result);
  const hires::RolloutRecord record = ToMsg(*result, 0);
  hires::ImagineGoal next;
  next.steps.resize(1);
  next.steps[0].name = "move_base_blind";
  next.steps[0].alternatives.resize(1);
  next.steps[0].alternatives[0].values = {"preManipulationAreaSouthTable1"};
  next.rollouts = 1;
  next.world_state = record.final_world;
  next.robot_state = record.final_robot;
  EXPECT_NO_THROW(Request(next));
}

TEST(ConversionsTest, ARolloutSaysWhetherAnythingWasWatched) {
  imagination::RolloutResult result;
  result.failure = {hires::base::FailureCode::kAreaOccupied, {"book1", "book2"}};
  result.nothing_watched = true;
  const imagination::RolloutResult back = FromMsg(ToMsg(result, 3));
  EXPECT_TRUE(imagination::SameOutcome(result, back));
  result.nothing_watched = false;
  EXPECT_FALSE(FromMsg(ToMsg(result, 3)).nothing_watched);
}

TEST(ConversionsTest, AFailureKeepsItsCodeItsSubjectsAndItsWords) {
  const hires::base::Failure failure(hires::base::FailureCode::kAreaOccupied, {"book1", "book2"},
                                     "two books");
  const hires::base::Failure back = FromMsg(ToMsg(failure));
  EXPECT_EQ(back, failure);
  EXPECT_EQ(back.detail, "two books");
  EXPECT_EQ(FromMsg(hires::Failure()), hires::base::Failure());
}

TEST(ConversionsTest, AFailureThatALaterVersionSendsIsToldAndNotGuessed) {
  hires::Failure later;
  later.code = 60000;
  later.subjects = {"mug1"};
  later.detail = "spilt";
  const hires::base::Failure failure = FromMsg(later);
  EXPECT_EQ(failure.code, hires::base::FailureCode::kOther);
  EXPECT_EQ(failure.subjects, later.subjects);
  EXPECT_EQ(hires::base::ToString(failure), "other: code 60000, unknown to this version: spilt");
}

imagination::Prediction SomePrediction() {
  imagination::Prediction prediction;
  prediction.action = {"move_base", {"a"}};
  prediction.alternative = 2;
  prediction.evidence.num_rollouts = 8;
  prediction.evidence.success = {0.75, 0.35, 0.97, 8, imagination::IntervalKind::kClopperPearson};
  prediction.evidence.cost = {30.0, 20.0, 90.0};
  prediction.evidence.durations = {11.0, 12.5, 12.5, 14.0};
  prediction.evidence.max_tilts = {0.01, 0.02};
  prediction.evidence.first_causes = {{"braking", 2}, {"turning", 1}};
  prediction.evidence.worst_rollout = 5;
  prediction.evidence.first_failed = 3;
  prediction.evidence.median_rollout = 1;
  return prediction;
}

TEST(ConversionsTest, APredictionKeepsItsKindOfIntervalItsCostAndWhichRolloutsItNames) {
  const imagination::Prediction back = FromMsg(ToMsg(SomePrediction()));
  EXPECT_EQ(back.alternative, 2);
  EXPECT_EQ(back.evidence.success.kind, imagination::IntervalKind::kClopperPearson);
  ASSERT_TRUE(back.evidence.cost.has_value());
  EXPECT_EQ(back.evidence.cost->mean, 30.0);
  EXPECT_EQ(back.evidence.cost->lower, 20.0);
  EXPECT_EQ(back.evidence.cost->upper, 90.0);
  EXPECT_EQ(back.evidence.first_causes, SomePrediction().evidence.first_causes);
  EXPECT_EQ(back.evidence.durations, SomePrediction().evidence.durations);
  EXPECT_EQ(back.evidence.max_tilts, SomePrediction().evidence.max_tilts);
  EXPECT_EQ(back.evidence.worst_rollout, 5);
  EXPECT_EQ(back.evidence.first_failed, 3);
  EXPECT_EQ(back.evidence.median_rollout, 1);
}

TEST(ConversionsTest, WhatAPredictionDoesNotKnowStaysUnknown) {
  imagination::Prediction prediction = SomePrediction();
  prediction.evidence.success.kind = imagination::IntervalKind::kConfidenceSequence;
  prediction.evidence.cost.reset();
  prediction.evidence.first_failed = -1;
  const imagination::Prediction back = FromMsg(ToMsg(prediction));
  EXPECT_EQ(back.evidence.success.kind, imagination::IntervalKind::kConfidenceSequence);
  EXPECT_FALSE(back.evidence.cost.has_value());
  EXPECT_EQ(back.evidence.first_failed, -1);
}

TEST(ConversionsTest, DurationsThatAreNoneAreAnError) {
  hires::Prediction prediction = ToMsg(SomePrediction());
  prediction.durations[0] = std::nan("");
  EXPECT_EQ(ConfigErrorOf([&] { FromMsg(prediction); }),
            "the prediction of move_base(a): a duration is not finite; is the imagination client "
            "of this version?");
}

TEST(ConversionsTest, AnUnknownKindOfIntervalIsAnError) {
  hires::Prediction prediction = ToMsg(SomePrediction());
  prediction.interval_kind = 7;
  EXPECT_THROW(FromMsg(prediction), hires::base::ConfigError);
}

TEST(ReportMessageTest, WhatWasCancelledSaysWhatWasFound) {
  imagination::Report report;
  report.outcome = imagination::ImaginationOutcome::kCancelled;
  EXPECT_EQ(ToMsg(report).outcome, hires::ImagineResult::CANCELLED) << "nothing was finished";
  report.found = imagination::ImaginationOutcome::kAllFailed;
  EXPECT_EQ(ToMsg(report).outcome, hires::ImagineResult::ALL_FAILED);
  report.found = imagination::ImaginationOutcome::kRanked;
  EXPECT_EQ(ToMsg(report).outcome, hires::ImagineResult::RANKED_AT_DEADLINE);
}

TEST(ConversionsTest, WhatStandsBehindACostTravels) {
  using hires::base::FailureCode;
  imagination::Report report;
  EXPECT_FALSE(FromMsg(ToMsg(report)).by_cost);
  report.by_cost = imagination::CostReasons();
  EXPECT_TRUE(FromMsg(ToMsg(report)).by_cost);
  EXPECT_FALSE(FromMsg(ToMsg(report)).by_cost->next);
  EXPECT_FALSE(FromMsg(ToMsg(report)).by_cost->turning);
  report.by_cost->prices = {{FailureCode::kObjectFell, 600.0}, {FailureCode::kNoPath, 60.0}};
  report.by_cost->next = imagination::CostComparison{1, -5.0, -46.5, 12.5, true, 0.875};
  report.by_cost->turning = imagination::TurningPrice{FailureCode::kObjectFell, 64.0, false, 2};
  report.by_cost->probability = 0.75;
  report.by_cost->regret = 1.5;
  report.by_cost->until_settled = 250;
  const imagination::CostReasons back = *FromMsg(ToMsg(report)).by_cost;
  EXPECT_EQ(back.probability, 0.75);
  EXPECT_EQ(back.regret, 1.5);
  EXPECT_EQ(back.until_settled, 250);
  EXPECT_EQ(back.prices, report.by_cost->prices);
  EXPECT_EQ(back.next->other, 1);
  EXPECT_EQ(back.next->time_saved, -5.0);
  EXPECT_EQ(back.next->failures_more, -46.5);
  EXPECT_EQ(back.next->failures_more_upper, 12.5);
  EXPECT_TRUE(back.next->neither_failed);
  EXPECT_EQ(back.next->probability, 0.875);
  EXPECT_EQ(back.turning->code, FailureCode::kObjectFell);
  EXPECT_EQ(back.turning->price, 64.0);
  EXPECT_FALSE(back.turning->is_below);
  EXPECT_EQ(back.turning->other, 2);
}

TEST(ConversionsTest, ANearTieTravelsWithItsEnd) {
  imagination::Report report;
  report.outcome = imagination::ImaginationOutcome::kClose;
  for (const bool complete : {true, false}) {
    report.complete = complete;
    const hires::ImagineResult message = ToMsg(report);
    EXPECT_EQ(message.outcome, hires::ImagineResult::CLOSE);
    EXPECT_EQ(FromMsg(message).outcome, imagination::ImaginationOutcome::kClose);
    EXPECT_EQ(FromMsg(message).complete, complete);
  }
}

TEST(ConversionsTest, UndecidedAndCaveatsTravel) {
  imagination::Report report;
  report.outcome = imagination::ImaginationOutcome::kUndecided;
  report.caveats = {"the floor may be uneven"};
  const hires::ImagineResult message = ToMsg(report);
  EXPECT_EQ(message.outcome, hires::ImagineResult::UNDECIDED);
  EXPECT_EQ(FromMsg(message).outcome, imagination::ImaginationOutcome::kUndecided);
  EXPECT_EQ(FromMsg(message).caveats, report.caveats);
}

TEST(ImagineRequestTest, ReferencesSayAllThatARolloutTakes) {
  imagination::Report report;
  report.ranking = {SomePrediction()};
  imagination::ImaginationSetup setup;
  setup.world_hash = 1;
  setup.robot_hash = 2;
  setup.actions_hash = 3;
  setup.physics_hash = 4;
  ImagineRequest request;
  request.setup.seed = 7;
  request.setup.uncertainty =
      std::make_shared<const imagination::Uncertainty>(imagination::NoUncertainty());
  const hires::RolloutRef worst = AnswerTo(Goal(), request, setup, report).predictions[0].worst;
  EXPECT_EQ(worst.request_id, Goal().request_id);
  EXPECT_EQ(worst.action.name, "move_base");
  EXPECT_EQ(worst.alternative, 2u);
  EXPECT_EQ(worst.index, 5u);
  EXPECT_EQ(worst.seed, 7u);
  EXPECT_EQ(worst.world_hash, 1u);
  EXPECT_EQ(worst.robot_hash, 2u);
  EXPECT_EQ(worst.actions_hash, 3u);
  EXPECT_EQ(worst.physics_hash, 4u);
  EXPECT_EQ(worst.uncertainty_hash, imagination::NoUncertainty().hash);
}

TEST(ImagineRequestTest, StepsMustBeOne) {
  hires::ImagineGoal goal = Goal();
  goal.steps.push_back(goal.steps.front());
  EXPECT_EQ(
      ErrorOf(goal),
      "steps has 2 entries, wanted 1: one step is imagined at a time; ask for each by itself");
  goal.steps.clear();
  EXPECT_THAT(ErrorOf(goal), testing::HasSubstr("steps has 0 entries"));
}

TEST(ImagineRequestTest, AStateOfAnotherWorldIsRefused) {
  hires::ImagineGoal goal = Goal();
  goal.updated_fluents.clear();
  goal.world_state.world_hash = Restaurant().world_hash + 1;
  EXPECT_THAT(ErrorOf(goal), HasSubstr("world_state.world_hash is "));
}

TEST(ImagineRequestTest, WhatAGoalSaysWinsOverTheDefaults) {
  imagination::SchedulerParams defaults;
  defaults.batch = 3;
  defaults.criteria.rule = imagination::RankingRule::kThesis;
  hires::ImagineGoal goal = Goal();
  imagination::SchedulerParams params = RequestOf(goal, Restaurant(), defaults).params;
  EXPECT_EQ(params.rollouts, 8);
  EXPECT_EQ(params.deadline, 0.0);
  EXPECT_EQ(params.batch, 3);
  EXPECT_EQ(params.criteria.rule, imagination::RankingRule::kThesis);
  EXPECT_TRUE(params.early_stop);
  EXPECT_EQ(params.criteria.max_regret, 2.0);
  goal.max_regret = 0.5;
  goal.ranking = "risk";
  goal.play_all = true;
  goal.deadline = ros::Duration(2.5);
  params = RequestOf(goal, Restaurant(), defaults).params;
  EXPECT_EQ(params.criteria.rule, imagination::RankingRule::kRisk);
  EXPECT_FALSE(params.early_stop);
  EXPECT_EQ(params.deadline, 2.5);
  EXPECT_EQ(params.criteria.max_regret, 0.5);
  defaults.early_stop = false;
  goal.play_all = false;
  EXPECT_FALSE(RequestOf(goal, Restaurant(), defaults).params.early_stop);
}

TEST(ImagineRequestTest, TheRequestsOwnUncertaintyCounts) {
  hires::ImagineGoal goal = Goal();
  goal.uncertainty = "none";
  EXPECT_EQ(Request(goal).setup.uncertainty->hash, imagination::NoUncertainty().hash);
  EXPECT_NE(Request(goal).setup.uncertainty->hash, Restaurant().uncertainty->hash);
}

TEST(ImagineRequestTest, WhatCannotBePlayedIsRefusedByName) {
  hires::ImagineGoal goal = Goal();
  goal.rollouts = 0;
  EXPECT_THAT(ErrorOf(goal), HasSubstr("rollouts"));
  for (const std::uint32_t many : {100001u, 2147483648u, 4000000000u, 4294967295u}) {
    goal.rollouts = many;
    EXPECT_THAT(ErrorOf(goal), HasSubstr(fmt::format("rollouts is {}, wanted", many)));
  }
  goal = Goal();
  goal.deadline = ros::Duration(-1.0);
  EXPECT_THAT(ErrorOf(goal), HasSubstr("deadline"));
  goal = Goal();
  goal.ranking = "luck";
  EXPECT_THAT(ErrorOf(goal), HasSubstr("luck"));
  goal = Goal();
  goal.uncertainty = "objct_mass: 1";
  EXPECT_THAT(ErrorOf(goal), HasSubstr("uncertainty of the request"));
  goal = Goal();
  goal.steps[0].alternatives[0].values = {"preManipulationAreaSouthTabel1"};
  EXPECT_THAT(ErrorOf(goal), HasSubstr("did you mean 'premanipulationareasouthtable1'"));
  goal = Goal();
  goal.updated_fluents.pop_back();
  goal.updated_fluents[0].arguments = {"nowhere"};
  EXPECT_THAT(ErrorOf(goal), HasSubstr("nowhere"));
}

TEST(ImagineRequestTest, ARefusalHasNoRecommendation) {
  const hires::ImagineResult result = RefusalOf(Goal(), "because");
  EXPECT_EQ(result.outcome, hires::ImagineResult::INVALID);
  EXPECT_EQ(result.recommended, -1);
  EXPECT_EQ(result.why, "because");
  EXPECT_EQ(result.seed, 7u);
}

TEST(ImagineRequestTest, ALongReasonIsCutBetweenCharacters) {
  std::string why(1999, 'x');
  EXPECT_EQ(RefusalOf(Goal(), why).why, why);
  why += "\u00e4" + why;  // two bytes, of which one would fit
  EXPECT_EQ(RefusalOf(Goal(), why).why, std::string(1999, 'x') + " ...");
}

TEST(ImagineRequestTest, AnAnswerRestsOnTheFluentsOfItsGoal) {
  const hires::ImagineResult result = AnswerTo(Goal(), {}, {}, {});
  EXPECT_EQ(result.outcome, hires::ImagineResult::NOTHING_FINISHED);
  EXPECT_EQ(result.depends_on, Goal().updated_fluents);
}

}  // namespace
}  // namespace hires_ros::imagine_request_test
