#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <utility>

#include "hires/base/text.h"
#include "hires/execution/monitor.h"
#include "support/whole_tasks.h"

// Steps that are imagined while others are carried out.

namespace hires::execution::monitor_imagination_test {
namespace {

using test_support::AllFail;
using test_support::ExpectSound;
using test_support::ExpectSuccess;
using test_support::Failing;
using test_support::For;
using test_support::Golden;
using test_support::LogOf;
using test_support::Ranked;
using test_support::ScriptedWorld;
using test_support::Slow;
using test_support::SouthFails;
using test_support::StepScript;
using test_support::TaskOf;
using test_support::Texts;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

TEST(ImaginationTest, WherePlacingIsImaginedToFailTheOtherSideIsServedAndNoStepIsWasted) {
  auto options = For("serve_coffee_imagined");
  options.imagine = SouthFails;
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee_imagined");
  Texts expected = Golden("serve_coffee");
  expected.resize(10);
  for (const std::string& step : Golden("serve_coffee_south_failed")) expected.push_back(step);
  EXPECT_THAT(world.Begun(), ElementsAreArray(expected)) << LogOf(world);
  EXPECT_EQ(world.CountOf("stop"), 0);
  EXPECT_TRUE(world.Holds({"on", {"mug1", "placingareawestlefttable1"}}));
  EXPECT_THAT(world.warnings(), SizeIs(1)) << "one repair";
  EXPECT_THAT(world.warnings()[0], HasSubstr("imagined_failure: area_occupied: book1"));
}

TEST(ImaginationTest, TheStateIsProjectedToTheImaginedStep) {
  auto options = For("serve_coffee_imagined");
  options.imagine = SouthFails;
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee_imagined");
  std::vector<std::string> state;
  for (const base::Atom& atom : world.imaginations().at(0).state) {
    state.push_back(base::ToString(atom));
  }
  EXPECT_THAT(state, AllOf(Contains("robotat(manipulationareasouthtable1)"),
                           Contains("holding(rightarm1, mug1)"),
                           Contains("hasarmposture(rightarm1, armtosideposture)"),
                           Contains("hastorsoposture(torsoupposture)"),
                           Contains("on(mug2, placingareaeastrightcounter1)")));
  EXPECT_THAT(state, Not(Contains("on(mug1, placingareaeastrightcounter1)")));
  EXPECT_EQ(world.imaginations()[0].plan, 0);
  EXPECT_EQ(world.imaginations()[0].step, 15);
}

TEST(ImaginationTest, WhatIsOtherThanPlannedIsReplacedAllTheSame) {
  // The arm that has set the mill down is on its way back for some time yet, where the plan has it
  // at the side. It will be tucked before the robot drives: the drive is imagined as before.
  auto options = For("carry_object");
  options.imagine = [](const StartImagination& request, int) {
    return Ranked(base::Combinations(request.action).front(), 20.0);
  };
  ScriptedWorld world(options);
  const auto is_placing = [](const Command& command) {
    const auto* start = std::get_if<StartStep>(&command);
    return start != nullptr && start->action.name == "place_on_tray";
  };
  const base::Atom at_side{"hasarmposture", {"rightarm1", "armtosideposture"}};
  const base::Atom on_its_way{"hasarmposture", {"rightarm1", "armunnamedposture"}};
  world.When(is_placing, [&](ScriptedWorld* w) {
    const double end = w->now() - options.start + StepScript().duration;
    const auto becomes = [](const base::Atom& gone, const base::Atom& come) {
      return [=](ScriptedWorld* world) {
        world->Set({gone}, {come});
        world->Observe();
      };
    };
    w->At(end + 0.02, becomes(at_side, on_its_way));
    w->At(end + 2.0, becomes(on_its_way, at_side));
  });
  ExpectSuccess(&world, "carry_object");
  for (const StartImagination& imagination : world.imaginations()) {
    Texts arms;
    for (const base::Atom& atom : imagination.state) {
      if (atom.predicate == "hasarmposture") arms.push_back(base::ToString(atom));
    }
    EXPECT_THAT(arms, UnorderedElementsAre("hasarmposture(leftarm1, armtuckedposture)",
                                           "hasarmposture(rightarm1, armtuckedposture)"));
  }
  EXPECT_THAT(world.imaginations(), SizeIs(1));
}

const char kDrive[] = "move_base_param(premanipulationareanorthtable1, ";

/// The planner's plan has fast; the default is slow.
Texts CarriedSlowly() {
  Texts steps = Golden("carry_object");
  std::replace(steps.begin(), steps.end(), kDrive + std::string("fast)"),
               kDrive + std::string("slow)"));
  return steps;
}

TEST(ToppleTest, TheRecommendedMotionSetIsDriven) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination&, int) { return Slow(); };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(world.imaginations(), SizeIs(1));
  EXPECT_THAT(world.log()[1], HasSubstr("imagine move_base_param @0.05")) << "at once";
  EXPECT_GT(world.StartOf(kDrive + std::string("slow)")), 20.0);
  EXPECT_THAT(world.warnings(), IsEmpty());
  EXPECT_THAT(world.imaginations()[0].action.alternatives,
              ElementsAreArray({Texts{"premanipulationareanorthtable1"}, Texts{"slow", "fast"}}));
}

