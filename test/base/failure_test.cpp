#include "hires/base/failure.h"

#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <stdexcept>
#include <string>

#include "hires/base/text.h"

namespace hires::base::failure_test {
namespace {

TEST(FailureTest, EveryCodeHasOneNumberAndOneWordAndComesBackFromBoth) {
  std::set<std::string> words;
  std::uint16_t last = 0;
  for (const FailureInfo& info : AllFailures()) {
    const auto number = static_cast<std::uint16_t>(info.code);
    EXPECT_GT(number, last) << info.word << ": the table goes by number";
    last = number;
    EXPECT_TRUE(words.insert(info.word).second) << info.word;
    EXPECT_EQ(ParseFailureCode(info.word), info.code);
    EXPECT_EQ(FailureCodeOf(number), info.code);
    EXPECT_EQ(ToString(info.code), info.word);
  }
}

TEST(FailureTest, TableKnowsEveryEnumerator) {
  const std::string header =
      ReadTextFile(std::string(HIRES_SOURCE_DIR) + "/include/hires/base/failure.h");
  const std::regex enumerator(R"(\n  k[A-Za-z]+ = (\d+))");
  std::size_t count = 0;
  for (std::sregex_iterator at(header.begin(), header.end(), enumerator), end; at != end; ++at) {
    const auto code = static_cast<FailureCode>(std::stoi((*at)[1]));
    if (code == FailureCode::kNone) continue;
    EXPECT_EQ(InfoOf(code).code, code) << at->str();
    ++count;
  }
  EXPECT_EQ(count, AllFailures().size());
}

// Messages, bags and stores carry these numbers: whoever changes one changes what they say.
TEST(FailureTest, NumbersOnTheWireStayAsTheyAre) {
  EXPECT_EQ(static_cast<int>(FailureCode::kObjectFell), 1);
  EXPECT_EQ(static_cast<int>(FailureCode::kAreaOccupied), 12);
  EXPECT_EQ(static_cast<int>(FailureCode::kTimedOut), 110);
  EXPECT_EQ(static_cast<int>(FailureCode::kMotorsHalted), 200);
  EXPECT_EQ(static_cast<int>(FailureCode::kConditionLost), 304);
  EXPECT_EQ(static_cast<int>(FailureCode::kBadStart), 400);
  EXPECT_EQ(static_cast<int>(FailureCode::kRobotTips), 111);
  EXPECT_EQ(AllFailures().size(), 64u);
}

TEST(FailureTest, UnknownWordsAndNumbersAreNoCodes) {
  EXPECT_EQ(ParseFailureCode("object_flew"), std::nullopt);
  EXPECT_EQ(ParseFailureCode(""), std::nullopt);
  EXPECT_EQ(FailureCodeOf(99), std::nullopt);
  EXPECT_EQ(FailureCodeOf(0), FailureCode::kNone);
  EXPECT_THROW(InfoOf(static_cast<FailureCode>(99)), std::logic_error);
  EXPECT_THROW(InfoOf(FailureCode::kNone), std::logic_error);
}

TEST(FailureTest, TextNamesSubjectsUnlessThereAreWordsForPeople) {
  EXPECT_EQ(ToString(Failure()), "");
  EXPECT_EQ(ToString(Failure(FailureCode::kStuck)), "stuck");
  EXPECT_EQ(ToString(Failure(FailureCode::kAreaOccupied, {"Book1", "book2"})),
            "area_occupied: book1, book2");
  EXPECT_EQ(ToString(Failure(FailureCode::kRobotCollision, {"l_forearm", "table1"},
                             "l_forearm touches table1")),
            "robot_collision: l_forearm touches table1");
}

TEST(FailureTest, WordsForPeopleMakeNoDifference) {
  const Failure a(FailureCode::kStalePose, {}, "0.41 s"), b(FailureCode::kStalePose, {}, "0.42 s");
  EXPECT_EQ(a, b);
  EXPECT_FALSE(a < b || b < a);
  EXPECT_NE(a, Failure(FailureCode::kStaleScan));
  EXPECT_NE(a, Failure(FailureCode::kStalePose, {"map"}));
  EXPECT_TRUE(a);
  EXPECT_FALSE(Failure());
}

// What imagination and repair decide by; a change here changes what the robot tries again.
TEST(FailureTest, ScopesSayWhetherAnotherWayMayHelp) {
  EXPECT_EQ(InfoOf(FailureCode::kAreaOccupied).scope, FailureScope::kAction);
  EXPECT_FALSE(InfoOf(FailureCode::kAreaOccupied).may_pass);
  EXPECT_FALSE(InfoOf(FailureCode::kUnreachable).may_pass);
  EXPECT_EQ(InfoOf(FailureCode::kMotorsHalted).scope, FailureScope::kRobot);
  EXPECT_EQ(InfoOf(FailureCode::kNoController).scope, FailureScope::kRobot);
  EXPECT_EQ(InfoOf(FailureCode::kEffectMissing).scope, FailureScope::kPlan);
}

}  // namespace
}  // namespace hires::base::failure_test
