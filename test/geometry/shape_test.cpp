#include "hires/geometry/shape.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"

namespace hires::geometry::shape_test {
namespace {

constexpr double kAround24 =
    1.0086289605801528;  // 1 / cos(pi / 24): circle to its polygon's corner

constexpr double kTinyCorner = 1e-8;  // [m] outlines leave out corners smaller than a tenth of it

Pose3 At(double x, double y, double z, double roll = 0.0, double pitch = 0.0, double yaw = 0.0) {
  return {{x, y, z}, RotationFromRpy(roll, pitch, yaw)};
}

Pose3 RandomPose(base::Rng* rng) {
  const double x = rng->Uniform(-2.0, 2.0), y = rng->Uniform(-2.0, 2.0);
  const double z = rng->Uniform(-2.0, 2.0), roll = rng->Uniform(-kPi, kPi);
  const double pitch = rng->Uniform(-1.5, 1.5);
  return At(x, y, z, roll, pitch, rng->Uniform(-kPi, kPi));
}

/// A point of the shape's surface or inside, drawn by chance.
Eigen::Vector3d PointIn(const Shape& shape, base::Rng* rng) {
  const auto drawn = [rng] {
    const double x = rng->Uniform(-1.0, 1.0), y = rng->Uniform(-1.0, 1.0);
    return Eigen::Vector3d(x, y, rng->Uniform(-1.0, 1.0));
  };
  const Eigen::Vector3d v = drawn();
  if (const auto* box = std::get_if<Box>(&shape)) return box->size.cwiseProduct(v) / 2.0;
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius * v.normalized();
  const auto& cylinder = std::get<Cylinder>(shape);
  const Eigen::Vector2d rim = cylinder.radius * v.head<2>().normalized();
  return {rim.x(), rim.y(), cylinder.length / 2 * v.z()};
}

TriangleMesh MeshOf(const Box& box) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
    mesh.vertices.push_back(box.size.cwiseProduct(corner));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

Shape AsMesh(const Box& box) { return std::make_shared<const TriangleMesh>(MeshOf(box)); }

double Area(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2.0;
}

void ExpectBounds(const Aabb& bounds, const Eigen::Vector3d& lower, const Eigen::Vector3d& upper) {
  EXPECT_LT((bounds.lower - lower).norm(), 1e-12) << bounds.lower.transpose();
  EXPECT_LT((bounds.upper - upper).norm(), 1e-12) << bounds.upper.transpose();
}

TEST(AabbTest, IsEmptyFromBirth) {
  Aabb everything;
  everything.Include(Eigen::Vector3d(-1e9, -1e9, -1e9));
  everything.Include(Eigen::Vector3d(1e9, 1e9, 1e9));
  EXPECT_FALSE(Aabb{}.Overlaps(everything));
  EXPECT_FALSE(Aabb{}.Overlaps(Aabb{}));
}

TEST(AabbTest, GrowsByPointsAndBoxes) {
  Aabb box;
  box.Include(Eigen::Vector3d(1, 2, 3));
  ExpectBounds(box, {1, 2, 3}, {1, 2, 3});
  box.Include(Eigen::Vector3d(0, 5, 3));
  ExpectBounds(box, {0, 2, 3}, {1, 5, 3});
  Aabb other;
  other.Include(Eigen::Vector3d(-1, 3, 9));
  box.Include(other);
  ExpectBounds(box, {-1, 2, 3}, {1, 5, 9});
  box.Include(Aabb{});
  ExpectBounds(box, {-1, 2, 3}, {1, 5, 9});
}

TEST(AabbTest, OverlapNeedsAllThreeAxesAndTouchingCounts) {
  const Aabb unit{{0, 0, 0}, {1, 1, 1}};
  EXPECT_TRUE(unit.Overlaps(unit));
  EXPECT_TRUE(unit.Overlaps({{1, 1, 1}, {2, 2, 2}}));
  for (int axis = 0; axis < 3; ++axis) {
    Aabb away = unit;
    away.lower[axis] += 1.001;
    away.upper[axis] += 1.001;
    EXPECT_FALSE(unit.Overlaps(away)) << axis;
    EXPECT_FALSE(away.Overlaps(unit)) << axis;
  }
}

TEST(BoundsOfTest, UprightShapes) {
  ExpectBounds(BoundsOf(Box{{1, 2, 3}}, At(1, 1, 1)), {0.5, 0, -0.5}, {1.5, 2, 2.5});
  ExpectBounds(BoundsOf(Cylinder{0.5, 3}, At(1, 1, 1)), {0.5, 0.5, -0.5}, {1.5, 1.5, 2.5});
  ExpectBounds(BoundsOf(Sphere{0.5}, At(1, 1, 1)), {0.5, 0.5, 0.5}, {1.5, 1.5, 1.5});
  ExpectBounds(BoundsOf(AsMesh({{1, 2, 3}}), At(1, 1, 1)), {0.5, 0, -0.5}, {1.5, 2, 2.5});
}

TEST(BoundsOfTest, ALyingCylinder) {
  ExpectBounds(BoundsOf(Cylinder{0.5, 3}, At(0, 0, 0, 0, kPi / 2)), {-1.5, -0.5, -0.5},
               {1.5, 0.5, 0.5});
}

TEST(BoundsOfTest, ATurnedBoxReachesWithItsCorner) {
  const double half = std::sqrt(2.0) / 2.0;
  ExpectBounds(BoundsOf(Box{{1, 1, 1}}, At(0, 0, 0, 0, 0, kPi / 4)), {-half, -half, -0.5},
               {half, half, 0.5});
}

TEST(BoundsOfTest, HoldEveryPointAndAreReachedOnEverySide) {
  for (const Shape& shape :
       {Shape(Box{{0.3, 0.6, 1.2}}), Shape(Cylinder{0.4, 0.9}), Shape(Sphere{0.7})}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      base::Rng rng = base::Rng(1).Fork(seed);
      const Pose3 X_WS = RandomPose(&rng);
      const Aabb bounds = BoundsOf(shape, X_WS);
      Aabb reached;
      for (int i = 0; i < 5000; ++i) reached.Include(X_WS * PointIn(shape, &rng));
      EXPECT_TRUE((reached.lower.array() >= bounds.lower.array() - 1e-12).all());
      EXPECT_TRUE((reached.upper.array() <= bounds.upper.array() + 1e-12).all());
      EXPECT_LT((reached.lower - bounds.lower).maxCoeff(), 0.1) << "seed " << seed;
      EXPECT_LT((bounds.upper - reached.upper).maxCoeff(), 0.1) << "seed " << seed;
    }
  }
}

TEST(BoundsOfTest, AMeshOfABoxHasTheBoundsOfTheBox) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(2).Fork(seed);
    const Pose3 X_WS = RandomPose(&rng);
    const Box box{{0.3, 0.6, 1.2}};
    const Aabb expected = BoundsOf(box, X_WS);
    ExpectBounds(BoundsOf(AsMesh(box), X_WS), expected.lower, expected.upper);
  }
}