TEST(ImaginationTest, TheRecommendedSpotIsPlacedAt) {
  auto options = For("serve_coffee_spots");
  options.imagine = [](const StartImagination&, int) {
    return Ranked({"place_object_at", {"mug1", "rightarm1", "placingareawestrighttable1", "left"}},
                  11.0);
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee_spots");
  ASSERT_THAT(world.imaginations(), SizeIs(1));
  EXPECT_THAT(world.imaginations()[0].action.alternatives.back(),
              ElementsAreArray({"any", "middle", "left", "right", "front", "back"}));
  const std::string at = "place_object_at(mug1, rightarm1, placingareawestrighttable1, ";
  EXPECT_GT(world.StartOf(at + "left)"), 0.0);
  EXPECT_LT(world.StartOf(at + "any)"), 0.0);
}

TEST(ImaginationTest, ThePoseThatSeesBestIsLookedFromAndThePlanGoesOn) {
  auto options = For("serve_coffee_looking");
  const std::string area = "placingareaeastrightcounter1", at = "manipulationareaeastcounter1";
  options.imagine = [&](const StartImagination&, int) {
    return Ranked({"observe_objects_at", {area, at, "torsodownposture", "left"}}, 40.0);
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee_looking");
  ASSERT_THAT(world.imaginations(), SizeIs(1));
  const auto& asked = world.imaginations()[0].action.alternatives;
  EXPECT_THAT(asked,
              ElementsAreArray({Texts{area}, Texts{at},
                                Texts{"torsoupposture", "torsomiddleposture", "torsodownposture"},
                                Texts{"default", "left", "right", "behind"}}));
  Texts expected = Golden("serve_coffee");
  expected.insert(expected.begin() + 6,
                  "observe_objects_at(" + area + ", " + at + ", torsodownposture, left)");
  EXPECT_THAT(world.Begun(), ElementsAreArray(expected)) << LogOf(world);
}

TEST(ToppleTest, TheDeadlineIsWhenTheDriveIsExpectedAndMovesWithThePlan) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination&, int) { return std::nullopt; };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  // tuck 6.9, drive, torso 22.8 beside tuck 6.9 and arm 2.1, blind 5, pick 14.1, blind 5,
  // tray 10.9, tuck 6.9: as the sidecar expects. The first drive has no measured duration.
  EXPECT_NEAR(world.imaginations().at(0).deadline, 1000.05 + 6.9 + 22.8 + 5 + 14.1 + 5 + 10.9 + 6.9,
              1e-3);
  ASSERT_THAT(world.moves(), Not(IsEmpty()));
  EXPECT_NEAR(world.moves().back().deadline - 1000.0, world.StartOf(kDrive + std::string("slow)")),
              2.0);
}

TEST(ToppleTest, WithoutAnAnswerInTimeTheDefaultIsDrivenAndSomebodyIsWarned) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination&, int) { return Slow(); };
  options.imagine_delay = 500.0;
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(world.Begun(), ElementsAreArray(CarriedSlowly()));
  EXPECT_THAT(world.warnings(),
              ElementsAreArray({AllOf(HasSubstr("without imagination"),
                                      HasSubstr("there was no answer in time"))}));
}

TEST(ToppleTest, AnAnswerInTheLastMomentStillCounts) {
  auto options = For("carry_object");
  options.imagine_delay = 0.4;
  ScriptedWorld world(options);
  bool is_answered = false;
  world.At(45.0, [&](ScriptedWorld* w) {
    ImagineAnswered answer = Slow();
    answer.request = w->imaginations().at(0).request;
    const auto steps = w->monitor().Steps();
    is_answered = true;
    w->Post(answer);
  });
  ExpectSuccess(&world, "carry_object");
  EXPECT_TRUE(is_answered);
}

