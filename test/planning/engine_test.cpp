#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hires/base/error.h"
#include "hires/planning/planner.h"
#include "planning/support/plan_text.h"

// Small cases worked by hand, one or more for each construct of the language. The helpers take the
// items of a domain, facts and tasks, as in (defdomain d (ITEMS)) and (defproblem p d FACTS TASKS).

namespace hires::planning::engine_test {
namespace {

using hires::test_support::AllPlans;
using hires::test_support::Solve;
using hires::test_support::Steps;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

/// Steps without condition and effect, that only show what came: (!show x), (!a), (!b), ...
const std::string kShow =
    "(:operator (!show ?x) () () ())"
    "(:operator (!a) () () ()) (:operator (!b) () () ())"
    "(:operator (!c) () () ()) (:operator (!d) () () ())";

/// (show-all) shows one thing of which (p ?x) holds: as many plans as there are, oldest fact first.
const std::string kShowAll = kShow + "(:method (show-all) ((p ?x)) ((!show ?x)))";

/// A method (t) with this precondition that shows ?x.
std::vector<std::string> ShowWhere(const std::string& precondition, const std::string& facts,
                                   const std::string& more = "") {
  return AllPlans(kShow + more + "(:method (t) " + precondition + " ((!show ?x)))", facts, "((t))");
}

/// Whether a precondition holds.
bool Holds(const std::string& precondition, const std::string& facts,
           const std::string& more = "") {
  return !AllPlans(kShow + more + "(:method (t) " + precondition + " ((!a)))", facts, "((t))")
              .empty();
}

/// The value of an expression, as it is printed.
std::string Value(const std::string& expression,
                  const Functions& functions = Functions::Standard()) {
  const auto plans = AllPlans(kShow + "(:method (t) ((assign ?x " + expression + ")) ((!show ?x)))",
                              "()", "((t))", functions);
  return plans.size() == 1 ? plans[0] : std::to_string(plans.size()) + " plans";
}

// ------------------------------------------------------------------------------------ operators

TEST(OperatorTest, AnEmptyTaskNetworkGivesOnePlanWithoutSteps) {
  const PlanResult result = Solve(kShow, "()", "()");
  EXPECT_EQ(result.outcome, PlanOutcome::kFound);
  ASSERT_EQ(result.plans.size(), 1u);
  EXPECT_THAT(result.plans[0].steps, IsEmpty());
  EXPECT_EQ(result.plans[0].cost, 0.0);
}

TEST(OperatorTest, CostsAreExpressionsAndOneWhereNothingIsSaid) {
  const PlanResult result = Solve(
      "(:operator (!pay ?n) ((rate ?r)) () () (* ?r ?n)) (:operator (!free) () () () 0)"
      "(:operator (!plain) () () ())",
      "((rate 0.5))", "((!pay 3) (!free) (!plain))");
  ASSERT_EQ(result.plans.size(), 1u);
  const Plan& plan = result.plans[0];
  EXPECT_EQ(plan.steps[0].cost, 1.5);
  EXPECT_EQ(plan.steps[1].cost, 0.0);
  EXPECT_EQ(plan.steps[2].cost, 1.0);
  EXPECT_EQ(plan.cost, 2.5);
}

TEST(OperatorTest, BookkeepingStepsAreStepsOfThePlan) {
  EXPECT_THAT(AllPlans("(:operator (!!note ?x) () () ((noted ?x)) 0)"
                       "(:operator (!use ?x) ((noted ?x)) () ())",
                       "()", "((!!note a) (!use a))"),
              ElementsAre("(!!note a) (!use a)"));
}

TEST(OperatorTest, OneBindingIsUsedTheNewestFact) {
  EXPECT_THAT(AllPlans("(:operator (!take ?x) ((p ?x)) ((p ?x)) ())"
                       "(:method (t) () ((!take ?x)))",
                       "((p a) (p b) (p c))", "((t))"),
              ElementsAre("(!take c)"));
}

TEST(OperatorTest, ItsPreconditionBindsVariablesOfLaterTasks) {
  EXPECT_THAT(AllPlans(kShow + "(:operator (!find ?x) ((p ?x) (big ?x)) () ())"
                               "(:method (t) () ((!find ?x) (twice ?x)))"
                               "(:method (twice ?y) () ((!show ?y) (!show ?y)))",
                       "((p a) (p b) (big a))", "((t))"),
              ElementsAre("(!find a) (!show a) (!show a)"));
}

TEST(OperatorTest, AMethodsPreconditionBindsVariablesOfItsTask) {
  EXPECT_THAT(AllPlans(kShow + "(:method (t) () ((choose ?x) (!show ?x)))"
                               "(:method (choose ?y) ((p ?y)) ((!a)))"
                               "(:method (choose z) () ((!b)))",
                       "((p a) (p b))", "((t))"),
              ElementsAre("(!a) (!show a)", "(!a) (!show b)", "(!b) (!show z)"));
}

TEST(OperatorTest, DeletesComeBeforeAdds) {
  EXPECT_THAT(AllPlans("(:operator (!renew) () ((p)) ((p))) (:operator (!need) ((p)) () ())",
                       "((p))", "((!renew) (!need))"),
              ElementsAre("(!renew) (!need)"));
}

TEST(OperatorTest, AnUnprovablePreconditionLeavesNoPlan) {
  const PlanResult result = Solve("(:operator (!need) ((p)) () ())", "((q))", "((!need))");
  EXPECT_EQ(result.outcome, PlanOutcome::kNoPlan);
  EXPECT_TRUE(result.exhausted);
  EXPECT_THAT(result.plans, IsEmpty());
}

TEST(OperatorTest, ArgumentsThatAreListsAreTakenApart) {
  EXPECT_THAT(AllPlans("(:operator (!put (?x ?y)) ((p ?x)) () ((at ?x ?y)))"
                       "(:operator (!need ?x ?y) ((at ?x ?y)) () ())",
                       "((p mug))", "((!put (mug table)) (!need mug table))"),
              ElementsAre("(!put (mug table)) (!need mug table)"));
}

TEST(OperatorTest, OneWithoutPreconditionSlotHasHeadDeletesAndAdds) {
  EXPECT_THAT(AllPlans("(:operator (!move ?x ?y) ((at ?x)) ((at ?y)))"
                       "(:operator (!here ?x) ((at ?x)) () ())"
                       "(:operator (!not-here ?x) ((not (at ?x))) () ())",
                       "((at a))", "((!move a b) (!here b) (!not-here a))"),
              ElementsAre("(!move a b) (!here b) (!not-here a)"));
}

// -------------------------------------------------------------------------- effects and the state

TEST(EffectTest, AVariableStandsForAWholeAddOrDeleteList) {
  EXPECT_THAT(AllPlans(kShowAll + "(:operator (!!assert ?g) () () ?g 0)"
                                  "(:operator (!!remove ?g) () ?g () 0)",
                       "((p old))", "((!!remove ((p old))) (!!assert ((p x) (q))) (show-all))"),
              ElementsAre("(!!remove ((p old))) (!!assert ((p x) (q))) (!show x)"));
}

TEST(EffectTest, AVariableStandsForAnAtomOfAList) {
  EXPECT_THAT(AllPlans(kShowAll + "(:operator (!!swap ?old ?new) (?old) (?new))", "((p a))",
                       "((!!swap (p a) (p b)) (show-all))"),
              ElementsAre("(!!swap (p a) (p b)) (!show b)"));
}

TEST(EffectTest, AForallTakesAwayAllThatMatch) {
  EXPECT_THAT(AllPlans(kShowAll + "(:operator (!clear) ((forall (?u) ((p ?u) (bad ?u)) ((p ?u))))"
                                  " ((cleared)))",
                       "((p a) (p b) (p c) (bad a) (bad c))", "((!clear) (show-all))"),
              ElementsAre("(!clear) (!show b)"));
}

TEST(EffectTest, AForallAddsForAllThatMatchedBefore) {
  EXPECT_THAT(AllPlans(kShowAll + "(:operator (!mark) ((q a)) ((forall (?u) ((q ?u)) ((p ?u)))))",
                       "((q a) (q b))", "((!mark) (show-all))"),
              UnorderedElementsAre("(!mark) (!show a)", "(!mark) (!show b)"));
}

TEST(EffectTest, AddsAreMadeInReverseOrderOfListing) {
  EXPECT_THAT(AllPlans(kShowAll + "(:operator (!add) () () ((p a) (p b) (p c)))", "()",
                       "((!add) (show-all))"),
              ElementsAre("(!add) (!show c)", "(!add) (!show b)", "(!add) (!show a)"));
}

TEST(EffectTest, AddingAFactThatHoldsKeepsItsAge) {
  EXPECT_THAT(AllPlans(kShowAll + "(:operator (!add) () () ((p a)))", "((p a) (p b))",
                       "((!add) (show-all))"),
              ElementsAre("(!add) (!show a)", "(!add) (!show b)"));
}

TEST(EffectTest, DeletingAndAddingAFactMakesItTheNewest) {
  EXPECT_THAT(AllPlans(kShowAll + "(:operator (!renew) () ((p a)) ((p a)))", "((p a) (p b))",
                       "((!renew) (show-all))"),
              ElementsAre("(!renew) (!show b)", "(!renew) (!show a)"));
}

TEST(EffectTest, AFactThatIsListedTwiceCountsOnce) {
  EXPECT_THAT(AllPlans(kShowAll, "((p a) (p b) (p a))", "((show-all))"),
              ElementsAre("(!show a)", "(!show b)"));
}

TEST(EffectTest, OneBranchOfTheSearchDoesNotSeeTheEffectsOfAnother) {
  const std::string items = kShow +
                            "(:operator (!drop ?x) () ((p ?x)) ((gone ?x)))"
                            "(:method (t) ((p ?x)) ((!drop ?x) (rest)))"
                            "(:method (rest) ((p ?y)) ((!show ?y)))";
  EXPECT_THAT(AllPlans(items, "((p a) (p b) (p c))", "((t))"),
              ElementsAre("(!drop a) (!show b)", "(!drop a) (!show c)", "(!drop b) (!show a)",
                          "(!drop b) (!show c)", "(!drop c) (!show a)", "(!drop c) (!show b)"));
}

// ----------------------------------------------------------------------------------- protections

const std::string kProtect =
    "(:operator (!protect ?g) () ((:protection ?g)) 0)"
    "(:operator (!release ?g) ((:protection ?g)) () 0)"
    "(:operator (!lose) ((p)) ()) (:operator (!get) () ((p))) (:operator (!a) () ())";

TEST(ProtectionTest, AStepThatTakesAwayAProtectedFactIsRefused) {
  EXPECT_THAT(AllPlans(kProtect, "((p))", "((!protect (p)) (!lose))"), IsEmpty());
  EXPECT_THAT(AllPlans(kProtect, "((p))", "((!protect (p)) (!a))"),
              ElementsAre("(!protect (p)) (!a)"));
}

TEST(ProtectionTest, WhatIsReleasedMayGo) {
  EXPECT_THAT(AllPlans(kProtect, "((p))", "((!protect (p)) (!release (p)) (!lose))"),
              ElementsAre("(!protect (p)) (!release (p)) (!lose)"));
}

TEST(ProtectionTest, ProtectionsAreCounted) {
  EXPECT_THAT(AllPlans(kProtect, "((p))", "((!protect (p)) (!protect (p)) (!release (p)) (!lose))"),
              IsEmpty());
  EXPECT_EQ(AllPlans(kProtect, "((p))",
                     "((!protect (p)) (!protect (p)) (!release (p)) (!release (p)) (!lose))")
                .size(),
            1u);
}

TEST(ProtectionTest, ReleasingWhatIsNotProtectedChangesNothing) {
  EXPECT_EQ(
      AllPlans(kProtect, "((p))", "((!release (p)) (!protect (p)) (!release (p)) (!lose))").size(),
      1u);
  EXPECT_THAT(AllPlans(kProtect, "((p))", "((!release (p)) (!protect (p)) (!lose))"), IsEmpty());
}

TEST(ProtectionTest, AStepMayTakeAProtectedFactAwayAndBringItBack) {
  EXPECT_EQ(
      AllPlans(kProtect + "(:operator (!touch) ((p)) ((p)))", "((p))", "((!protect (p)) (!touch))")
          .size(),
      1u);
}

TEST(ProtectionTest, AStepMayReleaseAndTakeAwayAtOnce) {
  EXPECT_EQ(AllPlans(kProtect + "(:operator (!end) ((p) (:protection (p))) ())", "((p))",
                     "((!protect (p)) (!end))")
                .size(),
            1u);
}

TEST(ProtectionTest, OnlyOrdersThatKeepWhatIsProtectedAreFound) {
  EXPECT_THAT(AllPlans(kProtect, "((p))",
                       "(:unordered (:ordered (!protect (p)) (!a) (!release (p))) (!lose))"),
              UnorderedElementsAre("(!protect (p)) (!a) (!release (p)) (!lose)"));
}

TEST(ProtectionTest, WhatAxiomsProveIsProtectedToo) {
  const std::string items = kProtect +
                            "(:- (safe) ((not (fire)))) (:operator (!light) () ((fire)))"
                            "(:operator (!smoke) () ((smoke)))";
  EXPECT_THAT(AllPlans(items, "()", "((!protect (safe)) (!light))"), IsEmpty());
  EXPECT_EQ(AllPlans(items, "()", "((!protect (safe)) (!smoke))").size(), 1u);
}

// --------------------------------------------------------------------------------------- methods

TEST(MethodTest, TheFirstBranchThatHoldsIsTheOnlyOne) {
  const std::string items = kShow + "(:method (t) ((p)) ((!a)) ((q)) ((!b)) () ((!c)))";
  EXPECT_THAT(AllPlans(items, "((p) (q))", "((t))"), ElementsAre("(!a)"));
  EXPECT_THAT(AllPlans(items, "((q))", "((t))"), ElementsAre("(!b)"));
  EXPECT_THAT(AllPlans(items, "()", "((t))"), ElementsAre("(!c)"));
}

TEST(MethodTest, ABranchThatHoldsButLeadsNowhereIsNotReplacedByTheNext) {
  EXPECT_THAT(AllPlans(kShow + "(:operator (!fail) ((never)) () ())"
                               "(:method (t) ((p)) ((!a) (!fail)) () ((!b)))",
                       "((p))", "((t))"),
              IsEmpty());
}

TEST(MethodTest, AllMethodsOfATaskAreTriedInTheirOrder) {
  EXPECT_THAT(AllPlans(kShow + "(:method (t) two ((p)) ((!b))) (:method (t) () ((!a)))"
                               "(:method (t) ((q)) ((!c)))",
                       "((p))", "((t))"),
              ElementsAre("(!b)", "(!a)"));
}

TEST(MethodTest, TheDecompositionNamesMethodBranchAndLabel) {
  const PlanResult result =
      Solve(kShow + "(:method (t ?x) one ((p ?x)) ((!a)) two () ((!show ?x)))", "()", "((t mug))");
  ASSERT_EQ(result.plans.size(), 1u);
  const Plan& plan = result.plans[0];
  ASSERT_EQ(plan.nodes.size(), 3u);
  EXPECT_EQ(plan.nodes[0].children, std::vector<int>{1});
  EXPECT_EQ(ToString(plan.nodes[1].task), "(t mug)");
  EXPECT_EQ(plan.nodes[1].method, 0);
  EXPECT_EQ(plan.nodes[1].branch, 1);
  EXPECT_EQ(plan.nodes[1].label, "two");
  EXPECT_EQ(plan.nodes[1].children, std::vector<int>{2});
  EXPECT_EQ(plan.nodes[2].parent, 1);
  EXPECT_EQ(plan.nodes[2].step, 0);
  EXPECT_EQ(plan.steps[0].node, 2);
}

TEST(MethodTest, AHeadMatchesOnlyItsConstants) {
  const std::string items =
      kShow + "(:method (t a ?x) () ((!a))) (:method (t b ?x) () ((!b) (!show ?x)))";
  EXPECT_THAT(AllPlans(items, "()", "((t b mug))"), ElementsAre("(!b) (!show mug)"));
  EXPECT_THAT(AllPlans(items, "()", "((t c mug))"), IsEmpty());
}

TEST(MethodTest, AVariableTwiceInAHeadStandsForOneThing) {
  const std::string items = kShow + "(:method (t ?x ?x) () ((!a)))";
  EXPECT_EQ(AllPlans(items, "()", "((t mug mug))").size(), 1u);
  EXPECT_EQ(AllPlans(items, "()", "((t mug cup))").size(), 0u);
}

TEST(MethodTest, TwoUsesOfAMethodHaveVariablesOfTheirOwn) {
  EXPECT_THAT(AllPlans(kShow + "(:method (t ?n) ((p ?n ?x)) ((!show ?x)))", "((p 1 a) (p 2 b))",
                       "((t 1) (t 2))"),
              ElementsAre("(!show a) (!show b)"));
}

// ----------------------------------------------------------------------------- order of bindings

TEST(BindingOrderTest, AMethodTriesTheOldestFactFirst) {
  EXPECT_THAT(ShowWhere("((p ?x))", "((p a) (p b) (p c))"),
              ElementsAre("(!show a)", "(!show b)", "(!show c)"));
  EXPECT_THAT(ShowWhere("(p ?x)", "((p a) (p b))"), ElementsAre("(!show a)", "(!show b)"));
}

TEST(BindingOrderTest, SeveralGoalsAreOldestFirstEach) {
  EXPECT_THAT(ShowWhere("((p ?u) (q ?v) (assign ?x (list '?u '?v)))", "((p a) (p b) (q 1) (q 2))"),
              ElementsAre("(!show (a 1))", "(!show (a 2))", "(!show (b 1))", "(!show (b 2))"));
}

TEST(BindingOrderTest, FirstTakesTheNewestFact) {
  EXPECT_THAT(ShowWhere("(:first (p ?x))", "((p a) (p b) (p c))"), ElementsAre("(!show c)"));
  EXPECT_THAT(ShowWhere("(:first (p ?x) (q ?x))", "((p a) (p b) (p c) (q a) (q b))"),
              ElementsAre("(!show b)"));
}

TEST(BindingOrderTest, AnExplicitAndIsTheOtherWayRound) {
  EXPECT_THAT(ShowWhere("(and (p ?x))", "((p a) (p b) (p c))"),
              ElementsAre("(!show c)", "(!show b)", "(!show a)"));
  EXPECT_THAT(ShowWhere("(:first (and (p ?x)))", "((p a) (p b) (p c))"), ElementsAre("(!show a)"));
}

TEST(BindingOrderTest, AnOperatorWithAnExplicitAndTakesTheOldestFact) {
  EXPECT_THAT(AllPlans("(:operator (!take ?x) (and (p ?x) (q ?x)) () ())"
                       "(:method (t) () ((!take ?x)))",
                       "((p a) (p b) (p c) (q b) (q c))", "((t))"),
              ElementsAre("(!take b)"));
}

TEST(BindingOrderTest, FactsComeBeforeAxioms) {
  EXPECT_THAT(ShowWhere("((p ?x))", "((q a) (p b))", "(:- (p ?x) ((q ?x)))"),
              ElementsAre("(!show b)", "(!show a)"));
  EXPECT_THAT(ShowWhere("(:first (p ?x))", "((p b) (q a))", "(:- (p ?x) ((q ?x)))"),
              ElementsAre("(!show b)"));
}

TEST(BindingOrderTest, BindingsThatLeadToTheSameSubtasksAreOne) {
  EXPECT_EQ(
      AllPlans(kShow + "(:method (t) ((p ?u)) ((!a)))", "((p a) (p b) (p c))", "((t))").size(), 1u);
  EXPECT_THAT(ShowWhere("((q ?u ?x))", "((q 1 a) (q 2 a) (q 1 b))"),
              ElementsAre("(!show a)", "(!show b)"));
}

TEST(BindingOrderTest, SortByTakesAConditionWithoutVariables) {
  EXPECT_TRUE(Holds("(:sort-by 1 ((p a)))", "((p a))"));
  EXPECT_FALSE(Holds("(:sort-by 1 ((p a)))", "()"));
  EXPECT_THAT(AllPlans("(:operator (!step) (:sort-by 1 ((p))) () ())", "((p))", "((!step))"),
              ElementsAre("(!step)"));
}

TEST(BindingOrderTest, SortByGivesAnOperatorTheSmallestKey) {
  EXPECT_THAT(AllPlans("(:operator (!take ?x) (:sort-by ?n ((size ?x ?n))) () ())"
                       "(:method (t) () ((!take ?x)))",
                       "((size a 3) (size b 1) (size c 2))", "((t))"),
              ElementsAre("(!take b)"));
}

TEST(BindingOrderTest, SortByPutsTheSmallestKeyFirst) {
  const std::string facts = "((size a 3) (size b 1) (size c 2))";
  EXPECT_THAT(ShowWhere("(:sort-by ?n ((size ?x ?n)))", facts),
              ElementsAre("(!show b)", "(!show c)", "(!show a)"));
  EXPECT_THAT(ShowWhere("(:sort-by ?n #'> ((size ?x ?n)))", facts),
              ElementsAre("(!show a)", "(!show c)", "(!show b)"));
  EXPECT_THAT(ShowWhere("(:sort-by (abs (- ?n 2)) ((size ?x ?n)))", facts),
              ElementsAre("(!show c)", "(!show a)", "(!show b)"));
}

TEST(BindingOrderTest, SortByLeavesEqualKeysInTheirOrder) {
  EXPECT_THAT(ShowWhere("(:sort-by ?n ((size ?x ?n)))", "((size a 1) (size b 0) (size c 1.0))"),
              ElementsAre("(!show b)", "(!show a)", "(!show c)"));
}

// --------------------------------------------------------------------------------- task networks

/// Two tasks of two steps each.
const std::string kPairs = kShow + "(:method (ab) () ((!a) (!b))) (:method (cd) () ((!c) (!d)))";

TEST(TaskNetworkTest, OrderedTasksComeInTheirOrder) {
  EXPECT_THAT(AllPlans(kPairs, "()", "(:ordered (cd) (ab))"), ElementsAre("(!c) (!d) (!a) (!b)"));
  EXPECT_THAT(AllPlans(kPairs, "()", "((cd) (ab))"), ElementsAre("(!c) (!d) (!a) (!b)"));
}

TEST(TaskNetworkTest, UnorderedTasksAreInterleavedInEveryWayOnce) {
  EXPECT_THAT(
      AllPlans(kPairs, "()", "(:unordered (ab) (cd))"),
      UnorderedElementsAre("(!a) (!b) (!c) (!d)", "(!a) (!c) (!b) (!d)", "(!a) (!c) (!d) (!b)",
                           "(!c) (!a) (!b) (!d)", "(!c) (!a) (!d) (!b)", "(!c) (!d) (!a) (!b)"));
}

TEST(TaskNetworkTest, TasksAreTakenInTheOrderInWhichTheyBecomeReady) {
  EXPECT_THAT(Steps(Solve(kShow, "()", "(:unordered (!c) (!a) (!b))")),
              ElementsAre("(!c) (!a) (!b)"));
  // (!b) gets ready when (cd) has long been so.
  EXPECT_THAT(Steps(Solve(kPairs, "()", "(:unordered (ab) (cd))")),
              ElementsAre("(!a) (!c) (!b) (!d)"));
}

TEST(TaskNetworkTest, TwoMethodsDoubleTheInterleavings) {
  EXPECT_EQ(
      AllPlans(kPairs + "(:method (ab) () ((!b) (!a)))", "()", "(:unordered (ab) (cd))").size(),
      12u);
}

TEST(TaskNetworkTest, NetworksNest) {
  EXPECT_THAT(AllPlans(kShow, "()", "(:ordered (:unordered (!a) (!b)) (!c))"),
              UnorderedElementsAre("(!a) (!b) (!c)", "(!b) (!a) (!c)"));
  EXPECT_THAT(AllPlans(kShow, "()", "(:unordered (:ordered (!a) (!b)) (!c))"),
              UnorderedElementsAre("(!a) (!b) (!c)", "(!a) (!c) (!b)", "(!c) (!a) (!b)"));
}

TEST(TaskNetworkTest, ImmediateTasksComeBeforeAllOthersThatAreReady) {
  EXPECT_THAT(AllPlans(kShow, "()", "(:unordered (!a) (:task :immediate !b) (!c))"),
              UnorderedElementsAre("(!b) (!a) (!c)", "(!b) (!c) (!a)"));
  EXPECT_THAT(AllPlans(kShow, "()", "(:unordered (:ordered (!a) (:task :immediate !b)) (!c))"),
              UnorderedElementsAre("(!a) (!b) (!c)", "(!c) (!a) (!b)"));
}

TEST(TaskNetworkTest, AnImmediateTaskPassesItsHasteToOneFirstSubtask) {
  EXPECT_THAT(
      AllPlans(kShow + "(:method (t) () (:unordered (!a) (!b)))", "()",
               "(:unordered (!c) (:task :immediate t))"),
      UnorderedElementsAre("(!a) (!b) (!c)", "(!a) (!c) (!b)", "(!b) (!a) (!c)", "(!b) (!c) (!a)"));
}

TEST(TaskNetworkTest, AnImmediateSubtaskOfAReductionIsTheOnlyOneToGoOn) {
  EXPECT_THAT(
      AllPlans(kShow + "(:method (t) () (:unordered (!a) (:task :immediate !b)))", "()", "((t))"),
      ElementsAre("(!b) (!a)"));
}

TEST(TaskNetworkTest, EmptyReductionsLeaveNoStep) {
  const std::string items = kShow + "(:method (nothing) () ())";
  EXPECT_THAT(AllPlans(items, "()", "((nothing) (!a) (nothing))"), ElementsAre("(!a)"));
  EXPECT_THAT(AllPlans(items, "()", "((nothing))"), ElementsAre(""));
}

TEST(TaskNetworkTest, EmptyNetworksInNetworksLeaveNoStep) {
  EXPECT_THAT(AllPlans(kShow, "()", "(:unordered (:ordered) (!a))"), ElementsAre("(!a)"));
  EXPECT_THAT(AllPlans(kShow, "()", "((:unordered) (!a) (:ordered (:unordered) ()) (!b))"),
              ElementsAre("(!a) (!b)"));
  EXPECT_THAT(
      AllPlans(kShow + "(:method (t) () (:unordered () (!a)))", "()", "(:unordered (t) (!b))"),
      UnorderedElementsAre("(!a) (!b)", "(!b) (!a)"));
}

TEST(TaskNetworkTest, WhenATaskWasFoundToNeedNoStepMakesNoOtherPlan) {
  EXPECT_THAT(AllPlans(kShow + "(:method (nothing) () ())", "()",
                       "(:unordered (nothing) (:ordered (!a) (!b)))"),
              ElementsAre("(!a) (!b)"));
}

TEST(TaskNetworkTest, TheSameStepsByOtherBranchesAreOtherPlans) {
  EXPECT_THAT(AllPlans(kShow + "(:method (t) () ((!a))) (:method (t) () ((u)))"
                               "(:method (u) () ((!a)))",
                       "()", "((t))"),
              ElementsAre("(!a)", "(!a)"));
}

TEST(TaskNetworkTest, TheStateOfAnUnorderedTaskIsThatOfItsMoment) {
  const std::string items = kShow +
                            "(:operator (!set) () () ((p)))"
                            "(:method (t) ((p)) ((!a)) () ((!b)))";
  EXPECT_THAT(AllPlans(items, "()", "(:unordered (!set) (t))"),
              UnorderedElementsAre("(!set) (!a)", "(!b) (!set)"));
}

TEST(TaskNetworkTest, PlansOfThousandsOfStepsAreNoTroubleForTheStack) {
  const PlanResult result =
      Solve(kShow +
                "(:method (count 0) () ())"
                "(:method (count ?n) ((call > ?n 0)) ((!a) (count (call - ?n 1))))",
            "()", "((count 50000))");
  ASSERT_EQ(result.outcome, PlanOutcome::kFound);
  EXPECT_EQ(result.plans[0].steps.size(), 50000u);
}

// ----------------------------------------------------------------------------------------- logic

TEST(LogicTest, NotHoldsWhereNothingMatches) {
  EXPECT_TRUE(Holds("((not (p a)))", "((p b))"));
  EXPECT_FALSE(Holds("((not (p b)))", "((p b))"));
  EXPECT_FALSE(Holds("((not (p ?any)))", "((p b))"));
  EXPECT_TRUE(Holds("((not (p ?any)))", "((q b))"));
  EXPECT_TRUE(Holds("((not (not (p b))))", "((p b))"));
}

TEST(LogicTest, NotBindsNothing) {
  EXPECT_THAT(ShowWhere("((not (not (p ?x))) (q ?x))", "((p a) (q b))"), ElementsAre("(!show b)"));
}

TEST(LogicTest, AndHoldsWhereAllPartsDo) {
  EXPECT_TRUE(Holds("(and (p a) (q b))", "((p a) (q b))"));
  EXPECT_FALSE(Holds("(and (p a) (q b))", "((p a) (q c))"));
  EXPECT_TRUE(Holds("(and)", "()"));
}

TEST(LogicTest, OrHoldsWhereOnePartDoes) {
  EXPECT_TRUE(Holds("((or (p a) (q b)))", "((q b))"));
  EXPECT_FALSE(Holds("((or (p a) (q b)))", "((q a))"));
  EXPECT_THAT(ShowWhere("((or (p ?x) (q ?x)))", "((p a) (q b) (r c))"),
              UnorderedElementsAre("(!show a)", "(!show b)"));
}

TEST(LogicTest, ImplyHoldsWhereTheFirstDoesNotOrTheSecondDoes) {
  EXPECT_TRUE(Holds("((imply (p a) (q a)))", "()"));
  EXPECT_TRUE(Holds("((imply (p a) (q a)))", "((p a) (q a))"));
  EXPECT_FALSE(Holds("((imply (p a) (q a)))", "((p a))"));
}

TEST(LogicTest, ForallHoldsWhereEveryBindingOfTheFirstSatisfiesTheSecond) {
  const std::string all_clean = "((forall (?c) ((cup ?c)) ((clean ?c))))";
  EXPECT_TRUE(Holds(all_clean, "((cup a) (cup b) (clean a) (clean b))"));
  EXPECT_FALSE(Holds(all_clean, "((cup a) (cup b) (clean a))"));
  EXPECT_TRUE(Holds(all_clean, "((clean a))"));
}

TEST(LogicTest, ForallSeesVariablesThatAreBoundOutside) {
  EXPECT_THAT(ShowWhere("((table ?x) (forall (?c) ((on ?c ?x)) ((clean ?c))))",
                        "((table t1) (table t2) (table t3) (on a t1) (on b t2) (clean b))"),
              ElementsAre("(!show t2)", "(!show t3)"));
}

TEST(LogicTest, ExistsHoldsWhereOneBindingOfTheFirstSatisfiesTheSecond) {
  const std::string one_clean = "((exists (?c) ((cup ?c)) ((clean ?c))))";
  EXPECT_TRUE(Holds(one_clean, "((cup a) (cup b) (clean b))"));
  EXPECT_FALSE(Holds(one_clean, "((cup a) (clean b))"));
}

TEST(LogicTest, AssignBindsAVariableOrComparesItsValue) {
  EXPECT_THAT(ShowWhere("((p ?n) (assign ?x (+ ?n 1)))", "((p 1) (p 5))"),
              ElementsAre("(!show 2)", "(!show 6)"));
  EXPECT_TRUE(Holds("((p ?n) (assign ?n (+ 1 1)))", "((p 2))"));
  EXPECT_FALSE(Holds("((p ?n) (assign ?n (+ 1 1)))", "((p 3))"));
}

TEST(LogicTest, AssignEachBindsAVariableToEachMember) {
  EXPECT_THAT(ShowWhere("((assign* ?x '(1 2 3)))", "()"),
              UnorderedElementsAre("(!show 1)", "(!show 2)", "(!show 3)"));
  EXPECT_THAT(ShowWhere("((assign* ?x '(1 2 3)) (p ?x))", "((p 2) (p 4))"),
              ElementsAre("(!show 2)"));
  EXPECT_FALSE(Holds("((assign* ?x nil))", "()"));
}

TEST(LogicTest, CallAndEvalHoldWhereTheValueIsNotNil) {
  EXPECT_TRUE(Holds("((p ?n) (call > ?n 3))", "((p 4))"));
  EXPECT_FALSE(Holds("((p ?n) (call > ?n 3))", "((p 3))"));
  EXPECT_TRUE(Holds("((p ?n) (eval (and (> ?n 3) (evenp ?n))))", "((p 4))"));
  EXPECT_FALSE(Holds("((p ?n) (eval (and (> ?n 3) (evenp ?n))))", "((p 5))"));
}

TEST(LogicTest, SetofGivesAllOnceAndFailsWhereThereAreNone) {
  EXPECT_THAT(ShowWhere("((setof ?u (p ?u ?n) ?x))", "((p a 1) (p b 1) (p a 2))"),
              ElementsAre("(!show (a b))"));
  EXPECT_FALSE(Holds("((setof ?u (p ?u ?n) ?all))", "((q a))"));
}

TEST(LogicTest, SetofMayGatherTerms) {
  EXPECT_THAT(ShowWhere("((setof (at ?u ?n) (p ?u ?n) ?x))", "((p a 1) (p b 2))"),
              ElementsAre("(!show ((at a 1) (at b 2)))"));
}

TEST(LogicTest, AVariableStandsForAGoal) {
  EXPECT_THAT(AllPlans(kShow + "(:method (check ?g) (?g) ((!a)) () ((!b)))", "((p a) (on b c))",
                       "((check (on b c)) (check (p c)))"),
              ElementsAre("(!a) (!b)"));
}

// ---------------------------------------------------------------------------------------- axioms

TEST(AxiomTest, TheFirstBranchThatHoldsIsTheOnlyOne) {
  const std::string axiom = "(:- (best ?x) gold ((gold ?x)) silver ((silver ?x)))";
  EXPECT_THAT(ShowWhere("((best ?x))", "((silver a) (silver b))", axiom),
              ElementsAre("(!show a)", "(!show b)"));
  EXPECT_THAT(ShowWhere("((best ?x))", "((silver a) (gold c))", axiom), ElementsAre("(!show c)"));
}

TEST(AxiomTest, SeveralAxiomsOfAHeadAllCount) {
  const std::string axioms = "(:- (good ?x) ((gold ?x))) (:- (good ?x) ((silver ?x)))";
  EXPECT_THAT(ShowWhere("((good ?x))", "((silver a) (gold c))", axioms),
              UnorderedElementsAre("(!show a)", "(!show c)"));
}

TEST(AxiomTest, AxiomsMayUseThemselves) {
  const std::string axiom = "(:- (above ?x ?y) ((on ?x ?y)) ((on ?x ?z) (above ?z ?y)))";
  const std::string facts = "((on a b) (on b c) (on c d))";
  EXPECT_TRUE(Holds("((above a d))", facts, axiom));
  EXPECT_FALSE(Holds("((above d a))", facts, axiom));
}

TEST(AxiomTest, SameAndDifferentAreOrdinaryAxioms) {
  const std::string axioms = "(:- (same ?x ?x) nil) (:- (different ?x ?y) ((not (same ?x ?y))))";
  EXPECT_TRUE(Holds("((same mug mug))", "()", axioms));
  EXPECT_FALSE(Holds("((same mug cup))", "()", axioms));
  EXPECT_THAT(ShowWhere("((p ?x) (p ?y) (different ?x ?y))", "((p a) (p b))", axioms),
              ElementsAre("(!show a)", "(!show b)"));
  EXPECT_THAT(ShowWhere("((same ?x mug))", "()", axioms), ElementsAre("(!show mug)"));
}

TEST(AxiomTest, QuotedVariablesStandForTheirValues) {
  const std::string axiom = "(:- (different ?x ?y) ((eval (not (eq '?x '?y)))))";
  EXPECT_TRUE(Holds("((different mug cup))", "()", axiom));
  EXPECT_FALSE(Holds("((different mug mug))", "()", axiom));
}

TEST(AxiomTest, EqualityHasNoMeaningOfItsOwn) {
  EXPECT_FALSE(Holds("((= a a))", "()"));
  EXPECT_TRUE(Holds("((= a a))", "((= a a))"));
}

TEST(AxiomTest, AGoalOfAnAxiomMayBeAVariable) {
  const std::string axioms =
      "(:- (all-true nil) nil)"
      "(:- (all-true (?g . ?rest)) (and ?g (all-true ?rest)))";
  const std::string facts = "((p a) (on b c))";
  EXPECT_TRUE(Holds("((all-true ((p a) (on b c))))", facts, axioms));
  EXPECT_FALSE(Holds("((all-true ((p a) (on b a))))", facts, axioms));
}

// --------------------------------------------------------------------------------- terms and Lisp

TEST(TermTest, DottedListsTakeTheFirstAndTheRest) {
  EXPECT_THAT(AllPlans(kShow + "(:method (each nil) () ())"
                               "(:method (each (?g . ?gs)) () ((!show ?g) (each ?gs)))",
                       "()", "((each (a (b c) 3)))"),
              ElementsAre("(!show a) (!show (b c)) (!show 3)"));
}

TEST(TermTest, ListsAreBuiltInTasks) {
  EXPECT_THAT(AllPlans(kShow + "(:method (turn (?g . ?gs) ?out) () ((turn ?gs (?g . ?out))))"
                               "(:method (turn nil ?out) () ((!show ?out)))",
                       "()", "((turn (a b c) nil))"),
              ElementsAre("(!show (c b a))"));
}

TEST(TermTest, FactsMayHoldLists) {
  EXPECT_THAT(ShowWhere("((goal (on ?x ?any)))", "((goal (on a b)) (goal (clear c)))"),
              ElementsAre("(!show a)"));
  EXPECT_THAT(ShowWhere("((goal (on . ?x)))", "((goal (on a b)) (goal (clear c)))"),
              ElementsAre("(!show (a b))"));
}

TEST(TermTest, NumbersAreComparedByTypeAndValue) {
  EXPECT_TRUE(Holds("((p 1))", "((p 1))"));
  EXPECT_TRUE(Holds("((p 0.5))", "((p 0.5))"));
  EXPECT_FALSE(Holds("((p 1))", "((p 2))"));
  EXPECT_FALSE(Holds("((p 1))", "((p 1.0))"));  // as terms; (= 1 1.0) calls them equal
}

TEST(TermTest, CallsInTasksAreEvaluated) {
  EXPECT_THAT(AllPlans(kShow + "(:method (t ?n) () ((!show (call + ?n 1))))", "()", "((t 4))"),
              ElementsAre("(!show 5)"));
}

TEST(ExpressionTest, FormsOfLispGiveTheirValues) {
  EXPECT_EQ(Value("(if (> 2 1) 'yes 'no)"), "(!show yes)");
  EXPECT_EQ(Value("(cond ((> 1 2) 'a) ((> 2 1) 'b) (t 'c))"), "(!show b)");
  EXPECT_EQ(Value("(let ((u 2) (v 3)) (* u v))"), "(!show 6)");
  EXPECT_EQ(Value("'(a b (c))"), "(!show (a b (c)))");
  EXPECT_EQ(Value("`(a ,(+ 1 2))"), "(!show (a 3))");
  EXPECT_EQ(Value("(cons 'a '(b))"), "(!show (a b))");
  EXPECT_EQ(Value("(/ 10 4)"), "(!show 2.5)");
}

TEST(ExpressionTest, FunctionsWrittenInCppAreCalledByName) {
  Functions functions = Functions::Standard();
  functions.Add("distance", 2, 2, [](TermTable* terms, const std::vector<Term>& arguments) {
    return terms->Real(terms->number(arguments[1]) - terms->number(arguments[0]));
  });
  EXPECT_EQ(Value("(distance 1.5 4)", functions), "(!show 2.5)");
  PlanRequest request;
  const PlanResult result = Solve("(:operator (!drive ?x ?y) () () () (distance ?x ?y))", "()",
                                  "((!drive 1 4))", request, functions);
  ASSERT_EQ(result.plans.size(), 1u);
  EXPECT_EQ(result.plans[0].cost, 3.0);
}

TEST(ExpressionTest, UnknownFunctionsAreNamed) {
  try {
    Value("(distanse 1 2)");
    FAIL() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("distanse"));
  }
}

TEST(ExpressionTest, AFunctionThatRefusesItsArgumentsIsNamedWithItsPlace) {
  try {
    Value("(+ 1 'mug)");
    FAIL() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("domain:1:"));
    EXPECT_THAT(error.what(), HasSubstr("mug"));
  }
}

