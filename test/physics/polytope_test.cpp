#include "physics/polytope.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "physics/box_contacts.h"
#include "support/box_mesh.h"

namespace hires::physics::polytope_test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using geometry::TriangleMesh;

/// An upright prism over a regular polygon, its sides up or down the z axis by half its height.
TriangleMesh Prism(int num_sides, double radius, double height) {
  TriangleMesh mesh;
  for (int i = 0; i < num_sides; ++i) {
    const double angle = 2.0 * geometry::kPi * i / num_sides;
    for (const double z : {-height / 2, height / 2}) {
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  }
  for (int i = 0; i < num_sides; ++i) {
    const int low = 2 * i, next = 2 * ((i + 1) % num_sides);
    mesh.triangles.push_back({low, next, next + 1});
    mesh.triangles.push_back({low, next + 1, low + 1});
    if (i == 0 || i == num_sides - 1) continue;
    mesh.triangles.push_back({0, next, low});
    mesh.triangles.push_back({1, low + 1, next + 1});
  }
  return mesh;
}

Matrix3d DrawRotation(base::Rng* rng) {
  const Eigen::Quaterniond q(rng->Normal(0, 1), rng->Normal(0, 1), rng->Normal(0, 1),
                             rng->Normal(0, 1));
  return q.normalized().toRotationMatrix();
}

Vector3d DrawPlace(double reach, base::Rng* rng) {
  return {rng->Uniform(-reach, reach), rng->Uniform(-reach, reach), rng->Uniform(-reach, reach)};
}

TEST(PolytopeTest, FacesOfMeshesAreWholeWhateverTheirTriangles) {
  const auto box = PolytopeOf(*test_support::BoxMesh({0.3, 0.2, 0.1}));
  ASSERT_NE(box, nullptr);
  EXPECT_EQ(box->vertices.size(), 8u);
  EXPECT_EQ(box->faces.size(), 6u);
  EXPECT_EQ(box->edges.size(), 12u);
  for (const int sides : {3, 8, 62}) {
    const auto prism = PolytopeOf(Prism(sides, 0.05, 0.1));
    ASSERT_NE(prism, nullptr) << sides;
    EXPECT_EQ(prism->faces.size(), sides + 2u);
    EXPECT_EQ(prism->edges.size(), 3u * sides);
  }
  // Vertices within a face and along an edge, as modelling tools leave them.
  TriangleMesh finer = *test_support::BoxMesh({0.3, 0.2, 0.1});
  const auto triangles = finer.triangles;
  finer.triangles.clear();
  for (const auto& triangle : triangles) {
    const int middle = static_cast<int>(finer.vertices.size());
    Vector3d sum = Vector3d::Zero();
    for (const int corner : triangle) sum += finer.vertices[corner];
    finer.vertices.push_back(sum / 3);
    for (int i = 0; i < 3; ++i) {
      finer.triangles.push_back({triangle[i], triangle[(i + 1) % 3], middle});
    }
  }
  const auto same = PolytopeOf(finer);
  ASSERT_NE(same, nullptr);
  EXPECT_EQ(same->vertices.size(), 8u);
  EXPECT_EQ(same->faces.size(), 6u);
}

TEST(PolytopeTest, WhatIsNoConvexSolidIsNone) {
  TriangleMesh open = *test_support::BoxMesh({0.3, 0.2, 0.1});
  open.triangles.pop_back();
  open.triangles.pop_back();
  EXPECT_EQ(PolytopeOf(open), nullptr);
  TriangleMesh inside_out = *test_support::BoxMesh({0.3, 0.2, 0.1});
  for (auto& triangle : inside_out.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_EQ(PolytopeOf(inside_out), nullptr);
  TriangleMesh dented = Prism(12, 0.05, 0.1);
  dented.vertices[4] *= 0.5;
  dented.vertices[5] *= 0.5;
  EXPECT_EQ(PolytopeOf(dented), nullptr);
  TriangleMesh two = *test_support::BoxMesh({0.1, 0.1, 0.1});
  const int num_vertices = static_cast<int>(two.vertices.size());
  const auto first = two;
  for (const Vector3d& vertex : first.vertices) two.vertices.push_back(vertex + Vector3d(1, 0, 0));
  for (const auto& t : first.triangles) {
    two.triangles.push_back({t[0] + num_vertices, t[1] + num_vertices, t[2] + num_vertices});
  }
  EXPECT_EQ(PolytopeOf(two), nullptr);
  EXPECT_EQ(PolytopeOf(Prism(100, 0.05, 0.1)), nullptr) << "more faces than are worth their pairs";
}

/// Every point of one list is one of the other [1 um].
bool IsWithin(const ContactList& some, const ContactList& all) {
  return std::all_of(some.begin(), some.end(), [&](const ContactPoint& a) {
    return std::any_of(all.begin(), all.end(), [&](const ContactPoint& b) {
      return (a.position - b.position).norm() < 1e-6 && (a.normal - b.normal).norm() < 1e-6 &&
             std::abs(a.depth - b.depth) < 1e-6;
    });
  });
}

TEST(PolytopeTest, BoxesTouchWhereBoxesDo) {
  base::Rng rng(17);
  int num_touching = 0;
  for (int i = 0; i < 5000; ++i) {
    const auto draw = [&] {
      const Vector3d half(rng.Uniform(0.01, 0.15), rng.Uniform(0.01, 0.15),
                          rng.Uniform(0.01, 0.15));
      return PlacedBox{DrawPlace(0.15, &rng), DrawRotation(&rng), half};
    };
    const PlacedBox a = draw(), b = draw();
    const auto solid_a = PolytopeOf(geometry::Box{2 * a.half_size});
    const auto solid_b = PolytopeOf(*test_support::BoxMesh(2 * b.half_size));
    ContactList boxes, polytopes;
    const bool touch = AddBoxOnBox(a, b, &boxes);
    ASSERT_EQ(AddPolytopeOnPolytope({&solid_a, a.centre, a.R_WB}, {solid_b.get(), b.centre, b.R_WB},
                                    &polytopes),
              touch)
        << i;
    if (touch) ++num_touching;
    EXPECT_TRUE(IsWithin(boxes, polytopes) && IsWithin(polytopes, boxes)) << i;
  }
  EXPECT_GT(num_touching, 1000);
}

/// How far A reaches below B's highest point along a direction: an overlap along each is an
/// overlap.
double OverlapAlong(const Vector3d& way, const PlacedPolytope& a, const PlacedPolytope& b) {
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (const Vector3d& v : a.solid->vertices) {
    lowest = std::min(lowest, way.dot(a.centre + a.R_WB * v));
  }
  for (const Vector3d& v : b.solid->vertices) {
    highest = std::max(highest, way.dot(b.centre + b.R_WB * v));
  }
  return highest - lowest;
}

TEST(PolytopeTest, NoDirectionTakesSolidsApartSoonerThanTheContactSays) {
  base::Rng rng(18);
  int num_touching = 0;
  for (int i = 0; i < 400; ++i) {
    const auto solid_a = PolytopeOf(Prism(3 + i % 7, 0.08, 0.1));
    const auto solid_b = PolytopeOf(Prism(3 + i % 5, 0.12, 0.07));
    const PlacedPolytope a{solid_a.get(), DrawPlace(0.12, &rng), DrawRotation(&rng)};
    const PlacedPolytope b{solid_b.get(), DrawPlace(0.12, &rng), DrawRotation(&rng)};
    ContactList ab, ba;
    const bool touch = AddPolytopeOnPolytope(a, b, &ab);
    ASSERT_EQ(AddPolytopeOnPolytope(b, a, &ba), touch) << i;
    double least = HUGE_VAL;
    for (int j = 0; j < 500; ++j) {
      least = std::min(least, OverlapAlong(DrawRotation(&rng).col(0), a, b));
    }
    if (!touch) continue;  // a direction between faces and edges is seldom drawn
    ++num_touching;
    ASSERT_GE(least, 0.0) << i;
    const ContactPoint deepest = *std::max_element(
        ab.begin(), ab.end(),
        [](const ContactPoint& p, const ContactPoint& q) { return p.depth < q.depth; });
    const double overlap = OverlapAlong(deepest.normal, a, b);
    EXPECT_LT(overlap, least + kFacePreference) << i;
    EXPECT_LT(deepest.depth, overlap + 1e-9) << i;
  }
  EXPECT_GT(num_touching, 100);
}

TEST(PolytopeTest, SolidsThatDoNotTouchHaveAPlaneBetweenThem) {
  base::Rng rng(19);
  const auto solid = PolytopeOf(Prism(6, 0.08, 0.1));
  for (int i = 0; i < 2000; ++i) {
    const PlacedPolytope b{solid.get(), DrawPlace(1.0, &rng), DrawRotation(&rng)};
    PlacedPolytope a{solid.get(), b.centre, DrawRotation(&rng)};
    // Along a drawn direction until both just part.
    const Vector3d way = DrawRotation(&rng).col(0);
    a.centre += (OverlapAlong(way, a, b) + 1e-9) * way;
    ContactList apart;
    EXPECT_FALSE(AddPolytopeOnPolytope(a, b, &apart)) << i;
    EXPECT_TRUE(apart.empty());
    a.centre = b.centre + 0.02 * way;  // each holds the other's middle
    ContactList touching;
    EXPECT_TRUE(AddPolytopeOnPolytope(a, b, &touching)) << i;
  }
}

TEST(PolytopeTest, ACanTouchesABoxOfTrianglesWhereItTouchesABox) {
  base::Rng rng(20);
  int num_touching = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vector3d half(rng.Uniform(0.02, 0.15), rng.Uniform(0.02, 0.15), rng.Uniform(0.02, 0.15));
    const PlacedBox box{DrawPlace(0.1, &rng), DrawRotation(&rng), half};
    // Half of them stand, lean or lie on a face; the others are anywhere.
    PlacedCylinder can{DrawPlace(0.2, &rng), DrawRotation(&rng).col(2), rng.Uniform(0.01, 0.06),
                       rng.Uniform(0.01, 0.1)};
    if (i % 2 == 0) {
      can.axis = box.R_WB * (Vector3d::UnitZ() + 0.02 * DrawPlace(1.0, &rng)).normalized();
      can.centre = box.centre + box.R_WB * Vector3d(rng.Uniform(-1.2, 1.2) * half.x(),
                                                    rng.Uniform(-1.2, 1.2) * half.y(),
                                                    half.z() + can.half_length - 0.0005);
    }
    const Vector3d lean = DrawPlace(0.5, &rng);
    const auto solid = PolytopeOf(*test_support::BoxMesh(2 * half));
    ContactList on_box, on_mesh;
    const QuickLook look = AddCylinderOnBox(can, box, lean, &on_box);
    ASSERT_EQ(AddCylinderOnPolytope(can, {solid.get(), box.centre, box.R_WB}, lean, &on_mesh), look)
        << i;
    EXPECT_TRUE(IsWithin(on_box, on_mesh) && IsWithin(on_mesh, on_box)) << i;
    if (look == QuickLook::kOnFace) ++num_touching;
  }
  EXPECT_GT(num_touching, 1000);
}

}  // namespace
}  // namespace hires::physics::polytope_test
