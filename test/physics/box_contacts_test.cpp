#include "physics/box_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"

namespace hires::physics::box_contacts_test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

const PlacedBox kPlate{{0.0, 0.0, -0.01}, Matrix3d::Identity(), {0.2, 0.15, 0.01}};  // up to z = 0

PlacedBox Turned(const PlacedBox& box, const Matrix3d& R, const Vector3d& by) {
  return {R * box.centre + by, R * box.R_WB, box.half_size};
}

double Lowest(const PlacedBox& box, const Vector3d& up) {
  return box.centre.dot(up) - box.half_size.dot((box.R_WB.transpose() * up).cwiseAbs());
}

/// Whether a box of the plate's kind and one on it touch in the four corners of the upper one.
void ExpectFourCorners(const PlacedBox& upper, const PlacedBox& plate, const Vector3d& up,
                       double depth) {
  ContactList contacts;
  ASSERT_TRUE(AddBoxOnBox(upper, plate, &contacts));
  ASSERT_EQ(contacts.size(), 4);
  for (const ContactPoint& point : contacts) {
    EXPECT_NEAR(point.depth, depth, 1e-9);
    EXPECT_NEAR((point.normal - up).norm(), 0.0, 1e-9);
    const Vector3d corner = upper.R_WB.transpose() * (point.position - upper.centre);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::abs(corner[i]), upper.half_size[i], 1e-9);
  }
}

TEST(BoxContactsTest, BoxOnAPlateStandsOnItsFourCorners) {
  const PlacedBox cube{{0.05, -0.02, 0.0295}, Matrix3d::Identity(), {0.03, 0.03, 0.03}};
  ExpectFourCorners(cube, kPlate, Vector3d::UnitZ(), 0.0005);
}

TEST(BoxContactsTest, RoundingDoesNotTakeContactsAway) {
  base::Rng rng(3);
  for (int i = 0; i < 2000; ++i) {
    const Matrix3d R = Eigen::Quaterniond::UnitRandom().toRotationMatrix();
    const Vector3d by(rng.Uniform(-3, 3), rng.Uniform(-3, 3), rng.Uniform(-1, 1));
    // A whole number of quarter turns, so that edges are parallel but for the last bits.
    const Matrix3d quarters =
        AngleAxisd(geometry::kPi / 2 * (i % 4), Vector3d::UnitZ()).toRotationMatrix();
    const PlacedBox cube{{0.05, -0.02, 0.0295}, quarters, {0.03, 0.03, 0.03}};
    ExpectFourCorners(Turned(cube, R, by), Turned(kPlate, R, by), R.col(2), 0.0005);
  }
}

TEST(BoxContactsTest, WhatReachesOverTheBorderIsCarriedAtTheBorder) {
  const PlacedBox book{{0.18, 0.0, 0.0099}, Matrix3d::Identity(), {0.07, 0.1, 0.01}};
  ContactList contacts;
  ASSERT_TRUE(AddBoxOnBox(book, kPlate, &contacts));
  ASSERT_EQ(contacts.size(), 4);
  double farthest = 0.0;
  for (const ContactPoint& point : contacts) farthest = std::max(farthest, point.position.x());
  EXPECT_NEAR(farthest, 0.2, 1e-12);
}

TEST(BoxContactsTest, ABoxThatIsWiderThanWhatCarriesItStandsOnThat) {
  const PlacedBox board{{0.0, 0.0, 0.0095}, Matrix3d::Identity(), {0.5, 0.5, 0.01}};
  ContactList contacts;
  ASSERT_TRUE(AddBoxOnBox(board, kPlate, &contacts));
  ASSERT_EQ(contacts.size(), 4);
  for (const ContactPoint& point : contacts) {
    EXPECT_NEAR(std::abs(point.position.x()), 0.2, 1e-12);
    EXPECT_NEAR(std::abs(point.position.y()), 0.15, 1e-12);
    EXPECT_NEAR(point.depth, 0.0005, 1e-12);
    EXPECT_NEAR(point.normal.z(), 1.0, 1e-12);
  }
}

