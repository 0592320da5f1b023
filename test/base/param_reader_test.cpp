#include "hires/base/param_reader.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>

#include "hires/base/error.h"

namespace hires::base::param_reader_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

ParamReader Read(const std::string& yaml) { return ParamReader::FromString(yaml, "a.yaml"); }

/// The whole text of the ConfigError that the call throws.
template <typename Call>
std::string ErrorOf(Call call) {
  try {
    call();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(BoundTest, BetweenIncludesBothEndsAndNoNan) {
  const Bound<double> bound = Between(0.5, 2.0);
  EXPECT_TRUE(bound.holds(0.5));
  EXPECT_TRUE(bound.holds(2.0));
  EXPECT_FALSE(bound.holds(std::nextafter(0.5, 0.0)));
  EXPECT_FALSE(bound.holds(std::nextafter(2.0, 3.0)));
  EXPECT_FALSE(bound.holds(NAN));
  EXPECT_EQ(bound.wanted, "between 0.5 and 2");
}

TEST(BoundTest, PositiveMeansFiniteAndAboveZero) {
  const Bound<double> bound = Positive();
  EXPECT_TRUE(bound.holds(std::numeric_limits<double>::denorm_min()));
  EXPECT_FALSE(bound.holds(0.0));
  EXPECT_FALSE(bound.holds(-1.0));
  EXPECT_FALSE(bound.holds(INFINITY));
  EXPECT_FALSE(bound.holds(NAN));
  EXPECT_EQ(bound.wanted, "a finite number above 0");
}

TEST(BoundTest, WholeNumbersAndChoicesSayWhatTheyWant) {
  EXPECT_TRUE(Between(1, 4).holds(4));
  EXPECT_FALSE(Between(1, 4).holds(5));
  EXPECT_EQ(Between(1, 4).wanted, "a whole number between 1 and 4");
  EXPECT_TRUE(OneOf({"a", "b"}).holds("b"));
  EXPECT_FALSE(OneOf({"a", "b"}).holds("c"));
  EXPECT_EQ(OneOf({"a", "b"}).wanted, "one of 'a', 'b'");
}

TEST(BoundTest, AWordThatYamlReadsAsABoolIsFoundAmongTheChoices) {
  const std::pair<const char*, const char*> kPairs[] = {
      {"on", "off"}, {"yes", "no"}, {"true", "false"}};
  for (const auto& [on, off] : kPairs) {
    EXPECT_EQ(WordOf(true, OneOf({"domain", on, off})), on);
    EXPECT_EQ(WordOf(false, OneOf({"domain", on, off})), off);
    EXPECT_EQ(WordOf(true, OneOf({"domain", off})), std::nullopt);
    EXPECT_EQ(WordOf(false, OneOf({"domain", on})), std::nullopt);
  }
}

TEST(ParamReaderTest, ReadsEveryType) {
  ParamReader in = Read(
      "step: 0.001\n"
      "workers: 4\n"
      "ranking: risk\n"
      "verbose: true\n"
      "note: ''\n"
      "pose: [1, -2.5, 3e-1]\n"
      "names: [a, 'b c', 7]\n");
  EXPECT_EQ(in.Get("step", Between(0.0, 1.0)), 0.001);
  EXPECT_EQ(in.Get("workers", Between(1, 8)), 4);
  EXPECT_EQ(in.Get("ranking", OneOf({"risk", "thesis"})), "risk");
  EXPECT_TRUE(in.GetBool("verbose"));
  EXPECT_EQ(in.GetString("note"), "");
  EXPECT_THAT(in.GetNumbers("pose", 3), ElementsAre(1.0, -2.5, 0.3));
  EXPECT_THAT(in.GetStrings("names"), ElementsAre("a", "b c", "7"));
  EXPECT_NO_THROW(in.RejectUnknownKeys());
}

TEST(ParamReaderTest, AWholeNumberIsANumberToo) {
  EXPECT_EQ(Read("step: 2").Get("step", Between(0.0, 4.0)), 2.0);
}

TEST(ParamReaderTest, EmptyListsAreLists) {
  ParamReader in = Read("numbers: []\nstrings: []\nmaps: []");
  EXPECT_THAT(in.GetNumbers("numbers", 0), IsEmpty());
  EXPECT_THAT(in.GetStrings("strings"), IsEmpty());
  EXPECT_THAT(in.SubList("maps"), IsEmpty());
}

TEST(ParamReaderTest, HasAndKeysLookWithoutReading) {
  const ParamReader in = Read("zebra: 1\nant: 2\n");
  EXPECT_TRUE(in.Has("ant"));
  EXPECT_FALSE(in.Has("bee"));
  EXPECT_THAT(in.Keys(), ElementsAre("zebra", "ant"));
  EXPECT_THROW(in.RejectUnknownKeys(), ConfigError);
}

TEST(ParamReaderTest, AnEmptyDocumentIsAMapWithoutKeys) {
  for (const char* yaml : {"", "# only a comment\n", "---\n", "~"}) {
    ParamReader in = Read(yaml);
    EXPECT_THAT(in.Keys(), IsEmpty());
    EXPECT_FALSE(in.Has("a"));
    EXPECT_NO_THROW(in.RejectUnknownKeys());
    EXPECT_THAT(ErrorOf([&] { in.GetString("a"); }), HasSubstr("a.yaml: a is missing")) << yaml;
  }
}

TEST(ParamReaderTest, AMissingKeyIsNamedWithTheMapItMissesFrom) {
  EXPECT_EQ(ErrorOf([] { Read("a: 1\nsub:\n  b: 1\n").Sub("sub").GetString("c"); }),
            "a.yaml: sub.c is missing; line 3; add it");
}

TEST(ParamReaderTest, AValueOutOfBoundsIsNamedWithWhatWasWanted) {
  EXPECT_EQ(ErrorOf([] { Read("x: 1\nstep: 0.05").Get("step", Between(0.0, 0.01)); }),
            "a.yaml: step is '0.05', wanted between 0 and 0.01; line 2");
  EXPECT_EQ(ErrorOf([] { Read("n: 9").Get("n", Between(1, 8)); }),
            "a.yaml: n is '9', wanted a whole number between 1 and 8; line 1");
  EXPECT_EQ(ErrorOf([] {
              Read("r: ris").Get("r", OneOf({"risk", "thesis"}));
            }),
            "a.yaml: r is 'ris', wanted one of 'risk', 'thesis'; line 1");
}

TEST(ParamReaderTest, AValueOfAnotherTypeIsNamedWithWhatWasWanted) {
  EXPECT_EQ(ErrorOf([] { Read("x: fast").Get("x", Positive()); }),
            "a.yaml: x is 'fast', wanted a number; line 1");
  EXPECT_EQ(ErrorOf([] { Read("x: 1.5").Get("x", Between(0, 9)); }),
            "a.yaml: x is '1.5', wanted a whole number; line 1");
  EXPECT_EQ(ErrorOf([] { Read("x: 3000000000").Get("x", Between(0, 9)); }),
            "a.yaml: x is '3000000000', wanted a whole number; line 1");
  EXPECT_EQ(ErrorOf([] { Read("x: maybe").GetBool("x"); }),
            "a.yaml: x is 'maybe', wanted true or false; line 1");
  EXPECT_EQ(ErrorOf([] { Read("x: [1]").Get("x", Positive()); }),
            "a.yaml: x is a list, wanted a number; line 1");
  EXPECT_EQ(ErrorOf([] { Read("x: {a: 1}").GetString("x"); }),
            "a.yaml: x is a map, wanted text; line 1");
  EXPECT_EQ(ErrorOf([] { Read("x:").GetString("x"); }), "a.yaml: x is empty, wanted text; line 1");
  EXPECT_THAT([] { Read("x: .nan").Get("x", Between(0.0, 1.0)); },
              ThrowsMessage<ConfigError>(HasSubstr("x is '.nan', wanted between 0 and 1")));
}

TEST(ParamReaderTest, ALeadingZeroIsRefusedRatherThanReadAsOctal) {
  for (const char* text : {"010", "-010", "0x10"}) {
    EXPECT_EQ(ErrorOf([&] { Read(std::string("n: ") + text).Get("n", Between(-99, 99)); }),
              std::string("a.yaml: n is '") + text +
                  "', wanted a whole number without a leading 0; line 1");
  }
  EXPECT_EQ(Read("n: 0").Get("n", Between(0, 9)), 0);
  EXPECT_EQ(Read("n: -7").Get("n", Between(-9, 9)), -7);
}

TEST(ParamReaderTest, AListOfNumbersMustHaveItsSizeAndOnlyFiniteNumbers) {
  EXPECT_EQ(ErrorOf([] { Read("p: [1, 2]").GetNumbers("p", 3); }),
            "a.yaml: p is a list, wanted a list of 3 numbers and not 2; line 1");
  EXPECT_EQ(ErrorOf([] { Read("p: 1").GetNumbers("p", 1); }),
            "a.yaml: p is '1', wanted a list of 1 numbers; line 1");
  EXPECT_EQ(ErrorOf([] { Read("p: [1, b]").GetNumbers("p", 2); }),
            "a.yaml: p is a list, item 2 is 'b', wanted a finite number; line 1");
  EXPECT_EQ(ErrorOf([] { Read("p: [.inf, 1]").GetNumbers("p", 2); }),
            "a.yaml: p is a list, item 1 is '.inf', wanted a finite number; line 1");
  EXPECT_EQ(ErrorOf([] { Read("p: [1, [2]]").GetNumbers("p", 2); }),
            "a.yaml: p is a list, item 2 is a list, wanted a finite number; line 1");
}

TEST(ParamReaderTest, PairsAreAListOrTextOfOne) {
  const auto pairs_of = [](const std::string& yaml) {
    return Read(yaml).FindPairs("p", Between(-2.0, 2.0));
  };
  const std::vector<std::pair<double, double>> two{{1.0, -2.0}, {0.5, 2.0}};
  for (const char* yaml :
       {"p: [[1, -2], [0.5, 2]]", "p: '[[1, -2], [0.5, 2]]'", "p:\n- [1, -2]\n- - 0.5\n  - 2\n"}) {
    EXPECT_EQ(pairs_of(yaml), two) << yaml;
  }
  for (const char* yaml : {"p: []", "p: '[]'"}) EXPECT_EQ(pairs_of(yaml)->size(), 0u) << yaml;
  for (const char* yaml : {"p: 7", "p: text", "p: '[{'", "p: {x: 1}", "p: [{x: 1}]", "p: [1, 2]"})
    EXPECT_FALSE(pairs_of(yaml).has_value()) << yaml;
  for (const char* yaml : {"p: [[1, 2], [1]]", "p: [[1, 2], [1, 3]]", "p: [[1, 2], [1, .nan]]",
                           "p: [[1, 2], 1]", "p: [[1, 2], {x: 1}]", "p: [[1, 2], [1, [2]]]"}) {
    EXPECT_THAT(ErrorOf([&] { pairs_of(yaml); }),
                ::testing::HasSubstr("wanted a pair [x, y] of numbers between -2 and 2; line 1"))
        << yaml;
  }
}

TEST(ParamReaderTest, AListOfTextHoldsOnlyText) {
  EXPECT_EQ(ErrorOf([] { Read("s: [a, [b]]").GetStrings("s"); }),
            "a.yaml: s is a list, wanted a list of text; line 1");
  EXPECT_EQ(ErrorOf([] { Read("s: a").GetStrings("s"); }),
            "a.yaml: s is 'a', wanted a list of text; line 1");
}

TEST(ParamReaderTest, NestedMapsAreNamedByTheirPath) {
  ParamReader in = Read("a:\n  b:\n    c: x\nlist:\n  - d: 1\n  - d: y\n");
  ParamReader b = in.Sub("a").Sub("b");
  EXPECT_EQ(ErrorOf([&] { b.Get("c", Positive()); }),
            "a.yaml: a.b.c is 'x', wanted a number; line 3");
  std::vector<ParamReader> list = in.SubList("list");
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].Get("d", Positive()), 1.0);
  EXPECT_EQ(ErrorOf([&] { list[1].Get("d", Positive()); }),
            "a.yaml: list[1].d is 'y', wanted a number; line 6");
}

