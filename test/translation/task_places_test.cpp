#include "hires/translation/task_places.h"

#include <gmock/gmock.h>

#include "support/restaurant_translation.h"

namespace hires::translation::task_places_test {
namespace {

using test_support::RestaurantContext;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

std::vector<std::string> PlacesOf(const std::string& concept_name,
                                  const std::vector<std::string>& arguments,
                                  const std::vector<knowledge::Fluent>& more = {}) {
  auto fluents = test_support::RestaurantFluents();
  knowledge::Fluent task;
  task.concept_name = concept_name;
  task.instance = "task1";
  for (const std::string& argument : arguments) {
    task.properties.push_back({"hasArgument", "xsd:string", argument});
  }
  fluents.push_back(task);
  for (const knowledge::Fluent& fluent : more) {
    for (knowledge::Fluent& known : fluents) {
      if (known.instance == fluent.instance) known = fluent;
    }
  }
  return PlacesOfTasks(RestaurantContext(), knowledge::LiveView(fluents, 1));
}

TEST(PlacesOfTasksTest, WithoutATaskThereIsNothingToLookAt) {
  const knowledge::LiveView view(test_support::RestaurantFluents(), 1);
  EXPECT_THAT(PlacesOfTasks(RestaurantContext(), view), IsEmpty());
}

TEST(PlacesOfTasksTest, APlacingAreaIsAPlace) {
  EXPECT_THAT(PlacesOf("PlaceObjectTask", {"rightArm1", "placingAreaWestLeftTable1"}),
              ElementsAre("placingareawestlefttable1"));
}

TEST(PlacesOfTasksTest, AGuestMeansThePlacesAtHisSeat) {
  EXPECT_THAT(PlacesOf("ServeCoffeeToGuestTask", {"guest1"}),
              UnorderedElementsAre("placingareawestlefttable1", "placingareawestrighttable1"));
}

TEST(PlacesOfTasksTest, AnObjectMeansWhereItStands) {
  EXPECT_THAT(PlacesOf("PickUpObjectTask", {"mug1", "rightArm1"}),
              ElementsAre("placingareaeastrightcounter1"));
}

TEST(PlacesOfTasksTest, WhatStandsOnTheTrayIsLookedAtItself) {
  knowledge::Fluent on;
  on.concept_name = "On";
  on.instance = "onMug1";
  on.properties = {{"hasPhysicalEntity", "Mug", std::string("mug1")},
                   {"hasArea", "TrayArea", std::string("trayArea1")}};
  EXPECT_THAT(PlacesOf("PickUpObjectTask", {"mug1"}, {on}), ElementsAre("mug1"));
}

TEST(PlacesOfTasksTest, AStandingAreaMeansTheFurnitureBeforeIt) {
  EXPECT_THAT(PlacesOf("MoveBaseTask", {"preManipulationAreaSouthTable1"}),
              UnorderedElementsAre("placingareaeastlefttable1", "placingareawestrighttable1"));
}

TEST(PlacesOfTasksTest, AMotionSetIsNoPlace) {
  EXPECT_THAT(PlacesOf("MoveBaseTask", {"fast"}), IsEmpty());
}

}  // namespace
}  // namespace hires::translation::task_places_test
