#include "hires/execution/monitor.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <utility>

#include "hires/base/text.h"
#include "support/scripted_world.h"

// Whole tasks in a scripted world. The expected plans are Listings 6.1 and 6.2 of S. Rockel's
// dissertation (University of Hamburg, 2015) and the plan of the toppling scenario.

namespace hires::execution {
namespace {

using test_support::AllFail;
using test_support::FactsOf;
using test_support::Ranked;
using test_support::ScriptedWorld;
using test_support::StepScript;
using test_support::TaskOf;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

using Texts = std::vector<std::string>;

/// "(!move_base a)" as "move_base(a)", without `!imagine`.
Texts Golden(const std::string& name) {
  const std::string path = std::string(HIRES_SOURCE_DIR) + "/test/data/planning/" + name + ".plan";
  Texts actions;
  for (std::string line : base::Split(base::ReadTextFile(path), '\n')) {
    if (line.empty() || line.rfind("(!imagine", 0) == 0) continue;
    line = line.substr(2, line.size() - 3);
    Texts words = base::Split(line, ' ');
    const std::string name_of = words.front();
    words.erase(words.begin());
    actions.push_back(name_of + "(" + base::Join(words, ", ") + ")");
  }
  return actions;
}

ScriptedWorld::Options For(const std::string& problem) {
  ScriptedWorld::Options options;
  options.facts = FactsOf(problem);
  return options;
}

std::string LogOf(const ScriptedWorld& world) { return base::Join(world.log(), "\n"); }

void ExpectSound(const ScriptedWorld& world) {
  EXPECT_THAT(world.violations(), IsEmpty()) << LogOf(world);
}

void ExpectSuccess(ScriptedWorld* world, const std::string& problem) {
  const Finish finish = world->Run(TaskOf(problem));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kSucceeded) << finish.reason << "\n" << LogOf(*world);
  ExpectSound(*world);
}

TEST(MonitorTest, ServingCoffeeIsCarriedOutAsInListing61) {
  ScriptedWorld world(For("serve_coffee"));
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_THAT(world.Begun(), ElementsAreArray(Golden("serve_coffee"))) << LogOf(world);
  EXPECT_TRUE(world.Holds({"on", {"mug1", "placingareawestrighttable1"}}));
  EXPECT_THAT(world.warnings(), IsEmpty());
}

TEST(MonitorTest, TorsoAndArmsMoveAtTheSameTime) {
  ScriptedWorld world(For("serve_coffee"));
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_EQ(world.StartOf("move_torso(torsoupposture)"),
            world.StartOf("tuck_arms(armtuckedposture, armuntuckedposture)"));
  EXPECT_EQ(world.StartOf("move_torso(torsomiddleposture)"),
            world.StartOf("move_arms_to_carryposture()"));
}

TEST(MonitorTest, PlansWithoutReasonsAreCarriedOutToo) {
  auto options = For("serve_coffee");
  options.plans = ScriptedWorld::Options::PlanForm::kSteps;
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_THAT(world.Begun(), ElementsAreArray(Golden("serve_coffee")));
}

TEST(MonitorTest, PlansWithoutDecompositionAreMendedByTheWholeTask) {
  for (const auto form :
       {ScriptedWorld::Options::PlanForm::kSteps, ScriptedWorld::Options::PlanForm::kFlat}) {
    auto options = For("serve_coffee");
    options.plans = form;
    options.step = [](const base::ActionCall& action, int count) {
      StepScript script;
      if (action.name == "move_torso" && count == 0) {
        script.result = StepFinished::Result::kFailed;
        script.reason = "stuck";
      }
      return script;
    };
    ScriptedWorld world(options);
    ExpectSuccess(&world, "serve_coffee");
    EXPECT_GT(world.plannings().size(), 2u);
    for (const StartPlanning& planning : world.plannings()) {
      EXPECT_EQ(base::ToLower(planning.tasks), "(serve_coffee_to_guest guest1)");
    }
  }
}

TEST(MonitorTest, WhatIsDoneAlreadyNeedsNoStep) {
  ScriptedWorld world(For("clear_table"));
  EXPECT_EQ(world.Run("clear_table table2 counter1").outcome, Finish::Outcome::kSucceeded);
  EXPECT_THAT(world.Begun(), IsEmpty());
  ExpectSound(world);
}

TEST(MonitorTest, TwoMugsAreClearedInOneTask) {
  ScriptedWorld world(For("clear_table"));
  ExpectSuccess(&world, "clear_table");
  EXPECT_THAT(world.Begun(), ElementsAreArray(Golden("clear_table")));
}

TEST(MonitorTest, ATaskThatIsNoneIsRefusedWithWhatIsWrong) {
  for (const auto& [task, text] : std::vector<std::pair<std::string, std::string>>{
           {"serve_tea guest1", "serve_tea"}, {"(serve", "task:1:1"}, {"", "names no task"}}) {
    ScriptedWorld world(For("serve_coffee"));
    const Finish finish = world.Run(task);
    EXPECT_EQ(finish.outcome, Finish::Outcome::kFailed);
    EXPECT_THAT(finish.reason, HasSubstr(text));
    ExpectSound(world);
  }
}

TEST(MonitorTest, NoPlanIsSaidWithThePlannersReason) {
  ScriptedWorld world(For("serve_coffee"));
  const Finish finish = world.Run("serve_coffee_to_guest guest5");
  EXPECT_EQ(finish.outcome, Finish::Outcome::kNoPlan);
  EXPECT_EQ(finish.reason, "there is no plan: every way was tried");
  EXPECT_THAT(world.Begun(), IsEmpty());
}

TEST(MonitorTest, NothingIsDoneBeforeAnythingWasObserved) {
  const MonitorParams params;
  Monitor monitor(&test_support::Restaurant(), &test_support::RestaurantData(), params);
  EXPECT_FALSE(monitor.is_busy());
  const auto commands = monitor.Handle(TaskRequested{"clear_table table2 counter1"}, 10.0);
  ASSERT_THAT(commands, SizeIs(1));
  EXPECT_THAT(std::get<Finish>(commands[0]).reason, HasSubstr("nothing has been observed"));
  EXPECT_FALSE(monitor.is_busy());
  EXPECT_EQ(monitor.WakeAt(), std::nullopt);
}

TEST(MonitorTest, ASecondTaskIsNotTakenUpBesideTheFirst) {
  ScriptedWorld world(For("serve_coffee"));
  world.At(20.0, [](ScriptedWorld* w) { w->Post(TaskRequested{"clear_table table1 counter1"}); });
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_THAT(world.warnings(), ElementsAreArray({AllOf(HasSubstr("clear_table table1 counter1"),
                                                        HasSubstr("preempt it first"))}));
}

// ------------------------------------------------------------------------------------ imagination

/// Placing at the south of the table is imagined to fail, elsewhere to succeed.
std::optional<ImagineAnswered> SouthFails(const StartImagination& request, int) {
  if (request.action.alternatives.back().front() == "placingareawestrighttable1") {
    ImagineAnswered answer = AllFail(request, "area_occupied: book1");
    answer.depends_on = {"book1"};
    return answer;
  }
  return Ranked({request.action.name, {"mug1", "rightarm1", "placingareawestlefttable1"}}, 12.0);
}

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
  EXPECT_THAT(world.warnings()[0], HasSubstr("imagined to fail: area_occupied: book1"));
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

ImagineAnswered Slow() {
  return Ranked({"move_base_param", {"premanipulationareanorthtable1", "slow"}}, 24.0);
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
  EXPECT_NEAR(world.moves().back().deadline - 1000.0, world.StartOf(kDrive + std::string("fast)")),
              2.0);
}

TEST(ToppleTest, WithoutAnAnswerInTimeTheDefaultIsDrivenAndSomebodyIsWarned) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination&, int) { return Slow(); };
  options.imagine_delay = 500.0;
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(world.Begun(), ElementsAreArray(Golden("carry_object"))) << "with fast";
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
  options.operators = &waiting;
  options.imagine = [](const StartImagination&, int) { return Slow(); };
  options.imagine_delay = 150.0;
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_NEAR(world.StartOf(kDrive + std::string("slow)")), 150.05, 1e-6);
  EXPECT_EQ(world.imaginations().at(0).deadline, temporal::kForever);
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
  EXPECT_NEAR(world.StartOf(kDrive + std::string("fast)")), 300.05, 1e-6);
  EXPECT_GT(world.imaginations().size(), 5u) << "asked again and again";
  EXPECT_THAT(world.warnings(), ElementsAreArray({HasSubstr("nobody is there")}));
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
    if (area == "premanipulationareanorthtable1") return AllFail(request, "object_toppled");
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
    return AllFail(request, "object_toppled");
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
    return AllFail(request, "object_toppled");
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(world.Begun(), ElementsAreArray(Golden("carry_object")));
  EXPECT_THAT(world.plannings(), SizeIs(1)) << "nothing is planned again";
  EXPECT_THAT(world.warnings(), SizeIs(1));
}

