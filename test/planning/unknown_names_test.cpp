// Names that nothing stands for: harmless until they are reached, as in domains found in the world.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "hires/planning/plan_report.h"
#include "hires/planning/planner.h"
#include "hires/planning/planning_files.h"
#include "hires/planning/request.h"
#include "hires/planning/shop2_reader.h"
#include "hires/planning/task_text.h"
#include "hires/planning/validator.h"
#include "planning/check/known_names.h"
#include "planning/support/plan_text.h"
#include "support/messages.h"

namespace hires::planning::unknown_names_test {
namespace {

using hires::test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr char kDomain[] = R"((defdomain d (
(:operator (!wave ?who) () () ())
(:method (greet ?who) ((near ?who)) ((!wave ?who)) ((far ?who)) ((shout ?who)))
(:method (count ?who) ((assign ?n (tally ?who))) ((!wave ?n)))
(:method (best) (:sort-by ?x #'nicer (near ?x)) ((!wave ?x))))))";

PlanResult PlanFor(const std::string& tasks, bool strict = false) {
  const Domain domain = ReadShop2Domain(kDomain, "d.lisp");
  const Problem problem =
      ReadShop2Problems("(defproblem p d ((near anna) (near eve) (far bert)) " + tasks + ")",
                        "p.lisp")
          .front();
  PlanRequest request;
  request.strict = strict;
  return FindPlans(domain, problem, request);
}

TEST(SymbolsTest, ArgumentsOfTasksAreNamedEachOnceWithoutHeads) {
  EXPECT_THAT(ArgumentSymbols(ReadTasks("(:unordered (greet anna 3) (tell (eve anna) bert))", "t")),
              ElementsAre("anna", "eve", "bert"));
}

TEST(SymbolsTest, WhatFactsAndDomainWriteIsKnown) {
  const Domain domain = ReadShop2Domain(kDomain, "d.lisp");
  const Problem problem =
      ReadShop2Problems("(defproblem p d ((near anna)) ((greet eve)))", "p.lisp").front();
  EXPECT_THAT(SymbolsOf(domain, problem),
              AllOf(Contains("anna"), Contains("!wave"), Contains("near"), Not(Contains("eve")),
                    Not(Contains("?who"))));
}

TEST(UnknownNamesTest, WhereNothingReachesThemThereIsAPlanAndAWarning) {
  const PlanResult result = PlanFor("((greet anna))");
  ASSERT_EQ(result.outcome, PlanOutcome::kFound);
  EXPECT_EQ(ToString(result.plans.at(0).steps.at(0).task), "(!wave anna)");
  EXPECT_THAT(result.warnings,
              ElementsAre(HasSubstr("task 'shout' is unknown"),
                          AllOf(HasSubstr("d.lisp:4:"), HasSubstr("function 'tally' is unknown")),
                          AllOf(HasSubstr(":sort-by"), HasSubstr("function 'nicer' is unknown"))));
}

TEST(UnknownNamesTest, WhatIsReachedIsAnErrorWithPlaceAndRemedy) {
  EXPECT_THAT(
      ConfigErrorOf([] { PlanFor("((greet bert))"); }),
      AllOf(HasSubstr("d.lisp:3:"), HasSubstr("task 'shout' is unknown"),
            HasSubstr("operator or a method for it"), HasSubstr("reached as (shout bert)")));
  EXPECT_THAT(ConfigErrorOf([] { PlanFor("((count anna))"); }),
              AllOf(HasSubstr("d.lisp:4:"), HasSubstr("function 'tally' is unknown")));
  EXPECT_THAT(ConfigErrorOf([] { PlanFor("((best))"); }),
              AllOf(HasSubstr("d.lisp:5:"), HasSubstr("function 'nicer' is unknown")));
}

TEST(UnknownNamesTest, StrictlyTheyAreRefusedAnyway) {
  EXPECT_THAT(ConfigErrorOf([] { PlanFor("((greet anna))", true); }),
              HasSubstr("task 'shout' is unknown"));
}

TEST(UnknownNamesTest, AProblemsOwnTasksHaveToExist) {
  EXPECT_THAT(ConfigErrorOf([] { PlanFor("((shout anna))"); }), HasSubstr("'shout' is unknown"));
}

// ------------------------------------------------------------------------- predicates, misspelt

TEST(UnknownNamesTest, ATaskThatFitsTheHeadOfNoMethodIsNamed) {
  const Domain domain = ReadShop2Domain(
      "(defdomain d ((:operator (!go ?r) () () ()) (:method (leave r1 home) () ((!go r1)))\n"
      " (:method (leave r1 shop) () ((!go r1)))))",
      "d.lisp");
  const Problem problem =
      ReadShop2Problems("(defproblem p d ((at r1)) ((leave k\xC3\x84se home)))", "p.lisp").front();
  PlanRequest request;
  request.explain = true;
  const PlanResult result = FindPlans(domain, problem, request);
  EXPECT_EQ(result.outcome, PlanOutcome::kNoPlan);
  EXPECT_THAT(OutcomeSentence(result, Which::kFirst),
              AllOf(HasSubstr("it got as far as (leave k\xC3\x84se home): its arguments fit"),
                    HasSubstr("neither a fact nor the domain knows 'k\xC3\x84se'")));
}

constexpr char kCups[] = R"((defdomain cups (
(:operator (!take ?cup) ((emty ?hand)) ((empty ?hand)) ((holds ?hand ?cup)))
(:operator (!drop ?cup) ((holds ?hand ?cup) (not (imagined_failure take))) () ((empty ?hand)))
(:method (get ?cup) ((observe ?cup)) ((!take ?cup)))
(:- (free ?hand) ((empty ?hand) (not (hold ?hand ?any)))))))";

std::vector<std::string> MisspeltWith(const std::string& facts) {
  return MisspeltPredicates(
      ReadShop2Domain(kCups, "cups.lisp"),
      ReadShop2Problems("(defproblem p cups " + facts + " ())", "p.lisp").front());
}

TEST(MisspeltPredicatesTest, WhatNothingCanEverGiveIsNamedWithItsPlaceAndWhatIsMeant) {
  EXPECT_THAT(
      MisspeltWith("((empty left))"),
      ElementsAre(AllOf(HasSubstr("cups.lisp:2:"), HasSubstr("operator '!take'"),
                        HasSubstr("(emty ...)"), HasSubstr("did you mean 'empty'?")),
                  AllOf(HasSubstr("axiom 'free'"), HasSubstr("(hold ...)"), HasSubstr("'holds'"))));
}

TEST(MisspeltPredicatesTest, WhatTheStateOrAnEffectGivesIsSpeltAsItIsMeant) {
  EXPECT_THAT(MisspeltWith("((emty left) (hold left mug))"), IsEmpty());
}

TEST(MisspeltPredicatesTest, AFactThatNothingHasToDoWithIsNamedWithWhatIsMeant) {
  const std::string right = "(empty left) (emty right) (hold right mug) ";
  EXPECT_THAT(MisspeltWith("(" + right + "(holdss left cup) (holdss left mug) (unheard of))"),
              ElementsAre(AllOf(HasSubstr("p.lisp:1:"), HasSubstr("problem 'p'"),
                                HasSubstr("(holdss ...)"), HasSubstr("did you mean 'hold"))));
  EXPECT_THAT(MisspeltWith("(" + right + "(holds left mug) (free right))"), IsEmpty());
  const Domain any_goal = ReadShop2Domain(
      "(defdomain d ((:method (m ?goal) (?goal (holds ?x)) ()) (:operator (!o) () ((holds a)))))",
      "d.lisp");
  const Problem problem = ReadShop2Problems("(defproblem p d ((hold a)) ())", "p.lisp").front();
  EXPECT_THAT(MisspeltPredicates(any_goal, problem), IsEmpty()) << "a variable may ask for it";
}

TEST(MisspeltPredicatesTest, AVariableThatIsAddedMayBeAnything) {
  const Domain domain = ReadShop2Domain(
      "(defdomain d ((:operator (!add ?facts) ((emty)) () ?facts)"
      "(:operator (!fill) () () ((empty)))))",
      "d.lisp");
  EXPECT_THAT(MisspeltPredicates(domain, {}), IsEmpty());
}

TEST(MisspeltPredicatesTest, TheyAreWarnedAboutAndStrictlyRefused) {
  const Domain domain = ReadShop2Domain(kCups, "cups.lisp");
  const Problem problem =
      ReadShop2Problems("(defproblem p cups ((empty left)) ())", "p.lisp").front();
  EXPECT_THAT(FindPlans(domain, problem).doubts,
              ::testing::Contains(HasSubstr("did you mean 'empty'?")));
  PlanRequest request;
  request.strict = true;
  EXPECT_THAT(ConfigErrorOf([&] { FindPlans(domain, problem, request); }), HasSubstr("(emty ...)"));
}

/// Of the folder of examples found in the world; numbers are its README's.
class WildTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kFolder)) GTEST_SKIP() << kFolder << " is missing";
  }
  static PlanResult PlanOf(const std::string& domain, const std::string& problems,
                           const std::string& name, Which which = Which::kFirst) {
    const Domain read = LoadDomain(kFolder + domain);
    const Problem problem = FindProblem(LoadProblems(kFolder + problems, read), name);
    PlanRequest request;
    request.which = which;
    PlanResult result = FindPlans(read, problem, request);
    for (const Plan& plan : result.plans) EXPECT_THAT(ValidatePlan(read, problem, plan), IsEmpty());
    return result;
  }
  static const std::string kFolder;
};
const std::string WildTest::kFolder = std::string(HIRES_SHARED_DATA) + "/htn/wild/";

