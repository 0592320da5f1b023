#include "hires/actions/catalogue.h"

#include <gmock/gmock.h>

#include "support/messages.h"

namespace hires::actions::catalogue_test {
namespace {

using test_support::ConfigErrorOf;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::set<std::string> GroupsOfCall(const base::ActionCall& call) {
  return GroupsOf(OwnActions().Get(call.name), call);
}

TEST(CatalogueTest, FindsActionsWhateverTheirCase) {
  EXPECT_EQ(OwnActions().Get("Move_Base").name, "move_base");
  EXPECT_EQ(OwnActions().Get("!place_object").name, "place_object");
  EXPECT_EQ(OwnActions().Find("somersault"), nullptr);
}

TEST(CatalogueTest, NamesActionsLikeTheUnknownOne) {
  EXPECT_THAT(
      ConfigErrorOf([] { OwnActions().Get("move_torsi"); }),
      AllOf(HasSubstr("action 'move_torsi' is unknown"), HasSubstr("did you mean 'move_torso'")));
}

TEST(CatalogueTest, TakesAnActionOnceAndOnlyIfItMakesSense) {
  Catalogue catalogue;
  catalogue.Add(OwnActions().Get("move_base"));
  EXPECT_THAT(ConfigErrorOf([&] { catalogue.Add(OwnActions().Get("move_base")); }),
              HasSubstr("action 'move_base' exists already"));
  EXPECT_THAT(ConfigErrorOf([&] { catalogue.Add({}); }), HasSubstr("its name is ''"));
  EXPECT_EQ(catalogue.specs().size(), 1u);
}

TEST(OwnActionsTest, SayHowMuchOfTheRobotTheyMove) {
  EXPECT_EQ(OwnActions().Get("move_base").detail, Detail::kBase);
  EXPECT_EQ(OwnActions().Get("move_base_blind").detail, Detail::kBase);
  EXPECT_EQ(OwnActions().Get("place_object").detail, Detail::kUpperBody);
  EXPECT_EQ(OwnActions().Get("move_torso").detail, Detail::kUpperBody);
}

TEST(OwnActionsTest, WhoGraspsNeedsAllThatMustStandStillAndLooks) {
  EXPECT_THAT(GroupsOfCall({"Pick_Up_Object", {"mug1", "rightArm1"}}),
              ElementsAre("base", "head", "rightarm1", "torso"));
  EXPECT_THAT(GroupsOfCall({"place_on_tray", {"leftArm1", "mug1"}}),
              ElementsAre("base", "head", "leftarm1", "torso"));
  EXPECT_THAT(GroupsOfCall({"look_at", {"table1"}}), ElementsAre("head"));
  EXPECT_THAT(GroupsOfCall({"tuck_arms", {"a", "b"}}), ElementsAre("leftarm1", "rightarm1"));
}

TEST(OwnActionsTest, TheHeadIsLeftAloneByWhoeverUsesItAndByWhoeverIsUnknown) {
  for (const char* name : {"pick_up_object", "place_object", "place_on_tray", "pick_up_from_tray",
                           "observe_objects_on_area", "look_at", "somersault"}) {
    EXPECT_TRUE(MayUseHead(OwnActions(), name)) << name;
  }
  for (const char* name : {"move_base", "move_torso", "tuck_arms"}) {
    EXPECT_FALSE(MayUseHead(OwnActions(), name)) << name;
  }
}

TEST(OwnActionsTest, OnlyLookingPromisesNothing) {
  for (const auto& [name, spec] : OwnActions().specs()) {
    const bool looks = name == "look_at" || name.rfind("observe_", 0) == 0;
    EXPECT_EQ(spec.effects.empty(), looks) << name;
  }
}

}  // namespace
}  // namespace hires::actions::catalogue_test
