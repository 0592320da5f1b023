#include "cli/verbs/plan/plan_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "cli/command_run.h"
#include "hires/base/text.h"
#include "support/temporary_folder.h"

namespace hires::cli::plan_command_test {
namespace {

using hires::test_support::Capture;
using hires::test_support::Ended;
using hires::test_support::RunHires;
using nlohmann::json;
using test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

std::string Data(const std::string& name) {
  return HIRES_SOURCE_DIR + std::string("/test/reports/data/") + name;
}

/// `hires plan --domain FILE` with more words behind.
Ended Plan(const std::string& domain, const std::vector<std::string>& more) {
  return RunHires({"plan", "--domain", domain}, more);
}

Ended Deliver(const std::string& problem, std::vector<std::string> more = {}) {
  more.insert(more.end(), {"--problem", Data("delivery.lisp"), "--name", problem});
  return Plan(Data("delivery.lisp"), more);
}

Ended Endless(const std::string& problem, std::vector<std::string> more) {
  more.insert(more.end(), {"--name", problem});
  return Plan(Data("endless.lisp"), more);
}

/// The same with --json: what was written.
json JsonOf(const std::function<Ended(const std::vector<std::string>&)>& plan,
            std::vector<std::string> more = {}) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "answer.json").string();
  more.insert(more.end(), {"--json", path});
  plan(more);
  return json::parse(base::ReadTextFile(path));
}

json DeliverAsJson(const std::string& problem, const std::vector<std::string>& more = {}) {
  return JsonOf([&](const auto& words) { return Deliver(problem, words); }, more);
}

json EndlessAsJson(const std::string& problem, const std::vector<std::string>& more) {
  return JsonOf([&](const auto& words) { return Endless(problem, words); }, more);
}

void ExpectRefused(const Ended& ended, const std::vector<std::string>& words) {
  EXPECT_EQ(ended.code, kExitBadInput);
  EXPECT_THAT(ended.out, IsEmpty());
  for (const std::string& word : words) EXPECT_THAT(ended.err, HasSubstr(word));
}

// What is found.

TEST(PlanCommandTest, PrintsStepsWithCostsOrderAndOrigin) {
  const Ended ended = Deliver("two_ways");
  EXPECT_EQ(ended.code, kExitPlanFound) << ended.err;
  EXPECT_THAT(ended.out, StartsWith("#  step                      cost  after  part of\n"));
  EXPECT_THAT(ended.out, HasSubstr("0  (!walk home park)            5         deliver/travel\n"
                                   "1  (!hand_over parcel anna)     1      0  deliver\n"));
  EXPECT_THAT(ended.out, HasSubstr("found: 1 plan, 2 steps, cost 6\n"));
  EXPECT_THAT(ended.out, HasSubstr(" expansions, "));
  EXPECT_THAT(ended.err, IsEmpty());
}

TEST(PlanCommandTest, JsonHasEachStepWithItsReasons) {
  const json answer = DeliverAsJson("two_ways");
  EXPECT_EQ(answer["outcome"], "found");
  ASSERT_EQ(answer["plans"].size(), 1u);
  EXPECT_EQ(answer["plans"][0], json::parse(R"json({
    "cost": 6.0,
    "steps": [
      {"operator": "!walk", "arguments": ["home", "park"], "cost": 5.0,
       "preconditions": ["(at home)"], "deletes": ["(at home)"], "adds": ["(at park)"],
       "links": [{"producer": -1, "precondition": "(at home)"}], "path": "deliver/travel"},
      {"operator": "!hand_over", "arguments": ["parcel", "anna"], "cost": 1.0,
       "preconditions": ["(has parcel)", "(lives anna park)", "(at park)"],
       "deletes": ["(has parcel)"], "adds": ["(given parcel anna)"],
       "links": [{"producer": -1, "precondition": "(has parcel)"},
                 {"producer": -1, "precondition": "(lives anna park)"},
                 {"producer": 0, "precondition": "(at park)"}], "path": "deliver"}],
    "order": [[0, 1]]})json"));
  // deliver, travel, !walk, !hand_over
  EXPECT_EQ(answer["statistics"]["expansions"], 4);
  EXPECT_GT(answer["statistics"]["inferences"], 0);
  EXPECT_GE(answer["statistics"]["cpu_seconds"], 0.0);
  EXPECT_GT(answer["statistics"]["peak_mb"], 1.0);
  EXPECT_FALSE(answer.contains("trace"));
}

TEST(PlanCommandTest, AllPlansComeInTheOrderOfTheMethods) {
  const json answer = DeliverAsJson("two_ways", {"--which", "all"});
  ASSERT_EQ(answer["plans"].size(), 2u);
  EXPECT_EQ(answer["plans"][0]["cost"], 6.0);
  EXPECT_EQ(answer["plans"][1]["cost"], 3.0);
  EXPECT_EQ(answer["exhausted"], true);
  const Ended ended = Deliver("two_ways", {"--which", "all"});
  EXPECT_EQ(ended.code, kExitPlanFound);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("plan 1, cost 6\n"), HasSubstr("plan 2, cost 3\n")));
  EXPECT_THAT(ended.out, HasSubstr("2 plans, the cheapest costs 3; there are no others"));
}

