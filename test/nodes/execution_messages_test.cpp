#include "nodes/execution_monitor/execution_messages.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "hires/base/error.h"
#include "hires/planning/plan_order.h"
#include "hires/planning/planner.h"
#include "hires/planning/reasons.h"
#include "hires/ros/planning/plan_request.h"

namespace hires_ros::execution_messages_test {
namespace {

namespace execution = hires::execution;
namespace planning = hires::planning;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ImagineOutcome = execution::ImagineAnswered::Outcome;

planning::PlanningKnowledge Restaurant() {
  return planning::LoadPlanningKnowledge(
      planning::ReadPlannerConfig(HIRES_SOURCE_DIR "/config/planner.yaml"));
}

hires::base::Atom AtomOf(const planning::Datum& fact) {
  hires::base::Atom atom{std::string(fact.Head()), {}};
  for (std::size_t i = 1; i < fact.items.size(); ++i) {
    atom.arguments.push_back(planning::ToString(fact.items[i]));
  }
  return atom;
}

/// Serving a coffee as it was planned and sent.
class PlanOfTest : public ::testing::Test {
 protected:
  PlanOfTest() : knowledge_(Restaurant()) {
    const planning::Problem& problem = knowledge_.problems[0];
    command_.tasks = "serve_coffee_to_guest guest1";
    for (const planning::Datum& fact : problem.facts) command_.state.push_back(AtomOf(fact));
    goal_ = GoalOf(command_, 10.0);
    sent_ = planning::FindPlans(knowledge_.domain, problem).plans.at(0);
    planning::AddReasons(knowledge_.domain, problem, &sent_);
    message_ = ToMsg(sent_);
  }

  const planning::PlanningKnowledge knowledge_;
  execution::StartPlanning command_;
  hires::PlanGoal goal_;
  planning::Plan sent_;
  hires::Plan message_;
};

TEST_F(PlanOfTest, StepsReasonsBindingsAndOrderAreThoseOfThePlanner) {
  const planning::Plan plan = PlanOf(message_, goal_, knowledge_);
  ASSERT_EQ(plan.steps.size(), sent_.steps.size());
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    const planning::PlanStep& got = plan.steps[i];
    const planning::PlanStep& want = sent_.steps[i];
    EXPECT_EQ(got.task, want.task);
    EXPECT_EQ(got.preconditions, want.preconditions);
    EXPECT_EQ(got.adds, want.adds);
    EXPECT_EQ(got.deletes, want.deletes);
    EXPECT_EQ(got.reads, want.reads);
    ASSERT_EQ(got.links.size(), want.links.size());
    for (std::size_t k = 0; k < got.links.size(); ++k) {
      EXPECT_EQ(got.links[k].producer, want.links[k].producer);
    }
    for (const auto& [variable, value] : want.bindings) {
      EXPECT_THAT(got.bindings, ::testing::Contains(::testing::Pair(variable, value)));
    }
  }
  EXPECT_EQ(planning::PartialOrder(plan), planning::PartialOrder(sent_));
}

TEST_F(PlanOfTest, WhatTheMessageSaysOfReasonsCountsForNothing) {
  for (hires::PlanStep& step : message_.steps) {
    step.adds.clear();
    step.links.clear();
  }
  EXPECT_EQ(PlanOf(message_, goal_, knowledge_).steps[0].adds, sent_.steps[0].adds);
}

TEST_F(PlanOfTest, AStepThatCannotBeTakenIsAnError) {
  std::swap(message_.steps[0], message_.steps[1]);
  EXPECT_THROW(PlanOf(message_, goal_, knowledge_), hires::base::ConfigError);
}

TEST_F(PlanOfTest, AStepThatIsNoTermIsAnErrorThatNamesIt) {
  message_.steps[3].task = "(!move_base";
  try {
    PlanOf(message_, goal_, knowledge_);
    FAIL() << "no error";
  } catch (const hires::base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("plan.steps[3].task"));
  }
}

