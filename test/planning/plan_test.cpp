#include "hires/planning/plan.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace hires::planning::plan_test {
namespace {

Datum Term(const std::vector<std::string>& names) {
  std::vector<Datum> items;
  for (const std::string& name : names) items.push_back(MakeSymbol(name));
  return MakeList(std::move(items));
}

PlanNode Node(const std::vector<std::string>& task, int parent) {
  PlanNode node;
  node.task = Term(task);
  node.parent = parent;
  return node;
}

PlanStep Step(const std::vector<std::string>& task, int node) {
  PlanStep step;
  step.task = Term(task);
  step.node = node;
  return step;
}

/// serve(get(!grasp), !bow), !sleep
Plan Serving() {
  Plan plan;
  plan.nodes = {PlanNode{},
                Node({"serve", "guest1"}, 0),
                Node({"get", "mug1"}, 1),
                Node({"!grasp", "mug1"}, 2),
                Node({"!bow"}, 1),
                Node({"!sleep"}, 0)};
  plan.steps = {Step({"!grasp", "mug1"}, 3), Step({"!bow"}, 4), Step({"!sleep"}, 5)};
  return plan;
}

TEST(PlanTest, ThePathNamesTheTasksAboveFromTheRootOn) {
  EXPECT_EQ(DecompositionPath(Serving(), 0), "serve/get");
  EXPECT_EQ(DecompositionPath(Serving(), 1), "serve");
}

TEST(PlanTest, AStepOfTheProblemItselfHasAnEmptyPath) {
  EXPECT_EQ(DecompositionPath(Serving(), 2), "");
}

TEST(PlanTest, APathOfNoStepOrWithoutEndIsRefused) {
  EXPECT_THROW(DecompositionPath(Serving(), -1), std::logic_error);
  EXPECT_THROW(DecompositionPath(Serving(), 3), std::logic_error);
  Plan circle = Serving();
  circle.nodes[1].parent = 2;
  EXPECT_THROW(DecompositionPath(circle, 0), std::logic_error);
  Plan nowhere = Serving();
  nowhere.steps[0].node = 6;
  EXPECT_THROW(DecompositionPath(nowhere, 0), std::logic_error);
}

TEST(PlanTest, AsShop2TextEachStepIsALine) {
  EXPECT_EQ(ToShop2Plan(Serving()), "(!grasp mug1)\n(!bow)\n(!sleep)\n");
  EXPECT_EQ(ToShop2Plan({}), "");
}

TEST(PlanTest, LiteralsAreEqualInAtomAndSign) {
  const Literal holds{Term({"on", "mug1"}), true};
  EXPECT_TRUE(holds == (Literal{Term({"on", "mug1"}), true}));
  EXPECT_FALSE(holds == (Literal{Term({"on", "mug1"}), false}));
  EXPECT_FALSE(holds == (Literal{Term({"on", "mug2"}), true}));
}

}  // namespace
}  // namespace hires::planning::plan_test