TEST(OutlineInBandTest, AnUprightBoxGivesItsRectangle) {
  const auto outline = OutlineInBand(Box{{1, 2, 3}}, At(5, 6, 1.5), 0.2, 0.4);
  ASSERT_TRUE(outline.has_value());
  EXPECT_EQ(outline->size(), 4u);
  EXPECT_NEAR(Area(*outline), 2.0, 1e-12);
  EXPECT_TRUE(Contains(*outline, {5.49, 6.99}));
  EXPECT_FALSE(Contains(*outline, {5.51, 6.99}));
}

TEST(OutlineInBandTest, OutsideOfTheBandThereIsNothing) {
  const Shape box = Box{{1, 1, 1}};
  EXPECT_FALSE(OutlineInBand(box, At(0, 0, 0), 0.6, 0.7).has_value());
  EXPECT_FALSE(OutlineInBand(box, At(0, 0, 0), -0.7, -0.6).has_value());
  EXPECT_FALSE(OutlineInBand(Sphere{0.5}, At(0, 0, 0), 0.5, 0.7).has_value());
  EXPECT_FALSE(OutlineInBand(AsMesh({{1, 1, 1}}), At(0, 0, 0), 0.6, 0.7).has_value());
}

TEST(OutlineInBandTest, AThinBandCutsThroughTheMiddleOfAnything) {
  for (const Shape& shape : {Shape(Box{{1, 1, 1}}), AsMesh({{1, 1, 1}})}) {
    const auto outline = OutlineInBand(shape, At(0, 0, 0), 0.1, 0.1);
    ASSERT_TRUE(outline.has_value());
    EXPECT_NEAR(Area(*outline), 1.0, 1e-12);
  }
}