TEST(ParamReaderTest, WhatIsNoMapIsRefusedWhereAMapIsWanted) {
  EXPECT_EQ(ErrorOf([] { Read("[1, 2]"); }),
            "a.yaml: the document is a list, wanted a map of keys; line 1");
  EXPECT_EQ(ErrorOf([] { Read("a: 1").Sub("a"); }),
            "a.yaml: a is '1', wanted a map of keys; line 1");
  EXPECT_EQ(ErrorOf([] { Read("a: {b: 1}").SubList("a"); }),
            "a.yaml: a is a map, wanted a list of maps; line 1");
}

TEST(ParamReaderTest, AKeyThatNobodyAskedForIsRefusedWithTheLikelyOne) {
  ParamReader in = Read("num_wrokers: 4\nother: 1\n");
  in.GetString("other");
  EXPECT_EQ(ErrorOf([&] { in.Get("num_workers", Between(1, 8)); }),
            "a.yaml: key 'num_wrokers' is unknown; did you mean 'num_workers'?; line 1");
  EXPECT_EQ(ErrorOf([&] { in.RejectUnknownKeys(); }),
            "a.yaml: key 'num_wrokers' is unknown; did you mean 'num_workers'?; line 1");
}

TEST(ParamReaderTest, AMissingKeyThatStandsThereMistypedIsToldOnce) {
  const auto error_of = [](const std::string& yaml, const std::string& key) {
    return ErrorOf([&] { Read("a:\n  " + yaml).Sub("a").Get(key, Positive()); });
  };
  const std::string wanted = "' is unknown; did you mean 'a.mass'?; line 2";
  for (const std::string typo : {"mas", "masss", "amss"}) {
    EXPECT_EQ(error_of(typo + ": 0.5", "mass"), "a.yaml: key 'a." + typo + wanted);
  }
  EXPECT_EQ(ErrorOf([] {
              Read("tasks: x\n").RequireKeys({"robot", "task"});
            }),
            "a.yaml: key 'tasks' is unknown; did you mean 'task'?; line 1");
  // These may be keys in their own right.
  EXPECT_THAT(error_of("start_y: 1", "start_x"), HasSubstr("a.start_x is missing"));
  EXPECT_THAT(error_of("width: 1", "depth"), HasSubstr("a.depth is missing"));
  ParamReader in = Read("areas: x");
  in.GetString("areas");
  EXPECT_THAT(ErrorOf([&] { in.GetString("area"); }), HasSubstr("area is missing"));
}