TEST(ToppleTest, WithoutImaginationNothingIsAsked) {
  auto options = For("carry_object");
  options.monitor.imagination = MonitorParams::ImaginePolicy::kOff;
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(world.Begun(), ElementsAreArray(Golden("carry_object")));
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
  options.step = [](const base::ActionCall& action, int count) {
    StepScript script;
    if (action.name == "place_on_tray" && count == 0) {
      script.result = StepFinished::Result::kFailed;
      script.reason = "no_path: r_forearm_link touches table1";
    }
    return script;
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  EXPECT_THAT(world.imaginations(), SizeIs(1));
  EXPECT_GT(world.StartOf(kDrive + std::string("slow)")), 0.0);
}

TEST(ToppleTest, TheCheapestChangeIsTriedFirst) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination&, int) { return Slow(); };
  options.step = [](const base::ActionCall& action, int count) {
    StepScript script;
    if (action.name == "place_on_tray" && count == 0) {
      script.result = StepFinished::Result::kFailed;
      script.reason = "grasp_lost";
    }
    return script;
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "carry_object");
  ASSERT_THAT(world.plannings(), SizeIs(2));
  // What was begun goes on where it was: of loading the tray the last step is left.
  EXPECT_THAT(world.plannings()[1].tasks, AllOf(HasSubstr("(!place_on_tray rightarm1 peppermill1)"),
                                                HasSubstr("(unload_tray peppermill1 table1)"),
                                                Not(HasSubstr("carry_object_on_tray"))));
}

