#include "hires/planning/ipc_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/planning/planner.h"
#include "hires/planning/shop2_reader.h"
#include "hires/planning/validator.h"
#include "planning/language/hddl_reader.h"

namespace hires::planning::ipc_plan_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::SizeIs;

// --------------------------------------------------------------------------------------- a problem

const char kDomain[] = R"((define (domain d)
  (:types place thing)
  (:predicates (at ?p - place) (on ?t - thing ?p - place))
  (:task tidy :parameters (?a ?b - thing))
  (:task put :parameters (?t - thing))
  (:task go :parameters (?p - place))
  (:method m_tidy :parameters (?a ?b - thing) :task (tidy ?a ?b)
    :subtasks (and (x (put ?a)) (y (put ?b)) (z (wipe))) :ordering (and (< x z) (< y z)))
  (:method m_put :parameters (?t - thing ?p - place) :task (put ?t) :precondition (on ?t ?p)
    :ordered-subtasks (and (go ?p) (take ?t ?p)))
  (:method m_go :parameters (?p ?q - place) :task (go ?p) :precondition (at ?q)
    :ordered-subtasks (drive ?q ?p))
  (:method m_stay :parameters (?p - place) :task (go ?p) :precondition (at ?p))
  (:action drive :parameters (?q ?p - place) :precondition (at ?q)
    :effect (and (not (at ?q)) (at ?p)))
  (:action take :parameters (?t - thing ?p - place) :precondition (and (at ?p) (on ?t ?p))
    :effect (not (on ?t ?p)))
  (:action wipe)))";

const char kProblem[] = R"((define (problem p) (:domain d)
  (:objects t1 t2 - place mug jug - thing)
  (:htn :subtasks (tidy mug jug)) (:init (at t1) (on mug t1) (on jug t2))))";

const char kPlan[] = R"(==>
0 take mug t1
1 drive t1 t2
2 take jug t2
3 wipe
root 4
4 tidy mug jug -> m_tidy 5 7 3
5 put mug -> m_put 6 0
6 go t1 -> m_stay
7 put jug -> m_put 8 2
8 go t2 -> m_go 1
<==
)";

Domain TestDomain() { return ReadHddlDomain(kDomain, "d.hddl"); }

Plan Read(const std::string& text) {
  const Domain domain = TestDomain();
  return ReadIpcPlan(text, "plan.txt", domain, ReadHddlProblem(kProblem, "p.hddl", domain));
}

std::string Replaced(const std::string& from, const std::string& to) {
  std::string text = kPlan;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

const PlanNode& NodeOf(const Plan& plan, const std::string& task) {
  for (const PlanNode& node : plan.nodes) {
    if (ToString(node.task) == task) return node;
  }
  throw std::runtime_error("no node " + task);
}

// ----------------------------------------------------------------------------------- HDDL and back

TEST(ReadIpcPlanTest, StepsAndDecompositionAreFound) {
  const Plan plan = Read(kPlan);
  ASSERT_THAT(plan.steps, SizeIs(4));
  EXPECT_EQ(ToString(plan.steps[1].task), "(!drive t1 t2)");
  EXPECT_THAT(plan.steps[1].bindings,
              ElementsAre(Pair("?p", MakeSymbol("t2")), Pair("?q", MakeSymbol("t1"))));
  ASSERT_THAT(plan.nodes, SizeIs(10));
  EXPECT_THAT(plan.nodes[0].children, SizeIs(1));
  const PlanNode& tidy = NodeOf(plan, "(tidy mug jug)");
  EXPECT_EQ(tidy.parent, 0);
  EXPECT_EQ(tidy.label, "m_tidy");
  EXPECT_THAT(tidy.children, SizeIs(3));
  EXPECT_EQ(plan.nodes[tidy.children[2]].step, 3);
  EXPECT_EQ(plan.steps[3].node, tidy.children[2]);
  EXPECT_EQ(NodeOf(plan, "(go t2)").method, 2);
  EXPECT_EQ(NodeOf(plan, "(go t2)").branch, 0);
}

TEST(ReadIpcPlanTest, VariablesAreBoundByHeadAndSubtasks) {
  const Plan plan = Read(kPlan);
  EXPECT_THAT(NodeOf(plan, "(put jug)").bindings,
              ElementsAre(Pair("?p", MakeSymbol("t2")), Pair("?t", MakeSymbol("jug"))));
  EXPECT_THAT(NodeOf(plan, "(go t2)").bindings,
              ElementsAre(Pair("?p", MakeSymbol("t2")), Pair("?q", MakeSymbol("t1"))));
}

TEST(ReadIpcPlanTest, TasksAreDecomposedBeforeTheirFirstStep) {
  const Plan plan = Read(kPlan);
  EXPECT_EQ(NodeOf(plan, "(tidy mug jug)").at_step, 0);
  EXPECT_EQ(NodeOf(plan, "(put jug)").at_step, 1);
  EXPECT_EQ(NodeOf(plan, "(go t1)").at_step, 0);  // without steps, before the task after it
}

TEST(ReadIpcPlanTest, ATaskWithoutStepsComesAfterWhatIsOrderedBeforeIt) {
  const Domain domain = ReadHddlDomain(R"((define (domain d) (:task t) (:task u) (:action a)
    (:method m :task (t) :ordered-subtasks (and (a) (u) (u) (a))) (:method e :task (u))))",
                                       "d");
  const Problem problem =
      ReadHddlProblem("(define (problem p) (:domain d) (:htn :subtasks (t)))", "p", domain);
  const Plan plan = ReadIpcPlan("==>\n0 a\n1 a\nroot 2\n2 t -> m 0 3 4 1\n3 u -> e\n4 u -> e\n",
                                "plan", domain, problem);
  std::vector<int> moments;
  for (const PlanNode& node : plan.nodes) {
    if (node.label == "e") moments.push_back(node.at_step);
  }
  EXPECT_THAT(moments, ElementsAre(1, 1));
}