TEST(OutlineInBandTest, ACylinderGivesTwentyFourCornersAroundItsCircle) {
  const auto outline = OutlineInBand(Cylinder{0.5, 1}, At(2, 3, 0), -0.1, 0.1);
  ASSERT_TRUE(outline.has_value());
  EXPECT_EQ(outline->size(), 24u);
  for (const Eigen::Vector2d& p : *outline) {
    EXPECT_NEAR((p - Eigen::Vector2d(2, 3)).norm(), 0.5 * kAround24, 1e-12);
  }
  EXPECT_NEAR(InscribedRadius(Transformed({-2, -3, 0}, *outline)), 0.5, 1e-12);
}

TEST(OutlineInBandTest, RoundingGrowsNoCorners) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(5).Fork(seed);
    const double yaw = rng.Uniform(-kPi, kPi), x = rng.Uniform(-5.0, 5.0);
    const Pose3 X_WS = At(x, rng.Uniform(-5.0, 5.0), 0.3, 0.0, 0.0, yaw);
    EXPECT_EQ(OutlineInBand(Cylinder{0.037, 0.8}, X_WS, 0.1, 0.2)->size(), 24u);
    EXPECT_EQ(OutlineInBand(Box{{0.7, 0.8, 0.9}}, X_WS, 0.1, 0.2)->size(), 4u);
    EXPECT_EQ(OutlineInBand(AsMesh({{0.7, 0.8, 0.9}}), X_WS, 0.1, 0.2)->size(), 4u);
  }
}

TEST(OutlineInBandTest, ASphereGivesTheWidestCircleWithinTheBand) {
  const auto radius = [](double z_min, double z_max) {
    return InscribedRadius(*OutlineInBand(Sphere{0.5}, At(0, 0, 1), z_min, z_max));
  };
  EXPECT_NEAR(radius(0.0, 2.0), 0.5, 1e-12);
  EXPECT_NEAR(radius(0.0, 0.6), 0.3, 1e-12);  // 0.4 below the centre: 3-4-5
  EXPECT_NEAR(radius(1.3, 2.0), 0.4, 1e-12);  // 0.3 above the centre
}

TEST(OutlineInBandTest, TurningASphereChangesNothing) {
  EXPECT_EQ(OutlineInBand(Sphere{0.5}, At(1, 2, 3, 0.7, 0.3, 0.2), 2.0, 4.0),
            OutlineInBand(Sphere{0.5}, At(1, 2, 3), 2.0, 4.0));
}

TEST(OutlineInBandTest, ATiltedBoxIsCutWhereTheBandIs) {
  // A long beam rising at 45 degrees: between z = 0 and 0.1 only its foot counts.
  const Shape beam = Box{{10.0, 0.2, 0.2}};
  const auto outline = OutlineInBand(beam, At(0, 0, 0, 0, -kPi / 4), 0.0, 0.1);
  ASSERT_TRUE(outline.has_value());
  double x_min = 1e300, x_max = -1e300;
  for (const Eigen::Vector2d& p : *outline) {
    x_min = std::min(x_min, p.x());
    x_max = std::max(x_max, p.x());
  }
  const double half_width = 0.1 * std::sqrt(2.0);  // of the beam along x at one height
  EXPECT_NEAR(x_min, -half_width, 1e-12);
  EXPECT_NEAR(x_max, 0.1 + half_width, 1e-12);
}