// ----------------------------------------------------------------------- first, all, best, limits

/// Three ways at the costs 4, 2 and 3.
const std::string kWays =
    "(:operator (!dear) () () () 4) (:operator (!cheap) () () () 2)"
    "(:operator (!fair) () () () 3)"
    "(:method (go) () ((!dear))) (:method (go) () ((!cheap))) (:method (go) () ((!fair)))";

TEST(WhichTest, FirstIsTheFirstAllAreAllAndBestIsTheCheapest) {
  PlanRequest request;
  EXPECT_THAT(Steps(Solve(kWays, "()", "((go))", request)), ElementsAre("(!dear)"));
  request.which = Which::kAll;
  EXPECT_THAT(Steps(Solve(kWays, "()", "((go))", request)),
              ElementsAre("(!dear)", "(!cheap)", "(!fair)"));
  request.which = Which::kBest;
  const PlanResult best = Solve(kWays, "()", "((go) (go))", request);
  EXPECT_THAT(Steps(best), ElementsAre("(!cheap) (!cheap)"));
  EXPECT_EQ(best.plans[0].cost, 4.0);
  EXPECT_TRUE(best.exhausted);
}

TEST(LimitTest, MaxPlansEndsTheSearchThere) {
  PlanRequest request;
  request.which = Which::kAll;
  request.max_plans = 2;
  const PlanResult result = Solve(kWays, "()", "((go))", request);
  EXPECT_THAT(Steps(result), ElementsAre("(!dear)", "(!cheap)"));
  EXPECT_EQ(result.outcome, PlanOutcome::kFound);
  EXPECT_FALSE(result.exhausted);
}

