#include "hires/geometry/polygon.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"

namespace hires::geometry::polygon_test {
namespace {

using ::testing::UnorderedElementsAre;

using Points = std::vector<Eigen::Vector2d>;

const Polygon kUnitSquare{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}};

double SignedArea(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2.0;
}

Points RandomPoints(base::Rng* rng, int count) {
  Points points;
  for (int i = 0; i < count; ++i) {
    const double x = rng->Uniform(-1.0, 1.0), y = rng->Uniform(-1.0, 1.0);
    points.emplace_back(x, y);
  }
  return points;
}

Pose2 RandomPose(base::Rng* rng) {
  const double x = rng->Uniform(-2.0, 2.0), y = rng->Uniform(-2.0, 2.0);
  return {x, y, rng->Uniform(-kPi, kPi)};
}

/// Points on the outline, close together.
Points Sampled(const Polygon& polygon, int per_edge) {
  Points samples;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    for (int k = 0; k < per_edge; ++k) samples.push_back(a + (b - a) * k / double(per_edge));
  }
  return samples;
}

TEST(ConvexHullTest, LeavesOutWhatLiesInsideOrOnAnEdge) {
  const Polygon hull =
      ConvexHull({{0.0, 0.0}, {1.0, 1.0}, {0.5, 0.5}, {1.0, 0.0}, {0.5, 0.0}, {0.0, 1.0}});
  EXPECT_THAT(hull, UnorderedElementsAre(Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 0),
                                         Eigen::Vector2d(1, 1), Eigen::Vector2d(0, 1)));
  EXPECT_DOUBLE_EQ(SignedArea(hull), 1.0);  // positive: counter-clockwise
}

TEST(ConvexHullTest, RepeatedPointsCountOnce) {
  Points points;
  for (int i = 0; i < 3; ++i) points.insert(points.end(), kUnitSquare.begin(), kUnitSquare.end());
  EXPECT_EQ(ConvexHull(points).size(), 4u);
}

TEST(ConvexHullTest, PointsThatSpanNoAreaAreTheCallersFault) {
  EXPECT_THROW(ConvexHull({}), std::logic_error);
  EXPECT_THROW(ConvexHull({{0.0, 0.0}, {1.0, 0.0}}), std::logic_error);
  EXPECT_THROW(ConvexHull({{1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}}), std::logic_error);
  EXPECT_THROW(ConvexHull({{0.0, 0.0}, {1.0, 2.0}, {2.0, 4.0}, {3.0, 6.0}}), std::logic_error);
}

TEST(ConvexHullTest, IsConvexHoldsEveryPointAndHasNoPointOfItsOwn) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(1).Fork(seed);
    const Points points = RandomPoints(&rng, 3 + rng.Index(30));
    const Polygon hull = ConvexHull(points);
    for (std::size_t i = 0; i < hull.size(); ++i) {
      EXPECT_GT(SignedArea({hull[i], hull[(i + 1) % hull.size()], hull[(i + 2) % hull.size()]}),
                0.0);
      EXPECT_NE(std::find(points.begin(), points.end(), hull[i]), points.end());
    }
    for (const Eigen::Vector2d& p : points) {
      EXPECT_TRUE(Contains(hull, p) || Distance(hull, {p, p, p}) < 1e-12) << "seed " << seed;
    }
  }
}

TEST(ConvexHullTest, DoesNotDependOnTheOrderOfThePoints) {
  base::Rng rng(4);
  Points points = RandomPoints(&rng, 20);
  const Polygon hull = ConvexHull(points);
  std::reverse(points.begin(), points.end());
  EXPECT_EQ(ConvexHull(points), hull);
}

TEST(TransformedTest, TurnsThenMoves) {
  const Polygon moved = Transformed({2.0, 3.0, kPi / 2}, {{1.0, 0.0}, {0.0, 1.0}, {0.0, 0.0}});
  EXPECT_TRUE(moved[0].isApprox(Eigen::Vector2d(2.0, 4.0), 1e-15));
  EXPECT_TRUE(moved[1].isApprox(Eigen::Vector2d(1.0, 3.0), 1e-15));
  EXPECT_TRUE(moved[2].isApprox(Eigen::Vector2d(2.0, 3.0), 1e-15));
}