planning::OperatorData Waiting() {
  planning::OperatorData data = test_support::RestaurantData();
  data.operators.at("move_base_param").imagine->on_late = planning::OnLate::kWait;
  return data;
}

TEST(ToppleTest, WhereTheDomainSaysSoTheRobotWaits) {
  const planning::OperatorData waiting = Waiting();
  auto options = For("carry_object");
  options.monitor.arrival_margin = 0.5;
  options.operators = &waiting;
  options.imagine = [](const StartImagination&, int) { return Slow(); };
  options.imagine_delay = 150.0;
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_NEAR(world.StartOf(kDrive + std::string("slow)")), 150.05, 1e-6);
  // By the time its patience ends, what was played until then is due.
  EXPECT_NEAR(world.imaginations().at(0).deadline, 1000.05 + options.monitor.max_wait - 0.5, 1e-6);
  EXPECT_THAT(world.warnings(), IsEmpty());
}

TEST(ToppleTest, WhatWasPlayedBeforePatienceEndsIsTaken) {
  const planning::OperatorData waiting = Waiting();
  auto options = For("carry_object");
  options.operators = &waiting;
  options.imagine = [](const StartImagination&, int) { return Slow(); };
  options.imagine_delay =
      options.monitor.max_wait - 0.2;  // as a client that answers at the deadline
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_GT(world.StartOf(kDrive + std::string("slow)")), options.monitor.max_wait - 1.0);
  EXPECT_THAT(world.warnings(), IsEmpty());
}

TEST(ToppleTest, NobodyWaitsForEver) {
  const planning::OperatorData waiting = Waiting();
  auto options = For("carry_object");
  options.operators = &waiting;
  options.imagine = [](const StartImagination&, int) {
    ImagineAnswered answer;
    answer.outcome = ImagineAnswered::Outcome::kNoWorker;
    return answer;
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_NEAR(world.StartOf(kDrive + std::string("slow)")), 300.05, 1e-6);
  EXPECT_GT(world.imaginations().size(), 5u) << "asked again and again";
  EXPECT_THAT(world.warnings(), ElementsAreArray({HasSubstr("no worker is there")}));
}

TEST(ToppleTest, AWorkerThatComesLaterIsAskedAgain) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination&, int count) {
    if (count >= 2) return Slow();
    ImagineAnswered answer;
    answer.outcome = ImagineAnswered::Outcome::kNoWorker;
    return answer;
  };
  options.imagine_delay = 1.0;
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_GT(world.StartOf(kDrive + std::string("slow)")), 0.0);
  EXPECT_THAT(world.warnings(), IsEmpty());
}

ImagineAnswered Undecided() {
  ImagineAnswered answer;
  answer.outcome = ImagineAnswered::Outcome::kUndecided;
  answer.why = "about 90 rollouts decide";
  answer.depends_on = {"peppermill1"};
  return answer;
}

TEST(ToppleTest, WhatImaginationCannotDecideIsNoBanAndTheDefaultIsDriven) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination&, int) { return Undecided(); };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(world.Begun(), ElementsAreArray(CarriedSlowly()));
  EXPECT_THAT(world.imaginations(), SizeIs(1)) << "asking until it says yes would deceive";
  EXPECT_THAT(world.warnings(), ElementsAreArray({AllOf(HasSubstr("imagination could not decide"),
                                                        HasSubstr("about 90 rollouts decide"))}));
}

TEST(ToppleTest, UndecidedCountsAsLateWhereTheDomainSaysWait) {
  const planning::OperatorData waiting = Waiting();
  auto options = For("carry_object");
  options.operators = &waiting;
  options.imagine = [](const StartImagination&, int) { return Undecided(); };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_NEAR(world.StartOf(kDrive + std::string("slow)")), 300.05, 1e-6);
  EXPECT_THAT(world.imaginations(), SizeIs(1));
}

TEST(ToppleTest, UndecidedIsAskedAgainWhenSomethingChanges) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination&, int count) {
    return count == 0 ? Undecided() : Slow();
  };
  ScriptedWorld world(options);
  world.At(10.0, [](ScriptedWorld* w) { w->Post(GeometryChanged{{"peppermill1"}}); });
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(world.imaginations(), SizeIs(2));
  EXPECT_GT(world.StartOf(kDrive + std::string("slow)")), 0.0);
}

