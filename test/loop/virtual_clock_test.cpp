#include "loop/virtual_clock.h"

#include <gmock/gmock.h>

namespace hires::loop::virtual_clock_test {
namespace {

using testing::ElementsAre;

TEST(VirtualClockTest, WhatIsDueIsDoneInOrderAndTimeLeapsBetween) {
  VirtualClock clock(1.0);
  std::vector<std::pair<char, double>> done;
  const auto note = [&](char name) { return [&, name] { done.push_back({name, clock.now()}); }; };
  clock.At(3.0, note('c'));
  clock.In(1.0, note('a'));
  clock.At(2.0, note('b'));  // at the same time, asked for later
  while (clock.Step()) {
  }
  EXPECT_THAT(done, ElementsAre(std::pair('a', 2.0), std::pair('b', 2.0), std::pair('c', 3.0)));
  EXPECT_EQ(clock.now(), 3.0);
}

TEST(VirtualClockTest, WhatIsAskedForOnTheWayTakesItsPlace) {
  VirtualClock clock(0.0);
  std::string done;
  clock.At(2.0, [&] { done += 'c'; });
  clock.At(1.0, [&] {
    done += 'a';
    clock.In(0.5, [&] { done += 'b'; });
  });
  while (clock.Step()) {
  }
  EXPECT_EQ(done, "abc");
}

TEST(VirtualClockTest, ThePastIsNow) {
  VirtualClock clock(5.0);
  double when = 0.0;
  clock.At(1.0, [&] { when = clock.now(); });
  EXPECT_TRUE(clock.Step());
  EXPECT_EQ(when, 5.0);
  EXPECT_FALSE(clock.Step());
}

}  // namespace
}  // namespace hires::loop::virtual_clock_test
