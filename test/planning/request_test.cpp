#include "hires/planning/request.h"

#include <gmock/gmock.h>

#include "hires/base/error.h"
#include "hires/planning/shop2_reader.h"
#include "hires/planning/task_text.h"

namespace hires::planning::request_test {
namespace {

using testing::HasSubstr;

std::string ErrorOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "nothing was wrong";
}

Domain Kitchen() {
  return ReadShop2Domain("(defdomain kitchen ((:operator (!wait ?time) () () ())))", "kitchen");
}

TEST(SetTasksTest, TheyTakeThePlaceOfThoseBefore) {
  Problem problem;
  problem.source = "file";
  SetTasks("!wait 1", Kitchen(), &problem);
  SetTasks("((!wait 2) (!wait 3))", Kitchen(), &problem);
  EXPECT_EQ(problem.tasks.items.size(), 2u);
  EXPECT_EQ(problem.source, "task");
}

TEST(SetTasksTest, ATaskThatTheDomainLacksIsNamed) {
  Problem problem;
  EXPECT_THAT(ErrorOf([&] { SetTasks("!wiat 1", Kitchen(), &problem); }), HasSubstr("!wait"));
}

TEST(AppendFactsTest, TheyFollowWhatIsKnown) {
  Problem problem;
  AppendFacts({{"on", {"mug1", "table1"}}}, "state", &problem);
  AppendFacts({{"holding", {"leftarm1", "mug1"}}}, "facts", &problem);
  ASSERT_EQ(problem.facts.size(), 2u);
  EXPECT_EQ(ToString(problem.facts[0]), "(on mug1 table1)");
}

TEST(AppendFactsTest, WhatIsNoGroundAtomIsNamedWithItsPlace) {
  Problem problem;
  const std::vector<base::Atom> variable{{"on", {"mug1", "table1"}}, {"on", {"mug1", "?where"}}};
  EXPECT_THAT(ErrorOf([&] { AppendFacts(variable, "state", &problem); }),
              HasSubstr("state[1].arguments[1]"));
  EXPECT_THAT(ErrorOf([&] {
                AppendFacts({{"(on mug1)", {}}}, "facts", &problem);
              }),
              HasSubstr("facts[0].predicate"));
}

}  // namespace
}  // namespace hires::planning::request_test