// ------------------------------------------------------------------------------ things go wrong

/// The first `times` attempts of actions of that name fail.
auto Failing(const std::string& name, int times, const std::string& reason) {
  return [=](const base::ActionCall& action, int count) {
    StepScript script;
    if (action.name == name && count < times) {
      script.result = StepFinished::Result::kFailed;
      script.reason = reason;
    }
    return script;
  };
}

TEST(FailureTest, AnOccupiedAreaSendsTheRobotToTheOtherSide) {
  auto options = For("serve_coffee");
  options.step = [](const base::ActionCall& action, int) {
    StepScript script;
    if (action.name == "place_object" && action.arguments[2] == "placingareawestrighttable1") {
      script.result = StepFinished::Result::kFailed;
      script.reason = "area_occupied: book1";
    }
    return script;
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_TRUE(world.Holds({"on", {"mug1", "placingareawestlefttable1"}}));
  EXPECT_EQ(world.CountOf("begin place_object"), 2);
}

TEST(FailureTest, WhatWasInTheWayAndWentIsInTheWayNoMore) {
  // South and north are occupied, by different things; then the south becomes free.
  auto options = For("serve_coffee");
  bool is_free = false;
  options.step = [&](const base::ActionCall& action, int) {
    StepScript script;
    if (action.name != "place_object") return script;
    const bool is_south = action.arguments[2] == "placingareawestrighttable1";
    if (is_south && is_free) return script;
    script.result = StepFinished::Result::kFailed;
    script.reason = is_south ? "area_occupied: book1" : "area_occupied: vase1";
    return script;
  };
  ScriptedWorld world(options);
  world.At(1.0, [](ScriptedWorld* w) { w->Post(GeometryChanged{{"book1"}}); });
  world.At(80.0, [&](ScriptedWorld* w) {
    is_free = true;
    w->Post(GeometryChanged{{"book1"}});
  });
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_EQ(world.CountOf("begin place_object"), 3);
  EXPECT_TRUE(world.Holds({"on", {"mug1", "placingareawestrighttable1"}}));
}

TEST(FailureTest, WhatFailsTwiceWithNothingChangedIsDoneAnotherWay) {
  auto options = For("serve_coffee");
  options.step = [](const base::ActionCall& action, int) {
    StepScript script;
    if (action.name == "pick_up_object" && action.arguments[1] == "rightarm1") {
      script.result = StepFinished::Result::kFailed;
      script.reason = "no_path: r_forearm_link touches peppermill1";
    }
    return script;
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_EQ(world.CountOf("begin pick_up_object"), 3) << "right, right, left";
}

TEST(FailureTest, WhatFailsInEveryWayEndsTheTask) {
  auto options = For("serve_coffee");
  options.step = Failing("pick_up_object", 100, "grasp_failed");
  ScriptedWorld world(options);
  const Finish finish = world.Run(TaskOf("serve_coffee"));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kNoPlan);
  EXPECT_THAT(finish.reason, HasSubstr("there is no plan"));
  EXPECT_THAT(finish.reason, HasSubstr("pick_up_object(mug1, leftarm1): grasp_failed"));
  EXPECT_EQ(world.CountOf("begin pick_up_object"), 4) << "each arm twice";
  ExpectSound(world);
}

TEST(FailureTest, WhereNobodyServesActionsNoOtherWayIsTried) {
  auto options = For("serve_coffee");
  options.step = [](const base::ActionCall& action, int) {
    StepScript script;
    if (action.name == "pick_up_object") {
      script.result = StepFinished::Result::kUnavailable;
      script.reason = "nobody serves execute_action";
    }
    return script;
  };
  ScriptedWorld world(options);
  const Finish finish = world.Run(TaskOf("serve_coffee"));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kFailed);
  EXPECT_THAT(finish.reason, HasSubstr("twice in a row, and nothing has changed"));
  EXPECT_EQ(world.CountOf("begin pick_up_object"), 2);
  ExpectSound(world);
}

