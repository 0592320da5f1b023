#include "hires/ros/planning/plan_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "hires/planning/datum_reader.h"
#include "hires/planning/planning_files.h"
#include "support/messages.h"

namespace hires_ros::plan_request_test {
namespace {

namespace planning = hires::planning;
using hires::test_support::ConfigErrorOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::StartsWith;

const std::string& DeliveryFile() {
  static const std::string path =
      std::string(HIRES_SOURCE_DIR) + "/test/reports/data/delivery.lisp";
  return path;
}

const planning::PlanningKnowledge& Delivery() {
  static const planning::PlanningKnowledge knowledge = [] {
    planning::PlanningKnowledge read;
    read.domain = planning::LoadDomain(DeliveryFile());
    read.problems = planning::LoadProblems(DeliveryFile(), read.domain);
    return read;
  }();
  return knowledge;
}

hires::Atom MakeAtom(const std::string& predicate, const std::vector<std::string>& arguments) {
  hires::Atom atom;
  atom.predicate = predicate;
  atom.arguments = arguments;
  return atom;
}

hires::PlanGoal Goal(const std::string& task) {
  hires::PlanGoal goal;
  goal.task = task;
  return goal;
}

PlanRequest Request(const hires::PlanGoal& goal) { return RequestOf(goal, Delivery(), {}); }

std::string ErrorOf(const hires::PlanGoal& goal) {
  return ConfigErrorOf([&] { Request(goal); });
}

hires::PlanResult Answer(const hires::PlanGoal& goal,
                         planning::Stop stop = planning::Stop::kContinue) {
  return AnswerTo(goal, Delivery(), {}, [stop](const planning::Progress&) { return stop; });
}

std::vector<std::string> TasksOf(const planning::Problem& problem) {
  std::vector<std::string> tasks;
  for (const auto& item : problem.tasks.items) tasks.push_back(planning::ToString(item.task));
  return tasks;
}

std::vector<std::string> FactsOf(const planning::Problem& problem) {
  std::vector<std::string> facts;
  for (const planning::Datum& fact : problem.facts) facts.push_back(planning::ToString(fact));
  return facts;
}

// What a goal means.

TEST(PlanRequestTest, ATaskIsPlannedFromTheFirstProblemsFacts) {
  const PlanRequest request = Request(Goal("travel park"));
  EXPECT_THAT(TasksOf(request.problem), ElementsAre("(travel park)"));
  EXPECT_EQ(request.problem.facts.size(), Delivery().problems[0].facts.size());
  EXPECT_EQ(request.search.which, planning::Which::kFirst);
}

TEST(PlanRequestTest, ANamedProblemBringsItsFactsAndWithoutATaskItsTasks) {
  hires::PlanGoal goal;
  goal.problem = "no_way";
  EXPECT_THAT(TasksOf(Request(goal).problem), ElementsAre("(deliver parcel anna)"));
  goal.task = "travel park";
  const PlanRequest request = Request(goal);
  EXPECT_THAT(TasksOf(request.problem), ElementsAre("(travel park)"));
  EXPECT_THAT(FactsOf(request.problem),
              ElementsAre("(at home)", "(has parcel)", "(lives anna island)", "(path home park)"));
}

TEST(PlanRequestTest, AStateReplacesTheFactsAndMoreFactsCome) {
  hires::PlanGoal goal = Goal("travel park");
  goal.state = {MakeAtom("At", {"Home"}), MakeAtom("size", {"1.5", "(a (b 2))"})};
  goal.more_facts = {MakeAtom("imagined_failure", {"!walk", "home", "park"})};
  EXPECT_THAT(FactsOf(Request(goal).problem), ElementsAre("(at home)", "(size 1.5 (a (b 2)))",
                                                          "(imagined_failure !walk home park)"));
  goal.state.clear();
  EXPECT_EQ(FactsOf(Request(goal).problem).back(), "(imagined_failure !walk home park)");
  EXPECT_EQ(FactsOf(Request(goal).problem).size(), Delivery().problems[0].facts.size() + 1);
}

TEST(PlanRequestTest, WithoutProblemsThereIsNoFact) {
  planning::PlanningKnowledge knowledge;
  knowledge.domain = Delivery().domain;
  EXPECT_THAT(RequestOf(Goal("travel park"), knowledge, {}).problem.facts, IsEmpty());
}

TEST(PlanRequestTest, LimitsAreThePlannersWhereTheGoalSaysNothing) {
  planning::PlannerConfig config;
  config.max_plans = 7;
  config.max_depth = 99;
  config.time_limit = 12.0;
  hires::PlanGoal goal = Goal("travel park");
  EXPECT_EQ(RequestOf(goal, Delivery(), config).search.max_plans, 7u);
  EXPECT_EQ(RequestOf(goal, Delivery(), config).search.max_depth, 99);
  EXPECT_EQ(TimeLimitOf(goal, config), 12.0);
  goal.max_plans = 3;
  goal.max_trace = 5;
  goal.time_limit = ros::Duration(2.5);
  EXPECT_EQ(RequestOf(goal, Delivery(), config).search.max_plans, 3u);
  EXPECT_EQ(RequestOf(goal, Delivery(), config).search.max_trace, 5u);
  EXPECT_EQ(TimeLimitOf(goal, config), 2.5);
}

TEST(PlanRequestTest, WhatCannotBeUnderstoodIsNamed) {
  EXPECT_THAT(ErrorOf(Goal("")), StartsWith("task and problem are both empty"));
  EXPECT_THAT(ErrorOf(Goal("(travel")), StartsWith("task:1:1: "));
  EXPECT_THAT(ErrorOf(Goal("trvel park")), HasSubstr("'travel'"));
  hires::PlanGoal goal = Goal("travel park");
  goal.problem = "two_wasy";
  EXPECT_THAT(ErrorOf(goal), HasSubstr("'two_ways'"));
  goal = Goal("travel park");
  goal.state = {MakeAtom("at", {"?where"})};
  EXPECT_THAT(ErrorOf(goal), StartsWith("state[0].arguments[0]: ?where has a variable"));
  goal.state = {MakeAtom("at", {"home"}), MakeAtom("3", {})};
  EXPECT_THAT(ErrorOf(goal), StartsWith("state[1].predicate: is 3, wanted a name"));
}

TEST(PlanRequestTest, LimitsBeyondThePlannersOwnAreRefused) {
  hires::PlanGoal goal = Goal("travel park");
  goal.which = 3;
  EXPECT_THAT(ErrorOf(goal), StartsWith("which is 3, wanted FIRST (0), ALL (1) or BEST (2)"));
  goal = Goal("travel park");
  goal.max_plans = 1001;
  EXPECT_THAT(ErrorOf(goal), StartsWith("max_plans is 1001, wanted at most 1000"));
  goal = Goal("travel park");
  goal.memory_limit = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(ErrorOf(goal), StartsWith("memory_limit is nan MB, wanted at most 1000 MB"));
  goal = Goal("travel park");
  goal.time_limit = ros::Duration(-1.0);
  EXPECT_THAT(ErrorOf(goal), StartsWith("time_limit is -1 s, wanted at most 60 s"));
}

// Its answer.

TEST(PlanRequestTest, APlanIsAnswered) {
  const hires::PlanResult result = Answer(Goal("deliver parcel anna"));
  EXPECT_EQ(result.outcome, hires::PlanResult::FOUND);
  EXPECT_EQ(result.why, "1 plan, 2 steps, cost 6");
  ASSERT_THAT(result.plans, SizeIs(1));
  ASSERT_THAT(result.plans[0].steps, SizeIs(2));
  EXPECT_EQ(result.plans[0].steps[0].task, "(!walk home park)");
  EXPECT_THAT(result.plans[0].steps[1].after, ElementsAre(0u));
}

TEST(PlanRequestTest, NoPlanComesWithATraceIfWanted) {
  hires::PlanGoal goal = Goal("travel island");
  EXPECT_EQ(Answer(goal).outcome, hires::PlanResult::NO_PLAN);
  EXPECT_THAT(Answer(goal).trace, IsEmpty());
  goal.max_trace = 10;
  const hires::PlanResult result = Answer(goal);
  EXPECT_TRUE(result.exhausted);
  ASSERT_THAT(result.trace, SizeIs(testing::Ge(2u)));
  EXPECT_THAT(result.trace[0], HasSubstr("(travel island)"));
}

TEST(PlanRequestTest, WhoeverStopsGetsNoPlans) {
  const hires::PlanResult result = Answer(Goal("travel park"), planning::Stop::kCancelled);
  EXPECT_EQ(result.outcome, hires::PlanResult::CANCELLED);
  EXPECT_THAT(result.plans, IsEmpty());
}

TEST(PlanRequestTest, ABadGoalIsAResultAndNoException) {
  const hires::PlanResult result = Answer(Goal("deliver parcel"));
  EXPECT_EQ(result.outcome, hires::PlanResult::INVALID);
  EXPECT_THAT(result.why, HasSubstr("deliver"));
  EXPECT_LT(Answer(Goal(std::string(1'000'000, 'x'))).why.size(), 3000u);
}

// Plans as messages.

planning::Datum Term(const std::string& text) { return planning::ReadData(text, "test").at(0); }

TEST(PlanRequestTest, AStepKeepsAllThatItRestsOn) {
  planning::Plan plan;
  plan.cost = 2.5;
  plan.nodes.resize(2);
  plan.nodes[1].parent = 0;
  planning::PlanStep step;
  step.task = Term("(!!imagine (slow fast) 1.5)");
  step.cost = 2.5;
  step.node = 1;
  step.preconditions = {{Term("(at home)"), true}, {Term("(on ?x (a b))"), false}};
  step.deletes = {Term("(at home)")};
  step.adds = {Term("(at park)")};
  step.links = {{planning::CausalLink::kInitial, step.preconditions[0]},
                {planning::CausalLink::kInitial, step.preconditions[1]}};
  plan.steps = {step};
  const hires::Plan message = ToMsg(plan);
  ASSERT_THAT(message.steps, SizeIs(1));
  const hires::PlanStep& told = message.steps[0];
  EXPECT_EQ(told.action.name, "imagine");
  EXPECT_THAT(told.action.arguments, ElementsAre("(slow fast)", "1.5"));
  EXPECT_TRUE(told.bookkeeping);
  EXPECT_EQ(told.task, "(!!imagine (slow fast) 1.5)");
  EXPECT_EQ(told.cost, 2.5);
  EXPECT_EQ(told.path, "");
  ASSERT_THAT(told.preconditions, SizeIs(2));
  EXPECT_EQ(told.preconditions[1].atom.predicate, "on");
  EXPECT_THAT(told.preconditions[1].atom.arguments, ElementsAre("?x", "(a b)"));
  EXPECT_FALSE(told.preconditions[1].holds);
  EXPECT_EQ(told.deletes[0].predicate, "at");
  EXPECT_THAT(told.adds[0].arguments, ElementsAre("park"));
  ASSERT_THAT(told.links, SizeIs(2));
  EXPECT_EQ(told.links[1].producer, hires::CausalLink::INITIAL);
  EXPECT_EQ(told.links[1].precondition, 1u);
}

}  // namespace
}  // namespace hires_ros::plan_request_test