TEST(LimitTest, MaxCostGivesUpDearerPaths) {
  PlanRequest request;
  request.which = Which::kAll;
  request.max_cost = 3.0;
  EXPECT_THAT(Steps(Solve(kWays, "()", "((go))", request)), ElementsAre("(!cheap)", "(!fair)"));
  request.max_cost = 1.0;
  const PlanResult none = Solve(kWays, "()", "((go))", request);
  EXPECT_EQ(none.outcome, PlanOutcome::kLimitCost);
  EXPECT_FALSE(none.exhausted);
}

TEST(LimitTest, MaxDepthGivesUpLongerPaths) {
  PlanRequest request;
  request.max_depth = 4;  // two decompositions and two steps
  EXPECT_EQ(Solve(kWays, "()", "((go) (go))", request).outcome, PlanOutcome::kFound);
  request.max_depth = 3;
  const PlanResult none = Solve(kWays, "()", "((go) (go))", request);
  EXPECT_EQ(none.outcome, PlanOutcome::kLimitDepth);
  EXPECT_THAT(none.plans, IsEmpty());
}

/// (run) decomposes for ever; with steps that change the state in between, or without.
const std::string kIdle = kShow + "(:method (run) () ((run)))";
const std::string kToggle =
    "(:operator (!on) () () ((light))) (:operator (!off) () ((light)) ())"
    "(:method (run) () ((!on) (!off) (run)))";