TEST(OutlineInBandTest, HoldsEveryPointOfTheShapeThatLiesInTheBand) {
  int checked = 0;
  for (const Shape& shape :
       {Shape(Box{{0.3, 0.6, 1.2}}), Shape(Cylinder{0.4, 0.9}), Shape(Sphere{0.7})}) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      base::Rng rng = base::Rng(3).Fork(seed);
      const Pose3 X_WS = RandomPose(&rng);
      const double z_min = X_WS.translation.z() - 0.2, z_max = z_min + 0.3;
      const auto outline = OutlineInBand(shape, X_WS, z_min, z_max);
      ASSERT_TRUE(outline.has_value());
      for (int i = 0; i < 100; ++i) {
        const Eigen::Vector3d p = X_WS * PointIn(shape, &rng);
        if (p.z() < z_min || p.z() > z_max) continue;
        const Eigen::Vector2d q = p.head<2>();
        EXPECT_TRUE(Contains(*outline, q) || Distance(*outline, {q, q, q}) < kTinyCorner)
            << "seed " << seed;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 5000);
}

TEST(OutlineInBandTest, AMeshOfABoxHasTheOutlineOfTheBox) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(4).Fork(seed);
    const Pose3 X_WS = RandomPose(&rng);
    const Box box{{0.3, 0.6, 1.2}};
    const double z_min = X_WS.translation.z() - 0.2, z_max = z_min + 0.3;
    const auto expected = OutlineInBand(box, X_WS, z_min, z_max);
    const auto outline = OutlineInBand(AsMesh(box), X_WS, z_min, z_max);
    ASSERT_TRUE(expected.has_value() && outline.has_value());
    EXPECT_NEAR(Area(*outline), Area(*expected), 1e-8) << "seed " << seed;
    for (const Eigen::Vector2d& q : *expected) {
      EXPECT_TRUE(Contains(*outline, q) || Distance(*outline, {q, q, q}) < kTinyCorner);
    }
  }
}

TEST(OutlineInBandTest, WhatIsFlatAndUprightHasNoArea) {
  TriangleMesh wall;
  wall.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
  wall.triangles = {{0, 1, 2}};
  EXPECT_FALSE(OutlineInBand(std::make_shared<const TriangleMesh>(wall), {}, 0.0, 1.0).has_value());
}

TEST(OutlineInBandTest, ABandUpsideDownIsTheCallersFault) {
  EXPECT_THROW(OutlineInBand(Sphere{0.5}, {}, 0.2, 0.1), std::logic_error);
}

TEST(AreAlikeTest, ShapesSizesAndPlacesDecideWithinHalfAMillimetre) {
  const auto body = [](const Shape& shape, double z = 0.0) {
    Collision one;
    one.shape = shape;
    one.X_BS.translation.z() = z;
    return std::vector<Collision>{one};
  };
  const auto can = body(Cylinder{0.035, 0.3}, 0.15);
  EXPECT_TRUE(AreAlike(can, body(Cylinder{0.0354, 0.2996}, 0.1504)));
  EXPECT_FALSE(AreAlike(can, body(Cylinder{0.036, 0.3}, 0.15)));
  EXPECT_FALSE(AreAlike(can, body(Cylinder{0.035, 0.3}, 0.151)));
  EXPECT_FALSE(AreAlike(can, body(Box{{0.07, 0.07, 0.3}}, 0.15)));
  EXPECT_FALSE(AreAlike(can, {}));
  auto twice = can;
  twice.push_back(can.front());
  EXPECT_FALSE(AreAlike(can, twice));
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const auto one = std::make_shared<const TriangleMesh>(mesh);
  mesh.vertices[2].y() = 1.01;
  EXPECT_TRUE(AreAlike(body(one), body(std::make_shared<const TriangleMesh>(*one))));
  EXPECT_FALSE(AreAlike(body(one), body(std::make_shared<const TriangleMesh>(mesh))));
}

TEST(CollisionTest, GripsAndDoesNotBounceFromBirth) {
  const Collision collision;
  EXPECT_EQ(collision.friction, 1.0);
  EXPECT_EQ(collision.restitution, 0.0);
}

}  // namespace
}  // namespace hires::geometry::shape_test
