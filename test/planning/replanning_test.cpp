#include "hires/planning/replanning.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "hires/planning/planning_files.h"
#include "hires/planning/reasons.h"
#include "hires/planning/validator.h"
#include "planning/support/conditions.h"
#include "planning/support/plan_text.h"
#include "planning/support/plans.h"

namespace hires::planning::replanning_test {
namespace {

using hires::test_support::DomainOf;
using hires::test_support::FirstPlan;
using hires::test_support::ProblemOf;
using hires::test_support::Read;
using hires::test_support::Steps;
using hires::test_support::Text;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// "a < b" for ordered tasks, "a | b" for unordered ones, else pairs; nested networks in brackets.
std::string NetworkText(const TaskNetwork& network) {
  std::vector<std::string> items;
  for (const TaskItem& item : network.items) {
    const std::string text =
        item.network.empty() ? ToString(item.task) : "[" + NetworkText(item.network.front()) + "]";
    items.push_back((item.immediate ? "!" : "") + text);
  }
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) text += (i > 0 ? " " : "") + items[i];
  for (const auto& [before, after] : network.order) {
    text += " " + std::to_string(before) + "<" + std::to_string(after);
  }
  return text;
}

/// Carrying two cups, each by steps that may be interleaved, then a report.
const std::string kCups =
    "(:operator (!pick ?c ?t) ((on ?c ?t)) ((on ?c ?t)) ((held ?c)))"
    "(:operator (!put ?c ?t) ((held ?c)) ((held ?c)) ((on ?c ?t)))"
    "(:operator (!drop ?c) ((held ?c)) ((held ?c)) ((on ?c floor)))"
    "(:operator (!report) () () ())"
    "(:method (get ?c) done ((held ?c)) () get ((on ?c ?t)) ((!pick ?c ?t)))"
    "(:method (carry ?c ?to) ((not (on ?c ?to))) ((get ?c) (!put ?c ?to)))"
    "(:method (carry ?c ?to) ((on ?c ?to)) ())"
    "(:method (carry ?c ?to) ((unwanted ?c)) ((get ?c) (!drop ?c)))"
    "(:method (serve ?a ?b) () ((:unordered (carry ?a table) (carry ?b table)) (!report)))";

struct Served {
  Domain domain = DomainOf(kCups);
  Problem problem = ProblemOf("((on cup counter) (on pot counter))", "((serve cup pot))");
  Plan plan = PlanWith(
      "(!pick cup counter) (!put cup table) (!pick pot counter) (!put pot table) (!report)");

  Plan PlanWith(const std::string& steps) const {
    PlanRequest request;
    request.which = Which::kAll;
    for (const Plan& each : FindPlans(domain, problem, request).plans) {
      if (Steps(each) == steps) return each;
    }
    throw std::runtime_error("no plan " + steps);
  }