TEST(ToppleTest, TheDomainSaysHowOftenItMustSucceed) {
  planning::OperatorData strict = test_support::RestaurantData();
  auto options = For("carry_object");
  options.operators = &strict;
  options.imagine = [](const StartImagination&, int) { return Slow(); };
  const auto asked = [&](std::optional<double> min_success) {
    strict.operators.at("move_base_param").imagine->min_success = min_success;
    ScriptedWorld world(options);
    ExpectSuccess(&world, "carry_object");
    return world.imaginations().at(0).min_success;
  };
  EXPECT_EQ(asked(0.9), 0.9);
  EXPECT_EQ(asked(std::nullopt), 0.0);
}

TEST(ToppleTest, WhatCannotBeImaginedIsNotAskedAgain) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination&, int) {
    ImagineAnswered answer;
    answer.outcome = ImagineAnswered::Outcome::kInvalid;
    answer.why = "no such area";
    return answer;
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(world.imaginations(), SizeIs(1));
  EXPECT_THAT(world.warnings(), ElementsAreArray({HasSubstr("no such area")}));
}

TEST(ToppleTest, WhenAllSetsFailTheTrayGoesToAnotherSideOfTheTable) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination& request, int) {
    const std::string area = request.action.alternatives[0][0];
    if (area == "premanipulationareanorthtable1")
      return AllFail(request, base::FailureCode::kObjectToppled);
    return Ranked({"move_base_param", {area, "slow"}}, 24.0);
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(world.Begun(), Contains("move_base_param(premanipulationareasouthtable1, slow)"));
  EXPECT_THAT(world.imaginations(), SizeIs(2));
  EXPECT_EQ(world.CountOf("stop"), 0) << "what ran is part of the new plan too";
}

TEST(ToppleTest, WhenEverythingFailsEverywhereTheRobotStopsAndSaysSo) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination& request, int) {
    return AllFail(request, base::FailureCode::kObjectToppled);
  };
  ScriptedWorld world(options);
  const Finish finish = world.Run(TaskOf("carry_object"));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kNoPlan) << finish.reason;
  ExpectSound(world);
}

TEST(ToppleTest, UnderThesisPolicyTheDefaultIsDrivenInEveryCase) {
  auto options = For("carry_object");
  options.monitor.imagination = MonitorParams::ImaginePolicy::kThesis;
  options.imagine = [](const StartImagination& request, int) {
    return AllFail(request, base::FailureCode::kObjectToppled);
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(world.Begun(), ElementsAreArray(CarriedSlowly()));
  EXPECT_THAT(world.plannings(), SizeIs(1)) << "nothing is planned again";
  EXPECT_THAT(world.warnings(), SizeIs(1));
}

TEST(ToppleTest, WithoutImaginationNothingIsAsked) {
  auto options = For("carry_object");
  options.monitor.imagination = MonitorParams::ImaginePolicy::kOff;
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(world.Begun(), ElementsAreArray(CarriedSlowly()));
  EXPECT_THAT(world.imaginations(), IsEmpty());
  EXPECT_THAT(world.warnings(), IsEmpty());
}

TEST(ToppleTest, ADurationThatDoesNotFitIsDroppedWithItsConflict) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination&, int) {
    ImagineAnswered answer = Slow();
    answer.duration = 2.0;
    answer.duration_low = 1.0;
    answer.duration_high = 3.0;  // the leg takes at least 4.4 s
    return answer;
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(
      world.warnings(),
      ElementsAreArray({AllOf(HasSubstr("does not fit the plan"), HasSubstr("at most 3 s"))}));
  EXPECT_GT(world.StartOf(kDrive + std::string("slow)")), 0.0);
}

TEST(ToppleTest, ItIsImaginedAgainWhenWhatItRestsOnChanges) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination&, int count) {
    ImagineAnswered answer =
        count == 0 ? Slow()
                   : Ranked({"move_base_param", {"premanipulationareanorthtable1", "fast"}}, 12.0);
    answer.depends_on = {"chair1"};
    return answer;
  };
  options.imagine_delay = 5.0;
  ScriptedWorld world(options);
  world.At(10.0, [](ScriptedWorld* w) { w->Post(GeometryChanged{{"mug2"}}); });
  world.At(12.0, [](ScriptedWorld* w) { w->Post(GeometryChanged{{"Chair1"}}); });
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(world.imaginations(), SizeIs(3)) << "mug2 was not known; chair1 counts";
  EXPECT_GT(world.StartOf(kDrive + std::string("fast)")), 0.0);
}