TEST(FailureTest, AFailureThatPassesIsTriedAgain) {
  auto options = For("serve_coffee");
  options.step = Failing("pick_up_object", 1, "grasp_failed");
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_EQ(world.CountOf("begin pick_up_object"), 2);
  EXPECT_THAT(world.plannings(), SizeIs(2));
}

TEST(FailureTest, AStepThatNeverEndsIsStoppedAndTriedAgain) {
  auto options = For("serve_coffee");
  options.step = [](const base::ActionCall& action, int count) {
    StepScript script;
    script.ends = action.name != "move_base" || count > 0;
    return script;
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_EQ(world.CountOf("stop move_base"), 2) << "two drives, each once";
  EXPECT_THAT(world.warnings(), Contains(HasSubstr("timed_out")));
}

TEST(FailureTest, NothingIsBegunBesideAStepThatDoesNotStop) {
  auto options = For("serve_coffee");
  options.step = [](const base::ActionCall& action, int) {
    StepScript script;
    script.ends = script.obeys = action.name != "move_torso";
    return script;
  };
  ScriptedWorld world(options);
  const Finish finish = world.Run(TaskOf("serve_coffee"));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kFailed);
  EXPECT_EQ(finish.reason,
            "move_torso(torsoupposture) was told to stop and has not answered for 10 s");
  EXPECT_THAT(world.warnings(), Contains(HasSubstr("the robot may still move")));
  EXPECT_EQ(world.CountOf("begin move_torso"), 1);
}

