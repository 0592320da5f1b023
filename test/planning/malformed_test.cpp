// What goes wrong in SHOP2 files, and what the user is told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hires/base/error.h"
#include "hires/planning/shop2_reader.h"

namespace hires::planning::malformed_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Reads domain and problems of a text as far as it holds them, and their tasks.
void ReadAll(const std::string& text) {
  const Domain domain = ReadShop2Domain(text, "bad.lisp");
  if (text.find("problem") == std::string::npos) return;
  for (const Problem& problem : ReadShop2Problems(text, "bad.lisp")) CheckTasks(problem, domain);
}

std::string ErrorOf(const std::string& text) {
  try {
    ReadAll(text);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

std::string DomainWith(const std::string& item) {
  return "(defdomain d (\n(:operator (!go ?from ?to) () ())\n" + item + "))";
}

std::string WithProblem(const std::string& rest) {
  return DomainWith("(:method (walk ?to) () ())") + "\n(defproblem p " + rest + ")";
}

struct Malformed {
  std::string text;
  std::vector<std::string> parts;  ///< of the message: place, construct, what came, remedy
};

void ExpectMessages(const std::vector<Malformed>& table) {
  for (const Malformed& malformed : table) {
    const std::string message = ErrorOf(malformed.text);
    EXPECT_LT(message.size(), 700u);
    for (const std::string& part : malformed.parts) {
      EXPECT_THAT(message, HasSubstr(part)) << malformed.text;
    }
  }
}

TEST(MalformedTest, WhatTheTestsBuildOnIsWellFormed) {
  EXPECT_EQ(ErrorOf(DomainWith("")), "no error");
  EXPECT_EQ(ErrorOf(WithProblem("d ((at a)) ((walk b))")), "no error");
}

TEST(MalformedTest, FilesAreToldApart) {
  ExpectMessages({
      {"", {"bad.lisp:1:1", "holds no domain", "(defdomain name (items...))"}},
      {"(defproblem p () ())", {"bad.lisp:1:1", "holds no domain"}},
      {"(defdomain a ())\n(defdomain b ())", {"bad.lisp:2:1", "second domain", "line 1"}},
      {"(defdomain a ())\n(:method (m) () ())", {"bad.lisp:2:1", "(:method", "')' too many"}},
      {"(defdomian a ())", {"bad.lisp:1:1", "came (defdomian a nil)", "(defdomain name"}},
      {"(defdomain a ())\n(defproblem p () ()) ((walk b))", {"bad.lisp:2:22", "came ((walk b))"}},
      {"(defdomain a ())\n(shop:defproblme p () ())", {"bad.lisp:2:1", "(defproblem name"}},
      {"defdomain", {"bad.lisp:1:1", "came defdomain"}},
      {"(define (domain d))", {"bad.lisp:1:1", "came (define (domain d))", "(defdomain"}},
      {"(defdomain d (\n(:operator (!go) () ())\n", {"bad.lisp:1:14", "add the missing ')'"}},
      {"(defdomain d ()))", {"bad.lisp:1:17", "')' closes nothing"}},
  });
}

TEST(MalformedTest, Domains) {
  ExpectMessages({
      {"(defdomain d)", {"bad.lisp:1:1", "domain", "came (defdomain d)", "(defdomain name"}},
      {"(defdomain \"d\" ())", {"bad.lisp:1:12", "came \"d\"", "a name"}},
      {"(defdomain nil ())", {"bad.lisp:1:12", "a name"}},
      {"(defdomain d (:method (m) () ()))", {"bad.lisp:1:14", "in one list of their own"}},
      {"(defdomain d (:method (m) () ()) (:method (n) () ()))", {"bad.lisp:1:14", "one list"}},
      {"(defdomain d foo)", {"bad.lisp:1:14", "domain 'd'", "came foo", "a list of operators"}},
      {DomainWith("(:include \"other.lisp\")"),
       {"bad.lisp:3:1", "domain 'd'", "(:include", "wanted (:operator"}},
      {DomainWith("(:action go)"), {"bad.lisp:3:1", "(:action go)", "wanted (:operator"}},
      {DomainWith("(:static p q)"), {"bad.lisp:3:1", "(:static p q)"}},
      {DomainWith("walk"), {"bad.lisp:3:1", "came walk", "wanted (:operator"}},
  });
}

TEST(MalformedTest, Operators) {
  ExpectMessages({
      {DomainWith("(:operator)"),
       {"bad.lisp:3:1", "operator 'without a name'", "(:operator (!name"}},
      {DomainWith("(:operator !x () ())"), {"bad.lisp:3:12", "came !x", "a head (name"}},
      {DomainWith("(:operator (?x) () ())"), {"bad.lisp:3:12", "came (?x)", "a head"}},
      {DomainWith("(:operator (load ?x) () ())"),
       {"bad.lisp:3:12", "operator 'load'", "begins with '!'", "write '!load'"}},
      {DomainWith("(:operator (!load ?x) ())"),
       {"bad.lisp:3:1", "operator '!load'", "parts after its head: 1, wanted 2 to 4"}},
      {DomainWith("(:operator (!load ?x) () () () 1 2)"), {"bad.lisp:3:1", "after its head: 5"}},
      {DomainWith("(:operator (!go ?x) () ())"),
       {"bad.lisp:3:1", "operator '!go'", "stands in line 2 already", "rename"}},
      {DomainWith("(:operator (!load ?x) () ((in ?x ?truck)))"),
       {"bad.lisp:3:27", "operator '!load'", "?truck in an add", "correct its name"}},
      {DomainWith("(:operator (!load ?x) () ?atoms)"), {"bad.lisp:3:26", "?atoms in an add"}},
      {DomainWith("(:operator (!load) () ((forall (?u) (p ?u) ((q ?u ?v)))))"),
       {"bad.lisp:3:45", "?v in an add"}},
      {DomainWith("(:operator (!load) (in a) ())"),
       {"bad.lisp:3:20", "came (in a)", "a list of effects"}},
      {DomainWith("(:operator (!load) (in) () ((not (in a))))"),
       {"bad.lisp:3:29", "'not' is a logical word"}},
      {DomainWith("(:operator (!load) () ((:protection (not (p)))))"),
       {"bad.lisp:3:24", "operator '!load'", "(:protection (not (p)))", "as SHOP3 can"}},
      {DomainWith("(:operator (!load) ((:protection)) ())"),
       {"bad.lisp:3:21", "came (:protection)", "(:protection (predicate"}},
      {DomainWith("(:operator (!load) ((forall (?u) (p ?u))) ())"),
       {"bad.lisp:3:21", "(forall (?variables...) condition (atoms...))"}},
      {DomainWith("(:operator (!load) ((p) . ?x) ())"), {"bad.lisp:3:20", "a list of effects"}},
      {DomainWith("(:op (!load) :pre ((p)))"), {"bad.lisp:3:14", "came :pre", ":precond"}},
      {DomainWith("(:op (!load) :cost)"), {"bad.lisp:3:14", "came :cost"}},
      {DomainWith("(:op (!load) :cost 1 :cost 2)"), {"bad.lisp:3:22", "':cost'", "second time"}},
  });
}

TEST(MalformedTest, Methods) {
  ExpectMessages({
      {DomainWith("(:method)"), {"bad.lisp:3:1", "method 'without a name'", "(:method [name]"}},
      {DomainWith("(:method (m ?x))"), {"bad.lisp:3:1", "method 'm'", "precondition tasks"}},
      {DomainWith("(:method (!m) () ())"), {"bad.lisp:3:10", "method '!m'", "take the '!' away"}},
      {DomainWith("(:method (m) ((!go a b)))"),
       {"bad.lisp:3:14", "method 'm'", "one of them is missing", "write nil"}},
      {DomainWith("(:method (m) () () label ((p)))"),
       {"bad.lisp:3:20", "method 'm', branch 2", "one of them is missing"}},
      {DomainWith("(:method (m) () () () ((!go a)))"),
       {"bad.lisp:3:24", "method 'm', branch 2", "task '!go' has 1 argument,",
        "operator (!go ?from ?to) in line 2 takes 2 arguments"}},
      {DomainWith("(:method (m . ?x) () ((!go a b c . ?x)))"),
       {"bad.lisp:3:23", "has at least 3 arguments"}},
      {DomainWith("(:method (m) () (:parallel (!go a b)))"), {"bad.lisp:3:17", "(:parallel"}},
      {DomainWith("(:method (m) () (?task a b))"), {"bad.lisp:3:17", "came (?task a b)"}},
      {DomainWith("(:method (m) () ((!go a b) ?task))"),
       {"bad.lisp:3:28", "came ?task", "nil, a task"}},
      {DomainWith("(:method (m) () 7)"), {"bad.lisp:3:17", "came 7", "nil, a task"}},
      {DomainWith("(:method (m) () ((!go a b) . ?x))"), {"bad.lisp:3:17", "method 'm'"}},
      {DomainWith("(:method (m) () (:task))"), {"bad.lisp:3:17", "came (:task)", "a task (name"}},
  });
}

TEST(MalformedTest, Goals) {
  const auto with_goals = [](const std::string& goals) {
    return DomainWith("(:method (m ?x) " + goals + " nil)");
  };
  ExpectMessages({
      {with_goals("foo"), {"bad.lisp:3:17", "method 'm'", "one of them is missing"}},
      {with_goals("7"), {"bad.lisp:3:17", "method 'm'", "came 7", "wanted a goal"}},
      {with_goals("((p) q)"), {"bad.lisp:3:22", "came q", "wanted a goal"}},
      {with_goals("((p) . (q))"), {"bad.lisp:3:25", "came q", "wanted a goal"}},
      {with_goals("((p) . ?x)"), {"bad.lisp:3:17", "without a dot"}},
      {with_goals("(?p a b)"), {"bad.lisp:3:21", "came a", "wanted a goal"}},
      {with_goals("'(p)"), {"bad.lisp:3:17", "without a quote"}},
      {with_goals("(not)"), {"bad.lisp:3:17", "came (not)", "(not goal)"}},
      {with_goals("(not (p) (q))"), {"bad.lisp:3:17", "(not goal)"}},
      {with_goals("(imply (p))"), {"bad.lisp:3:17", "(imply condition conclusion)"}},
      {with_goals("(forall (?y) (p ?y))"), {"bad.lisp:3:17", "(forall (?variables...)"}},
      {with_goals("(forall (y) (p) (q))"), {"bad.lisp:3:26", "came y", "a variable"}},
      {with_goals("(forall y (p) (q))"), {"bad.lisp:3:25", "came y", "list of variables"}},
      {with_goals("(exists (?y))"), {"bad.lisp:3:17", "(exists (?variables...)"}},
      {with_goals("(assign y 3)"), {"bad.lisp:3:25", "came y", "a variable"}},
      {with_goals("(assign ?y)"), {"bad.lisp:3:17", "(assign ?variable expression)"}},
      {with_goals("(eval)"), {"bad.lisp:3:17", "(eval expression)"}},
      {with_goals("(call)"), {"bad.lisp:3:17", "(call function arguments...)"}},
      {with_goals("(setof ?y (p ?y) z)"), {"bad.lisp:3:34", "came z", "a variable"}},
      {with_goals("(setof ?y (p ?y))"), {"bad.lisp:3:17", "(setof term goals ?variable)"}},
      {with_goals("(:sort-by ?y)"), {"bad.lisp:3:17", "(:sort-by key"}},
      {with_goals("(:sort-by ?y (lambda (a b) a) ((p ?y)))"),
       {"bad.lisp:3:30", "came (lambda", "name of a function"}},
      {with_goals("((p) (:first (q)))"), {"bad.lisp:3:22", "':first' stands within a goal"}},
      {with_goals("(not (:sort-by ?y (q ?y)))"), {"bad.lisp:3:22", "':sort-by' stands within"}},
      {with_goals("((:protection (p)))"), {"bad.lisp:3:18", "came (:protection (p))"}},
  });
}

TEST(MalformedTest, Axioms) {
  ExpectMessages({
      {DomainWith("(:-)"), {"bad.lisp:3:1", "axiom 'without a name'", "(:- (predicate"}},
      {DomainWith("(:- (p ?x))"), {"bad.lisp:3:1", "axiom 'p'", "write nil"}},
      {DomainWith("(:- p ((q)))"), {"bad.lisp:3:5", "came p", "a head"}},
      {DomainWith("(:- (and (p)) ((q)))"), {"bad.lisp:3:5", "'and' is a logical word"}},
      {DomainWith("(:- (p) label)"), {"bad.lisp:3:9", "axiom 'p'", "goals after this label"}},
      {DomainWith("(:- (p) (:sort-by ?x (q ?x)))"), {"bad.lisp:3:9", "are not sorted"}},
  });
}

TEST(MalformedTest, Problems) {
  ExpectMessages({
      {WithProblem(""), {"bad.lisp:4:1", "problem", "came (defproblem p)", "wanted (defproblem"}},
      {WithProblem("a b c d"), {"bad.lisp:4:1", "wanted (defproblem"}},
      {WithProblem("d at nil"), {"bad.lisp:4:17", "problem 'p'", "came at", "a list of facts"}},
      {WithProblem("d (at a) nil"), {"bad.lisp:4:17", "came (at a)", "a list of facts"}},
      {WithProblem("d ((at a) b) nil"), {"bad.lisp:4:25", "came b", "a fact (predicate"}},
      {WithProblem("d ((at ?x)) nil"), {"bad.lisp:4:18", "(at ?x)", "without variables"}},
      {WithProblem("d ((at a . b)) nil"), {"bad.lisp:4:18", "(at a . b)", "a fact"}},
      {WithProblem("d ((not ?x) at) nil"), {"bad.lisp:4:27", "came at", "a fact (predicate"}},
      {WithProblem("7 ((at a)) nil"), {"bad.lisp:4:15", "came 7", "a name"}},
      {WithProblem("d () ((wolk a))"), {"bad.lisp:4:21", "problem 'p'", "did you mean 'walk'"}},
      {WithProblem("d () ((walk a b))"),
       {"bad.lisp:4:21", "task 'walk' has 2 arguments", "method (walk ?to) in line 3 takes 1"}},
  });
}

TEST(MalformedTest, EachItemsFaultIsToldAtOnce) {
  const std::string message = ErrorOf(
      DomainWith("(:operator (load ?x) () ())\n(:method (m) () 7)\n(:- p ((q)))\n(:static p)"));
  for (const std::string place :
       {"bad.lisp:3:12", "bad.lisp:4:17", "bad.lisp:5:5", "bad.lisp:6:1"}) {
    EXPECT_THAT(message, HasSubstr(place));
  }
  std::string many;
  for (int i = 0; i < 1000; ++i) many += "(:static p)";
  EXPECT_THAT(ErrorOf(DomainWith(many)), HasSubstr("and 950 more"));
}

TEST(MalformedTest, NoProblemAtAll) {
  try {
    ReadShop2Problems("(defdomain d ())", "bad.lisp");
    FAIL();
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("bad.lisp:1:1"), HasSubstr("holds no problem")));
  }
}

