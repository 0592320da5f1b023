#include "hires/base/text.h"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "hires/base/error.h"
#include "hires/base/radians.h"
#include "hires/base/rng.h"
#include "hires/base/short_text.h"

namespace hires::base::text_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

TEST(ToLowerTest, ChangesLettersOnly) {
  EXPECT_EQ(ToLower("preManipulationAreaEastCounter1"), "premanipulationareaeastcounter1");
  EXPECT_EQ(ToLower(""), "");
  EXPECT_EQ(ToLower("A_1-\xC3\x84"), "a_1-\xC3\x84");  // bytes beyond ASCII stay
}

TEST(SplitTest, KeepsEmptyParts) {
  EXPECT_THAT(Split("a,b,c", ','), ElementsAre("a", "b", "c"));
  EXPECT_THAT(Split(",a,,b,", ','), ElementsAre("", "a", "", "b", ""));
  EXPECT_THAT(Split("abc", ','), ElementsAre("abc"));
  EXPECT_THAT(Split("", ','), ElementsAre(""));
}

TEST(SplitWordsTest, QuotesHoldBlanksTogether) {
  EXPECT_THAT(SplitWords(" a\tb  c\n"), ElementsAre("a", "b", "c"));
  EXPECT_THAT(SplitWords("_world:=\"/my lab/a.world\" _robot:=\"\" \"\""),
              ElementsAre("_world:=/my lab/a.world", "_robot:=", ""));
  EXPECT_THAT(SplitWords("a\"b c\"d"), ElementsAre("ab cd"));
  EXPECT_THAT(SplitWords("/o\"brien's lab"), ElementsAre("/o\"brien's", "lab"));
  EXPECT_THAT(SplitWords(" \t"), IsEmpty());
}

TEST(JoinTest, PutsTheSeparatorBetween) {
  EXPECT_EQ(Join({"a", "b", "c"}, ", "), "a, b, c");
  EXPECT_EQ(Join({"a"}, ", "), "a");
  EXPECT_EQ(Join({}, ", "), "");
}

TEST(SplitTest, JoinTakesItBack) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Rng rng = Rng(3).Fork(seed);
    std::string text;
    for (int i = rng.Index(20); i > 0; --i) text += "ab;"[rng.Index(3)];
    EXPECT_EQ(Join(Split(text, ';'), ";"), text);
  }
}

TEST(NearestNamesTest, RanksByEditDistanceThenByName) {
  const std::vector<std::string> known{"table10", "counter1", "table2", "table1"};
  EXPECT_THAT(NearestNames("tabel1", known), ElementsAre("table1", "table10", "table2"));
  EXPECT_THAT(NearestNames("TABLE2", known, 1), ElementsAre("table2"));
}

TEST(NearestNamesTest, OfTwoAsNearTheOneThatEndsAlikeComesFirst) {
  EXPECT_THAT(NearestNames("peppermil1", {"peppermill", "peppermill1"}),
              ElementsAre("peppermill1", "peppermill"));
}

TEST(NearestNamesTest, NamesEachOnce) {
  EXPECT_THAT(NearestNames("9.9", {"A.9", "5.9", "A.9"}), ElementsAre("5.9", "A.9"));
}

TEST(NearestNamesTest, CountsInsertionDeletionAndReplacementAsOne) {
  EXPECT_THAT(NearestNames("kitten", {"sitting", "kit", "kittens"}),
              ElementsAre("kittens", "kit", "sitting"));  // distances 1, 3, 3
}

TEST(NearestNamesTest, GivesNoMoreThanThereIs) {
  EXPECT_THAT(NearestNames("a", {}), IsEmpty());
  EXPECT_THAT(NearestNames("a", {"b"}, 5), ElementsAre("b"));
  EXPECT_THAT(NearestNames("a", {"b"}, 0), IsEmpty());
}

TEST(UnknownNameTest, ProposesWhatWasMeant) {
  EXPECT_EQ(UnknownName("area", "x1", {"y1"}), "area 'x1' is unknown; did you mean 'y1'?");
  EXPECT_EQ(UnknownName("area", "ab", {"ac", "b"}),
            "area 'ab' is unknown; did you mean one of 'ac', 'b'?");
  EXPECT_EQ(UnknownName("area", "x", {}), "area 'x' is unknown; none is defined");
}

