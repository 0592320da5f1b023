#include "hires/planning/planning_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>

#include "hires/base/error.h"
#include "hires/planning/plan.h"
#include "hires/planning/planner.h"
#include "hires/planning/task_text.h"
#include "hires/planning/validator.h"
#include "support/temporary_folder.h"

namespace hires::planning::planning_files_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr const char* kHddlDomain =
    "(define (domain d) (:types place) (:predicates (at ?p - place))\n"
    " (:action go :parameters (?p - place) :precondition () :effect (at ?p)))";
constexpr const char* kHddlProblem =
    "(define (problem p) (:domain d) (:objects a - place)\n"
    " (:htn :ordered-subtasks (and (go a))) (:init))";
constexpr const char* kShop2Domain = "(defdomain d ((:operator (!go ?p) () ((at ?p)))))";

template <typename Read>
std::string ErrorOf(const Read& read) {
  try {
    read();
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(LanguageOfTest, TheFirstWordTells) {
  using Language = Domain::Language;
  EXPECT_EQ(LanguageOf("; words\n#| more |# ( DefDomain d ())", "f"), Language::kShop2);
  EXPECT_EQ(LanguageOf("(defproblem", "f"), Language::kShop2);
  EXPECT_EQ(LanguageOf("(make-problem 'p", "f"), Language::kShop2);
  EXPECT_EQ(LanguageOf("(in-package :shop-user)", "f"), Language::kShop2);
  EXPECT_EQ(LanguageOf("\xEF\xBB\xBF(Define (domain d))", "f"), Language::kHddl);
}

TEST(LanguageOfTest, OtherFilesAreNamed) {
  for (const char* text : {"", "plan: 7", "(", "((defdomain d ()))", "(\"defdomain\")"}) {
    EXPECT_THAT(ErrorOf([&] { LanguageOf(text, "notes.txt"); }),
                AllOf(HasSubstr("notes.txt: is no planning file"), HasSubstr("(defdomain")))
        << text;
  }
  EXPECT_THAT(ErrorOf([] { LanguageOf("(setq x 1)", "notes.txt"); }), HasSubstr("(setq"));
}

TEST(LanguageOfTest, WhatIsWrittenInUtf16OrEmptyIsCalledSo) {
  using std::string_literals::operator""s;
  for (const std::string& text :
       {"\xFF\xFE(\0d\0"s, "\xFE\xFF\0(\0d"s, "(\0d\0e\0"s, "\0(\0d\0e"s}) {
    EXPECT_THAT(ErrorOf([&] { LanguageOf(text, "d.lisp"); }),
                AllOf(HasSubstr("d.lisp: "), HasSubstr("UTF-16"), HasSubstr("save it as UTF-8")));
  }
  for (const char* text : {"", " \n\t", "\xEF\xBB\xBF\n"}) {
    EXPECT_THAT(ErrorOf([&] { LanguageOf(text, "d.lisp"); }), HasSubstr("it is empty, wanted"));
  }
}

TEST(LanguageOfTest, FormsOfLispMayStandBefore) {
  using Language = Domain::Language;
  for (const std::string before : {"(progn (ql:quickload :shop3))", "(defpackage :x)", "#+x (f)",
                                   "(cl:in-package #:shop-user)", "(eval-when () 1)"}) {
    EXPECT_EQ(LanguageOf(before + " (defdomain d ())", "f"), Language::kShop2) << before;
    EXPECT_EQ(LanguageOf(before + " (shop:defproblem p () ())", "f"), Language::kShop2) << before;
  }
  EXPECT_EQ(LanguageOf("(shop2:defdomain d ())", "f"), Language::kShop2);
}

TEST(LoadTest, WhatIsToldOfAFileIsToldOnce) {
  const hires::test_support::TemporaryFolder folder;
  const std::string path = folder.Write(
      "d.lisp", std::string(kShop2Domain) + "(defproblem p d () ((!go a)))(find-plans 'p)");
  const Domain domain = LoadDomain(path);
  EXPECT_THAT(domain.warnings, ElementsAre(HasSubstr("(find-plans ...)")));
  EXPECT_THAT(LoadProblems(path, domain).at(0).warnings, IsEmpty());
  const std::string other = folder.Write("p.lisp", "(defproblem p d () ((!go a)))(find-plans 'p)");
  EXPECT_THAT(LoadProblems(other, domain).at(0).warnings, ElementsAre(HasSubstr("p.lisp:1:30")));
}

TEST(LoadTest, BothLanguagesAreLoaded) {
  const hires::test_support::TemporaryFolder folder;
  const Domain shop2 = LoadDomain(folder.Write("d.lisp", kShop2Domain));
  EXPECT_EQ(shop2.language, Domain::Language::kShop2);
  const std::string problems =
      folder.Write("p.lisp", "(defproblem p1 d () ((!go a))) (defproblem p2 d () ((!go b)))");
  EXPECT_THAT(LoadProblems(problems, shop2), SizeIs(2));

  const Domain hddl = LoadDomain(folder.Write("d.hddl", kHddlDomain));
  EXPECT_EQ(hddl.language, Domain::Language::kHddl);
  EXPECT_THAT(LoadProblems(folder.Write("p.hddl", kHddlProblem), hddl), SizeIs(1));
}

TEST(LoadTest, TheSidecarBesideADomainSaysWhetherTheOrderOfSubtasksIsKept) {
  const hires::test_support::TemporaryFolder folder;
  const std::string shop2 = folder.Write("d.lisp", kShop2Domain);
  EXPECT_EQ(LoadDomain(shop2).subtask_order, SubtaskOrder::kKept);
  folder.Write("d.yaml", "subtask_order: causal_links\noperators: {}\n");
  EXPECT_EQ(LoadDomain(shop2).subtask_order, SubtaskOrder::kCausalLinks);
  folder.Write("d.yaml", "subtask_order: kept\n");
  EXPECT_EQ(LoadDomain(shop2).subtask_order, SubtaskOrder::kKept);
  folder.Write("d.yaml", "subtask_order: any\n");
  EXPECT_THAT(ErrorOf([&] { LoadDomain(shop2); }),
              AllOf(HasSubstr("d.yaml"), HasSubstr("causal_links")));
}

TEST(CheckSidecarTest, ASidecarThatCannotBeExecutedIsRefusedWithFileAndKey) {
  const hires::test_support::TemporaryFolder folder;
  const std::string path = folder.Write("d.lisp", kShop2Domain);
  const Domain domain = LoadDomain(path);
  const auto error = [&] { return ErrorOf([&] { CheckSidecar(path, domain); }); };
  EXPECT_NO_THROW(CheckSidecar(path, domain)) << "there is none";
  folder.Write("d.yaml", "subtask_order: causal_links\n");
  EXPECT_NO_THROW(CheckSidecar(path, domain)) << "for planning alone";
  folder.Write("d.yaml", "operators: {go: {duration: {mni: 3}}}\n");
  EXPECT_THAT(error(), HasSubstr("d.yaml"));
  folder.Write("d.yaml", "operators: {\n");
  EXPECT_THAT(error(), AllOf(HasSubstr("d.yaml"), HasSubstr("line 2")));
}

TEST(LoadTest, AYamlFileBesideADomainThatIsNoSidecarIsPassedOverWithAWarning) {
  const hires::test_support::TemporaryFolder folder;
  const std::string path = folder.Write("d.lisp", kShop2Domain);
  for (const char* foreign : {"version: 3\nservices: {planner: {}}\n", "# nothing\n", "{}\n"}) {
    SCOPED_TRACE(foreign);
    folder.Write("d.yaml", foreign);
    const Domain domain = LoadDomain(path);
    EXPECT_EQ(domain.subtask_order, SubtaskOrder::kKept);
    EXPECT_THAT(domain.warnings, ElementsAre(HasSubstr("d.yaml: stands beside the domain")));
    EXPECT_NO_THROW(CheckSidecar(path, domain));
  }
  folder.Write("d.yaml", "legs: []\n");
  EXPECT_THAT(LoadDomain(path).warnings, IsEmpty());
}

TEST(LoadTest, TheOrderOfHddlIsAlwaysKept) {
  const hires::test_support::TemporaryFolder folder;
  const std::string hddl = folder.Write("d.hddl", kHddlDomain);
  EXPECT_EQ(LoadDomain(hddl).subtask_order, SubtaskOrder::kKept);
  folder.Write("d.yaml", "subtask_order: causal_links\n");
  EXPECT_THAT(ErrorOf([&] { LoadDomain(hddl); }),
              AllOf(HasSubstr("subtask_order"), HasSubstr(":ordered-subtasks are always kept")));
}

TEST(LoadTest, LanguagesAreNotMixed) {
  const hires::test_support::TemporaryFolder folder;
  const Domain domain = LoadDomain(folder.Write("d.lisp", kShop2Domain));
  const std::string problem = folder.Write("p.hddl", kHddlProblem);
  EXPECT_THAT(ErrorOf([&] { LoadProblems(problem, domain); }),
              AllOf(HasSubstr("p.hddl: is written in HDDL"), HasSubstr("d.lisp in SHOP2")));
}

// Published files differ in this, and other planners go on.
TEST(LoadTest, AProblemOfADomainOfAnotherNameIsWarnedOfAndStrictlyRefused) {
  const hires::test_support::TemporaryFolder folder;
  const std::vector<std::array<std::string, 4>> cases{
      {"d.hddl", kHddlDomain, "(define (problem p)\n (:domain e) (:objects a - place)\n (:htn))",
       "p.hddl:2:2: problem 'p'"},
      {"d.lisp", kShop2Domain, "(defproblem p\n e () ((!go a)))", "p.lisp:2:2: problem 'p'"},
      {"d.lisp", kShop2Domain, "(defproblem\n (p :domain e) () ((!go a)))",
       "p.lisp:2:13: problem 'p'"}};
  for (const auto& [domain_file, domain_text, problem_text, place] : cases) {
    const Domain domain = LoadDomain(folder.Write(domain_file, domain_text));
    const std::string file = "p" + domain_file.substr(1);
    const Problem problem = LoadProblems(folder.Write(file, problem_text), domain).at(0);
    const auto says = AllOf(HasSubstr(place), HasSubstr("'e'"), HasSubstr("'d'"));
    EXPECT_THAT(problem.warnings, ElementsAre(says));
    const PlanResult result = FindPlans(domain, problem);
    EXPECT_EQ(result.outcome, PlanOutcome::kFound);
    EXPECT_THAT(result.doubts, ElementsAre(says));
    PlanRequest request;
    request.strict = true;
    EXPECT_THAT(ErrorOf([&] { FindPlans(domain, problem, request); }), says);
  }
}

TEST(LoadTest, AProblemThatNamesItsDomainOrNoneIsNotWarnedOf) {
  const hires::test_support::TemporaryFolder folder;
  const Domain domain = LoadDomain(folder.Write("d.lisp", kShop2Domain));
  for (const char* text : {"(defproblem p D () ((!go a)))", "(defproblem p () ((!go a)))",
                           "(make-problem 'p 'd '() '((!go a)))"}) {
    EXPECT_THAT(LoadProblems(folder.Write("p.lisp", text), domain).at(0).warnings, IsEmpty());
  }
}

TEST(LoadTest, TasksOfProblemsAreCheckedAgainstTheDomain) {
  const hires::test_support::TemporaryFolder folder;
  const Domain domain = LoadDomain(folder.Write("d.lisp", kShop2Domain));
  const std::string problem = folder.Write("p.lisp", "(defproblem p d ()\n ((!fly a)))");
  EXPECT_THAT(ErrorOf([&] { LoadProblems(problem, domain); }),
              AllOf(HasSubstr("p.lisp:2:3"), HasSubstr("did you mean '!go'")));
}

TEST(LoadTest, TheProblemsBesideOneThatIsWrongCanBePlannedFor) {
  const hires::test_support::TemporaryFolder folder;
  const Domain domain = LoadDomain(folder.Write("d.lisp", kShop2Domain));
  const std::string path =
      folder.Write("p.lisp",
                   "(defproblem p1 d () ((!go a b)))\n(defproblem p2 d () ((!go a)))\n"
                   "(defproblem p3 d () ((!fly a)))\n(defproblem p4 d ((at ?x)) ((!go a)))");
  const std::vector<Problem> problems = LoadProblems(path, domain);
  ASSERT_THAT(problems, SizeIs(4));
  const Problem& good = FindProblem(problems, "P2");
  EXPECT_EQ(FindPlans(domain, good).outcome, PlanOutcome::kFound);
  EXPECT_THAT(good.warnings, ElementsAre(AllOf(HasSubstr("p.lisp:1:22"), HasSubstr("'p1'"),
                                               HasSubstr("(3 such problems)"))));
  EXPECT_THAT(ErrorOf([&] { FindProblem(problems, "p1"); }), HasSubstr("p.lisp:1:22"));
  EXPECT_THAT(ErrorOf([&] { FindProblem(problems, "p3"); }), HasSubstr("did you mean '!go'"));
  EXPECT_THAT(ErrorOf([&] { FindProblem(problems, "p4"); }), HasSubstr("p.lisp:4:19"));
}

TEST(LoadTest, ADomainInTheLanguageOfJshop2IsPlannedFor) {
  const hires::test_support::TemporaryFolder folder;
  const std::string path = folder.Write("d.lisp", R"((defdomain labels (
    (:operator (!stick ?box ?label ?way) () () ((labelled ?box ?label)))
    (:method (mark ?box ?label)
      ((call Member ?label (fragile heavy (call + 1 2))) (assign ?way (by hand ?box)))
      ((!stick ?box ?label ?way)))))
    (defproblem p labels () ((mark b1 heavy)) () ((mark b1 3)) () ((mark b1 light))))");
  const Domain domain = LoadDomain(path);
  const std::vector<Problem> problems = LoadProblems(path, domain);
  ASSERT_THAT(problems, SizeIs(3));
  const PlanResult heavy = FindPlans(domain, problems[0]);
  ASSERT_EQ(heavy.outcome, PlanOutcome::kFound);
  EXPECT_EQ(ToShop2Plan(heavy.plans[0]), "(!stick b1 heavy (by hand b1))\n");
  EXPECT_THAT(ValidatePlan(domain, problems[0], heavy.plans[0]), IsEmpty());
  EXPECT_EQ(FindPlans(domain, problems[1]).outcome, PlanOutcome::kFound);
  EXPECT_EQ(FindPlans(domain, problems[2]).outcome, PlanOutcome::kNoPlan);
}

TEST(LoadTest, AMissingFileIsNamed) {
  EXPECT_THAT(ErrorOf([] { LoadDomain("/nowhere/d.lisp"); }), HasSubstr("/nowhere/d.lisp"));
}

}  // namespace
}  // namespace hires::planning::planning_files_test