TEST(ToppleTest, WhatTheRobotCarriesMayMove) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination&, int) { return Slow(); };
  options.imagine_delay = 1.0;
  ScriptedWorld world(options);
  world.When(
      [](const Command& c) {
        const auto* start = std::get_if<StartStep>(&c);
        return start != nullptr && start->action.name == "place_on_tray";
      },
      [](ScriptedWorld* w) { w->Post(GeometryChanged{{"peppermill1"}}); });
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(world.imaginations(), SizeIs(1));
}

TEST(ImaginationTest, WhatRunsButIsNotWantedAnyMoreIsStoppedFirst) {
  auto options = For("serve_coffee_imagined");
  options.imagine = SouthFails;
  options.imagine_delay = 43.0;  // on the way to the south
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee_imagined");
  const double south = world.StartOf("move_base(premanipulationareasouthtable1)");
  EXPECT_GT(south, 40.0);
  EXPECT_LT(south, 43.0);
  EXPECT_EQ(world.CountOf("stop move_base(premanipulationareasouthtable1)"), 1);
  EXPECT_NEAR(world.StartOf("move_base(premanipulationareanorthtable1)"), 43.9, 0.5);
  EXPECT_TRUE(world.Holds({"on", {"mug1", "placingareawestlefttable1"}}));
}

TEST(ImaginationTest, SeveralStepsAreImaginedAtOnceEachFromItsOwnStart) {
  auto options = For("carry_object");
  options.facts.push_back({"imagine", {"place_object"}});
  options.imagine = [](const StartImagination& request, int) {
    return Ranked(base::Combinations(request.action).front(), 20.0);
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  ASSERT_THAT(world.imaginations(), SizeIs(2));
  std::map<std::string, std::string> robot_at;
  for (const StartImagination& imagination : world.imaginations()) {
    for (const base::Atom& atom : imagination.state) {
      if (atom.predicate == "robotat") robot_at[imagination.action.name] = atom.arguments[0];
    }
  }
  EXPECT_EQ(robot_at["move_base_param"], "premanipulationareaeastcounter1");
  EXPECT_EQ(robot_at["place_object"], "manipulationareanorthtable1");
  EXPECT_LT(world.imaginations()[0].deadline, world.imaginations()[1].deadline);
  EXPECT_EQ(world.CountOf("imagine"), 2);
  EXPECT_THAT(world.log()[2], HasSubstr("@0.05"));
}

TEST(ToppleTest, AnAnswerOutlivesARepairThatDoesNotConcernIt) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination&, int) { return Slow(); };
  options.imagine_delay = 5.0;
  options.step =
      Failing("place_on_tray", 1, {base::FailureCode::kNoPath, {"r_forearm_link", "table1"}});
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(world.imaginations(), SizeIs(1));
  EXPECT_GT(world.StartOf(kDrive + std::string("slow)")), 0.0);
}

TEST(ToppleTest, TheCheapestChangeIsTriedFirst) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination&, int) { return Slow(); };
  options.step = Failing("place_on_tray", 1, base::FailureCode::kObjectSlipped);
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  ASSERT_THAT(world.plannings(), SizeIs(2));
  // What was begun goes on where it was: of loading the tray the last step is left.
  EXPECT_THAT(world.plannings()[1].tasks, AllOf(HasSubstr("(!place_on_tray rightarm1 peppermill1)"),
                                                HasSubstr("(unload_tray peppermill1 table1)"),
                                                Not(HasSubstr("carry_object_on_tray"))));
}

// ---------------------------------------------------------------------------- defaults and repairs

ImagineAnswered Without(ImagineAnswered::Outcome outcome) {
  ImagineAnswered answer;
  answer.outcome = outcome;
  return answer;
}

ImagineAnswered Fast() {
  return Ranked({"move_base_param", {"premanipulationareanorthtable1", "fast"}}, 17.0);
}

