#include "hires/planning/datum_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "hires/base/error.h"
#include "hires/base/rng.h"

namespace hires::planning::datum_reader_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

Datum ReadSingle(const std::string& text) {
  const std::vector<Datum> data = ReadData(text, "t.lisp");
  EXPECT_THAT(data, SizeIs(1)) << text;
  return data.empty() ? Datum() : data[0];
}

/// What comes out when the text is read and written again.
std::string Again(const std::string& text) { return ToString(ReadSingle(text)); }

std::string ErrorOf(const std::string& text, const ReaderLimits& limits = {}) {
  try {
    ReadData(text, "t.lisp", limits);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

std::string Repeat(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(ReadDataTest, EmptyTextsHoldNothing) {
  for (const char* text : {"", " \n\t\r\n", "; only a comment", "#| one #| in |# another |#"}) {
    EXPECT_THAT(ReadData(text, "t.lisp"), SizeIs(0)) << text;
  }
}

TEST(ReadDataTest, LettersBecomeLowerCaseExceptInStrings) {
  EXPECT_EQ(Again("(:Operator (!Drive ?X Loc-A) \"As Is\")"),
            "(:operator (!drive ?x loc-a) \"As Is\")");
}

TEST(ReadDataTest, KindsAreTold) {
  EXPECT_EQ(ReadSingle("foo").kind, Datum::Kind::kSymbol);
  EXPECT_EQ(ReadSingle(":foo").kind, Datum::Kind::kSymbol);
  EXPECT_EQ(ReadSingle("?foo").kind, Datum::Kind::kVariable);
  EXPECT_EQ(ReadSingle("?").kind, Datum::Kind::kVariable);
  EXPECT_EQ(ReadSingle("12").kind, Datum::Kind::kInteger);
  EXPECT_EQ(ReadSingle("1.5").kind, Datum::Kind::kReal);
  EXPECT_EQ(ReadSingle("\"foo\"").kind, Datum::Kind::kString);
  EXPECT_EQ(ReadSingle("(foo)").kind, Datum::Kind::kList);
  EXPECT_EQ(ReadSingle("|?foo|").kind, Datum::Kind::kSymbol);
}

TEST(ReadDataTest, NumbersHaveTheirValues) {
  EXPECT_EQ(ReadSingle("-2"), MakeInteger(-2));
  EXPECT_EQ(ReadSingle("+3"), MakeInteger(3));
  EXPECT_EQ(ReadSingle("5."), MakeInteger(5));
  EXPECT_EQ(ReadSingle("-9223372036854775808"), MakeInteger(INT64_MIN));
  EXPECT_EQ(ReadSingle(".1"), MakeReal(0.1));
  EXPECT_EQ(ReadSingle("-.5"), MakeReal(-0.5));
  EXPECT_EQ(ReadSingle("+1.5"), MakeReal(1.5));
  EXPECT_EQ(ReadSingle("1e3"), MakeReal(1000.0));
  EXPECT_EQ(ReadSingle("1.5d-2"), MakeReal(0.015));
  EXPECT_EQ(ReadSingle("1/2"), MakeReal(0.5));
  EXPECT_EQ(ReadSingle("-4/2"), MakeInteger(-2));
}

TEST(ReadDataTest, WhatOnlyResemblesANumberIsASymbol) {
  for (const char* text :
       {"+", "-", "1+", "1-", "loc1-1", "1/x", "1e", "e5", "1.2.3", "+-1", "b.c"}) {
    EXPECT_EQ(ReadSingle(text), MakeSymbol(text)) << text;
  }
}

TEST(ReadDataTest, QuotesBecomeLists) {
  EXPECT_EQ(Again("'?x"), "(quote ?x)");
  EXPECT_EQ(Again("`(a ,(b) 'c)"), "(backquote (a (unquote (b)) (quote c)))");
  EXPECT_EQ(Again("(:sort-by ?c #'> (p))"), "(:sort-by ?c (function >) (p))");
  EXPECT_EQ(Again("''a"), "(quote (quote a))");
}

TEST(ReadDataTest, DottedListsKeepTheirTail) {
  const Datum list = ReadSingle("(?g . ?gs)");
  EXPECT_THAT(list.items, SizeIs(1));
  ASSERT_THAT(list.tail, SizeIs(1));
  EXPECT_EQ(list.tail[0], MakeVariable("?gs"));
  EXPECT_EQ(ToString(list), "(?g . ?gs)");
}

TEST(ReadDataTest, ADotBeforeAListIsNoDot) {
  EXPECT_EQ(Again("(a . (b . (c . nil)))"), "(a b c)");
  EXPECT_EQ(Again("(a . (b . ?c))"), "(a b . ?c)");
  EXPECT_EQ(Again("(a . ())"), "(a)");
}

TEST(ReadDataTest, BarsAndBackslashesMakeSymbols) {
  EXPECT_EQ(ReadSingle("|a (b)|"), MakeSymbol("a (b)"));
  EXPECT_EQ(ReadSingle("x|Y z|w"), MakeSymbol("xy zw"));
  EXPECT_EQ(ReadSingle("a\\ b"), MakeSymbol("a b"));
  EXPECT_EQ(ReadSingle("|12|"), MakeSymbol("12"));
  EXPECT_EQ(ReadSingle("||"), MakeSymbol(""));
}

TEST(ReadDataTest, StringsKeepEscapedQuotes) {
  EXPECT_EQ(ReadSingle("\"a \\\"b\\\" \\\\ ;c\""), MakeString("a \"b\" \\ ;c"));
}

TEST(ReadDataTest, PackagePrefixesStayPartOfTheSymbol) {
  EXPECT_EQ(ReadSingle("shop3::find-plans"), MakeSymbol("shop3::find-plans"));
}

TEST(ReadDataTest, PlacesAreLinesAndColumns) {
  const std::vector<Datum> data = ReadData("; one\n(a\n   ?b \"\xC3\xA4\" c)", "t.lisp");
  ASSERT_THAT(data, SizeIs(1));
  EXPECT_EQ(data[0].place.line, 2);
  EXPECT_EQ(data[0].place.column, 1);
  EXPECT_EQ(data[0].items[1].place.line, 3);
  EXPECT_EQ(data[0].items[1].place.column, 4);
  EXPECT_EQ(data[0].items[3].place.column, 11) << "a letter of two bytes is one column";
}

TEST(ReadDataTest, ByteOrderMarksAreSkipped) {
  EXPECT_EQ(Again("\xEF\xBB\xBF(a)"), "(a)");
  EXPECT_EQ(Again("(a \xEF\xBB\xBF(b))"), "(a (b))") << "files joined by cat";
  const Datum marked = MakeSymbol(
      "\xEF\xBB\xBF"
      "b");
  EXPECT_EQ(ReadSingle(ToString(marked)), marked);
}

TEST(ReadDataTest, BlanksOfWebPagesAndWordProcessorsAreBlanks) {
  for (const std::string blank :
       {"\xC2\xA0", "\xE2\x80\x83", "\xE2\x80\x8B", "\xE2\x80\xAF", "\xE3\x80\x80"}) {
    SCOPED_TRACE(blank);
    EXPECT_EQ(Again(blank + "(a" + blank + "(b)" + blank + blank + "3" + blank + ")" + blank),
              "(a (b) 3)");
    const Datum kept = MakeSymbol("a" + blank + "b");
    EXPECT_EQ(ReadSingle(ToString(kept)), kept);
  }
  // Its neighbours are letters: a dash, and the e with an accent.
  EXPECT_EQ(ReadData("(a\xE2\x80\x93"
                     "b \xC3\xA0)",
                     "f")
                .at(0)
                .items.size(),
            2u);
}

TEST(ReadDataTest, NilAndTheEmptyListAreEqual) {
  EXPECT_EQ(ReadSingle("nil"), ReadSingle("()"));
  EXPECT_EQ(ReadSingle("(a nil)"), ReadSingle("(a ())"));
  EXPECT_NE(ReadSingle("nil"), ReadSingle("(nil)"));
}

TEST(DatumTest, DifferentDataAreNotEqual) {
  const std::vector<std::string> texts = {"a",   "?a",      "\"a\"", "1",  "1.0",
                                          "(a)", "(a . b)", "(a b)", "()", "(a . ?b)"};
  for (const std::string& a : texts) {
    for (const std::string& b : texts) EXPECT_EQ(ReadSingle(a) == ReadSingle(b), a == b) << a << b;
  }
}

TEST(DatumTest, RealsAreWrittenAsLispDoes) {
  EXPECT_EQ(ToString(MakeReal(15.0)), "15.0");
  EXPECT_EQ(ToString(MakeReal(0.1)), "0.1");
  EXPECT_EQ(ToString(MakeReal(-0.5)), "-0.5");
  EXPECT_EQ(ToString(MakeReal(0.0)), "0.0");
  EXPECT_EQ(ToString(MakeReal(1234567.0)), "1234567.0");
  EXPECT_EQ(ToString(MakeReal(1e20)), "1.0e20");
  EXPECT_EQ(ToString(MakeReal(-2.5e-7)), "-2.5e-7");
}

TEST(DatumTest, OnlyVariablesMakeADatumNotGround) {
  EXPECT_TRUE(IsGround(ReadSingle("(a (b 1 \"?x\") . c)")));
  EXPECT_FALSE(IsGround(ReadSingle("(a (b ?x))")));
  EXPECT_FALSE(IsGround(ReadSingle("(a . ?x)")));
}

/// A datum of any kind; `depth` lists deep at most.
Datum AnyDatum(base::Rng* rng, int depth) {
  static const std::vector<std::string> names = {"a",   "?v", "1+", "12",       "",   "a b", "nil",
                                                 "x|y", ".",  "#f", "\xC3\xA4", ":k", "1.5"};
  const std::string& name =
      names[static_cast<std::size_t>(rng->Index(static_cast<int>(names.size())))];
  switch (rng->Index(depth > 0 ? 8 : 5)) {
    case 0:
      return MakeSymbol(name);
    case 1:
      return MakeVariable("?x" + std::to_string(rng->Index(3)));
    case 2:
      return MakeInteger(rng->Index(2000) - 1000);
    case 3:
      return MakeReal(rng->Normal(0.0, 1.0) * std::pow(10.0, rng->Index(40) - 20));
    case 4:
      return MakeString(name + "\"\\");
    default:
      break;
  }
  Datum list;
  const int size = rng->Index(4);
  for (int i = 0; i < size; ++i) list.items.push_back(AnyDatum(rng, depth - 1));
  if (size > 0 && rng->Bernoulli(0.3)) list.tail.push_back(MakeVariable("?rest"));
  return list;
}

TEST(DatumTest, WhatIsWrittenReadsAsTheSame) {
  const base::Rng root(7);
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    base::Rng rng = root.Fork(seed);
    const Datum datum = AnyDatum(&rng, 4);
    EXPECT_EQ(ReadSingle(ToString(datum)), datum) << ToString(datum);
  }
}

TEST(ExcerptTest, IsShortWhateverTheDatum) {
  Datum huge = MakeList({MakeSymbol("many")});
  huge.items.resize(100'000, MakeString("with\nlines"));
  EXPECT_LE(Excerpt(huge).size(), 60u);
  EXPECT_THAT(Excerpt(huge), AllOf(HasSubstr("(many \"with lines\""), HasSubstr("...")));
  EXPECT_EQ(Excerpt(ReadSingle("(on a ?b)")), "(on a ?b)");
}

struct BadText {
  std::string text;
  std::vector<std::string> parts;  ///< of the message
};

TEST(ReadDataErrorTest, NamesPlaceAndRemedy) {
  const std::vector<BadText> bad_texts = {
      {"(a\n (b c)\n", {"t.lisp:1:1", "line 3", "add the missing ')'"}},
      {"(a\n (b\n", {"t.lisp:2:2", "add the missing ')'"}},
      {"(defdomain a (\n (b)\n)\n(defproblem c ())\n(defproblem d ())",
       {"t.lisp:1:1", "add the missing ')', before line 4"}},
      {"(a))\n", {"t.lisp:1:4", "')' closes nothing"}},
      {"\n ' ", {"t.lisp:2:2", "after this quote"}},
      {"(a ')", {"t.lisp:1:5", "follows a quote"}},
      {"(a . )", {"t.lisp:1:6", "follows a dot"}},
      {"(a . b c)", {"t.lisp:1:8", "second datum follows a dot"}},
      {"( . b)", {"t.lisp:1:3", "a dot stands here"}},
      {"a . b", {"t.lisp:1:3", "a dot stands here"}},
      {"(a . . b)", {"t.lisp:1:6", "a dot stands here"}},
      {"(a ' . b)", {"t.lisp:1:6", "a dot stands here"}},
      {"(a .. b)", {"t.lisp:1:4", "'..' is no name"}},
      {"(a ,@b)", {"t.lisp:1:4", "',@' is not supported", "append"}},
      {"#.(delete-file \"x\")", {"t.lisp:1:1", "runs code"}},
      {"#(1 2)", {"t.lisp:1:1", "'#' starts nothing"}},
      {"(a \"b\n c", {"t.lisp:1:4", "string", "has no end"}},
      {"(a \"b\\", {"t.lisp:1:4", "string", "has no end"}},
      {"(a |b", {"t.lisp:1:5", "|symbol|", "has no end"}},
      {"a\\", {"t.lisp:1:1", "symbol", "has no end"}},
      {"x #| y #| z |#", {"t.lisp:1:3", "comment", "has no end"}},
      {"99999999999999999999", {"t.lisp:1:1", "beyond 64 bits"}},
      {"1e999", {"t.lisp:1:1", "1e999", "beyond"}},
      {"3/0", {"t.lisp:1:1", "3/0 divides by zero"}},
      {std::string("(a \x01)"), {"t.lisp:1:4", "control character 0x01"}},
      {std::string("a\0b", 3), {"t.lisp:1:2", "control character 0x00"}},
      {"(caf\xE9 1)", {"t.lisp:1:2", "UTF-8"}},
      {"(a \"\xC3\")", {"t.lisp:1:4", "UTF-8"}},
      {"\xED\xA0\x80", {"t.lisp:1:1", "UTF-8"}},
  };
  for (const BadText& bad : bad_texts) {
    for (const std::string& part : bad.parts) {
      EXPECT_THAT(ErrorOf(bad.text), HasSubstr(part)) << bad.text;
    }
  }
}

TEST(ReadDataErrorTest, NestingIsLimited) {
  EXPECT_EQ(ErrorOf(Repeat("(", 1000) + Repeat(")", 1000)), "no error");
  EXPECT_THAT(ErrorOf(Repeat("(", 1'000'000)),
              AllOf(HasSubstr("t.lisp:1:1001"), HasSubstr("1000 lists are open"),
                    HasSubstr("line 1, column 1")));
  EXPECT_THAT(ErrorOf(Repeat("'", 1'000'000)), HasSubstr("t.lisp:1:1001"));
}

TEST(ReadDataErrorTest, LongSymbolsAreCutInTheMessage) {
  const std::string message = ErrorOf("\n(" + std::string(50 << 20, 'a') + ")");
  EXPECT_THAT(message, AllOf(HasSubstr("t.lisp:2:2"), HasSubstr("longer than 1000 bytes"),
                             HasSubstr("aaa...")));
  EXPECT_LT(message.size(), 200u);
  EXPECT_THAT(ErrorOf("|" + std::string(2000, 'a')), HasSubstr("longer than 1000 bytes"));
  EXPECT_EQ(ErrorOf(std::string(1000, 'a')), "no error");
}

TEST(ReadDataErrorTest, LongStringsNameWhereTheyBegin) {
  EXPECT_THAT(ErrorOf("(a \"" + std::string(2 << 20, 'x')),
              AllOf(HasSubstr("t.lisp:1:4"), HasSubstr("closing quote missing")));
}

TEST(ReadDataErrorTest, HugeTextsAreNotRead) {
  EXPECT_THAT(ErrorOf(std::string(100 << 20, 'a')),
              AllOf(HasSubstr("104857600 bytes"), HasSubstr("67108864")));
}

TEST(ReadDataErrorTest, TheNumberOfDataIsLimited) {
  ReaderLimits limits;
  limits.max_data = 10;
  EXPECT_EQ(ErrorOf("(a b c d e f g h i)", limits), "no error");
  EXPECT_THAT(ErrorOf("(a b c d e f g h i\n j)", limits),
              AllOf(HasSubstr("t.lisp:2:2"), HasSubstr("more than 10 symbols")));
}

}  // namespace
}  // namespace hires::planning::datum_reader_test
