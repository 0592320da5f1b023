#include "hires/perception/line_of_sight.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <set>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "support/rays.h"
#include "support/sight_scenes.h"

namespace hires::perception::line_of_sight_test {
namespace {

using Eigen::Vector3d;
using geometry::kPi;
using test_support::AnyPose;
using test_support::AnyUnitVector;
using test_support::At;
using test_support::DistanceTo;
using test_support::Grown;
using test_support::LookingFrom;
using test_support::OneBody;
using test_support::SightWorld;
using test_support::Thing;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// ---- Two roads: rays through Embree's triangles against closed forms.

geometry::Collision Part(const std::string& name, const geometry::Shape& shape,
                         const geometry::Pose3& X_MS) {
  geometry::Collision part;
  part.name = name;
  part.shape = shape;
  part.X_BS = X_MS;
  return part;
}

/// Flat pieces within a round shape lie between it and a slightly smaller one, and so do hits.
/// @param dent  [m] how much smaller
void CompareWithClosedForm(const geometry::Shape& shape, double dent, std::uint64_t seed) {
  constexpr double kSinglePrecision = 1e-5;  // [m]
  const auto empty = std::make_shared<Surroundings>(world::World());
  const geometry::Shape smaller = Grown(shape, -dent - 1e-9);
  base::Rng rng(seed);
  int num_hits = 0, num_misses = 0;
  for (int i = 0; i < 2000; ++i) {
    const geometry::Pose3 X_MS = AnyPose(&rng, {4.0, -2.0, 5.0});
    const LineOfSight sight(empty, {}, {Part("body", shape, X_MS)});
    const Vector3d from_M = X_MS.translation + rng.Uniform(2.0, 3.0) * AnyUnitVector(&rng);
    const Vector3d aim = X_MS.translation + rng.Uniform(0.0, 1.0) * AnyUnitVector(&rng);
    const Vector3d direction = (aim - from_M).normalized();
    const auto hit = sight.FirstHit(from_M, direction);
    const double got = hit && hit->name == "body" ? hit->distance : kInfinity;
    const double at_least = DistanceTo(shape, X_MS, from_M, direction);
    const double at_most = DistanceTo(smaller, X_MS, from_M, direction);
    ASSERT_GE(got, at_least - kSinglePrecision) << "ray " << i;
    ASSERT_LE(got, at_most + kSinglePrecision) << "ray " << i;
    if (at_most < kInfinity) ++num_hits;
    if (at_least == kInfinity) ++num_misses;
  }
  EXPECT_GT(num_hits, 200);
  EXPECT_GT(num_misses, 200);
}

TEST(LineOfSightTest, RaysMeetABoxWhereTheSlabMethodSays) {
  CompareWithClosedForm(geometry::Box{{1.0, 0.6, 0.8}}, 0.0, 1);
}

TEST(LineOfSightTest, RaysMeetASphereWhereTheQuadraticEquationSays) {
  CompareWithClosedForm(geometry::Sphere{0.5}, 0.5 * 0.0024, 2);
}

TEST(LineOfSightTest, RaysMeetACylinderWhereTheQuadraticEquationSays) {
  CompareWithClosedForm(geometry::Cylinder{0.4, 0.9}, 0.4 * 0.0012047, 3);  // 1 - cos(pi / 64)
}

TEST(LineOfSightTest, MeshesAreMetLikeTheShapesThatTheyRepeat) {
  const geometry::Box box{{1.0, 0.6, 0.8}};
  const geometry::Shape mesh = test_support::MeshOf(box);
  base::Rng rng(4);
  for (int i = 0; i < 200; ++i) {
    const geometry::Pose3 X_MS = AnyPose(&rng, {0.0, 0.0, 3.0});
    const LineOfSight as_box(std::make_shared<Surroundings>(OneBody(box, X_MS)), {});
    const LineOfSight as_mesh(std::make_shared<Surroundings>(OneBody(mesh, X_MS)), {});
    // The same mesh as a shape of the robot, which no library has seen.
    const LineOfSight as_robot(std::make_shared<Surroundings>(world::World()), {},
                               {Part("part", mesh, X_MS)});
    const Vector3d from_M = X_MS.translation + 2.0 * AnyUnitVector(&rng);
    const Vector3d direction = X_MS.translation + 0.2 * AnyUnitVector(&rng) - from_M;
    EXPECT_NEAR(as_mesh.Cast(from_M, direction), as_box.Cast(from_M, direction), 1e-5);
    EXPECT_NEAR(as_robot.Cast(from_M, direction), as_box.Cast(from_M, direction), 1e-5);
  }
}

TEST(LineOfSightTest, TheFloorIsThereWithoutBeingAskedFor) {
  const LineOfSight sight(std::make_shared<Surroundings>(world::World()), {});
  const auto hit = sight.FirstHit({3.0, 4.0, 2.0}, Vector3d(1.0, 0.0, -1.0));
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->name, "floor");
  EXPECT_NEAR(hit->distance, 2.0 * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(sight.Cast({3.0, 4.0, 2.0}, Vector3d::UnitX()), kInfinity);
}

TEST(LineOfSightTest, ARayFromWithinAShapeLeavesIt) {
  world::World world = OneBody(geometry::Box{{0.4, 0.4, 0.4}}, At(0.0, 0.0, 1.0));
  world.statics.push_back(test_support::Block("wall", {0.2, 4.0, 2.0}, {2.1, 0.0, 1.0}));
  const LineOfSight sight(std::make_shared<Surroundings>(world), {});
  const auto hit = sight.FirstHit({0.0, 0.0, 1.0}, Vector3d::UnitX());
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->name, "wall");
  EXPECT_NEAR(hit->distance, 2.0, 1e-5);
}

TEST(LineOfSightTest, BoxesThatTouchLetNoLightThroughBetweenThem) {
  world::World world = OneBody(geometry::Box{{0.4, 2.0, 2.0}}, At(0.0, 0.0, 1.5));
  world.statics.push_back(test_support::Block("next", {0.4, 2.0, 2.0}, {0.4, 0.0, 1.5}));
  const LineOfSight sight(std::make_shared<Surroundings>(world), {});
  const auto hit = sight.FirstHit({0.0, 0.0, 1.5}, Vector3d::UnitX());  // from within the first
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->name, "next");
  EXPECT_NEAR(hit->distance, 0.2, 1e-6);
}