TEST(ParamReaderTest, UnknownKeysOfNestedMapsAreRefusedToo) {
  ParamReader in = Read("a:\n  b: 1\n  d: 1\nlist:\n  - e: 1\n");
  in.Sub("a").GetString("b");
  in.SubList("list")[0].GetString("e");
  EXPECT_EQ(ErrorOf([&] { in.RejectUnknownKeys(); }),
            "a.yaml: key 'a.d' is unknown; did you mean 'a.b'?; line 3");
}

TEST(ParamReaderTest, AKeyThatStandsTwiceIsRefused) {
  EXPECT_EQ(ErrorOf([] { Read("a: 1\nb: 2\na: 3\n"); }),
            "a.yaml: a stands twice; line 3; keep one");
}

TEST(ParamReaderTest, BrokenYamlIsNamedWithItsLine) {
  EXPECT_THAT(
      [] { Read("a: 1\nb: [1, 2\nc: 3\n"); },
      ThrowsMessage<ConfigError>(AllOf(HasSubstr("a.yaml: no valid YAML"), HasSubstr("; line 3"))));
  EXPECT_THROW(Read("a: *nowhere"), ConfigError);
}

TEST(ParamReaderTest, ASecondDocumentIsNotPassedOver) {
  EXPECT_EQ(ErrorOf([] { Read("a: 1\n---\nb: 2\n"); }),
            "a.yaml: holds 2 YAML documents, wanted one; remove the '---'; line 3");
}