TEST(ReadIpcPlanTest, WhatIsWrittenIsReadAgain) {
  EXPECT_EQ(ToIpcPlan(TestDomain(), Read(kPlan)), kPlan);
}

TEST(ReadIpcPlanTest, SubtasksMayComeInAnyOrderThatTheMethodAllows) {
  EXPECT_EQ(ToIpcPlan(TestDomain(), Read(Replaced("m_tidy 5 7 3", "m_tidy 7 5 3"))), kPlan);
}

TEST(ReadIpcPlanTest, OtherNumbersNoiseAndAnArtificialRootAreFine) {
  const std::string text = R"(Parsing (done
a line that is no Lisp: ) " | #<
  ==>
100 take mug t1
3 Drive t1 t2

7 take jug t2 ; a comment
1 wipe
root 999
999 __top -> __top_method 4
4 tidy mug jug -> m_tidy 5 70 1
5 put mug -> m_put 6 100
6 go t1 -> m_stay
70 put jug -> m_put 8 7
8 go t2 -> m_go 3
<==
after it ( everything goes
)";
  EXPECT_EQ(ToIpcPlan(TestDomain(), Read(text)), kPlan);
}

TEST(ReadIpcPlanTest, PlansOfNothingAreRead) {
  const Domain domain = ReadHddlDomain("(define (domain d))", "d");
  const Problem problem = ReadHddlProblem("(define (problem p) (:domain d) (:htn))", "p", domain);
  const Plan plan = ReadIpcPlan("==>\nroot\n<==\n", "plan", domain, problem);
  EXPECT_THAT(plan.steps, IsEmpty());
  EXPECT_EQ(ToIpcPlan(domain, plan), "==>\nroot\n<==\n");
}

// -------------------------------------------------------------------------------------------
// errors

struct BadPlan {
  std::string text;
  std::vector<std::string> message;
};

std::ostream& operator<<(std::ostream& out, const BadPlan& bad) { return out << bad.text; }

BadPlan With(const std::string& from, const std::string& to, std::vector<std::string> message) {
  return {Replaced(from, to), std::move(message)};
}

class BadIpcPlanTest : public testing::TestWithParam<BadPlan> {};

TEST_P(BadIpcPlanTest, IsRefusedWithPlaceAndRemedy) {
  std::string message = "no error";
  try {
    Read(GetParam().text);
  } catch (const base::ConfigError& error) {
    message = error.what();
  }
  for (const std::string& part : GetParam().message) EXPECT_THAT(message, HasSubstr(part));
}

