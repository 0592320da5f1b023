#include "hires/planning/task_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/messages.h"

namespace hires::planning {
namespace {

using test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<std::string> TasksOf(const std::string& text) {
  std::vector<std::string> tasks;
  for (const TaskItem& item : ReadTasks(text, "task").items) tasks.push_back(ToString(item.task));
  return tasks;
}

std::string ErrorOf(const std::string& text) {
  return ConfigErrorOf([&] { ReadTasks(text, "task"); });
}

std::string TermErrorOf(const std::string& text) {
  return ConfigErrorOf([&] { ReadGroundTerm(text, "state[3]"); });
}

using Texts = std::vector<std::string>;

TEST(TaskTextTest, OneTaskWithOrWithoutParentheses) {
  EXPECT_EQ(TasksOf("serve Guest1"), Texts{"(serve guest1)"});
  EXPECT_EQ(TasksOf("(serve guest1)"), Texts{"(serve guest1)"});
  EXPECT_EQ(TasksOf("tidy_up"), Texts{"(tidy_up)"});
  EXPECT_EQ(TasksOf("carry (mug1 mug2) 1.5"), Texts{"(carry (mug1 mug2) 1.5)"});
}

TEST(TaskTextTest, SeveralTasksGoOneAfterTheOther) {
  for (const char* text : {"(a x) (b)", "((a x) (b))", "(:ordered (a x) (b))"}) {
    EXPECT_EQ(TasksOf(text), (Texts{"(a x)", "(b)"})) << text;
    EXPECT_EQ(ReadTasks(text, "task").order, (std::vector<std::pair<int, int>>{{0, 1}})) << text;
  }
}

TEST(TaskTextTest, UnorderedTasksHaveNoOrder) {
  EXPECT_EQ(TasksOf("(:unordered (a x) (b))"), (Texts{"(a x)", "(b)"}));
  EXPECT_TRUE(ReadTasks("(:unordered (a x) (b))", "task").order.empty());
}

TEST(TaskTextTest, ACommentBehindTheTaskIsNoTask) {
  EXPECT_EQ(TasksOf("serve guest1 ; please"), Texts{"(serve guest1)"});
}

TEST(TaskTextTest, TextThatIsNoTaskIsRefusedWithItsPlace) {
  EXPECT_THAT(ErrorOf(""), StartsWith("task: names no task; write"));
  EXPECT_THAT(ErrorOf("; nothing"), StartsWith("task: names no task; write"));
  EXPECT_THAT(ErrorOf("(serve guest1"), StartsWith("task:1:1: "));
  EXPECT_THAT(ErrorOf("serve guest1)"), StartsWith("task:1:13: "));
  EXPECT_THAT(ErrorOf("3 4"), StartsWith("task:"));
  // Cannot leave the tasks: what would be another problem is no task.
  EXPECT_THAT(ErrorOf("(a)) (defproblem p d () ((b))"), StartsWith("task:1:4: "));
}

TEST(TaskTextTest, ATermIsOneAndGround) {
  EXPECT_EQ(ToString(ReadGroundTerm(" Mug1 ", "x")), "mug1");
  EXPECT_EQ(ToString(ReadGroundTerm("(a (b . 2))", "x")), "(a (b . 2))");
  EXPECT_THAT(TermErrorOf(""), StartsWith("state[3]: has 0 terms, wanted exactly one"));
  EXPECT_THAT(TermErrorOf("a b"), StartsWith("state[3]: has 2 terms, wanted exactly one"));
  EXPECT_THAT(TermErrorOf("(a ?x)"),
              AllOf(HasSubstr("(a ?x) has a variable"), HasSubstr("wanted a term without")));
  EXPECT_THAT(TermErrorOf("(a"), StartsWith("state[3]:1:1: "));
}

TEST(TaskTextTest, AProblemIsFoundByItsNameInAnyCase) {
  std::vector<Problem> problems(2);
  problems[0].name = "serve_coffee";
  problems[1].name = "clear_table";
  EXPECT_EQ(&FindProblem(problems, "Clear_Table"), &problems[1]);
  EXPECT_EQ(ConfigErrorOf([&] { FindProblem(problems, "clear_tabel"); }),
            "problem 'clear_tabel' is unknown; did you mean 'clear_table' or 'serve_coffee'?");
  EXPECT_EQ(ConfigErrorOf([] { FindProblem({}, "x"); }), "problem 'x' is unknown; none is defined");
}

}  // namespace
}  // namespace hires::planning
