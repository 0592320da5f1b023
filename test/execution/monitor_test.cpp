#include "hires/execution/monitor.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <utility>

#include "hires/base/text.h"
#include "support/whole_tasks.h"

namespace hires::execution::monitor_test {
namespace {

using test_support::AllFail;
using test_support::ExpectSound;
using test_support::ExpectSuccess;
using test_support::Failing;
using test_support::For;
using test_support::Golden;
using test_support::LogOf;
using test_support::ScriptedWorld;
using test_support::Slow;
using test_support::SouthFails;
using test_support::StepScript;
using test_support::TaskOf;
using ::testing::AllOf;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::SizeIs;

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
    options.step = Failing("move_torso", 1, base::FailureCode::kStuck);
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

/// Two mugs of coffee, of which nobody knows how warm they are.
ScriptedWorld::Options MugsOfUnknownTemperature() {
  auto options = For("serve_hot_coffee");
  auto& facts = options.facts;
  facts.erase(
      std::remove_if(facts.begin(), facts.end(),
                     [](const base::Atom& atom) { return atom.predicate == "hastemperature"; }),
      facts.end());
  return options;
}

bool IsStartOf(const Command& command, const std::string& action) {
  const auto* start = std::get_if<StartStep>(&command);
  return start != nullptr && start->action.name == action;
}

TEST(MonitorTest, WhatIsMeasuredWhileItIsMeasuredMendsThePlan) {
  ScriptedWorld world(MugsOfUnknownTemperature());
  world.When([](const Command& c) { return IsStartOf(c, "measure_temperature"); },
             [](ScriptedWorld* w) {
               for (const auto& [mug, degrees] : {std::pair("mug1", "21"), {"mug2", "62.5"}})
                 w->Set({}, {{"hastemperature", {mug, degrees}}, {"temperatureknown", {mug}}});
               w->Observe(1.0);
             });
  ExpectSuccess(&world, "serve_hot_coffee");
  EXPECT_EQ(world.CountOf("begin measure_temperature"), 1) << LogOf(world);
  EXPECT_TRUE(world.Holds({"on", {"mug2", "placingareawestrighttable1"}})) << LogOf(world);
  EXPECT_THAT(world.warnings(), SizeIs(1));
}

TEST(MonitorTest, WhatIsKnownOnTheWayIsNotMeasured) {
  ScriptedWorld world(MugsOfUnknownTemperature());
  world.When([](const Command& c) { return IsStartOf(c, "move_base"); },
             [](ScriptedWorld* w) {
               w->Set({}, {{"hastemperature", {"mug2", "50"}}, {"temperatureknown", {"mug2"}}});
               w->Observe(1.0);
             });
  ExpectSuccess(&world, "serve_hot_coffee");
  EXPECT_EQ(world.CountOf("begin measure_temperature"), 0) << LogOf(world);
  EXPECT_TRUE(world.Holds({"on", {"mug2", "placingareawestrighttable1"}})) << LogOf(world);
}

/// Here the world makes true what the planner only guessed.
TEST(MonitorTest, ABookkeepingStepBetweenOthersIsDoneInItsTurn) {
  ScriptedWorld world(MugsOfUnknownTemperature());
  ExpectSuccess(&world, "serve_hot_coffee");
  EXPECT_THAT(world.warnings(), IsEmpty());
  EXPECT_EQ(world.plannings().size(), 1u);
}

TEST(MonitorTest, WhereNothingIsMeasuredTheTaskFailsAndSaysWhat) {
  auto options = MugsOfUnknownTemperature();
  options.step = [](const base::ActionCall& action, int) {
    StepScript script;
    script.has_effects = action.name != "measure_temperature";
    return script;
  };
  ScriptedWorld world(options);
  const Finish finish = world.Run(TaskOf("serve_hot_coffee"));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kFailed);
  EXPECT_THAT(finish.reason, HasSubstr("temperatureknown"));
  EXPECT_EQ(world.CountOf("begin pick_up_object"), 0) << LogOf(world);
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

// ---------------------------------------------------------------------------------- the planner

TEST(PlannerTest, ADeadPlannerIsWaitedForAndThenTheTaskFails) {
  auto options = For("serve_coffee");
  options.step = Failing("pick_up_object", 1, base::FailureCode::kGraspFailed);
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

TEST(RecordTest, AFailureIsItsWordWhomItIsAboutAndWords) {
  auto options = For("serve_coffee");
  options.step = Failing("pick_up_object", 1,
                         {base::FailureCode::kNoPath, {"r_hand", "book1"}, "r_hand touches book1"});
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee");
  using Text = std::pair<std::string, std::string>;
  int found = 0;
  for (const Record& record : world.records()) {
    const bool is_end = record.kind == Record::Kind::kEnd &&
                        record.concept_name == "PickUpObjectActivity" && record.texts.size() > 4;
    if (record.concept_name != "ActivityFailure" && !is_end) continue;
    ++found;
    EXPECT_THAT(
        record.texts,
        IsSupersetOf({Text{"hasFailure", "no_path"}, Text{"hasSubject", "r_hand"},
                      Text{"hasSubject", "book1"}, Text{"hasDetail", "r_hand touches book1"}}));
  }
  EXPECT_EQ(found, 2) << "the activity that failed, and the failure";
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
      return count == 0 ? AllFail(request, base::FailureCode::kObjectToppled) : Slow();
    };
    options.step = Failing("place_on_tray", 1, base::FailureCode::kGraspFailed);
    ScriptedWorld world(options);
    world.Run(TaskOf("carry_object"));
    log = world.log();
  }
  EXPECT_EQ(logs[0], logs[1]);
}

}  // namespace
}  // namespace hires::execution::monitor_test