TEST(PlanAnswerTest, FoundWithoutAPlanIsInvalid) {
  hires::PlanResult result;
  result.outcome = hires::PlanResult::FOUND;
  EXPECT_EQ(AnswerOf(3, result).outcome, execution::PlanArrived::Outcome::kInvalid);
  result.outcome = hires::PlanResult::LIMIT_MEMORY;
  EXPECT_EQ(AnswerOf(3, result).outcome, execution::PlanArrived::Outcome::kLimit);
  result.outcome = hires::PlanResult::BUSY;
  EXPECT_EQ(AnswerOf(3, result).outcome, execution::PlanArrived::Outcome::kUnavailable);
  EXPECT_EQ(AnswerOf(3, result).request, 3);
}

hires::Prediction Prediction(const std::string& set, double success) {
  hires::Prediction prediction;
  prediction.action.name = "move_base_param";
  prediction.action.arguments = {"area1", set};
  prediction.success_share = success;
  prediction.rollouts = 16;
  prediction.duration_mean = 20.0;
  prediction.durations = {17.0, 20.0, 23.0};
  prediction.duration_p95 = 23.0;
  hires::FailureCount fell;
  fell.failure.code = hires::Failure::OBJECT_FELL;
  fell.count = 5;
  hires::FailureCount late;
  late.failure.code = hires::Failure::TIMED_OUT;
  late.count = 1;
  prediction.failures = {late, fell};
  return prediction;
}

hires::ImagineResult Ranked() {
  hires::ImagineResult result;
  result.outcome = hires::ImagineResult::RANKED;
  result.predictions = {Prediction("slow", 1.0), Prediction("fast", 0.2)};
  result.recommended = 0;
  return result;
}

hires::GenerateImagineState::Response StateWith(const std::string& object) {
  hires::GenerateImagineState::Response state;
  state.world_state.objects.resize(1);
  state.world_state.objects[0].name = object;
  return state;
}

TEST(ImagineAnswerTest, ARankingHasRecommendationAndDuration) {
  const auto answer = AnswerOf(7, Ranked(), StateWith("Mug1"), false);
  EXPECT_EQ(answer.outcome, ImagineOutcome::kRanked);
  EXPECT_EQ(answer.request, 7);
  EXPECT_THAT(answer.recommended.arguments, ElementsAre("area1", "slow"));
  EXPECT_EQ(answer.duration, 20.0);
  EXPECT_EQ(answer.duration_low, 17.0);
  EXPECT_EQ(answer.duration_high, 23.0);
  EXPECT_TRUE(answer.failed.empty());
  EXPECT_THAT(answer.depends_on, ElementsAre("mug1"));
}

TEST(ImagineAnswerTest, WhenAllFailedEveryAlternativeIsNamed) {
  hires::ImagineResult result = Ranked();
  result.outcome = hires::ImagineResult::ALL_FAILED;
  result.recommended = -1;
  const auto answer = AnswerOf(7, result, {}, false);
  EXPECT_EQ(answer.outcome, ImagineOutcome::kAllFailed);
  ASSERT_EQ(answer.failed.size(), 2u);
  EXPECT_EQ(answer.failed[1].arguments[1], "fast");
  const hires::base::Failure fell(hires::base::FailureCode::kObjectFell);
  EXPECT_THAT(answer.failures, ElementsAre(fell, fell));
}

TEST(ImagineAnswerTest, ARequestThatWasLateCountsAsFarAsItWas) {
  hires::ImagineResult result = Ranked();
  result.outcome = hires::ImagineResult::RANKED_AT_DEADLINE;
  EXPECT_EQ(AnswerOf(7, result, {}, true).outcome, ImagineOutcome::kRanked);
  result.recommended = -1;
  result.outcome = hires::ImagineResult::ALL_FAILED;
  EXPECT_EQ(AnswerOf(7, result, {}, true).outcome, ImagineOutcome::kAllFailed);
  EXPECT_EQ(AnswerOf(7, result, {}, true).failed.size(), 2u);
  result.predictions.clear();
  result.outcome = hires::ImagineResult::CANCELLED;
  EXPECT_EQ(AnswerOf(7, result, {}, true).outcome, ImagineOutcome::kNothingFinished);
  EXPECT_EQ(AnswerOf(7, result, {}, false).outcome, ImagineOutcome::kUnavailable);
}

