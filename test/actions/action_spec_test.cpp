#include "hires/actions/action_spec.h"

#include <gmock/gmock.h>

#include "hires/actions/catalogue.h"
#include "support/messages.h"

namespace hires::actions::action_spec_test {
namespace {

using test_support::ConfigErrorOf;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// Puts an object down beside the robot: sound, and nothing that the robot has.
ActionSpec PutBeside() {
  ActionSpec spec;
  spec.name = "put_beside";
  spec.parameters = {{"object", ParameterKind::kObject}, {"arm", ParameterKind::kArm}};
  spec.detail = Detail::kUpperBody;
  spec.groups = {kBaseGroup, "?arm"};
  spec.purpose = {Purpose::kPutOnTray, "object", "arm", ""};
  spec.effects = {{"Holding", {"?arm", "nothing"}}};
  spec.failures = {base::FailureCode::kNoPath};
  return spec;
}

std::string WhyNot(const ActionSpec& spec) {
  return ConfigErrorOf([&] { CheckSpec(spec); });
}

TEST(CheckSpecTest, TakesWhatMakesSense) { EXPECT_NO_THROW(CheckSpec(PutBeside())); }

TEST(CheckSpecTest, RefusesNamesThatPlansCannotHave) {
  for (const char* name : {"", "Put", "put beside", "!put", "1put"}) {
    ActionSpec spec = PutBeside();
    spec.name = name;
    EXPECT_THAT(WhyNot(spec), AllOf(HasSubstr(std::string("its name is '") + name + "'"),
                                    HasSubstr("wanted lower-case letters")));
  }
  ActionSpec spec = PutBeside();
  spec.parameters[0].name = "the object";
  EXPECT_THAT(WhyNot(spec), HasSubstr("a parameter is called 'the object'"));
  spec.parameters[0].name = "arm";
  EXPECT_THAT(WhyNot(spec), HasSubstr("two parameters are called 'arm'"));
}

TEST(CheckSpecTest, RefusesGroupsThatAreNone) {
  ActionSpec spec = PutBeside();
  spec.groups = {};
  EXPECT_THAT(WhyNot(spec), HasSubstr("needs no group of joints"));
  spec.groups = {"?object"};
  EXPECT_THAT(WhyNot(spec), HasSubstr("a group is 'object', wanted a parameter of the kind 'arm'"));
  spec.groups = {"left arm"};
  EXPECT_THAT(WhyNot(spec), HasSubstr("a group is 'left arm'"));
}

TEST(CheckSpecTest, RefusesJointsThatDoNotMoveAtTheLevelOfTheBase) {
  ActionSpec spec = PutBeside();
  spec.detail = Detail::kBase;
  EXPECT_THAT(WhyNot(spec), HasSubstr("needs '?arm', which does not move"));
}

TEST(CheckSpecTest, RefusesToDriveWithoutBaseOrGoal) {
  ActionSpec spec = PutBeside();
  spec.driving = Driving::kRoundObstacles;
  EXPECT_THAT(WhyNot(spec), HasSubstr("no parameter of the kind 'area'"));
  spec.driving = Driving::kStraight;
  EXPECT_NO_THROW(CheckSpec(spec));
  spec.groups = {"?arm"};
  EXPECT_THAT(WhyNot(spec), HasSubstr("its groups lack 'base'"));
}

TEST(CheckSpecTest, RefusesAPurposeWithoutItsParameters) {
  ActionSpec spec = PutBeside();
  spec.purpose.object = "thing";
  EXPECT_THAT(WhyNot(spec), HasSubstr("the object of its purpose is 'thing'"));
  spec.purpose = {Purpose::kTake, "object", "object", ""};
  EXPECT_THAT(WhyNot(spec), HasSubstr("the arm of its purpose is 'object'"));
  spec.purpose = {Purpose::kPutOnArea, "object", "arm", ""};
  EXPECT_THAT(WhyNot(spec), HasSubstr("the area of its purpose is ''"));
}

TEST(CheckSpecTest, RefusesEffectsAndFailuresOfNobody) {
  ActionSpec spec = PutBeside();
  spec.effects = {{"Holding", {"?hand", "nothing"}}};
  EXPECT_THAT(WhyNot(spec), HasSubstr("effect Holding(?hand, nothing): '?hand' is no parameter"));
  spec.effects = {{"", {}}};
  EXPECT_THAT(WhyNot(spec), HasSubstr("an effect has no predicate"));
  spec.effects = {};
  spec.failures = {static_cast<base::FailureCode>(99)};
  EXPECT_THAT(WhyNot(spec), HasSubstr("failure 99 is no code"));
}

TEST(ActionSpecTest, GroupsNameTheArmOfTheCall) {
  EXPECT_THAT(GroupsOf(PutBeside(), {"Put_Beside", {"mug1", "leftArm1"}}),
              ElementsAre("base", "leftarm1"));
}

TEST(ActionSpecTest, FindsArgumentsByNameAndKind) {
  const base::ActionCall call{"put_beside", {"Mug1", "leftArm1"}};
  EXPECT_EQ(ArgumentOf(PutBeside(), call, "object"), "mug1");
  EXPECT_EQ(ArgumentOf(PutBeside(), call, "area"), "");
  EXPECT_EQ(ArgumentOf(PutBeside(), call, ParameterKind::kArm), "leftarm1");
  EXPECT_EQ(ArgumentOf(PutBeside(), call, ParameterKind::kMotionSet), std::nullopt);
  EXPECT_EQ(ArgumentOf(PutBeside(), {"put_beside", {"Mug1"}}, ParameterKind::kArm), std::nullopt);
}

TEST(ActionSpecTest, TheNumberOfArgumentsMustFit) {
  EXPECT_THAT(ConfigErrorOf([] {
                CheckArguments(PutBeside(), {"put_beside", {"mug1"}});
              }),
              HasSubstr("has 1 argument, wanted 2 (object, arm)"));
  EXPECT_EQ(Signature(PutBeside()), "put_beside(object, arm)");
}

TEST(ActionSpecTest, EveryPartOfADescriptionCounts) {
  std::vector<ActionSpec> others(8, PutBeside());
  others[0].name = "put_away";
  others[1].parameters[0].kind = ParameterKind::kAreaOrObject;
  others[2].detail = Detail::kBase;
  others[3].groups.insert(kHeadGroup);
  others[4].purpose.purpose = Purpose::kTake;
  others[5].effects.clear();
  others[6].failures.clear();
  others[7].is_operator = false;
  for (const ActionSpec& other : others) EXPECT_NE(Canonical(other), Canonical(PutBeside()));
}

TEST(ActionSpecTest, ConceptsAreCalledAsOntologiesCallThem) {
  EXPECT_EQ(ActivityConcept("move_base_param"), "MoveBaseParamActivity");
  EXPECT_EQ(TaskConcept("imagine"), "ImagineTask");
}

}  // namespace
}  // namespace hires::actions::action_spec_test
