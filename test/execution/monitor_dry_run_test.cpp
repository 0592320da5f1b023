#include <gmock/gmock.h>

#include <algorithm>

#include "hires/base/text.h"
#include "hires/execution/monitor.h"
#include "support/scripted_world.h"

// Tasks that are planned and imagined and not begun, in a scripted world.

namespace hires::execution::monitor_dry_run_test {
namespace {

using test_support::AllFail;
using test_support::FactsOf;
using test_support::Ranked;
using test_support::ScriptedWorld;
using test_support::TaskOf;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

ScriptedWorld::Options DryRun(const std::string& problem) {
  ScriptedWorld::Options options;
  options.facts = FactsOf(problem);
  options.monitor.dry_run = true;
  return options;
}

void ExpectNothingBegun(const ScriptedWorld& world, const Finish& finish) {
  EXPECT_EQ(finish.outcome, Finish::Outcome::kDryRun) << finish.reason;
  EXPECT_THAT(finish.reason, HasSubstr("nothing was begun"));
  EXPECT_THAT(world.Begun(), IsEmpty());
  EXPECT_THAT(world.violations(), IsEmpty());
}

/// The step that imagination was asked about, at the end.
const StepStatus* DriveOf(const std::vector<StepStatus>& steps) {
  const StepStatus* drive = nullptr;
  for (const StepStatus& step : steps) {
    const bool is_drive = step.action.name == "move_base_param";
    if (is_drive && step.phase == StepPhase::kWaiting) drive = &step;
  }
  return drive;
}

const StepStatus* FirstDriveOf(const std::vector<StepStatus>& steps) {
  const auto drive = std::find_if(steps.begin(), steps.end(), [](const StepStatus& step) {
    return step.action.name == "move_base" && step.phase == StepPhase::kWaiting;
  });
  return drive == steps.end() ? nullptr : &*drive;
}

/// It can only be about how long it lasts.
bool IsOneAlternative(const StartImagination& request) {
  return base::Combinations(request.action).size() == 1;
}

std::vector<StartImagination> AskedHow(const ScriptedWorld& world) {
  std::vector<StartImagination> asked = world.imaginations();
  asked.erase(std::remove_if(asked.begin(), asked.end(), IsOneAlternative), asked.end());
  return asked;
}

std::vector<std::string> TextsOf(const std::vector<base::Atom>& atoms) {
  std::vector<std::string> texts;
  for (const base::Atom& atom : atoms) texts.push_back(base::ToLower(ToString(atom)));
  return texts;
}

ImagineAnswered Slow(const std::string& area) {
  return Ranked({"move_base_param", {area, "slow"}}, 24.0);
}

/// Slow is recommended for the drive to table1.
ScriptedWorld::Options SlowDryRun() {
  auto options = DryRun("carry_object");
  options.imagine = [](const StartImagination&, int) {
    return Slow("premanipulationareanorthtable1");
  };
  return options;
}

TEST(DryRunTest, ThePlanEndsWithTheRecommendedAlternativeAndNothingIsBegun) {
  ScriptedWorld world(SlowDryRun());
  ExpectNothingBegun(world, world.Run(TaskOf("carry_object")));
  EXPECT_NEAR(world.now(), 1040.05, 1e-6)
      << "as soon as the answers are there, after 20 s each: how to drive, how long the rest lasts";
  const auto steps = world.monitor().Steps();
  const StepStatus* drive = DriveOf(steps);
  ASSERT_NE(drive, nullptr);
  EXPECT_THAT(drive->action.arguments, ElementsAre("premanipulationareanorthtable1", "slow"));
  EXPECT_THAT(drive->note, HasSubstr("imagined"));
  EXPECT_THAT(world.warnings(), IsEmpty());
}

TEST(DryRunTest, StepsBeginAndEndWhenTheyAreExpectedTo) {
  ScriptedWorld world(SlowDryRun());
  ExpectNothingBegun(world, world.Run(TaskOf("carry_object")));
  const auto steps = world.monitor().Steps();
  const StepStatus* drive = DriveOf(steps);
  ASSERT_NE(drive, nullptr);
  EXPECT_NEAR(drive->expected_finish - drive->expected_start, 24.0, 1e-6) << "as imagined";
  EXPECT_GT(drive->expected_start, drive->start.earliest + 30.0) << "before it more than the least";
  const auto grasp = std::find_if(steps.begin(), steps.end(), [](const StepStatus& step) {
    return step.action.name == "pick_up_object";
  });
  ASSERT_NE(grasp, steps.end());
  EXPECT_NEAR(grasp->expected_finish - grasp->expected_start, 14.1, 1e-6) << "restaurant.yaml";
}

TEST(DryRunTest, AnswersHaveAllTheTimeTheyNeed) {
  auto options = DryRun("carry_object");
  options.imagine_delay = 250.0;  // long after the drive would have begun
  const double max_wait = options.monitor.max_wait;
  options.imagine = [max_wait](const StartImagination& request, int) {
    if (!IsOneAlternative(request)) EXPECT_NEAR(request.deadline, 1000.05 + max_wait, 1.0);
    return Slow("premanipulationareanorthtable1");
  };
  ScriptedWorld world(options);
  ExpectNothingBegun(world, world.Run(TaskOf("carry_object")));
  EXPECT_THAT(DriveOf(world.monitor().Steps())->note, HasSubstr("imagined"));
}

TEST(DryRunTest, APlanThatIsImaginedToFailIsMendedAsInEarnest) {
  auto options = DryRun("carry_object");
  options.imagine = [](const StartImagination& request, int) {
    const std::string area = request.action.alternatives[0][0];
    if (area == "premanipulationareanorthtable1")
      return AllFail(request, base::FailureCode::kObjectToppled);
    return Slow(area);
  };
  ScriptedWorld world(options);
  ExpectNothingBegun(world, world.Run(TaskOf("carry_object")));
  EXPECT_THAT(AskedHow(world), SizeIs(2));
  EXPECT_THAT(DriveOf(world.monitor().Steps())->action.arguments,
              ElementsAre("premanipulationareasouthtable1", "slow"));
}

TEST(DryRunTest, WhereEverythingIsImaginedToFailThereIsNoPlan) {
  auto options = DryRun("carry_object");
  options.imagine = [](const StartImagination& request, int) {
    return AllFail(request, base::FailureCode::kObjectToppled);
  };
  ScriptedWorld world(options);
  EXPECT_EQ(world.Run(TaskOf("carry_object")).outcome, Finish::Outcome::kNoPlan);
  EXPECT_THAT(world.Begun(), IsEmpty());
}

/// It names each of the steps and what is to be done, and does not say that all was imagined.
void ExpectUnimagined(const ScriptedWorld& world, const Finish& finish,
                      const std::vector<std::string>& steps) {
  EXPECT_EQ(finish.outcome, Finish::Outcome::kFailed);
  EXPECT_EQ(finish.failure, base::FailureCode::kUnavailable);
  EXPECT_THAT(finish.reason, AllOf(HasSubstr("not imagined"), HasSubstr("imagination.launch"),
                                   Not(HasSubstr("planned and imagined"))));
  for (const std::string& step : steps) EXPECT_THAT(finish.reason, HasSubstr(step + "("));
  EXPECT_THAT(world.Begun(), IsEmpty());
}

std::function<std::optional<ImagineAnswered>(const StartImagination&, int)> Nothing(
    ImagineAnswered::Outcome outcome) {
  return [outcome](const StartImagination&, int) {
    ImagineAnswered answer;
    answer.outcome = outcome;
    return answer;
  };
}

TEST(DryRunTest, WhatNobodyImaginesIsNoDryRunThatWentWell) {
  using Outcome = ImagineAnswered::Outcome;
  for (const Outcome outcome :
       {Outcome::kNoWorker, Outcome::kUnavailable, Outcome::kNothingFinished}) {
    auto options = DryRun("carry_object");
    options.imagine = Nothing(outcome);
    ScriptedWorld world(options);
    ExpectUnimagined(world, world.Run(TaskOf("carry_object")), {"move_base_param", "move_base"});
    auto durations_alone = DryRun("serve_coffee");
    durations_alone.imagine = Nothing(outcome);
    ScriptedWorld served(durations_alone);
    ExpectUnimagined(served, served.Run(TaskOf("serve_coffee")), {"move_base"});
  }
}

TEST(DryRunTest, WhatIsUndecidedWasImagined) {
  auto options = DryRun("carry_object");
  options.imagine = Nothing(ImagineAnswered::Outcome::kUndecided);
  ScriptedWorld world(options);
  ExpectNothingBegun(world, world.Run(TaskOf("carry_object")));
}

TEST(DryRunTest, NobodyWhoImaginesIsSaidAtOnceWithTheDefault) {
  auto options = DryRun("carry_object");
  options.imagine = Nothing(ImagineAnswered::Outcome::kNoWorker);
  ScriptedWorld world(options);
  ExpectUnimagined(world, world.Run(TaskOf("carry_object")), {"move_base_param", "move_base"});
  EXPECT_THAT(AskedHow(world), SizeIs(1));
  EXPECT_THAT(FirstDriveOf(world.monitor().Steps())->note,
              HasSubstr("how long it lasts is not known: no worker is there to imagine it"));
  EXPECT_THAT(DriveOf(world.monitor().Steps())->note,
              HasSubstr("no worker is there to imagine it"));
  EXPECT_THAT(world.warnings(), ElementsAre(HasSubstr("without imagination")));
}

TEST(DryRunTest, AStepThatMakesNoSenseHasFailed) {
  auto options = DryRun("carry_object");
  options.imagine = [](const StartImagination& request, int) {
    ImagineAnswered answer;
    answer.outcome = ImagineAnswered::Outcome::kInvalid;
    answer.why = IsOneAlternative(request) ? "never mind" : "area 'nowhere' is unknown";
    return answer;
  };
  ScriptedWorld world(options);
  const Finish finish = world.Run(TaskOf("carry_object"));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kFailed);
  EXPECT_EQ(finish.failure, base::FailureCode::kInvalidAction);
  EXPECT_THAT(finish.reason, AllOf(HasSubstr("move_base_param("), HasSubstr("area 'nowhere'"),
                                   Not(HasSubstr("never mind"))))
      << "how long a step lasts is not asked in earnest";
  EXPECT_THAT(world.Begun(), IsEmpty());
}

TEST(DryRunTest, StepsOfTheRobotAreToldApartFromThoseThatImagine) {
  ScriptedWorld world(SlowDryRun());
  ExpectNothingBegun(world, world.Run(TaskOf("carry_object")));
  for (const StepStatus& step : world.monitor().Steps()) {
    if (step.action.name == "imagine") EXPECT_FALSE(step.is_of_robot);
    if (step.action.name.rfind("move_", 0) == 0) EXPECT_TRUE(step.is_of_robot);
  }
}

TEST(DryRunTest, SilenceEndsAtTheLongestWait) {
  auto options = DryRun("carry_object");
  options.imagine = [](const StartImagination&, int) { return std::nullopt; };
  ScriptedWorld world(options);
  ExpectUnimagined(world, world.Run(TaskOf("carry_object")), {"move_base_param", "move_base"});
  EXPECT_NEAR(world.now(), 1000.05 + 2.0 * options.monitor.max_wait, 1.0)
      << "how to drive, how long the rest lasts";
  EXPECT_THAT(FirstDriveOf(world.monitor().Steps())->note,
              HasSubstr("how long it lasts is not known: no answer came in time"));
}

TEST(DryRunTest, WithoutImaginationThePlanAloneIsShown) {
  auto options = DryRun("carry_object");
  options.monitor.imagination = MonitorParams::ImaginePolicy::kOff;
  ScriptedWorld world(options);
  const Finish finish = world.Run(TaskOf("carry_object"));
  ExpectNothingBegun(world, finish);
  EXPECT_EQ(finish.reason, "planned; nothing was begun");
  EXPECT_THAT(world.imaginations(), IsEmpty());
  EXPECT_EQ(DriveOf(world.monitor().Steps())->action.arguments.back(), "slow");
  EXPECT_THAT(FirstDriveOf(world.monitor().Steps())->note,
              HasSubstr("how long it lasts is not known: imagination is off"));
}

TEST(DryRunTest, ADriveFromAnywhereLastsAsLongAsImagined) {
  auto options = SlowDryRun();
  options.imagine = [](const StartImagination& request, int) {
    if (IsOneAlternative(request)) return Ranked(base::Combinations(request.action)[0], 12.5);
    return Slow("premanipulationareanorthtable1");
  };
  ScriptedWorld world(options);
  ExpectNothingBegun(world, world.Run(TaskOf("carry_object")));
  ASSERT_THAT(world.imaginations(), SizeIs(2)) << "what restaurant.yaml knows is not asked";
  const StartImagination& asked = world.imaginations()[1];
  EXPECT_EQ(ToString(asked.action), "move_base(premanipulationareaeastcounter1)");
  EXPECT_EQ(asked.deadline, std::numeric_limits<double>::infinity());
  EXPECT_THAT(TextsOf(asked.state), Contains("hasarmposture(rightarm1, armtuckedposture)"))
      << "as it will be when the drive begins";
  const auto steps = world.monitor().Steps();
  const StepStatus* first = FirstDriveOf(steps);
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(asked.step, first->index);
  EXPECT_NEAR(first->expected_finish - first->expected_start, 12.5, 1e-6);
  EXPECT_EQ(first->note, "lasts 12.5 s as imagined");
  EXPECT_NEAR(DriveOf(steps)->expected_finish - DriveOf(steps)->expected_start, 24.0, 1e-6);
}

TEST(DryRunTest, ADriveThatIsImaginedToFailChangesNoPlan) {
  auto options = SlowDryRun();
  options.imagine = [](const StartImagination& request, int) {
    if (IsOneAlternative(request)) return AllFail(request, base::FailureCode::kNoPath);
    return Slow("premanipulationareanorthtable1");
  };
  ScriptedWorld world(options);
  ExpectNothingBegun(world, world.Run(TaskOf("carry_object")));
  EXPECT_THAT(world.plannings(), SizeIs(1)) << "in earnest it would not be imagined";
  const auto steps = world.monitor().Steps();
  EXPECT_EQ(FirstDriveOf(steps)->note,
            "how long it lasts is not known: no alternative is expected to succeed: "
            "every alternative fails");
}

TEST(DryRunTest, OfAPlanWithoutImaginationDurationsAloneAreAsked) {
  auto options = DryRun("serve_coffee");
  options.imagine = [](const StartImagination& request, int) {
    return Ranked(base::Combinations(request.action)[0], 12.5);
  };
  ScriptedWorld world(options);
  ExpectNothingBegun(world, world.Run(TaskOf("serve_coffee")));
  EXPECT_NEAR(world.now(), 1020.05, 1e-6);
  EXPECT_THAT(AskedHow(world), IsEmpty());
  const auto steps = world.monitor().Steps();
  const StepStatus* first = FirstDriveOf(steps);
  ASSERT_NE(first, nullptr);
  EXPECT_NEAR(first->expected_finish - first->expected_start, 12.5, 1e-6);
}

TEST(DryRunTest, InEarnestNoDurationIsAsked) {
  auto options = SlowDryRun();
  options.monitor.dry_run = false;
  ScriptedWorld world(options);
  EXPECT_EQ(world.Run(TaskOf("carry_object")).outcome, Finish::Outcome::kSucceeded);
  for (const StartImagination& request : world.imaginations()) {
    EXPECT_FALSE(IsOneAlternative(request)) << ToString(request.action);
  }
}

TEST(DryRunTest, ItCanBePreempted) {
  auto options = DryRun("carry_object");
  options.imagine = [](const StartImagination&, int) { return std::nullopt; };
  ScriptedWorld world(options);
  world.At(10.0, [](ScriptedWorld* w) { w->Post(PreemptRequested{}); });
  EXPECT_EQ(world.Run(TaskOf("carry_object")).outcome, Finish::Outcome::kPreempted);
  EXPECT_THAT(world.Begun(), IsEmpty());
}

}  // namespace
}  // namespace hires::execution::monitor_dry_run_test
