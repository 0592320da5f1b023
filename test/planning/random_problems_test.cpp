#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hires/base/rng.h"
#include "hires/planning/planner.h"
#include "hires/planning/planning_files.h"
#include "hires/planning/shop2_reader.h"
#include "hires/planning/validator.h"
#include "support/planning_problems.h"

// The random problems of the benchmarks, and the benchmarks' own domains.
namespace hires::planning::random_problems_test {
namespace {

using hires::test_support::BlocksProblem;
using hires::test_support::LogisticsOf;
using hires::test_support::LogisticsProblem;

const std::string kDomains = HIRES_SOURCE_DIR "/benchmark/planning/domains/";

Problem Read(const std::string& text, const Domain& domain) {
  const Problem problem = ReadShop2Problems(text, "random").at(0);
  CheckTasks(problem, domain);
  return problem;
}

void ExpectValidPlan(const Domain& domain, const Problem& problem) {
  const PlanResult result = FindPlans(domain, problem);
  ASSERT_EQ(result.outcome, PlanOutcome::kFound) << problem.name;
  EXPECT_EQ(ValidatePlan(domain, problem, result.plans.at(0)), std::vector<std::string>{})
      << problem.name;
}

TEST(RandomProblemsTest, SameSeedGivesTheSameTextAndAnotherSeedAnother) {
  const auto logistics = [](int seed) {
    return LogisticsProblem(LogisticsOf(10), base::Rng(static_cast<std::uint64_t>(seed)));
  };
  EXPECT_EQ(logistics(1), logistics(1));
  EXPECT_NE(logistics(1), logistics(2));
  EXPECT_EQ(BlocksProblem(20, base::Rng(1)), BlocksProblem(20, base::Rng(1)));
  EXPECT_NE(BlocksProblem(20, base::Rng(1)), BlocksProblem(20, base::Rng(2)));
}

TEST(RandomProblemsTest, LogisticsHoldsWhatItsSizeSays) {
  const Domain domain = LoadDomain(kDomains + "logistics.lisp");
  const Problem problem = Read(LogisticsProblem({7, 3, 4, 2}, base::Rng(1)), domain);
  EXPECT_EQ(problem.tasks.items.size(), 7u);
  EXPECT_TRUE(problem.tasks.order.empty());
  // 2 airplanes with places; 3 cities with 4 facts each; 12 places with their city; 7 parcels.
  EXPECT_EQ(problem.facts.size(), 4u + 12u + 24u + 7u);
}

TEST(RandomProblemsTest, BlocksHoldsEveryBlockOnceInBothTowers) {
  const Domain domain = LoadDomain(kDomains + "blocks.lisp");
  const Problem problem = Read(BlocksProblem(30, base::Rng(1)), domain);
  int below_or_table = 0;
  for (const Datum& fact : problem.facts) {
    below_or_table += fact.Head() == "on" || fact.Head() == "on-table" ? 1 : 0;
  }
  EXPECT_EQ(below_or_table, 30);
}

TEST(OwnDomainsTest, LogisticsIsSolvedForEverySeed) {
  const Domain domain = LoadDomain(kDomains + "logistics.lisp");
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    ExpectValidPlan(domain, Read(LogisticsProblem(LogisticsOf(12), base::Rng(seed)), domain));
  }
}

TEST(OwnDomainsTest, BlocksIsSolvedForEverySeed) {
  const Domain domain = LoadDomain(kDomains + "blocks.lisp");
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    ExpectValidPlan(domain, Read(BlocksProblem(25, base::Rng(seed)), domain));
  }
}

// Each plan moves a block at most twice: out of the way once, and to its place.
TEST(OwnDomainsTest, BlocksMovesEachBlockTwiceAtMost) {
  const Domain domain = LoadDomain(kDomains + "blocks.lisp");
  const Problem problem = Read(BlocksProblem(40, base::Rng(3)), domain);
  const PlanResult result = FindPlans(domain, problem);
  ASSERT_EQ(result.outcome, PlanOutcome::kFound);
  int moves = 0;
  for (const PlanStep& step : result.plans.at(0).steps) {
    moves += step.task.Head() == "!stack" || step.task.Head() == "!putdown" ? 1 : 0;
  }
  EXPECT_LE(moves, 80);
  EXPECT_EQ(result.plans.at(0).cost, 2.0 * moves);
}

}  // namespace
}  // namespace hires::planning::random_problems_test