TEST(PlanCommandTest, BestIsTheCheapestAlone) {
  const json answer = DeliverAsJson("two_ways", {"--which", "best"});
  ASSERT_EQ(answer["plans"].size(), 1u);
  EXPECT_EQ(answer["plans"][0]["cost"], 3.0);
  EXPECT_EQ(answer["plans"][0]["steps"][0]["operator"], "!ride");
}

TEST(PlanCommandTest, ANumberOfPlansEndsTheSearch) {
  const json answer = EndlessAsJson("many", {"--which", "all", "--limit", "3"});
  EXPECT_EQ(answer["outcome"], "found");
  EXPECT_EQ(answer["plans"].size(), 3u);
  EXPECT_EQ(answer["exhausted"], false);
}

TEST(PlanCommandTest, AnotherTaskReplacesTheProblems) {
  const Ended ended = Deliver("no_way", {"--task", "travel park", "--format", "shop2"});
  EXPECT_EQ(ended.code, kExitPlanFound) << ended.err;
  EXPECT_EQ(ended.out, "(!walk home park)\n");
  const Ended network = Deliver(
      "two_ways", {"--task", "((travel park) (!hand_over parcel anna))", "--format", "shop2"});
  EXPECT_EQ(network.out, "(!walk home park)\n(!hand_over parcel anna)\n");
}

TEST(PlanCommandTest, AnEmptyOptionIsNotTakenForNone) {
  for (const std::string option : {"--task", "--problem", "--name", "--json"}) {
    for (const std::string empty : {"", "  "}) {
      ExpectRefused(Plan(Data("delivery.lisp"), {option, empty}), {option, "an empty text came"});
    }
  }
}

TEST(PlanCommandTest, TheProblemMayStandInTheDomainsFile) {
  const Ended ended = Plan(Data("delivery.lisp"), {"--name", "Two_Ways", "--format", "shop2"});
  EXPECT_EQ(ended.code, kExitPlanFound) << ended.err;
}

// Formats.

TEST(PlanCommandTest, Shop2FormatIsTheBarePlanAndTheRestGoesToStandardError) {
  const Ended ended = Deliver("two_ways", {"--format", "shop2", "--which", "all"});
  EXPECT_EQ(ended.out,
            "(!walk home park)\n(!hand_over parcel anna)\n\n"
            "(!ride home park)\n(!hand_over parcel anna)\n");
  EXPECT_THAT(ended.err, StartsWith("found: 2 plans"));
}

TEST(PlanCommandTest, IpcFormatOfAnHddlProblem) {
  const Ended ended = Plan(
      Data("lamp.hddl"), {"--problem", Data("lamp_problem.hddl"), "--format", "ipc", "--validate"});
  EXPECT_EQ(ended.code, kExitPlanFound) << ended.err;
  EXPECT_EQ(ended.out, "==>\n0 press s1\nroot 1\n1 light s1 -> m_press 0\n<==\n");
  EXPECT_THAT(ended.err, StartsWith("plan 1 is valid\nfound: 1 plan, 1 step, cost 1"));
}

TEST(PlanCommandTest, ValidateSaysForEachPlanThatItIsValid) {
  const Ended ended = Deliver("two_ways", {"--validate", "--which", "all"});
  EXPECT_EQ(ended.code, kExitPlanFound);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("plan 1 is valid\n"), HasSubstr("plan 2 is valid\n")));
  const json answer = DeliverAsJson("two_ways", {"--validate"});
  EXPECT_EQ(answer["plans"][0]["violations"], json::array());
}

TEST(PlanCommandTest, TraceSaysWhyWaysWereGivenUp) {
  const Ended ended = Deliver("no_way", {"--trace"});
  EXPECT_THAT(ended.out, AllOf(HasSubstr("given up because"), HasSubstr("(travel island)")));
  const json answer = DeliverAsJson("no_way", {"--trace"});
  ASSERT_GE(answer["trace"].size(), 2u);
  EXPECT_EQ(answer["trace"][0]["task"], "(travel island)");
}

// What is not found.

TEST(PlanCommandTest, NoPlanIsAnOutcomeOfItsOwn) {
  const Ended ended = Deliver("no_way");
  EXPECT_EQ(ended.code, kExitNoPlan);
  EXPECT_THAT(ended.out,
              AllOf(HasSubstr("no_plan: there is no plan; every way was tried; it got as far as "),
                    HasSubstr("(travel island): no binding satisfies goal 2 (path home island)")));
  const json answer = DeliverAsJson("no_way");
  EXPECT_EQ(answer["outcome"], "no_plan");
  EXPECT_EQ(answer["plans"], json::array());
  EXPECT_EQ(answer["exhausted"], true);
}

