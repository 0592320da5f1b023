#include "hires/world/standing.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "hires/base/error.h"

namespace hires::world::standing_test {
namespace {

using base::ParamReader;
using geometry::Pose3;
using ::testing::AllOf;
using ::testing::HasSubstr;

Pose3 At(double x, double z, double tilt = 0.0) {
  Pose3 X = geometry::Lift({x, 0.0, 0.0}, z);
  X.rotation = geometry::RotationFromRpy(tilt, 0.0, 0.0);
  return X;
}

Pose3 Leaning(double tilt) { return At(0.0, 1.0, tilt); }

// ------------------------------------------------------------------------------------ one look

TEST(IsAwayTest, LowerOrBesideByMoreThanTheCriterionAllows) {
  const StandingCriterion criterion{0.5, 0.0, 0.05, 0.10};
  EXPECT_FALSE(IsAway(criterion, {0.0, 0.05, 0.10}));
  EXPECT_TRUE(IsAway(criterion, {0.0, 0.0501, 0.0}));
  EXPECT_TRUE(IsAway(criterion, {0.0, 0.0, 0.1001}));
  EXPECT_FALSE(IsAway(criterion, {3.0, 0.0, 0.0})) << "how it leans does not matter";
  EXPECT_FALSE(IsAway(criterion, {0.0, -3.0, 0.0})) << "lifted";
}

TEST(DepartureFromTest, IsWorkedOutInTheFrameOfTheCarrier) {
  Pose3 now = At(1.03, 0.7, 0.25);
  now.translation.y() = 0.04;
  const Departure departure = DepartureFrom(At(1.0, 0.75), now);
  EXPECT_NEAR(departure.tilt, 0.25, 1e-12);
  EXPECT_NEAR(departure.drop, 0.05, 1e-12);
  EXPECT_NEAR(departure.slide, 0.05, 1e-12);  // 3, 4, 5
}

TEST(IsUprightTest, LeaningTooFarOrNowhereIsNotUpright) {
  const StandingCriterion criterion{0.4, 9.0, 0.05, 0.10};
  EXPECT_TRUE(IsUpright(criterion, Leaning(0.399)));
  EXPECT_FALSE(IsUpright(criterion, Leaning(0.401)));
  EXPECT_FALSE(IsUpright(criterion, At(std::nan(""), 0.0)));
}

// ------------------------------------------------------------------------------------ detector

TEST(StepsPerLookTest, LooksAre5MillisecondsApartAndAtLeastAStep) {
  EXPECT_EQ(StepsPerLook(0.001), 5);
  EXPECT_EQ(StepsPerLook(0.0005), 10);
  EXPECT_EQ(StepsPerLook(0.005), 1);
  EXPECT_EQ(StepsPerLook(1.0), 1);
  EXPECT_THROW(StepsPerLook(0.0), std::logic_error);
}

TEST(FallDetectorTest, EachLimitIsWhereTheCriterionHasIt) {
  const auto fall = [](double x, double z, double tilt) {
    FallDetector detector{{0.5, 0.0, 0.05, 0.10}};
    detector.Update(At(0.0, 1.0), false, 0.0);
    return detector.Update(At(x, z, tilt), false, 0.1);
  };
  EXPECT_EQ(fall(0.0999, 0.9501, 0.4999), Fall::kNone);
  EXPECT_EQ(fall(0.0, 1.0, 0.5001), Fall::kToppled);
  EXPECT_EQ(fall(0.0, 0.9499, 0.0), Fall::kDropped);
  EXPECT_EQ(fall(0.1001, 1.0, 0.0), Fall::kSlid);
  EXPECT_EQ(fall(1.0, 0.0, 1.0), Fall::kToppled) << "the first way to fall counts";
  EXPECT_EQ(fall(1.0, 0.0, 0.0), Fall::kDropped);
  EXPECT_EQ(fall(0.0, 4.0, 0.0), Fall::kNone) << "lifted";
}

TEST(FallDetectorTest, BeforeTheFirstLookNothingStandsAndNothingFell) {
  const FallDetector detector{{}};
  EXPECT_FALSE(detector.stands());
  EXPECT_FALSE(detector.is_down());
  EXPECT_EQ(detector.falls(), 0);
}

TEST(FallDetectorTest, AFallIsToldOnce) {
  FallDetector detector{{}};
  EXPECT_EQ(detector.Update(Leaning(0.0), false, 0.0), Fall::kNone);
  EXPECT_TRUE(detector.stands());
  EXPECT_EQ(detector.Update(Leaning(0.6), false, 0.1), Fall::kToppled);
  EXPECT_EQ(detector.Update(Leaning(1.5), false, 0.2), Fall::kNone);
  EXPECT_EQ(detector.Update(At(3.0, 0.0, 1.5), false, 0.3), Fall::kNone) << "it rolled off";
  EXPECT_TRUE(detector.is_down());
  EXPECT_FALSE(detector.stands());
  EXPECT_EQ(detector.falls(), 1);
}

TEST(FallDetectorTest, WhatLiesWhenItIsFirstSeenDoesNotStand) {
  FallDetector detector{{}};
  EXPECT_EQ(detector.Update(Leaning(1.5), false, 0.0), Fall::kToppled);
  EXPECT_FALSE(detector.stands());
}

TEST(FallDetectorTest, LeaningMustLastForTheHoldTime) {
  FallDetector detector{{0.4, 0.2, 0.05, 0.10}};
  for (int i = 0; i <= 2; ++i) detector.Update(Leaning(0.45), false, 0.05 * i);
  EXPECT_FALSE(detector.stands()) << "it is on its way";
  EXPECT_EQ(detector.Update(Leaning(0.39), false, 0.15), Fall::kNone) << "it rocked back";
  EXPECT_TRUE(detector.stands());
  for (int i = 0; i <= 3; ++i) {
    EXPECT_EQ(detector.Update(Leaning(0.45), false, 0.2 + 0.05 * i), Fall::kNone) << i;
  }
  EXPECT_EQ(detector.Update(Leaning(0.45), false, 0.4), Fall::kToppled) << "0.2 s, sums rounded";
}

TEST(FallDetectorTest, DroppingAndSlidingNeedNoHoldTime) {
  const StandingCriterion criterion{0.4, 5.0, 0.05, 0.10};
  FallDetector dropping{criterion}, sliding{criterion};
  dropping.Update(At(0.0, 1.0), false, 0.0);
  EXPECT_EQ(dropping.Update(At(0.0, 0.94), false, 0.0), Fall::kDropped);
  sliding.Update(At(0.0, 1.0), false, 0.0);
  EXPECT_EQ(sliding.Update(At(0.11, 1.0), false, 0.0), Fall::kSlid);
}

TEST(FallDetectorTest, WhatSlidesOffAndFallsFellOnce) {
  FallDetector dropping{{}}, toppling{{}};
  for (FallDetector* detector : {&dropping, &toppling}) {
    detector->Update(At(0.0, 1.0), false, 0.0);
    EXPECT_EQ(detector->Update(At(0.11, 1.0), false, 0.1), Fall::kSlid);
    EXPECT_EQ(detector->Update(At(0.2, 1.0), false, 0.2), Fall::kNone) << "it slides on";
  }
  EXPECT_EQ(dropping.Update(At(0.3, 0.9), false, 0.3), Fall::kDropped);
  EXPECT_EQ(dropping.Update(At(0.3, 0.0, 1.5), false, 0.4), Fall::kNone) << "down is down";
  EXPECT_EQ(dropping.fall(), Fall::kDropped);
  EXPECT_EQ(dropping.falls(), 1);
  EXPECT_EQ(toppling.Update(At(0.2, 1.0, 0.6), false, 0.3), Fall::kToppled);
  EXPECT_EQ(toppling.Update(At(0.2, 1.0), false, 0.4), Fall::kNone);
  EXPECT_EQ(toppling.fall(), Fall::kToppled) << "upright, but not where it stood";
  EXPECT_EQ(toppling.falls(), 1);
}

TEST(FallDetectorTest, OnlyASlideIsLessThanAFall) {
  const Fall all[] = {Fall::kLost, Fall::kToppled, Fall::kDropped, Fall::kSlid};
  for (const Fall fall : all) {
    EXPECT_TRUE(IsWorse(fall, Fall::kNone));
    EXPECT_FALSE(IsWorse(Fall::kNone, fall));
    EXPECT_EQ(IsWorse(fall, Fall::kSlid), fall != Fall::kSlid);
    for (const Fall than : {Fall::kLost, Fall::kToppled, Fall::kDropped})
      EXPECT_FALSE(IsWorse(fall, than));
  }
}

TEST(FallDetectorTest, AFallInSmallStepsIsSeen) {
  FallDetector detector{{}};
  for (int i = 0; i <= 100; ++i) detector.Update(At(0.0, 1.0 - 0.01 * i), false, 0.01 * i);
  EXPECT_EQ(detector.falls(), 1) << "upright all the way down";
}

TEST(FallDetectorTest, WhatTheHandHoldsLeansAndMovesAndDoesNotFall) {
  FallDetector detector{{}};
  detector.Update(At(0.0, 1.0), false, 0.0);
  EXPECT_EQ(detector.Update(At(2.0, 0.3, 1.5), true, 0.1), Fall::kNone);
  EXPECT_FALSE(detector.is_down());
  EXPECT_FALSE(detector.stands()) << "it is held";
  EXPECT_NEAR(detector.now().tilt, 1.5, 1e-9);
  EXPECT_EQ(detector.Update(At(2.0, 0.3, 0.01), false, 0.2), Fall::kNone);
  EXPECT_TRUE(detector.stands()) << "where the hand let go";
  EXPECT_EQ(detector.Update(At(2.0, 0.24, 0.01), false, 0.3), Fall::kDropped) << "from there";
}

TEST(FallDetectorTest, WhatAHandLetsGoOfLyingFell) {
  FallDetector detector{{}};
  detector.Update(At(0.0, 1.0, 1.5), true, 0.0);
  EXPECT_EQ(detector.Update(At(0.0, 1.0, 1.5), false, 0.1), Fall::kToppled);
}

TEST(FallDetectorTest, PutUpAgainItMayFallAgain) {
  FallDetector detector{{}};
  detector.Update(Leaning(0.0), false, 0.0);
  detector.Update(Leaning(1.0), false, 0.1);
  detector.Update(Leaning(0.11), false, 0.2);
  EXPECT_TRUE(detector.is_down()) << "a fifth of 0.5 rad is 0.1 rad";
  detector.Update(Leaning(0.09), false, 0.3);
  EXPECT_TRUE(detector.stands());
  EXPECT_EQ(detector.Update(Leaning(1.0), false, 0.4), Fall::kToppled);
  EXPECT_EQ(detector.falls(), 2);
}

TEST(FallDetectorTest, UprightOnTheFloorIsNotPutUp) {
  FallDetector detector{{}};
  detector.Update(At(0.0, 1.0), false, 0.0);
  detector.Update(At(0.0, 0.0, 1.0), false, 0.1);
  detector.Update(At(0.0, 0.0), false, 0.2);
  EXPECT_TRUE(detector.is_down()) << "it is not where it stood";
  detector.Update(At(0.0, 0.5), true, 0.3);
  detector.Update(At(0.0, 0.0), false, 0.4);
  EXPECT_TRUE(detector.stands()) << "a hand put it there";
  EXPECT_EQ(detector.falls(), 1);
}

TEST(FallDetectorTest, ItIsPutUpOnceItLeansByLessThanTheUprightTilt) {
  const StandingCriterion criterion{0.4, 0.0, 0.05, 0.10};
  EXPECT_DOUBLE_EQ(criterion.upright_tilt(), 0.08);
  FallDetector detector{criterion};
  detector.Update(Leaning(0.0), false, 0.0);
  EXPECT_EQ(detector.Update(Leaning(0.41), false, 0.1), Fall::kToppled);
  detector.Update(Leaning(0.081), false, 0.2);
  EXPECT_TRUE(detector.is_down());
  detector.Update(Leaning(0.079), false, 0.3);
  EXPECT_FALSE(detector.is_down());
}

TEST(FallDetectorTest, AfterAResetItStandsWhereItIsFound) {
  FallDetector detector{{}};
  detector.Update(At(0.0, 1.0), false, 0.0);
  detector.Update(At(0.0, 0.0, 1.0), false, 0.1);
  detector.Reset();
  EXPECT_EQ(detector.Update(At(5.0, 0.0), false, 0.2), Fall::kNone);
  EXPECT_TRUE(detector.stands());
  EXPECT_EQ(detector.falls(), 1) << "what was counted stays counted";
}

TEST(FallDetectorTest, APoseThatIsNoNumberIsLost) {
  FallDetector detector{{}};
  detector.Update(At(0.0, 1.0), false, 0.0);
  EXPECT_EQ(detector.Update(At(std::nan(""), 1.0), false, 0.1), Fall::kLost);
  EXPECT_EQ(detector.Update(At(0.0, std::numeric_limits<double>::infinity()), true, 0.2),
            Fall::kNone)
      << "told once";
  EXPECT_FALSE(detector.stands());
  EXPECT_EQ(detector.falls(), 1);
}

TEST(FallDetectorTest, WhileTimeStandsStillNothingLeansLonger) {
  FallDetector detector{{0.4, 0.2, 0.05, 0.10}};
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(detector.Update(Leaning(1.5), false, 7.0), Fall::kNone);
  }
  EXPECT_EQ(detector.Update(Leaning(1.5), false, 7.2), Fall::kToppled);
  FallDetector set_back{{0.4, 0.2, 0.05, 0.10}};
  set_back.Update(Leaning(1.5), false, 7.0);
  EXPECT_EQ(set_back.Update(Leaning(1.5), false, 0.1), Fall::kNone);
  EXPECT_EQ(set_back.Update(Leaning(1.5), false, 0.3), Fall::kToppled);
}

TEST(FallDetectorTest, SlidingIsWhatTheCarrierSees) {
  FallDetector detector{{}};
  for (int i = 0; i <= 100; ++i) {  // a tray drives by, 5 m
    const Pose3 X_MC = geometry::Lift({0.05 * i, 1.0, 0.02 * i}, 0.3);
    EXPECT_EQ(detector.Update(X_MC * At(0.2, 0.0), false, 0.1 * i, X_MC), Fall::kNone) << i;
  }
  const Pose3 X_MC = geometry::Lift({5.0, 1.0, 2.0}, 0.3);
  EXPECT_EQ(detector.Update(X_MC * At(0.31, 0.0), false, 11.0, X_MC), Fall::kSlid);
}

TEST(FallDetectorTest, TiltIsAgainstTheWorldAndNotTheCarrier) {
  FallDetector detector{{}};
  const Pose3 leaning = Leaning(0.6);
  EXPECT_EQ(detector.Update(leaning, false, 0.0, leaning), Fall::kToppled);
}

// --------------------------------------------------------------------------------------- reader

std::string ErrorOf(const std::string& yaml) {
  try {
    ReadStandingCriterion(ParamReader::FromString(yaml, "scene.yaml").Sub("standing"));
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ReadStandingCriterionTest, EveryKeyIsRead) {
  const auto criterion = ReadStandingCriterion(
      ParamReader::FromString("{tilt: 0.4, hold_time: 0.2, drop: 0.06, slide: 0.07}", "test"));
  EXPECT_EQ(criterion.tilt, 0.4);
  EXPECT_EQ(criterion.hold_time, 0.2);
  EXPECT_EQ(criterion.drop, 0.06);
  EXPECT_EQ(criterion.slide, 0.07);
}

TEST(ReadStandingCriterionTest, WhatMakesNoSenseIsNamed) {
  EXPECT_THAT(ErrorOf("standing: {tilt: 0.0, hold_time: 0.0, drop: 0.05, slide: 0.1}"),
              AllOf(HasSubstr("scene.yaml"), HasSubstr("standing.tilt is '0.0'")));
  EXPECT_THAT(ErrorOf("standing: {tilt: 0.5, hold_time: -1.0, drop: 0.05, slide: 0.1}"),
              HasSubstr("standing.hold_time is '-1.0'"));
  EXPECT_THAT(ErrorOf("standing: {tilt: 0.5, hold_time: 0.0, drop: .nan, slide: 0.1}"),
              HasSubstr("standing.drop"));
  EXPECT_THAT(ErrorOf("standing: {tilt: 0.5, hold_time: 0.0, drop: 0.05}"),
              HasSubstr("standing.slide"));
  EXPECT_THAT(ErrorOf("standing: {tilt: 0.5, hold_time: 0.0, drop: 0.05, slide: 0.1, topple: 0.5}"),
              HasSubstr("standing.topple"));
}

}  // namespace
}  // namespace hires::world::standing_test
