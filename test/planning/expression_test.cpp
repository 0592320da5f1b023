#include <gmock/gmock.h>

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/planning/functions.h"
#include "planning/evaluate.h"
#include "planning/functions/expression_node.h"

namespace hires::planning::expression_test {
namespace {

using test_support::Evaluate;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(VariableTest, StandsForItsValueQuotedOrNot) {
  EXPECT_EQ(Evaluate("?x", {{"?x", "b1"}}), "b1");
  EXPECT_EQ(Evaluate("'?x", {{"?x", "b1"}}), "b1");
  EXPECT_EQ(Evaluate("(not (eq '?x '?y))", {{"?x", "b1"}, {"?y", "b2"}}), "t");
  EXPECT_EQ(Evaluate("(not (eq ?x '?y))", {{"?x", "b1"}, {"?y", "b1"}}), "nil");
  EXPECT_EQ(Evaluate("(> ?a 3)", {{"?a", "4"}}), "t");
}

TEST(VariableTest, ListsAreValuesNotCalls) {
  EXPECT_EQ(Evaluate("(length ?l)", {{"?l", "(no-function a b)"}}), "3");
}

TEST(ConstantTest, NilTrueAndKeywordsAreThemselves) {
  EXPECT_EQ(Evaluate("nil"), "nil");
  EXPECT_EQ(Evaluate("()"), "nil");
  EXPECT_EQ(Evaluate("t"), "t");
  EXPECT_EQ(Evaluate(":test"), ":test");
  EXPECT_EQ(Evaluate("15.0"), "15.0");
  EXPECT_EQ(Evaluate("\"two words\""), "\"two words\"");
}

TEST(QuoteTest, ReplacesVariablesInside) {
  EXPECT_EQ(Evaluate("'(a (?x) . ?y)", {{"?x", "1"}, {"?y", "(b c)"}}), "(a (1) b c)");
  EXPECT_EQ(Evaluate("'(+ 1 2)"), "(+ 1 2)");
  EXPECT_EQ(Evaluate("'('a)"), "((quote a))");
}

TEST(QuoteTest, VariablesWithoutValueStay) {
  EXPECT_EQ(Evaluate("(list ?x 'a '(b . ?x))", {{"?x", ""}}), "(?0 a (b . ?0))");
  EXPECT_EQ(Evaluate("(cons '?x nil)", {{"?x", ""}}), "(?0)");
}

TEST(BackquoteTest, EvaluatesWhatIsUnquoted) {
  EXPECT_EQ(Evaluate("`(a ,(+ 1 ?x) ?x (b ,?x))", {{"?x", "2"}}), "(a 3 2 (b 2))");
  EXPECT_EQ(Evaluate("`(a b)"), "(a b)");
  EXPECT_EQ(Evaluate("`,(+ 1 2)"), "3");
  EXPECT_EQ(Evaluate("`(a ',(+ 1 2))"), "(a (quote 3))");
}

TEST(IfTest, TakesTheBranchThatTheTestSays) {
  EXPECT_EQ(Evaluate("(if (> 2 1) 'yes 'no)"), "yes");
  EXPECT_EQ(Evaluate("(if nil 'yes 'no)"), "no");
  EXPECT_EQ(Evaluate("(if nil 'yes)"), "nil");
  EXPECT_EQ(Evaluate("(if 0 'yes 'no)"), "yes");
}

TEST(IfTest, LeavesTheOtherBranchAlone) {
  EXPECT_EQ(Evaluate("(if t 1 (/ 1 0))"), "1");
  EXPECT_EQ(Evaluate("(if nil (/ 1 0) 2)"), "2");
}

TEST(CondTest, TakesTheFirstClauseThatHolds) {
  const std::string cond = "(cond ((< ?x 0) 'negative) ((= ?x 0) 'zero) (t 'positive))";
  EXPECT_EQ(Evaluate(cond, {{"?x", "-1"}}), "negative");
  EXPECT_EQ(Evaluate(cond, {{"?x", "0"}}), "zero");
  EXPECT_EQ(Evaluate(cond, {{"?x", "7"}}), "positive");
  EXPECT_EQ(Evaluate("(cond (nil 1))"), "nil");
  EXPECT_EQ(Evaluate("(cond (nil) ((+ 1 2)))"), "3");
  EXPECT_EQ(Evaluate("(cond (t 1 2 3))"), "3");
}

TEST(WhenTest, WhenAndUnlessAreOpposites) {
  EXPECT_EQ(Evaluate("(when t 1 2)"), "2");
  EXPECT_EQ(Evaluate("(when nil (/ 1 0))"), "nil");
  EXPECT_EQ(Evaluate("(when t)"), "nil");
  EXPECT_EQ(Evaluate("(unless nil 1 2)"), "2");
  EXPECT_EQ(Evaluate("(unless t (/ 1 0))"), "nil");
}

TEST(LogicExpressionTest, StopsAtTheFirstPartThatDecides) {
  EXPECT_EQ(Evaluate("(and)"), "t");
  EXPECT_EQ(Evaluate("(and 1 2)"), "2");
  EXPECT_EQ(Evaluate("(and nil (/ 1 0))"), "nil");
  EXPECT_EQ(Evaluate("(or)"), "nil");
  EXPECT_EQ(Evaluate("(or nil 2 (/ 1 0))"), "2");
}

TEST(LetTest, PlainLetSeesTheOuterNamesAndLetStarTheNewOnes) {
  EXPECT_EQ(Evaluate("(let ((x 1) (y 2)) (+ x y))"), "3");
  EXPECT_EQ(Evaluate("(let ((x 1)) (let ((x 2) (y x)) (list x y)))"), "(2 1)");
  EXPECT_EQ(Evaluate("(let ((x 1)) (let* ((x 2) (y x)) (list x y)))"), "(2 2)");
  EXPECT_EQ(Evaluate("(let ((x 1)) (let ((x 2)) x) x)"), "1");
  EXPECT_EQ(Evaluate("(let ((x (let ((a 1)) (+ a 1))) (y (let ((b 5)) b))) (list x y))"), "(2 5)");
  EXPECT_EQ(Evaluate("(let (x (y)) (list x y))"), "(nil nil)");
  EXPECT_EQ(Evaluate("(let ((x ?v)) (* x x))", {{"?v", "7"}}), "49");
}

TEST(ListFormTest, AppliesNamedFunctions) {
  EXPECT_EQ(Evaluate("(mapcar #'1+ '(1 2 3))"), "(2 3 4)");
  EXPECT_EQ(Evaluate("(mapcar #'+ '(1 2 3) '(10 20))"), "(11 22)");
  EXPECT_EQ(Evaluate("(mapcar 'list nil)"), "nil");
  EXPECT_EQ(Evaluate("(some #'evenp '(1 2 3))"), "t");
  EXPECT_EQ(Evaluate("(some #'< '(3 5) '(1 6))"), "t");
  EXPECT_EQ(Evaluate("(some #'evenp nil)"), "nil");
  EXPECT_EQ(Evaluate("(every #'evenp '(2 4))"), "t");
  EXPECT_EQ(Evaluate("(every #'evenp '(2 3))"), "nil");
  EXPECT_EQ(Evaluate("(every #'evenp nil)"), "t");
  EXPECT_EQ(Evaluate("(find-if #'oddp '(2 3 5))"), "3");
  EXPECT_EQ(Evaluate("(count-if #'oddp '(2 3 5))"), "2");
  EXPECT_EQ(Evaluate("(remove-if #'oddp '(1 2 3 4))"), "(2 4)");
  EXPECT_EQ(Evaluate("(remove-if-not #'oddp '(1 2 3 4))"), "(1 3)");
  EXPECT_EQ(Evaluate("(funcall #'- 5 3)"), "2");
  EXPECT_EQ(Evaluate("(apply #'+ 1 2 ?l)", {{"?l", "(3 4)"}}), "10");
}

TEST(ListFormTest, ReduceFoldsFromTheLeft) {
  EXPECT_EQ(Evaluate("(reduce #'- '(10 3 2))"), "5");
  EXPECT_EQ(Evaluate("(reduce #'- '(3 2) :initial-value 10)"), "5");
  EXPECT_EQ(Evaluate("(reduce #'+ nil)"), "0");
  EXPECT_EQ(Evaluate("(reduce #'max '(3))"), "3");
}

TEST(ListFormTest, SortKeepsTheOrderOfEquals) {
  EXPECT_EQ(Evaluate("(sort '(3 1 2) #'<)"), "(1 2 3)");
  EXPECT_EQ(Evaluate("(sort '(3 1 2) '>)"), "(3 2 1)");
  EXPECT_EQ(Evaluate("(sort '(1.0 2 1) #'<)"), "(1.0 1 2)");
}

TEST(ListFormTest, SortEndsWithAFunctionThatIsNoOrder) {
  EXPECT_EQ(Evaluate("(length (sort '(3 1 2 5 4 9 8 7 6 0 3 1 2 5 4 9 8 7 6 0) #'list))"), "20");
  EXPECT_EQ(Evaluate("(length (sort '(1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1) #'<=))"), "20");
}

TEST(EvaluationTest, RepeatsItselfWithTheSameTable) {
  TermTable terms;
  test_support::TextVariables variables(&terms, {{"?x", "(1 2)"}});
  const Expression expression(
      ReadData("(let ((y (mapcar #'1+ ?x))) `(sum ,(apply #'+ y)))", "test.lisp").at(0),
      [&](const std::string& name) { return variables.SlotOf(name); }, Functions::Standard(),
      &terms, "test.lisp");
  const Term first = expression.Evaluate(&terms, &variables);
  EXPECT_EQ(terms.ToString(first), "(sum 5)");
  EXPECT_EQ(expression.Evaluate(&terms, &variables), first);
}

TEST(EvaluationTest, GoesOnAfterAnError) {
  TermTable terms;
  test_support::TextVariables good(&terms, {{"?x", "2"}});
  test_support::TextVariables bad(&terms, {{"?x", "0"}});
  const Expression expression(
      ReadData("(+ 1 (/ 4 ?x))", "test.lisp").at(0), [](const std::string&) { return 0; },
      Functions::Standard(), &terms, "test.lisp");
  EXPECT_THROW(expression.Evaluate(&terms, &bad), base::ConfigError);
  EXPECT_EQ(terms.ToString(expression.Evaluate(&terms, &good)), "3");
}

// ------------------------------------------------------------------------------ what is refused

struct Malformed {
  std::string expression;
  std::string place;
  std::string message;
};
void PrintTo(const Malformed& c, std::ostream* out) { *out << c.expression; }

class MalformedExpressionTest : public ::testing::TestWithParam<Malformed> {};

TEST_P(MalformedExpressionTest, IsRefusedWithPlaceAndRemedy) {
  EXPECT_THAT(
      [] {
        Evaluate(GetParam().expression, {{"?u", ""}});
      },
      ThrowsMessage<base::ConfigError>(
          AllOf(HasSubstr("test.lisp:" + GetParam().place), HasSubstr(GetParam().message))));
}

INSTANTIATE_TEST_SUITE_P(
    All, MalformedExpressionTest,
    ::testing::Values(
        Malformed{"(lenght '(a))", "1:1", "did you mean 'length'"},
        Malformed{"(+ 1 (first))", "1:6", "function 'first' has 0 arguments, takes 1"},
        Malformed{"(floor 1 2 3)", "1:1", "function 'floor' has 3 arguments, takes 1 to 2"},
        Malformed{"(min)", "1:1", "function 'min' has 0 arguments, takes 1 or more"},
        Malformed{"(+ 1\n   foo)", "2:4", "unbound name"},
        Malformed{"(+ 1 foo)", "1:6", "write 'foo for the symbol itself"},
        Malformed{"(let ((foo 1)) fooo)", "1:16", "did you mean 'foo'"},
        Malformed{"(let ((foo 1) (bar foo)) bar)", "1:20", "unbound name"},
        Malformed{"((lambda (x) x) 1)", "1:1", "a call begins with the name of a function"},
        Malformed{"(mapcar (lambda (x) x) '(1))", "1:1", "lambda and computed functions"},
        Malformed{"(mapcar #'(lambda (x) x) '(1))", "1:1", "lambda and computed functions"},
        Malformed{"(lambda (x) x)", "1:1", "lambda is not supported"},
        Malformed{"(funcall ?u 1)", "1:1", "wanted, like #'first"},
        Malformed{"(mapcar #'frist '((1)))", "1:1", "did you mean 'first'"},
        Malformed{"(mapcar #'first '(1) '(2))", "1:1", "calls 'first' with 2 arguments"},
        Malformed{"(sort '(1) #'not)", "1:1", "calls 'not' with 2 arguments"},
        Malformed{"(sort '(1))", "1:1", "form 'sort' has 1 argument, takes 2"},
        Malformed{"(reduce #'cons nil)", "1:1", "give an :initial-value"},
        Malformed{"(reduce #'+ '(1) :from-end t)", "1:1", "wanted :initial-value and a value"},
        Malformed{"(apply #'first '(1 2))", "1:1", "2 arguments for 'first'"},
        Malformed{"(mapcar #'1+ 'a)", "1:1", "'mapcar' got a as argument 1, wanted a list"},
        Malformed{"(if)", "1:1", "form 'if' has 0 arguments, takes 2 to 3"},
        Malformed{"(cond t)", "1:7", "a clause of cond is a list (test value)"},
        Malformed{"(let x 1)", "1:1", "wanted a list of bindings"},
        Malformed{"(let ((?u 1)) 1)", "1:7", "a symbol without ?"},
        Malformed{"(let ((nil 1)) 1)", "1:7", "let binds a name"},
        Malformed{"(let ((x 1 2)) 1)", "1:7", "a binding is (name value)"},
        Malformed{"(quote a b)", "1:1", "form 'quote' has 2 arguments, takes 1"},
        Malformed{"'(a ,b)", "1:", "a comma belongs inside a backquote"},
        Malformed{"(+ 1 ,?u)", "1:6", "a comma belongs inside a backquote"},
        Malformed{"`(a `(b))", "1:1", "a backquote within a backquote"},
        Malformed{"(+ 1 . ?u)", "1:1", "(apply #'function list)"},
        Malformed{"(?u 1)", "1:1", "a call begins with the name of a function"},
        Malformed{"?u", "1:1", "the variable has no value here"},
        Malformed{"(+ 1 ?u)", "1:6", "the variable has no value here"},
        Malformed{"(eq 'a '?u)", "1:1", "'eq' got ?u with a variable that has no value"},
        Malformed{"(length (list ?u))", "1:1", "with a variable that has no value"},
        Malformed{"(if '?u 1 2)", "1:", "the variable has no value here"},
        Malformed{"(first '((a) . ?u))", "1:1", "with a variable that has no value"}));

std::string Nested(int depth) {
  std::string text = "1";
  for (int i = 0; i < depth; ++i) text = "(1+ " + text + ")";
  return text;
}

TEST(DepthTest, TwoHundredAndFiftySixListsAreAllowedAndNotOneMore) {
  EXPECT_EQ(Evaluate(Nested(256)), "257");
  EXPECT_THAT([] { Evaluate(Nested(257)); },
              ThrowsMessage<base::ConfigError>(
                  AllOf(HasSubstr("test.lisp:1:1"), HasSubstr("may nest 256 lists deep"))));
}

// ------------------------------------------------------------------------------ anything at all

/// Expressions out of everything that the language knows, mostly nonsense.
class RandomExpressions {
 public:
  explicit RandomExpressions(base::Rng rng) : rng_(rng), words_(Functions::Standard().Names()) {
    const std::vector<std::string> forms = FormNames();
    for (int i = 0; i < 3; ++i) words_.insert(words_.end(), forms.begin(), forms.end());
  }

