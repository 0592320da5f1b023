#include "hires/base/silence.h"

#include <gtest/gtest.h>

namespace hires::base::silence_test {
namespace {

/// A limit of 1 s; heard at 0.
Silence Heard() {
  Silence silence(1.0);
  silence.Look(0.0);
  silence.Hear();
  return silence;
}

TEST(SilenceTest, NobodyIsThereBeforeTheFirstWord) {
  Silence silence(1.0);
  EXPECT_FALSE(silence.Look(0.0));
  EXPECT_FALSE(silence.Look(0.1));
  silence.Hear();
  EXPECT_TRUE(silence.Look(0.2));
}

TEST(SilenceTest, WhoSaysNothingIsGoneAfterTheLimit) {
  Silence silence = Heard();
  for (int i = 1; i < 10; ++i) EXPECT_TRUE(silence.Look(0.1 * i)) << i;
  EXPECT_FALSE(silence.Look(1.01));
  EXPECT_FALSE(silence.Look(1.02));
  silence.Hear();
  EXPECT_TRUE(silence.Look(1.03));
}

// What was said meanwhile is heard after the look, as a timer that is overdue comes first.
TEST(SilenceTest, AListenerThatWasHeldUpItselfHasMissedNothing) {
  Silence silence = Heard();
  EXPECT_TRUE(silence.Look(60.0));
  silence.Hear();
  EXPECT_TRUE(silence.Look(60.9));
  EXPECT_TRUE(silence.Look(61.0));
}

TEST(SilenceTest, OneWhoDiedMeanwhileIsGoneSoonAfter) {
  Silence silence = Heard();
  EXPECT_TRUE(silence.Look(60.0));
  for (int i = 1; i < 7; ++i) EXPECT_TRUE(silence.Look(60.0 + 0.1 * i)) << i;
  EXPECT_FALSE(silence.Look(60.8));
}

TEST(SilenceTest, AClockThatGoesBackIsNoSilence) {
  Silence silence(1.0);
  silence.Look(100.0);
  silence.Hear();
  EXPECT_TRUE(silence.Look(0.0));
  EXPECT_TRUE(silence.Look(0.1));
}

}  // namespace
}  // namespace hires::base::silence_test