TEST(PaddedTest, MovesCornersAwayFromTheOriginAlongBothAxes) {
  EXPECT_EQ(Padded({{0.3, -0.2}, {0.0, 0.4}, {-0.3, 0.0}}, 0.1),
            (Polygon{{0.3 + 0.1, -0.2 - 0.1}, {0.0, 0.4 + 0.1}, {-0.3 - 0.1, 0.0}}));
  EXPECT_EQ(Padded(kUnitSquare, 0.0), kUnitSquare);
}

TEST(ContainsTest, IncludesTheBoundary) {
  EXPECT_TRUE(Contains(kUnitSquare, {0.5, 0.5}));
  EXPECT_TRUE(Contains(kUnitSquare, {1.0, 1.0}));
  EXPECT_TRUE(Contains(kUnitSquare, {0.5, 0.0}));
  EXPECT_FALSE(Contains(kUnitSquare, {0.5, -1e-12}));
  EXPECT_FALSE(Contains(kUnitSquare, {1.0 + 1e-12, 0.5}));
  EXPECT_FALSE(Contains(kUnitSquare, {2.0, 0.0}));  // on the line of an edge, beyond it
}

TEST(DistanceTest, GoldenValues) {
  const auto square_at = [](double x, double y) { return Transformed({x, y, 0.0}, kUnitSquare); };
  EXPECT_DOUBLE_EQ(Distance(kUnitSquare, square_at(3.0, 0.0)), 2.0);          // edge to edge
  EXPECT_DOUBLE_EQ(Distance(kUnitSquare, square_at(4.0, 5.0)), 5.0);          // corner to corner
  EXPECT_EQ(Distance(kUnitSquare, square_at(1.0, 0.25)), 0.0);                // touching
  EXPECT_EQ(Distance(kUnitSquare, square_at(0.5, 0.5)), 0.0);                 // overlapping
  EXPECT_EQ(Distance(kUnitSquare, kUnitSquare), 0.0);                         // the same
  EXPECT_EQ(Distance(kUnitSquare, {{0.4, 0.4}, {0.6, 0.4}, {0.5, 0.6}}), 0);  // within
  const Polygon diamond{{2.0, 0.5}, {2.5, 0.0}, {3.0, 0.5}, {2.5, 1.0}};
  EXPECT_DOUBLE_EQ(Distance(kUnitSquare, diamond), 1.0);  // corner to edge
}

TEST(DistanceTest, CrossingBarsOverlapAlthoughNoCornerLiesWithin) {
  const Polygon wide{{-2.0, -0.1}, {2.0, -0.1}, {2.0, 0.1}, {-2.0, 0.1}};
  EXPECT_EQ(Distance(wide, Transformed({0.0, 0.0, kPi / 2}, wide)), 0.0);
}

TEST(PartingShiftTest, GoldenValues) {
  const auto square_at = [](double x, double y) { return Transformed({x, y, 0.0}, kUnitSquare); };
  EXPECT_EQ(PartingShift(kUnitSquare, square_at(3.0, 0.0)), Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(PartingShift(kUnitSquare, square_at(1.0, 0.5)), Eigen::Vector2d(0.0, 0.0))
      << "touching";
  EXPECT_LT((PartingShift(kUnitSquare, square_at(0.75, 0.5)) - Eigen::Vector2d(-0.25, 0.0)).norm(),
            1e-12);
  EXPECT_LT(
      (PartingShift(kUnitSquare, square_at(0.25, -0.875)) - Eigen::Vector2d(0.0, 0.125)).norm(),
      1e-12);
  const Polygon diamond{{0.9, 0.5}, {1.9, -0.5}, {2.9, 0.5}, {1.9, 1.5}};
  EXPECT_LT((PartingShift(kUnitSquare, diamond) - Eigen::Vector2d(-0.1, 0.0)).norm(), 1e-12);
}

TEST(PartingShiftTest, PartsAndNoShorterShiftInSixtyDirectionsDoes) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    base::Rng rng = base::Rng(3).Fork(seed);
    const auto polygon = [&rng] {
      std::vector<Eigen::Vector2d> points;
      for (int i = 0; i < 6; ++i) points.emplace_back(rng.Uniform(-1, 1), rng.Uniform(-1, 1));
      return ConvexHull(points);
    };
    const Polygon a = polygon(), b = polygon();
    const Eigen::Vector2d shift = PartingShift(a, b);
    const auto moved = [&](const Eigen::Vector2d& by) {
      return Transformed({by.x(), by.y(), 0.0}, a);
    };
    if (Distance(a, b) > 0.0) {
      EXPECT_EQ(shift, Eigen::Vector2d(0.0, 0.0));
      continue;
    }
    EXPECT_GT(Distance(moved(1.0001 * shift), b), 0.0) << "seed " << seed;
    EXPECT_LT(Distance(moved(1.0001 * shift), b), 1e-3) << "seed " << seed;
    for (int i = 0; i < 60; ++i) {
      const double angle = i * kPi / 30;
      const Eigen::Vector2d shorter =
          0.999 * shift.norm() * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      EXPECT_EQ(Distance(moved(shorter), b), 0.0) << "seed " << seed;
    }
  }
}

