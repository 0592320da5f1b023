#include "cli/verbs/imagine/playback.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace hires::cli::playback_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(PlaybackTest, PlaysAndPausesAtTheEnd) {
  Playback playback(1.0, 11.0);
  playback.Tick(4.0);
  EXPECT_DOUBLE_EQ(playback.position(), 5.0);
  EXPECT_FALSE(playback.is_paused());
  playback.Tick(100.0);
  EXPECT_DOUBLE_EQ(playback.position(), 11.0);
  EXPECT_TRUE(playback.is_paused());
  playback.Type(" ");  // once more
  EXPECT_FALSE(playback.is_paused());
  EXPECT_TRUE(playback.TakeJump());
  EXPECT_DOUBLE_EQ(playback.position(), 1.0);
}

TEST(PlaybackTest, StandsStillWhilePaused) {
  Playback playback(0.0, 10.0);
  playback.Type(" ");
  playback.Tick(3.0);
  EXPECT_DOUBLE_EQ(playback.position(), 0.0);
  EXPECT_FALSE(playback.TakeJump());
  playback.Type(" ");
  playback.Tick(3.0);
  EXPECT_DOUBLE_EQ(playback.position(), 3.0);
}

TEST(PlaybackTest, CursorKeysSeekEvenWhereTheirBytesComeOneByOne) {
  Playback playback(0.0, 10.0);
  playback.Tick(5.0);
  playback.Type("\x1b[C\x1b[C");
  EXPECT_DOUBLE_EQ(playback.position(), 7.0);
  for (const char* byte : {"\x1b", "[", "D"}) playback.Type(byte);
  EXPECT_DOUBLE_EQ(playback.position(), 6.0);
  EXPECT_TRUE(playback.TakeJump());
  EXPECT_FALSE(playback.TakeJump());
}

TEST(PlaybackTest, SeeksNoFurtherThanTheRecording) {
  Playback playback(2.0, 3.5);
  playback.Type("..");
  EXPECT_DOUBLE_EQ(playback.position(), 3.5);
  playback.Type(",,,,");
  EXPECT_DOUBLE_EQ(playback.position(), 2.0);
}

TEST(PlaybackTest, DigitsAreTenthsOfTheWhole) {
  Playback playback(2.0, 12.0);
  playback.Type("7");
  EXPECT_DOUBLE_EQ(playback.position(), 9.0);
  playback.Type("0");
  EXPECT_DOUBLE_EQ(playback.position(), 2.0);
}

TEST(PlaybackTest, RatesDoubleAndHalveWithinBounds) {
  Playback playback(0.0, 100.0);
  playback.Type("\x1b[A+");
  EXPECT_DOUBLE_EQ(playback.rate(), 4.0);
  playback.Tick(1.0);
  EXPECT_DOUBLE_EQ(playback.position(), 4.0);
  playback.Type("--------------------");
  EXPECT_DOUBLE_EQ(playback.rate(), 1.0 / 16);
}

TEST(PlaybackTest, OtherKeysDoNothingAndQEndsIt) {
  Playback playback(0.0, 10.0);
  playback.Type("xyz\n");
  EXPECT_FALSE(playback.is_paused() || playback.wants_to_quit() || playback.TakeJump());
  playback.Type("q");
  EXPECT_TRUE(playback.wants_to_quit());
}

TEST(PlaybackTest, TheSliderShowsWhereItIs) {
  Playback playback(0.0, 10.0);
  EXPECT_THAT(playback.Slider(11), StartsWith("|>          |   0.00 of 10.00 s  x 1"));
  playback.Type("5 ");
  EXPECT_THAT(playback.Slider(11), StartsWith("|=====>     |   5.00 of"));
  EXPECT_THAT(playback.Slider(11), HasSubstr("paused"));
  playback.Type("........");
  EXPECT_THAT(playback.Slider(11), StartsWith("|==========>|"));
}

TEST(PlaybackTest, AnEndBeforeTheBeginIsRefused) {
  EXPECT_THROW(Playback(2.0, 1.0), std::logic_error);
}

}  // namespace
}  // namespace hires::cli::playback_test