const std::string kCount =
    "(:operator (!count ?n) () () ((counted ?n)))"
    "(:method (run ?n) () ((!count ?n) (run (call + ?n 1))))";

TEST(LoopTest, TheLoopCheckEndsAPathThatComesBackToStateAndTasks) {
  for (const std::string& items : {kIdle, kToggle}) {
    const PlanResult result = Solve(items, "()", "((run))");
    EXPECT_EQ(result.outcome, PlanOutcome::kNoPlan);
    EXPECT_TRUE(result.exhausted);
    EXPECT_LT(result.progress.expansions, 20u);
  }
}

TEST(LoopTest, AWayOutOfALoopIsFound) {
  EXPECT_THAT(AllPlans("(:operator (!on) () () ((light))) (:operator (!off) () ((light)) ())"
                       "(:method (run) ((not (light))) ((!on) (run)))"
                       "(:method (run) ((light)) ((!off) (run)))"
                       "(:method (run) ((light)) ())",
                       "()", "((run))"),
              ElementsAre("(!on)"));
}

TEST(LoopTest, EqualTasksInAnotherStateAreNoLoop) {
  const PlanResult result = Solve(
      "(:operator (!eat) ((food ?x)) ((food ?x)) ())"
      "(:method (eat-all) ((food ?x)) ((!eat) (eat-all)) () ())",
      "((food a) (food b) (food c))", "((eat-all))");
  ASSERT_EQ(result.outcome, PlanOutcome::kFound);
  EXPECT_EQ(result.plans[0].steps.size(), 3u);
}

