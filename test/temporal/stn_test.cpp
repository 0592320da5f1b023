#include "hires/temporal/stn.h"

#include <gmock/gmock.h>

#include <cmath>

namespace hires::temporal::stn_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr Bounds kNone{};

void Take(Stn* network, Stn::Point from, Stn::Point to, const Bounds& bounds,
          const std::string& why = "c", Stn::ConstraintId* id = nullptr) {
  const auto conflict = network->Constrain(from, to, bounds, why, id);
  EXPECT_FALSE(conflict) << conflict->text;
}

TEST(StnTest, APointOfItsOwnMayLieAnywhere) {
  Stn network;
  const Stn::Point point = network.AddPoint("start of drive");
  EXPECT_EQ(network.num_points(), 2u);
  EXPECT_EQ(network.NameOf(point), "start of drive");
  EXPECT_EQ(network.Of(point), kNone);
  EXPECT_EQ(network.Of(Stn::kOrigin), (Bounds{0.0, 0.0}));
  EXPECT_EQ(network.Between(Stn::kOrigin, point), kNone);
  EXPECT_EQ(network.Between(point, point), (Bounds{0.0, 0.0}));
}

// John goes to work: Dechter, Meiri and Pearl 1991, their example 1.1. He leaves between 7:10 and
// 7:20 and takes 30 to 40 min, Fred arrives between 8:00 and 8:10 after 20 to 30 min, and John
// arrives 10 to 20 min after Fred left. In minutes after 7:00.
TEST(StnTest, JohnAndFredGoToWorkAsInTheBook) {
  Stn network;
  const auto john_leaves = network.AddPoint("John leaves");
  const auto john_arrives = network.AddPoint("John arrives");
  const auto fred_leaves = network.AddPoint("Fred leaves");
  const auto fred_arrives = network.AddPoint("Fred arrives");
  Take(&network, Stn::kOrigin, john_leaves, {10, 20});
  Take(&network, john_leaves, john_arrives, {30, 40});
  Take(&network, fred_leaves, john_arrives, {10, 20});
  Take(&network, fred_leaves, fred_arrives, {40, 50});
  Take(&network, Stn::kOrigin, fred_arrives, {60, 70});
  EXPECT_EQ(network.Of(john_leaves), (Bounds{10, 20}));
  EXPECT_EQ(network.Of(john_arrives), (Bounds{40, 50}));
  EXPECT_EQ(network.Of(fred_leaves), (Bounds{20, 30}));
  EXPECT_EQ(network.Of(fred_arrives), (Bounds{60, 70}));
  EXPECT_EQ(network.Between(john_leaves, fred_leaves), (Bounds{10, 20}));
}

TEST(StnTest, WhatIsRefusedChangesNothingAndSaysWhy) {
  Stn network;
  const auto start = network.AddPoint("start"), finish = network.AddPoint("finish");
  Stn::ConstraintId begun = -7, lasts = -7, refused = -7;
  Take(&network, Stn::kOrigin, start, {5, kForever}, "begun", &begun);
  Take(&network, start, finish, {12, 20}, "drive lasts", &lasts);
  const auto conflict =
      network.Constrain(Stn::kOrigin, finish, {-kForever, 10}, "deadline", &refused);
  ASSERT_TRUE(conflict);
  EXPECT_THAT(conflict->cycle, ElementsAre(Stn::Conflict::kRefused, lasts, begun));
  EXPECT_EQ(conflict->text,
            "deadline (at most 10 s); drive lasts (at least 12 s); begun (at least 5 s)");
  EXPECT_EQ(refused, -7);
  EXPECT_EQ(network.Of(finish), (Bounds{17, kForever}));
  Take(&network, Stn::kOrigin, finish, {-kForever, 17}, "deadline");
  EXPECT_EQ(network.Of(start), (Bounds{5, 5}));
}

TEST(StnTest, AConstraintCanContradictItself) {
  Stn network;
  const auto point = network.AddPoint("p");
  const auto conflict = network.Constrain(Stn::kOrigin, point, {3, 2}, "odd");
  ASSERT_TRUE(conflict);
  EXPECT_THAT(conflict->cycle, ElementsAre(-1, -1));
  EXPECT_EQ(network.Of(point), kNone);
  EXPECT_TRUE(network.Constrain(point, point, {1, 2}, "later than itself"));
  EXPECT_FALSE(network.Constrain(point, point, {-1, 2}, "not quite itself"));
}

TEST(StnTest, PointsThatNothingTiesToTheOriginConflictToo) {
  Stn network;
  const auto a = network.AddPoint("a"), b = network.AddPoint("b"), c = network.AddPoint("c");
  Take(&network, a, b, {1, kForever});
  Take(&network, b, c, {1, kForever});
  EXPECT_TRUE(network.Constrain(c, a, {-1, kForever}, "back"));
  EXPECT_FALSE(network.Constrain(c, a, {-2, kForever}, "just back"));
  EXPECT_EQ(network.Between(a, c), (Bounds{2, 2}));
}