TEST(BoxContactsTest, ATiltedBoxStandsOnItsEdgeOrCorner) {
  const PlacedBox cube{{0.0, 0.0, 0.0}, Matrix3d::Identity(), {0.03, 0.03, 0.03}};
  const auto tilted = [&](const Matrix3d& R) {
    PlacedBox box = Turned(cube, R, Vector3d::Zero());
    box.centre.z() -= Lowest(box, Vector3d::UnitZ()) + 0.0002;
    return box;
  };
  ContactList edge, corner;
  ASSERT_TRUE(
      AddBoxOnBox(tilted(AngleAxisd(0.3, Vector3d::UnitX()).toRotationMatrix()), kPlate, &edge));
  EXPECT_EQ(edge.size(), 2);
  ASSERT_TRUE(
      AddBoxOnBox(tilted((AngleAxisd(0.3, Vector3d::UnitX()) * AngleAxisd(0.2, Vector3d::UnitY()))
                             .toRotationMatrix()),
                  kPlate, &corner));
  ASSERT_EQ(corner.size(), 1);
  EXPECT_NEAR(corner[0].depth, 0.0002, 1e-12);
}

TEST(BoxContactsTest, CrossedEdgesTouchInOnePoint) {
  // Two bars, each with an edge up or down, one across the other.
  const Matrix3d on_edge = AngleAxisd(geometry::kPi / 4, Vector3d::UnitX()).toRotationMatrix();
  const Matrix3d across = AngleAxisd(geometry::kPi / 2, Vector3d::UnitZ()).toRotationMatrix();
  const Vector3d half(0.2, 0.02, 0.02);
  const double apart = 2.0 * 0.02 * std::sqrt(2.0) - 0.0003;
  const PlacedBox lower{{0.0, 0.0, 0.0}, on_edge, half},
      upper{{0.05, 0.03, apart}, across * on_edge, half};
  ContactList contacts;
  ASSERT_TRUE(AddBoxOnBox(upper, lower, &contacts));
  ASSERT_EQ(contacts.size(), 1);
  EXPECT_NEAR(contacts[0].depth, 0.0003, 1e-12);
  EXPECT_NEAR((contacts[0].normal - Vector3d::UnitZ()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((contacts[0].position - Vector3d(0.05, 0.0, apart / 2)).norm(), 0.0, 1e-12);
}

TEST(BoxContactsTest, TouchingIsMutualAndEndsWhereBoxesAreMovedApart) {
  base::Rng rng(11);
  int num_touching = 0;
  for (int i = 0; i < 5000; ++i) {
    const auto draw = [&] {
      const Eigen::Quaterniond q(rng.Normal(0, 1), rng.Normal(0, 1), rng.Normal(0, 1),
                                 rng.Normal(0, 1));
      return PlacedBox{
          {rng.Uniform(-0.15, 0.15), rng.Uniform(-0.15, 0.15), rng.Uniform(-0.15, 0.15)},
          q.normalized().toRotationMatrix(),
          {rng.Uniform(0.01, 0.15), rng.Uniform(0.01, 0.15), rng.Uniform(0.01, 0.15)}};
    };
    PlacedBox a = draw();
    const PlacedBox b = draw();
    ContactList ab, ba;
    const bool touch = AddBoxOnBox(a, b, &ab);
    ASSERT_EQ(touch, AddBoxOnBox(b, a, &ba)) << i;
    if (!touch) continue;
    ++num_touching;
    const auto deeper = [](const ContactPoint& p, const ContactPoint& q) {
      return p.depth < q.depth;
    };
    const ContactPoint deepest = *std::max_element(ab.begin(), ab.end(), deeper);
    EXPECT_GT((a.centre - b.centre).dot(deepest.normal), 0.0) << "out of B into A, case " << i;
    int num_moves = 0;  // what is deepest within a face may lie less deep than what is beside it
    for (ContactList left = ab; num_moves < 20 && !left.empty(); ++num_moves) {
      const ContactPoint out = *std::max_element(left.begin(), left.end(), deeper);
      a.centre += (out.depth + 1e-6) * out.normal;
      left.Clear();
      AddBoxOnBox(a, b, &left);
    }
    EXPECT_LT(num_moves, 20) << i;
  }
  EXPECT_GT(num_touching, 1000);
}

}  // namespace
}  // namespace hires::physics::box_contacts_test