  Datum Next(int depth) {
    if (depth == 0 || rng_.Bernoulli(0.2)) return Leaf();
    std::vector<Datum> items = {rng_.Bernoulli(0.95) ? MakeSymbol(Word()) : Next(depth - 1)};
    const int count = rng_.Index(4);
    for (int i = 0; i < count; ++i) items.push_back(Argument(depth - 1));
    Datum list = MakeList(std::move(items));
    if (rng_.Bernoulli(0.02)) list.tail.push_back(Leaf());
    return list;
  }

 private:
  const std::string& Word() {
    return words_[static_cast<std::size_t>(rng_.Index(static_cast<int>(words_.size())))];
  }

  Datum Argument(int depth) {
    if (rng_.Bernoulli(0.15)) return MakeList({MakeSymbol("function"), MakeSymbol(Word())});
    if (rng_.Bernoulli(0.2)) return MakeList({MakeSymbol("quote"), Next(depth)});
    return Next(depth);
  }

  Datum Leaf() {
    switch (rng_.Index(6)) {
      case 0:
        return MakeInteger(rng_.Index(7) - 3);
      case 1:
        return MakeReal(rng_.Normal(0.0, 1e3));
      case 2:
        return MakeInteger(std::numeric_limits<std::int64_t>::min() + rng_.Index(2));
      case 3:
        return MakeVariable(rng_.Bernoulli(0.7) ? "?list" : "?free");
      case 4:
        return MakeList({});
      default:
        return rng_.Bernoulli(0.5) ? MakeSymbol("t") : MakeString("Text");
    }
  }

  base::Rng rng_;
  std::vector<std::string> words_;
};

TEST(RandomExpressionsTest, EndWithAValueOrAConfigError) {
  RandomExpressions expressions(base::Rng(11));
  int num_values = 0;
  for (int i = 0; i < 50'000; ++i) {
    const Datum datum = expressions.Next(4);
    TermTable terms;
    test_support::TextVariables variables(&terms, {{"?list", "(3 1.5 (a . b) 2)"}, {"?free", ""}});
    try {
      const Expression expression(
          datum, [&](const std::string& name) { return variables.SlotOf(name); },
          Functions::Standard(), &terms, "random");
      expression.Evaluate(&terms, &variables);
      ++num_values;
    } catch (const base::ConfigError&) {  // anything else ends the test
    }
  }
  EXPECT_GT(num_values, 5'000);
}

}  // namespace
}  // namespace hires::planning::expression_test