TEST(ParamReaderTest, EndlessNestingIsRefused) {
  EXPECT_THROW(Read("a: " + std::string(100000, '[')), ConfigError);
}

TEST(ParamReaderTest, FailSpeaksInTheWordsOfTheReader) {
  ParamReader in = Read("a:\n  low: 3\n  high: 2\n");
  EXPECT_EQ(ErrorOf([&] { in.Sub("a").Fail("high", "wanted at least low"); }),
            "a.yaml: a.high is '2', wanted at least low; line 3");
  EXPECT_EQ(ErrorOf([&] { in.Fail("b", "wanted with a"); }), "a.yaml: b is missing, wanted with a");
}

TEST(ParamReaderTest, CopiesShareWhatWasRead) {
  ParamReader in = Read("a: 1");
  ParamReader(in).GetString("a");
  EXPECT_NO_THROW(in.RejectUnknownKeys());
}

TEST(ParamReaderTest, AMissingFileIsNamed) {
  EXPECT_THAT([] { ParamReader::FromFile("/nowhere/b.yaml"); },
              ThrowsMessage<ConfigError>(HasSubstr("/nowhere/b.yaml: no such file")));
}

TEST(ParamReaderTest, AFileIsReadUnderItsOwnName) {
  const std::string path = ::testing::TempDir() + "hires_param_reader_test.yaml";
  std::ofstream(path) << "a: x\n";
  ParamReader in = ParamReader::FromFile(path);
  EXPECT_EQ(ErrorOf([&] { in.Get("a", Positive()); }),
            path + ": a is 'x', wanted a number; line 1");
  std::remove(path.c_str());
}

}  // namespace
}  // namespace hires::base::param_reader_test