TEST(MalformedTest, AMillionParenthesesEndAtTheLimit) {
  EXPECT_THAT(ErrorOf(std::string(1'000'000, '(')),
              AllOf(HasSubstr("bad.lisp:1:1001"), HasSubstr("1000 lists are open")));
}

TEST(MalformedTest, DeepGoalsAndNetworksWithinTheLimitAreRead) {
  const auto nested = [](const std::string& open, const std::string& inner, int times) {
    std::string text;
    for (int i = 0; i < times; ++i) text += open;
    return text + inner + std::string(static_cast<std::size_t>(times), ')');
  };
  EXPECT_EQ(ErrorOf(DomainWith("(:method (m) " + nested("(not ", "(p)", 990) + " nil)")),
            "no error");
  EXPECT_EQ(
      ErrorOf(DomainWith("(:method (m) nil " + nested("(:unordered ", "(!go a b)", 990) + ")")),
      "no error");
  EXPECT_EQ(ErrorOf(DomainWith("(:operator (!o) " + nested("((forall () () ", "nil", 490) +
                               std::string(490, ')') + " ())")),
            "no error");
}

TEST(MalformedTest, ATaskThatNothingHandlesIsNotedWithPlaceAndRemedy) {
  const Domain domain = ReadShop2Domain(
      DomainWith("(:method (m) () ((fly a) (go a b)))(:method (n) () ((fly b)))"), "bad.lisp");
  EXPECT_EQ(domain.unknown_tasks.size(), 2u);
  EXPECT_THAT(domain.unknown_tasks.at("fly"),
              AllOf(HasSubstr("bad.lisp:3:18"), HasSubstr("method 'm'"),
                    HasSubstr("task 'fly' is unknown"), HasSubstr("did you mean")));
  EXPECT_THAT(domain.unknown_tasks.at("go"), HasSubstr("did you mean '!go'"));
}

