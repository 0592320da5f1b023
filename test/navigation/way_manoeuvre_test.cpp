#include "navigation/way_manoeuvre.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "navigation/closed_loop.h"
#include "support/rounds.h"

namespace hires::navigation::way_manoeuvre_test {
namespace {

using Eigen::Vector2d;
using geometry::Pose2;
using hires::test_support::Rounds;
using test_support::EmptyScene;
using test_support::IdealBase;
using test_support::Scene;

/// 6 m x 6 m, with a wall from y 2.9 to 3.1 and a door of 0.9 m from x 2.55 on.
Scene WithDoor() {
  Scene scene = EmptyScene(6.0, 6.0);
  scene.Add(0.0, 2.9, 2.55, 3.1);
  scene.Add(3.45, 2.9, 6.0, 3.1);
  return scene;
}

/// Straight on through the middle of the door, and 2 m further.
std::vector<Vector2d> WayFrom(double y) {
  std::vector<Vector2d> way;
  for (; y <= 5.0; y += 0.025) way.emplace_back(3.0, y);
  return way;
}

struct DrawnBase {
  geometry::Polygon footprint;
  Pose2 X_MB;  ///< before the door, at a slant, and free
};

/// Of bases that pass the door headed along the way, and can turn before it.
DrawnBase Draw(const Costmap& costmap, base::Rng* rng) {
  const double x = 0.5 * rng->Uniform(0.4, 0.75), y = 0.5 * rng->Uniform(0.4, 0.65);
  DrawnBase drawn{test_support::Rectangle(-x, -y, x, y), {}};
  do {
    drawn.X_MB = {rng->Uniform(2.5, 3.5), rng->Uniform(2.3, 2.75),
                  0.5 * geometry::kPi + rng->Uniform(-1.5, 1.5)};
  } while (costmap.FootprintCost(drawn.footprint, drawn.X_MB) >= kLethalCost);
  return drawn;
}

std::vector<SweptFootprint> SweepsOf(const geometry::Polygon& footprint) {
  std::vector<SweptFootprint> sweeps;
  for (const double margin : {0.06, 0.02, 0.0})
    sweeps.emplace_back(geometry::Padded(footprint, margin), 0.025, 0.1);
  return sweeps;
}

/// Of bases that move sideways, and of others.
class WayManoeuvreTest : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Sideways, WayManoeuvreTest, testing::Bool());

// Each turn and each drive of what is found is free, and it ends beyond the door, headed along the
// way.
TEST_P(WayManoeuvreTest, PiecesAreFreeAndLeadThroughADoor) {
  const Costmap costmap = WithDoor().MakeCostmap();
  const base::Rng root(31);
  for (int seed = 0; seed < Rounds(80); ++seed) {
    base::Rng rng = root.Fork(seed);
    const DrawnBase drawn = Draw(costmap, &rng);
    auto sweeps = SweepsOf(drawn.footprint);
    const std::vector<Vector2d> way = WayFrom(drawn.X_MB.y);
    const auto pieces = FindPieces(costmap, drawn.X_MB, way, GetParam(), &sweeps);
    ASSERT_FALSE(pieces.empty()) << seed;
    Pose2 X_MB = drawn.X_MB;
    for (const Piece& piece : pieces) {
      const double turn = TurnBegun(piece.yaw - X_MB.yaw, piece.sign);
      EXPECT_TRUE(sweeps.back().IsFree(costmap, X_MB, {0.0, 0.0, turn}, 1.0)) << seed;
      X_MB.yaw = piece.yaw;
      const Vector2d ahead = X_MB.Inverse() * piece.p_MTo;
      const double beside = GetParam() ? ahead.cwiseAbs().minCoeff() : ahead.y();
      EXPECT_NEAR(beside, 0.0, 1e-6) << seed;
      EXPECT_TRUE(sweeps.back().IsFree(costmap, X_MB, {ahead.x(), ahead.y(), 0.0}, 1.0)) << seed;
      X_MB.x = piece.p_MTo.x();
      X_MB.y = piece.p_MTo.y();
    }
    EXPECT_GE(X_MB.y, drawn.X_MB.y + 0.9) << seed;
    EXPECT_NEAR(X_MB.x, 3.0, 0.11) << seed;
    EXPECT_LT(std::abs(X_MB.yaw - 0.5 * geometry::kPi), 0.21) << seed;
  }
}

// A base that stands before a door without a valid velocity comes through it, and touches nothing.
TEST_P(WayManoeuvreTest, WhoStandsBeforeADoorDrivesThroughIt) {
  DwaParams params;
  if (!GetParam()) params.max_lateral_velocity = 0.0;
  const Scene scene = WithDoor();
  const Costmap costmap = scene.MakeCostmap();
  const base::Rng root(32);
  for (int seed = 0; seed < Rounds(40); ++seed) {
    base::Rng rng = root.Fork(seed);
    const DrawnBase drawn = Draw(costmap, &rng);
    auto sweeps = SweepsOf(drawn.footprint);
    const std::vector<Vector2d> way = WayFrom(drawn.X_MB.y);
    WayManoeuvre manoeuvre(params);
    manoeuvre.SetMotionSet(test_support::kSlow);
    manoeuvre.SetWay(false);
    manoeuvre.Stand();
    IdealBase base;
    base.X_MB = drawn.X_MB;
    for (double time = 0.0; time < 60.0; time += 0.1) {
      const auto step = manoeuvre.Update(costmap, base.X_MB, base.V_B, way, 0, &sweeps);
      if (step.next != WayManoeuvre::Next::kDrive) break;
      for (int i = 0; i < 10; ++i) base.Step(step.velocity, 0.01);
      const auto outline = geometry::Transformed(base.X_MB, drawn.footprint);
      for (const auto& obstacle : scene.obstacles)
        EXPECT_GT(geometry::Distance(outline, obstacle), 0.0) << seed;
    }
    EXPECT_FALSE(manoeuvre.is_active()) << seed;
    EXPECT_GE(base.X_MB.y, drawn.X_MB.y + 0.8) << seed;
  }
}

// A heading between two that are told apart bars no turn.
TEST_P(WayManoeuvreTest, OnAFreeFloorItTurnsTheShorterWay) {
  const Costmap costmap = EmptyScene(6.0, 6.0).MakeCostmap();
  auto sweeps = SweepsOf(test_support::Rectangle(-0.3, -0.3, 0.3, 0.3));
  const std::vector<Vector2d> way = WayFrom(1.0);
  for (double off = -2.4; off <= 2.4; off += 0.11) {
    if (std::abs(off) < 0.3) continue;  // headed along the way as it is
    const auto pieces =
        FindPieces(costmap, {3.0, 1.0, 0.5 * geometry::kPi + off}, way, GetParam(), &sweeps);
    ASSERT_FALSE(pieces.empty()) << off;
    double yaw = 0.5 * geometry::kPi + off;
    for (const Piece& piece : pieces) {
      const double turn = TurnBegun(piece.yaw - yaw, piece.sign);
      EXPECT_LE(turn * off, 0.0) << off;
      yaw = piece.yaw;
    }
  }
}

struct AskedManoeuvre {
  explicit AskedManoeuvre(bool moves_sideways) : manoeuvre(Params(moves_sideways)) {
    manoeuvre.SetMotionSet(test_support::kSlow);
    manoeuvre.SetWay(false);
  }
  static DwaParams Params(bool moves_sideways) {
    DwaParams params;
    if (!moves_sideways) params.max_lateral_velocity = 0.0;
    return params;
  }
  /// Of a base that stands without a valid velocity.
  WayManoeuvre::Next Ask(const Costmap& costmap, const Pose2& X_MB) {
    manoeuvre.Stand();
    return manoeuvre.Update(costmap, X_MB, {}, WayFrom(X_MB.y), 0, &sweeps).next;
  }

