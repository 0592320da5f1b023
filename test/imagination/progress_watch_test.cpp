#include "imagination/rollout/progress_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "hires/geometry/angles.h"
#include "support/property.h"

namespace hires::imagination::progress_watch_test {
namespace {

using geometry::Pose2;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr hires::test_support::PropertyCases kPropertyCases{200};
constexpr double kPeriod = 0.1;  // [s] of a control cycle

double Draw(double lower, double upper) {
  return lower + (upper - lower) * *rc::gen::inRange(0, 1001) / 1000.0;
}

/// What drives to a goal where it then does something else.
struct Drive {
  Pose2 X_MGoal;
  double arrival;   // [s]
  double duration;  // [s]
};

/// A straight drive, and then `at_goal`, a pose in the frame of the goal by the time there.
ProgressWatch Watched(const Drive& drive, const std::function<Pose2(double)>& at_goal) {
  ProgressWatch watch;
  skills::DriveView view;
  view.path = std::make_shared<const std::vector<Pose2>>(std::vector<Pose2>{drive.X_MGoal});
  const Pose2 X_GArrival = at_goal(0.0);
  for (int i = 0; i * kPeriod <= drive.duration; ++i) {
    const double left = drive.arrival - i * kPeriod;
    Pose2 X_GB = left <= 0.0 ? at_goal(-left) : X_GArrival;
    if (left > 0.0) X_GB.x -= 0.5 * left;
    watch.Note(i * kPeriod, drive.X_MGoal * X_GB, view);
  }
  return watch;
}

Drive DrawDrive() {
  return {{Draw(-9.0, 9.0), Draw(-9.0, 9.0), Draw(-3.0, 3.0)}, Draw(5.0, 60.0), 300.0};
}

// What lies less than 1 m before the place where nothing comes on belongs to it: 2 s at 0.5 m/s.
void ExpectSince(const Stall& stall, const Drive& drive) {
  RC_ASSERT(stall.since <= drive.arrival + 1.0);
  RC_ASSERT(stall.since >= drive.arrival - 3.0);
}

HIRES_PROPERTY(ProgressWatchTest, CirclesAreToldFromWhenOn, ()) {
  const Drive drive = DrawDrive();
  const double radius = Draw(0.1, 0.33), rate = Draw(0.3, 2.0);
  const double side = *rc::gen::arbitrary<bool>() ? 1.0 : -1.0;
  const auto stall = Watched(drive, [&](double time) {
                       const double angle = side * rate * time;
                       return Pose2{radius * std::cos(angle), radius * std::sin(angle),
                                    geometry::WrapToPi(angle + side * M_PI / 2.0)};
                     }).StallAtEnd();
  RC_ASSERT(stall.has_value());
  RC_ASSERT(stall->kind == Stall::Kind::kCircles);
  RC_ASSERT(std::abs(*stall->to_goal - radius) < 1e-6);
  ExpectSince(*stall, drive);
}

HIRES_PROPERTY(ProgressWatchTest, SwingingIsNoCircle, ()) {
  const Drive drive = DrawDrive();
  const double swing = Draw(0.1, 1.0), rate = Draw(0.2, 2.0);
  const auto stall = Watched(drive, [&](double time) {
                       return Pose2{0.2, 0.0, swing * std::sin(rate * time)};
                     }).StallAtEnd();
  RC_ASSERT(stall.has_value());
  RC_ASSERT(stall->kind == Stall::Kind::kSwings);
  ExpectSince(*stall, drive);
}

HIRES_PROPERTY(ProgressWatchTest, WhatStandsOrTurnsIsToldApart, ()) {
  const Drive drive = DrawDrive();
  const auto stands = Watched(drive, [](double) { return Pose2{0.3, 0.0, 0.0}; }).StallAtEnd();
  RC_ASSERT(stands.has_value());
  RC_ASSERT(stands->kind == Stall::Kind::kStands);
  const double rate = Draw(0.1, 2.0);
  const auto turns = Watched(drive, [&](double time) {
                       return Pose2{0.1, 0.0, geometry::WrapToPi(rate * time)};
                     }).StallAtEnd();
  RC_ASSERT(turns.has_value());
  RC_ASSERT(turns->kind == Stall::Kind::kTurns);
}

HIRES_PROPERTY(ProgressWatchTest, WhatComesOnIsNoStall, ()) {
  Drive drive = DrawDrive();
  drive.arrival = 1000.0;
  RC_ASSERT(!Watched(drive, [](double) { return Pose2{}; }).StallAtEnd().has_value());
}

/// A drive to (10, 0) that goes to and fro over so many metres, or comes on.
ProgressWatch Driven(double to_and_fro) {
  const auto path =
      std::make_shared<const std::vector<Pose2>>(std::vector<Pose2>{{0, 0, 0}, {10, 0, 0}});
  skills::DriveView view;
  view.path = path;
  ProgressWatch watch;
  for (double time = 0.0; time < 300.0; time += 0.1) {
    const double x = to_and_fro > 0.0 ? to_and_fro * (1.0 - std::cos(0.5 * time)) : 0.02 * time;
    watch.Note(time, {x, 0.0, 0.0}, view);
  }
  return watch;
}

TEST(ComesOnTest, WhoGoesToAndFroOverMetresDoesNotAndWhoIsSlowDoes) {
  EXPECT_FALSE(Driven(1.5).ComesOn());
  EXPECT_FALSE(Driven(1.5).StallAtEnd()) << "its place is not small";
  EXPECT_TRUE(Driven(0.0).ComesOn());
  EXPECT_TRUE(ProgressWatch().ComesOn());
}

TEST(StallTextTest, SaysSinceWhenWhereAndWhatMayHelp) {
  const Stall stall{Stall::Kind::kCircles, 12.04, {3.0, 1.0, 0.0}, 0.31, 0.2, -1.2};
  EXPECT_THAT(StallText(stall, {}, ""),
              AllOf(HasSubstr("since 12.0 s it drives in circles 0.31 m from its goal"),
                    HasSubstr("x 3.00 m, y 1.00 m"), HasSubstr("xy_goal_tolerance (0.2 m)")));
  EXPECT_THAT(StallText(stall, {}, "the goal is 0.12 m from 's'"),
              HasSubstr("what may help: another goal, for the goal is 0.12 m from 's'"));
  const Stall far{Stall::Kind::kStands, 12.04, {3.0, 1.0, 0.0}, 4.0, 0.0, 0.0};
  EXPECT_THAT(StallText(far, {}, "the goal is 0.12 m from 's'"),
              ::testing::Not(HasSubstr("another goal")));
  EXPECT_THAT(UnderWayText(300.0, 7.0, true), AllOf(HasSubstr("7.0 m away"), HasSubstr("300 s")));
  EXPECT_THAT(UnderWayText(300.0, 7.0, false),
              AllOf(HasSubstr("7.0 m away"), HasSubstr("more time does not help")));
}

}  // namespace
}  // namespace hires::imagination::progress_watch_test
