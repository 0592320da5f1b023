#include <gmock/gmock.h>

#include <algorithm>

#include "hires/execution/monitor.h"
#include "support/whole_tasks.h"

// Things go wrong.

namespace hires::execution::monitor_failure_test {
namespace {

using test_support::ExpectSound;
using test_support::ExpectSuccess;
using test_support::Failing;
using test_support::For;
using test_support::ScriptedWorld;
using test_support::Slow;
using test_support::StepScript;
using test_support::TaskOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(FailureTest, AnOccupiedAreaSendsTheRobotToTheOtherSide) {
  auto options = For("serve_coffee");
  options.step = [](const base::ActionCall& action, int) {
    StepScript script;
    if (action.name == "place_object" && action.arguments[2] == "placingareawestrighttable1") {
      script.result = StepFinished::Result::kFailed;
      script.failure = {base::FailureCode::kAreaOccupied, {"book1"}};
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
    script.failure = {base::FailureCode::kAreaOccupied, {is_south ? "book1" : "vase1"}};
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
      script.failure = {base::FailureCode::kNoPath,
                        {"r_forearm_link", "peppermill1"},
                        "r_forearm_link touches peppermill1"};
    }
    return script;
  };
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee");
  EXPECT_EQ(world.CountOf("begin pick_up_object"), 3) << "right, right, left";
}

TEST(FailureTest, WhatFailsInEveryWayEndsTheTask) {
  auto options = For("serve_coffee");
  options.step = Failing("pick_up_object", 100, base::FailureCode::kGraspFailed);
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
      script.failure = {base::FailureCode::kUnavailable, {}, "nobody serves execute_action"};
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

TEST(FailureTest, WordsForPeopleDoNotMakeAFailureAnother) {
  auto options = For("serve_coffee");
  int turn = 0;
  options.step = [&turn](const base::ActionCall& action, int) {
    StepScript script;
    if (action.name == "pick_up_object") {
      script.result = StepFinished::Result::kFailed;
      script.failure = {base::FailureCode::kStaleScan, {}, std::to_string(++turn) + " s"};
    }
    return script;
  };
  ScriptedWorld world(options);
  const Finish finish = world.Run(TaskOf("serve_coffee"));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kFailed);
  EXPECT_EQ(finish.failure, base::FailureCode::kStaleScan);
  EXPECT_THAT(finish.reason,
              HasSubstr("stale_scan: 2 s (twice in a row, and nothing has changed)"));
  EXPECT_EQ(world.CountOf("begin pick_up_object"), 2);
}

/// What the table says decides, for every code there is.
TEST(FailureTest, AWayThatNeedsAnotherIsTakenOnceOthersTwice) {
  for (const base::FailureInfo& info : base::AllFailures()) {
    auto options = For("serve_coffee");
    options.step = [&](const base::ActionCall& action, int) {
      StepScript script;
      if (action.name == "pick_up_object" && action.arguments[1] == "rightarm1") {
        script.result = StepFinished::Result::kFailed;
        script.failure = info.code;
      }
      return script;
    };
    ScriptedWorld world(options);
    const Finish finish = world.Run(TaskOf("serve_coffee"));
    const bool is_of_action = info.scope == base::FailureScope::kAction;
    EXPECT_EQ(finish.outcome == Finish::Outcome::kSucceeded, is_of_action) << info.word;
    const int tries = is_of_action && !info.may_pass ? 1 : 2;
    EXPECT_EQ(world.CountOf("begin pick_up_object"), tries + (is_of_action ? 1 : 0)) << info.word;
    EXPECT_TRUE(is_of_action || finish.failure == info.code) << info.word;
  }
}

TEST(FailureTest, AStepThatFailedSaysAsWhat) {
  auto options = For("serve_coffee");
  options.step = Failing("pick_up_object", 1, {base::FailureCode::kHandFull, {"mug2"}});
  ScriptedWorld world(options);
  ExpectSuccess(&world, "serve_coffee");
  const auto steps = world.monitor().Steps();
  const auto failed = std::find_if(steps.begin(), steps.end(), [](const StepStatus& step) {
    return step.phase == StepPhase::kFailed;
  });
  ASSERT_NE(failed, steps.end());
  EXPECT_EQ(failed->failure, base::Failure(base::FailureCode::kHandFull, {"mug2"}));
  EXPECT_EQ(failed->note, "hand_full: mug2");
}

TEST(FailureTest, AFailureThatPassesIsTriedAgain) {
  auto options = For("serve_coffee");
  options.step = Failing("pick_up_object", 1, base::FailureCode::kGraspFailed);
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
  options.step = Failing("pick_up_object", 100, base::FailureCode::kMotorsHalted);
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

/// Why the step of this name was stopped or cannot begin.
base::Failure FailureOf(const std::string& action, ScriptedWorld* world) {
  for (const StepStatus& step : world->monitor().Steps()) {
    if (step.action.name == action && step.failure) return step.failure;
  }
  return {};
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
  const base::Failure loss = FailureOf("move_base_param", &world);
  EXPECT_EQ(loss.code, base::FailureCode::kConditionLost);
  EXPECT_THAT(loss.subjects, ElementsAre("peppermill1", "trayarea1"));
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
  EXPECT_EQ(FailureOf("pick_up_object", &world).code, base::FailureCode::kConditionLost);
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
      script.failure = {base::FailureCode::kStuck,
                        {"turn" + std::to_string(++turn)}};  // never the same
    }
    return script;
  };
  ScriptedWorld world(options);
  const Finish finish = world.Run(TaskOf("serve_coffee"));
  EXPECT_EQ(finish.outcome, Finish::Outcome::kFailed);
  EXPECT_THAT(finish.reason, HasSubstr("gave up after 3 repairs"));
  ExpectSound(world);
}

}  // namespace
}  // namespace hires::execution::monitor_failure_test
