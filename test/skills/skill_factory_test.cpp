#include "hires/skills/skill_factory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/messages.h"
#include "support/scenes.h"

namespace hires::skills {
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
              HasSubstr("has 1 arguments, wanted 2 (area, motion set)"));
}

TEST(SkillFactoryTest, KnowsTheAreasOfTheWorldFlat) {
  EXPECT_EQ(RoomSkills().areas.size(), 3u);
  EXPECT_EQ(RoomSkills().areas.at("corner").y, 3.0);
}

}  // namespace
}  // namespace hires::skills