TEST(LoopTest, TheSameStateWithFewerProtectionsIsNoLoop) {
  EXPECT_THAT(Steps(Solve(kProtect + "(:method (run) () ((!lose)))"
                                     "(:method (run) () ((!release (p)) (run)))",
                          "((p))", "((!protect (p)) (!protect (p)) (run))")),
              ElementsAre("(!protect (p)) (!protect (p)) (!release (p)) (!release (p)) (!lose)"));
}

// Which fact is the newest decides what comes next.
TEST(LoopTest, TheSameFactsAtAnotherAgeAreNoLoop) {
  const std::string items =
      "(:operator (!renew ?x) () ((q ?x)) ((q ?x))) (:operator (!done) () () ())"
      "(:method (run) (:first (q ?x)) ((step ?x)))"
      "(:method (step b) () ((!renew a) (run))) (:method (step a) () ((!done)))";
  PlanRequest request;
  for (const bool loop_check : {false, true}) {
    request.loop_check = loop_check;
    EXPECT_THAT(Steps(Solve(items, "((q a) (q b))", "((run))", request)),
                ElementsAre("(!renew a) (!done)"));
  }
}

// The tasks come back as well, not only the facts.
TEST(LoopTest, TheSameTasksWithFactsOfAnotherAgeAreNoLoop) {
  const std::string items =
      "(:operator (!renew ?x) () ((q ?x)) ((q ?x))) (:operator (!done) () () ())"
      "(:method (go) () ((pick))) (:method (pick) (:first (q ?x)) ((try ?x)))"
      "(:method (try b) () ((!renew a) (go))) (:method (try a) () ((!done)))";
  EXPECT_THAT(Steps(Solve(items, "((q a) (q b))", "((go))")), ElementsAre("(!renew a) (!done)"));
}