TEST(UnknownNameTest, WhatLooksLikeNothingKnownGetsTheListAndNoGuess) {
  EXPECT_EQ(UnknownName("area", "x", {"kitchen", "dock"}),
            "area 'x' is unknown; did you mean one of 'kitchen', 'dock'?");
  std::vector<std::string> many;
  for (int i = 10; i < 30; ++i) many.push_back("table" + std::to_string(i));
  const std::string text = UnknownName("area", "moon", many);
  EXPECT_NE(text.find("'table12', ...?"), std::string::npos) << text;
  EXPECT_EQ(text.find("table13"), std::string::npos) << text;
  many.insert(many.begin(), "a_place_that_is_far_away");
  many.push_back("spoon_");
  const std::string nearest = UnknownName("area", "fork", many);
  EXPECT_NE(nearest.find("one of 'spoon_', 'table10', 'table11', ...?"), std::string::npos)
      << nearest;
  EXPECT_EQ(UnknownName("area", "fork", many, "hires list areas"),
            "area 'fork' is unknown; `hires list areas` lists what there is");
  EXPECT_EQ(UnknownName("area", "tabel12", many, "hires list areas"),
            "area 'tabel12' is unknown; did you mean 'table12'?");
}

TEST(UnknownNameTest, OnlyAThirdOfANameIsASlip) {
  EXPECT_EQ(UnknownName("ranking", "best", {"risk", "cost", "thesis"}),
            "ranking 'best' is unknown; did you mean one of 'risk', 'cost', 'thesis'?");
  EXPECT_EQ(UnknownName("motion set", "fats", {"slow", "fast"}),
            "motion set 'fats' is unknown; did you mean 'fast'?");
  EXPECT_EQ(UnknownName("option", "--wrld", {"--help", "--map", "--world"}),
            "option '--wrld' is unknown; did you mean '--world'?");
}

TEST(UnknownNameTest, BesideAClearSlipOthersAreNoGuess) {
  EXPECT_EQ(UnknownName("option", "--rolouts", {"--robot", "--rollouts"}),
            "option '--rolouts' is unknown; did you mean '--rollouts'?");
}

TEST(UnknownNameTest, WhatWasShortenedIsGuessedWhereNothingWasMistyped) {
  EXPECT_EQ(UnknownName("object", "peper1", {"cup1", "fork1", "peppermill1"}),
            "object 'peper1' is unknown; did you mean 'peppermill1'?");
  EXPECT_EQ(UnknownName("area", "counter1", {"placingAreaCounter1", "table1"}),
            "area 'counter1' is unknown; did you mean 'placingAreaCounter1'?");
  EXPECT_EQ(UnknownName("area", "counter1", {"placingAreaCounter1", "counter2"}),
            "area 'counter1' is unknown; did you mean 'counter2'?");
}

/// A folder of its own that goes away with the test.
class ReadTextFileTest : public ::testing::Test {
 protected:
  ReadTextFileTest()
      : folder_(std::filesystem::temp_directory_path() /
                ("hires_text_test_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~ReadTextFileTest() override { std::filesystem::remove_all(folder_); }
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return (folder_ / name).string();
  }
  std::filesystem::path folder_;
};

TEST_F(ReadTextFileTest, GivesEveryByte) {
  const std::string text("a\r\n\0b\xFF", 6);
  EXPECT_EQ(ReadTextFile(Write("a.txt", text)), text);
}

TEST_F(ReadTextFileTest, AnEmptyFileIsAnEmptyText) {
  EXPECT_EQ(ReadTextFile(Write("empty.txt", "")), "");
}

TEST_F(ReadTextFileTest, TheLimitItselfIsAllowedAndOneMoreIsNot) {
  const std::string path = Write("a.txt", "12345");
  EXPECT_EQ(ReadTextFile(path, 5), "12345");
  EXPECT_THAT([&] { ReadTextFile(path, 4); },
              ThrowsMessage<ConfigError>(
                  AllOf(HasSubstr(path), HasSubstr("5 bytes"), HasSubstr("at most 4"))));
}

TEST_F(ReadTextFileTest, AMissingFileIsNamed) {
  const std::string path = (folder_ / "nowhere.txt").string();
  EXPECT_THAT([&] { ReadTextFile(path); },
              ThrowsMessage<ConfigError>(AllOf(HasSubstr(path), HasSubstr("no such file"))));
}

TEST_F(ReadTextFileTest, OfARelativePathTheFolderIsTold) {
  EXPECT_THAT([] { ReadTextFile("no/such.world"); },
              ThrowsMessage<ConfigError>(HasSubstr("no/such.world: no such file in " +
                                                   std::filesystem::current_path().string())));
}

TEST_F(ReadTextFileTest, FoldersAndDevicesAreNoFiles) {
  EXPECT_THAT([&] { ReadTextFile(folder_.string()); },
              ThrowsMessage<ConfigError>(HasSubstr("no regular file")));
  EXPECT_THAT([] { ReadTextFile("/dev/zero"); },
              ThrowsMessage<ConfigError>(HasSubstr("no regular file")));
}

TEST_F(ReadTextFileTest, AFileIsReplacedWholeOrNotAtAll) {
  const std::string path = Write("a.txt", "before");
  ReplaceTextFile(path, std::string("a\0b", 3));
  EXPECT_EQ(ReadTextFile(path), std::string("a\0b", 3));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1)
      << "nothing unfinished is left";
  EXPECT_THAT([] { ReplaceTextFile("/no/such/folder/x.csv", "x"); },
              ThrowsMessage<ConfigError>(HasSubstr("/no/such/folder/x.csv: cannot be written")));
}

