#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/planning/planner.h"
#include "hires/planning/shop2_reader.h"
#include "hires/planning/validator.h"
#include "planning/language/hddl_reader.h"

namespace hires::planning::passes_test {
namespace {

constexpr int kFacts = 4, kActions = 4, kTasks = 3;

/// "p2" or "(not (p2))", each a conjunct.
std::string Literals(int most, double denied, base::Rng* chance) {
  std::string text;
  for (int i = chance->Index(most + 1); i > 0; --i) {
    const std::string fact = fmt::format("(p{})", chance->Index(kFacts));
    text += chance->Uniform(0.0, 1.0) < denied ? fmt::format(" (not {})", fact) : " " + fact;
  }
  return text;
}

/// Subtasks of which every second pair or so has an order. Compound ones are later ones, so that
/// there is an end.
std::string Network(int task, base::Rng* chance) {
  const int size = chance->Index(4);
  std::string subtasks, ordering;
  for (int i = 0; i < size; ++i) {
    const int later = kTasks - 1 - task;
    const bool is_action = later == 0 || chance->Uniform(0.0, 1.0) < 0.5;
    subtasks += is_action ? fmt::format(" (t{} (a{}))", i, chance->Index(kActions))
                          : fmt::format(" (t{} (c{}))", i, task + 1 + chance->Index(later));
    for (int j = 0; j < i; ++j) {
      if (chance->Uniform(0.0, 1.0) < 0.4) ordering += fmt::format(" (< t{} t{})", j, i);
    }
  }
  if (chance->Uniform(0.0, 1.0) < 0.2) {  // all in a row
    ordering.clear();
    for (int i = 1; i < size; ++i) ordering += fmt::format(" (< t{} t{})", i - 1, i);
  }
  return fmt::format(":subtasks (and{}) :ordering (and{})", subtasks, ordering);
}

std::string RandomDomain(base::Rng* chance) {
  std::string text = "(define (domain d) (:predicates";
  for (int i = 0; i < kFacts; ++i) text += fmt::format(" (p{})", i);
  text += ")\n";
  for (int i = 0; i < kTasks; ++i) text += fmt::format("(:task c{} :parameters ())\n", i);
  for (int i = 0; i < kActions; ++i) {
    text += fmt::format("(:action a{} :parameters () :precondition (and{}) :effect (and{}))\n", i,
                        Literals(2, 0.4, chance), Literals(2, 0.4, chance));
  }
  for (int i = 0; i < kTasks; ++i) {
    for (int k = chance->Index(3); k >= 0; --k) {
      text += fmt::format("(:method m{}_{} :parameters () :task (c{}) :precondition (and{}) {})\n",
                          i, k, i, Literals(1, 0.3, chance), Network(i, chance));
    }
  }
  return text + ")";
}

std::string RandomProblem(base::Rng* chance) {
  return fmt::format("(define (problem p) (:domain d) (:htn {}) (:init{}) (:goal (and{})))",
                     Network(0, chance), Literals(2, 0.0, chance), Literals(2, 0.5, chance));
}

/// Tasks of SHOP2, ordered or not, with such lists among them.
std::string NestedTasks(int task, int depth, base::Rng* chance) {
  std::string text = chance->Index(2) == 0 ? "(:unordered" : "(:ordered";
  for (int i = chance->Index(4); i > 0; --i) {
    const int later = kTasks - 1 - task;
    if (depth > 0 && chance->Index(3) == 0) {
      text += " " + NestedTasks(task, depth - 1, chance);
    } else if (later == 0 || chance->Index(2) == 0) {
      text += fmt::format(" (!a{})", chance->Index(kActions));
    } else {
      text += fmt::format(" (c{})", task + 1 + chance->Index(later));
    }
  }
  return text + ")";
}

std::string Shop2Literals(int most, base::Rng* chance) {
  std::string text;
  for (int i = chance->Index(most + 1); i > 0; --i) {
    const char* form = chance->Index(3) == 0 ? " (not (p{}))" : " (p{})";
    text += fmt::format(fmt::runtime(form), chance->Index(kFacts));
  }
  return "(" + text + ")";
}

std::string Facts(base::Rng* chance) {
  std::string text;
  for (int i = chance->Index(3); i > 0; --i) text += fmt::format(" (p{})", chance->Index(kFacts));
  return "(" + text + ")";
}

std::string RandomShop2(base::Rng* chance) {
  std::string text = "(defdomain d (\n";
  for (int i = 0; i < kActions; ++i) {
    text += fmt::format("(:operator (!a{}) {} {} {} {})\n", i, Shop2Literals(2, chance),
                        Facts(chance), Facts(chance), 1 + chance->Index(3));
  }
  for (int i = 0; i < kTasks; ++i) {
    for (int k = chance->Index(3); k >= 0; --k) {
      text += fmt::format("(:method (c{}) {} {})\n", i, Shop2Literals(1, chance),
                          NestedTasks(i, 2, chance));
    }
  }
  return text + ")) (defproblem p d " + Facts(chance) + " (:unordered (c0) (c1)))";
}

PlanResult Find(const Domain& domain, const Problem& problem, Which which, bool loop_check) {
  PlanRequest request;
  request.which = which;
  request.max_plans = 300;
  request.loop_check = loop_check;
  request.stop = [](const Progress& progress) {
    return progress.expansions > 20'000 ? Stop::kTime : Stop::kContinue;
  };
  return FindPlans(domain, problem, request);
}

/// How often there was a plan, none, and all to compare the cheapest with.
struct Tally {
  int found{0}, none{0}, compared{0};
};

/// The first and the cheapest plan against the search for all plans, which leaves no way out.
void Compare(const Domain& domain, const Problem& problem, Tally* tally) {
  const PlanResult all = Find(domain, problem, Which::kAll, false);
  if (all.outcome == PlanOutcome::kLimitTime) return;  // none in so many
  const PlanResult first = Find(domain, problem, Which::kFirst, true);
  const PlanResult best = Find(domain, problem, Which::kBest, true);
  ASSERT_EQ(first.outcome, all.outcome);
  if (best.outcome != PlanOutcome::kLimitTime) {
    ASSERT_EQ(best.outcome, all.outcome);
  }
  ++(first.plans.empty() ? tally->none : tally->found);
  if (first.plans.empty()) return;
  ASSERT_THAT(ValidatePlan(domain, problem, first.plans[0]), testing::IsEmpty());
  ASSERT_THAT(ValidatePlan(domain, problem, best.plans[0]), testing::IsEmpty());
  if (!all.exhausted || best.outcome == PlanOutcome::kLimitTime) return;
  ++tally->compared;
  const auto cheapest =
      std::min_element(all.plans.begin(), all.plans.end(),
                       [](const Plan& a, const Plan& b) { return a.cost < b.cost; });
  ASSERT_EQ(best.plans[0].cost, cheapest->cost);
}

/// What leaves ways out, because the situation was met before, because tasks wait for others, or
/// because the first step would fail, against the search for all plans, which leaves none out.
TEST(PassesTest, OnePlanIsFoundWhereThereIsOneAndTheCheapestIsThat) {
  const base::Rng rng(61);
  Tally tally;
  for (int round = 0; round < 4000; ++round) {
    base::Rng chance = rng.Fork(round);
    const std::string text = RandomDomain(&chance);
    const std::string tasks = RandomProblem(&chance);
    SCOPED_TRACE(text + "\n" + tasks);
    const Domain domain = ReadHddlDomain(text, "domain.hddl");
    ASSERT_NO_FATAL_FAILURE(
        Compare(domain, ReadHddlProblem(tasks, "problem.hddl", domain), &tally));
  }
  EXPECT_GT(tally.found, 1000);
  EXPECT_GT(tally.none, 1000);
  EXPECT_GT(tally.compared, 1000);
}

TEST(PassesTest, ListsOfTasksWithinListsAreTakenBackWhole) {
  const base::Rng rng(67);
  Tally tally;
  for (int round = 0; round < 3000; ++round) {
    base::Rng chance = rng.Fork(round);
    const std::string text = RandomShop2(&chance);
    SCOPED_TRACE(text);
    const Domain domain = ReadShop2Domain(text, "d.lisp");
    const Problem problem = ReadShop2Problems(text, "d.lisp").at(0);
    ASSERT_NO_FATAL_FAILURE(Compare(domain, problem, &tally));
  }
  EXPECT_GT(tally.found, 300);
  EXPECT_GT(tally.none, 300);
  EXPECT_GT(tally.compared, 100);
}

}  // namespace
}  // namespace hires::planning::passes_test