INSTANTIATE_TEST_SUITE_P(
    Texts, BadIpcPlanTest,
    testing::Values(
        BadPlan{"", {"plan.txt:1:1", "no line ==>"}},
        BadPlan{"==>\n0 wipe\n", {"no line 'root ...'", "cut off"}},
        With("1 drive t1 t2", "1 (drive t1 t2", {"plan.txt:3:3"}),
        With("1 drive t1 t2", "x drive t1 t2", {"plan.txt:3:1", "x stands where the id"}),
        With("1 drive t1 t2", "-1 drive t1 t2", {"-1 stands where the id"}),
        With("1 drive t1 t2", "0 drive t1 t2", {"plan.txt:3:1", "id 0 is used twice"}),
        With("1 drive t1 t2", "1", {"plan.txt:3:1", "wanted 'id task arguments'"}),
        With("1 drive t1 t2", "1 5 t1", {"plan.txt:3:1", "wanted 'id task arguments'"}),
        With("1 drive t1 t2", "1 driv t1 t2", {"primitive task 'driv' is unknown", "'drive'"}),
        With("1 drive t1 t2", "1 drive t1",
             {"plan.txt:3:1", "(!drive t1) does not fit (!drive ?q ?p)"}),
        With("root 4", "root 4\nroot 4", {"plan.txt:7:1", "a second line 'root"}),
        With("root 4", "root", {"task 4 is not below 'root'"}),
        With("root 4", "root 44", {"plan.txt:6:1", "id 44 stands for no task"}),
        With("root 4", "root 5\n4 go t1 -> m_go 1", {"id 4 is used twice"}),
        With("<==", "9 wipe", {"plan.txt:12:1", "a step stands behind 'root ...'"}),
        With("<==", "9 go t1 -> m_stay", {"plan.txt:12:1", "task 9 is not below 'root'"}),
        With("m_tidy 5 7 3", "m_tidy 5 7 3 3", {"plan.txt:7:1", "task 3 is a subtask twice"}),
        With("m_tidy 5 7 3", "m_tidy 5 3 7\n9 go t1 -> m_go 9",
             {"plan.txt:8:1", "task 9 is not below 'root'"}),
        With("-> m_stay", "->", {"no method stands behind '->'"}),
        With("6 go t1 -> m_stay", "6 -> m_stay", {"wanted 'id task arguments'"}),
        With("-> m_stay", "-> m_sta",
             {"plan.txt:9:1", "method of task 'go' 'm_sta' is unknown", "'m_stay'"}),
        With("6 go t1 -> m_stay", "6 goo t1 -> m_stay", {"compound task 'goo' is unknown"}),
        With("5 put mug", "5 put jug", {"plan.txt:7:1", "do not fit method 'm_tidy'"}),
        With("4 tidy mug jug", "4 tidy jug mug", {"plan.txt:6:1", "not those of problem 'p'"}),
        With("m_put 6 0", "m_put 0", {"task 6 is not below 'root'"}),
        With("0 take mug t1\n1 drive t1 t2\n2 take jug t2\n3 wipe",
             "3 wipe\n0 take mug t1\n1 drive t1 t2\n2 take jug t2",
             {"plan.txt:7:1", "another order"})));

// --------------------------------------------------------------------------------------------
// SHOP2

/// Methods with and without names, labels and several branches; lists, strings and numbers as
/// arguments; a step of bookkeeping.
const char kShopDomain[] = R"((defdomain d (
  (:operator (!load ?x) () () ())
  (:operator (!!note ?x) () () ())
  (:operator (!note ?x) () () ())
  (:method (all ?x) ((p)) ((one (a b) ?x)) () ((one ?x ?x)))
  (:method (one ?x ?y) first () ((!load ?x) (!!note ?y)) second () ((!note ?x)))
  (:method (one ?x ?y) third () (:ordered (!load ?x) (:unordered (!note 1.5) (!note ?y)))))))";

/// The tree of a plan from nodes given as (task, parent, method, branch).
struct NodeSpec {
  std::string task;
  int parent;
  int method;
  int branch;
};

