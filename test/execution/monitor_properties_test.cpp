#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "support/property.h"
#include "support/rounds.h"
#include "support/scripted_world.h"

// Everything at any moment: steps that fail, are slow, never end or are not seen; objects that
// vanish or come back; answers that are late, repeated or about something else; a planner that
// comes and goes; preempts. Whatever happens, a task ends, the robot stands at its end, and no step
// is begun whose preconditions are not observed or whose resources are taken.

namespace hires::execution::monitor_properties_test {
namespace {

using test_support::AllFail;
using test_support::FactsOf;
using test_support::Ranked;
using test_support::ScriptedWorld;
using test_support::StepScript;
using test_support::TaskOf;

constexpr const char* kProblems[] = {"serve_coffee", "serve_coffee_imagined", "carry_object",
                                     "clear_table"};
const std::vector<std::string> kAreas = {"placingareaeastrightcounter1",
                                         "placingareawestlefttable1", "placingareawestrighttable1",
                                         "trayarea1"};
const std::vector<std::string> kPlaces = {
    "floorareatamsrestaurant1", "premanipulationareaeastcounter1", "manipulationareasouthtable1"};
const std::vector<base::Failure> kFailures = {
    base::FailureCode::kUnreachable,
    {base::FailureCode::kNoPath, {"r_forearm_link", "table1"}},
    {base::FailureCode::kAreaOccupied, {"book1"}},
    base::FailureCode::kGraspFailed,
    base::FailureCode::kTimedOut};
const std::vector<std::string> kObjects = {"mug1", "mug2", "peppermill1"};

template <typename T>
const T& AnyOf(const std::vector<T>& list, base::Rng* rng) {
  return list[static_cast<std::size_t>(rng->Index(static_cast<int>(list.size())))];
}

/// How bad the world is: probability of something odd.
struct Trouble {
  double in_steps, in_world, in_answers, in_planner;
};

StepScript AnyStep(const Trouble& trouble, base::Rng* rng) {
  StepScript script;
  script.duration = rng->Uniform(0.0, 12.0);
  if (!rng->Bernoulli(trouble.in_steps)) return script;
  switch (rng->Index(6)) {
    case 0:
      script.result = StepFinished::Result::kFailed;
      script.failure = AnyOf(kFailures, rng);
      break;
    case 1:
      script.result = StepFinished::Result::kUnavailable;
      break;
    case 2:
      script.has_effects = false;
      break;
    case 3:
      script.ends = false;
      break;
    case 4:
      script.is_observed = false;
      break;
    default:
      script.ends = script.obeys = false;
  }
  return script;
}

std::optional<ImagineAnswered> AnyAnswer(const StartImagination& request, const Trouble& trouble,
                                         base::Rng* rng) {
  const std::vector<base::ActionCall> calls = base::Combinations(request.action);
  ImagineAnswered best =
      Ranked(calls[static_cast<std::size_t>(rng->Index(static_cast<int>(calls.size())))], 15.0);
  best.depends_on = {AnyOf(kObjects, rng)};
  if (!rng->Bernoulli(trouble.in_answers)) return best;
  switch (rng->Index(6)) {
    case 0:
      return std::nullopt;
    case 1:
      return AllFail(request, base::FailureCode::kObjectToppled);
    case 2:
      best.recommended = {"dance", {"slowly"}};
      return best;
    case 3:
      best.duration_low = best.duration_high = 0.1;
      return best;
    case 4:
      best.outcome = ImagineAnswered::Outcome::kInvalid;
      return best;
    case 5:
      best.outcome = ImagineAnswered::Outcome::kUndecided;
      return best;
    default:
      best.outcome = rng->Bernoulli(0.5) ? ImagineAnswered::Outcome::kNoWorker
                                         : ImagineAnswered::Outcome::kNothingFinished;
      return best;
  }
}

std::optional<PlanArrived> AnyPlan(const Trouble& trouble, base::Rng* rng) {
  if (!rng->Bernoulli(trouble.in_planner)) return std::nullopt;
  PlanArrived answer;
  answer.outcome =
      rng->Bernoulli(0.7) ? PlanArrived::Outcome::kUnavailable : PlanArrived::Outcome::kLimit;
  answer.why = "scripted";
  return answer;
}

/// Somebody else is at work.
void ChangeWorld(ScriptedWorld* world, base::Rng* rng) {
  const std::string object = AnyOf(kObjects, rng);
  switch (rng->Index(3)) {
    case 0:  // an object goes, and perhaps comes elsewhere
      for (const std::string& area : kAreas) world->Set({{"on", {object, area}}}, {});
      if (rng->Bernoulli(0.5)) world->Set({}, {{"on", {object, AnyOf(kAreas, rng)}}});
      break;
    case 1:  // it slips out of the hand
      for (const char* arm : {"leftarm1", "rightarm1"}) {
        if (!world->Holds({"holding", {arm, object}})) continue;
        world->Set({{"holding", {arm, object}}}, {{"holding", {arm, "nothing"}}});
      }
      break;
    default:  // the robot is pushed
      world->ReplaceAll("robotat", {"robotat", {AnyOf(kPlaces, rng)}});
  }
  world->Observe(rng->Uniform(0.0, 1.0));
}

/// An answer to nothing that was asked, or to what is over.
Event AnyStrayEvent(base::Rng* rng) {
  const int id = rng->Index(30);
  switch (rng->Index(4)) {
    case 0:
      return StepFinished{id + 100, StepFinished::Result::kSucceeded, {}};
    case 1:
      return PlanArrived{id + 1000, PlanArrived::Outcome::kFound, {}, ""};
    case 2: {
      ImagineAnswered answer = Ranked({"move_base_param", {"x", "slow"}}, 3.0);
      answer.request = id + 1000;
      return answer;
    }
    default:
      return GeometryChanged{{AnyOf(kObjects, rng)}};
  }
}

struct Played {
  Finish finish;
  std::vector<std::string> log, violations;
};

Played Play(std::uint64_t seed) {
  const base::Rng root(seed);
  base::Rng rng = root.Fork(0), steps = root.Fork(1), answers = root.Fork(2), plans = root.Fork(3);
  const Trouble trouble{rng.Uniform(0.0, 0.4), rng.Uniform(0.0, 6.0), rng.Uniform(0.0, 1.0),
                        rng.Bernoulli(0.5) ? 0.0 : rng.Uniform(0.0, 0.7)};
  const std::string problem = kProblems[rng.Index(4)];
  ScriptedWorld::Options options;
  options.facts = FactsOf(problem);
  options.plans = static_cast<ScriptedWorld::Options::PlanForm>(rng.Index(3));
  options.planner_delay = rng.Uniform(0.0, 8.0);
  options.imagine_delay = rng.Uniform(0.0, 60.0);
  options.observation_delay = rng.Uniform(0.0, 1.0);
  options.monitor.imagination = static_cast<MonitorParams::ImaginePolicy>(rng.Index(3));
  options.step = [&](const base::ActionCall&, int) { return AnyStep(trouble, &steps); };
  options.imagine = [&](const StartImagination& request, int) {
    return AnyAnswer(request, trouble, &answers);
  };
  options.planner = [&](int) { return AnyPlan(trouble, &plans); };
  ScriptedWorld world(options);
  for (int i = 0; i < static_cast<int>(trouble.in_world); ++i) {
    world.At(rng.Uniform(0.0, 200.0), [&](ScriptedWorld* w) { ChangeWorld(w, &rng); });
    world.At(rng.Uniform(0.0, 200.0), [&](ScriptedWorld* w) { w->Post(AnyStrayEvent(&rng)); });
    world.At(rng.Uniform(0.0, 200.0), [&](ScriptedWorld* w) { w->Repeat(); });
  }
  if (rng.Bernoulli(0.3)) {
    world.At(rng.Uniform(0.0, 150.0), [](ScriptedWorld* w) { w->Post(PreemptRequested{}); });
  }
  const Finish finish = world.Run(TaskOf(problem));
  return {finish, world.log(), world.violations()};
}

constexpr test_support::PropertyCases kPropertyCases{};

HIRES_PROPERTY(MonitorPropertyTest, WhateverHappensItEndsAndTheRobotStands, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  const Played played = Play(seed);
  if (!played.violations.empty()) {
    RC_LOG() << base::Join(played.violations, "\n") << "\n--\n" << base::Join(played.log, "\n");
  }
  RC_ASSERT(played.violations.empty());
  RC_CLASSIFY(played.finish.outcome == Finish::Outcome::kSucceeded, "succeeded");
  RC_CLASSIFY(played.finish.outcome == Finish::Outcome::kFailed, "failed");
  RC_CLASSIFY(played.finish.outcome == Finish::Outcome::kNoPlan, "no plan");
  RC_CLASSIFY(played.finish.outcome == Finish::Outcome::kPreempted, "preempted");
}

HIRES_PROPERTY(MonitorPropertyTest, TheSameEventsGiveTheSameCommands, ()) {
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  RC_ASSERT(Play(seed).log == Play(seed).log);
}

TEST(MonitorPropertyTest, ManyWorldsHoldNoSurprise) {
  const auto num_worlds = static_cast<std::uint64_t>(test_support::Rounds(500));
  for (std::uint64_t seed = 0; seed < num_worlds; ++seed) {
    const Played played = Play(seed);
    EXPECT_TRUE(played.violations.empty()) << "seed " << seed << "\n"
                                           << base::Join(played.violations, "\n") << "\n--\n"
                                           << base::Join(played.log, "\n");
    if (!played.violations.empty()) return;
  }
}

}  // namespace
}  // namespace hires::execution::monitor_properties_test