TEST_F(ReadTextFileTest, ADeviceTakesWhatIsWrittenAndStaysOneAndALinkALink) {
  const std::string path = Write("a.txt", "before"), link = (folder_ / "link").string(),
                    pipe = (folder_ / "pipe").string();
  std::filesystem::create_symlink(path, link);
  ReplaceTextFile(link, "after");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(ReadTextFile(path), "after");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string heard;
  std::thread reader([&] { std::getline(std::ifstream(pipe), heard); });
  ReplaceTextFile(pipe, "hello");
  reader.join();
  EXPECT_EQ(heard, "hello");
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  const std::string full = (folder_ / "full").string();
  std::filesystem::create_symlink("/dev/full", full);  // a link, for who breaks this as root
  EXPECT_THAT([&] { ReplaceTextFile(full, "x"); },
              ThrowsMessage<ConfigError>(HasSubstr(full + ": cannot be written")));
  EXPECT_TRUE(std::filesystem::is_character_file(full));
}

TEST_F(ReadTextFileTest, WhetherAFileMayBeReplacedIsKnownBefore) {
  const std::string path = Write("a.txt", "before");
  RequireReplaceable(path);
  RequireReplaceable((folder_ / "new.txt").string());
  RequireReplaceable("/dev/null");
  EXPECT_EQ(ReadTextFile(path), "before");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1)
      << "nothing was made";
  EXPECT_THAT([&] { RequireReplaceable(folder_.string()); },
              ThrowsMessage<ConfigError>(
                  AllOf(HasSubstr(folder_.string()), HasSubstr("it is a folder; name a file"))));
  for (const char* nowhere : {"/no/such/folder/x.csv", "/proc/x.csv"}) {
    EXPECT_THAT([&] { RequireReplaceable(nowhere); },
                ThrowsMessage<ConfigError>(HasSubstr(nowhere)));
  }
}

TEST_F(ReadTextFileTest, AForbiddenFileIsNamed) {
  const std::string path = Write("secret.txt", "a");
  std::filesystem::permissions(path, std::filesystem::perms::none);
  if (::access(path.c_str(), R_OK) == 0) GTEST_SKIP() << "root may read everything";
  EXPECT_THAT([&] { ReadTextFile(path); },
              ThrowsMessage<ConfigError>(AllOf(HasSubstr(path), HasSubstr("permissions"))));
}

TEST(RefuseUtf16Test, TextOfTwoBytesALetterIsNamedAndNothingElse) {
  using std::string_literals::operator""s;
  for (const std::string& text : {"\xFF\xFE"s, "\xFE\xFF\0<"s, "<\0a\0"s, "\0<\0a"s}) {
    EXPECT_THAT([&] { RefuseUtf16(text, "a.xml"); },
                ThrowsMessage<ConfigError>(
                    AllOf(HasSubstr("a.xml: is text in UTF-16"), HasSubstr("save it as UTF-8"))));
  }
  // The last three begin as binary files do: a short name, a count of either order.
  for (const std::string& text :
       {""s, "<"s, "<robot/>"s, "\xEF\xBB\xBF<a/>"s, "A\0\0\0"s, "\x04\0\0\0"s, "\0\0\0\x04"s}) {
    EXPECT_NO_THROW(RefuseUtf16(text, "a.xml")) << text;
  }
}

TEST(AllThatIsWrongTest, OneAloneIsItselfAndOfManyTheFirstAreListed) {
  EXPECT_EQ(AllThatIsWrong("a.yaml", {"a.yaml:1: x"}), "a.yaml:1: x");
  EXPECT_EQ(AllThatIsWrong("a.yaml", {"x", "y"}), "a.yaml: 2 things are wrong:\n  x\n  y");
  const std::vector<std::string> many(kMostListed + 7, "x");
  EXPECT_THAT(AllThatIsWrong("a.yaml", many),
              AllOf(HasSubstr("57 things are wrong"), EndsWith("\n  x\n  and 7 more")));
  EXPECT_EQ(FirstLines(many).size(), kMostListed + 1);
  EXPECT_THAT(FirstLines({"x"}), ElementsAre("x"));
}

TEST(RadiansTest, ATurnRoundedUpwardsIsOneAndDegreesAreNone) {
  for (const double angle : {0.0, 3.15, -6.2832, 6.284}) EXPECT_FALSE(WhyNoRadians(angle)) << angle;
  EXPECT_THAT(WhyNoRadians(-90.0).value(), HasSubstr("-90 degrees are -1.5708"));
  EXPECT_TRUE(WhyNoRadians(6.29));
}

}  // namespace
}  // namespace hires::base::text_test
