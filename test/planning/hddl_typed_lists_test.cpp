// Typed lists as published HDDL files have them: objects of several types, dashes without a blank.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hires/planning/planner.h"
#include "hires/planning/validator.h"
#include "planning/language/hddl_reader.h"
#include "support/messages.h"

namespace hires::planning::hddl_typed_lists_test {
namespace {

using hires::test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

Domain DomainOf(const std::string& sections) {
  return ReadHddlDomain("(define (domain d)\n" + sections + ")", "d.hddl");
}

Problem ProblemOf(const Domain& domain, const std::string& sections) {
  return ReadHddlProblem("(define (problem p) (:domain d)\n" + sections + ")", "p.hddl", domain);
}

std::vector<std::string> Facts(const Domain& domain, const Problem& problem) {
  std::vector<std::string> texts;
  for (const auto* facts : {&domain.facts, &problem.facts}) {
    for (const Datum& fact : *facts) texts.push_back(ToString(fact));
  }
  return texts;
}

int NumSteps(const Domain& domain, const Problem& problem) {
  const PlanResult result = FindPlans(domain, problem);
  if (result.plans.size() != 1) return -1;
  EXPECT_THAT(ValidatePlan(domain, problem, result.plans[0]), IsEmpty());
  return static_cast<int>(result.plans[0].steps.size());
}

// ---------------------------------------------------------------------- objects of several types

const std::string kGifts =
    "(:types vessel gift - thing cup - vessel)"
    "(:predicates (full ?v - vessel) (given ?g - gift) (seen ?t - (either vessel gift)))"
    "(:task treat :parameters (?v - vessel ?g - gift))"
    "(:method m :parameters (?v - vessel ?g - gift) :task (treat ?v ?g)"
    " :ordered-subtasks (and (fill ?v) (give ?g)))"
    "(:action fill :parameters (?v - vessel) :effect (full ?v))"
    "(:action give :parameters (?g - gift) :effect (given ?g))";

TEST(HddlObjectTest, OneListedWithSeveralTypesIsOfAllOfThem) {
  const Domain domain = DomainOf(kGifts);
  const Problem problem = ProblemOf(domain,
                                    "(:objects mug - vessel mug - gift)"
                                    "(:htn :ordered-subtasks (and (treat mug mug)))");
  EXPECT_THAT(Facts(domain, problem),
              UnorderedElementsAre("(%type-object mug)", "(%type-thing mug)", "(%type-vessel mug)",
                                   "(%type-gift mug)", "(%type-vessel/gift mug)"));
  EXPECT_EQ(NumSteps(domain, problem), 2);
}

TEST(HddlObjectTest, CommasBetweenEntriesArePassedOver) {
  const Domain domain = DomainOf(kGifts);
  const auto facts = [&](const std::string& objects) {
    return Facts(domain, ProblemOf(domain, "(:objects " + objects + ") (:htn)"));
  };
  const std::vector<std::string> wanted = facts("a b c - cup d - gift");
  EXPECT_EQ(facts("a, b ,c - cup, d - gift"), wanted);
  EXPECT_EQ(facts("a,b,c, - cup d -, gift"), wanted);
  EXPECT_EQ(DomainOf("(:predicates (p ?a, ?b)) (:action x :parameters (?a, ?b - object))")
                .operators.at(0)
                .head.items.size(),
            3u);
}

TEST(HddlObjectTest, AProblemAddsTypesToAConstant) {
  const Domain domain = DomainOf("(:constants mug - gift)" + kGifts);
  const Problem problem =
      ProblemOf(domain, "(:objects mug - cup) (:htn :ordered-subtasks (and (treat mug mug)))");
  EXPECT_THAT(
      Facts(domain, problem),
      UnorderedElementsAre("(%type-object mug)", "(%type-thing mug)", "(%type-vessel mug)",
                           "(%type-gift mug)", "(%type-cup mug)", "(%type-vessel/gift mug)"));
  EXPECT_EQ(NumSteps(domain, problem), 2);
}

TEST(HddlObjectTest, OfATypeAndOneBelowTheNarrowerOneCounts) {
  for (const std::string objects : {"mug - cup mug - vessel mug", "mug mug - thing mug - cup"}) {
    const Domain domain = DomainOf(kGifts);
    const Problem problem = ProblemOf(domain, "(:objects " + objects + ") (:htn)");
    EXPECT_THAT(Facts(domain, problem), SizeIs(5)) << objects;
    EXPECT_THAT(ConfigErrorOf([&] {
                  ProblemOf(domain, "(:objects " + objects + ") (:htn) (:init (given mug))");
                }),
                HasSubstr("'mug' is of type cup, predicate 'given' takes gift here"));
  }
}

TEST(HddlObjectTest, ThreeTypesThatOtherObjectsShareAreOneJointType) {
  const Domain domain = DomainOf("(:types a b c) (:predicates (p ?x - a ?y - b ?z - c))");
  const std::string objects = "x - a y - b x - b y - c x - c y - a z - c";
  const Problem problem =
      ProblemOf(domain, "(:objects " + objects + ") (:htn) (:init (p x y z) (p y x x))");
  EXPECT_THAT(Facts(domain, problem), SizeIs(2 * 4 + 2 + 2));
  EXPECT_THAT(ConfigErrorOf([&] {
                ProblemOf(domain, "(:objects " + objects + ") (:htn) (:init (p z x x))");
              }),
              HasSubstr("'z' is of type c, predicate 'p' takes a here"));
}

TEST(HddlObjectTest, AMessageNamesAllTypesOfAnObject) {
  EXPECT_THAT(
      ConfigErrorOf([] {
        DomainOf(
            "(:types a b c) (:constants x - a x - b) (:predicates (p ?x - c))\n"
            "(:action go :precondition (p x))");
      }),
      AllOf(HasSubstr("d.hddl:3:"), HasSubstr("'x' is of type a and b"), HasSubstr("takes c")));
}

TEST(HddlObjectTest, TypesThatObjectsShareAreBoundedInNumber) {
  std::string types, objects;
  for (int i = 0; i < 60; ++i) types += " t" + std::to_string(i);
  for (int i = 0; i < 60; ++i) {
    for (int k = 0; k < i; ++k) {
      const std::string name = "x" + std::to_string(i) + "_" + std::to_string(k);
      objects += " " + name + " - t" + std::to_string(i) + " " + name + " - t" + std::to_string(k);
    }
  }
  EXPECT_THAT(ConfigErrorOf([&] { DomainOf("(:types" + types + ") (:constants" + objects + ")"); }),
              HasSubstr("1001 types are declared, at most 1000"));
}

// --------------------------------------------------------------------------- dashes without blank

TEST(HddlDashTest, GluedToATypeItIsReadWhereverTypesStand) {
  const Domain domain = DomainOf(
      "(:types cup plate -thing spoon -(either cup plate))"
      "(:constants c -cup)"
      "(:predicates (seen ?c -cup ?p -plate) (any ?x -(either cup plate)))"
      "(:functions (far ?c -cup) -number (near ?c - cup) - number (total-cost) -number)"
      "(:task look :parameters (?c -cup ?p -plate))"
      "(:method m :parameters (?c -cup ?p -plate) :task (look ?c ?p)"
      " :precondition (and (exists (?q -plate) (= ?q ?p)) (sortof ?c -cup))"
      " :ordered-subtasks (and (glance ?c ?p)))"
      "(:action glance :parameters (?c -cup ?p -plate)"
      " :precondition (forall (?d -cup) (not (seen ?d ?p)))"
      " :effect (forall (?d -cup) (seen ?d ?p)))");
  const Problem problem = ProblemOf(domain,
                                    "(:objects d -cup p q -plate)"
                                    "(:htn :parameters (?p -plate)"
                                    " :ordered-subtasks (and (look c ?p)))"
                                    "(:goal (forall (?d -cup) (seen ?d p)))");
  EXPECT_EQ(NumSteps(domain, problem), 1);
  const auto facts = Facts(domain, problem);
  EXPECT_EQ(std::count(facts.begin(), facts.end(), "(%type-thing q)"), 1);
  EXPECT_EQ(std::count(facts.begin(), facts.end(), "(%type-cup c)"), 1);
  EXPECT_EQ(std::count(facts.begin(), facts.end(), "(%type-plate c)"), 0);
}

TEST(HddlDashTest, ATypeBehindItIsCheckedAtItsPlace) {
  EXPECT_THAT(
      ConfigErrorOf([] { DomainOf("(:types cup) (:predicates (p ?x -cupp))"); }),
      AllOf(HasSubstr("d.hddl:2:34:"), HasSubstr("type 'cupp' is unknown"), HasSubstr("'cup'")));
  EXPECT_THAT(ConfigErrorOf([] { DomainOf("(:types -cup)"); }),
              AllOf(HasSubstr("d.hddl:2:9:"), HasSubstr("'-' has no name before it")));
}

}  // namespace
}  // namespace hires::planning::hddl_typed_lists_test
