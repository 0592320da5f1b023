#include "lab/src/trial/recognition_score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hires/geometry/angles.h"

namespace hires::perception::recognition_score_test {
namespace {

using Eigen::Vector3d;

/// A table without a catalogue, point by point.
class ScoredTable {
 public:
  ScoredTable(int num_things, int num_detections) {
    for (int i = 0; i < num_things; ++i) {
      TableThing thing;
      thing.model = "box" + std::to_string(i);
      thing.is_known = false;
      thing.size = {0.2, 0.1, 0.3};
      thing.middle = {0.0, 0.0, 0.15};
      table.things.push_back(thing);
    }
    seen.sighting.detections.resize(num_detections);
    for (Detection& detection : seen.sighting.detections) {
      detection.label = kUnknownLabel;
      detection.size = {0.2, 0.1, 0.3};
    }
  }

  /// Points of a thing that a detection has; -1: something else, none.
  void Put(int num, int thing, int detection, bool is_measured = true) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    for (int i = 0; i < num; ++i) {
      table.cloud.points.push_back(Eigen::Vector3f::Constant(is_measured ? 1.0F : kNone));
      table.owner.push_back(thing);
      seen.thing_of.push_back(detection);
      if (thing >= 0) ++table.things[thing].num_points;
    }
  }

  RecognitionScore Score(const FoundBy& found_by = {}) const {
    RecognitionScore score({}, 1, found_by);
    score.Add(table, seen);
    return score;
  }

