// What the variables of an operator's deletes and adds stand for is the same for the search, for
// whoever checks its plans and for the reasons of their steps.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "hires/planning/domain.h"
#include "hires/planning/reasons.h"
#include "hires/planning/validator.h"
#include "planning/support/conditions.h"
#include "planning/support/plans.h"
#include "support/messages.h"

namespace hires::planning::effect_atoms_test {
namespace {

using hires::test_support::ConfigErrorOf;
using hires::test_support::DomainOf;
using hires::test_support::FlatPlan;
using hires::test_support::FlatProblem;
using hires::test_support::ProblemOf;
using hires::test_support::Text;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A plan of the search, which is valid, with its reasons.
Plan PlanOf(const Domain& domain, const Problem& problem) {
  const PlanResult result = FindPlans(domain, problem);
  if (result.plans.size() != 1) return {};
  Plan plan = result.plans[0];
  EXPECT_THAT(ValidatePlan(domain, problem, plan), IsEmpty());
  AddReasons(domain, problem, &plan);
  return plan;
}

/// One step (!do argument), and then one that needs what the first should have made true.
struct Case {
  std::string name;
  std::string precondition, deletes, adds;  ///< of (!do ?g)
  std::string argument;
  std::string after;  ///< condition that holds after it
  std::string deleted, added;
};
void PrintTo(const Case& value, std::ostream* out) { *out << value.name; }

class EffectAtomsTest : public ::testing::TestWithParam<Case> {};

TEST_P(EffectAtomsTest, SearchValidatorAndReasonsAgree) {
  const Case& effects = GetParam();
  const Domain domain =
      DomainOf("(:operator (!do ?g) " + effects.precondition + " " + effects.deletes + " " +
               effects.adds + ") (:operator (!then) " + effects.after + " () ())");
  const Problem problem =
      ProblemOf("((old a) (old b) (n 1))", "((!do " + effects.argument + ") (!then))");
  const Plan plan = PlanOf(domain, problem);
  ASSERT_THAT(plan.steps, SizeIs(2));
  EXPECT_EQ(Text(plan.steps[0].deletes), effects.deleted);
  EXPECT_EQ(Text(plan.steps[0].adds), effects.added);
}

INSTANTIATE_TEST_SUITE_P(
    Variables, EffectAtomsTest,
    ::testing::Values(
        Case{"AnAtom", "()", "()", "(?g)", "(p a)", "((p a))", "", "(p a)"},
        Case{"AnAtomForTheWholeList", "()", "()", "?g", "(p a)", "((p a))", "", "(p a)"},
        Case{"AList", "()", "()", "?g", "((p a) (q))", "((p a) (q))", "", "(p a) (q)"},
        Case{"AListAmongOthers", "()", "()", "((r) ?g (s))", "((p a) (q))", "((p a) (q) (r) (s))",
             "", "(r) (p a) (q) (s)"},
        Case{"NothingAtAll", "()", "?g", "(?g)", "()", "((old a))", "", ""},
        Case{"AnAtomOfLists", "()", "()", "(?g)", "(p (a b) ((c)))", "((p (a b) ((c))))", "",
             "(p (a b) ((c)))"},
        Case{"ADeletedAtom", "()", "(?g)", "()", "(old a)", "((old b) (not (old a)))", "(old a)",
             ""},
        Case{"ADeletedList", "()", "?g", "()", "((old a) (old b))", "((not (old ?any)))",
             "(old a) (old b)", ""},
        Case{"AProtection", "()", "()", "((p) ?g)", "(:protection (p))", "((p))", "", "(p)"},
        Case{"AListOfProtections", "()", "()", "?g", "((p) (:protection (p)))", "((p))", "", "(p)"},
        Case{"AProtectedAtom", "()", "()", "(?g (:protection ?g))", "(p a)", "((p a))", "",
             "(p a)"}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Conditions, EffectAtomsTest,
    ::testing::Values(
        Case{"AssignedAtom", "((assign ?f '(p a)))", "()", "(?f)", "1", "((p a))", "", "(p a)"},
        Case{"ListOfAll", "((setof (new ?x) ((old ?x)) ?f))", "()", "?f", "1", "((new a) (new b))",
             "", "(new a) (new b)"},
        Case{"InAForall", "()", "()", "((forall (?v) ((old ?v)) (?g (new ?v))))", "(p a)",
             "((p a) (new a) (new b))", "", "(p a) (new a) (new b)"},
        Case{"InAForallInAForall", "()",
             "((forall (?v) ((old ?v)) ((forall (?w) ((old ?w)) ((old ?w) (pair ?v ?w))))))",
             "((forall (?v) ((old ?v)) ((forall (?w) ((old ?w)) (?g)))))", "(p)",
             "((p) (not (old ?any)))", "(old a) (old b)", "(p)"},
        Case{"BoundByAForall", "()", "()", "((forall (?v) ((old ?v)) ((p ?v))))", "1",
             "((p a) (p b))", "", "(p a) (p b)"},
        Case{"CalledFor", "((n ?n))", "((n ?n))", "((n (call + ?n ?g)))", "2", "((n 3))", "(n 1)",
             "(n 3)"},
        Case{"BoundByAnImply", "((imply (n 1) (old ?x)))", "((old ?x))", "((p ?x))", "1",
             "((p a) (not (old a)))", "(old a)", "(p a)"},
        Case{"BoundByNoExists", "((exists (?x) ((old ?x)) ((old ?y))))", "((old ?y))", "()", "1",
             "((old a) (old b))", "", ""},
        Case{"Quoted", "()", "()", "((p '(a ?g)))", "b", "((p (a b)))", "", "(p (a b))"},
        Case{"QuotedInTheTask", "()", "()", "(?g)", "'(p a)", "((p a))", "", "(p a)"}),
    [](const auto& info) { return info.param.name; });

TEST(EffectValuesTest, AStepThatNeedsAnAddedAtomIsLinkedToTheStepThatAddsIt) {
  const Domain domain = DomainOf(
      "(:operator (!!note ?fact) () () (?fact) 0) (:operator (!lift ?x) ((noted ?x)) () ((up ?x)))"
      "(:method (lift_all) ((box ?x) (not (noted ?x))) ((!!note (noted ?x)) (!lift ?x) (lift_all))"
      " nil ())");
  const Plan plan = PlanOf(domain, ProblemOf("((box a) (box b))", "((lift_all))"));
  ASSERT_THAT(plan.steps, SizeIs(4));
  ASSERT_THAT(plan.steps[3].links, SizeIs(1));
  EXPECT_EQ(plan.steps[3].links[0].producer, 2);
  EXPECT_EQ(ToString(plan.steps[3].links[0].literal.atom), "(noted b)");
}

// What a variable stands for is known in a plan only, so that no reader can refuse it.
TEST(EffectValuesTest, WhatIsNoFactIsAddedByNobody) {
  const Domain domain = DomainOf("(:operator (!do ?g) () () (?g)) (:method (t) () ())");
  for (const std::string value : {"((p a) 7)", "(((p a)))", "(:protection)", "(:protection 7)",
                                  "(:protection ((p a)))", "(:protection (p a) (q))"}) {
    const std::string step = "(!do " + value + ")";
    const Problem problem = FlatProblem("()", {step});
    EXPECT_THAT(ConfigErrorOf([&] { FindPlans(domain, problem); }),
                AllOf(HasSubstr("d.lisp:1"), HasSubstr("!do"), HasSubstr("no fact")))
        << value;
    EXPECT_THAT(ValidatePlan(domain, problem, FlatPlan({step})), Contains(HasSubstr("no fact")))
        << value;
  }
}

TEST(EffectValuesTest, WhatIsNoFactIsDeletedAlready) {
  const Domain domain = DomainOf("(:operator (!do ?g) () (?g) ())");
  for (const std::string value : {"7", "((p a) 7)", "(:protection)", "(:protection 7)", "x"}) {
    EXPECT_THAT(PlanOf(domain, ProblemOf("()", "((!do " + value + "))")).steps, SizeIs(1)) << value;
  }
}

TEST(PredicateSetTest, AVariableAmongTheEffectsMayBeAnyPredicate) {
  const Domain named =
      DomainOf("(:operator (!a ?x) () ((p ?x)) ((forall (?v) ((q ?v)) ((r ?v)))))");
  const PredicateSet few = ChangingPredicates(named);
  EXPECT_THAT(few.names, ElementsAre("p", "r"));
  EXPECT_TRUE(few.MayHave("r"));
  EXPECT_FALSE(few.MayHave("q"));
  const Domain open = DomainOf("(:operator (!a ?x) () () ((forall (?v) ((q ?v)) (?x))))");
  EXPECT_TRUE(ChangingPredicates(open).MayHave("q"));
}

}  // namespace
}  // namespace hires::planning::effect_atoms_test
