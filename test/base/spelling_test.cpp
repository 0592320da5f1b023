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

}  // namespace
}  // namespace hires::base::spelling_test