TEST(FailureTest, SuccessThatNobodySeesIsNone) {
  auto options = For("serve_coffee");
  options.step = [](const base::ActionCall& action, int count) {
    StepScript script;
    script.has_effects = action.name != "pick_up_object" || count > 0;
    return script;
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_EQ(world.CountOf("begin pick_up_object"), 2);
  EXPECT_THAT(world.warnings(), ElementsAreArray({HasSubstr("effect_missing: holding(rightarm1")}));
}

/// Somebody observes, and says every second until when all is told.
void ObserveEverySecond(double until, double delay, ScriptedWorld* world) {
  world->At(0.0, [](ScriptedWorld* w) { w->ObserveUntilNow(0.0); });
  for (double t = 1.0; t < until; t += 1.0) {
    world->At(t, [delay](ScriptedWorld* w) { w->ObserveUntilNow(delay); });
  }
}

TEST(FailureTest, EffectsThatAreToldLateAreWaitedFor) {
  auto options = For("serve_coffee");
  options.observation_delay = 10.0;  // far beyond effect_timeout
  ScriptedWorld world(options);
  ObserveEverySecond(600.0, 10.0, &world);
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_EQ(world.CountOf("begin pick_up_object"), 1);
  EXPECT_THAT(world.plannings(), SizeIs(1));
  EXPECT_THAT(world.warnings(),
              Contains(HasSubstr("pick_up_object(mug1, rightarm1): word of what is observed is "
                                 "3.0 s late; it is waited for up to 30 s")));
}

TEST(FailureTest, WhatIsMissingIsSoOnceAllWasTold) {
  auto options = For("serve_coffee");
  options.step = [](const base::ActionCall& action, int count) {
    StepScript script;
    script.has_effects = action.name != "pick_up_object" || count > 0;
    return script;
  };
  ScriptedWorld world(options);
  ObserveEverySecond(600.0, 2.5, &world);
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_THAT(world.warnings(), ElementsAreArray({HasSubstr("effect_missing: holding(rightarm1")}));
  const auto ended = world.TimeOf("end pick_up_object"),
             mended = world.TimeOf("warn pick_up_object");
  EXPECT_GT(mended, ended + 3.0);
  EXPECT_LT(mended, ended + 3.0 + 2.5 + 1.0) << "as soon as it is told";
  EXPECT_EQ(world.CountOf("begin pick_up_object"), 2);
}

TEST(FailureTest, AStoppedRobotTriesNoOtherWay) {
  auto options = For("serve_coffee");
  options.step = Failing("pick_up_object", 100, "motors_halted");
  ScriptedWorld world(options);
  const Finish finish = world.Run(TaskOf("serve_coffee"));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kFailed);
  EXPECT_THAT(finish.reason, HasSubstr("motors_halted (twice in a row, and nothing has changed)"));
  EXPECT_EQ(world.CountOf("begin pick_up_object"), 2);
  ExpectSound(world);
}

TEST(FailureTest, ObservationsThatStayAwayAreNotWaitedForForEver) {
  auto options = For("serve_coffee");
  options.step = [](const base::ActionCall& action, int count) {
    StepScript script;
    script.is_observed = action.name != "pick_up_object" || count > 0;
    return script;
  };
  ScriptedWorld world(options);
  ObserveEverySecond(3.0, 0.0, &world);
  world.Run(TaskOf("serve_coffee"));
  EXPECT_THAT(world.warnings(), Contains(HasSubstr("effect_unknown: holding(rightarm1")));
  ExpectSound(world);
}

TEST(FailureTest, AnObjectThatSlipsOffInTransitIsNoticedAndTheDriveIsStopped) {
  auto options = For("carry_object");
  options.imagine = [](const StartImagination&, int) { return Slow(); };
  options.step = [](const base::ActionCall& action, int) {
    StepScript script;
    if (action.name == "move_base_param") script.duration = 30.0;
    return script;
  };
  ScriptedWorld world(options);
  world.When(
      [](const Command& c) {
        const auto* start = std::get_if<StartStep>(&c);
        return start != nullptr && start->action.name == "move_base_param";
      },
      [](ScriptedWorld* w) {
        w->Set({{"on", {"peppermill1", "trayarea1"}}}, {});
        w->Observe(7.0);
      });
  const Finish finish = world.Run(TaskOf("carry_object"));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kNoPlan) << "it lies where no area is";
  EXPECT_EQ(world.CountOf("stop move_base_param"), 1);
  EXPECT_THAT(world.warnings(), Contains(HasSubstr("condition_lost: on(peppermill1, trayarea1)")));
  ExpectSound(world);
}

TEST(FailureTest, AnObjectThatVanishesIsNoticedLongBeforeItIsNeeded) {
  ScriptedWorld world(For("serve_coffee"));
  world.At(7.0, [](ScriptedWorld* w) {
    w->Set({{"on", {"mug1", "placingareaeastrightcounter1"}}}, {});
    w->Observe();
  });
  const Finish finish = world.Run(TaskOf("serve_coffee"));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kNoPlan);
  EXPECT_EQ(world.CountOf("begin pick_up_object"), 0);
  ExpectSound(world);
}

TEST(FailureTest, AGlanceThatSeesNothingChangesNothing) {
  ScriptedWorld world(For("serve_coffee"));
  const base::Atom mug{"on", {"mug1", "placingareaeastrightcounter1"}};
  world.At(7.0, [&](ScriptedWorld* w) { w->Set({mug}, {}), w->Observe(); });
  world.At(7.3, [&](ScriptedWorld* w) { w->Set({}, {mug}), w->Observe(); });
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_THAT(world.warnings(), IsEmpty());
}

