#include "physics/placed_shape.h"

#include <gmock/gmock.h>

#include <limits>
#include <string>

#include "hires/base/error.h"
#include "physics/scenes.h"

namespace hires::physics::placed_shape_test {
namespace {

using Eigen::Vector3d;
using test_support::BoxMesh;
using test_support::MakeCollision;
using ::testing::HasSubstr;

const double kNaN = std::numeric_limits<double>::quiet_NaN();

/// All of them reach 0.1 m up and down.
std::vector<geometry::Shape> ShapesOfHeightTwenty() {
  return {geometry::Box{{0.3, 0.3, 0.2}}, geometry::Cylinder{0.12, 0.2}, geometry::Sphere{0.1},
          BoxMesh({0.3, 0.3, 0.2})};
}

ContactList TouchAt(const geometry::Shape& upper, const geometry::Shape& lower, double height) {
  PlacedShape a(MakeCollision(upper, Vector3d::Zero()));
  PlacedShape b(MakeCollision(lower, Vector3d::Zero()));
  a.Place({0.01, 0.02, height}, Eigen::Matrix3d::Identity());
  b.Place(Vector3d::Zero(), Eigen::Matrix3d::Identity());
  ContactList contacts;
  FindContacts(a, b, Vector3d::Zero(), &contacts);
  return contacts;
}

TEST(PlacedShapeTest, EveryPairOfShapesTouchesWhereItOverlapsAndNowhereElse) {
  const std::vector<geometry::Shape> shapes = ShapesOfHeightTwenty();
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (std::size_t j = 0; j < shapes.size(); ++j) {
      const ContactList contacts = TouchAt(shapes[i], shapes[j], 0.1985);
      EXPECT_GE(contacts.size(), 1) << i << " on " << j;
      EXPECT_LE(contacts.size(), ContactList::kAtMost) << i << " on " << j;
      for (const ContactPoint& point : contacts) {
        EXPECT_GT(point.normal.z(), 0.9) << i << " on " << j;
        EXPECT_NEAR(point.position.z(), 0.1, 0.01) << i << " on " << j;
        EXPECT_LE(point.depth, 0.0035) << i << " on " << j;
      }
      EXPECT_TRUE(TouchAt(shapes[i], shapes[j], 0.205).empty()) << i << " on " << j;
    }
  }
}

TEST(PlacedShapeTest, EveryShapeTouchesTheFloorItReaches) {
  for (const geometry::Shape& shape : ShapesOfHeightTwenty()) {
    PlacedShape a(MakeCollision(shape, Vector3d::Zero()));
    PlacedShape floor = PlacedShape::Floor(0.5);
    ContactList contacts;
    a.Place({3.0, 4.0, 0.099}, Eigen::Matrix3d::Identity());
    FindContacts(a, floor, Vector3d::Zero(), &contacts);
    ASSERT_FALSE(contacts.empty()) << shape.index();
    // ODE's meshes live in single precision.
    EXPECT_NEAR(contacts[0].depth, 0.001, 1e-8) << shape.index();
    EXPECT_NEAR(contacts[0].normal.z(), 1.0, 1e-9) << shape.index();
    a.Place({3.0, 4.0, 0.101}, Eigen::Matrix3d::Identity());
    FindContacts(a, floor, Vector3d::Zero(), &contacts);
    EXPECT_TRUE(contacts.empty()) << shape.index();
  }
}

TEST(PlacedShapeTest, CylinderLeaningOnAnEdgeTouchesIt) {
  PlacedShape leaning(MakeCollision(geometry::Cylinder{0.037, 0.274}, Vector3d::Zero()));
  PlacedShape table(MakeCollision(geometry::Box{{0.5, 0.5, 0.5}}, Vector3d::Zero()));
  table.Place(Vector3d::Zero(), Eigen::Matrix3d::Identity());
  // The edge y direction at x = 0.25, z = 0.25; the axis leans by 45 degrees across it.
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(-0.25 * 3.14159265358979, Vector3d::UnitY()).toRotationMatrix();
  const Vector3d out = Vector3d(1.0, 0.0, 1.0).normalized();
  leaning.Place(Vector3d(0.25, 0.0, 0.25) + 0.036 * out, R);
  ContactList contacts;
  FindContacts(leaning, table, Vector3d::Zero(), &contacts);
  ASSERT_FALSE(contacts.empty());
  EXPECT_GT(contacts[0].normal.dot(out), 0.9);
}

TEST(PlacedShapeTest, RaysHitWhereTheShapeBegins) {
  for (const geometry::Shape& shape : ShapesOfHeightTwenty()) {
    PlacedShape placed(MakeCollision(shape, Vector3d::Zero()));
    placed.Place({0.0, 0.0, 1.0}, Eigen::Matrix3d::Identity());
    const RayHit hit = CastRay({0.01, 0.0, 0.0}, Vector3d::UnitZ(), 2.0, placed);
    ASSERT_TRUE(hit.hit) << shape.index();
    EXPECT_NEAR(hit.distance, 0.9, 0.001) << shape.index();
    EXPECT_LT(hit.normal.z(), -0.9) << shape.index();
    EXPECT_FALSE(CastRay({0.01, 0.0, 0.0}, Vector3d::UnitZ(), 0.8, placed).hit);
  }
}

TEST(PlacedShapeTest, RefusesWhatNoShapeCanBe) {
  struct Case {
    geometry::Shape shape;
    const char* says;
  };
  auto hole = std::make_shared<geometry::TriangleMesh>(*BoxMesh({1, 1, 1}));
  hole->triangles[3][1] = 8;
  auto broken = std::make_shared<geometry::TriangleMesh>(*BoxMesh({1, 1, 1}));
  broken->vertices[2].y() = kNaN;
  const std::vector<Case> cases = {
      {geometry::Box{{1.0, 0.0, 1.0}}, "box size y is 0 m"},
      {geometry::Cylinder{-1.0, 1.0}, "cylinder radius is -1 m"},
      {geometry::Cylinder{1.0, kNaN}, "cylinder length is nan m"},
      {geometry::Sphere{std::numeric_limits<double>::infinity()}, "sphere radius is inf m"},
      {std::shared_ptr<const geometry::TriangleMesh>(), "no triangles"},
      {std::shared_ptr<const geometry::TriangleMesh>(hole), "names vertex 8"},
      {std::shared_ptr<const geometry::TriangleMesh>(broken), "not finite"},
  };
  for (const Case& c : cases) {
    try {
      PlacedShape shape(MakeCollision(c.shape, Vector3d::Zero()));
      ADD_FAILURE() << "accepted: " << c.says;
    } catch (const base::ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr("collision 'shape'"));
      EXPECT_THAT(error.what(), HasSubstr(c.says));
    }
  }
}

TEST(PlacedShapeTest, RefusesSurfacesThatNoBodyHas) {
  geometry::Collision collision = MakeCollision(geometry::Sphere{0.1}, Vector3d::Zero(), -0.1);
  EXPECT_THROW(PlacedShape{collision}, base::ConfigError);
  collision.friction = 0.5;
  collision.restitution = 1.5;
  EXPECT_THROW(PlacedShape{collision}, base::ConfigError);
  collision.restitution = 0.0;
  collision.X_BS.translation.x() = kNaN;
  EXPECT_THROW(PlacedShape{collision}, base::ConfigError);
  EXPECT_THROW(PlacedShape::Floor(kNaN), base::ConfigError);
}

}  // namespace
}  // namespace hires::physics::placed_shape_test
