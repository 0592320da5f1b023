#include "skills/free_spot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scenes.h"

namespace hires::skills::free_spot_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Models mill (radius 0.037), and a book of 0.11 x 0.045.
const world::World& Shelf() {
  static const world::World shelf = [] {
    world::World made = hires::test_support::Room();
    world::ObjectModel book = hires::test_support::Mill("book");
    book.collisions = {hires::test_support::Shape("body", geometry::Box{{0.11, 0.045, 0.175}},
                                                  {0.0, 0.0, 0.0875})};
    hires::test_support::AddModel(&made, book);
    return made;
  }();
  return shelf;
}

const geometry::Pose3& X_MA() {
  static const geometry::Pose3 pose{{3.0, 2.0, 0.73}, Eigen::Quaterniond::Identity()};
  return pose;
}

world::ObjectState Stands(const std::string& name, const std::string& model, double x, double y,
                          double z = 0.0, double yaw = 0.0) {
  world::ObjectState object;
  object.name = name;
  object.model = model;
  object.X_MO = X_MA() * geometry::Pose3{{x, y, z}, geometry::RotationFromRpy(0.0, 0.0, yaw)};
  return object;
}

PlacingArea SquareOf(const PlaceParams& params) {
  return {X_MA(), world::Inset(world::World().ExtentOf(""), params.area_edge)};
}

FreeSpots Spots(const std::vector<world::ObjectState>& others, const PlaceParams& params = {}) {
  return FindFreeSpots(params, Shelf(), *Shelf().models.at("mill"), SquareOf(params), others);
}

TEST(RadiusOfTest, ARoundObjectHasItsOwnRadius) {
  EXPECT_NEAR(RadiusOf(*Shelf().models.at("mill")), 0.037, 1e-6);
}

TEST(RadiusOfTest, AnOutlineTurnsWithItsObject) {
  const geometry::Polygon outline =
      OutlineOf(*Shelf().models.at("book"),
                {{1.0, 0.0, 0.0}, geometry::RotationFromRpy(0.0, 0.0, 1.5707963)});
  double lowest = 1e9, highest = -1e9;
  for (const Eigen::Vector2d& corner : outline) {
    lowest = std::min(lowest, corner.y());
    highest = std::max(highest, corner.y());
  }
  EXPECT_NEAR(highest - lowest, 0.11, 1e-6);
}

FreeSpots At(const std::string& spot, const std::vector<world::ObjectState>& others) {
  return FindStatedSpot({}, Shelf(), *Shelf().models.at("mill"), SquareOf({}), others,
                        *ParseSpot(spot));
}

TEST(StatedSpotTest, LiesAsFarOutAsTheObjectMayGo) {
  const double room = 0.14 - 0.037;
  const FreeSpots corner = At("Back_Left", {});
  ASSERT_EQ(corner.spots_A.size(), 1u);
  EXPECT_LT((corner.spots_A[0] - Eigen::Vector3d(-room, room, 0.0)).norm(), 1e-6);
  ASSERT_EQ(At("middle", {}).spots_A.size(), 1u);
  EXPECT_LT(At("middle", {}).spots_A[0].norm(), 1e-12);
}

TEST(StatedSpotTest, IsOccupiedByTheOneThatStandsThereAndNoOtherSpotIsTakenInstead) {
  const std::vector<world::ObjectState> others{Stands("mill1", "mill", 0.10, 0.0)};
  EXPECT_THAT(At("front", others).spots_A, IsEmpty());
  EXPECT_THAT(At("front", others).occupants, ElementsAre("mill1"));
  EXPECT_EQ(At("back", others).spots_A.size(), 1u);
}

TEST(StatedSpotTest, EverySpotButTheFreeChoiceHasAPlaceOfItsOwn) {
  EXPECT_FALSE(ParseSpot("ANY"));
  const std::vector<std::string> names = SpotNames();
  ASSERT_EQ(names.size(), 9u);
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(*ParseSpot(names[i]), *ParseSpot(names[j]));
  }
}

TEST(FreeSpotsTest, AnEmptyAreaOffersItsMiddleFirst) {
  const FreeSpots free = Spots({});
  EXPECT_THAT(free.occupants, IsEmpty());
  ASSERT_FALSE(free.spots_A.empty());
  EXPECT_LT(free.spots_A.front().norm(), 1e-12);
}

TEST(FreeSpotsTest, TheObjectLiesWhollyWithinTheSquare) {
  const PlaceParams params;
  for (const Eigen::Vector3d& p_A : Spots({}).spots_A) {
    EXPECT_LE(p_A.head<2>().cwiseAbs().maxCoeff() + 0.037, 0.14 + 1e-9);
  }
}