TEST(MalformedTest, ASymbolOfAHundredMegabytesIsNotRead) {
  const std::string symbol(100u << 20, 'x');
  EXPECT_THAT(ErrorOf("(defdomain " + symbol + " ())"),
              AllOf(HasSubstr("bad.lisp:1:1"), HasSubstr("at most 67108864 are read")));
}

TEST(MalformedTest, ALongSymbolIsCutInTheMessage) {
  const std::string symbol(50u << 20, 'x');
  const std::string message = ErrorOf("(defdomain " + symbol + " ())");
  EXPECT_THAT(message, AllOf(HasSubstr("bad.lisp:1:12"), HasSubstr("longer than 1000 bytes")));
  EXPECT_LT(message.size(), 200u);
}

TEST(MalformedTest, ManyTasksLikeAnUnknownOneCostLittle) {
  std::string methods;
  for (int i = 0; i < 20'000; ++i) {
    methods += "(:method (" + std::string(900, 'm') + std::to_string(i) + ") () ())";
  }
  const std::string name = std::string(900, 'm') + "xx";
  const Domain domain =
      ReadShop2Domain(DomainWith(methods + "(:method (m) () ((" + name + ")))"), "bad.lisp");
  EXPECT_THAT(domain.unknown_tasks.at(name), HasSubstr("xx' is unknown; write an operator"));
}

}  // namespace
}  // namespace hires::planning::malformed_test
