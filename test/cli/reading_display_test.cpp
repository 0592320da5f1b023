#include "cli/reading_display.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace hires::cli::reading_display_test {
namespace {

std::string ShownFrom(bool is_drawn_over) {
  std::ostringstream out;
  double now = 10.0;
  const auto show = ShowReadingOn(&out, is_drawn_over, [&] { return now; });
  show("reading hall.world", 0.1);
  now = 11.0;
  show("reading hall.world", 0.43);
  now = 12.0;
  show("reading hall.world", 1.0);
  return out.str();
}

TEST(ReadingDisplayTest, ATerminalShowsOneLineThatIsGoneAtTheEnd) {
  EXPECT_EQ(ShownFrom(true), "\rreading hall.world: 43 %\033[K\r\033[K");
}

TEST(ReadingDisplayTest, ALogHasALineNowAndThen) {
  EXPECT_EQ(ShownFrom(false), "reading hall.world: 43 %\n");
}

TEST(ReadingDisplayTest, LongWorkTellsWhatIsLeft) {
  std::ostringstream out;
  double now = 10.0;
  const auto show = ShowReadingOn(&out, false, [&] { return now; });
  show("mapping drive.log", 0.0);
  now = 14.0;
  show("mapping drive.log", 0.25);
  EXPECT_EQ(out.str(), "mapping drive.log: 25 %, 12 s left\n");
}

TEST(ReadingDisplayTest, WorkThatGoesOnFromAShareHasThePaceOfWhatIsNew) {
  std::ostringstream out;
  double now = 10.0;
  const auto show = ShowReadingOn(&out, false, [&] { return now; });
  show("series of drives", 0.5);  // was done before
  now = 15.0;
  show("series of drives", 0.6);  // a tenth in 5 s, four more to come
  EXPECT_EQ(out.str(), "series of drives: 60 %, 20 s left\n");
}

}  // namespace
}  // namespace hires::cli::reading_display_test
