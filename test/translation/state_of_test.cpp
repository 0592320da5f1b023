#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "hires/base/error.h"
#include "hires/geometry/angles.h"
#include "hires/knowledge/state_view.h"
#include "hires/translation/classification.h"
#include "support/restaurant_translation.h"
#include "support/scenes.h"
#include "translation/stated_pose.h"

namespace hires::translation::state_of_test {
namespace {

using base::Atom;
using test_support::RestaurantContext;
using testing::HasSubstr;

const Atom kAtStart{"RobotAt", {"nearStartArea1"}};

GeometricState Build(std::vector<Atom> atoms, const knowledge::FluentView* view = nullptr) {
  atoms.push_back(kAtStart);
  return StateOf(RestaurantContext(), view, atoms);
}

std::string ErrorOf(const std::vector<Atom>& atoms) {
  try {
    StateOf(RestaurantContext(), nullptr, atoms);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

const world::ObjectState& Object(const GeometricState& state, const std::string& name) {
  const world::ObjectState* object = state.world.Find(name);
  if (object == nullptr) throw std::runtime_error("no object is called " + name);
  return *object;
}

/// The restaurant's knowledge with some fluents replaced or added.
knowledge::LiveView ViewWith(const std::vector<knowledge::Fluent>& changed) {
  auto fluents = test_support::RestaurantFluents();
  for (const knowledge::Fluent& fluent : changed) {
    const auto old = std::find_if(fluents.begin(), fluents.end(),
                                  [&](const auto& one) { return one.instance == fluent.instance; });
    if (old != fluents.end()) fluents.erase(old);
    fluents.push_back(fluent);
  }
  return knowledge::LiveView(fluents, 1);
}

knowledge::Fluent PoseAt(const std::string& instance, double x, double y, double z,
                         const std::string& frame = "") {
  knowledge::Fluent pose;
  pose.concept_name = "Pose";
  pose.instance = instance;
  pose.properties = {{"hasX", "xsd:float", x}, {"hasY", "xsd:float", y}, {"hasZ", "xsd:float", z}};
  if (!frame.empty()) pose.properties.push_back({"hasFrame", "xsd:string", frame});
  return pose;
}

TEST(AreasTest, KindsAndSizesAreThoseOfTheKnowledge) {
  const Areas& areas = RestaurantContext().areas;
  EXPECT_EQ(areas.Require("placingAreaEastRightCounter1").kind, AreaKind::kPlacing);
  EXPECT_EQ(areas.Require("placingAreaEastRightCounter1").size, Eigen::Vector2d(0.35, 0.65));
  EXPECT_EQ(areas.Require("sittingareawesttable1").kind, AreaKind::kSeat);
  EXPECT_EQ(areas.Require("floorareatamsrestaurant1").kind, AreaKind::kRoom);
  EXPECT_EQ(areas.Require("home").kind, AreaKind::kStanding);
  EXPECT_THROW(areas.Require("hom"), base::ConfigError);
}

// The world tells skills and rollouts, the knowledge tells the planner's state: the same rectangle.
TEST(AreasTest, WhatTheWorldSaysOfAPlaceIsWhatTheKnowledgeSays) {
  const knowledge::LiveView view = ViewWith({});
  const auto& extents = RestaurantContext().world->extents;
  ASSERT_FALSE(extents.empty());
  for (const auto& [name, extent_F] : extents) {
    const Area& area = RestaurantContext().areas.Require(name);
    EXPECT_LT((area.size - extent_F.sizes()).norm(), 1e-12) << name;
    const knowledge::Fluent* pose = view.Find("poseBoundingBox" + name);
    ASSERT_NE(pose, nullptr) << name;
    EXPECT_NEAR(*NumberOf(*pose, "hasX"), area.X_FA.translation.x(), 1e-9) << name;
    EXPECT_NEAR(*NumberOf(*pose, "hasY"), area.X_FA.translation.y(), 1e-9) << name;
  }
}

TEST(AreasTest, TheTrayIsTheRobotsShape) {
  const Area& tray = RestaurantContext().areas.Require(kTrayArea);
  EXPECT_EQ(tray.kind, AreaKind::kTray);
  EXPECT_EQ(tray.link, "base_tray_link");
  EXPECT_NEAR(tray.size.x(), 0.25, 0.02);
  EXPECT_NEAR(tray.size.y(), 0.658, 0.02);
}

TEST(StateOfTest, TheRobotStandsOnItsArea) {
  const auto state = StateOf(RestaurantContext(), nullptr, {{"RobotAt", {"HOME"}}});
  EXPECT_NEAR(state.robot.X_MB.x, 13.0, 1e-12);
  EXPECT_NEAR(state.robot.X_MB.y, 11.3, 1e-12);
}

TEST(StateOfTest, ARobotThatWasSeenAtTheAreaStaysWhereItWasSeen) {
  const auto near = ViewWith({PoseAt("posePR21", 13.1, 11.2, 0.0)});  // yaw 0: turned away
  EXPECT_NEAR(StateOf(RestaurantContext(), &near, {{"RobotAt", {"home"}}}).robot.X_MB.x, 13.0,
              1e-12);
  knowledge::Fluent pose = PoseAt("posePR21", 13.1, 11.2, 0.0);
  pose.properties.push_back({"hasYaw", "xsd:float", 3.1});
  const auto there = ViewWith({pose});
  const auto state = StateOf(RestaurantContext(), &there, {{"RobotAt", {"home"}}});
  EXPECT_NEAR(state.robot.X_MB.x, 13.1, 1e-12);
  EXPECT_NEAR(state.robot.X_MB.yaw, 3.1, 1e-12);
}

TEST(StateOfTest, PosturesSetJoints) {
  const auto state = Build({{"HasTorsoPosture", {"TorsoMiddlePosture"}},
                            {"HasArmPosture", {"leftArm1", "ArmToSidePosture"}}});
  EXPECT_EQ(state.robot.joints.at("torso_lift_joint"), 0.20);
  EXPECT_EQ(state.robot.joints.at("l_shoulder_pan_joint"), 2.115);
}

TEST(StateOfTest, AnObjectInTheHandIsBetweenTheFingersWhichAreAsFarOpen) {
  const auto state = Build(
      {{"HasArmPosture", {"rightarm1", "armuntuckedposture"}}, {"Holding", {"rightarm1", "mug1"}}});
  EXPECT_EQ(Object(state, "mug1").attached_to, "r_gripper_palm_link");
  EXPECT_EQ(Object(state, "mug1").model, "coffee_cup");
  EXPECT_NEAR(state.robot.joints.at("r_gripper_joint"), 0.08, 1e-9);
  const robot::Robot& pr2 = *RestaurantContext().robot;
  const auto X_BL = robot::ForwardKinematics(pr2.model, state.robot.joints);
  const auto X_MT = geometry::Lift(state.robot.X_MB) *
                    X_BL[*pr2.model.FindLink(pr2.profile.base_link)].Inverse() *
                    X_BL[*pr2.model.FindLink("r_gripper_tool_frame")];
  const Eigen::Vector3d grasped_M = Object(state, "mug1").X_MO * Eigen::Vector3d(0.0, 0.0, 0.04);
  EXPECT_LT((grasped_M - X_MT.translation).norm(), 1e-9);
}

TEST(StateOfTest, AnObjectThatWasSeenInTheHandIsWhereItWasSeen) {
  const auto view = ViewWith({PoseAt("poseMug1", 0.15, 0.01, -0.05, "r_gripper_palm_link")});
  const std::vector<Atom> held = {{"Holding", {"rightarm1", "mug1"}}};
  const robot::Robot& pr2 = *RestaurantContext().robot;
  const auto state = Build(held, &view);
  const auto X_BL = robot::ForwardKinematics(pr2.model, state.robot.joints);
  const auto X_MP = geometry::Lift(state.robot.X_MB) *
                    X_BL[*pr2.model.FindLink(pr2.profile.base_link)].Inverse() *
                    X_BL[*pr2.model.FindLink("r_gripper_palm_link")];
  const Eigen::Vector3d p_PO = X_MP.Inverse() * Object(state, "mug1").X_MO.translation;
  EXPECT_LT((p_PO - Eigen::Vector3d(0.15, 0.01, -0.05)).norm(), 1e-9);
  // The other hand has not seen it so.
  const auto other = Build({{"Holding", {"leftarm1", "mug1"}}}, &view);
  EXPECT_EQ(Object(other, "mug1").attached_to, "l_gripper_palm_link");
}

TEST(StateOfTest, AnObjectThatWasSeenOnTheAreaStaysThere) {
  const auto view = ViewWith({PoseAt("poseMug1", 5.42, 10.31, 0.751)});
  const auto state = Build({{"On", {"mug1", "placingAreaEastRightCounter1"}}}, &view);
  EXPECT_LT((Object(state, "mug1").X_MO.translation - Eigen::Vector3d(5.42, 10.31, 0.75)).norm(),
            1e-12);
  const auto moved = Build({{"On", {"mug1", "placingAreaWestLeftTable1"}}}, &view);
  EXPECT_LT((Object(moved, "mug1").X_MO.translation - Eigen::Vector3d(7.48, 11.62, 0.73)).norm(),
            1e-9);
}

TEST(StateOfTest, AnUprightObjectSeenNearATopStandsOnIt) {
  const auto height = [](double seen) {
    const auto view = ViewWith({PoseAt("poseMug1", 5.42, 10.31, seen)});
    return Object(Build({}, &view), "mug1").X_MO.translation.z();
  };
  for (const double error : {-0.07, -0.04, -0.005, 0.01, 0.025}) {
    EXPECT_NEAR(height(0.75 + error), 0.75, 1e-12) << "error = " << error;
  }
  EXPECT_DOUBLE_EQ(height(0.65), 0.65);  // on a shelf, perhaps
  EXPECT_DOUBLE_EQ(height(0.80), 0.80);  // it hangs or stands on something unknown: as it was seen
}

TEST(StateOfTest, ObjectsSeenInEachOtherStandSideBySide) {
  const auto view =
      ViewWith({PoseAt("poseMug1", 5.40, 10.30, 0.75), PoseAt("poseMug2", 5.40, 10.36, 0.75),
                PoseAt("posePeppermill1", 5.44, 10.30, 0.75)});
  const auto state = Build({}, &view);
  const auto at = [&](const char* name) -> Eigen::Vector3d {
    return Object(state, name).X_MO.translation;
  };
  const auto outline = [&](const char* name) {
    const world::ObjectState& object = Object(state, name);
    std::vector<Eigen::Vector2d> corners;
    for (const auto& collision : RestaurantContext().world->models.at(object.model)->collisions) {
      const auto part =
          geometry::OutlineInBand(collision.shape, object.X_MO * collision.X_BS, 0.75, 1.0);
      if (part) corners.insert(corners.end(), part->begin(), part->end());
    }
    return geometry::ConvexHull(corners);
  };
  EXPECT_GT(geometry::Distance(outline("mug1"), outline("mug2")), 0.0);
  EXPECT_GT(geometry::Distance(outline("mug1"), outline("peppermill1")), 0.0);
  EXPECT_GT(geometry::Distance(outline("mug2"), outline("peppermill1")), 0.0);
  EXPECT_LT((at("mug1") - Eigen::Vector3d(5.40, 10.30, 0.75)).norm(), 0.06);
  EXPECT_EQ(at("mug1").z(), 0.75);
  EXPECT_EQ(Build({}, &view).world.Find("mug1")->X_MO.translation, at("mug1")) << "each time";
}

TEST(StateOfTest, WhatWasSeenDeepInAnotherObjectIsLeftAsItIs) {
  const auto view =
      ViewWith({PoseAt("poseMug1", 5.40, 10.30, 0.75), PoseAt("poseMug2", 5.40, 10.30, 0.75),
                PoseAt("posePeppermill1", 5.40, 10.30, 0.75)});
  EXPECT_EQ(Object(Build({}, &view), "mug1").X_MO.translation, Eigen::Vector3d(5.40, 10.30, 0.75));
}

TEST(StateOfTest, AnObjectIsPutBesideTheOneThatIsThere) {
  const auto state = Build({{"On", {"mug1", "placingAreaWestLeftTable1"}},
                            {"On", {"mug2", "placingAreaWestLeftTable1"}}});
  const double apart =
      (Object(state, "mug1").X_MO.translation - Object(state, "mug2").X_MO.translation).norm();
  EXPECT_GT(apart, 0.08);
  EXPECT_LT(apart, 0.13);
}

TEST(StateOfTest, TheTrayFillsFromTheMiddle) {
  const auto state = Build({{"On", {"mug1", "trayArea1"}},
                            {"On", {"mug2", "trayArea1"}},
                            {"On", {"peppermill1", "trayArea1"}}});
  const geometry::Pose3 X_BM = geometry::Lift(state.robot.X_MB).Inverse();
  const auto y = [&](const char* name) {
    return (X_BM * Object(state, name).X_MO.translation).y();
  };
  EXPECT_NEAR(y("mug1"), 0.0, 1e-9);
  EXPECT_NEAR(y("mug2"), -0.13, 1e-9);
  EXPECT_NEAR(y("peppermill1"), 0.13, 1e-9);
}

TEST(StateOfTest, WhatIsSeenALittleBelowOrAboveTheTrayStandsOnIt) {
  const Area& tray = RestaurantContext().areas.Require(kTrayArea);
  const double surface =
      Object(Build({{"On", {"mug1", "trayArea1"}}}), "mug1").X_MO.translation.z();
  for (const double error : {-0.02, -0.006, 0.006, 0.02}) {  // [m] 5 mm is the detector's deviation
    const Eigen::Vector3d p_FO = tray.X_FA.translation + Eigen::Vector3d(0.02, 0.05, error);
    const auto view = ViewWith({PoseAt("poseMug1", p_FO.x(), p_FO.y(), p_FO.z(), tray.link)});
    const auto state = Build({{"On", {"mug1", "trayArea1"}}}, &view);
    const Eigen::Vector3d p_M = Object(state, "mug1").X_MO.translation;
    EXPECT_NEAR(p_M.z(), surface, 1e-9) << error;
    EXPECT_GT(
        (p_M - Object(Build({{"On", {"mug1", "trayArea1"}}}), "mug1").X_MO.translation).norm(),
        0.04)
        << "where it was seen, not in its slot";
  }
}

TEST(StateOfTest, ObjectsThatOnlyFluentsKnowStayWhereTheyWereSeen) {
  const knowledge::LiveView view(test_support::RestaurantFluents(), 1);
  const auto state = Build({{"On", {"mug1", "trayArea1"}}}, &view);
  EXPECT_EQ(state.world.objects.size(), 3u);
  EXPECT_EQ(Object(state, "mug2").X_MO.translation, Eigen::Vector3d(5.37, 9.94, 0.75));
  EXPECT_EQ(Object(state, "peppermill1").model, "peppermill_thesis");
}

/// Says of a thing of unknown kind, which is called unknown1, how large it is and where it stands.
std::vector<knowledge::Fluent> BoxAt(double x, double y, double z, const Eigen::Vector3d& size) {
  knowledge::Fluent thing, box;
  thing.concept_name = "UnknownObject";
  thing.instance = "unknown1";
  thing.properties = {{"hasPose", "Pose", "poseUnknown1"},
                      {"hasBoundingBox", "BoundingBox", "boundingBoxUnknown1"}};
  box.concept_name = "BoundingBox";
  box.instance = "boundingBoxUnknown1";
  box.properties = {{"hasXSize", "xsd:float", size.x()},
                    {"hasYSize", "xsd:float", size.y()},
                    {"hasZSize", "xsd:float", size.z()}};
  return {thing, box, PoseAt("poseUnknown1", x, y, z)};
}

TEST(StateOfTest, ABoxSeenInFurnitureThatNothingCarriesIsThatFurniture) {
  const auto is_there = [](double x, double y, double z, const Eigen::Vector3d& size) {
    const auto view = ViewWith(BoxAt(x, y, z, size));
    const TranslatorContext known = WithKnowledge(RestaurantContext(), view);
    return StateOf(known, &view, {kAtStart}).world.Find("unknown1") != nullptr;
  };
  const Eigen::Vector3d strip(0.06, 0.41, 0.17);
  EXPECT_FALSE(is_there(8.49, 11.42, 0.73, strip)) << "the back of chair2, as high as the table";
  EXPECT_TRUE(is_there(8.75, 11.42, 0.73, strip)) << "in no furniture: somebody holds it, perhaps";
  EXPECT_TRUE(is_there(7.48, 11.62, 0.73, strip)) << "the table carries it";
  EXPECT_TRUE(is_there(7.48, 11.62, 0.68, strip)) << "likewise, seen too low: it is put on top";
}

TEST(StateOfTest, WhatWasOnTheRobotAndIsNamedByNoAtomIsLeftOut) {
  const auto view = ViewWith({PoseAt("poseMug1", 0.15, 0.0, 0.0, "r_gripper_palm_link")});
  EXPECT_EQ(Build({}, &view).world.Find("mug1"), nullptr);
}

TEST(StateOfTest, TheWholeStateOfTheBlackboardCanBeBuilt) {
  const knowledge::LiveView view(test_support::RestaurantFluents(), 1);
  const auto atoms = knowledge::StateAtoms(view, *RestaurantContext().ontology);
  const auto state = StateOf(RestaurantContext(), &view, atoms);
  EXPECT_NEAR(state.robot.X_MB.x, 12.5, 1e-12) << "seen at its start, said to be in the room";
  EXPECT_EQ(state.world.objects.size(), 3u);
}

TEST(StateOfTest, ARobotWithoutArmsTakesPosturesForGranted) {
  const TranslatorContext context =
      MakeContext(test_support::Room(), test_support::TrayRobot(), {}, nullptr);
  const auto state = StateOf(context, nullptr,
                             {{"RobotAt", {"West"}},
                              {"HasArmPosture", {"leftarm1", "armtucked"}},
                              {"Holding", {"leftarm1", "nothing"}},
                              {"On", {"mill", "trayArea1"}}});
  ASSERT_EQ(state.world.objects.size(), 1u);
  EXPECT_NEAR(state.world.objects[0].X_MO.translation.z(), 0.35, 0.01);
}

TEST(StateOfTest, InAWorldWithoutRoomsARobotIsOnItsFloorWhereItIsSeen) {
  const TranslatorContext context = MakeContext(test_support::Room(), test_support::TrayRobot(), {},
                                                RestaurantContext().ontology);
  const auto view = ViewWith({PoseAt("posePR21", 0.4, 0.3, 0.0)});
  const GeometricState state = StateOf(context, &view, {{"RobotAt", {"floorArea"}}});
  EXPECT_EQ(state.robot.X_MB.x, 0.4);
  EXPECT_EQ(state.robot.X_MB.y, 0.3);
  const std::vector<Atom> atoms = AtomsOf(context, state);
  const auto said = std::find_if(atoms.begin(), atoms.end(),
                                 [](const Atom& atom) { return atom.predicate == "RobotAt"; });
  ASSERT_NE(said, atoms.end());
  EXPECT_THAT(said->arguments, testing::ElementsAre(kFloorArea));
}

TEST(StateOfTest, NobodyKnowsWhereOnTheFloorARobotIsThatNobodySees) {
  const TranslatorContext context =
      MakeContext(test_support::Room(), test_support::TrayRobot(), {}, nullptr);
  try {
    StateOf(context, nullptr, {{"RobotAt", {"floorArea"}}});
    FAIL() << "no error";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("nothing says where on the floor"));
  }
}

TEST(StateOfTest, AnInstanceTheCatalogueLacksIsLikeItsKin) {
  EXPECT_EQ(RestaurantContext().ModelOf("mug7"), "coffee_cup");
  EXPECT_EQ(RestaurantContext().FindModel("teapot1"), "");
}

TEST(StateOfTest, AnInstanceNamedByItsModelIsOne) {
  EXPECT_EQ(RestaurantContext().ModelOf("peppermill_repository1"), "peppermill_repository");
}

TEST(StateOfTest, WhatIsKnownOfAnObjectBesideItsPlaceChangesNothing) {
  const auto state = [](const std::vector<base::Atom>& more) {
    std::vector<base::Atom> atoms{kAtStart, {"On", {"mug1", "trayArea1"}}};
    atoms.insert(atoms.end(), more.begin(), more.end());
    return StateOf(RestaurantContext(), nullptr, atoms).world.objects;
  };
  const auto plain = state({});
  const auto warm = state({{"HasTemperature", {"mug1", "62.5"}}, {"TemperatureKnown", {"mug1"}}});
  ASSERT_EQ(plain.size(), warm.size());
  EXPECT_EQ(plain[0].X_MO.translation, warm[0].X_MO.translation);
}

TEST(StateOfTest, ErrorsNameTheAtomAndWhatComesNear) {
  EXPECT_THAT(ErrorOf({}), HasSubstr("RobotAt(area) is missing"));
  EXPECT_THAT(ErrorOf({{"RobotAt", {"hime"}}}),
              HasSubstr("RobotAt(hime): area 'hime' is unknown; did you mean 'home'"));
  EXPECT_THAT(ErrorOf({{"RobotAt", {"sittingAreaWestTable1"}}}),
              HasSubstr("is no area for the robot's base"));
  EXPECT_THAT(ErrorOf({{"RobotAt", {"home", "nearStartArea1"}}}),
              HasSubstr("has 2 arguments, wanted 1"));
  EXPECT_THAT(ErrorOf({{"RobotAt", {"home"}}, kAtStart}), HasSubstr("contradicts"));
  EXPECT_THAT(ErrorOf({kAtStart, {"On", {"mug1", "sittingAreaWestTable1"}}}),
              HasSubstr("On(mug1, sittingAreaWestTable1): is no area to put things on"));
  EXPECT_THAT(ErrorOf({kAtStart, {"On", {"teapot1", "trayArea1"}}}),
              HasSubstr("object 'teapot1' is unknown"));
  EXPECT_THAT(ErrorOf({kAtStart, {"HasArmPosture", {"leftarm1", "armtuckposture"}}}),
              HasSubstr("did you mean 'armtuckedposture'"));
  EXPECT_THAT(ErrorOf({kAtStart, {"HasArmPosture", {"arm3", "armtuckedposture"}}}),
              HasSubstr("arm 'arm3' is unknown"));
  EXPECT_THAT(ErrorOf({kAtStart, {"HasTorsoPosture", {"torsotopposture"}}}),
              HasSubstr("torso posture 'torsotopposture' is unknown"));
  EXPECT_THAT(ErrorOf({kAtStart, {"Grasping", {"leftarm1"}}}),
              HasSubstr("predicate 'Grasping' is unknown"));
  EXPECT_THAT(
      ErrorOf({kAtStart, {"Holding", {"leftarm1", "mug1"}}, {"Holding", {"leftarm1", "mug2"}}}),
      HasSubstr("contradicts what another atom says of this hand: 'mug1'"));
  EXPECT_THAT(
      ErrorOf({kAtStart, {"Holding", {"leftarm1", "mug1"}}, {"Holding", {"rightarm1", "mug1"}}}),
      HasSubstr("who holds this object"));
  EXPECT_THAT(ErrorOf({kAtStart, {"Holding", {"leftarm1", "mug1"}}, {"On", {"mug1", "trayArea1"}}}),
              HasSubstr("contradicts Holding(leftarm1, mug1)"));
  std::vector<Atom> crowd = {kAtStart};
  for (int i = 1; i <= 20; ++i) crowd.push_back({"On", {"bowl" + std::to_string(i), "trayarea1"}});
  EXPECT_THAT(ErrorOf(crowd), HasSubstr("there is no room left on the tray"));
}

TEST(StateOfTest, ARobotWithoutATrayCarriesNothing) {
  robot::Robot robot = test_support::TrayRobot();
  robot.profile.tray_link.clear();
  const TranslatorContext context = MakeContext(test_support::Room(), robot, {}, nullptr);
  try {
    StateOf(context, nullptr, {{"RobotAt", {"West"}}, {"On", {"mill", "trayArea1"}}});
    FAIL() << "a mill stands on no tray";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("robot 'tray_robot' has no tray"));
  }
}

}  // namespace
}  // namespace hires::translation::state_of_test