  WayManoeuvre manoeuvre;
  std::vector<SweptFootprint> sweeps = SweepsOf(test_support::Rectangle(-0.3, -0.3, 0.3, 0.3));
};

// What stood in the door for a minute has gone: it drives, and did not look all the time.
TEST_P(WayManoeuvreTest, WhatBlocksTheWayForATimeUsesNoTryUp) {
  Scene closed = WithDoor();
  closed.Add(2.5, 2.8, 3.5, 3.2);
  const Costmap with_person = closed.MakeCostmap(), without = WithDoor().MakeCostmap();
  AskedManoeuvre asked(GetParam());
  const Pose2 X_MB{3.0, 2.3, 0.5 * geometry::kPi + 0.7};
  for (int cycle = 0; cycle < 600; ++cycle)
    ASSERT_EQ(asked.Ask(with_person, X_MB), WayManoeuvre::Next::kNothing);
  int waits = 0;
  while (asked.Ask(without, X_MB) == WayManoeuvre::Next::kNothing && waits < 1000) ++waits;
  EXPECT_LT(waits, 700);
  EXPECT_TRUE(asked.manoeuvre.is_active());
}

TEST_P(WayManoeuvreTest, ABaseThatIsFoundElsewhereDrivesNoOldPiece) {
  const Costmap costmap = WithDoor().MakeCostmap();
  AskedManoeuvre asked(GetParam());
  const Pose2 X_MB{3.0, 2.3, 0.5 * geometry::kPi + 0.7};
  ASSERT_EQ(asked.Ask(costmap, X_MB), WayManoeuvre::Next::kDrive);
  asked.manoeuvre.SetWay(true);
  EXPECT_TRUE(asked.manoeuvre.is_active());
  const Pose2 X_MFound{1.5, 1.0, 0.0};
  asked.manoeuvre.Update(costmap, X_MFound, {}, WayFrom(1.0), 0, &asked.sweeps);
  EXPECT_FALSE(asked.manoeuvre.is_active());
}

TEST_P(WayManoeuvreTest, NothingIsDoneWhileABaseComesFurther) {
  const Costmap costmap = EmptyScene(6.0, 6.0).MakeCostmap();
  auto sweeps = SweepsOf(test_support::Rectangle(-0.3, -0.3, 0.3, 0.3));
  const std::vector<Vector2d> way = WayFrom(1.0);
  DwaParams params;
  if (!GetParam()) params.max_lateral_velocity = 0.0;
  WayManoeuvre manoeuvre(params);
  manoeuvre.SetMotionSet(test_support::kSlow);
  for (std::size_t i = 0; i + 40 < way.size(); ++i) {
    const Pose2 X_MB{way[i].x(), way[i].y(), 0.5 * geometry::kPi};
    const auto step = manoeuvre.Update(costmap, X_MB, {0.25, 0.0, 0.0}, way, i, &sweeps);
    ASSERT_EQ(step.next, WayManoeuvre::Next::kNothing);
  }
}

}  // namespace
}  // namespace hires::navigation::way_manoeuvre_test
