// Where the restaurant says that the robot may stand, the PR2 can stand with its load.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "hires/robot/robot_profile.h"
#include "hires/simulation/robot_clearance.h"
#include "hires/simulation/scene.h"
#include "hires/world/object_catalogue.h"

namespace hires::simulation::areas_test {
namespace {

const std::string kRoot = HIRES_SOURCE_DIR;

const Scene& Restaurant() {
  static const auto scene = MakeScene(world::LoadWorld(kRoot + "/worlds/restaurant.world"),
                                      robot::LoadRobot(kRoot + "/config/robots/pr2.yaml"));
  return *scene;
}

/// The pepper mill on the tray, in the base frame.
std::vector<geometry::Collision> Mill() {
  const world::ObjectModel mill =
      world::FindObjectModel("peppermill1", kRoot + "/worlds/objects.yaml");
  std::vector<geometry::Collision> shapes = mill.collisions;
  for (geometry::Collision& shape : shapes) {
    shape.name = "mill";
    shape.X_BS = Restaurant().X_BO * shape.X_BS;
  }
  return shapes;
}

const RobotClearance& WithMill() {
  static const RobotClearance clearance = [] {
    std::vector<geometry::Collision> shapes = Restaurant().robot_shapes_B;
    for (const geometry::Collision& shape : Mill()) shapes.push_back(shape);
    return RobotClearance(shapes, Restaurant().world);
  }();
  return clearance;
}

geometry::Pose2 Area(const std::string& name) {
  const auto X_MA = Restaurant().world.FindFrame(name);
  if (!X_MA) ADD_FAILURE() << "no area " << name;
  return geometry::Flatten(X_MA.value_or(geometry::Pose3{}));
}

std::vector<std::string> StandingAreas() {
  std::vector<std::string> areas;
  for (const std::string& name : Restaurant().world.FrameNames()) {
    const bool is_for_arms = name.find("anipulationArea") != std::string::npos;
    if (is_for_arms || name == "home" || name == "nearStartArea1") areas.push_back(name);
  }
  return areas;
}

void ExpectFree(const RobotClearance& clearance, const std::string& area) {
  const auto contact = clearance.FindContact(Area(area));
  EXPECT_FALSE(contact) << area << ": " << contact->robot_part << " touches " << contact->obstacle;
}

TEST(AreasTest, TheLoadedPr2StandsFreeWhereverItMayStand) {
  EXPECT_EQ(StandingAreas().size(), 12u);
  for (const std::string& area : StandingAreas()) ExpectFree(WithMill(), area);
}

TEST(AreasTest, TheMillWouldTouchTheCounterFromWhereItsPoseWasRecorded) {
  const auto contact = RobotClearance(Mill(), Restaurant().world).FindContact({5.9, 10.11, 3.14});
  ASSERT_TRUE(contact);
  EXPECT_EQ(contact->obstacle, "counter1::slab");
}

TEST(AreasTest, TheMillsTopIsAboveTheLowerFaceOfTheSlab) {
  const geometry::Collision mill = Mill().at(0);
  const double top = geometry::BoundsOf(mill.shape, mill.X_BS).upper.z();
  EXPECT_NEAR(top, 0.620, 5e-4);
  const auto& statics = Restaurant().world.statics;
  const auto counter = std::find_if(statics.begin(), statics.end(),
                                    [](const auto& body) { return body.name == "counter1"; });
  ASSERT_NE(counter, statics.end());
  double slab_bottom = 0.0;  // [m] of the highest part
  for (const geometry::Collision& part : counter->collisions) {
    const double bottom = geometry::BoundsOf(part.shape, counter->X_MB * part.X_BS).lower.z();
    slab_bottom = std::max(slab_bottom, bottom);
  }
  EXPECT_NEAR(slab_bottom, 0.61, 1e-9);
  EXPECT_GT(top, slab_bottom);
}

}  // namespace
}  // namespace hires::simulation::areas_test
