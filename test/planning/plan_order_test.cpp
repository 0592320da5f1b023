#include "hires/planning/plan_order.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "hires/base/rng.h"
#include "hires/planning/reasons.h"
#include "hires/planning/step_replay.h"
#include "planning/support/conditions.h"
#include "planning/support/plans.h"
#include "support/rounds.h"

namespace hires::planning::plan_order_test {
namespace {

using hires::test_support::DomainOf;
using hires::test_support::FlatPlan;
using hires::test_support::FlatProblem;
using hires::test_support::Text;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

using Order = std::vector<std::pair<int, int>>;

/// A domain in which the order of subtasks does not count.
Domain FreeDomainOf(const std::string& items) {
  Domain domain = DomainOf(items);
  domain.subtask_order = SubtaskOrder::kCausalLinks;
  return domain;
}

Order OrderOf(const std::string& items, const std::string& facts,
              const std::vector<std::string>& steps) {
  Plan plan = FlatPlan(steps);
  AddReasons(FreeDomainOf(items), FlatProblem(facts, steps), &plan);
  return PartialOrder(plan);
}

const std::string kItems =
    "(:operator (!make ?x) () () ((p ?x))) (:operator (!break ?x) () ((p ?x)) ())"
    "(:operator (!use ?x) ((p ?x)) () ()) (:operator (!mind ?x) ((not (p ?x))) () ())"
    "(:operator (!mind-all) ((not (p ?x))) () ())"
    "(:operator (!check) ((forall (?x) (p ?x) (q ?x))) () ())"
    "(:operator (!hold ?x) () () ((:protection (p ?x))))"
    "(:operator (!release ?x) () ((:protection (p ?x))) ())"
    "(:operator (!idle) () () ())"
    "(:operator (!sweep) () ((forall (?x) ((p ?x)) ((p ?x)))) ())";

TEST(PartialOrderTest, StepsThatShareNothingAreFree) {
  EXPECT_THAT(OrderOf(kItems, "()", {"(!make a)", "(!make b)", "(!idle)"}), IsEmpty());
  EXPECT_THAT(PartialOrder(Plan()), IsEmpty());
}

TEST(PartialOrderTest, TheProducerComesBeforeTheConsumer) {
  EXPECT_THAT(OrderOf(kItems, "()", {"(!make a)", "(!make b)", "(!use a)"}),
              ElementsAre(Pair(0, 2)));
}

TEST(PartialOrderTest, WhoeverBreaksALinkStaysBehindIt) {
  EXPECT_THAT(OrderOf(kItems, "((p a))", {"(!use a)", "(!break a)"}), ElementsAre(Pair(0, 1)));
}

TEST(PartialOrderTest, WhoeverBreaksALinkStaysBeforeIt) {
  EXPECT_THAT(OrderOf(kItems, "((p a))", {"(!break a)", "(!make a)", "(!use a)"}),
              ElementsAre(Pair(0, 1), Pair(1, 2)));
}

TEST(PartialOrderTest, WhoeverAddsWhatMustNotHoldStaysOnItsSide) {
  EXPECT_THAT(OrderOf(kItems, "()", {"(!mind a)", "(!make a)", "(!make b)"}),
              ElementsAre(Pair(0, 1)));
  EXPECT_THAT(OrderOf(kItems, "()", {"(!mind-all)", "(!make a)", "(!make b)"}),
              ElementsAre(Pair(0, 1), Pair(0, 2)));
}

TEST(PartialOrderTest, EveryStepThatTookAMatchAwayComesBeforeWhoeverNeedsNone) {
  EXPECT_THAT(OrderOf(kItems, "((p a) (p b))", {"(!break a)", "(!break b)", "(!mind-all)"}),
              ElementsAre(Pair(0, 2), Pair(1, 2)));
}

TEST(PartialOrderTest, AddingAndDeletingOneAtomKeepTheirOrder) {
  EXPECT_THAT(OrderOf(kItems, "()", {"(!make a)", "(!break a)", "(!make a)"}),
              ElementsAre(Pair(0, 1), Pair(1, 2)));
}

TEST(PartialOrderTest, ADeleteThatFoundNothingStaysBeforeTheAdd) {
  EXPECT_THAT(OrderOf(kItems, "()", {"(!break a)", "(!make a)"}), ElementsAre(Pair(0, 1)));
}

TEST(PartialOrderTest, AddingWhatIsThereWaitsForNobody) {
  EXPECT_THAT(OrderOf(kItems, "()", {"(!make a)", "(!make a)", "(!use a)"}),
              ElementsAre(Pair(0, 2)));
}

TEST(PartialOrderTest, NewInstancesOfAForallStayBehindIt) {
  EXPECT_THAT(OrderOf(kItems, "((p a) (q a))", {"(!check)", "(!make b)"}), ElementsAre(Pair(0, 1)));
}

TEST(PartialOrderTest, WhatAConditionalEffectLooksAtKeepsItsSide) {
  EXPECT_THAT(OrderOf(kItems, "()", {"(!sweep)", "(!make a)", "(!idle)"}), ElementsAre(Pair(0, 1)));
}

TEST(PartialOrderTest, AProtectedAtomIsLeftAloneUntilItsProtectionEnds) {
  EXPECT_THAT(OrderOf(kItems, "((p a))", {"(!hold a)", "(!release a)", "(!break a)"}),
              ElementsAre(Pair(0, 1), Pair(1, 2)));
}

TEST(PartialOrderTest, BookkeepingIsLikeOtherSteps) {
  EXPECT_THAT(OrderOf("(:operator (!!note ?x) () () ((noted ?x)) 0)"
                      "(:operator (!read ?x) ((noted ?x)) () ())",
                      "()", {"(!!note a)", "(!read a)"}),
              ElementsAre(Pair(0, 1)));
}

// -------------------------------------------------------------------------- the order of subtasks

const std::string kSteps =
    "(:operator (!a) () () ()) (:operator (!b) () () ()) (:operator (!c) () () ())"
    "(:operator (!imagine ?what) () () ()) (:method (nothing) () ())";

/// The order of the first plan for the tasks; nothing touches anything.
Order SubtaskOrderOf(const std::string& methods, const std::string& tasks) {
  const Domain domain = DomainOf(kSteps + methods);
  const Problem problem = hires::test_support::ProblemOf("()", tasks);
  Plan plan = hires::test_support::FirstPlan(domain, problem);
  AddReasons(domain, problem, &plan);
  return PartialOrder(plan);
}

TEST(SubtaskOrderTest, OrderedTasksOfTheProblemStayOrdered) {
  EXPECT_THAT(SubtaskOrderOf("", "((!a) (!b) (!c))"), ElementsAre(Pair(0, 1), Pair(1, 2)));
  EXPECT_THAT(SubtaskOrderOf("", "(:unordered (!a) (!b) (!c))"), IsEmpty());
}

TEST(SubtaskOrderTest, OrderedSubtasksStayOrderedHoweverDeep) {
  const std::string methods = "(:method (both) () ((!a) (!b))) (:method (deep) () ((both)))";
  EXPECT_THAT(SubtaskOrderOf(methods, "((deep) (!c))"), ElementsAre(Pair(0, 1), Pair(1, 2)));
}

TEST(SubtaskOrderTest, EveryStepOfATaskWaitsForEveryStepOfTheOneBefore) {
  const std::string methods = "(:method (both) () (:unordered (!a) (!b)))";
  EXPECT_THAT(SubtaskOrderOf(methods, "((both) (both))"),
              ElementsAre(Pair(0, 2), Pair(0, 3), Pair(1, 2), Pair(1, 3)));
  // Found as (!a) (!c) (!b).
  EXPECT_THAT(SubtaskOrderOf("", "(:unordered (:ordered (!a) (!b)) (!c))"),
              ElementsAre(Pair(0, 2)));
}

TEST(SubtaskOrderTest, ATaskWithoutStepsPassesTheOrderOn) {
  EXPECT_THAT(SubtaskOrderOf("", "((!a) (nothing) (nothing) (!b))"), ElementsAre(Pair(0, 1)));
}

TEST(SubtaskOrderTest, ImaginationHoldsUpNothing) {
  EXPECT_THAT(SubtaskOrderOf("", "((!a) (!imagine !b) (!b))"), ElementsAre(Pair(0, 2)));
}

TEST(SubtaskOrderTest, ADomainMayLeaveTheOrderToCausalLinks) {
  EXPECT_THAT(OrderOf(kItems, "()", {"(!make a)", "(!make b)"}), IsEmpty());
  Plan plan = FlatPlan({"(!make a)", "(!make b)"});
  AddReasons(DomainOf(kItems), FlatProblem("()", {"(!make a)", "(!make b)"}), &plan);
  EXPECT_THAT(PartialOrder(plan), ElementsAre(Pair(0, 1)));
}

TEST(SubtaskOrderTest, APlanThatDoesNotSayHowItCameAboutIsTakenInItsOrder) {
  const std::vector<std::string> steps{"(!make a)", "(!make b)", "(!make c)"};
  Plan plan = FlatPlan(steps);
  plan.nodes.clear();
  EXPECT_THAT(OrderOfSubtasks(DomainOf(kItems), FlatProblem("()", steps), plan),
              ElementsAre(Pair(0, 1), Pair(1, 2)));
  EXPECT_THAT(OrderOfSubtasks(DomainOf(kItems), FlatProblem("()", {"(!make a)"}), FlatPlan(steps)),
              ElementsAre(Pair(0, 1), Pair(1, 2)));
}

TEST(LinearExtensionTest, ThereAreAsManyAsTheOrderLeaves) {
  const auto count = [](int num_steps, const Order& order) {
    int extensions = 0;
    ForEachLinearExtension(num_steps, order, [&](const std::vector<int>&) { return ++extensions; });
    return extensions;
  };
  EXPECT_EQ(count(0, {}), 1);
  EXPECT_EQ(count(4, {}), 24);
  EXPECT_EQ(count(4, {{0, 1}, {2, 3}}), 6);
  EXPECT_EQ(count(4, {{0, 1}, {1, 2}, {2, 3}}), 1);
}

TEST(LinearExtensionTest, EndsWhenItIsToldTo) {
  std::vector<std::vector<int>> seen;
  ForEachLinearExtension(3, {{2, 0}}, [&](const std::vector<int>& order) {
    seen.push_back(order);
    return seen.size() < 2;
  });
  EXPECT_THAT(seen, ElementsAre(ElementsAre(1, 2, 0), ElementsAre(2, 0, 1)));
}

// ----------------------------------------------------------------------------------- properties

/// Operators over the atoms (p a) ... (p d) with every kind of precondition and effect.
const std::string kRandomItems =
    "(:operator (!plain ?x ?y) ((p ?x)) ((p ?x)) ((p ?y)))"
    "(:operator (!copy ?x ?y) ((p ?x)) () ((p ?y)))"
    "(:operator (!blind ?x ?y) () ((p ?x)) ((q ?y)))"
    "(:operator (!absent ?x ?y) ((not (p ?x)) (not (q ?y))) () ((p ?y)))"
    "(:operator (!none ?x) ((not (q ?any))) () ((q ?x)))"
    "(:operator (!every ?x) ((forall (?z) (p ?z) (q ?z))) () ((q ?x) (p ?x)))"
    "(:operator (!some ?x ?y) ((or (p ?x) (q ?x))) ((q ?x)) ((q ?y)))"
    "(:operator (!when ?x ?y) () ((forall () (p ?x) ((q ?y)))) ())"
    "(:operator (!sweep ?x) () ((forall (?z) (q ?z) ((q ?z)))) ((p ?x)))"
    "(:operator (!derived ?x ?y) ((not (both ?x))) ((p ?y)) ())"
    "(:operator (!hold ?x) ((p ?x)) () ((:protection (p ?x))))"
    "(:operator (!release ?x) () ((:protection (p ?x))) ())"
    "(:- (both ?x) ((p ?x) (q ?x)))";

std::string RandomStep(base::Rng* rng) {
  static const char* const kNames[] = {"!plain", "!copy",  "!blind",   "!absent",
                                       "!some",  "!when",  "!derived", "!none",
                                       "!every", "!sweep", "!hold",    "!release"};
  static const char* const kThings[] = {" a", " b", " c", " d"};
  const int kind = rng->Index(12);
  std::string text = std::string("(") + kNames[kind] + kThings[rng->Index(4)];
  if (kind < 7) text += kThings[rng->Index(4)];
  return text + ")";
}

/// Steps that can be taken one after the other.
std::vector<std::string> RandomSteps(const Domain& domain, const Problem& problem, int num_steps,
                                     base::Rng* rng) {
  std::vector<std::string> steps;
  for (int tries = 0; tries < 500 && static_cast<int>(steps.size()) < num_steps; ++tries) {
    steps.push_back(RandomStep(rng));
    StepReplay replay(domain, problem, Functions::Standard(), false);
    for (const PlanStep& step : FlatPlan(steps).steps) {
      if (replay.Take(step).wrong.empty()) continue;
      steps.pop_back();
      break;
    }
  }
  return steps;
}

std::set<std::string> FinalFacts(const StepReplay& replay) {
  std::set<std::string> facts;
  for (const Datum& fact : replay.facts().FactsAt(replay.moment())) facts.insert(ToString(fact));
  return facts;
}

TEST(PartialOrderPropertyTest, EveryLinearExtensionCanBeExecutedAndEndsInTheSameState) {
  const Domain domain = FreeDomainOf(kRandomItems);
  int num_extensions = 0;
  for (int seed = 0; seed < test_support::Rounds(300); ++seed) {
    base::Rng rng(seed);
    const std::string facts = rng.Bernoulli(0.5) ? "((p a) (p b) (q a))" : "((p c) (q c) (q d))";
    const std::vector<std::string> steps = RandomSteps(domain, FlatProblem(facts, {}), 6, &rng);
    const Problem problem = FlatProblem(facts, steps);
    Plan plan = FlatPlan(steps);
    AddReasons(domain, problem, &plan);
    StepReplay in_order(domain, problem, Functions::Standard(), false);
    for (const PlanStep& step : plan.steps) in_order.Take(step);
    const auto visit = [&](const std::vector<int>& order) {
      StepReplay replay(domain, problem, Functions::Standard(), false);
      for (const int step : order) {
        EXPECT_THAT(replay.Take(plan.steps[step]).wrong, IsEmpty())
            << "seed " << seed << " " << Text(std::vector<Datum>{plan.steps[step].task});
      }
      EXPECT_EQ(FinalFacts(replay), FinalFacts(in_order)) << "seed " << seed;
      ++num_extensions;
      return !::testing::Test::HasFailure();
    };
    ForEachLinearExtension(static_cast<int>(steps.size()), PartialOrder(plan), visit);
    ASSERT_FALSE(::testing::Test::HasFailure()) << ::testing::PrintToString(steps) << facts;
  }
  EXPECT_GT(num_extensions, 1000);
}

/// All pairs that follow from others.
std::set<std::pair<int, int>> Closure(const Order& order, int num_steps) {
  std::set<std::pair<int, int>> closure(order.begin(), order.end());
  for (int k = 0; k < num_steps; ++k) {
    for (int i = 0; i < num_steps; ++i) {
      for (int j = 0; j < num_steps; ++j) {
        if (closure.count({i, k}) > 0 && closure.count({k, j}) > 0) closure.emplace(i, j);
      }
    }
  }
  return closure;
}

TEST(PartialOrderPropertyTest, NoPairFollowsFromOthers) {
  const Domain domain = FreeDomainOf(kRandomItems);
  for (int seed = 0; seed < 50; ++seed) {
    base::Rng rng(seed);
    const std::vector<std::string> steps =
        RandomSteps(domain, FlatProblem("((p a))", {}), 10, &rng);
    Plan plan = FlatPlan(steps);
    AddReasons(domain, FlatProblem("((p a))", steps), &plan);
    const Order order = PartialOrder(plan);
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
    for (std::size_t i = 0; i < order.size(); ++i) {
      EXPECT_LT(order[i].first, order[i].second);
      Order others = order;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      EXPECT_EQ(Closure(others, 10).count(order[i]), 0u) << "seed " << seed;
    }
  }
}

}  // namespace
}  // namespace hires::planning::plan_order_test