TEST(FailureTest, WhatALaterStepRestsOnMayBeToldLate) {
  ScriptedWorld world(For("serve_coffee"));
  const base::Atom mug{"on", {"mug1", "placingareaeastrightcounter1"}};
  world.At(0.0, [](ScriptedWorld* w) { w->ObserveUntilNow(0.0); });
  // Two words about one change, the second far too late, and nobody says that the first is all.
  world.At(7.0, [&](ScriptedWorld* w) { w->Set({mug}, {}), w->Observe(); });
  world.At(12.0, [&](ScriptedWorld* w) { w->Set({}, {mug}), w->Observe(); });
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_THAT(world.plannings(), SizeIs(1));
  EXPECT_THAT(world.warnings(), ElementsAreArray({HasSubstr("word of what is observed is 3.0 s")}));
}

TEST(FailureTest, AnObjectThatIsMovedToAnotherAreaIsFetchedThere) {
  ScriptedWorld world(For("serve_coffee"));
  world.At(7.0, [](ScriptedWorld* w) {
    w->Set({{"on", {"mug1", "placingareaeastrightcounter1"}}}, {{"on", {"mug1", "trayarea1"}}});
    w->Observe();
  });
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_THAT(world.Begun(), Contains("pick_up_from_tray(rightarm1, mug1)"));
}

TEST(FailureTest, ARobotThatIsPushedAwayDrivesThereAgain) {
  ScriptedWorld world(For("serve_coffee"));
  world.When(
      [](const Command& c) {
        const auto* start = std::get_if<StartStep>(&c);
        return start != nullptr && start->action.name == "move_arm_to_side";
      },
      [](ScriptedWorld* w) {
        w->Set({{"robotat", {"premanipulationareaeastcounter1"}}},
               {{"robotat", {"floorareatamsrestaurant1"}}});
        w->Observe(0.5);
      });
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_EQ(world.CountOf("begin move_base(premanipulationareaeastcounter1)"), 2);
}

TEST(FailureTest, AfterTooManyRepairsItIsGivenUp) {
  auto options = For("serve_coffee");
  options.monitor.max_replans = 3;
  int turn = 0;
  options.step = [&turn](const base::ActionCall& action, int) {
    StepScript script;
    if (action.name == "move_torso") {
      script.result = StepFinished::Result::kFailed;
      script.reason = "stuck_" + std::to_string(++turn);  // never the same twice
    }
    return script;
  };
  ScriptedWorld world(options);
  const Finish finish = world.Run(TaskOf("serve_coffee"));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kFailed);
  EXPECT_THAT(finish.reason, HasSubstr("gave up after 3 repairs"));
  ExpectSound(world);
}

// ---------------------------------------------------------------------------------- the planner

TEST(PlannerTest, ADeadPlannerIsWaitedForAndThenTheTaskFails) {
  auto options = For("serve_coffee");
  options.step = Failing("pick_up_object", 1, "grasp_failed");
  options.planner = [](int count) -> std::optional<PlanArrived> {
    if (count == 0) return std::nullopt;
    PlanArrived gone;
    gone.outcome = PlanArrived::Outcome::kUnavailable;
    gone.why = "planner: no server";
    return gone;
  };
  ScriptedWorld world(options);
  const Finish finish = world.Run(TaskOf("serve_coffee"));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kFailed);
  EXPECT_THAT(finish.reason, HasSubstr("no planner for 30 s: planner: no server"));
  ExpectSound(world);
}