TEST(LoopTest, MaxDepthEndsRecursionWithoutEnd) {
  PlanRequest request;
  request.max_depth = 1000;
  EXPECT_EQ(Solve(kCount, "()", "((run 0))", request).outcome, PlanOutcome::kLimitDepth);
  request.loop_check = false;
  EXPECT_EQ(Solve(kIdle, "()", "((run))", request).outcome, PlanOutcome::kLimitDepth);
}

TEST(LoopTest, TheQuestionEndsRecursionWithoutEnd) {
  PlanRequest request;
  request.loop_check = false;
  std::uint64_t last = 0;
  request.stop = [&last](const Progress& progress) {
    EXPECT_LE(progress.expansions - last, 256u);
    last = progress.expansions;
    return progress.expansions > 3000 ? Stop::kCancelled : Stop::kContinue;
  };
  const PlanResult result = Solve(kToggle, "()", "((run))", request);
  EXPECT_EQ(result.outcome, PlanOutcome::kCancelled);
  EXPECT_GT(result.progress.expansions, 3000u);
  EXPECT_LE(result.progress.expansions, 3000u + 256u);
}

TEST(LoopTest, TheQuestionEndsInferenceWithoutEnd) {
  PlanRequest request;
  int questions = 0;
  request.stop = [&questions](const Progress&) {
    return ++questions == 3 ? Stop::kTime : Stop::kContinue;
  };
  // 12^6 ways to look for what is not there
  std::string facts;
  for (int i = 0; i < 12; ++i) facts += "(p " + std::to_string(i) + ")";
  const PlanResult result =
      Solve(kShow + "(:method (t) ((p ?a) (p ?b) (p ?c) (p ?d) (p ?e) (p ?f) (q ?f)) ((!a)))",
            "(" + facts + "(q 99))", "((t))", request);
  EXPECT_EQ(result.outcome, PlanOutcome::kLimitTime);
  EXPECT_LE(result.progress.inferences, 4u * 4096u);
}