TEST_F(WildTest, UmTranslogHasItsPlanOf51Steps) {
  const Domain domain = LoadDomain(kFolder + "umt2.lisp");
  const auto problems = LoadProblems(kFolder + "umt2_1.lisp", domain);
  ASSERT_EQ(problems.size(), 1u);
  const PlanResult result = FindPlans(domain, problems[0]);
  ASSERT_EQ(result.outcome, PlanOutcome::kFound);
  EXPECT_EQ(result.plans[0].steps.size(), 51u);
  EXPECT_EQ(result.plans[0].cost, 51.0);
}

TEST_F(WildTest, SortsAsTheReferenceDoes) {
  const std::vector<std::pair<std::string, std::string>> firsts{
      {"p1", "(!a1 1)"}, {"p2", "(!b1 -2)"}, {"p2-reverse", "(!b1 3)"}, {"p3", "(!b1 3)"}};
  for (const auto& [name, first] : firsts) {
    const PlanResult result = PlanOf("toy_sort.lisp", "toy_sort.lisp", name);
    ASSERT_EQ(result.outcome, PlanOutcome::kFound) << name;
    EXPECT_EQ(ToString(result.plans[0].steps[0].task), first) << name;
    EXPECT_EQ(PlanOf("toy_sort.lisp", "toy_sort.lisp", name, Which::kAll).plans.size(), 3u) << name;
  }
}

TEST_F(WildTest, AssignsEachAsTheReferenceDoes) {
  const std::string file = "toy_assign_star.lisp";
  const auto problems = LoadProblems(kFolder + file, LoadDomain(kFolder + file));
  ASSERT_EQ(problems.size(), 12u);
  for (const Problem& problem : problems) {
    const PlanResult all = PlanOf(file, file, problem.name, Which::kAll);
    if (problem.name == "shouldnt-work") {
      EXPECT_EQ(all.outcome, PlanOutcome::kNoPlan);
      continue;
    }
    const std::string suffix = "-choose-method";
    const bool has_choice =
        problem.name.size() > suffix.size() &&
        problem.name.compare(problem.name.size() - suffix.size(), suffix.size(), suffix) == 0;
    EXPECT_EQ(all.plans.size(), has_choice ? 2u : 1u) << problem.name;
    EXPECT_LE(all.plans.at(0).steps.size(), 2u) << problem.name;
  }
}

}  // namespace
}  // namespace hires::planning::unknown_names_test