  Problem Rest(int executed, int keep_depth) const {
    return RemainingProblem(domain, problem, plan, executed,
                            FactsAfter(domain, problem, plan, executed), keep_depth);
  }
  std::string RestText(int executed, int keep_depth) const {
    return NetworkText(Rest(executed, keep_depth).tasks);
  }
};

TEST(RemainingProblemTest, FinishedTasksAreGone) {
  const Served served;
  EXPECT_EQ(served.RestText(2, 9), "(carry pot table) (!report) 0<1");
  EXPECT_EQ(served.RestText(4, 9), "(!report)");
  EXPECT_EQ(served.RestText(5, 9), "");
}

TEST(RemainingProblemTest, ABegunTaskKeepsItsRemainingSubtasks) {
  EXPECT_EQ(Served().RestText(1, 9), "[(!put cup table) (carry pot table)] (!report) 0<1");
}

TEST(RemainingProblemTest, WhatStandsDeeperIsATaskAgain) {
  const Served served;
  EXPECT_EQ(served.RestText(1, 1), "[(carry cup table) (carry pot table)] (!report) 0<1");
  EXPECT_EQ(served.RestText(3, 1), "(carry pot table) (!report) 0<1");
}

TEST(RemainingProblemTest, DepthZeroAsksForTheProblemsOwnTasks) {
  const Served served;
  EXPECT_EQ(served.RestText(1, 0), "(serve cup pot)");
  EXPECT_EQ(served.RestText(5, 0), "(serve cup pot)");
}

TEST(RemainingProblemTest, NothingBegunIsEverythingLeft) {
  EXPECT_EQ(Served().RestText(0, 1), "(serve cup pot)");
}

TEST(RemainingProblemTest, TheFactsAreTheOnesGiven) {
  EXPECT_EQ(Text(Served().Rest(1, 1).facts), "(on pot counter) (held cup)");
}

TEST(RemainingProblemTest, OrderByWayOfAFinishedTaskStays) {
  const Domain domain = DomainOf(
      "(:operator (!a) () () ()) (:operator (!b) () () ()) (:operator (!c) () () ())"
      "(:method (nothing) () ())");
  const Problem problem = ProblemOf("()", "(:unordered (!a) (:ordered (!b) (nothing) (!c)))");
  Plan plan = hires::test_support::FlatPlan({"(!a)", "(!b)", "(!c)"});
  plan.nodes.push_back(hires::test_support::MethodNode("(nothing)", 0, {}, 0, 0, 0));
  plan.nodes[0].children = {1, 2, 4, 3};
  EXPECT_EQ(NetworkText(RemainingProblem(domain, problem, plan, 1, {}, 1).tasks), "(!b) (!c) 0<1");
}

TEST(RemainingProblemTest, ACheckThatWasNotMadeBeforeTheLastStepIsMadeAgain) {
  const Domain domain = DomainOf(
      "(:operator (!a) () () ((p))) (:method (check) ((p)) ())"
      "(:method (t) () ((!a) (check)))");
  const Problem problem = ProblemOf("()", "((t))");
  const Plan plan = FirstPlan(domain, problem);
  EXPECT_EQ(NetworkText(RemainingProblem(domain, problem, plan, 1, {}, 9).tasks), "(check)");
}

TEST(RemainingProblemTest, ImmediateTasksThatDidNotBeginStayImmediate) {
  const Domain domain =
      DomainOf("(:operator (!a) () () ()) (:operator (!b) () () ()) (:operator (!c) () () ())");
  const Problem problem =
      ProblemOf("()", "(:unordered (:ordered (!a) (:task :immediate !b)) (!c))");
  const Plan plan = FirstPlan(domain, problem);
  ASSERT_EQ(Steps(plan), "(!a) (!b) (!c)");
  EXPECT_EQ(NetworkText(RemainingProblem(domain, problem, plan, 1, {}, 1).tasks), "!(!b) (!c)");
}

TEST(RemainingProblemTest, ValuesThatOnlyLaterStepsBoundAreOpenAgain) {
  const Domain domain = DomainOf(
      "(:operator (!look) () () ()) (:operator (!find ?x) ((cup ?x)) () ())"
      "(:operator (!fetch ?x) () () ()) (:method (get) () ((!look) (!find ?x) (!fetch ?x)))");
  const Problem problem = ProblemOf("((cup red))", "((get))");
  const Plan plan = FirstPlan(domain, problem);
  const std::vector<Datum> facts = {Read("(cup blue)")};
  EXPECT_EQ(NetworkText(RemainingProblem(domain, problem, plan, 2, facts, 1).tasks),
            "(!fetch red)");
  const Problem rest = RemainingProblem(domain, problem, plan, 1, facts, 1);
  EXPECT_EQ(Steps(FirstPlan(domain, rest)), "(!find blue) (!fetch blue)");
}

TEST(RemainingProblemTest, ValuesThatThePreconditionBoundStay) {
  const Domain domain = DomainOf(
      "(:operator (!look) () () ()) (:operator (!fetch ?x) () () ())"
      "(:method (get) ((cup ?x)) ((!look) (!fetch ?x)))");
  const Problem problem = ProblemOf("((cup red))", "((get))");
  const Plan plan = FirstPlan(domain, problem);
  EXPECT_EQ(NetworkText(RemainingProblem(domain, problem, plan, 1, {Read("(cup blue)")}, 1).tasks),
            "(!fetch red)");
  Plan bare = plan;  // of another planner, which tells no bindings
  for (PlanNode& node : bare.nodes) node.bindings.clear();
  EXPECT_EQ(NetworkText(RemainingProblem(domain, problem, bare, 1, {}, 1).tasks), "(!fetch red)");
}

const std::string kGuards =
    "(:operator (!guard ?x) () () ((:protection (at ?x))))"
    "(:operator (!work) () () ())"
    "(:operator (!free ?x) () ((:protection (at ?x))) ())"
    "(:operator (!go ?x ?y) ((at ?x)) ((at ?x)) ((at ?y)))"
    "(:method (job ?x) () ((!guard ?x) (!work) (!free ?x)))";

TEST(RemainingProblemTest, OpenProtectionsStay) {
  const Domain domain = DomainOf(kGuards);
  const Problem problem = ProblemOf("((at a))", "((job a))");
  const Plan plan = FirstPlan(domain, problem);
  const auto protections = [&](int executed, const std::string& facts, int keep_depth) {
    return Text(RemainingProblem(domain, problem, plan, executed, Read(facts).items, keep_depth)
                    .protections);
  };
  EXPECT_EQ(protections(1, "((at a))", 1), "(at a)");
  EXPECT_EQ(protections(2, "((at a))", 1), "(at a)");
  EXPECT_EQ(protections(3, "((at a))", 1), "");
  EXPECT_EQ(protections(2, "((at b))", 1), "");  // what does not hold cannot be kept
  EXPECT_EQ(protections(2, "((at a))", 0), "");  // (job a) is done again and protects again
}

TEST(RemainingProblemTest, TheCallerMustNameAMomentOfThePlan) {
  const Served served;
  EXPECT_THROW(served.Rest(6, 1), std::logic_error);
  EXPECT_THROW(RemainingProblem(served.domain, served.problem, served.plan, -1, {}, 1),
               std::logic_error);
  EXPECT_THROW(RemainingProblem(served.domain, served.problem, served.plan, 1, {}, -1),
               std::logic_error);
  EXPECT_THROW(DeepestKeepDepth(Plan(), 0), std::logic_error);
}

TEST(DeepestKeepDepthTest, IsTheDepthOfTheDeepestOpenTask) {
  const Served served;
  EXPECT_EQ(DeepestKeepDepth(served.plan, 0), 1);
  EXPECT_EQ(DeepestKeepDepth(served.plan, 1), 2);  // (carry cup table)
  EXPECT_EQ(DeepestKeepDepth(served.plan, 2), 1);
  EXPECT_EQ(DeepestKeepDepth(served.plan, 5), 1);
}

/// If all goes as planned, the rest of the plan solves what remains, at each moment and depth.
TEST(RemainingProblemTest, WhatRemainsCanBePlannedAtEveryMomentAndDepth) {
  const Served served;
  for (int executed = 0; executed <= 5; ++executed) {
    Plan rest_of_plan;
    rest_of_plan.steps.assign(served.plan.steps.begin() + executed, served.plan.steps.end());
    for (int depth = 1; depth <= DeepestKeepDepth(served.plan, executed); ++depth) {
      const Problem rest = served.Rest(executed, depth);
      PlanRequest all;
      all.which = Which::kAll;
      std::vector<std::string> plans;
      for (const Plan& plan : FindPlans(served.domain, rest, all).plans) {
        EXPECT_THAT(ValidatePlan(served.domain, rest, plan), IsEmpty());
        plans.push_back(Steps(plan));
      }
      EXPECT_THAT(plans, Contains(Steps(rest_of_plan))) << executed << " steps, depth " << depth;
    }
  }
}

// ---------------------------------------------------------------------------------------- Replan

/// Unordered tasks interleave; which way the search does it first is not for these tests.
std::vector<std::string> SortedSteps(const Plan& plan) {
  std::vector<std::string> steps;
  for (const PlanStep& step : plan.steps) steps.push_back(ToString(step.task));
  std::sort(steps.begin(), steps.end());
  return steps;
}

Replanned ReplanServed(const Served& served, int executed, const std::string& facts,
                       const PlanRequest& request = {}) {
  return Replan(served.domain, served.problem, served.plan, executed, Read(facts).items, request);
}

TEST(ReplanTest, KeepsAsMuchAsCanBeKept) {
  const Served served;
  const Replanned again = ReplanServed(served, 1, "((held cup) (on pot counter))");
  EXPECT_EQ(again.result.outcome, PlanOutcome::kFound);
  EXPECT_EQ(again.kept_depth, 2);
  EXPECT_THAT(
      SortedSteps(again.result.plans.at(0)),
      ElementsAre("(!pick pot counter)", "(!put cup table)", "(!put pot table)", "(!report)"));
  EXPECT_THAT(ValidatePlan(served.domain, again.problem, again.result.plans[0]), IsEmpty());
}

TEST(ReplanTest, GivesUpAMethodThatDoesNotWorkAnyMore) {
  const Served served;
  // The cup slipped: putting it down is not possible, carrying it again is.
  const Replanned again = ReplanServed(served, 1, "((on cup floor) (on pot counter))");
  EXPECT_EQ(again.kept_depth, 1);
  EXPECT_THAT(SortedSteps(again.result.plans.at(0)),
              ElementsAre("(!pick cup floor)", "(!pick pot counter)", "(!put cup table)",
                          "(!put pot table)", "(!report)"));
}

TEST(ReplanTest, BeginsAnewWhereNothingElseHelps) {
  // Both are carried, then the cup falls: only (both cup pot) as a whole picks it up.
  const Domain domain =
      DomainOf(kCups +
               "(:operator (!check ?c) ((on ?c table)) () ())"
               "(:method (both ?a ?b) () ((carry ?a table) (carry ?b table) (!check ?a)))");
  const Problem problem = ProblemOf("((on cup counter) (on pot counter))", "((both cup pot))");
  const Plan plan = FirstPlan(domain, problem);
  const Replanned again =
      Replan(domain, problem, plan, 4, Read("((on cup floor) (on pot table))").items);
  EXPECT_EQ(again.result.outcome, PlanOutcome::kFound);
  EXPECT_EQ(again.kept_depth, 0);
  EXPECT_THAT(SortedSteps(again.result.plans.at(0)),
              ElementsAre("(!check cup)", "(!pick cup floor)", "(!put cup table)"));
}

TEST(ReplanTest, ImaginedFailuresExcludeSteps) {
  const Served served;
  const std::string world = "(held cup) (on pot counter) (imagined_failure put cup table)";
  const Replanned none = ReplanServed(served, 1, "(" + world + ")");
  EXPECT_EQ(none.result.outcome, PlanOutcome::kNoPlan);
  EXPECT_TRUE(none.result.exhausted);
  EXPECT_THAT(none.result.plans, IsEmpty());
  const Replanned other = ReplanServed(served, 1, "(" + world + " (unwanted cup))");
  ASSERT_EQ(other.result.outcome, PlanOutcome::kFound);
  EXPECT_THAT(SortedSteps(other.result.plans.at(0)),
              ElementsAre("(!drop cup)", "(!pick pot counter)", "(!put pot table)", "(!report)"));
}

TEST(ReplanTest, SaysNoPlanOnlyWhenEveryTryWasSeenToItsEnd) {
  const Served served;
  PlanRequest request;
  request.max_depth = 2;
  const Replanned given_up = ReplanServed(served, 1, "((held cup) (on pot counter))", request);
  EXPECT_EQ(given_up.result.outcome, PlanOutcome::kLimitDepth);
  EXPECT_FALSE(given_up.result.exhausted);
}

TEST(ReplanTest, ACallersLimitEndsAllTries) {
  const Served served;
  int questions = 0;
  PlanRequest request;
  request.stop = [&](const Progress&) {
    ++questions;
    return Stop::kCancelled;
  };
  const Domain endless = DomainOf(
      "(:operator (!step ?n) () () ((n ?n))) (:method (count ?n) () ((!step ?n) "
      "(count (call + ?n 1)))) (:method (all) () ((count 0) (count 0)))");
  const Problem problem = ProblemOf("()", "((all))");
  Plan plan = hires::test_support::FlatPlan({});
  plan.nodes.push_back(hires::test_support::MethodNode("(all)", 0, {}, 1, 0, 0));
  plan.nodes[0].children = {1};
  const Replanned cancelled = Replan(endless, problem, plan, 0, {}, request);
  EXPECT_EQ(cancelled.result.outcome, PlanOutcome::kCancelled);
  EXPECT_EQ(cancelled.kept_depth, 1);
  EXPECT_EQ(questions, 1);
}

TEST(ReplanTest, CountsTheWorkOfAllTries) {
  const Served served;
  const Replanned again = ReplanServed(served, 1, "((on cup floor) (on pot counter))");
  const PlanResult last_try = FindPlans(served.domain, again.problem);
  EXPECT_GT(again.result.progress.expansions, last_try.progress.expansions);
}

TEST(ReplanTest, OpenProtectionsAreKept) {
  const Domain domain = DomainOf(kGuards + "(:method (tour) () ((!go a b)))");
  const Problem problem = ProblemOf("((at a))", "(:unordered (job a) (tour))");
  PlanRequest all;
  all.which = Which::kAll;
  const Plan plan = FindPlans(domain, problem, all).plans.at(0);
  ASSERT_EQ(ToString(plan.steps.at(0).task), "(!guard a)");
  const Problem rest = RemainingProblem(domain, problem, plan, 1, {Read("(at a)")}, 1);
  for (const Plan& again : FindPlans(domain, rest, all).plans) {
    EXPECT_THAT(ValidatePlan(domain, rest, again), IsEmpty());
    EXPECT_EQ(Steps(again), "(!work) (!free a) (!go a b)");
  }
}

// ----------------------------------------------------------------------------------- shared data

/// Where the world is as expected, the rest of the plan is found again, whole and at once.
void ExpectRestIsFoundAgain(const std::string& domain_file, const std::string& problem_file) {
  const std::filesystem::path folder = std::filesystem::path(HIRES_SHARED_DATA) / "htn";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no example problems in " << folder;
  const Domain domain = LoadDomain(folder / domain_file);
  const Problem problem = LoadProblems(folder / problem_file, domain).at(0);
  const Plan plan = FirstPlan(domain, problem);
  const int num_steps = static_cast<int>(plan.steps.size());
  for (int part = 0; part <= 6; ++part) {
    const int executed = num_steps * part / 6;
    const Replanned again =
        Replan(domain, problem, plan, executed, FactsAfter(domain, problem, plan, executed));
    ASSERT_EQ(again.result.outcome, PlanOutcome::kFound) << executed;
    EXPECT_EQ(again.kept_depth, DeepestKeepDepth(plan, executed));
    EXPECT_THAT(ValidatePlan(domain, again.problem, again.result.plans.at(0)), IsEmpty());
    Plan rest;
    rest.steps.assign(plan.steps.begin() + executed, plan.steps.end());
    EXPECT_EQ(Steps(again.result.plans.at(0)), Steps(rest)) << executed;
  }
}

TEST(ReplanSharedPlansTest, Blocks) {
  ExpectRestIsFoundAgain("shop2/blocks.lisp", "shop2/blocks_100.lisp");
}
TEST(ReplanSharedPlansTest, Depots) {
  ExpectRestIsFoundAgain("shop2/depots.lisp", "shop2/depots_07.lisp");
}
// Parcels share trucks that are protected where one of them is loaded: the rest may come in another
// order, but must keep what is protected.
TEST(ReplanSharedPlansTest, LogisticsKeepsOpenProtections) {
  const std::filesystem::path folder = std::filesystem::path(HIRES_SHARED_DATA) / "htn" / "shop2";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no example problems in " << folder;
  const Domain domain = LoadDomain(folder / "logistics.lisp");
  const Problem problem = LoadProblems(folder / "logistics_15_1.lisp", domain).at(0);
  const Plan plan = FirstPlan(domain, problem);
  for (int executed = 0; executed < static_cast<int>(plan.steps.size()); executed += 15) {
    const Replanned again =
        Replan(domain, problem, plan, executed, FactsAfter(domain, problem, plan, executed));
    ASSERT_EQ(again.result.outcome, PlanOutcome::kFound) << executed;
    EXPECT_THAT(ValidatePlan(domain, again.problem, again.result.plans.at(0)), IsEmpty())
        << executed;
  }
}
TEST(ReplanSharedPlansTest, Snake) {
  ExpectRestIsFoundAgain("hddl/snake/domain.hddl", "hddl/snake/pb05.snake.hddl");
}
TEST(ReplanSharedPlansTest, Tidy) {
  ExpectRestIsFoundAgain("hddl/tidy/domain.hddl", "hddl/tidy/tidy01.hddl");
}

}  // namespace
}  // namespace hires::planning::replanning_test
