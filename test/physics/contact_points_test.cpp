#include "physics/contact_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "hires/geometry/pose.h"

namespace hires::physics::contact_points_test {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.037, kHalf = 0.137;

PlacedCylinder Standing(double x, double y, double foot) {
  return {{x, y, foot + kHalf}, Vector3d::UnitZ(), kRadius, kHalf};
}

PlacedBox Plate(double size_x, double size_y) {  // its upper face is z = 0
  return {{0.0, 0.0, -0.005}, Eigen::Matrix3d::Identity(), {size_x / 2, size_y / 2, 0.005}};
}

double LargestAlong(const ContactList& contacts, const Vector3d& direction) {
  double largest = -1e300;
  for (const ContactPoint& point : contacts) {
    largest = std::max(largest, point.position.dot(direction));
  }
  return largest;
}

TEST(ContactPointsTest, StandingCylinderTouchesTheFloorAllAroundItsRim) {
  ContactList contacts;
  AddCylinderOnFace(Standing(1.0, 2.0, -0.0005), FloorFace(), Vector3d::Zero(), &contacts);
  ASSERT_EQ(contacts.size(), 4);
  Vector3d sum = Vector3d::Zero();
  for (const ContactPoint& point : contacts) {
    EXPECT_NEAR((point.position - Vector3d(1.0, 2.0, -0.0005)).norm(), kRadius, 1e-12);
    EXPECT_NEAR(point.depth, 0.0005, 1e-12);
    EXPECT_EQ(point.normal, Vector3d::UnitZ());
    sum += point.position / 4;
  }
  EXPECT_NEAR((sum - Vector3d(1.0, 2.0, -0.0005)).norm(), 0.0, 1e-12);
}

TEST(ContactPointsTest, RimHasAPointInTheDirectionOfTheLean) {
  for (int i = 0; i < 36; ++i) {
    const double heading = 2.0 * geometry::kPi * i / 36;
    const Vector3d lean(0.1 * std::cos(heading), 0.1 * std::sin(heading), 0.0);
    ContactList contacts;
    AddCylinderOnFace(Standing(0.0, 0.0, -1e-5), FloorFace(), lean, &contacts);
    EXPECT_NEAR(LargestAlong(contacts, lean.normalized()), kRadius, 1e-9) << "heading " << heading;
  }
}

TEST(ContactPointsTest, TiltedCylinderHasLowestPointAndLeanPoint) {
  const Eigen::AngleAxisd tilt(1e-4, Vector3d::UnitY());  // towards +x
  const PlacedCylinder cylinder{{0.0, 0.0, kHalf - 1e-3}, tilt * Vector3d::UnitZ(), kRadius, kHalf};
  const Vector3d lean = Vector3d(1.0, 1.0, 0.0).normalized();
  ContactList contacts;
  AddCylinderOnFace(cylinder, FloorFace(), lean, &contacts);
  ASSERT_EQ(contacts.size(), 5);
  EXPECT_NEAR(contacts[0].depth, 1e-3 + kRadius * std::sin(1e-4), 1e-8);
  EXPECT_NEAR(LargestAlong(contacts, lean), kRadius, 2e-5);
}

TEST(ContactPointsTest, CylinderOnItsEdgeTouchesAtOnePoint) {
  const Eigen::AngleAxisd tilt(0.3, Vector3d::UnitY());
  const double height = kHalf * std::cos(0.3) + kRadius * std::sin(0.3);
  ContactList contacts;
  AddCylinderOnFace({{0.0, 0.0, height - 1e-4}, tilt * Vector3d::UnitZ(), kRadius, kHalf},
                    FloorFace(), Vector3d::Zero(), &contacts);
  ASSERT_EQ(contacts.size(), 1);
  EXPECT_NEAR(contacts[0].depth, 1e-4, 1e-12);
  EXPECT_NEAR(contacts[0].position.x(), kRadius * std::cos(0.3) - kHalf * std::sin(0.3), 1e-12);
}

TEST(ContactPointsTest, LyingCylinderTouchesWithBothRims) {
  ContactList contacts;
  AddCylinderOnFace({{0.0, 0.0, kRadius - 1e-4}, Vector3d::UnitX(), kRadius, kHalf}, FloorFace(),
                    Vector3d::Zero(), &contacts);
  ASSERT_EQ(contacts.size(), 2);
  EXPECT_NEAR(LargestAlong(contacts, Vector3d::UnitX()), kHalf, 1e-12);
  EXPECT_NEAR(LargestAlong(contacts, -Vector3d::UnitX()), kHalf, 1e-12);
}

TEST(ContactPointsTest, TopDownCylinderStandsOnItsUpperRim) {
  PlacedCylinder cylinder = Standing(0.0, 0.0, -1e-4);
  cylinder.axis = -cylinder.axis;
  ContactList contacts;
  AddCylinderOnFace(cylinder, FloorFace(), Vector3d::Zero(), &contacts);
  ASSERT_EQ(contacts.size(), 4);
  EXPECT_NEAR(contacts[0].position.z(), -1e-4, 1e-12);
}

TEST(ContactPointsTest, CylinderAboveTheFaceTouchesNothing) {
  ContactList contacts;
  AddCylinderOnFace(Standing(0.0, 0.0, 1e-6), FloorFace(), Vector3d::UnitX(), &contacts);
  EXPECT_TRUE(contacts.empty());
  EXPECT_EQ(
      AddCylinderOnBox(Standing(0.0, 0.0, 1e-6), Plate(0.3, 0.3), Vector3d::Zero(), &contacts),
      QuickLook::kApart);
}

TEST(ContactPointsTest, CylinderOverTheBorderIsCarriedWhereTheBorderCutsItsRim) {
  ContactList contacts;
  ASSERT_EQ(
      AddCylinderOnBox(Standing(0.14, 0.0, -1e-4), Plate(0.3, 0.3), Vector3d::Zero(), &contacts),
      QuickLook::kOnFace);
  EXPECT_NEAR(LargestAlong(contacts, Vector3d::UnitX()), 0.15, 1e-12);
  const double half_chord = std::sqrt(kRadius * kRadius - 0.01 * 0.01);
  EXPECT_NEAR(LargestAlong(contacts, Vector3d::UnitY()), kRadius, 1e-12);
  int at_border = 0;
  for (const ContactPoint& point : contacts) {
    if (std::abs(std::abs(point.position.y()) - half_chord) < 1e-9) ++at_border;
  }
  EXPECT_EQ(at_border, 2);
}

TEST(ContactPointsTest, CylinderOnAThinPostIsCarriedByThePostsCorners) {
  ContactList contacts;
  ASSERT_EQ(
      AddCylinderOnBox(Standing(0.0, 0.0, -1e-4), Plate(0.02, 0.03), Vector3d::Zero(), &contacts),
      QuickLook::kOnFace);
  ASSERT_EQ(contacts.size(), 4);
  EXPECT_NEAR(LargestAlong(contacts, Vector3d::UnitX()), 0.01, 1e-12);
  EXPECT_NEAR(LargestAlong(contacts, Vector3d::UnitY()), 0.015, 1e-12);
}

TEST(ContactPointsTest, LyingCylinderOverTheBorderIsCarriedAtTheBorder) {
  ContactList contacts;
  ASSERT_EQ(AddCylinderOnBox({{0.1, 0.0, kRadius - 1e-4}, Vector3d::UnitX(), kRadius, kHalf},
                             Plate(0.3, 0.3), Vector3d::Zero(), &contacts),
            QuickLook::kOnFace);
  EXPECT_NEAR(LargestAlong(contacts, Vector3d::UnitX()), 0.15, 1e-12);
  EXPECT_NEAR(LargestAlong(contacts, -Vector3d::UnitX()), kHalf - 0.1, 1e-12);
}

TEST(ContactPointsTest, UprightCylinderTouchesAWallAlongItsSide) {
  const PlacedBox wall{{0.5, 0.0, 0.1}, Eigen::Matrix3d::Identity(), {0.1, 1.0, 0.5}};
  ContactList contacts;
  ASSERT_EQ(AddCylinderOnBox(Standing(0.4 - kRadius + 1e-4, 0.0, 0.01), wall, Vector3d::Zero(),
                             &contacts),
            QuickLook::kOnFace);
  ASSERT_EQ(contacts.size(), 2);
  for (const ContactPoint& point : contacts) {
    EXPECT_NEAR((point.normal + Vector3d::UnitX()).norm(), 0.0, 1e-12);
    EXPECT_NEAR(point.depth, 1e-4, 1e-9);
  }
}

TEST(ContactPointsTest, CylinderStandsOnACylindersEnd) {
  const PlacedCylinder stool{{0.0, 0.0, -0.05}, Vector3d::UnitZ(), 0.1, 0.05};
  ContactList contacts;
  ASSERT_EQ(AddCylinderOnCylinder(Standing(0.02, 0.0, -1e-4), stool, Vector3d::Zero(), &contacts),
            QuickLook::kOnFace);
  ASSERT_EQ(contacts.size(), 4);
  EXPECT_NEAR(contacts[0].normal.z(), 1.0, 1e-12);
  contacts.Clear();
  ASSERT_EQ(AddCylinderOnCylinder(stool, Standing(0.02, 0.0, -1e-4), Vector3d::Zero(), &contacts),
            QuickLook::kOnFace);
  ASSERT_EQ(contacts.size(), 4);
  EXPECT_NEAR(contacts[0].normal.z(), -1.0, 1e-12);
}

TEST(ContactPointsTest, CylinderOverTheBorderOfACylinderIsCarriedWhereTheRimsCross) {
  const PlacedCylinder stool{{0.0, 0.0, -0.05}, Vector3d::UnitZ(), 0.1, 0.05};
  ContactList contacts;
  ASSERT_EQ(AddCylinderOnCylinder(Standing(0.09, 0.0, -1e-4), stool, Vector3d::Zero(), &contacts),
            QuickLook::kOnFace);
  int crossings = 0;
  for (const ContactPoint& point : contacts) {
    const double from_stool = point.position.head<2>().norm();
    EXPECT_LE(from_stool, 0.1 + 1e-9);
    if (std::abs(from_stool - 0.1) < 1e-9) ++crossings;
  }
  EXPECT_EQ(crossings, 2);
}

TEST(ContactListTest, ReduceKeepsTheDeepestAndTheOutermost) {
  ContactList contacts;
  for (int i = 0; i < 25; ++i) {
    contacts.Add({0.01 * (i % 5), 0.01 * (i / 5), 0.0}, Vector3d::UnitZ(), i == 12 ? 2e-3 : 1e-3);
  }
  contacts.Reduce();
  ASSERT_EQ(contacts.size(), ContactList::kAtMost);
  EXPECT_EQ(contacts[0].depth, 2e-3);
  int corners = 0;
  for (const ContactPoint& point : contacts) {
    const bool at_x = point.position.x() == 0.0 || point.position.x() == 0.04;
    const bool at_y = point.position.y() == 0.0 || point.position.y() == 0.04;
    if (at_x && at_y) ++corners;
  }
  EXPECT_EQ(corners, 4);
}

/// Deepest that any of the cylinder's surface points lies inside the box, sampled [m].
double SampledDepth(const PlacedCylinder& cylinder, const PlacedBox& box) {
  const Vector3d u = cylinder.axis.unitOrthogonal(), v = cylinder.axis.cross(u);
  double deepest = -1.0;
  for (int i = 0; i < 48; ++i) {
    const double angle = 2.0 * geometry::kPi * i / 48;
    for (int k = -20; k <= 20; ++k) {
      const Vector3d p = cylinder.centre +
                         cylinder.radius * (std::cos(angle) * u + std::sin(angle) * v) +
                         k / 20.0 * cylinder.half_length * cylinder.axis;
      const Vector3d q = box.R_WB.transpose() * (p - box.centre);
      deepest = std::max(deepest, (box.half_size - q.cwiseAbs()).minCoeff());
    }
  }
  return deepest;
}

TEST(ContactPointsTest, QuickLookAgreesWithSampledCylinders) {
  const base::Rng root(11);
  int num_apart = 0, num_on_face = 0;
  for (int i = 0; i < 2000; ++i) {
    base::Rng rng = root.Fork(i);
    const auto vector = [&rng](double reach) {
      return Vector3d(rng.Uniform(-reach, reach), rng.Uniform(-reach, reach),
                      rng.Uniform(-reach, reach));
    };
    const PlacedCylinder cylinder{vector(0.3), vector(1.0).normalized(), 0.04, 0.1};
    const PlacedBox box{
        Vector3d::Zero(),
        geometry::RotationFromRpy(rng.Uniform(-3, 3), rng.Uniform(-1, 1), 0.4).toRotationMatrix(),
        {0.1, 0.2, 0.05}};
    ContactList contacts;
    const QuickLook look = AddCylinderOnBox(cylinder, box, vector(0.1), &contacts);
    const double depth = SampledDepth(cylinder, box);
    if (look == QuickLook::kApart) {
      ++num_apart;
      EXPECT_LE(depth, 1e-9) << "case " << i;
    }
    if (look == QuickLook::kOnFace) ++num_on_face;
    EXPECT_EQ(look == QuickLook::kOnFace, !contacts.empty());
    for (const ContactPoint& point : contacts) {
      EXPECT_NEAR(point.normal.norm(), 1.0, 1e-9);
      EXPECT_GE(point.depth, 0.0);
      const Vector3d from_centre = point.position - cylinder.centre;
      const double along = from_centre.dot(cylinder.axis);
      EXPECT_LE(std::abs(along), cylinder.half_length + 1e-9) << "case " << i;
      EXPECT_LE((from_centre - along * cylinder.axis).norm(), cylinder.radius + 1e-9);
    }
  }
  EXPECT_GT(num_apart, 200);
  EXPECT_GT(num_on_face, 200);
}

}  // namespace
}  // namespace hires::physics::contact_points_test
