#include "cli/verbs/imagine/imagine_start.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/messages.h"
#include "support/scenes.h"

namespace hires::cli::imagine_start_test {
namespace {

using hires::test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> Texts(const std::vector<base::Atom>& atoms) {
  std::vector<std::string> texts;
  for (const base::Atom& atom : atoms) texts.push_back(base::ToString(atom));
  return texts;
}

StartOptions AtDoor() {
  StartOptions options;
  options.from = "Door";
  return options;
}

TEST(ImagineStartTest, SaysWhatHolds) {
  StartOptions options = AtDoor();
  options.on_tray = {"mill1"};
  options.in_hand = {"mug1:rightArm1"};
  options.postures = {"torso1:TorsoUpPosture", "rightArm1:ArmCarryPosture"};
  options.put = {"bowl1:table"};
  const ImagineStart start = ReadStart(options, "place_object", actions::OwnActions());
  EXPECT_THAT(Texts(start.AllAtoms()), ElementsAre("RobotAt(Door)", "On(mill1, trayArea1)",
                                                   "HasTorsoPosture(TorsoUpPosture)",
                                                   "HasArmPosture(rightArm1, ArmCarryPosture)",
                                                   "Holding(rightArm1, mug1)", "On(bowl1, table)"));
  EXPECT_TRUE(start.put.empty());
}

TEST(ImagineStartTest, AnArmThatHoldsSomethingIsWhereTheStepBeforeLeavesIt) {
  StartOptions options = AtDoor();
  options.in_hand = {"mug1:rightArm1"};
  EXPECT_EQ(base::ToString(ReadStart(options, "place_object", actions::OwnActions()).atoms.back()),
            "HasArmPosture(rightArm1, ArmToSidePosture)");
  EXPECT_EQ(base::ToString(ReadStart(options, "move_base", actions::OwnActions()).atoms.back()),
            "HasArmPosture(rightArm1, ArmCarryPosture)");
}

TEST(ImagineStartTest, ReadsPlacesInNumbers) {
  StartOptions options = AtDoor();
  options.put = {"book1:table:0.1,-0.2", "book2:table:0.1,-0.2,1.5", "bowl1:1,2,0.7",
                 "bowl2:1,2,0.7,-1"};
  const std::vector<imagination::PutObject> put =
      ReadStart(options, "move_base", actions::OwnActions()).put;
  ASSERT_EQ(put.size(), 4u);
  EXPECT_EQ(put[0].object, "book1");
  EXPECT_EQ(put[0].area, "table");
  EXPECT_EQ(put[0].X_AO.translation, Eigen::Vector3d(0.1, -0.2, 0.0));
  EXPECT_NEAR(geometry::YawOf(put[1].X_AO.rotation), 1.5, 1e-12);
  EXPECT_EQ(put[2].area, "");
  EXPECT_EQ(put[2].X_AO.translation, Eigen::Vector3d(1.0, 2.0, 0.7));
  EXPECT_NEAR(geometry::YawOf(put[3].X_AO.rotation), -1.0, 1e-12);
}

TEST(ImagineStartTest, RefusesWhatItCannotRead) {
  const auto why_not = [](StartOptions options, const std::string& action = "move_base") {
    return ConfigErrorOf([&] { ReadStart(options, action, actions::OwnActions()); });
  };
  for (const char* put :
       {"book1", "book1:", ":table", "book1:table:0.1", "book1:table:0.1,0.2,0.3,1", "book1:1,2",
        "book1:1,x,3", "book1:table:nan,0", "a:b:c:d"}) {
    StartOptions options = AtDoor();
    options.put = {put};
    EXPECT_THAT(why_not(options), AllOf(HasSubstr(put), HasSubstr("OBJECT:AREA:X,Y[,YAW]"))) << put;
  }
  StartOptions options = AtDoor();
  options.put = {"book1:1,2,-0.1"};
  EXPECT_THAT(why_not(options), AllOf(HasSubstr("'book1:1,2,-0.1'"), HasSubstr("below the floor")));
  for (const char* put : {"book1:1,2,0,90", "book1:table:0.1,0.2,-45", "book1:1,2,0,6.3"}) {
    options.put = {put};
    EXPECT_THAT(why_not(options), AllOf(HasSubstr(put), HasSubstr("wanted radians"))) << put;
  }
  for (const std::vector<std::string>& objects : std::vector<std::vector<std::string>>{
           {"mug1", "mug1"}, {"mug1", "book1", "Mug1"}, {"a.sdf", "a.sdf"}}) {
    options = AtDoor();
    options.on_tray = objects;
    EXPECT_THAT(why_not(options), AllOf(HasSubstr(objects.back()), HasSubstr("came twice")));
  }
  options = AtDoor();
  options.in_hand = {"mug1"};
  EXPECT_THAT(why_not(options),
              AllOf(HasSubstr("--object-in-hand 'mug1'"), HasSubstr("OBJECT:ARM")));
  options.in_hand = {"mug1:rightArm1"};
  EXPECT_THAT(why_not(options, "fly"), HasSubstr("action 'fly' is unknown"));
  options = AtDoor();
  options.postures = {"TorsoUpPosture"};
  EXPECT_THAT(why_not(options), AllOf(HasSubstr("--posture"), HasSubstr("ARM:POSTURE")));
}

TEST(ReadAreaTest, ReadsOneTurnOfYawAndRefusesDegrees) {
  EXPECT_EQ(ReadAreas({"kitchen:3.2,1.0,-1.57"}).at(0).X_MA.yaw, -1.57);
  EXPECT_NO_THROW(ReadAreas({"kitchen:3.2,1.0,6.28"}));
  for (const auto& [text, radians] :
       {std::pair("kitchen:3.2,1.0,90", "90 degrees are 1.5708"),
        std::pair("kitchen:3.2,1.0,-180", "-180 degrees are -3.1416")}) {
    EXPECT_THAT(ConfigErrorOf([&] { ReadAreas({text}); }),
                AllOf(HasSubstr(text), HasSubstr("wanted radians"), HasSubstr(radians)));
  }
}

TEST(RequireObjectsTest, WhatAnActionIsAboutMustBeSomewhere) {
  world::WorldState world;
  world.objects.resize(2);
  world.objects[0].name = "mug1";
  world.objects[1].name = "bowl1";
  world.objects[1].attached_to = "r_gripper_palm_link";
  const auto error = [&](const base::ActionCall& action) {
    return ConfigErrorOf([&] { RequireObjects(actions::OwnActions(), {action}, world); });
  };
  EXPECT_THAT(error({"pick_up_object", {"mug2", "rightarm1"}}),
              AllOf(HasSubstr("mug2 is nowhere"), HasSubstr("--put mug2:AREA")));
  EXPECT_THAT(error({"place_object", {"mug1", "rightarm1", "table"}}),
              HasSubstr("mug1 is in no hand; wanted --object-in-hand mug1:ARM"));
  for (const base::ActionCall& action :
       {base::ActionCall{"pick_up_object", {"Mug1", "rightarm1"}},
        base::ActionCall{"place_object", {"bowl1", "rightarm1", "table"}},
        base::ActionCall{"move_base", {"door"}}}) {
    EXPECT_NO_THROW(RequireObjects(actions::OwnActions(), {action}, world)) << action.name;
  }
}

TEST(RequirePosturesTest, OfARobotThatIsABaseAloneNoneIsPassedOver) {
  robot::Robot robot = hires::test_support::TrayRobot();
  const auto why_not = [&](const std::vector<std::string>& postures) {
    StartOptions options = AtDoor();
    options.postures = postures;
    const ImagineStart start = ReadStart(options, "move_base", actions::OwnActions());
    return ConfigErrorOf([&] { RequirePostures(start, robot); });
  };
  for (const char* posture : {"torso1:TorsoUpPosture", "rightArm1:ArmCarryPosture"}) {
    EXPECT_THAT(why_not({posture}),
                AllOf(HasSubstr("--posture "), HasSubstr("'tray_robot' has a base alone")));
  }
  EXPECT_EQ(why_not({}), "(no ConfigError was thrown)");
  robot.profile.upper_body.emplace();
  EXPECT_EQ(why_not({"torso1:TorsoUpPosture"}), "(no ConfigError was thrown)");
}

TEST(AreaFilesOfTest, FilesAreToldFromAreas) {
  EXPECT_EQ(AreaFilesOf({"dock:1,2,0", "goals.yaml", "a/points.yml", "b:0,0,1.5"}),
            (std::vector<std::string>{"goals.yaml", "a/points.yml"}));
}

}  // namespace
}  // namespace hires::cli::imagine_start_test
