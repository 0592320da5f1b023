#include "simulation/start_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hires/base/error.h"
#include "simulation/start/overlap.h"
#include "support/box_mesh.h"
#include "support/scenes.h"

namespace hires::simulation::start_checks_test {
namespace {

using hires::test_support::AddModel;
using hires::test_support::Mill;
using hires::test_support::Room;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

world::ObjectState MillAt(double z) {
  world::ObjectState object;
  object.name = "mill1";
  object.model = "mill";
  object.X_MO.translation = {1.2, 2.0, z};
  return object;
}

std::string Why(const world::ObjectState& object, const world::World& world, const Inside& inside) {
  const auto scene = MakeScene(world, hires::test_support::TrayRobot());
  return WhyInsideRobot(object, *scene, geometry::Lift({1.0, 2.0, 0.0}), inside);
}

TEST(StartChecksTest, OfAThingOfTheWorldTheRobotsStartIsTold) {
  world::World room = Room();
  room.initial.objects.push_back(MillAt(0.0));
  room.sources["mill1"] = "room.world:7";
  const std::string why = Why(MillAt(0.0), room, {"base", 0.25, 0.25});
  EXPECT_THAT(why,
              AllOf(HasSubstr("would begin inside of object 'mill1' of the world (room.world:7)"),
                    HasSubstr("x 1.200 m, y 2.000 m"), HasSubstr("0.250 m deep into its 'base'"),
                    HasSubstr("begins at area 'West' at x 1.000 m"), HasSubstr("another --from"),
                    HasSubstr("--put mill1:X,Y,Z")));
  EXPECT_THAT(why, Not(HasSubstr("origin")));
  const world::ObjectState moved = MillAt(0.1);
  EXPECT_THAT(Why(moved, room, {"base", 0.2, 0.2}), HasSubstr("give the height"))
      << "who put it elsewhere is told of the place";
}

TEST(StartChecksTest, TheModelsOriginIsBlamedWhereJustThatLiftsItOut) {
  world::World room = Room();
  world::ObjectModel sunk = Mill("sunk");
  for (geometry::Collision& shape : sunk.collisions) shape.X_BS.translation.z() -= 0.1;
  AddModel(&room, sunk);
  world::ObjectState object = MillAt(0.35);
  object.model = "sunk";
  EXPECT_THAT(Why(object, room, {"plate", 0.02, 0.1}),
              HasSubstr("reaches 0.100 m below its origin"));
  EXPECT_THAT(Why(object, room, {"plate", 0.02, 0.15}), HasSubstr("put it on a free place there"));
}

TEST(StartChecksTest, OfTwoMeshesNeitherIsInTheOtherWhereOneGoesRoundIt) {
  using hires::test_support::Shape;
  const std::vector<geometry::Collision> basket{
      Shape("basket", hires::test_support::Basket(), Eigen::Vector3d::Zero())};
  const std::vector<geometry::Collision> apple{
      Shape("apple", hires::test_support::BoxMesh({0.08, 0.08, 0.08}), {0.0, 0.0, 0.04})};
  const geometry::Pose3 X_inside{{0.05, 0.02, 0.011}, Eigen::Quaterniond::Identity()};
  EXPECT_FALSE(Overlap(basket, {}, apple, X_inside));
  EXPECT_FALSE(Overlap(apple, X_inside, basket, {}));
  const geometry::Pose3 X_wall{{0.19, 0.0, 0.011}, Eigen::Quaterniond::Identity()};
  EXPECT_TRUE(Overlap(basket, {}, apple, X_wall));
  EXPECT_TRUE(Overlap(apple, X_wall, basket, {}));
}

}  // namespace
}  // namespace hires::simulation::start_checks_test
