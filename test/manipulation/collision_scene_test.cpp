#include "hires/manipulation/collision_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "restaurant_scene.h"

namespace hires::manipulation::collision_scene_test {
namespace {

using geometry::Box;
using geometry::Cylinder;
using geometry::Pose2;
using geometry::Pose3;
using geometry::Sphere;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Pair;

geometry::Collision Shape(geometry::Shape shape, const Pose3& X_BS = {}) {
  geometry::Collision collision;
  collision.name = "shape";
  collision.shape = std::move(shape);
  collision.X_BS = X_BS;
  return collision;
}

Pose3 At(double x, double y, double z, double roll = 0.0, double pitch = 0.0, double yaw = 0.0) {
  return {{x, y, z}, geometry::RotationFromRpy(roll, pitch, yaw)};
}

robot::Joint JointAt(const std::string& name, robot::JointType type, int parent, const Pose3& X) {
  robot::Joint joint;
  joint.name = name;
  joint.type = type;
  joint.parent = parent;
  joint.X_PJ = X;
  joint.axis = Eigen::Vector3d::UnitZ();
  return joint;
}

/// A lift: a base without shape, a sphere of 0.1 m that goes up and down 1 m above it, and a hand
/// that hangs on the sphere and turns.
std::shared_ptr<const robot::Robot> Lift() {
  robot::Robot robot;
  robot.model.name = "lift";
  robot::Link base, ball, hand;
  base.name = "base";
  ball.name = "ball";
  ball.joint = JointAt("lift", robot::JointType::kPrismatic, 0, At(0, 0, 1));
  ball.joint->limits = robot::JointLimits{-0.5, 5.0, 1.0, 1.0};
  ball.collisions = {Shape(Sphere{0.1})};
  hand.name = "hand";
  hand.joint = JointAt("turn", robot::JointType::kContinuous, 1, At(0.5, 0, 0));
  hand.collisions = {Shape(Box{{0.1, 0.1, 0.1}}, At(0.2, 0, 0))};
  robot.model.links = {base, ball, hand};
  robot.profile.base_link = "base";
  return std::make_shared<const robot::Robot>(robot);
}

std::shared_ptr<world::World> WorldWith(std::vector<world::StaticBody> statics) {
  auto world = std::make_shared<world::World>();
  world->name = "test";
  world->statics = std::move(statics);
  return world;
}

std::shared_ptr<const geometry::TriangleMesh> BoxMesh(const Eigen::Vector3d& size) {
  auto mesh = std::make_shared<geometry::TriangleMesh>();
  for (int i = 0; i < 8; ++i) {
    mesh->vertices.emplace_back(size.x() * ((i & 1) - 0.5), size.y() * (((i >> 1) & 1) - 0.5),
                                size.z() * (((i >> 2) & 1) - 0.5));
  }
  mesh->triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

CollisionScene Scene(std::vector<world::StaticBody> statics, double padding = 0.0) {
  return CollisionScene(WorldWith(std::move(statics)), Lift(), {padding, 0});
}

bool BallTouches(const CollisionScene& scene, double x, double lift) {
  return scene.FindTouch({x, 0.0, 0.0}, {{"lift", lift}}, {false, true, false}).has_value();
}

/// Distance from a point to a box in its own frame: the closed form that the scene is held against.
double DistanceToBox(const Eigen::Vector3d& p_S, const Eigen::Vector3d& size) {
  return (p_S.cwiseAbs() - 0.5 * size).cwiseMax(0.0).norm();
}

/// Likewise to a cylinder along z.
double DistanceToCylinder(const Eigen::Vector3d& p_S, const Cylinder& cylinder) {
  const double out = std::max(0.0, std::hypot(p_S.x(), p_S.y()) - cylinder.radius);
  return std::hypot(out, std::max(0.0, std::abs(p_S.z()) - 0.5 * cylinder.length));
}

/// Moves the ball among randomly placed bodies and holds every answer against `distance`, leaving
/// out what lies within `slack` of the boundary.
template <typename Distance>
void ExpectAgreement(const geometry::Shape& shape, Distance distance, double padding) {
  constexpr double kSlack = 1e-4;
  base::Rng rng(11);
  int touching = 0, free = 0;
  for (int i = 0; i < 300; ++i) {
    const Pose3 X_MS = At(rng.Uniform(-0.3, 0.3), rng.Uniform(-0.3, 0.3), rng.Uniform(0.8, 1.6),
                          rng.Uniform(-3, 3), rng.Uniform(-1.5, 1.5), rng.Uniform(-3, 3));
    const CollisionScene scene = Scene({{"body", X_MS, {Shape(shape)}}}, padding);
    for (double lift = -0.2; lift < 0.8; lift += 0.2) {
      const double gap =
          distance(X_MS.Inverse() * Eigen::Vector3d(0, 0, 1.0 + lift)) - 0.1 - padding;
      if (std::abs(gap) < kSlack) continue;
      EXPECT_EQ(BallTouches(scene, 0.0, lift), gap < 0.0) << "gap " << gap;
      ++(gap < 0.0 ? touching : free);
    }
  }
  EXPECT_GT(touching, 50);
  EXPECT_GT(free, 50);
}

TEST(CollisionSceneTest, SphereAndBoxTouchAsTheClosedFormSays) {
  const Eigen::Vector3d size(0.3, 0.4, 0.2);
  const auto distance = [&](const Eigen::Vector3d& p) { return DistanceToBox(p, size); };
  ExpectAgreement(Box{size}, distance, 0.0);
  ExpectAgreement(Box{size}, distance, 0.02);  // the sphere grows, so the closed form still holds
}

TEST(CollisionSceneTest, SphereAndCylinderTouchAsTheClosedFormSays) {
  const Cylinder cylinder{0.15, 0.5};
  const auto distance = [&](const Eigen::Vector3d& p) { return DistanceToCylinder(p, cylinder); };
  ExpectAgreement(cylinder, distance, 0.0);
  ExpectAgreement(cylinder, distance, 0.02);
}

TEST(CollisionSceneTest, SphereAndSphereTouchAsTheClosedFormSays) {
  ExpectAgreement(
      Sphere{0.2}, [](const Eigen::Vector3d& p) { return p.norm() - 0.2; }, 0.015);
}

TEST(CollisionSceneTest, AMeshIsItsSurface) {
  const Eigen::Vector3d size(0.3, 0.4,
                             0.2);  // the ball does not fit in: it always cuts the surface
  ExpectAgreement(
      BoxMesh(size), [&](const Eigen::Vector3d& p) { return DistanceToBox(p, size); }, 0.0);
  ExpectAgreement(
      BoxMesh(size), [&](const Eigen::Vector3d& p) { return DistanceToBox(p, size); }, 0.02);
}

TEST(CollisionSceneTest, BothAreNamed) {
  const CollisionScene scene = Scene({{"wall", At(0.2, 0, 1), {Shape(Box{{0.3, 1, 1}})}}});
  const auto touch = scene.FindTouch({}, {});
  ASSERT_TRUE(touch);
  EXPECT_EQ(ToString(*touch), "ball touches wall");
}

TEST(CollisionSceneTest, TheBasePoseMovesTheRobot) {
  const CollisionScene scene = Scene({{"wall", At(3, 0, 1), {Shape(Box{{0.2, 1, 1}})}}});
  EXPECT_FALSE(scene.FindTouch({1.0, 0.0, 0.0}, {}));
  EXPECT_TRUE(scene.FindTouch({3.0, 0.0, 0.0}, {}));
  // The hand is 0.7 m in front of the base.
  EXPECT_EQ(scene.FindTouch({2.3, 0.0, 0.0}, {})->a, "hand");
  EXPECT_FALSE(scene.FindTouch({2.3, 0.0, geometry::kPi}, {}));
}

TEST(CollisionSceneTest, OnlyMaskedLinksAreBlamed) {
  const CollisionScene scene = Scene({{"wall", At(0, 0, 1), {Shape(Box{{0.2, 0.2, 0.2}})}}});
  EXPECT_TRUE(scene.FindTouch({}, {}));
  EXPECT_FALSE(scene.FindTouch({}, {}, scene.MovedBy({"turn"})));
  EXPECT_TRUE(scene.FindTouch({}, {}, scene.MovedBy({"lift"})));
}

TEST(CollisionSceneTest, MovedByIsEverythingThatHangsOnTheJoint) {
  const CollisionScene scene = Scene({});
  EXPECT_EQ(scene.MovedBy({"lift"}), LinkMask({false, true, true}));
  EXPECT_EQ(scene.MovedBy({"turn"}), LinkMask({false, false, true}));
  EXPECT_EQ(scene.MovedBy({}), LinkMask({false, false, false}));
  EXPECT_THROW(scene.MovedBy({"torn"}), base::ConfigError);
}

TEST(CollisionSceneTest, TheFloorIsInTheWay) {
  const CollisionScene scene = Scene({}, 0.02);
  EXPECT_FALSE(scene.FindTouch({}, {{"lift", -0.5}}));
  const CollisionScene low = CollisionScene(WorldWith({}), Lift(), {0.41, 0});
  EXPECT_EQ(ToString(*low.FindTouch({}, {{"lift", -0.5}})), "ball touches floor");
}

world::ObjectModel Ball() {
  world::ObjectModel model;
  model.name = "ball05";
  model.collisions = {Shape(Sphere{0.05})};
  return model;
}

world::ObjectState Object(const std::string& name, const Pose3& X_MO,
                          const std::string& link = "") {
  world::ObjectState state;
  state.name = name;
  state.model = "ball05";
  state.X_MO = X_MO;
  state.attached_to = link;
  return state;
}

std::shared_ptr<world::World> WorldWithBalls() {
  auto world = WorldWith({{"wall", At(0, 2, 1), {Shape(Box{{0.1, 0.1, 3}})}}});
  world->models["ball05"] = std::make_shared<const world::ObjectModel>(Ball());
  return world;
}

TEST(CollisionSceneObjectsTest, ALooseObjectIsInTheWayUntilItIsAllowed) {
  CollisionScene scene(WorldWithBalls(), Lift(), {0.0, 0});
  scene.SetObjects({Object("Apple", At(0.1, 0, 1))}, {}, {});
  EXPECT_EQ(ToString(*scene.FindTouch({}, {})), "ball touches Apple");
  scene.Allow("apple", "BALL");
  EXPECT_FALSE(scene.FindTouch({}, {}));
}

TEST(CollisionSceneObjectsTest, AHeldObjectMovesWithItsLinkAndMayTouchItAlone) {
  CollisionScene scene(WorldWithBalls(), Lift(), {0.0, 0});
  // In the hand: at (0.7, 0, 1) when nothing turns; it overlaps the hand.
  scene.SetObjects({Object("apple", At(0.7, 0, 1.08), "hand"), Object("pear", At(0.5, 0.2, 1.1))},
                   {}, {});
  EXPECT_FALSE(scene.FindTouch({}, {}));
  const auto touch = scene.FindTouch({}, {{"turn", 0.5 * geometry::kPi}});
  ASSERT_TRUE(touch);
  EXPECT_THAT(ToString(*touch), AllOf(HasSubstr("pear"), HasSubstr("touches")));
  scene.Allow("hand", "pear");
  EXPECT_EQ(ToString(*scene.FindTouch({}, {{"turn", 0.5 * geometry::kPi}})), "apple touches pear");
  // 0.7 m from the lift's column, turned by 90 degrees, raised by 1 m with the ball.
  EXPECT_FALSE(scene.FindTouch({}, {{"turn", 0.5 * geometry::kPi}, {"lift", 1.0}}));
}

TEST(CollisionSceneObjectsTest, AHeldObjectMeetsStaticBodies) {
  CollisionScene scene(WorldWithBalls(), Lift(), {0.0, 0});
  const Pose2 X_MB{0.0, 1.6, 0.0};  // 0.4 m south of the wall
  scene.SetObjects({Object("apple", At(0.55, 1.6, 1.2), "ball")}, X_MB, {});
  EXPECT_FALSE(scene.FindTouch(X_MB, {}));
  EXPECT_EQ(ToString(*scene.FindTouch({0.0, 1.45, geometry::kPi / 2}, {})), "apple touches wall");
}

TEST(CollisionSceneObjectsTest, ThingsHeldByDifferentLinksMustNotMeet) {
  CollisionScene scene(WorldWithBalls(), Lift(), {0.0, 0});
  scene.SetObjects(
      {Object("apple", At(0.5, 0.2, 1.3), "ball"), Object("pear", At(0.7, 0, 1.3), "hand")}, {},
      {});
  EXPECT_FALSE(scene.FindTouch({}, {}));
  EXPECT_EQ(ToString(*scene.FindTouch({}, {{"turn", 0.5 * geometry::kPi}})), "apple touches pear");
}

TEST(CollisionSceneObjectsTest, AClonesObjectsAreItsOwn) {
  CollisionScene scene(WorldWithBalls(), Lift(), {0.0, 0});
  CollisionScene clone = scene.Clone();
  clone.SetObjects({Object("apple", At(0, 0, 1))}, {}, {});
  EXPECT_TRUE(clone.FindTouch({}, {}));
  EXPECT_FALSE(scene.FindTouch({}, {}));
  EXPECT_TRUE(clone.Clone().FindTouch({}, {}));
}

template <typename Action>
std::string ErrorOf(Action action) {
  try {
    action();
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(CollisionSceneErrorsTest, UnknownNamesAreNamed) {
  CollisionScene scene(WorldWithBalls(), Lift(), {0.0, 0});
  world::ObjectState pear = Object("pear", {});
  pear.model = "ball5";
  EXPECT_THAT(ErrorOf([&] { scene.SetObjects({pear}, {}, {}); }),
              AllOf(HasSubstr("pear"), HasSubstr("'ball5'"), HasSubstr("ball05")));
  EXPECT_THAT(ErrorOf([&] { scene.SetObjects({Object("apple", {}, "hands")}, {}, {}); }),
              AllOf(HasSubstr("apple"), HasSubstr("'hands'"), HasSubstr("hand")));
  EXPECT_THAT(ErrorOf([&] {
                scene.FindTouch({}, {{"lyft", 0.0}});
              }),
              AllOf(HasSubstr("'lyft'"), HasSubstr("lift")));
}

TEST(CollisionSceneErrorsTest, AnEmptyMeshIsAnError) {
  EXPECT_THAT(ErrorOf([] {
                Scene({{"rock", {}, {Shape(std::make_shared<geometry::TriangleMesh>())}}});
              }),
              AllOf(HasSubstr("rock"), HasSubstr("no triangles")));
}

// The PR2.

TEST(CollisionScenePr2Test, EveryNamedPostureIsFreeOfSelfTouchesInItsUsualTorsoHeight) {
  const CollisionScene scene = test_support::RestaurantScene();
  for (const std::string name :
       {"armtuckedposture", "armuntuckedposture", "armtosideposture", "armcarryposture"}) {
    const auto touch = scene.FindTouch({12.5, 9.8, 0.0}, test_support::Posture(name, 0.295, 0.0));
    EXPECT_FALSE(touch) << name << ": " << ToString(*touch);
  }
}

TEST(CollisionScenePr2Test, AnArmThroughTheTrayTouchesIt) {
  const CollisionScene scene = test_support::RestaurantScene();
  robot::JointPositions posture = test_support::Posture("armtosideposture", 0.0115, 0.0);
  test_support::SetArm("rightarm1", {0.0, 1.3, 0.0, -0.5, 0.0, -0.1, 0.0}, &posture);
  const auto touch = scene.FindTouch({12.5, 9.8, 0.0}, posture);
  ASSERT_TRUE(touch);
  EXPECT_THAT(ToString(*touch), HasSubstr("base_"));
}

// The tuck folds the arms into each other's boxes, which must not make them blind to each other.
TEST(CollisionScenePr2Test, ArmsThatCrossTouch) {
  const CollisionScene scene = test_support::RestaurantScene();
  robot::JointPositions posture = test_support::Posture("armtuckedposture", 0.295, 0.0);
  test_support::SetArm("leftarm1", {-0.5, 0.5, 0.0, -0.2, 0.0, -0.1, 0.0}, &posture);
  EXPECT_FALSE(
      scene.FindTouch({12.5, 9.8, 0.0}, test_support::Posture("armtuckedposture", 0.295, 0.0)));
  test_support::SetArm("rightarm1", {0.5, 0.5, 0.0, -0.2, 0.0, -0.1, 0.0}, &posture);
  const auto touch = scene.FindTouch({12.5, 9.8, 0.0}, posture);
  ASSERT_TRUE(touch);
  EXPECT_THAT(touch->a + touch->b, AllOf(HasSubstr("l_"), HasSubstr("r_")));
}

TEST(CollisionScenePr2Test, OnlyNeighboursInOneArmAreLeftOut) {
  for (const auto& [a, b] : test_support::RestaurantScene().LeftOutPairs()) {
    if (a == "base_link") continue;  // wheels
    EXPECT_EQ(a.substr(0, 2), b.substr(0, 2)) << a << " and " << b;
  }
}

TEST(CollisionScenePr2Test, TheRobotMayDriveWithTheTorsoDownAndItsWheelsOnTheFloor) {
  EXPECT_FALSE(test_support::RestaurantScene().FindTouch(
      {12.5, 9.8, 0.0}, test_support::Posture("armtuckedposture", 0.0115, 0.0)));
}

TEST(CollisionScenePr2Test, NoPairOfArmAndBaseIsLeftOut) {
  for (const auto& [a, b] : test_support::RestaurantScene().LeftOutPairs()) {
    const bool is_base = a.rfind("base_", 0) == 0 && a != "base_link";
    EXPECT_FALSE(is_base) << a << " and " << b;
    if (a == "base_link") {
      EXPECT_THAT(b, HasSubstr("wheel"));
    }
  }
}

}  // namespace
}  // namespace hires::manipulation::collision_scene_test