/// The first drive with the tray loaded fails after 5 s, as when what carries it out is killed.
ScriptedWorld::Options WithDriveLost() {
  auto options = For("carry_object");
  options.imagine_delay = 4.0;
  options.step = [is_first = true](const base::ActionCall& action, int) mutable {
    StepScript script;
    if (action.name != "move_base_param" || !std::exchange(is_first, false)) return script;
    script.result = StepFinished::Result::kUnavailable;
    script.failure = base::FailureCode::kUnavailable;
    return script;
  };
  return options;
}

bool AsksForTheRepair(const Command& command) {
  const auto* asked = std::get_if<StartImagination>(&command);
  return asked != nullptr && asked->plan == 1;
}

Texts DrivesOf(const ScriptedWorld& world) {
  Texts drives;
  for (const std::string& step : world.Begun()) {
    if (step.rfind("move_base_param", 0) == 0) drives.push_back(step);
  }
  return drives;
}

TEST(RepairedStepTest, WaitsForTheAnswerToItsNewStart) {
  auto options = WithDriveLost();
  options.imagine = [](const StartImagination&, int count) { return count == 0 ? Slow() : Fast(); };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(DrivesOf(world), ElementsAreArray({kDrive + std::string("slow)"),
                                                 kDrive + std::string("fast)")}));
  ASSERT_THAT(world.imaginations(), SizeIs(2));
  const double asked = world.imaginations()[1].deadline - options.monitor.late_wait;
  EXPECT_NEAR(world.StartOf(kDrive + std::string("fast)")), asked - options.start + 4.0, 1e-6);
  EXPECT_THAT(world.warnings(), SizeIs(1)) << "the repair";
}

TEST(RepairedStepTest, KeepsTheEarlierChoiceWhereNoAnswerComes) {
  for (const auto& chosen : {Slow(), Fast()}) {  // whatever the default is
    auto options = WithDriveLost();
    options.imagine = [&](const StartImagination&, int count) {
      return count == 0 ? std::optional<ImagineAnswered>(chosen) : std::nullopt;
    };
    ScriptedWorld world(options);
    ExpectSuccess(&world, "carry_object");
    const std::string drive = base::ToString(chosen.recommended);
    EXPECT_THAT(DrivesOf(world), ElementsAreArray({drive, drive})) << LogOf(world);
    ASSERT_THAT(world.warnings(), SizeIs(2)) << "the repair, and";
    EXPECT_THAT(world.warnings()[1], HasSubstr("keeps what was imagined for an earlier start"));
  }
}

TEST(RepairedStepTest, ShowsTheEarlierChoiceWhileItWaits) {
  auto options = WithDriveLost();
  options.imagine = [](const StartImagination&, int count) {
    return count == 0 ? std::optional<ImagineAnswered>(Slow()) : std::nullopt;
  };
  ScriptedWorld world(options);
  Texts ready;
  world.When(AsksForTheRepair,
             [&](ScriptedWorld* w) {
               w->At(w->now() - 1000.0 + 5.0, [&](ScriptedWorld* later) {
                 for (const StepStatus& step : later->monitor().Steps()) {
                   if (step.phase != StepPhase::kReady) continue;
                   ready.push_back(base::ToString(step.action));
                 }
               });
             });
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(ready, ElementsAreArray({kDrive + std::string("slow)")}));
}

