#include "imagination/object_support.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "hires/base/text.h"
#include "support/scenes.h"

namespace hires::imagination::object_support_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A hall with a table of 0.75 m that stands on its plate alone, as furniture of plates does.
world::World HallWithTable() {
  world::World hall;
  hall.statics = {hires::test_support::Block("plate", {1.0, 0.8, 0.05}, {3.0, 0.0, 0.725})};
  auto cup = std::make_shared<world::ObjectModel>();
  cup->name = "cup";
  cup->collisions = {
      hires::test_support::Shape("c", geometry::Cylinder{0.04, 0.1}, {0.0, 0.0, 0.05})};
  hall.models["cup"] = cup;
  return hall;
}

TEST(ObjectSupportTest, WhatStandsNowhereIsSaid) {
  world::World hall = HallWithTable();
  const auto why_not = [&](const std::vector<Eigen::Vector3d>& places) {
    std::vector<std::string> names;
    world::WorldState state;
    for (std::size_t i = 0; i < places.size(); ++i) {
      names.push_back("cup" + std::to_string(i + 1));
      world::ObjectState cup;
      cup.name = names.back();
      cup.model = "cup";
      cup.X_MO = geometry::Lift({places[i].x(), places[i].y(), 0.0}, places[i].z());
      state.objects.push_back(cup);
    }
    return base::Join(WhyUnsupported(names, state, hall, {}, 0.5), "; ");
  };
  for (const std::vector<Eigen::Vector3d>& right :
       std::vector<std::vector<Eigen::Vector3d>>{{{1.0, 0.0, 0.0}},    // the floor
                                                 {{1.0, 0.0, 0.05}},   // let go just above it
                                                 {{3.0, 0.0, 0.75}},   // the table
                                                 {{3.52, 0.0, 0.75}},  // over its edge
                                                 {{3.0, 0.0, 0.75}, {3.0, 0.0, 0.85}},  // a stack
                                                 {{3.0, 0.0, 0.0}},     // below the table
                                                 {{0.2, 0.0, 0.9}}}) {  // the robot
    EXPECT_EQ(why_not(right), "") << right.back().transpose();
  }
  EXPECT_THAT(why_not({{1.0, 0.0, 5.0}}),
              AllOf(HasSubstr("'cup1'"), HasSubstr("5 m over the floor"), HasSubstr("height")));
  EXPECT_THAT(why_not({{3.0, 0.0, 1.0}}), HasSubstr("0.25 m over 'plate'"));
  EXPECT_THAT(why_not({{3.0, 0.0, 0.5}}), HasSubstr("0.5 m over the floor"));
  EXPECT_THAT(why_not({{1.0, 0.0, 0.0}, {1.0, 0.0, 0.3}}), HasSubstr("0.2 m over 'cup1'"));
  for (const double depth : {-0.2, -5.0, -100.0})
    EXPECT_THAT(why_not({{1.0, 0.0, depth}}), HasSubstr("'cup1' would lie below the floor"));
  EXPECT_EQ(why_not({{1.0, 0.0, -0.05}}), "") << "seen with an error";
  hall.ground_depth = 3.0;
  EXPECT_EQ(why_not({{1.0, 0.0, -2.5}}), "") << "it may stand on the ground there";
}

TEST(ObjectSupportTest, WhatIsHeldOrIsNowhereNeedsNone) {
  world::WorldState state;
  world::ObjectState cup;
  cup.name = cup.model = "cup";
  cup.X_MO = geometry::Lift({1.0, 0.0, 0.0}, 1.2);
  cup.attached_to = "r_gripper_palm_link";
  state.objects.push_back(cup);
  EXPECT_THAT(WhyUnsupported({"cup", "bowl"}, state, HallWithTable(), {}, 0.5), IsEmpty());
}

}  // namespace
}  // namespace hires::imagination::object_support_test