Plan MakePlan(const std::vector<NodeSpec>& specs) {
  Plan plan;
  plan.nodes.resize(1);
  for (const NodeSpec& spec : specs) {
    const int index = static_cast<int>(plan.nodes.size());
    PlanNode node;
    node.task = ReadShop2Problems("(defproblem p d () (" + spec.task + "))", "p")
                    .at(0)
                    .tasks.items.at(0)
                    .task;
    node.parent = spec.parent;
    node.method = spec.method;
    node.branch = spec.branch;
    if (spec.method < 0) {
      node.step = static_cast<int>(plan.steps.size());
      plan.steps.emplace_back();
      plan.steps.back().task = node.task;
      plan.steps.back().node = index;
    }
    plan.nodes[spec.parent].children.push_back(index);
    plan.nodes.push_back(std::move(node));
  }
  return plan;
}

TEST(ToIpcPlanTest, Shop2PlansNameMethodsByLabelOrNumber) {
  const Domain domain = ReadShop2Domain(kShopDomain, "d.lisp");
  const Plan plan = MakePlan({{"(all (x (y . z)))", 0, 0, 1},
                              {"(one (x (y . z)) (x (y . z)))", 1, 1, 0},
                              {"(!load (x (y . z)))", 2, -1, -1},
                              {"(!!note (x (y . z)))", 2, -1, -1},
                              {"(one a nil)", 0, 2, 0},
                              {"(!load a)", 5, -1, -1},
                              {"(!note 1.5)", 5, -1, -1},
                              {"(!note nil)", 5, -1, -1}});
  EXPECT_EQ(ToIpcPlan(domain, plan), R"(==>
0 load (x (y . z))
1 !note (x (y . z))
2 load a
3 note 1.5
4 note nil
root 5 7
5 all (x (y . z)) -> all-1/2 6
6 one (x (y . z)) (x (y . z)) -> first 0 1
7 one a nil -> third 2 3 4
<==
)");
}

TEST(ToIpcPlanTest, Shop2PlansAreReadAgain) {
  const Domain domain = ReadShop2Domain(kShopDomain, "d.lisp");
  const Problem problem = ReadShop2Problems(
      "(defproblem p d () (:unordered (all (x (y . z))) (:ordered (one a ()))))", "p.lisp")[0];
  const Plan plan = MakePlan({{"(all (x (y . z)))", 0, 0, 1},
                              {"(one (x (y . z)) (x (y . z)))", 1, 1, 0},
                              {"(!load (x (y . z)))", 2, -1, -1},
                              {"(!!note (x (y . z)))", 2, -1, -1},
                              {"(one a nil)", 0, 2, 0},
                              {"(!load a)", 5, -1, -1},
                              {"(!note 1.5)", 5, -1, -1},
                              {"(!note nil)", 5, -1, -1}});
  const std::string text = ToIpcPlan(domain, plan);
  const Plan again = ReadIpcPlan(text, "plan.txt", domain, problem);
  EXPECT_EQ(ToIpcPlan(domain, again), text);
  EXPECT_EQ(NodeOf(again, "(one a nil)").method, 2);
  EXPECT_EQ(NodeOf(again, "(all (x (y . z)))").branch, 1);
}

TEST(ToIpcPlanTest, ANestedOrderIsChecked) {
  const Domain domain = ReadShop2Domain(kShopDomain, "d.lisp");
  const Problem problem = ReadShop2Problems("(defproblem p d () ((one a b)))", "p.lisp")[0];
  EXPECT_NO_THROW(
      ReadIpcPlan("==>\n0 load a\n1 note b\n2 note 1.5\nroot 3\n3 one a b -> third 0 1 2\n", "plan",
                  domain, problem));
  EXPECT_THROW(
      ReadIpcPlan("==>\n0 note 1.5\n1 load a\n2 note b\nroot 3\n3 one a b -> third 1 0 2\n", "plan",
                  domain, problem),
      base::ConfigError);
}

// ------------------------------------------------------------------------------- plans of the
// search

struct HddlCase {
  std::string domain;
  std::string problem;
};

