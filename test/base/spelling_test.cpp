#include "hires/base/spelling.h"

#include <gtest/gtest.h>

namespace hires::base::spelling_test {
namespace {

TEST(EditDistanceTest, CountsReplacedInsertedAndDeletedLetters) {
  EXPECT_EQ(EditDistance("cup", "cup"), 0u);
  EXPECT_EQ(EditDistance("cup", "cap"), 1u);
  EXPECT_EQ(EditDistance("emty", "empty"), 1u);
  EXPECT_EQ(EditDistance("", "mug"), 3u);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3u);
}

TEST(AreSpeltAlikeTest, OneLetterOfThreeOrTwoOfEightMayDiffer) {
  EXPECT_TRUE(AreSpeltAlike("emty", "empty"));
  EXPECT_TRUE(AreSpeltAlike("Robotat", "robot_at"));
  EXPECT_TRUE(AreSpeltAlike("has_arm_postrue", "has_arm_posture"));
  EXPECT_FALSE(AreSpeltAlike("empty", "Empty"));
  EXPECT_FALSE(AreSpeltAlike("on", "in"));
  EXPECT_FALSE(AreSpeltAlike("holds", "folded"));
}

TEST(LikelyNamesTest, GuessesSlipsAndPartsAndNothingElse) {
  const std::vector<std::string> known{"topple", "hot_coffee", "serve_coffee"};
  EXPECT_EQ(LikelyNames("Tople", known), std::vector<std::string>{"topple"});
  EXPECT_EQ(LikelyNames("coffee", known), (std::vector<std::string>{"hot_coffee", "serve_coffee"}));
  EXPECT_EQ(LikelyNames("xyzzy", known), std::vector<std::string>{});
  EXPECT_EQ(LikelyNames("xyzzy", {"mug"}), std::vector<std::string>{});
}

// To compare all of it with each of the known names would take minutes.
TEST(LikelyNamesTest, ANameOfAnyLengthIsAnsweredAtOnce) {
  const std::vector<std::string> known(1000, "serve_coffee");
  EXPECT_EQ(LikelyNames(std::string(1'000'000, 'x'), known), std::vector<std::string>{});
  EXPECT_EQ(LikelyNames("serve_coffee" + std::string(1'000'000, 'x'), {"serve_coffee"}),
            std::vector<std::string>{"serve_coffee"});
}

TEST(CountedTest, OneIsSingular) {
  EXPECT_EQ(Counted(0, "run"), "0 runs");
  EXPECT_EQ(Counted(1, "run"), "1 run");
  EXPECT_EQ(Counted(20, "run"), "20 runs");
}

}  // namespace
}  // namespace hires::base::spelling_test