TEST(StnTest, WhatIsRetractedGivesBackWhatItForbade) {
  Stn network;
  const auto start = network.AddPoint("start"), finish = network.AddPoint("finish");
  Stn::ConstraintId begun = -1, deadline = -1;
  Take(&network, Stn::kOrigin, start, {5, 9}, "begun", &begun);
  Take(&network, start, finish, {12, 20});
  Take(&network, Stn::kOrigin, finish, {-kForever, 18}, "deadline", &deadline);
  EXPECT_EQ(network.Of(start), (Bounds{5, 6}));
  network.Retract(deadline);
  EXPECT_EQ(network.Of(start), (Bounds{5, 9}));
  EXPECT_EQ(network.Of(finish), (Bounds{17, 29}));
  network.Retract(begun);
  EXPECT_EQ(network.Of(start), kNone);
  EXPECT_EQ(network.Of(finish), kNone);
  EXPECT_THROW(network.Retract(begun), std::logic_error);
  EXPECT_THROW(network.Retract(99), std::logic_error);
}

TEST(StnTest, TheSameConstraintTwiceHoldsUntilBothAreGone) {
  Stn network;
  const auto point = network.AddPoint("p");
  Stn::ConstraintId first = -1, second = -1;
  Take(&network, Stn::kOrigin, point, {1, 2}, "first", &first);
  Take(&network, Stn::kOrigin, point, {1, 2}, "second", &second);
  network.Retract(first);
  EXPECT_EQ(network.Of(point), (Bounds{1, 2}));
  network.Retract(second);
  EXPECT_EQ(network.Of(point), kNone);
}

// Sums of such numbers are not exact in floating point: 0.1 + 0.2 > 0.3 there.
TEST(StnTest, SumsOfTenthsAtTodaysTimesAreNoConflict) {
  Stn network;
  const double now = 1763636490.1;
  const auto a = network.AddPoint("a"), b = network.AddPoint("b"), c = network.AddPoint("c");
  Take(&network, Stn::kOrigin, a, {now, now});
  Take(&network, a, b, {0.1, 0.1});
  Take(&network, b, c, {0.2, 0.2});
  Take(&network, a, c, {0.3, 0.3});
  EXPECT_EQ(network.Of(a), (Bounds{now, now}));
  EXPECT_EQ(network.Between(a, c), (Bounds{0.3, 0.3}));
}

TEST(StnTest, BoundsThatAreNoneAreRefused) {
  Stn network;
  const auto point = network.AddPoint("p");
  const auto constrain = [&](double earliest, double latest) {
    network.Constrain(Stn::kOrigin, point, {earliest, latest}, "c");
  };
  EXPECT_THROW(constrain(std::nan(""), 1), std::logic_error);
  EXPECT_THROW(constrain(0, 2 * Stn::kLongest), std::logic_error);
  EXPECT_THROW(constrain(kForever, kForever), std::logic_error);
  EXPECT_THROW(constrain(-kForever, -kForever), std::logic_error);
  EXPECT_THROW(network.Constrain(7, point, {0, 1}, "c"), std::out_of_range);
  EXPECT_THROW(network.Between(0, -1), std::out_of_range);
  EXPECT_EQ(network.Of(point), kNone);
}

// ------------------------------------------------------------------------------------- Allen

double EndOf(const Interval& interval, bool is_start) {
  return is_start ? interval.start : interval.finish;
}

bool Keeps(const Interval& a, const Interval& b, const std::vector<EndConstraint>& ends) {
  return std::all_of(ends.begin(), ends.end(), [&](const EndConstraint& end) {
    const double distance = EndOf(b, end.to_is_start_b) - EndOf(a, end.from_is_start_a);
    return end.bounds.earliest <= distance && distance <= end.bounds.latest;
  });
}

// With a gap of at least one between whole numbers, "later" and "strictly later" are the same.
TEST(AllenBoundsTest, TheyHoldForAllPairsInTheRelationAndForNoOthers) {
  const auto is_strict = [](Allen relation) { return BoundsOf(relation, {1.0, kForever}); };
  int pairs = 0;
  for (double s = 0; s < 6; ++s) {
    for (double f = s + 1; f <= 6; ++f) {
      for (int word = 0; word < kNumAllen; ++word) {
        const Allen relation = static_cast<Allen>(word);
        const Interval a{2, 4}, b{s, f};
        EXPECT_EQ(Keeps(a, b, is_strict(relation)), Relation(a, b) == relation)
            << s << ".." << f << " " << ToString(relation);
        ++pairs;
      }
    }
  }
  EXPECT_EQ(pairs, 21 * kNumAllen);
}

TEST(AllenBoundsTest, BeforeLeavesTheGap) {
  const auto ends = BoundsOf(Allen::kBefore, {0.001, 1.0});
  ASSERT_THAT(ends, SizeIs(1));
  EXPECT_FALSE(ends[0].from_is_start_a);
  EXPECT_TRUE(ends[0].to_is_start_b);
  EXPECT_EQ(ends[0].bounds, (Bounds{0.001, 1.0}));
  EXPECT_THROW(BoundsOf(Allen::kBefore, {-1.0, 1.0}), std::logic_error);
  EXPECT_THROW(BoundsOf(Allen::kBefore, {2.0, 1.0}), std::logic_error);
}

}  // namespace
}  // namespace hires::temporal::stn_test
