#include "hires/planning/validator.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "hires/base/rng.h"
#include "hires/planning/planning_files.h"
#include "planning/support/plans.h"

namespace hires::planning::validator_test {
namespace {

using hires::test_support::DomainOf;
using hires::test_support::FirstPlan;
using hires::test_support::FlatPlan;
using hires::test_support::FlatProblem;
using hires::test_support::MethodNode;
using hires::test_support::ProblemOf;
using hires::test_support::TaskOf;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// ------------------------------------------------------------------------------------ by hand

const std::string kCups =
    "(:operator (!pick ?c ?t) ((on ?c ?t)) ((on ?c ?t)) ((held ?c)) 2)"
    "(:operator (!put ?c ?t) ((held ?c)) ((held ?c)) ((on ?c ?t)) (call + 1 2))"
    "(:method (carry ?c ?to) there ((on ?c ?to)) () elsewhere ((on ?c ?from))"
    " ((!pick ?c ?from) (!put ?c ?to)))"
    "(:method (serve ?a ?b) () (:unordered (carry ?a table) (carry ?b table)))";

const char kFacts[] = "((on cup counter) (on pot table))";

Problem CupProblem() { return ProblemOf(kFacts, "((serve cup pot))"); }

/// (serve cup pot) -> (carry cup table) by its second branch, (carry pot table) by its first.
Plan CupPlan() {
  Plan plan = FlatPlan({"(!pick cup counter)", "(!put cup table)"});
  plan.steps[0].cost = 2.0;
  plan.steps[1].cost = 3.0;
  plan.cost = 5.0;
  plan.nodes[0].children = {3};
  plan.nodes[1].parent = plan.nodes[2].parent = 4;
  plan.nodes.push_back(MethodNode("(serve cup pot)", 0, {4, 5}, 1, 0, 0));
  plan.nodes.push_back(MethodNode("(carry cup table)", 3, {1, 2}, 0, 1, 0));
  plan.nodes.back().bindings = {{"?from", MakeSymbol("counter")}};
  plan.nodes.push_back(MethodNode("(carry pot table)", 3, {}, 0, 0, 2));
  return plan;
}

std::vector<std::string> Wrong(const Plan& plan) {
  return ValidatePlan(DomainOf(kCups), CupProblem(), plan);
}

/// What is said of the plan after it was spoilt.
std::vector<std::string> Spoilt(const std::function<void(Plan*)>& spoil) {
  Plan plan = CupPlan();
  spoil(&plan);
  return Wrong(plan);
}

TEST(ValidatePlanTest, APlanWorkedOutByHandIsValid) { EXPECT_THAT(Wrong(CupPlan()), IsEmpty()); }

TEST(ValidatePlanTest, AnEmptyPlanSolvesAnEmptyProblem) {
  EXPECT_THAT(ValidatePlan(DomainOf(kCups), ProblemOf("()", "()"), FlatPlan({})), IsEmpty());
}

TEST(ValidatePlanTest, APlanWithoutRootIsSaidSo) {
  EXPECT_THAT(Spoilt([](Plan* plan) { plan->nodes.clear(); }),
              Contains(HasSubstr("node 0, the root, is missing")));
}

TEST(ValidatePlanTest, NodesMustFormATree) {
  EXPECT_THAT(Spoilt([](Plan* plan) { plan->nodes[3].children[0] = 17; }),
              Contains(HasSubstr("node 3: its child 17 does not exist")));
  EXPECT_THAT(Spoilt([](Plan* plan) { plan->nodes[4].parent = 5; }),
              Contains("node 4 (carry cup table): is a child of node 3, but names node 5 as its "
                       "parent"));
  EXPECT_THAT(Spoilt([](Plan* plan) {
                plan->nodes[3].children = {4, 5, 5};
              }),
              Contains("node 5 (carry pot table): stands 2 times in the tree below the root"));
  EXPECT_THAT(Spoilt([](Plan* plan) { plan->nodes[3].children = {4}; }),
              Contains("node 5 (carry pot table): stands 0 times in the tree below the root"));
  EXPECT_THAT(Spoilt([](Plan* plan) { plan->nodes[0].parent = 3; }),
              Contains(HasSubstr("node 0 is the root")));
}

TEST(ValidatePlanTest, StepsAndPrimitiveNodesBelongTogether) {
  EXPECT_THAT(Spoilt([](Plan* plan) { plan->nodes[1].step = -1; }),
              Contains("node 1 (!pick cup counter): has neither a method nor a step of the plan"));
  EXPECT_THAT(Spoilt([](Plan* plan) { plan->nodes[1].step = 1; }),
              Contains("node 1 (!pick cup counter): its step 1 is (!put cup table)"));
  EXPECT_THAT(Spoilt([](Plan* plan) { plan->steps[0].node = 4; }),
              Contains("step 0 (!pick cup counter): node 4 is not its place in the decomposition"));
  EXPECT_THAT(Spoilt([](Plan* plan) { plan->nodes[4].step = 1; }),
              Contains("node 4 (carry cup table): has a method and a step"));
}

TEST(ValidatePlanTest, TheProblemsTasksStandAtTheTop) {
  EXPECT_THAT(ValidatePlan(DomainOf(kCups), ProblemOf(kFacts, "((serve pot cup))"), CupPlan()),
              ElementsAre("node 0 (the problem): its subtask (serve pot cup) cannot be (serve cup "
                          "pot) (node 3)"));
  EXPECT_THAT(
      ValidatePlan(DomainOf(kCups), ProblemOf(kFacts, "((serve cup pot) (carry cup table))"),
                   CupPlan()),
      ElementsAre("node 0 (the problem): has 1 children where its task network asks for 2"));
}

TEST(ValidatePlanTest, MethodAndBranchMustExist) {
  EXPECT_THAT(Spoilt([](Plan* plan) { plan->nodes[4].method = 2; }),
              ElementsAre("node 4 (carry cup table): method 2, branch 1 does not exist in the "
                          "domain"));
  EXPECT_THAT(Spoilt([](Plan* plan) { plan->nodes[4].branch = 2; }),
              ElementsAre(HasSubstr("method 0, branch 2 does not exist")));
}

TEST(ValidatePlanTest, TheMethodIsOneForTheTask) {
  EXPECT_THAT(Spoilt([](Plan* plan) {
                plan->nodes[4].method = 1;
                plan->nodes[4].branch = 0;
              }),
              ElementsAre(HasSubstr("does not fit the method for (serve ?a ?b)")));
}

TEST(ValidatePlanTest, ChildrenAreTheBranchsSubtasks) {
  EXPECT_THAT(Spoilt([](Plan* plan) {
                plan->nodes[1].task = plan->steps[0].task = TaskOf("(!pick pot table)");
              }),
              Contains(HasSubstr("its subtask (!pick cup counter) cannot be (!pick pot table)")));
  EXPECT_THAT(Spoilt([](Plan* plan) { plan->nodes[5].branch = 1; }),
              Contains(HasSubstr("has 0 children where its method's branch asks for 2")));
}

TEST(ValidatePlanTest, ThePreconditionHoldsWhenTheTaskIsDecomposed) {
  EXPECT_THAT(Spoilt([](Plan* plan) { plan->nodes[4].bindings[0].second = MakeSymbol("table"); }),
              Contains(HasSubstr("its subtask (!pick cup table) cannot be (!pick cup counter)")));
  EXPECT_THAT(ValidatePlan(DomainOf(kCups), ProblemOf("((on cup counter))", "((serve cup pot))"),
                           CupPlan()),
              ElementsAre(AllOf(HasSubstr("node 5 (carry pot table): d.lisp:1:"),
                                HasSubstr("the precondition of branch 1 of its method does not "
                                          "hold after 2 steps"))));
}

TEST(ValidatePlanTest, ARecordedMomentCounts) {
  Plan late = CupPlan();
  late.nodes[4].at_step = 1;
  EXPECT_THAT(Wrong(late),
              Contains("node 4 (carry cup table): was decomposed after 1 steps, but step 0 belongs "
                       "to it"));
  late.nodes[4].at_step = 7;
  EXPECT_THAT(Wrong(late), Contains(HasSubstr("was decomposed after 7 steps, the plan has 2")));
}

TEST(ValidatePlanTest, NoEarlierBranchHeld) {
  const Problem problem =
      ProblemOf("((on cup counter) (on cup table) (on pot table))", "((serve cup pot))");
  EXPECT_THAT(ValidatePlan(DomainOf(kCups), problem, CupPlan()),
              ElementsAre(AllOf(HasSubstr("node 4 (carry cup table)"),
                                HasSubstr("branch 1 of its method holds after 0 steps, so branch 2 "
                                          "must not be used"))));
}

TEST(ValidatePlanTest, OperatorsMustBePossible) {
  EXPECT_THAT(Spoilt([](Plan* plan) {
                std::swap(plan->steps[0], plan->steps[1]);
                std::swap(plan->nodes[1].step, plan->nodes[2].step);
              }),
              AllOf(Contains(AllOf(HasSubstr("step 0 (!put cup table): d.lisp:1:"),
                                   HasSubstr("the precondition of its operator does not hold"))),
                    Contains("node 2 (!put cup table): begins after 0 steps, before what it has to "
                             "wait for is done after 2 steps")));
}

TEST(ValidatePlanTest, StepsNeedAnOperator) {
  EXPECT_THAT(ValidatePlan(DomainOf(kCups), ProblemOf(kFacts, "()"), FlatPlan({"(!throw cup)"})),
              Contains("step 0 (!throw cup): no operator of the domain has this name and these "
                       "arguments"));
}

TEST(ValidatePlanTest, CostsAreThoseOfTheOperators) {
  EXPECT_THAT(Spoilt([](Plan* plan) { plan->steps[1].cost = 4.0; }),
              ElementsAre("step 1 (!put cup table): has cost 4, its operator says 3",
                          "the plan's cost is 5, its steps cost 6"));
  EXPECT_THAT(Spoilt([](Plan* plan) { plan->cost = 6.0; }),
              ElementsAre("the plan's cost is 6, its steps cost 5"));
}

TEST(ValidatePlanTest, APlanOfAnotherPlannerNeedsNoCostsMomentsAndBindings) {
  EXPECT_THAT(Spoilt([](Plan* plan) {
                plan->cost = plan->steps[0].cost = plan->steps[1].cost = 0.0;
                plan->nodes[4].bindings.clear();
                plan->nodes[5].at_step = 0;
              }),
              IsEmpty());
}

TEST(ValidatePlanTest, TheProblemsGoalHoldsInTheEnd) {
  Problem problem = CupProblem();
  problem.goal.emplace();
  problem.goal->kind = Formula::Kind::kAtom;
  problem.goal->term = TaskOf("(on cup table)");
  EXPECT_THAT(ValidatePlan(DomainOf(kCups), problem, CupPlan()), IsEmpty());
  problem.goal->term = TaskOf("(on cup counter)");
  EXPECT_THAT(ValidatePlan(DomainOf(kCups), problem, CupPlan()),
              ElementsAre(HasSubstr("the problem's goal does not hold after the last step")));
}

TEST(ValidatePlanTest, AnImaginedFailureExcludesAStepWithAndWithoutItsMark) {
  for (const std::string fact :
       {"(imagined_failure put cup table)", "(imagined_failure !put cup table)"}) {
    const Problem problem =
        ProblemOf("((on cup counter) (on pot table) " + fact + ")", "((serve cup pot))");
    EXPECT_THAT(ValidatePlan(DomainOf(kCups), problem, CupPlan()),
                ElementsAre("step 1 (!put cup table): is excluded by the fact " + fact));
  }
  const Problem other = ProblemOf(
      "((on cup counter) (on pot table) (imagined_failure put cup counter))", "((serve cup pot))");
  EXPECT_THAT(ValidatePlan(DomainOf(kCups), other, CupPlan()), IsEmpty());
}

TEST(ValidatePlanTest, WhatCannotBeEvaluatedIsAViolationNotAnException) {
  const std::vector<std::string> steps = {"(!a x)"};
  EXPECT_THAT(ValidatePlan(DomainOf("(:operator (!a ?x) ((eval (> ?x 1))) () ())"),
                           FlatProblem("()", steps), FlatPlan(steps)),
              Contains(HasSubstr("step 0 (!a x): cannot be checked: d.lisp:1:")));
}

TEST(ValidatePlanTest, AddsMustBeGround) {
  const std::vector<std::string> steps = {"(!a)"};
  Domain domain = DomainOf("(:operator (!a) () () ((p x)))");
  domain.operators[0].adds[0].term = TaskOf("(p ?x)");
  EXPECT_THAT(ValidatePlan(domain, FlatProblem("()", steps), FlatPlan(steps)),
              Contains("step 0 (!a): adds (p ?x), which has unbound variables"));
}

// -------------------------------------------------------------------------- order, immediate tasks

const std::string kLetters =
    "(:operator (!a) () () ()) (:operator (!b) () () ()) (:operator (!c) () () ())"
    "(:operator (!d) () () ())";

std::vector<std::string> WrongOrder(const std::string& network,
                                    const std::vector<std::string>& steps,
                                    const std::vector<int>& children) {
  Plan plan = FlatPlan(steps);
  plan.nodes[0].children = children;
  return ValidatePlan(DomainOf(kLetters), ProblemOf("()", network), plan);
}

TEST(NetworkOrderTest, UnorderedTasksMayComeInAnyOrder) {
  EXPECT_THAT(WrongOrder("(:unordered (!a) (!b))", {"(!b)", "(!a)"}, {2, 1}), IsEmpty());
}

TEST(NetworkOrderTest, OrderedTasksMayNot) {
  EXPECT_THAT(WrongOrder("((!a) (!b))", {"(!b)", "(!a)"}, {2, 1}),
              ElementsAre(HasSubstr("node 1 (!b): begins after 0 steps, before")));
}

TEST(NetworkOrderTest, NestedNetworksInterleaveButKeepTheirOwnOrder) {
  const std::string network = "(:unordered (:ordered (!a) (!b)) (:ordered (!c) (!d)))";
  EXPECT_THAT(WrongOrder(network, {"(!a)", "(!c)", "(!b)", "(!d)"}, {1, 3, 2, 4}), IsEmpty());
  EXPECT_THAT(WrongOrder(network, {"(!c)", "(!b)", "(!a)", "(!d)"}, {3, 2, 1, 4}),
              ElementsAre(HasSubstr("node 2 (!b): begins after 1 steps, before what it has to wait "
                                    "for is done after 3 steps")));
}

TEST(NetworkOrderTest, ATaskAfterANetworkWaitsForAllOfIt) {
  const std::string network = "((:unordered (!a) (!b)) (!c))";
  EXPECT_THAT(WrongOrder(network, {"(!b)", "(!a)", "(!c)"}, {2, 1, 3}), IsEmpty());
  EXPECT_THAT(WrongOrder(network, {"(!a)", "(!c)", "(!b)"}, {1, 3, 2}),
              ElementsAre(HasSubstr("node 2 (!c): begins after 1 steps")));
}

TEST(ImmediateTest, NothingComesBetweenATaskThatIsReadyAndImmediate) {
  const std::string network =
      "(:unordered (:ordered (!a) (:task :immediate !b)) (:ordered (!c) (!d)))";
  EXPECT_THAT(WrongOrder(network, {"(!c)", "(!a)", "(!b)", "(!d)"}, {2, 3, 1, 4}), IsEmpty());
  EXPECT_THAT(WrongOrder(network, {"(!a)", "(!c)", "(!b)", "(!d)"}, {1, 3, 2, 4}),
              ElementsAre("node 3 (!b): is immediate and could go on after 1 steps, but step 1 "
                          "(!c) came before it"));
}

TEST(ImmediateTest, OtherImmediateTasksMayComeFirst) {
  const std::string network = "(:unordered (:task :immediate !a) (:task :immediate !b) (!c))";
  EXPECT_THAT(WrongOrder(network, {"(!b)", "(!a)", "(!c)"}, {2, 1, 3}), IsEmpty());
  EXPECT_THAT(WrongOrder(network, {"(!b)", "(!c)", "(!a)"}, {3, 1, 2}),
              ElementsAre(HasSubstr("node 3 (!a): is immediate and could go on after 0 steps, but "
                                    "step 1 (!c)")));
}

TEST(ImmediateTest, TheFirstStepOfAnImmediateTaskIsImmediate) {
  const Domain domain = DomainOf(kLetters + "(:method (ab) () ((!a) (!b)))");
  const Problem problem = ProblemOf("()", "(:unordered (:task :immediate ab) (!c))");
  const auto plan_with_steps = [](const std::vector<std::string>& steps, int a, int b, int c) {
    Plan plan = FlatPlan(steps);
    plan.nodes.push_back(MethodNode("(ab)", 0, {a, b}, 0, 0, 0));
    plan.nodes[a].parent = plan.nodes[b].parent = 4;
    plan.nodes[0].children = {4, c};
    return plan;
  };
  EXPECT_THAT(ValidatePlan(domain, problem, plan_with_steps({"(!a)", "(!c)", "(!b)"}, 1, 3, 2)),
              IsEmpty());
  EXPECT_THAT(ValidatePlan(domain, problem, plan_with_steps({"(!c)", "(!a)", "(!b)"}, 2, 3, 1)),
              ElementsAre(HasSubstr("node 2 (!a): is immediate")));
}

// --------------------------------------------------------------------------------- protections

const std::string kGuards =
    "(:operator (!guard ?x) () () ((:protection (at ?x))))"
    "(:operator (!free ?x) () ((:protection (at ?x))) ())"
    "(:operator (!go ?x ?y) ((at ?x)) ((at ?x)) ((at ?y)))";

std::vector<std::string> WrongGuards(const std::vector<std::string>& steps) {
  return ValidatePlan(DomainOf(kGuards), FlatProblem("((at a))", steps), FlatPlan(steps));
}

TEST(ValidatorProtectionTest, AProtectedAtomMustNotGo) {
  EXPECT_THAT(WrongGuards({"(!guard a)", "(!go a b)"}),
              ElementsAre("step 1 (!go a b): the protected atom (at a) does not hold after it"));
  EXPECT_THAT(WrongGuards({"(!guard a)", "(!free a)", "(!go a b)"}), IsEmpty());
}

TEST(ValidatorProtectionTest, ProtectionsAreCounted) {
  EXPECT_THAT(WrongGuards({"(!guard a)", "(!guard a)", "(!free a)", "(!go a b)"}),
              ElementsAre(HasSubstr("step 3 (!go a b): the protected atom (at a)")));
  EXPECT_THAT(WrongGuards({"(!guard a)", "(!guard a)", "(!free a)", "(!free a)", "(!go a b)"}),
              IsEmpty());
}

TEST(ValidatorProtectionTest, WhatDoesNotHoldCannotBeProtected) {
  EXPECT_THAT(WrongGuards({"(!guard b)"}), ElementsAre(HasSubstr("the protected atom (at b)")));
}

TEST(ValidatorProtectionTest, AProblemMayBeginWithProtections) {
  Problem problem = FlatProblem("((at a))", {"(!go a b)"});
  problem.protections.push_back(TaskOf("(at a)"));
  EXPECT_THAT(ValidatePlan(DomainOf(kGuards), problem, FlatPlan({"(!go a b)"})),
              ElementsAre(HasSubstr("the protected atom (at a)")));
}

// ------------------------------------------------------------------------------------ with the
// search

TEST(ValidatePlanTest, VariablesThatLaterStepsBindFit) {
  const Domain domain = DomainOf(
      "(:operator (!find ?x) ((cup ?x)) () ()) (:operator (!fetch ?x) () () ())"
      "(:method (get) () ((!find ?x) (!fetch ?x)))");
  const Problem problem = ProblemOf("((cup red))", "((get))");
  EXPECT_THAT(ValidatePlan(domain, problem, FirstPlan(domain, problem)), IsEmpty());
}

TEST(ValidatePlanTest, AnEarlierBranchThatOnlyHoldsNowIsNoViolation) {
  // (not (have ?x)) fails while ?x is open, as (have c) is there; with ?x = d it would hold.
  const Domain domain = DomainOf(
      "(:operator (!give ?x) () () ())"
      "(:method (get ?x) ((not (have ?x))) () ((want ?x)) ((!give ?x)))"
      "(:method (any) () ((get ?x)))");
  const Problem problem = ProblemOf("((have c) (want d))", "((any))");
  const Plan plan = FirstPlan(domain, problem);
  ASSERT_EQ(plan.steps.size(), 1u);
  EXPECT_THAT(ValidatePlan(domain, problem, plan), IsEmpty());
}

TEST(ValidatePlanTest, CallsInTasksAreEvaluated) {
  const Domain domain = DomainOf(
      "(:operator (!wait ?n) () () () ?n)"
      "(:method (wait-twice ?n) () ((!wait ?n) (!wait (call + ?n 1))))");
  const Problem problem = ProblemOf("()", "((wait-twice 1))");
  Plan plan = FirstPlan(domain, problem);
  EXPECT_THAT(ValidatePlan(domain, problem, plan), IsEmpty());
  plan.steps[1].task = plan.nodes[plan.steps[1].node].task = TaskOf("(!wait 3)");
  EXPECT_THAT(ValidatePlan(domain, problem, plan),
              Contains(HasSubstr("its subtask (!wait 2) cannot be (!wait 3)")));
}

/// Every change to a valid plan that cannot leave it valid is noticed.
TEST(ValidatePlanTest, AStepThatIsExchangedIsNoticed) {
  const Domain domain = DomainOf(kCups);
  const Problem problem =
      ProblemOf("((on a counter) (on b counter))", "((serve a b) (carry a shelf))");
  const Plan valid = FirstPlan(domain, problem);
  ASSERT_THAT(ValidatePlan(domain, problem, valid), IsEmpty());
  for (std::size_t i = 0; i < valid.steps.size(); ++i) {
    for (std::size_t j = i + 1; j < valid.steps.size(); ++j) {
      Plan spoilt = valid;
      std::swap(spoilt.steps[i].task, spoilt.steps[j].task);
      EXPECT_FALSE(ValidatePlan(domain, problem, spoilt).empty()) << i << " " << j;
      std::swap(spoilt.nodes[spoilt.steps[i].node].task, spoilt.nodes[spoilt.steps[j].node].task);
      EXPECT_FALSE(ValidatePlan(domain, problem, spoilt).empty()) << i << " " << j;
    }
  }
}

/// One of the numbers that tie a plan together.
int* RandomIndex(Plan* plan, base::Rng* rng) {
  PlanNode& node = plan->nodes[rng->Index(static_cast<int>(plan->nodes.size()))];
  PlanStep& step = plan->steps[rng->Index(static_cast<int>(plan->steps.size()))];
  const std::vector<int*> all = {&node.parent, &node.step,    &node.method,
                                 &node.branch, &node.at_step, &step.node};
  const int choice = rng->Index(static_cast<int>(all.size()) + 1);
  if (choice < static_cast<int>(all.size())) return all[choice];
  return node.children.empty() ? &node.parent
                               : &node.children[rng->Index(static_cast<int>(node.children.size()))];
}

TEST(ValidatePlanTest, APlanThatHoldsTogetherNowhereIsToldSoWithoutHarm) {
  static constexpr int kValues[] = {-2000000000, -2, -1, 0, 1, 2, 3, 5, 6, 2000000000};
  int num_noticed = 0;
  for (int seed = 0; seed < 500; ++seed) {
    base::Rng rng(seed);
    Plan plan = CupPlan();
    for (int changes = 1 + rng.Index(3); changes > 0; --changes) {
      *RandomIndex(&plan, &rng) = kValues[rng.Index(10)];
    }
    num_noticed += Wrong(plan).empty() ? 0 : 1;
  }
  EXPECT_GT(num_noticed, 400);  // the others changed what is free, or nothing
}

// ----------------------------------------------------------------------------------- shared data

namespace fs = std::filesystem;

/// Plans of the search for an example, spoilt at random: what is broken is noticed.
void ExpectSpoiltPlansAreNoticed(const std::string& domain_file, const std::string& problem_file) {
  const fs::path folder = fs::path(HIRES_SHARED_DATA) / "htn";
  if (!fs::exists(folder)) GTEST_SKIP() << "no example problems in " << folder;
  const Domain domain = LoadDomain(folder / domain_file);
  const Problem problem = LoadProblems(folder / problem_file, domain).at(0);
  const Plan valid = FirstPlan(domain, problem);
  ASSERT_THAT(ValidatePlan(domain, problem, valid), IsEmpty());
  const int num_steps = static_cast<int>(valid.steps.size());
  for (int seed = 0; seed < 8; ++seed) {
    base::Rng rng(seed);
    const int i = rng.Index(num_steps);
    Plan dearer = valid;
    dearer.steps[i].cost += 1.0;
    EXPECT_EQ(ValidatePlan(domain, problem, dearer).size(), 2u);
    Plan renamed = valid;
    renamed.steps[i].task.items.back() = MakeSymbol("nowhere");
    EXPECT_FALSE(ValidatePlan(domain, problem, renamed).empty());
    Plan early = valid;
    std::swap(early.nodes[early.steps[i].node].step,
              early.nodes[early.steps[(i + 1) % num_steps].node].step);
    EXPECT_FALSE(ValidatePlan(domain, problem, early).empty());
  }
}

TEST(ValidateSharedPlansTest, Blocks) {
  ExpectSpoiltPlansAreNoticed("shop2/blocks.lisp", "shop2/blocks_100.lisp");
}
TEST(ValidateSharedPlansTest, Depots) {
  ExpectSpoiltPlansAreNoticed("shop2/depots.lisp", "shop2/depots_07.lisp");
}
TEST(ValidateSharedPlansTest, Logistics) {
  ExpectSpoiltPlansAreNoticed("shop2/logistics.lisp", "shop2/logistics_30_1.lisp");
}
TEST(ValidateSharedPlansTest, Tidy) {
  ExpectSpoiltPlansAreNoticed("hddl/tidy/domain.hddl", "hddl/tidy/tidy01.hddl");
}

}  // namespace
}  // namespace hires::planning::validator_test
