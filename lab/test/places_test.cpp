#include "lab/src/experiment/places.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

namespace hires::lab::places_test {
namespace {

/// A moment at which the robot takes itself to be so far [m] from where it is.
PlaceMoment Moment(double off, bool is_lost = false) {
  PlaceMoment moment;
  moment.X_MBelieved.x = off;
  moment.is_lost = is_lost;
  return moment;
}

std::map<std::string, double> MeasuresOf(const std::vector<PlaceTrail>& drives) {
  LostTally tally;
  for (const PlaceTrail& drive : drives) tally.Add(drive);
  std::map<std::string, double> measures;
  for (const Measure& measure : tally.Measures()) measures[measure.name] = measure.value;
  return measures;
}

TEST(LostTallyTest, TellsWhatBecameOfDrivesThatWentAstray) {
  const PlaceTrail right{Moment(0.02), Moment(0.1), Moment(0.4, true), Moment(0.02)};
  const PlaceTrail found{Moment(3.0), Moment(3.0, true), Moment(0.1, true), Moment(0.1)};
  const PlaceTrail deceived{Moment(0.1), Moment(2.0), Moment(2.0), Moment(2.0)};
  const PlaceTrail still_lost{Moment(2.0), Moment(2.0, true), Moment(2.0, true), Moment(0.1, true)};
  const auto measures = MeasuresOf({right, found, deceived, still_lost, {}});
  EXPECT_EQ(measures.at("astray"), 3.0);
  EXPECT_EQ(measures.at("noticed"), 2.0);
  EXPECT_EQ(measures.at("found"), 1.0);
  EXPECT_EQ(measures.at("deceived"), 1.0);
  EXPECT_EQ(measures.at("lost_share"), 6.0 / 16.0);
  EXPECT_EQ(measures.at("wrong_and_sure_share"), 5.0 / 16.0);
}

TEST(LostTallyTest, TheTableTellsHowLongItTook) {
  LostTally tally;
  PlaceTrail drive(40, Moment(3.0));  // 2 s at 20 Hz
  drive.push_back(Moment(0.1));
  tally.Add(drive);
  EXPECT_THAT(tally.Table().rows.at(1), testing::Contains("2.0 / 2.0 s"));
}

}  // namespace
}  // namespace hires::lab::places_test