// As long as the counter's: the far end is used when the middle is full, and is one of the spots.
TEST(FreeSpotsTest, ALongAreaGoesOnWhereASquareEnds) {
  const PlacingArea area{X_MA(), {Eigen::Vector2d(-0.14, -0.44), Eigen::Vector2d(0.14, 0.14)}};
  const world::ObjectModel& mill = *Shelf().models.at("mill");
  const std::vector<world::ObjectState> others{Stands("book1", "book", 0.0, 0.06),
                                               Stands("book2", "book", 0.0, -0.06)};
  const FreeSpots free = FindFreeSpots({}, Shelf(), mill, area, others);
  ASSERT_FALSE(free.spots_A.empty());
  for (const Eigen::Vector3d& p_A : free.spots_A) {
    EXPECT_LT(p_A.y(), -0.06);
    EXPECT_TRUE(world::Inset(area.extent_A, 0.037 - 1e-9).contains(p_A.head<2>().eval()));
  }
  const FreeSpots right = FindStatedSpot({}, Shelf(), mill, area, others, *ParseSpot("right"));
  ASSERT_EQ(right.spots_A.size(), 1u);
  EXPECT_NEAR(right.spots_A[0].y(), -0.44 + 0.037, 1e-6);
}

TEST(FreeSpotsTest, SpotsKeepClearOfEveryNeighbourAndComeNearestFirst) {
  const PlaceParams params;
  const std::vector<world::ObjectState> others{Stands("mill1", "mill", 0.0, 0.0),
                                               Stands("book1", "book", -0.12, 0.1, 0.0, 0.7)};
  const FreeSpots free = Spots(others);
  ASSERT_FALSE(free.spots_A.empty());
  double before = 0.0;
  for (const Eigen::Vector3d& p_A : free.spots_A) {
    EXPECT_GE(p_A.norm(), 2 * 0.037 + params.clearance - 1e-9);
    EXPECT_GE(p_A.norm(), before - 1e-6);
    before = p_A.norm();
  }
  EXPECT_THAT(free.occupants, ElementsAre("book1", "mill1"));
}

TEST(FreeSpotsTest, TwoBooksFillAnArea) {
  const FreeSpots free =
      Spots({Stands("book2", "book", 0.0, 0.06), Stands("book1", "book", 0.0, -0.06)});
  EXPECT_THAT(free.spots_A, IsEmpty());
  EXPECT_THAT(free.occupants, ElementsAre("book1", "book2"));
}

TEST(FreeSpotsTest, WhatStandsOnAnotherLevelOrFarAwayIsNoNeighbour) {
  const FreeSpots free =
      Spots({Stands("book1", "book", 0.0, 0.0, -0.5), Stands("book2", "book", 1.0, 0.0)});
  EXPECT_LT(free.spots_A.front().norm(), 1e-12);
  EXPECT_THAT(free.occupants, IsEmpty());
}

TEST(FreeSpotsTest, AnObjectAsWideAsTheAreaHasItsMiddleOnly) {
  PlaceParams params;
  params.area_edge = 0.145;
  EXPECT_EQ(Spots({}, params).spots_A.size(), 1u);
}

TEST(FreeSlotsTest, TheTrayHasItsMiddleThenRightThenLeft) {
  const auto slots = [](const std::vector<world::ObjectState>& others) {
    return FindFreeSlots(PlaceParams{}, Shelf(), *Shelf().models.at("mill"), X_MA(), others);
  };
  EXPECT_THAT(slots({}).spots_A,
              ElementsAre(Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.0, -0.13, 0.0),
                          Eigen::Vector3d(0.0, 0.13, 0.0)));
  const FreeSpots two = slots({Stands("mill1", "mill", 0.01, 0.0)});
  EXPECT_EQ(two.spots_A.size(), 2u);
  EXPECT_THAT(two.occupants, ElementsAre("mill1"));
  // What the tray's laser sees there and nobody knows takes up its place, too.
  const FreeSpots one = slots({Stands("mill1", "mill", 0.01, 0.0),
                               Stands("unknown1", "unknown_0.085x0.085x0.150", 0.0, -0.12)});
  EXPECT_THAT(one.spots_A, ElementsAre(Eigen::Vector3d(0.0, 0.13, 0.0)));
  EXPECT_THAT(one.occupants, ElementsAre("mill1", "unknown1"));
}

}  // namespace
}  // namespace hires::skills::free_spot_test