// ---- What a camera sees of objects.

class SightTest : public testing::Test {
 protected:
  SightTest() : surroundings_(std::make_shared<Surroundings>(SightWorld())) {}

  double Share(const std::vector<world::ObjectState>& objects, const CameraView& view,
               const std::vector<geometry::Collision>& robot_M = {}) const {
    return LineOfSight(surroundings_, objects, robot_M).VisibleShare(view, objects[0].name);
  }

  std::shared_ptr<const Surroundings> surroundings_;
  const CameraView view_ = LookingFrom({0.0, 0.0, 1.0});  // along x
};

TEST_F(SightTest, AMugThatStandsAloneIsSeenWhole) {
  EXPECT_EQ(Share({Thing("mug1", "mug", At(1.5, 0.0, 0.9))}, view_), 1.0);
}

TEST_F(SightTest, AMugBehindAnotherIsHidden) {
  const std::vector<world::ObjectState> two = {Thing("mug1", "mug", At(2.0, 0.0, 0.95)),
                                               Thing("mug2", "mug", At(1.0, 0.0, 0.95))};
  EXPECT_EQ(Share(two, view_), 0.0);
  EXPECT_EQ(LineOfSight(surroundings_, two).VisibleShare(view_, "MUG2"), 1.0);
}

TEST_F(SightTest, AMugBehindAWallIsHidden) {
  EXPECT_EQ(Share({Thing("mug1", "mug", At(3.3, 0.0, 0.95))}, view_), 0.0);
}

TEST_F(SightTest, AMugThatIsHalfCoveredIsSeenByHalf) {
  // The screen's edge runs through the line from the camera to the middle of the mug.
  const std::vector<world::ObjectState> objects = {Thing("mug1", "mug", At(2.0, 0.0, 0.95)),
                                                   Thing("screen1", "screen", At(1.0, 0.5, 0.7))};
  EXPECT_NEAR(Share(objects, view_), 0.5, 0.15);
}