TEST(DistanceTest, AgreesWithPointsSampledOnBothOutlines) {
  constexpr int kPerEdge = 100;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(2).Fork(seed);
    const Polygon a = ConvexHull(RandomPoints(&rng, 6));
    const Polygon b = Transformed(RandomPose(&rng), ConvexHull(RandomPoints(&rng, 6)));
    double nearest = 1e300, longest = 0.0;
    bool overlap = false;
    for (const Eigen::Vector2d& p : Sampled(a, kPerEdge)) {
      overlap = overlap || Contains(b, p);
      for (const Eigen::Vector2d& q : Sampled(b, kPerEdge))
        nearest = std::min(nearest, (p - q).norm());
    }
    for (const Eigen::Vector2d& q : b) overlap = overlap || Contains(a, q);
    for (const Polygon* polygon : {&a, &b}) {
      for (std::size_t i = 0; i < polygon->size(); ++i) {
        longest = std::max(longest, ((*polygon)[i] - (*polygon)[(i + 1) % polygon->size()]).norm());
      }
    }
    const double distance = Distance(a, b);
    if (overlap) {
      EXPECT_EQ(distance, 0.0) << "seed " << seed;
    } else {
      EXPECT_LE(distance, nearest + 1e-12) << "seed " << seed;
      EXPECT_GE(distance, nearest - longest / kPerEdge) << "seed " << seed;
    }
  }
}

TEST(DistanceTest, IsSymmetricAndStaysWhenBothMoveTogether) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(3).Fork(seed);
    const Polygon a = ConvexHull(RandomPoints(&rng, 8));
    const Polygon b = Transformed({3.0, 1.0, 0.3}, ConvexHull(RandomPoints(&rng, 8)));
    const Pose2 X_WA = RandomPose(&rng);
    EXPECT_EQ(Distance(a, b), Distance(b, a));
    EXPECT_NEAR(Distance(Transformed(X_WA, a), Transformed(X_WA, b)), Distance(a, b), 1e-12);
  }
}

TEST(RadiusTest, OfASquareAroundTheOrigin) {
  const Polygon square{{-0.334, -0.334}, {0.334, -0.334}, {0.334, 0.334}, {-0.334, 0.334}};
  EXPECT_DOUBLE_EQ(InscribedRadius(square), 0.334);
  EXPECT_DOUBLE_EQ(CircumscribedRadius(square), 0.334 * std::sqrt(2.0));
}

TEST(RadiusTest, ANoseReachesFartherButLeavesTheInscribedCircle) {
  const Polygon nosed{{-0.3, -0.3}, {0.3, -0.3}, {0.46, 0.0}, {0.3, 0.3}, {-0.3, 0.3}};
  EXPECT_DOUBLE_EQ(InscribedRadius(nosed), 0.3);
  EXPECT_DOUBLE_EQ(CircumscribedRadius(nosed), 0.46);
}

TEST(RadiusTest, TurningChangesNeitherRadius) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(4).Fork(seed);
    const Polygon polygon = ConvexHull(RandomPoints(&rng, 10));
    const Polygon turned = Transformed({0.0, 0.0, rng.Uniform(-kPi, kPi)}, polygon);
    EXPECT_NEAR(InscribedRadius(turned), InscribedRadius(polygon), 1e-12);
    EXPECT_NEAR(CircumscribedRadius(turned), CircumscribedRadius(polygon), 1e-12);
  }
}

}  // namespace
}  // namespace hires::geometry::polygon_test
