#include "hires/planning/task_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "support/messages.h"

namespace hires::planning::task_text_test {
namespace {

using hires::test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::EndsWith;
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

TEST(TaskTextTest, ATaskWrittenAsACallIsToldHowTasksAreWritten) {
  const std::pair<const char*, const char*> kCalls[] = {
      {"serve(guest1)", "serve guest1"},
      {" carry(mug1, table1) ", "carry mug1 table1"},
      {"carry(mug1,table1)", "carry mug1 table1"},
      {"tidy_up()", "tidy_up"},
      {"serve(guest1", "serve guest1"},
      {"!drive(table1 fast) 1", "!drive table1 fast"}};
  for (const auto& [call, task] : kCalls) {
    EXPECT_THAT(ErrorOf(call), AllOf(StartsWith("task: '"), HasSubstr("is written as a call"),
                                     EndsWith(std::string("arguments: ") + task)))
        << call;
  }
  EXPECT_EQ(TasksOf("carry (mug1)"), Texts{"(carry (mug1))"}) << "an argument that is a list";
  EXPECT_EQ(TasksOf("(carry(mug1))"), Texts{"(carry (mug1))"}) << "SHOP2";
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
            "problem 'clear_tabel' is unknown; did you mean 'clear_table'?");
  EXPECT_EQ(ConfigErrorOf([] { FindProblem({}, "x"); }), "problem 'x' is unknown; none is defined");
}

TEST(TaskTextTest, OfTwoProblemsOfOneNameNeitherIsTaken) {
  std::vector<Problem> problems(3);
  for (Problem& problem : problems) problem.source = "p.lisp";
  problems[0].name = problems[2].name = "serve";
  problems[1].name = "clear";
  EXPECT_EQ(ConfigErrorOf([&] { FindProblem(problems, "Serve"); }),
            "p.lisp: two problems are called 'serve'; rename one");
  EXPECT_EQ(&FindProblem(problems, "clear"), &problems[1]);
}

// ------------------------------------------------------------------------------ networks as text

/// The order between all tasks of a network, nested ones included, by their texts.
std::set<std::pair<std::string, std::string>> OrderOf(const TaskNetwork& network) {
  std::vector<std::vector<std::string>> tasks;
  std::set<std::pair<std::string, std::string>> order;
  for (const TaskItem& item : network.items) {
    tasks.emplace_back();
    if (item.network.empty()) tasks.back().push_back(ToString(item.task));
    for (const TaskNetwork& nested : item.network) {
      for (const auto& pair : OrderOf(nested)) {
        order.insert(pair);
        if (pair.first == "") tasks.back().push_back(pair.second);
      }
    }
  }
  const int n = static_cast<int>(tasks.size());
  std::vector<std::vector<bool>> before(n, std::vector<bool>(n, false));
  for (const auto& [a, b] : network.order) before[a][b] = true;
  for (int k = 0; k < n; ++k) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) before[i][j] = before[i][j] || (before[i][k] && before[k][j]);
    }
  }
  for (int i = 0; i < n; ++i) {
    for (const std::string& a : tasks[i]) {
      order.emplace("", a);  // it is there
      for (int j = 0; j < n; ++j) {
        for (const std::string& b : tasks[j]) {
          if (before[i][j]) order.emplace(a, b);
        }
      }
    }
  }
  return order;
}

TEST(NetworkTextTest, WhatIsWrittenReadsAsTheSame) {
  for (const char* text :
       {"(a x)", "(:ordered (a x) (b ?y))", "(:unordered (a) (b))",
        "(:ordered (a) (:unordered (b) (:ordered (c) (d))) (e))",
        "(:unordered (:ordered (a) (b)) (:ordered (c) (:unordered (d) (e))))",
        "(:ordered (:immediate (a)) (b))", "(!imagine !drive (x) (slow fast))"}) {
    const TaskNetwork network = ReadTasks(text, "task");
    const auto written = ToShop2Tasks(network);
    ASSERT_TRUE(written) << text;
    EXPECT_EQ(*written, text);
    EXPECT_EQ(OrderOf(ReadTasks(*written, "task")), OrderOf(network)) << text;
  }
  EXPECT_EQ(ToShop2Tasks(TaskNetwork{}), "()");
  EXPECT_TRUE(ReadTasks("()", "task").items.empty());
}

TaskNetwork Plain(int num_tasks, std::vector<std::pair<int, int>> order) {
  TaskNetwork network;
  for (int i = 0; i < num_tasks; ++i) {
    network.items.emplace_back();
    network.items.back().task = MakeList({MakeSymbol(std::string(1, static_cast<char>('a' + i)))});
  }
  network.order = std::move(order);
  return network;
}

TEST(NetworkTextTest, AnyOrderThatNestsIsFound) {
  EXPECT_EQ(ToShop2Tasks(Plain(3, {{2, 1}, {1, 0}})), "(:ordered (c) (b) (a))");
  EXPECT_EQ(ToShop2Tasks(Plain(4, {{0, 2}, {0, 3}, {1, 2}, {1, 3}})),
            "(:ordered (:unordered (a) (b)) (:unordered (c) (d)))");
  EXPECT_EQ(ToShop2Tasks(Plain(4, {{0, 1}, {1, 2}, {0, 2}})),
            "(:unordered (:ordered (a) (b) (c)) (d))");
}

// Of four tasks with every order there is: either the text means the same, or the order has the
// shape N, which no nesting can say.
TEST(NetworkTextTest, AllOrdersOfFourTasksAreWrittenOrCannotBe) {
  const std::vector<std::pair<int, int>> all = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  std::set<std::set<std::pair<std::string, std::string>>> refused;
  for (unsigned chosen = 0; chosen < 64; ++chosen) {
    std::vector<std::pair<int, int>> order;
    for (unsigned i = 0; i < all.size(); ++i) {
      if (chosen >> i & 1u) order.push_back(all[i]);
    }
    const TaskNetwork network = Plain(4, order);
    const auto written = ToShop2Tasks(network);
    if (written) {
      EXPECT_EQ(OrderOf(ReadTasks(*written, "task")), OrderOf(network)) << *written;
    } else {
      refused.insert(OrderOf(network));
    }
  }
  for (const auto& order : refused) EXPECT_EQ(order.size(), 4u + 3u);
  EXPECT_EQ(refused.size(), 5u) << "the N with a, b, c, d in an order that i < j allows";
}

TEST(NetworkTextTest, ANestedNetworkThatIsImmediateCannotBeSaid) {
  TaskNetwork network = ReadTasks("(:ordered (a) (:unordered (b) (c)))", "task");
  network.items[1].immediate = true;
  EXPECT_EQ(ToShop2Tasks(network), std::nullopt);
}

}  // namespace
}  // namespace hires::planning::task_text_test
