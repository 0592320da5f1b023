#include "hires/skills/skill_factory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "restaurant.h"
#include "support/messages.h"
#include "support/scenes.h"

namespace hires::skills::skill_factory_test {
namespace {

using hires::test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::HasSubstr;

const SkillSet& RoomSkills() {
  static const SkillSet skills =
      MakeSkillSet(hires::test_support::Room(), hires::test_support::TrayRobot(), {}, {});
  return skills;
}

std::string WhyNot(const std::string& name, const std::vector<std::string>& arguments) {
  return ConfigErrorOf([&] { MakeSkill(RoomSkills(), {name, arguments}); });
}

/// How fast the robot is told to drive at first from `X_MB`.
std::optional<robot::MotionSet> MotionSetOf(const base::ActionCall& action) {
  const auto skill = MakeSkill(RoomSkills(), action);
  robot::Observation seen;
  seen.X_MB = {1.0, 2.0, 0.0};
  robot::Command command;
  skill->Update(seen, &command);
  return command.motion_set;
}

TEST(SkillFactoryTest, MakesEachActionWhateverItsCase) {
  EXPECT_EQ(MotionSetOf({"move_base", {"east"}})->max_linear_velocity, 0.55);  // default: fast
  EXPECT_EQ(MotionSetOf({"Move_Base_Param", {"EAST", "Slow"}})->max_linear_velocity, 0.30);
  EXPECT_EQ(MotionSetOf({"move_base_blind", {"East"}})->max_linear_velocity, 0.55);
}

TEST(SkillFactoryTest, TheSkillsHaveTheirOwnPeriods) {
  EXPECT_EQ(MakeSkill(RoomSkills(), {"move_base", {"east"}})->period(),
            navigation::DwaParams{}.control_period);
  EXPECT_EQ(MakeSkill(RoomSkills(), {"move_base_blind", {"east"}})->period(),
            MoveBaseBlindParams{}.period);
}

TEST(SkillFactoryTest, RefusesUnknownActions) {
  EXPECT_THAT(WhyNot("move_bass", {"east"}),
              AllOf(HasSubstr("move_bass(east)"), HasSubstr("action 'move_bass' is unknown"),
                    HasSubstr("did you mean 'move_base'")));
  EXPECT_THAT(WhyNot("", {}), HasSubstr("action '' is unknown"));
}

TEST(SkillFactoryTest, RefusesToDriveToAnotherStorey) {
  world::World room = hires::test_support::Room();
  room.statics.push_back(hires::test_support::Block("gallery", {2.0, 2.0, 0.1}, {4.5, 2.0, 1.95}));
  hires::test_support::AddArea(&room, "Up", geometry::Lift({4.5, 2.0, 0.0}, 2.0));
  const SkillSet skills = MakeSkillSet(room, hires::test_support::TrayRobot(), {}, {});
  for (const char* drive : {"move_base", "move_base_blind"}) {
    EXPECT_THAT(
        ConfigErrorOf([&] {
          MakeSkill(skills, {drive, {"up"}});
        }),
        AllOf(HasSubstr("'up' stands on 'gallery', 2.00 m higher"), HasSubstr("one level")));
    EXPECT_NO_THROW(MakeSkill(skills, {drive, {"east"}}));
  }
}

TEST(SkillFactoryTest, RefusesUnknownAreas) {
  EXPECT_THAT(WhyNot("move_base", {"weast"}),
              AllOf(HasSubstr("move_base(weast)"), HasSubstr("area 'weast' is unknown"),
                    HasSubstr("'east'"), HasSubstr("'west'")));
  EXPECT_THAT(WhyNot("move_base_blind", {""}), HasSubstr("area '' is unknown"));
}

TEST(SkillFactoryTest, RefusesUnknownMotionSets) {
  EXPECT_THAT(WhyNot("move_base_param", {"east", "fats"}),
              AllOf(HasSubstr("motion set 'fats' is unknown"), HasSubstr("did you mean 'fast'")));
}

TEST(SkillFactoryTest, RefusesTheWrongNumberOfArguments) {
  EXPECT_THAT(WhyNot("move_base", {}),
              AllOf(HasSubstr("has 0 arguments"), HasSubstr("wanted 1 (area)")));
  EXPECT_THAT(WhyNot("move_base", {"east", "fast"}), HasSubstr("has 2 arguments, wanted 1 (area)"));
  EXPECT_THAT(WhyNot("move_base_param", {"east"}),
              HasSubstr("has 1 argument, wanted 2 (area, motion_set)"));
}

TEST(SkillFactoryTest, KnowsTheAreasOfTheWorldFlat) {
  EXPECT_EQ(RoomSkills().areas.size(), 3u);
  EXPECT_EQ(RoomSkills().areas.at("corner").y, 3.0);
}

// ------------------------------------------------------------------------------- upper body

std::string WhyNotInRestaurant(const base::ActionCall& action) {
  return ConfigErrorOf([&] { MakeSkill(test_support::TheRestaurant().skills, action); });
}

/// A name of the restaurant for each parameter of an action.
base::ActionCall SampleOf(const actions::ActionSpec& spec) {
  using Kind = actions::ParameterKind;
  const std::map<Kind, std::string> samples{{Kind::kArea, "placingAreaWestRightTable1"},
                                            {Kind::kMotionSet, "slow"},
                                            {Kind::kTorsoPosture, "TorsoMiddlePosture"},
                                            {Kind::kArmPosture, "ArmUnTuckedPosture"},
                                            {Kind::kArm, "leftArm1"},
                                            {Kind::kObject, "mug1"},
                                            {Kind::kAreaOrObject, "mug1"},
                                            {Kind::kSpot, "front_left"},
                                            {Kind::kBasePlace, "Behind"}};
  base::ActionCall call{spec.name, {}};
  for (const auto& parameter : spec.parameters)
    call.arguments.push_back(samples.at(parameter.kind));
  return call;
}

TEST(SkillFactoryUpperBodyTest, MakesEveryActionThatIsDescribed) {
  for (const auto& [name, spec] : actions::OwnActions().specs()) {
    const base::ActionCall action = SampleOf(spec);
    EXPECT_NE(MakeSkill(test_support::TheRestaurant().skills, action), nullptr)
        << base::ToString(action);
  }
}

TEST(SkillFactoryUpperBodyTest, ARobotWithoutArmsHasNoneOfTheirSkills) {
  EXPECT_THAT(WhyNot("tuck_arms", {"armtuckedposture", "armtuckedposture"}),
              AllOf(HasSubstr("tuck_arms(armtuckedposture, armtuckedposture)"),
                    HasSubstr("robot 'tray_robot' has no upper body"), HasSubstr("upper_body")));
  EXPECT_THAT(WhyNot("look_at", {"east"}), HasSubstr("has no upper body"));
}

TEST(SkillFactoryUpperBodyTest, RefusesUnknownArmsPosturesAndAreas) {
  EXPECT_THAT(WhyNotInRestaurant({"move_arm_to_side", {"middleArm1"}}),
              AllOf(HasSubstr("move_arm_to_side(middleArm1)"), HasSubstr("arm 'middleArm1'"),
                    HasSubstr("rightarm1")));
  EXPECT_THAT(WhyNotInRestaurant({"pick_up_object", {"mug1", "rightarm2"}}),
              AllOf(HasSubstr("arm 'rightarm2' is unknown"), HasSubstr("'rightarm1'")));
  EXPECT_THAT(WhyNotInRestaurant({"move_torso", {"torsotopposture"}}),
              AllOf(HasSubstr("torso posture 'torsotopposture'"), HasSubstr("torsoupposture")));
  EXPECT_THAT(WhyNotInRestaurant({"tuck_arms", {"armcarryposture", "armtuckedposture"}}),
              AllOf(HasSubstr("goal of an arm 'armcarryposture'"), HasSubstr("armtuckedposture")));
  EXPECT_THAT(WhyNotInRestaurant(
                  {"place_object_at", {"mug1", "rightarm1", "placingAreaWestRightTable1", "frnt"}}),
              AllOf(HasSubstr("place_object_at("), HasSubstr("spot 'frnt' is unknown"),
                    HasSubstr("'front'")));
  EXPECT_THAT(WhyNotInRestaurant({"observe_objects_at",
                                  {"placingAreaWestRightTable1", "manipulationAreaSouthTable1",
                                   "torsoupposture", "lefft"}}),
              AllOf(HasSubstr("base place 'lefft' is unknown"), HasSubstr("'left'")));
  EXPECT_THAT(WhyNotInRestaurant({"place_object", {"mug1", "rightarm1", "placingAreaMoon1"}}),
              HasSubstr("area 'placingAreaMoon1' is unknown"));
  EXPECT_THAT(WhyNotInRestaurant({"observe_objects_on_area", {"mug1"}}),
              HasSubstr("area 'mug1' is unknown"));
}

TEST(SkillFactoryUpperBodyTest, RefusesTheWrongNumberOfArguments) {
  EXPECT_THAT(WhyNotInRestaurant({"move_arms_to_carryposture", {"rightarm1"}}),
              HasSubstr("has 1 argument, wanted 0 (none)"));
  EXPECT_THAT(WhyNotInRestaurant({"place_object", {"mug1", "rightarm1"}}),
              HasSubstr("has 2 arguments, wanted 3 (object, arm, area)"));
  EXPECT_THAT(WhyNotInRestaurant({"place_on_tray", {"mug1"}}), HasSubstr("wanted 2 (arm, object)"));
}

TEST(SkillFactoryUpperBodyTest, ARobotWithoutTrayPutsNothingOnIt) {
  robot::Robot robot = test_support::TheRestaurant().scene->robot;
  robot.profile.tray_link.clear();
  const SkillSet skills = MakeSkillSet(test_support::TheRestaurant().scene->world, robot, {}, {});
  for (const base::ActionCall& action :
       {base::ActionCall{"place_on_tray", {"rightarm1", "mug1"}},
        base::ActionCall{"pick_up_from_tray", {"rightarm1", "mug1"}}}) {
    EXPECT_THAT(ConfigErrorOf([&] { MakeSkill(skills, action); }),
                AllOf(HasSubstr("has no tray"), HasSubstr("tray_link")));
  }
}

}  // namespace
}  // namespace hires::skills::skill_factory_test