TEST(ImagineAnswerTest, WhatIsUndecidedRulesNothingOutWhateverItsIntervalsAre) {
  hires::ImagineResult result = Ranked();
  result.outcome = hires::ImagineResult::UNDECIDED;
  result.recommended = -1;
  for (auto& prediction : result.predictions) prediction.success_upper = 0.4;
  const auto answer = AnswerOf(7, result, {}, true);
  EXPECT_EQ(answer.outcome, ImagineOutcome::kUndecided);
  EXPECT_TRUE(answer.failed.empty());
}

TEST(ImagineAnswerTest, ARankingThatRecommendsNothingIsInvalid) {
  hires::ImagineResult result = Ranked();
  result.recommended = 2;
  EXPECT_EQ(AnswerOf(7, result, {}, false).outcome, ImagineOutcome::kInvalid);
  result.outcome = 77;
  EXPECT_EQ(AnswerOf(7, result, {}, false).outcome, ImagineOutcome::kInvalid);
}

TEST(StepMessageTest, WhatHasNotHappenedIsNoNumber) {
  execution::StepStatus status;
  status.plan = 2;
  status.phase = execution::StepPhase::kChecking;
  status.started = 5.0;
  status.expected_start = 5.0;
  status.expected_finish = 19.1;
  const hires::StepStatus message = ToMsg(status);
  EXPECT_EQ(message.plan, 2u);
  EXPECT_EQ(message.phase, hires::StepStatus::CHECKING);
  EXPECT_EQ(message.started, 5.0);
  EXPECT_TRUE(std::isnan(message.finished));
  EXPECT_EQ(message.expected_start, 5.0);
  EXPECT_EQ(message.expected_finish, 19.1);
}

TEST(StepMessageTest, PhasesHaveTheSameNumbers) {
  using execution::StepPhase;
  const auto number = [](StepPhase phase) { return static_cast<std::uint8_t>(phase); };
  EXPECT_EQ(number(StepPhase::kWaiting), hires::StepStatus::WAITING);
  EXPECT_EQ(number(StepPhase::kReady), hires::StepStatus::READY);
  EXPECT_EQ(number(StepPhase::kRunning), hires::StepStatus::RUNNING);
  EXPECT_EQ(number(StepPhase::kChecking), hires::StepStatus::CHECKING);
  EXPECT_EQ(number(StepPhase::kDone), hires::StepStatus::DONE);
  EXPECT_EQ(number(StepPhase::kFailed), hires::StepStatus::FAILED);
  EXPECT_EQ(number(StepPhase::kSkipped), hires::StepStatus::SKIPPED);
}

TEST(ExecuteMessageTest, NoLimitIsNone) {
  EXPECT_EQ(GoalOf(execution::StartStep{1, {"tuck_arms", {}}, 12.5}).time_limit.toSec(), 12.5);
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(GoalOf(execution::StartStep{1, {"tuck_arms", {}}, infinite}).time_limit.toSec(), 0.0);
}

TEST(ExecuteMessageTest, WhatCannotBeDoneFailed) {
  hires::ExecuteActionResult result;
  result.code = hires::ExecuteActionResult::INVALID;
  result.failure.code = hires::Failure::INVALID_ACTION;
  result.failure.detail = "no such action";
  const auto finished = AnswerOf(4, result);
  EXPECT_EQ(finished.result, execution::StepFinished::Result::kFailed);
  EXPECT_EQ(ToString(finished.failure), "invalid_action: no such action");
}

}  // namespace
}  // namespace hires_ros::execution_messages_test
