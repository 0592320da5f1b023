#include "hires/ros/planning/plan_nodes.h"

#include <gmock/gmock.h>

#include "hires/planning/planner.h"
#include "hires/planning/planning_files.h"
#include "hires/planning/reasons.h"
#include "hires/planning/replanning.h"
#include "hires/planning/task_text.h"
#include "support/messages.h"

namespace hires_ros::plan_nodes_test {
namespace {

namespace planning = hires::planning;
using hires::test_support::ConfigErrorOf;
using ::testing::HasSubstr;

const std::string kDomains = std::string(HIRES_SOURCE_DIR) + "/config/domains/";

class PlanNodesTest : public ::testing::Test {
 protected:
  PlanNodesTest()
      : domain_(planning::LoadDomain(kDomains + "restaurant.lisp")),
        problem_(planning::LoadProblems(kDomains + "problems/serve_coffee.lisp", domain_).at(0)),
        sent_(planning::FindPlans(domain_, problem_).plans.at(0)) {
    planning::AddReasons(domain_, problem_, &sent_);
    message_.nodes = NodesToMsg(sent_);
    got_ = sent_;
    got_.nodes.clear();
    for (planning::PlanStep& step : got_.steps) step.node = -1;
  }

  std::string Error() {
    return ConfigErrorOf([&] { AddNodes(message_, domain_, &got_); });
  }

  planning::Domain domain_;
  planning::Problem problem_;
  planning::Plan sent_, got_;
  hires::Plan message_;
};

TEST_F(PlanNodesTest, WhatIsSentComesBack) {
  AddNodes(message_, domain_, &got_);
  ASSERT_EQ(got_.nodes.size(), sent_.nodes.size());
  for (std::size_t i = 0; i < got_.nodes.size(); ++i) {
    const planning::PlanNode &a = sent_.nodes[i], &b = got_.nodes[i];
    EXPECT_EQ(a.task, b.task);
    EXPECT_EQ(a.parent, b.parent);
    EXPECT_EQ(a.children, b.children);
    EXPECT_EQ(a.step, b.step);
    EXPECT_EQ(a.method, b.method);
    EXPECT_EQ(a.branch, b.branch);
    EXPECT_EQ(a.label, b.label);
    EXPECT_EQ(a.at_step, b.at_step);
    EXPECT_EQ(a.bindings, b.bindings);
  }
  for (std::size_t i = 0; i < got_.steps.size(); ++i) {
    EXPECT_EQ(got_.steps[i].node, sent_.steps[i].node);
  }
}

TEST_F(PlanNodesTest, WhatIsLeftOfThePlanIsTheSame) {
  AddNodes(message_, domain_, &got_);
  const auto facts = planning::FactsAfter(domain_, problem_, sent_, 7);
  for (int depth = 0; depth <= planning::DeepestKeepDepth(sent_, 7); ++depth) {
    const auto left = [&](const planning::Plan& plan) {
      return planning::ToShop2Tasks(
          planning::RemainingProblem(domain_, problem_, plan, 7, facts, depth).tasks);
    };
    EXPECT_EQ(left(got_), left(sent_)) << depth;
  }
}

TEST_F(PlanNodesTest, AMessageWithoutNodesLeavesThePlanAsItIs) {
  message_.nodes.clear();
  AddNodes(message_, domain_, &got_);
  EXPECT_TRUE(got_.nodes.empty());
}

TEST_F(PlanNodesTest, WhatDoesNotFitIsRefusedWithItsPlace) {
  const auto sound = message_;
  message_.nodes[1].parent = 1000;
  EXPECT_THAT(Error(), HasSubstr("plan.nodes[1].parent: is 1000, wanted -1 (none) or less than"));
  message_ = sound;
  message_.nodes[2].step = 16;
  EXPECT_THAT(Error(), HasSubstr("plan.nodes[2].step: is 16"));
  message_ = sound;
  message_.nodes[1].method = 5000;
  EXPECT_THAT(Error(), HasSubstr("do both sides use the same domain?"));
  message_ = sound;
  message_.nodes[1].branch = 50;
  EXPECT_THAT(Error(), HasSubstr("plan.nodes[1].branch: is 50"));
  message_ = sound;
  message_.nodes[1].children.push_back(-2);
  EXPECT_THAT(Error(), HasSubstr("plan.nodes[1].children: is -2"));
  message_ = sound;
  message_.nodes[1].variables.push_back("?x");
  EXPECT_THAT(Error(), HasSubstr("names for"));
  message_ = sound;
  message_.nodes[1].task = "(a";
  EXPECT_THAT(Error(), HasSubstr("plan.nodes[1].task:1:1"));
  message_ = sound;
  message_.nodes[1].task = "a b";
  EXPECT_THAT(Error(), HasSubstr("has 2 terms, wanted one"));
}

}  // namespace
}  // namespace hires_ros::plan_nodes_test