  RandomTable table{};
  TabletopView seen{};
};

TEST(RecognitionScoreTest, AThingIsFoundByHalfOfItsPointsAndNotByFewer) {
  ScoredTable half(1, 1), fewer(1, 1);
  half.Put(50, 0, 0);
  half.Put(50, 0, -1);
  fewer.Put(49, 0, 0);
  fewer.Put(51, 0, -1);
  EXPECT_TRUE(half.Score().things()[0].is_found());
  EXPECT_EQ(half.Score().num_surplus(), 0);
  EXPECT_FALSE(fewer.Score().things()[0].is_found());
  EXPECT_EQ(fewer.Score().num_surplus(), 1) << "nothing is found by it";
}

TEST(RecognitionScoreTest, HalfOfADetectionsPointsMustBeOfTheThing) {
  ScoredTable half(2, 1), fewer(2, 1);
  half.Put(50, 0, 0);
  half.Put(20, 1, 0);
  half.Put(30, -1, 0);
  fewer.Put(50, 0, 0);
  fewer.Put(20, 1, 0);
  fewer.Put(31, -1, 0);
  EXPECT_TRUE(half.Score().things()[0].is_found());
  EXPECT_FALSE(fewer.Score().things()[0].is_found()) << "most of it, but not half";
  EXPECT_TRUE(fewer.Score().things()[0].is_merged);
  EXPECT_FALSE(fewer.Score().things()[1].is_found());
}

TEST(RecognitionScoreTest, HalfOfADetectionIsEnoughBesideAsManyPointsOfTheTable) {
  ScoredTable table(1, 1);
  table.Put(50, 0, 0);
  table.Put(50, -1, 0);
  EXPECT_TRUE(table.Score().things()[0].is_found());
}

TEST(RecognitionScoreTest, ARobotIsToldOfAThingByAnyDetectionThatIsMostlyOfIt) {
  ScoredTable table(1, 2);
  table.Put(3, 0, 0);
  table.Put(97, 0, -1);
  table.Put(1, 0, 1);
  table.Put(2, -1, 1);
  EXPECT_FALSE(table.Score().things()[0].is_found());
  EXPECT_TRUE(table.Score(kToldOf).things()[0].is_found());
  EXPECT_EQ(table.Score(kToldOf).num_surplus(), 1);
}

TEST(RecognitionScoreTest, WhatTheCameraDidNotMeasureIsNotAskedFor) {
  ScoredTable table(1, 1);
  table.Put(20, 0, 0);
  table.Put(10, 0, -1);
  table.Put(100, 0, -1, false);
  EXPECT_TRUE(table.Score().things()[0].is_found());
}

TEST(RecognitionScoreTest, OfTwoHalvesTheLargerFindsAndTheOtherIsSurplus) {
  ScoredTable table(1, 2);
  table.Put(50, 0, 0);
  table.Put(50, 0, 1);
  table.seen.sighting.detections[0].label = "first";
  const RecognitionScore tie = table.Score();
  EXPECT_EQ(tie.things()[0].label, "first");
  EXPECT_EQ(tie.num_surplus(), 1);
  table.Put(60, 0, 1);
  EXPECT_EQ(table.Score().things()[0].label, kUnknownLabel);
}

TEST(RecognitionScoreTest, TheBoxOfAnUnknownThingIsJudgedSideBySide) {
  ScoredTable table(1, 1);
  table.Put(10, 0, 0);
  TableThing& thing = table.table.things[0];
  thing.X_CO.translation = {0.5, 0.0, 1.0};
  thing.middle = {0.01, 0.0, 0.15};
  Detection& seen = table.seen.sighting.detections[0];
  // Its longer side along the thing's y axis: sides are told by their lengths.
  seen.size = {0.21, 0.08, 0.34};
  seen.X_CO.translation = {0.51, 0.03, 0.98};
  seen.X_CO.rotation = geometry::RotationFromRpy(0.0, 0.0, geometry::kPi / 2);
  const auto box = table.Score().things()[0].box;
  ASSERT_TRUE(box);
  // Middles are (0.51, 0, 1.15) and (0.51, 0.03, 1.15).
  EXPECT_NEAR(box->middle, 0.03, 1e-9);
  EXPECT_NEAR(box->longer, 0.01, 1e-9);
  EXPECT_NEAR(box->shorter, -0.02, 1e-9);
  EXPECT_NEAR(box->height, 0.04, 1e-9);
  seen.label = "mug";
  EXPECT_FALSE(table.Score().things()[0].box) << "of another name it is no box's";
}

TEST(RecognitionScoreTest, QuantilesOfBoxesAreOfSizesOfErrors) {
  std::vector<ThingVerdict> things(3);
  for (int i = 0; i < 3; ++i) {
    things[i].kind = things[i].called = kUnknownLabel;
    things[i].box = BoxError{0.01 * i, -0.02 * i, 0.03, -0.001};
  }
  const BoxSums boxes = SumsOf(things).boxes;
  EXPECT_EQ(boxes.num_boxes, 3);
  EXPECT_DOUBLE_EQ(boxes.middle.median, 0.01);
  EXPECT_DOUBLE_EQ(boxes.longer.share_95, 0.04);
  EXPECT_DOUBLE_EQ(boxes.shorter.median, 0.03);
  EXPECT_DOUBLE_EQ(boxes.height.share_95, 0.001);
}

TEST(RecognitionScoreTest, OfNothingThereIsNoQuantile) {
  const RecognitionSums sums = SumsOf({});
  for (const double value :
       {sums.median_error, sums.error_95, sums.median_error_B, sums.error_B_95, sums.median_turn,
        sums.boxes.middle.median, sums.boxes.height.share_95}) {
    EXPECT_TRUE(std::isnan(value)) << value;
  }
}

TEST(RecognitionScoreTest, AppendedTablesKeepApart) {
  ScoredTable table(2, 0);
  table.Put(10, 0, -1);
  table.Put(10, 1, -1);
  RecognitionScore score({}, 1);
  score.Append(table.Score());
  score.Append(ScoredTable(0, 0).Score());
  score.Append(table.Score());
  ASSERT_EQ(score.things().size(), 4u);
  EXPECT_EQ(score.things()[1].table, 0);
  EXPECT_EQ(score.things()[2].table, 2);
}

}  // namespace
}  // namespace hires::perception::recognition_score_test