TEST_F(SightTest, WhatIsTooNearTooFarOrBesideTheViewIsNotSeen) {
  EXPECT_EQ(Share({Thing("mug1", "mug", At(0.2, 0.0, 0.95))}, view_), 0.0);
  EXPECT_EQ(
      Share({Thing("mug1", "mug", At(0.0, 3.0, 0.95))}, LookingFrom({0.0, 0.0, 1.0}, kPi / 2)),
      1.0);
  EXPECT_EQ(
      Share({Thing("mug1", "mug", At(0.0, 3.6, 0.95))}, LookingFrom({0.0, 0.0, 1.0}, kPi / 2)),
      0.0);
  EXPECT_EQ(Share({Thing("mug1", "mug", At(1.5, 1.2, 0.95))}, view_), 0.0);
  EXPECT_EQ(Share({Thing("mug1", "mug", At(1.5, 0.0, 1.8))}, view_), 0.0);
}

TEST_F(SightTest, TheRobotsOwnArmHidesWhatIsBehindIt) {
  const std::vector<world::ObjectState> mug = {Thing("mug1", "mug", At(2.0, 0.0, 0.95))};
  geometry::Collision forearm =
      test_support::Shape("l_forearm_link", geometry::Box{{0.1, 0.4, 0.2}}, {0.6, 0.0, 1.0});
  EXPECT_EQ(Share(mug, view_, {forearm}), 0.0);
  forearm.X_BS.translation.y() = 0.5;
  EXPECT_EQ(Share(mug, view_, {forearm}), 1.0);
}

TEST_F(SightTest, APointIsSeenThroughTheObjectThatIsLookedThrough) {
  const LineOfSight sight(surroundings_, {Thing("mug1", "mug", At(1.0, 0.0, 0.95))});
  const Vector3d behind(1.5, 0.0, 1.0);
  EXPECT_FALSE(sight.Sees(view_, behind));
  EXPECT_TRUE(sight.Sees(view_, behind, "Mug1"));
  EXPECT_FALSE(sight.Sees(view_, {1.5, 1.2, 1.0})) << "beside the view";
}

TEST_F(SightTest, WhatIsNotThereIsJudgedAsIfItWere) {
  const std::vector<world::ObjectState> objects = {Thing("mug1", "mug", At(1.6, 0.1, 0.95)),
                                                   Thing("screen1", "screen", At(1.0, 0.5, 0.7))};
  const LineOfSight with(surroundings_, objects), without(surroundings_, {objects[1]});
  EXPECT_EQ(with.VisibleShare(view_, "mug1"),
            without.VisibleShareAt(view_, "mug", objects[0].X_MO));
  EXPECT_EQ(with.VisibleShare(view_, "mug1"),
            with.VisibleShareAt(view_, "mug", objects[0].X_MO, "mug1"));
}

// Two roads: packets of rays, and one ray after the other.
TEST_F(SightTest, APictureSaysOfEachPixelWhatItsRayMeets) {
  geometry::Collision forearm =
      test_support::Shape("l_forearm_link", geometry::Box{{0.1, 0.1, 0.1}}, {0.6, 0.2, 0.9});
  const LineOfSight sight(
      surroundings_,
      {Thing("mug1", "mug", At(1.5, 0.0, 0.9)), Thing("jug1", "jug", At(1.8, -0.2, 0.9)),
       Thing("screen1", "screen", At(2.5, 0.5, 0.7))},
      {forearm});
  const PinholeCamera camera = LookAt({0.0, 0.0, 1.0}, {1.5, 0.0, 0.8}, 65, 49, 1.0);
  constexpr double kMaxRange = 2.8;  // before the wall's upper part
  const RangePicture picture = sight.Look(camera, kMaxRange);
  const Vector3d forward = camera.X_MC.rotation * Vector3d::UnitX();
  std::set<std::string> met;
  for (int row = 0; row < camera.height; ++row) {
    for (int column = 0; column < camera.width; ++column) {
      const int i = row * camera.width + column;
      const Vector3d direction = camera.DirectionAt(column + 0.5, row + 0.5);
      const auto hit = sight.FirstHit({0.0, 0.0, 1.0}, direction);
      ASSERT_TRUE(hit.has_value());
      if (hit->distance > kMaxRange) {
        ASSERT_EQ(picture.owner[i], RangePicture::kNothing);
        ASSERT_EQ(picture.depth[i], std::numeric_limits<float>::infinity());
        continue;
      }
      ASSERT_EQ(picture.names[picture.owner[i]], hit->name) << column << ", " << row;
      ASSERT_NEAR(picture.depth[i], hit->distance * direction.dot(forward), 1e-5);
      if (hit->name == "floor") {
        ASSERT_NEAR(picture.incidence[i], -direction.z(), 1e-6);
      }
      met.insert(hit->name);
    }
  }
  EXPECT_THAT(met, testing::ElementsAre("floor", "jug1", "l_forearm_link", "mug1", "screen1"));
}

