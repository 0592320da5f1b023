#include "planning/search/found_plans.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "planning/support/path_bench.h"

namespace hires::planning::found_plans_test {
namespace {

using hires::test_support::PathBench;

/// A path to one task (!a) or (!b), offered as a plan when it has been carried out.
class FoundPlansTest : public ::testing::Test {
 protected:
  void Offer(FoundPlans* plans, const std::string& task, double cost) {
    SearchPath& path = bench_.path;
    const SearchPath::Moment start = path.Now();
    path.Decompose({Network::kRoot, &bench_.program.root(), 0, 0, 0},
                   {bench_.Term("(" + task + ")")}, -1);
    path.Finish({path.network().FirstReady(), &bench_.Operator(task), 0, cost});
    plans->Offer();
    path.ReturnTo(start);
  }
  PathBench bench_{"(:operator (!a) () () ()) (:operator (!b) () () ())", "()", "((!a))"};
};

TEST_F(FoundPlansTest, TheFirstIsEnoughWhereNoMoreIsAskedFor) {
  const PlanRequest request;
  FoundPlans plans(request, &bench_.path);
  EXPECT_FALSE(plans.enough());
  Offer(&plans, "!a", 3.0);
  EXPECT_TRUE(plans.enough());
  EXPECT_FALSE(plans.IsTooDear(100.0));
  EXPECT_EQ(plans.best_cost(), 3.0);
}

TEST_F(FoundPlansTest, EqualPlansAreOne) {
  PlanRequest request;
  request.which = Which::kAll;
  request.max_plans = 2;
  FoundPlans plans(request, &bench_.path);
  Offer(&plans, "!a", 1.0);
  Offer(&plans, "!a", 1.0);
  EXPECT_EQ(plans.size(), 1u);
  EXPECT_FALSE(plans.enough());
  Offer(&plans, "!b", 1.0);
  EXPECT_TRUE(plans.enough());
  EXPECT_EQ(ToShop2Plan(plans.Take().at(1)), "(!b)\n");
}

TEST_F(FoundPlansTest, OfTheCheapestTheFirstStays) {
  PlanRequest request;
  request.which = Which::kBest;
  FoundPlans plans(request, &bench_.path);
  Offer(&plans, "!a", 2.0);
  Offer(&plans, "!b", 2.0);
  EXPECT_TRUE(plans.IsTooDear(2.0));
  EXPECT_FALSE(plans.IsTooDear(1.5));
  EXPECT_FALSE(plans.enough());
  const std::vector<Plan> best = plans.Take();
  ASSERT_EQ(best.size(), 1u);
  EXPECT_EQ(ToShop2Plan(best[0]), "(!a)\n");
}

TEST_F(FoundPlansTest, ACheaperPlanReplacesTheOneBefore) {
  PlanRequest request;
  request.which = Which::kBest;
  request.decomposition = false;
  FoundPlans plans(request, &bench_.path);
  Offer(&plans, "!a", 2.0);
  Offer(&plans, "!b", 1.0);
  const std::vector<Plan> best = plans.Take();
  ASSERT_EQ(best.size(), 1u);
  EXPECT_EQ(best[0].cost, 1.0);
  EXPECT_TRUE(best[0].nodes.empty());
  EXPECT_EQ(best[0].steps.at(0).node, -1);
}

}  // namespace
}  // namespace hires::planning::found_plans_test