TEST(RepairedStepTest, AsksAgainUntilItsWaitIsOverWhereNoWorkerIsThere) {
  auto options = WithDriveLost();
  options.imagine_delay = 0.1;
  options.imagine = [](const StartImagination&, int count) {
    if (count == 0 || count == 4) return count == 0 ? Slow() : Fast();
    return Without(ImagineAnswered::Outcome::kNoWorker);
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(DrivesOf(world), ElementsAreArray({kDrive + std::string("slow)"),
                                                 kDrive + std::string("fast)")}));
}

TEST(RepairedStepTest, TakesTheDefaultWhereTheNewAnswerCannotDecide) {
  auto options = WithDriveLost();
  options.imagine = [](const StartImagination&, int count) {
    return count == 0 ? Fast() : Without(ImagineAnswered::Outcome::kUndecided);
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(DrivesOf(world), ElementsAreArray({kDrive + std::string("fast)"),
                                                 kDrive + std::string("slow)")}));
}

TEST(RepairedStepTest, TakesTheDefaultUnderThesisPolicy) {
  auto options = WithDriveLost();
  options.monitor.imagination = MonitorParams::ImaginePolicy::kThesis;
  options.monitor.defaults = {{"motion_set", "fast"}};
  options.imagine = [](const StartImagination&, int count) {
    return count == 0 ? std::optional<ImagineAnswered>(Slow()) : std::nullopt;
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(DrivesOf(world), ElementsAreArray({kDrive + std::string("slow)"),
                                                 kDrive + std::string("fast)")}));
}

TEST(RepairedStepTest, ForgetsTheChoiceOfAnotherTask) {
  auto options = For("carry_object");
  options.imagine_delay = 4.0;
  options.imagine = [](const StartImagination&, int count) {
    return count == 0 ? std::optional<ImagineAnswered>(Fast()) : std::nullopt;
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  world.Set({{"on", {"peppermill1", "placingareawestlefttable1"}}},
            {{"on", {"peppermill1", "placingareaeastrightcounter1"}}});
  world.Observe();
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(DrivesOf(world), ElementsAreArray({kDrive + std::string("fast)"),
                                                 kDrive + std::string("slow)")}));
}

TEST(LateAnswerTest, ChoiceIsDroppedWhenWhatItRestsOnChanges) {
  auto options = For("carry_object");
  options.imagine_delay = 4.0;
  options.imagine = [](const StartImagination&, int count) {
    ImagineAnswered answer = Fast();
    answer.depends_on = {"chair1"};
    return count == 0 ? std::optional<ImagineAnswered>(answer) : std::nullopt;
  };
  ScriptedWorld world(options);
  world.At(10.0, [](ScriptedWorld* w) { w->Post(GeometryChanged{{"chair1"}}); });
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(DrivesOf(world), ElementsAreArray({kDrive + std::string("slow)")}));
}

TEST(LateAnswerTest, StepAskedAtItsTurnWaitsForLateWaitAtMost) {
  auto options = WithDriveLost();
  options.monitor.late_wait = 12.0;
  options.imagine = [](const StartImagination&, int count) {
    return count == 0 ? std::optional<ImagineAnswered>(Fast()) : std::nullopt;
  };
  ScriptedWorld world(options);
  double asked = 0.0, begun = 0.0;
  world.When(AsksForTheRepair,
             [&](ScriptedWorld* w) { asked = w->now(); });
  world.When([&](const Command& c) { return asked > 0.0 && std::get_if<StartStep>(&c); },
             [&](ScriptedWorld* w) { begun = w->now(); });
  ExpectSuccess(&world, "carry_object");
  EXPECT_NEAR(begun - asked, 12.0 + options.monitor.answer_grace, 1e-6);
}

/// What is driven without any answer.
Texts UnimaginedDrives(const MonitorParams& monitor, const planning::OperatorData& data) {
  auto options = For("carry_object");
  options.monitor = monitor;
  options.operators = &data;
  options.imagine = [](const StartImagination&, int) { return std::nullopt; };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  return DrivesOf(world);
}

TEST(DefaultTest, MostCautiousMotionSetIsDrivenWhereTheDomainNamesNone) {
  planning::OperatorData data = test_support::RestaurantData();
  data.operators.at("move_base_param").imagine->defaults.clear();
  MonitorParams monitor;
  monitor.motion_sets = {"crawl", "slow", "fast"};  // no alternative is called crawl
  EXPECT_THAT(UnimaginedDrives(monitor, data), ElementsAreArray({kDrive + std::string("slow)")}));
  monitor.imagination = MonitorParams::ImaginePolicy::kOff;
  EXPECT_THAT(UnimaginedDrives(monitor, data), ElementsAreArray({kDrive + std::string("slow)")}));
}

TEST(DefaultTest, ConfiguredDefaultOverridesTheDomains) {
  MonitorParams monitor;
  monitor.defaults = {{"motion_set", "fast"}};
  EXPECT_THAT(UnimaginedDrives(monitor, test_support::RestaurantData()),
              ElementsAreArray({kDrive + std::string("fast)")}));
}

TEST(DefaultTest, ConfiguredDefaultThatIsNoAlternativeIsWarnedOf) {
  auto options = For("carry_object");
  options.monitor.defaults = {{"motion_set", "fats"}};
  options.monitor.imagination = MonitorParams::ImaginePolicy::kOff;
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(DrivesOf(world), ElementsAreArray({kDrive + std::string("slow)")}));
  EXPECT_THAT(world.warnings(), ElementsAreArray({AllOf(
                                    HasSubstr("motion_set=fats is not among the alternatives"),
                                    HasSubstr("slow is used"))}));
}

}  // namespace
}  // namespace hires::execution::monitor_imagination_test