TEST(LoopTest, AnAxiomThatOnlyLeadsToItselfEndsWithAnErrorOrByTheQuestion) {
  PlanRequest request;
  int questions = 0;
  request.stop = [&questions](const Progress&) {
    return ++questions > 1000 ? Stop::kTime : Stop::kContinue;
  };
  const std::string items = kShow + "(:- (p ?x) ((p ?x))) (:method (t) ((p a)) ((!a)))";
  try {
    EXPECT_EQ(Solve(items, "()", "((t))", request).outcome, PlanOutcome::kLimitTime);
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("domain:1:"));
  }
}

TEST(LimitTest, TheMemoryLimitEndsASearchThatGrows) {
  PlanRequest request;
  request.max_depth = 100'000'000;
  const std::size_t limit = 8u << 20;
  request.stop = WithMemoryLimit(limit);
  const PlanResult result = Solve(kCount, "()", "((run 0))", request);
  EXPECT_EQ(result.outcome, PlanOutcome::kLimitMemory);
  EXPECT_GT(result.progress.bytes, limit);
  EXPECT_LT(result.progress.bytes, 4 * limit);
}

TEST(LimitTest, TheMemoryLimitAsksTheNextQuestionFirst) {
  int asked = 0;
  const StopQuestion question = WithMemoryLimit(
      100, [&asked](const Progress&) { return ++asked == 1 ? Stop::kCancelled : Stop::kContinue; });
  Progress progress;
  progress.bytes = 1000;
  EXPECT_EQ(question(progress), Stop::kCancelled);
  EXPECT_EQ(question(progress), Stop::kMemory);
  progress.bytes = 100;
  EXPECT_EQ(question(progress), Stop::kContinue);
}