TEST(PlannerTest, APlannerThatComesBackGoesOn) {
  auto options = For("serve_coffee");
  options.planner = [](int count) -> std::optional<PlanArrived> {
    if (count > 3) return std::nullopt;
    PlanArrived gone;
    gone.outcome = PlanArrived::Outcome::kUnavailable;
    return gone;
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee");
}

TEST(PlannerTest, ASlowPlannerIsAskedOnceMore) {
  for (const bool comes : {true, false}) {
    auto options = For("serve_coffee");
    options.planner_delay = comes ? 29.0 : 40.0;
    ScriptedWorld world(options);
    const Finish finish = world.Run(TaskOf("serve_coffee"));
    EXPECT_EQ(finish.outcome, comes ? Finish::Outcome::kSucceeded : Finish::Outcome::kFailed);
    EXPECT_EQ(world.plannings().size(), comes ? 1u : 2u);
    ExpectSound(world);
  }
}

TEST(PlannerTest, APlannerAtItsLimitsHasNotSaidThatThereIsNoPlan) {
  auto options = For("serve_coffee");
  options.planner = [](int) {
    PlanArrived answer;
    answer.outcome = PlanArrived::Outcome::kLimit;
    answer.why = "the time limit of 60 s came first";
    return answer;
  };
  ScriptedWorld world(options);
  const Finish finish = world.Run(TaskOf("serve_coffee"));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kFailed);
  EXPECT_EQ(finish.reason, "the time limit of 60 s came first");
}

TEST(PlannerTest, ARequestThatThePlannerDoesNotUnderstandFails) {
  auto options = For("serve_coffee");
  options.planner = [](int) {
    PlanArrived answer;
    answer.outcome = PlanArrived::Outcome::kInvalid;
    answer.why = "state[3]: no name";
    return answer;
  };
  ScriptedWorld world(options);
  const Finish finish = world.Run(TaskOf("serve_coffee"));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kFailed);
  EXPECT_EQ(finish.reason, "state[3]: no name");
}

// ------------------------------------------------------------------------------------- preempting

TEST(PreemptTest, DuringEveryStepTheRobotStandsInTheEnd) {
  for (double time = 0.0; time < 90.0; time += 2.5) {
    auto options = For("serve_coffee");
    ScriptedWorld world(options);
    world.At(time, [](ScriptedWorld* w) { w->Post(PreemptRequested{}); });
    const Finish finish = world.Run(TaskOf("serve_coffee"));
    if (finish.outcome == Finish::Outcome::kSucceeded) continue;
    EXPECT_EQ(finish.outcome, Finish::Outcome::kPreempted) << time;
    ExpectSound(world);
    EXPECT_FALSE(world.monitor().is_busy());
  }
}

TEST(PreemptTest, PlanningAndImaginingEndToo) {
  auto options = For("carry_object");
  options.planner_delay = 5.0;
  ScriptedWorld early(options);
  early.At(2.0, [](ScriptedWorld* w) { w->Post(PreemptRequested{}); });
  EXPECT_EQ(early.Run(TaskOf("carry_object")).outcome, Finish::Outcome::kPreempted);
  EXPECT_EQ(early.CountOf("cancel planning"), 1);
  ExpectSound(early);
  ScriptedWorld later(options);
  later.At(10.0, [](ScriptedWorld* w) { w->Post(PreemptRequested{}); });
  EXPECT_EQ(later.Run(TaskOf("carry_object")).outcome, Finish::Outcome::kPreempted);
  EXPECT_EQ(later.CountOf("cancel imagination"), 1);
  ExpectSound(later);
}

TEST(PreemptTest, TheNextTaskBeginsAnew) {
  ScriptedWorld world(For("serve_coffee"));
  world.At(30.0, [](ScriptedWorld* w) { w->Post(PreemptRequested{}); });
  EXPECT_EQ(world.Run(TaskOf("serve_coffee")).outcome, Finish::Outcome::kPreempted);
  EXPECT_EQ(world.Run(TaskOf("serve_coffee")).outcome, Finish::Outcome::kSucceeded);
  ExpectSound(world);
}

// ------------------------------------------------------------------------------------ what is told

TEST(RecordTest, PlanTasksAndActivitiesAreTold) {
  ScriptedWorld world(For("serve_coffee"));
  ExpectSuccess(&world, "serve_coffee");
  std::map<std::string, int> begun, ended;
  for (const Record& record : world.records()) {
    if (record.kind == Record::Kind::kBegin) ++begun[record.concept_name];
    if (record.kind == Record::Kind::kEnd) ++ended[record.concept_name];
  }
  EXPECT_EQ(begun["Plan"], 1);
  EXPECT_EQ(ended["Plan"], 1);
  EXPECT_EQ(begun["MoveBaseTask"], 2);
  EXPECT_EQ(begun["MoveBaseActivity"], 2);
  EXPECT_EQ(ended["MoveBaseActivity"], 2);
  const Record& task = world.records().at(2);
  EXPECT_EQ(task.concept_name, "MoveBaseTask");
  EXPECT_EQ(task.general_concept, "PrimitiveTask");
  EXPECT_EQ(task.instance, "plan1Task2");
  EXPECT_THAT(task.texts,
              ElementsAreArray({std::pair<std::string, std::string>{"hasAction", "move_base"},
                                {"hasArgument", "premanipulationareaeastcounter1"}}));
  EXPECT_EQ(task.numbers.at(0), (std::pair<std::string, double>{"hasIndex", 2.0}));
  EXPECT_EQ(task.links.at(0), (std::pair<std::string, std::string>{"hasPlan", "plan1"}));
}