TEST(PlanCommandTest, EachLimitIsAnOutcomeOfItsOwn) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"--time", "0.001"}, "limit_time"},
      {{"--memory", "0.001"}, "limit_memory"},
      {{"--depth", "2"}, "limit_depth"}};
  for (const auto& [words, outcome] : cases) {
    const Ended ended = Endless("forever", words);
    EXPECT_EQ(ended.code, kExitLimit) << outcome;
    EXPECT_THAT(ended.out, HasSubstr(outcome + ": "));
    EXPECT_THAT(ended.out, HasSubstr("no plan found so far; allow more"));
    const json answer = EndlessAsJson("forever", words);
    EXPECT_EQ(answer["outcome"], outcome);
    EXPECT_EQ(answer["exhausted"], false);
  }
}

TEST(PlanCommandTest, WhoeverInterruptsGetsWhatWasFound) {
  PlanOptions options;
  options.domain = options.problem = Data("endless.lisp");
  options.name = "many";
  options.which = "best";
  int questions = 0;
  const Ended ended =
      Capture([&] { return RunPlanVerb(options, [&] { return ++questions > 3; }); });
  EXPECT_EQ(ended.code, kExitCancelled);
  EXPECT_THAT(ended.out, HasSubstr("39  (!mark n40 "));
  EXPECT_THAT(ended.out, HasSubstr("cancelled: cancelled after "));
  EXPECT_THAT(ended.out, HasSubstr("1 plan, 40 steps, cost 40 so far"));
}

TEST(PlanCommandTest, EqualQuestionsGetEqualAnswers) {
  const auto without_costs = [](json answer) {
    answer["statistics"].erase("cpu_seconds");
    answer["statistics"].erase("peak_mb");
    answer["report"].erase("command");  // names the folder of the answer
    return answer;
  };
  const std::vector<std::string> words{"--which", "all", "--limit", "20"};
  EXPECT_EQ(without_costs(EndlessAsJson("many", words)),
            without_costs(EndlessAsJson("many", words)));
}

// Bad input.

TEST(PlanCommandTest, SeveralProblemsAndNoNameListsThem) {
  ExpectRefused(Plan(Data("delivery.lisp"), {}), {"has 2 problems", "--name", "two_ways, no_way"});
}

TEST(PlanCommandTest, AnUnknownProblemNamesTheNearest) {
  ExpectRefused(Deliver("two_wasy"), {"problem 'two_wasy' is unknown", "'two_ways'"});
}

TEST(PlanCommandTest, FilesThatAreMissingOrOfTheOtherLanguage) {
  ExpectRefused(Plan("/nowhere/domain.lisp", {}), {"/nowhere/domain.lisp", "no such file"});
  ExpectRefused(Plan(Data("delivery.lisp"), {"--problem", Data("lamp_problem.hddl")}),
                {"lamp_problem.hddl"});
}

TEST(PlanCommandTest, ASidecarThatNothingCouldBeCarriedOutWith) {
  const TemporaryFolder folder;
  const std::string domain =
      folder.Write("delivery.lisp", base::ReadTextFile(Data("delivery.lisp")));
  folder.Write("delivery.yaml", "capacities: {}\nlegs: []\noperators: {walk: {}}\n");
  ExpectRefused(Plan(domain, {"--name", "two_ways"}), {"delivery.yaml", "operators."});
}

TEST(PlanCommandTest, TasksThatNobodyKnowsOrThatAreNoTasks) {
  ExpectRefused(Deliver("two_ways", {"--task", "delivr parcel anna"}), {"--task", "'deliver'"});
  ExpectRefused(Deliver("two_ways", {"--task", "(deliver parcel"}), {"--task:1:1"});
  ExpectRefused(Deliver("two_ways", {"--task", "deliver parcel"}), {"--task", "deliver"});
  ExpectRefused(Deliver("two_ways", {"--task", " "}), {"--task", "an empty text came"});
}

TEST(PlanCommandTest, OptionsOutOfRange) {
  ExpectRefused(Deliver("two_ways", {"--which", "any"}), {"--which", "first"});
  ExpectRefused(Deliver("two_ways", {"--format", "pddl"}), {"--format", "shop2"});
  ExpectRefused(Deliver("two_ways", {"--limit", "0"}), {"--limit"});
  ExpectRefused(Deliver("two_ways", {"--time", "-1"}), {"--time", "'-1' is out of range"});
  ExpectRefused(Deliver("two_ways", {"--time", "abc"}), {"--time", "'abc' is not a number"});
  ExpectRefused(Deliver("two_ways", {"--json", "/nowhere/answer.json"}), {"/nowhere"});
  ExpectRefused(RunHires({"plan"}), {"--domain"});
}

TEST(PlanCommandTest, HelpIsNoError) {
  const Ended ended = RunHires({"plan", "--help"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("--which"), HasSubstr("--format"), Not(IsEmpty())));
}

}  // namespace
}  // namespace hires::cli::plan_command_test