void ExpectSolvedAndValid(const HddlCase& files) {
  const Domain domain = ReadHddlDomain(base::ReadTextFile(files.domain), files.domain);
  const Problem problem = ReadHddlProblem(base::ReadTextFile(files.problem), files.problem, domain);
  const PlanResult result = FindPlans(domain, problem);
  ASSERT_EQ(result.outcome, PlanOutcome::kFound) << files.problem;
  const Plan& plan = result.plans.at(0);
  EXPECT_THAT(ValidatePlan(domain, problem, plan), IsEmpty()) << files.problem;
  const std::string text = ToIpcPlan(domain, plan);
  const Plan again = ReadIpcPlan(text, "plan.txt", domain, problem);
  EXPECT_EQ(ToIpcPlan(domain, again), text);
  EXPECT_THAT(ValidatePlan(domain, problem, again), IsEmpty()) << text;
}

class SmallHddlTest : public testing::TestWithParam<std::string> {};

HddlCase SmallCase(const std::string& name) {
  const std::string start = std::string(HIRES_SOURCE_DIR) + "/test/planning/data/" + name;
  return {start + "_domain.hddl", start + "_problem.hddl"};
}

TEST_P(SmallHddlTest, IsSolvedAndThePlanIsValidAlsoWhenReadAgain) {
  ExpectSolvedAndValid(SmallCase(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Domains, SmallHddlTest,
                         testing::Values("transport", "towers", "rover", "rescue"));

PlanResult SolveSmall(const std::string& name, Which which) {
  const HddlCase files = SmallCase(name);
  const Domain domain = ReadHddlDomain(base::ReadTextFile(files.domain), files.domain);
  PlanRequest request;
  request.which = which;
  return FindPlans(
      domain, ReadHddlProblem(base::ReadTextFile(files.problem), files.problem, domain), request);
}

TEST(SmallHddlCostsTest, TheTowersOfHanoiTakeFifteenMoves) {
  const PlanResult result = SolveSmall("towers", Which::kAll);
  ASSERT_THAT(result.plans, SizeIs(1));
  EXPECT_THAT(result.plans[0].steps, SizeIs(15));
  EXPECT_EQ(result.plans[0].cost, 15.0);
}

TEST(SmallHddlCostsTest, TheCheapestWayIsTheLengthOfItsRoads) {
  const PlanResult result = SolveSmall("transport", Which::kBest);
  ASSERT_THAT(result.plans, SizeIs(1));
  EXPECT_EQ(result.plans[0].cost, 64.0);
}

// ------------------------------------------------------------------------------------- shared
// files

class SharedHddlTest : public testing::TestWithParam<HddlCase> {
 protected:
  static std::string Folder() { return std::string(HIRES_SHARED_DATA) + "/htn/hddl/"; }
  void SetUp() override {
    if (!std::filesystem::exists(Folder())) {
      GTEST_SKIP() << "the folder of example problems is missing (HIRES_SHARED_DATA)";
    }
  }
};

std::ostream& operator<<(std::ostream& out, const HddlCase& files) { return out << files.problem; }

TEST_P(SharedHddlTest, IsSolvedAndThePlanIsValidAlsoWhenReadAgain) {
  ExpectSolvedAndValid({Folder() + GetParam().domain, Folder() + GetParam().problem});
}

INSTANTIATE_TEST_SUITE_P(Problems, SharedHddlTest,
                         testing::Values(HddlCase{"snake/domain.hddl", "snake/pb01.snake.hddl"},
                                         HddlCase{"snake/domain.hddl", "snake/pb05.snake.hddl"},
                                         HddlCase{"tidy/domain.hddl", "tidy/tidy01.hddl"}));

TEST_F(SharedHddlTest, ThePlanOfAnotherPlannerIsReadAndValid) {
  const std::string start = Folder() + "tidy/";
  const Domain domain = ReadHddlDomain(base::ReadTextFile(start + "domain.hddl"), "domain.hddl");
  const Problem problem =
      ReadHddlProblem(base::ReadTextFile(start + "tidy01.hddl"), "tidy01.hddl", domain);
  const Plan plan = ReadIpcPlan(base::ReadTextFile(start + "tidy01.plan.txt"), "tidy01.plan.txt",
                                domain, problem);
  EXPECT_THAT(plan.steps, SizeIs(10));
  EXPECT_EQ(DecompositionPath(plan, 1), "tidy_up/put_away");
  EXPECT_THAT(ValidatePlan(domain, problem, plan), IsEmpty());
}

}  // namespace
}  // namespace hires::planning::ipc_plan_test