// ------------------------------------------------------------------------ trace, imagined failures

TEST(TraceTest, NamesTheGoalThatFailedAndTheBindingsSoFar) {
  PlanRequest request;
  request.max_trace = 10;
  const PlanResult result = Solve(kShow +
                                      "\n(:operator (!lift ?x) ((cup ?x) (clear ?x)) () ())\n"
                                      "(:method (t) ((table ?t)) ((!lift mug)))",
                                  "((table t1) (cup mug))", "((t))", request);
  EXPECT_EQ(result.outcome, PlanOutcome::kNoPlan);
  ASSERT_FALSE(result.trace.empty());
  const TraceEntry& last = result.trace.back();
  EXPECT_EQ(last.task, "(!lift mug)");
  EXPECT_THAT(last.where, HasSubstr("!lift"));
  EXPECT_THAT(last.where, HasSubstr("2"));  // line
  EXPECT_THAT(last.reason, HasSubstr("goal 2 (clear mug)"));
}

TEST(TraceTest, SaysThatNoBranchOfAMethodHolds) {
  PlanRequest request;
  request.max_trace = 10;
  const PlanResult result =
      Solve(kShow + "\n(:method (t ?x)\n one ((p ?x) (q ?x)) ((!a))\n two ((r ?x)) ((!b)))",
            "((p mug))", "((t mug))", request);
  ASSERT_EQ(result.trace.size(), 2u);
  EXPECT_EQ(result.trace[0].task, "(t mug)");
  EXPECT_THAT(result.trace[0].where, HasSubstr("one"));
  EXPECT_THAT(result.trace[0].reason, HasSubstr("(q "));
  EXPECT_THAT(result.trace[1].where, HasSubstr("two"));
  EXPECT_THAT(result.trace[1].reason, HasSubstr("(r "));
}

TEST(TraceTest, NamesTheProtectionThatAStepWouldBreak) {
  PlanRequest request;
  request.max_trace = 1;
  const PlanResult result = Solve(kProtect, "((p))", "((!protect (p)) (!lose))", request);
  ASSERT_EQ(result.trace.size(), 1u);
  EXPECT_EQ(result.trace[0].task, "(!lose)");
  EXPECT_THAT(result.trace[0].reason, HasSubstr("protect"));
  EXPECT_THAT(result.trace[0].reason, HasSubstr("(p)"));
}

TEST(TraceTest, KeepsTheLatestReasonsOnlyAndNoneUnlessAsked) {
  const std::string items = kShow +
                            "(:operator (!need ?x) ((q ?x)) () ())"
                            "(:method (t) ((p ?x)) ((!need ?x)))";
  PlanRequest request;
  EXPECT_THAT(Solve(items, "((p a) (p b) (p c))", "((t))", request).trace, IsEmpty());
  request.max_trace = 2;
  const PlanResult result = Solve(items, "((p a) (p b) (p c))", "((t))", request);
  ASSERT_EQ(result.trace.size(), 2u);
  EXPECT_EQ(result.trace[0].task, "(!need b)");
  EXPECT_EQ(result.trace[1].task, "(!need c)");
}

TEST(ImaginedFailureTest, StepsThatFailedInImaginationAreNotTaken) {
  const std::string items =
      "(:operator (!drive ?how) () () ())"
      "(:method (t) () ((!drive fast))) (:method (t) () ((!drive slow)))";
  EXPECT_THAT(AllPlans(items, "()", "((t))"), ElementsAre("(!drive fast)", "(!drive slow)"));
  EXPECT_THAT(AllPlans(items, "((imagined_failure !drive fast))", "((t))"),
              ElementsAre("(!drive slow)"));
  EXPECT_THAT(AllPlans(items, "((imagined_failure drive fast))", "((t))"),
              ElementsAre("(!drive slow)"));
  EXPECT_THAT(AllPlans(items, "((imagined_failure !drive))", "((t))"),
              ElementsAre("(!drive fast)", "(!drive slow)"));
  const PlanResult none =
      Solve(items, "((imagined_failure !drive fast) (imagined_failure !drive slow))", "((t))");
  EXPECT_EQ(none.outcome, PlanOutcome::kNoPlan);
  EXPECT_TRUE(none.exhausted);
}

TEST(ImaginedFailureTest, AFailureThatIsTakenBackCountsNoMore) {
  const std::string items =
      "(:operator (!drive ?how) () () ())"
      "(:operator (!!forget ?how) () ((imagined_failure !drive ?how)) () 0)";
  EXPECT_THAT(
      AllPlans(items, "((imagined_failure !drive fast))", "((!!forget fast) (!drive fast))"),
      ElementsAre("(!!forget fast) (!drive fast)"));
}

// ----------------------------------------------------------------------------------- wrong
// problems

void ExpectError(const std::string& items, const std::string& facts, const std::string& tasks,
                 const std::string& part) {
  try {
    Solve(items, facts, tasks);
    FAIL() << "no error for " << tasks;
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr(part));
  }
}

TEST(WrongProblemTest, ATaskThatNothingHandlesIsNamed) {
  ExpectError(kShow, "()", "((!shaw mug))", "!shaw");
}

TEST(WrongProblemTest, AWrongNumberOfArgumentsIsNamed) {
  ExpectError(kShow, "()", "((!show mug cup))", "!show");
}

TEST(WrongProblemTest, AnImplicationFromAnUnboundVariableIsAnError) {
  ExpectError(kShow + "(:method (t) ((imply (p ?x) (q ?x))) ((!a)))", "()", "((t))", "imply");
}

TEST(WrongProblemTest, AnExpressionOfAnUnboundVariableIsAnError) {
  ExpectError(kShow + "(:method (t) ((call > ?x 3)) ((!a)))", "()", "((t))", "?x");
}

TEST(WrongProblemTest, AVariableGoalThatIsUnboundIsAnError) {
  ExpectError(kShow + "(:method (t) (?g) ((!a)))", "()", "((t))", "?g");
}

TEST(WrongProblemTest, AddingAnAtomWithAnUnboundVariableIsAnError) {
  ExpectError(kShow + "(:operator (!add ?x) () () ((p ?x))) (:method (t) () ((!add ?x)))", "()",
              "((t))", "(p ");
}

}  // namespace
}  // namespace hires::planning::engine_test
