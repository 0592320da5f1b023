#include "geometry/rolling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "support/box_mesh.h"

namespace hires::geometry::rolling_test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kRadius = 0.11, kLength = 0.4;

Collision At(Shape shape, const Vector3d& p_BS, double roll = 0.0) {
  Collision part;
  part.shape = std::move(shape);
  part.X_BS = {p_BS, RotationFromRpy(roll, 0.0, 0.0)};
  return part;
}

Rolling Of(const std::vector<Collision>& shapes, const Quaterniond& R_WB,
           const Vector3d& p_BBcm = Vector3d::Zero()) {
  return RollingOf(shapes, p_BBcm, R_WB);
}

Quaterniond Turned(double roll, double pitch = 0.0, double yaw = 0.0) {
  return RotationFromRpy(roll, pitch, yaw);
}

/// A solid of revolution about z as a mesh: `radius_at` [m] over heights from -1 to 1 [half].
Shape Lathed(int sides, int rings, double half, const std::function<double(double)>& radius_at) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (int ring = 0; ring <= rings; ++ring) {
    const double z = -std::cos(kPi * ring / rings);
    for (int i = 0; i < sides; ++i) {
      const double angle = 2.0 * kPi * i / sides;
      mesh->vertices.emplace_back(radius_at(z) * std::cos(angle), radius_at(z) * std::sin(angle),
                                  half * z);
    }
  }
  return std::shared_ptr<const TriangleMesh>(mesh);
}

Shape MeshBall(int sides) {
  return Lathed(sides, sides / 2, kRadius,
                [](double z) { return kRadius * std::sqrt(std::max(0.0, 1.0 - z * z)); });
}

Shape MeshPipe(int sides) {
  return Lathed(sides, 4, kLength / 2, [](double) { return kRadius; });
}

TEST(RollingOfTest, ABallRollsAllWaysHoweverItIsTurned) {
  base::Rng rng(1);
  for (int i = 0; i < 50; ++i) {
    const double roll = rng.Uniform(-kPi, kPi), pitch = rng.Uniform(-1.5, 1.5);
    const Quaterniond R_WB = Turned(roll, pitch, rng.Uniform(-kPi, kPi));
    EXPECT_EQ(Of({At(Sphere{kRadius}, {0.1, 0.2, 0.3})}, R_WB, {0.1, 0.2, 0.3}), Rolling::kAllWays);
    EXPECT_EQ(Of({At(MeshBall(128), Vector3d::Zero())}, R_WB), Rolling::kAllWays);
  }
}

TEST(RollingOfTest, ACylinderRollsOnItsSideAlone) {
  const std::vector<Collision> pipe{At(Cylinder{kRadius, kLength}, Vector3d::Zero())};
  const std::vector<Collision> mesh_pipe{At(MeshPipe(96), Vector3d::Zero())};
  for (const double yaw : {0.0, 0.3, 1.0, 2.2}) {
    const Quaterniond lying = Turned(0.0, kPi / 2, yaw), standing = Turned(0.0, 0.0, yaw);
    EXPECT_EQ(Of(pipe, lying), Rolling::kAlongALine);
    EXPECT_EQ(Of(pipe, standing), Rolling::kNot);
    EXPECT_EQ(Of(pipe, Turned(0.0, 1.0, yaw)), Rolling::kNot) << "it leans";
    EXPECT_EQ(Of(mesh_pipe, lying), Rolling::kAlongALine);
    EXPECT_EQ(Of(mesh_pipe, standing), Rolling::kNot);
  }
  EXPECT_EQ(Of({At(Cylinder{kRadius, kLength}, Vector3d::Zero(), kPi / 2)}, Turned(0.0)),
            Rolling::kAlongALine)
      << "it lies in its model";
  EXPECT_EQ(Of({At(Cylinder{kRadius, 0.02}, Vector3d::Zero())}, Turned(kPi / 2)),
            Rolling::kAlongALine)
      << "a wheel";
}

TEST(RollingOfTest, WhatIsMadeOfRoundShapesRollsAsItsHull) {
  const double half = kLength / 2;
  const std::vector<Collision> capsule{At(Cylinder{kRadius, kLength}, Vector3d::Zero()),
                                       At(Sphere{kRadius}, {0.0, 0.0, half}),
                                       At(Sphere{kRadius}, {0.0, 0.0, -half})};
  EXPECT_EQ(Of(capsule, Turned(kPi / 2)), Rolling::kAlongALine);
  EXPECT_EQ(Of(capsule, Turned(0.0)), Rolling::kNot) << "it tips";
  const std::vector<Collision> dumbbell{At(Sphere{kRadius}, {0.0, 0.0, half}),
                                        At(Sphere{kRadius}, {0.0, 0.0, -half}),
                                        At(Box{{0.02, 0.02, kLength}}, Vector3d::Zero())};
  for (const double yaw : {0.0, 0.2, 0.7})
    EXPECT_EQ(Of(dumbbell, Turned(kPi / 2, 0.0, yaw)), Rolling::kAlongALine);
  EXPECT_EQ(Of(dumbbell, Turned(kPi / 2 + 0.1)), Rolling::kNot) << "one end is in the air";
  const std::vector<Collision> shell{At(Sphere{kRadius}, Vector3d::Zero()),
                                     At(Box{{0.1, 0.1, 0.1}}, Vector3d::Zero())};
  EXPECT_EQ(Of(shell, Turned(0.4)), Rolling::kAllWays) << "the box is inside";
}

TEST(RollingOfTest, WhatStandsOnAFaceOrWouldTipDoesNot) {
  const auto cube = test_support::BoxMesh({0.1, 0.1, 0.1});
  EXPECT_EQ(Of({}, Turned(0.0)), Rolling::kNot);
  EXPECT_EQ(Of({At(Box{{0.1, 0.1, 0.1}}, Vector3d::Zero())}, Turned(0.0)), Rolling::kNot);
  EXPECT_EQ(Of({At(Box{{0.1, 0.1, 0.1}}, Vector3d::Zero())}, Turned(kPi / 4)), Rolling::kNot);
  EXPECT_EQ(Of({At(cube, Vector3d::Zero())}, Turned(0.0)), Rolling::kNot);
  EXPECT_EQ(Of({At(Box{{0.02, 0.2, 0.25}}, Vector3d::Zero())}, Turned(0.0)), Rolling::kNot)
      << "a book";
  EXPECT_EQ(Of({At(MeshPipe(6), Vector3d::Zero())}, Turned(kPi / 2)), Rolling::kNot) << "a pencil";
  for (double radius = 0.001; radius < 0.5; radius *= 1.02) {
    EXPECT_EQ(Of({At(Cylinder{radius, 0.5}, Vector3d::Zero())}, Turned(0.0)), Rolling::kNot);
    EXPECT_EQ(Of({At(Box{{0.5, 2.0 * radius, 0.5}}, Vector3d::Zero())}, Turned(0.0)), Rolling::kNot)
        << "it stands on a foot of " << radius << " m";
  }
  EXPECT_EQ(Of({At(Sphere{kRadius}, Vector3d::Zero())}, Turned(0.0), {0.0, 0.0, -0.06}),
            Rolling::kNot)
      << "it stands up again by itself";
  EXPECT_EQ(Of({At(Sphere{kRadius}, Vector3d::Zero())}, Turned(0.0), {0.03, 0.0, 0.0}),
            Rolling::kNot)
      << "it does not lie still";
}

}  // namespace
}  // namespace hires::geometry::rolling_test