TEST(RecordTest, ImaginedFailuresEndWithTheTask) {
  auto options = For("serve_coffee_imagined");
  options.imagine = SouthFails;
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee_imagined");
  int balance = 0, begun = 0;
  for (const Record& record : world.records()) {
    if (record.concept_name != "ImaginedFailure") continue;
    begun += record.kind == Record::Kind::kBegin;
    balance += record.kind == Record::Kind::kBegin ? 1 : -1;
  }
  EXPECT_EQ(begun, 1);
  EXPECT_EQ(balance, 0);
}

TEST(StatusTest, StepsTellWhenTheyComeAndWhenTheyCame) {
  ScriptedWorld world(For("serve_coffee"));
  std::vector<StepStatus> before;
  world.At(1.0, [&](ScriptedWorld* w) { before = w->monitor().Steps(); });
  ExpectSuccess(&world, "serve_coffee");
  ASSERT_THAT(before, SizeIs(16));
  EXPECT_EQ(before[0].phase, StepPhase::kRunning);
  EXPECT_EQ(before[0].start, (temporal::Bounds{1000.05, 1000.05}));
  EXPECT_EQ(before[1].phase, StepPhase::kWaiting);
  EXPECT_EQ(before[1].start.earliest, 1001.55) << "tucking takes at least 1.5 s";
  EXPECT_EQ(before[2].start.earliest, 1001.55) << "the first drive has no least duration";
  const std::vector<StepStatus> after = world.monitor().Steps();
  ASSERT_THAT(after, SizeIs(16));
  for (const StepStatus& step : after) {
    EXPECT_EQ(step.phase, StepPhase::kDone);
    EXPECT_NEAR(*step.finished - *step.started, 5.0, 1e-9);
    EXPECT_NEAR(step.start.earliest, *step.started, 1e-6);
    EXPECT_EQ(step.plan, 0);
  }
}

TEST(StatusTest, StepsOfEarlierPlansComeFirst) {
  auto options = For("serve_coffee_imagined");
  options.imagine = SouthFails;
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee_imagined");
  const std::vector<StepStatus> steps = world.monitor().Steps();
  EXPECT_TRUE(std::is_sorted(steps.begin(), steps.end(), [](const auto& a, const auto& b) {
    return std::make_pair(a.plan, a.index) < std::make_pair(b.plan, b.index);
  }));
  EXPECT_EQ(steps.back().plan, 1);
  EXPECT_EQ(std::count_if(steps.begin(), steps.end(),
                          [](const auto& step) {
                            return step.phase == StepPhase::kDone && step.action.name != "imagine";
                          }),
            16);
}

TEST(DeterminismTest, TheDateMakesNoDifference) {
  std::vector<std::string> logs[2];
  for (const double start : {1000.0, 1763636490.3}) {
    auto options = For("carry_object");
    options.start = start;
    options.imagine = [](const StartImagination&, int) { return Slow(); };
    ScriptedWorld world(options);
    ExpectSuccess(&world, "carry_object");
    logs[start > 1000.0] = world.log();
  }
  EXPECT_EQ(logs[0], logs[1]);
}

TEST(DeterminismTest, TheSameEventsGiveTheSameCommands) {
  std::vector<std::string> logs[2];
  for (auto& log : logs) {
    auto options = For("carry_object");
    options.imagine = [](const StartImagination& request, int count) {
      return count == 0 ? AllFail(request, "object_toppled") : Slow();
    };
    options.step = Failing("place_on_tray", 1, "grasp_failed");
    ScriptedWorld world(options);
    world.Run(TaskOf("carry_object"));
    log = world.log();
  }
  EXPECT_EQ(logs[0], logs[1]);
}

}  // namespace
}  // namespace hires::execution
