#include "lab/src/series/overlaps.h"

#include <gmock/gmock.h>

namespace hires::lab::overlaps_test {
namespace {

using geometry::Collision;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

std::vector<Collision> Box(double x, double y, double z) {
  return {{"box", geometry::Box{{x, y, z}}, geometry::Lift({}, z / 2.0)}};
}

/// A wall along x = 5, a table of 1 m and, beside it, a chair that touches it.
world::World Hall(const geometry::Pose2& table, const geometry::Pose2& chair) {
  world::World world;
  world.statics = {{"walls", geometry::Lift({5.0, 0.0, 0.0}, 0.0), Box(0.2, 10.0, 2.5)},
                   {"table1", geometry::Lift(table, 0.0), Box(1.0, 1.0, 0.75)},
                   {"chair1", geometry::Lift(chair, 0.0), Box(0.4, 0.4, 0.5)}};
  return world;
}

class NewOverlapsTest : public ::testing::Test {
 protected:
  std::vector<std::pair<std::string, std::string>> Found(const world::World& varied,
                                                         const geometry::Pose2& robot) const {
    std::vector<std::pair<std::string, std::string>> found;
    for (const Overlap& overlap :
         NewOverlaps({original_, X_MB_}, {varied, robot}, "pr2", Box(0.6, 0.6, 1.3))) {
      found.emplace_back(overlap.thing, overlap.other);
    }
    return found;
  }

  const geometry::Pose2 table_{0.0, 0.0, 0.0}, chair_{0.0, 0.6, 0.0}, X_MB_{-2.0, 0.0, 0.0};
  const world::World original_ = Hall(table_, chair_);
};

TEST_F(NewOverlapsTest, WhatTouchesInTheOriginalIsNotNew) {
  EXPECT_THAT(Found(original_, X_MB_), IsEmpty());
  EXPECT_THAT(Found(Hall({1.0, 0.0, 0.0}, {1.0, 0.6, 0.0}), X_MB_), IsEmpty()) << "both go along";
}

TEST_F(NewOverlapsTest, FurnitureInAWallOrInOtherFurnitureIsNamedOnce) {
  EXPECT_THAT(Found(Hall({4.5, 0.0, 0.0}, {4.2, 0.6, 0.0}), X_MB_),
              ElementsAre(Pair("table1", "walls")));
  EXPECT_THAT(Found(Hall(table_, {4.9, 0.0, 0.0}), X_MB_), ElementsAre(Pair("chair1", "walls")));
  EXPECT_THAT(Found(Hall({4.3, 0.0, 0.7}, chair_), X_MB_), ElementsAre(Pair("table1", "walls")))
      << "a corner, by its turn";
  EXPECT_THAT(Found(Hall({4.3, 0.0, 0.0}, chair_), X_MB_), IsEmpty());
}

TEST_F(NewOverlapsTest, TheRobotIsNamedWhetherItOrTheFurnitureWasMoved) {
  EXPECT_THAT(Found(original_, {0.5, 0.0, 0.0}), ElementsAre(Pair("pr2", "table1")));
  EXPECT_THAT(Found(Hall({-1.5, 0.0, 0.0}, {-1.5, 1.0, 0.0}), X_MB_),
              ElementsAre(Pair("pr2", "table1")));
  EXPECT_THAT(Found(original_, {5.0, 3.0, 0.0}), ElementsAre(Pair("pr2", "walls")));
}

}  // namespace
}  // namespace hires::lab::overlaps_test
