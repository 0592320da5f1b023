#include "hires/planning/functions.h"

#include <gmock/gmock.h>

#include <string>
#include <utility>
#include <vector>

#include "hires/base/error.h"
#include "planning/evaluate.h"

namespace hires::planning::functions_test {
namespace {

using test_support::Evaluate;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

struct Case {
  std::string expression;
  std::string value;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.expression; }

class FunctionTest : public ::testing::TestWithParam<Case> {};

TEST_P(FunctionTest, GivesTheValueOfCommonLisp) {
  EXPECT_EQ(Evaluate(GetParam().expression), GetParam().value);
}

INSTANTIATE_TEST_SUITE_P(Arithmetic, FunctionTest,
                         ::testing::Values(Case{"(+)", "0"}, Case{"(+ 1 2 3)", "6"},
                                           Case{"(+ 1 2.5)", "3.5"}, Case{"(- 3)", "-3"},
                                           Case{"(- 10 3 2)", "5"}, Case{"(*)", "1"},
                                           Case{"(* 2 3 4)", "24"}, Case{"(* 0.1 200)", "20.0"},
                                           Case{"(1+ 41)", "42"}, Case{"(1- 0)", "-1"},
                                           Case{"(abs -3)", "3"}, Case{"(abs 2.5)", "2.5"},
                                           Case{"(min 3 1 2)", "1"}, Case{"(max 3 1.5)", "3"},
                                           Case{"(max 3 3.5)", "3.5"}, Case{"(sqrt 16)", "4.0"},
                                           Case{"(expt 2 10)", "1024"}, Case{"(expt 2 -1)", "0.5"},
                                           Case{"(expt -1 -3)", "-1"}, Case{"(expt 9 0.5)", "3.0"},
                                           Case{"(expt 0 0)", "1"}));

// Integers that do not divide evenly give reals, where Common Lisp would give a ratio.
INSTANTIATE_TEST_SUITE_P(Division, FunctionTest,
                         ::testing::Values(Case{"(/ 6 3)", "2"}, Case{"(/ 7 2)", "3.5"},
                                           Case{"(/ 2)", "0.5"}, Case{"(/ 1)", "1"},
                                           Case{"(/ 24 2 3)", "4"}, Case{"(/ 6.0 3)", "2.0"},
                                           Case{"(/ 0 5)", "0"}));

INSTANTIATE_TEST_SUITE_P(
    Rounding, FunctionTest,
    ::testing::Values(
        Case{"(floor 7 2)", "3"}, Case{"(floor -7 2)", "-4"}, Case{"(floor 7 -2)", "-4"},
        Case{"(floor -2.5)", "-3"}, Case{"(ceiling 7 2)", "4"}, Case{"(ceiling -7 2)", "-3"},
        Case{"(ceiling 2.1)", "3"}, Case{"(truncate -7 2)", "-3"}, Case{"(truncate 2.9)", "2"},
        Case{"(round 5 2)", "2"}, Case{"(round 7 2)", "4"}, Case{"(round -5 2)", "-2"},
        Case{"(round -7 2)", "-4"}, Case{"(round 5 -2)", "-2"}, Case{"(round 8 3)", "3"},
        Case{"(round 7 3)", "2"}, Case{"(round 8 -3)", "-3"}, Case{"(round 2.5)", "2"},
        Case{"(round 3.5)", "4"}, Case{"(mod 7 3)", "1"}, Case{"(mod -7 3)", "2"},
        Case{"(mod 7 -3)", "-2"}, Case{"(rem -7 3)", "-1"}, Case{"(rem 7 -3)", "1"},
        Case{"(mod -0.5 2)", "1.5"}, Case{"(rem -0.5 2)", "-0.5"}));

// 2^63 = 9223372036854775808 is the first that does not fit.
INSTANTIATE_TEST_SUITE_P(
    BeyondSixtyFourBits, FunctionTest,
    ::testing::Values(Case{"(+ 9223372036854775806 1)", "9223372036854775807"},
                      Case{"(= (+ 9223372036854775807 1) (expt 2.0 63))", "t"},
                      Case{"(integerp (+ 9223372036854775807 1))", "nil"},
                      Case{"(= (- -9223372036854775807 2) (- (expt 2.0 63)))", "t"},
                      Case{"(= (* 4294967296 4294967296) (expt 2.0 64))", "t"},
                      Case{"(= (abs (- -9223372036854775807 1)) (expt 2.0 63))", "t"},
                      Case{"(= (/ (- -9223372036854775807 1) -1) (expt 2.0 63))", "t"},
                      Case{"(= (floor (- -9223372036854775807 1) -1) (expt 2.0 63))", "t"},
                      Case{"(mod (- -9223372036854775807 1) -1)", "0"},
                      Case{"(expt 2 62)", "4611686018427387904"},
                      Case{"(integerp (expt 2 63))", "nil"},
                      Case{"(integerp (floor 1.0e30))", "nil"}));

// A conversion to double would make 2^53 + 1 equal to 2^53.
INSTANTIATE_TEST_SUITE_P(
    Comparison, FunctionTest,
    ::testing::Values(Case{"(< 1 2 3)", "t"}, Case{"(< 1 3 2)", "nil"}, Case{"(< 1 1)", "nil"},
                      Case{"(<= 1 1 2)", "t"}, Case{"(> 3 2.5 1)", "t"}, Case{"(>= 2 2 3)", "nil"},
                      Case{"(= 1 1.0 1)", "t"}, Case{"(= 1 2)", "nil"}, Case{"(/= 1 2 3)", "t"},
                      Case{"(/= 1 2 1.0)", "nil"}, Case{"(< 5)", "t"},
                      Case{"(= 9007199254740993 9007199254740992.0)", "nil"},
                      Case{"(> 9007199254740993 9007199254740992.0)", "t"},
                      Case{"(< 9007199254740992.0 9007199254740993)", "t"},
                      Case{"(< 9223372036854775807 1.0e30)", "t"}, Case{"(< -1.0e30 0)", "t"},
                      Case{"(< 2 2.5)", "t"}, Case{"(< -2 -2.5)", "nil"}, Case{"(zerop 0.0)", "t"},
                      Case{"(plusp -1)", "nil"}, Case{"(minusp -0.5)", "t"},
                      Case{"(evenp -4)", "t"}, Case{"(oddp -3)", "t"}));

INSTANTIATE_TEST_SUITE_P(
    Sameness, FunctionTest,
    ::testing::Values(Case{"(eq 'a 'a)", "t"}, Case{"(eq 'a 'b)", "nil"}, Case{"(eq 3 3)", "t"},
                      Case{"(eq 1.5 1.5)", "nil"}, Case{"(eql 1.5 1.5)", "t"},
                      Case{"(eql 1 1.0)", "nil"}, Case{"(eql '(a) '(a))", "nil"},
                      Case{"(eql nil '())", "t"}, Case{"(equal '(a (1 b)) '(a (1 b)))", "t"},
                      Case{"(equal '(1) '(1.0))", "nil"}, Case{"(equal \"x\" \"x\")", "t"},
                      Case{"(equal \"x\" \"X\")", "nil"}, Case{"(eql \"x\" \"x\")", "nil"},
                      Case{"(equalp \"x\" \"X\")", "t"},
                      Case{"(equalp '(1 (a . 2.0)) '(1.0 (a . 2)))", "t"},
                      Case{"(equalp 1 1.5)", "nil"}));

INSTANTIATE_TEST_SUITE_P(
    Lists, FunctionTest,
    ::testing::Values(Case{"(list 1 'a \"s\")", "(1 a \"s\")"}, Case{"(list)", "nil"},
                      Case{"(cons 'a '(b))", "(a b)"}, Case{"(cons 'a 'b)", "(a . b)"},
                      Case{"(list* 1 2 '(3))", "(1 2 3)"}, Case{"(car '(a b))", "a"},
                      Case{"(car nil)", "nil"}, Case{"(cdr '(a b))", "(b)"},
                      Case{"(rest '(a . b))", "b"}, Case{"(first '(a b))", "a"},
                      Case{"(second '(a b))", "b"}, Case{"(third '(a b))", "nil"},
                      Case{"(fourth '(1 2 3 4 5))", "4"}, Case{"(fifth '(1 2 3 4 5))", "5"},
                      Case{"(cadr '(a b c))", "b"}, Case{"(cddr '(a b c))", "(c)"},
                      Case{"(caar '((a) b))", "a"}, Case{"(cdar '((a b) c))", "(b)"},
                      Case{"(caddr '(a b c))", "c"}, Case{"(nth 1 '(a b))", "b"},
                      Case{"(nth 9 '(a b))", "nil"}, Case{"(nthcdr 1 '(a b))", "(b)"},
                      Case{"(last '(a b c))", "(c)"}, Case{"(last nil)", "nil"},
                      Case{"(last '(a b c) 2)", "(b c)"}, Case{"(butlast '(a b c))", "(a b)"},
                      Case{"(butlast '(a b c) 5)", "nil"}, Case{"(length '(a b c))", "3"},
                      Case{"(length nil)", "0"}, Case{"(append '(a) nil '(b c) '(d))", "(a b c d)"},
                      Case{"(append '(a) 'b)", "(a . b)"}, Case{"(append)", "nil"},
                      Case{"(reverse '(a b c))", "(c b a)"}));

INSTANTIATE_TEST_SUITE_P(
    Sets, FunctionTest,
    ::testing::Values(
        Case{"(member 'b '(a b c))", "(b c)"}, Case{"(member 'd '(a b c))", "nil"},
        Case{"(member '(a) '((a)))", "nil"}, Case{"(member '(a) '((a)) :test #'equal)", "((a))"},
        Case{"(member 1 '(1.0) :test 'equalp)", "(1.0)"},
        Case{"(assoc 'b '((a 1) nil (b 2)))", "(b 2)"}, Case{"(assoc 'x '((a 1)))", "nil"},
        Case{"(find 'b '(a b))", "b"}, Case{"(position 'c '(a b c))", "2"},
        Case{"(position 'x '(a b c))", "nil"}, Case{"(count 'a '(a b a))", "2"},
        Case{"(remove 'a '(a b a c))", "(b c)"},
        Case{"(remove '(a) '((a) b) :test #'equal)", "(b)"},
        Case{"(remove-duplicates '(a b a c b))", "(a c b)"},
        Case{"(union '(a b) '(b c))", "(a b c)"}, Case{"(intersection '(a b c) '(c b x))", "(b c)"},
        Case{"(set-difference '(a b c) '(b))", "(a c)"}, Case{"(subsetp '(a b) '(b c a))", "t"},
        Case{"(subsetp '(a d) '(b c a))", "nil"}, Case{"(subsetp nil nil)", "t"}));

INSTANTIATE_TEST_SUITE_P(TypeTests, FunctionTest,
                         ::testing::Values(Case{"(not nil)", "t"}, Case{"(not 0)", "nil"},
                                           Case{"(null '(a))", "nil"}, Case{"(numberp 1.5)", "t"},
                                           Case{"(numberp 'a)", "nil"}, Case{"(integerp 1)", "t"},
                                           Case{"(symbolp 'a)", "t"}, Case{"(symbolp nil)", "t"},
                                           Case{"(symbolp 1)", "nil"}, Case{"(listp nil)", "t"},
                                           Case{"(listp 'a)", "nil"}, Case{"(consp '(a))", "t"},
                                           Case{"(consp nil)", "nil"}, Case{"(atom 'a)", "t"},
                                           Case{"(atom '(a))", "nil"},
                                           Case{"(stringp \"a\")", "t"}));

// ------------------------------------------------------------------------------ refused arguments

struct Refused {
  std::string expression;
  std::string message;
};
void PrintTo(const Refused& c, std::ostream* out) { *out << c.expression; }

class RefusedTest : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedTest, NamesPlaceFunctionAndWhatWasWanted) {
  EXPECT_THAT([] { Evaluate(GetParam().expression); },
              ThrowsMessage<base::ConfigError>(
                  AllOf(HasSubstr("test.lisp:1:1"), HasSubstr(GetParam().message))));
}

INSTANTIATE_TEST_SUITE_P(
    All, RefusedTest,
    ::testing::Values(
        Refused{"(+ 1 'b1)", "'+' got b1 as argument 2, wanted a number"},
        Refused{"(/ 1 0)", "'/' divides by 0"}, Refused{"(/ 0)", "'/' divides by 0"},
        Refused{"(/ 1 0.0)", "'/' divides by 0"}, Refused{"(mod 1 0)", "'mod' divides by 0"},
        Refused{"(floor 1 0)", "'floor' divides by 0"},
        Refused{"(expt 0 -1)", "'expt' divides by 0"},
        Refused{"(expt -8 0.5)", "'expt' got -8 as argument 1"},
        Refused{"(sqrt -1)", "'sqrt' got -1 as argument 1, wanted a number of at least 0"},
        Refused{"(* 1e300 1e300)", "'*' gives a number beyond all measure"},
        Refused{"(< 2 1 'x)", "'<' got x as argument 3, wanted a number"},
        Refused{"(evenp 2.0)", "'evenp' got 2.0 as argument 1, wanted an integer"},
        Refused{"(car 'a)", "'car' got a as argument 1, wanted a list"},
        Refused{"(length '(a . b))", "'length' got (a . b) as argument 1, wanted a list"},
        Refused{"(length \"abc\")", "'length' got \"abc\" as argument 1, wanted a list"},
        Refused{"(nth -1 '(a))", "'nth' got -1 as argument 1, wanted an integer of at least 0"},
        Refused{"(append 'a '(b))", "'append' got a as argument 1, wanted a list"},
        Refused{"(reverse 'a)", "'reverse' got a as argument 1, wanted a list"},
        Refused{"(assoc 'a '(b))", "'assoc' got (b) as argument 2, wanted a list of pairs"},
        Refused{"(member 'a '(b) :key 'first)", "'member' got :key as argument 3, wanted :test"},
        Refused{"(member 'a '(b) :test #'<)", "'member' got < as argument 4, wanted #'eq"},
        Refused{"(member 'a '(b) :test)", "wanted one function after :test"}));

TEST(BoundsTest, ListsOfMoreThanAMillionElementsAreRefused) {
  std::string doubled = "'(a b c d)";
  for (int i = 0; i < 19; ++i) doubled = "(let ((x " + doubled + ")) (append x x))";
  EXPECT_THAT([&] { Evaluate(doubled); },  // copies 4 * 2^18 = 1048576
              ThrowsMessage<base::ConfigError>(
                  HasSubstr("'append' makes a list of 1048576 elements, wanted at most 1000000")));
}

TEST(BoundsTest, ManyLargeListsInOneExpressionAreRefused) {
  std::string big = "'(0 1 2 3 4 5 6 7)";
  for (int i = 0; i < 16; ++i) big = "(let ((x " + big + ")) (append x x))";  // 524288 elements
  for (int i = 0; i < 40; ++i) big = "(mapcar #'1+ " + big + ")";
  EXPECT_THAT([&] { Evaluate(big); },
              ThrowsMessage<base::ConfigError>(HasSubstr("lists of more than 8000000 elements")));
}

TEST(BoundsTest, EqualpLooksAtAMillionElementsOnly) {
  TermTable terms;
  Term tree = terms.Real(1.0);
  for (int i = 0; i < 40; ++i) tree = terms.Pair(tree, tree);  // 2^40 leaves in 40 pairs
  const auto* equalp = Functions::Standard().Find("equalp");
  EXPECT_THAT(
      [&] {
        equalp->function(&terms, {tree, terms.Pair(tree, tree)});
      },
      ThrowsMessage<EvaluationError>(HasSubstr("equalp looks at 1000000 elements")));
}

// ------------------------------------------------------------------------------ the registry

Term Distance(TermTable* terms, const std::vector<Term>& arguments) {
  return terms->Real(terms->number(arguments[0]) - terms->number(arguments[1]));
}

TEST(FunctionsTest, AddedFunctionsAreCalledByName) {
  Functions functions = Functions::Standard();
  functions.Add("Distance", 2, 2, Distance);
  EXPECT_EQ(Evaluate("(+ 1 (distance 5 2))", {}, functions), "4.0");
}

TEST(FunctionsTest, FindsWhatWasAddedAndNothingElse) {
  Functions functions;
  EXPECT_EQ(functions.Find("distance"), nullptr);
  functions.Add("distance", 2, 2, Distance);
  functions.Add("area", 1, -1, Distance);
  ASSERT_NE(functions.Find("distance"), nullptr);
  EXPECT_EQ(functions.Find("distance")->max_arguments, 2);
  EXPECT_THAT(functions.Names(), ElementsAre("area", "distance"));
}

TEST(FunctionsTest, RefusesNamesThatAreTakenAndContradictions) {
  Functions functions = Functions::Standard();
  EXPECT_THAT([&] { functions.Add("eq", 2, 2, Distance); },
              ThrowsMessage<std::logic_error>(HasSubstr("function 'eq': the name is taken")));
  EXPECT_THAT([&] { functions.Add("let", 2, 2, Distance); },
              ThrowsMessage<std::logic_error>(HasSubstr("the name is a form of the language")));
  EXPECT_THAT([&] { functions.Add("f", 3, 2, Distance); },
              ThrowsMessage<std::logic_error>(HasSubstr("contradict each other")));
  EXPECT_THAT([&] { functions.Add("", 0, 0, Distance); },
              ThrowsMessage<std::logic_error>(HasSubstr("needs a name")));
}

TEST(FunctionsTest, StandardTestsAnswerTOrNilWithoutAnExpression) {
  TermTable terms;
  const Functions& standard = Functions::Standard();
  const Term a = terms.Symbol("a");
  EXPECT_EQ(standard.Find("eq")->function(&terms, {a, a}), terms.Symbol("t"));
  EXPECT_TRUE(standard.Find("not")->function(&terms, {a}).IsNil());
}

}  // namespace
}  // namespace hires::planning::functions_test