TEST_F(SightTest, TheSameLookGivesTheSameBits) {
  std::vector<world::ObjectState> objects;
  base::Rng rng(11);
  for (int i = 0; i < 12; ++i) {
    objects.push_back(Thing("mug" + std::to_string(i), "mug",
                            At(rng.Uniform(0.6, 2.5), rng.Uniform(-0.6, 0.6), 0.95)));
  }
  const LineOfSight once(surroundings_, objects), again(surroundings_, objects);
  for (const world::ObjectState& object : objects) {
    EXPECT_EQ(once.VisibleShare(view_, object.name), again.VisibleShare(view_, object.name));
  }
}

TEST_F(SightTest, UnknownModelsAndPosesThatAreNoNumbersAreNamed) {
  using testing::HasSubstr;
  try {
    LineOfSight(surroundings_, {Thing("mug1", "mugg", At(1.0, 0.0, 0.9))});
    FAIL() << "an unknown model was taken";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'mugg' is unknown; did you mean 'mug'"));
  }
  try {
    LineOfSight(surroundings_, {Thing("mug1", "mug", At(std::nan(""), 0.0, 0.9))});
    FAIL() << "a pose of NaN was taken";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("object 'mug1': its pose is not finite"));
  }
  EXPECT_THROW(LineOfSight(surroundings_, {}).VisibleShare(view_, "mug1"), std::logic_error);
}

// ---- Patterns of points.

TEST(SurroundingsTest, PointsOfASurfaceLieOnItAndStandForItsArea) {
  const Surroundings surroundings(SightWorld());
  double area = 0.0;
  for (const SurfacePoint& point : surroundings.Surface("mug")) {
    EXPECT_NEAR(point.n_O.norm(), 1.0, 1e-12);
    EXPECT_LE(std::hypot(point.p_O.x(), point.p_O.y()), 0.04 + 1e-9);
    area += point.area;
  }
  EXPECT_NEAR(area, 2.0 * kPi * 0.04 * (0.04 + 0.1), 1e-9);
}

TEST(SurroundingsTest, PointsWithinAnotherPartOfTheObjectAreLeftOut) {
  const Surroundings surroundings(SightWorld());
  for (const SurfacePoint& point : surroundings.Surface("jug")) {
    const bool is_in_body =
        std::hypot(point.p_O.x(), point.p_O.y()) < 0.0599 && std::abs(point.p_O.z() - 0.1) < 0.0999;
    EXPECT_FALSE(is_in_body) << point.p_O.transpose();
  }
}

TEST(SurroundingsTest, PointsOfAMeshCoverItEvenly) {
  world::World world = SightWorld();
  world::ObjectModel crate = test_support::Mill("crate");
  crate.collisions = {
      test_support::Shape("body", test_support::MeshOf({{1.0, 1.0, 1.0}}), {0, 0, 0})};
  test_support::AddModel(&world, crate);
  const Surroundings surroundings(world);
  double area = 0.0, upper_area = 0.0;
  for (const SurfacePoint& point : surroundings.Surface("crate")) {
    area += point.area;
    if (point.n_O.z() > 0.9) upper_area += point.area;
  }
  EXPECT_NEAR(area, 6.0, 1e-9);
  EXPECT_NEAR(upper_area, 1.0, 0.1);
}

}  // namespace
}  // namespace hires::perception::line_of_sight_test
