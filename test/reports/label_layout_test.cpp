#include "reports/film/label_layout.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hires/base/rng.h"
#include "reports/film/picture_text.h"
#include "support/rounds.h"

namespace hires::reports::label_layout_test {
namespace {

TEST(PlaceLabelsTest, OneStandsRightOfItsPoint) {
  EXPECT_EQ(PlaceLabels({{100, 50, 60}}, 400, 300), (std::vector<LabelPlace>{{108, 50}}));
}

TEST(PlaceLabelsTest, AtTheRightBorderItStandsLeft) {
  EXPECT_EQ(PlaceLabels({{380, 50, 60}}, 400, 300), (std::vector<LabelPlace>{{312, 50}}));
}

TEST(PlaceLabelsTest, OfTwoAtOnePlaceTheSecondStandsOnTheOtherSide) {
  EXPECT_EQ(PlaceLabels({{100, 50, 60}, {100, 50, 60}}, 400, 300),
            (std::vector<LabelPlace>{{108, 50}, {32, 50}}));
}

TEST(PlaceLabelsTest, NoneLiesOnAnotherOrBeyondThePictureWhereThereIsRoom) {
  for (int round = 0; round < test_support::Rounds(400); ++round) {
    base::Rng rng(static_cast<std::uint64_t>(round) + 1);
    // Close together, but no more than the lines above and below can hold.
    const int x = 200 + rng.Index(600), y = 250 + rng.Index(300);
    std::vector<Labelled> points;
    for (int i = 0; i < 2 + rng.Index(7); ++i)
      points.push_back({x + rng.Index(30), y + rng.Index(30), 30 + rng.Index(120)});
    const std::vector<LabelPlace> labels = PlaceLabels(points, 1000, 800);
    ASSERT_EQ(labels.size(), points.size());
    for (std::size_t i = 0; i < labels.size(); ++i) {
      EXPECT_GE(labels[i].column, 0);
      EXPECT_GE(labels[i].row, 0);
      EXPECT_LE(labels[i].column + points[i].width, 1000);
      EXPECT_LE(labels[i].row + kTextHeight, 800);
      for (std::size_t k = 0; k < i; ++k) {
        const bool is_beside = labels[i].column + points[i].width <= labels[k].column ||
                               labels[k].column + points[k].width <= labels[i].column;
        EXPECT_TRUE(is_beside || std::abs(labels[i].row - labels[k].row) >= kTextHeight)
            << "round " << round << ": labels " << k << " and " << i;
      }
    }
  }
}

}  // namespace
}  // namespace hires::reports::label_layout_test
