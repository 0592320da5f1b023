#include "hires/skills/action_loader.h"

#include <gmock/gmock.h>

#include "hires/base/hash.h"
#include "hires/base/text.h"
#include "hires/skills/skill_factory.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::skills::action_loader_test {
namespace {

using hires::test_support::ConfigErrorOf;
using testing::AllOf;
using testing::HasSubstr;

/// A library of test/skills/libraries.
std::string PathOf(const std::string& name) {
  return std::string(HIRES_TEST_LIBRARIES) + "/lib" + name + "_actions.so";
}

std::string WhyNot(const std::vector<std::string>& paths) {
  return ConfigErrorOf([&] { LoadActionSet(paths); });
}

/// A robot at an area, without anything that drives.
SkillSet SkillsWith(std::shared_ptr<const ActionSet> actions) {
  SkillSet skills;
  skills.areas = {{"east", {}}};
  skills.actions = std::move(actions);
  return skills;
}

TEST(ActionLoaderTest, WithoutLibrariesThereAreTheOwnActions) {
  const auto set = LoadActionSet({});
  EXPECT_EQ(set->catalogue().specs().size(), actions::OwnActions().specs().size());
  EXPECT_EQ(set->hash(), OwnActionSet()->hash());
  EXPECT_EQ(ToString(set->libraries()), "no library");
}

TEST(ActionLoaderTest, ALibrarysActionsAreMadeBesideTheOwn) {
  const SkillSet skills = SkillsWith(LoadActionSet({PathOf("sound")}));
  EXPECT_EQ(MakeSkill(skills, {"Nod", {"east"}})->period(), 0.125);
  EXPECT_EQ(SpecOf(skills, {"nod", {}}).groups, (std::set<std::string>{"base"}));
  EXPECT_NE(skills.actions->catalogue().Find("pick_up_object"), nullptr);
  EXPECT_THAT(ConfigErrorOf([&] {
                MakeSkill(skills, {"nod", {"west"}});
              }),
              HasSubstr("action 'nod(west)': area 'west' is unknown"));
  EXPECT_THAT(ConfigErrorOf([&] {
                MakeSkill(skills, {"nod", {}});
              }),
              HasSubstr("has 0 arguments, wanted 1 (area)"));
}

TEST(ActionLoaderTest, TheHashTellsLibrariesApart) {
  const auto set = LoadActionSet({PathOf("sound")});
  EXPECT_NE(set->hash(), OwnActionSet()->hash());
  EXPECT_EQ(set->hash(), LoadActionSet({PathOf("sound")})->hash());
  EXPECT_THAT(ToString(set->libraries()), HasSubstr("libsound_actions.so "));
}

TEST(ActionLoaderTest, AnotherBuildOfALibraryHasAnotherHash) {
  const hires::test_support::TemporaryFolder folder;
  const std::string copy =
      folder.Write("libsound_actions.so", base::ReadTextFile(PathOf("sound")) + "one more byte");
  EXPECT_NE(LoadActionSet({copy})->hash(), LoadActionSet({PathOf("sound")})->hash());
}

TEST(ActionLoaderTest, WhoHasOtherActionsSaysWithWhichLibraries) {
  const auto with = LoadActionSet({PathOf("sound")});
  EXPECT_EQ(WhyActionsDiffer(with->hash(), *with), "");
  EXPECT_THAT(WhyActionsDiffer(with->hash(), *OwnActionSet()),
              AllOf(HasSubstr("actions differ: the client has " + base::HexOf(with->hash())),
                    HasSubstr("this worker " + base::HexOf(OwnActionSet()->hash())),
                    HasSubstr("with no library; start both with the same ~action_libraries")));
  EXPECT_THAT(WhyActionsDiffer(1, *with), HasSubstr("with libsound_actions.so "));
}

TEST(ActionLoaderTest, RefusesAFileThatIsMissingOrNoLibrary) {
  EXPECT_THAT(WhyNot({"/nowhere/lib.so"}),
              AllOf(HasSubstr("library of actions '/nowhere/lib.so'"), HasSubstr("/nowhere")));
  const hires::test_support::TemporaryFolder folder;
  EXPECT_THAT(WhyNot({folder.Write("text.so", "no library")}), HasSubstr("it cannot be loaded"));
}

TEST(ActionLoaderTest, RefusesALibraryWithoutActions) {
  EXPECT_THAT(WhyNot({PathOf("empty")}),
              AllOf(HasSubstr("has no class of actions"), HasSubstr("HIRES_REGISTER_ACTIONS")));
}

TEST(ActionLoaderTest, RefusesANameThatExists) {
  EXPECT_THAT(WhyNot({PathOf("clashing")}),
              AllOf(HasSubstr("libclashing_actions.so"), HasSubstr("'move_base' exists already")));
  EXPECT_THAT(WhyNot({PathOf("sound"), PathOf("sound")}), HasSubstr("'nod' exists already"));
}

TEST(ActionLoaderTest, RefusesWhatMakesNoSense) {
  EXPECT_THAT(WhyNot({PathOf("senseless")}),
              AllOf(HasSubstr("libsenseless_actions.so"),
                    HasSubstr("action 'do_nothing': it needs no group of joints")));
  EXPECT_THAT(WhyNot({PathOf("without_maker")}), HasSubstr("action 'bow' has no maker"));
  EXPECT_THAT(WhyNot({PathOf("throwing")}), HasSubstr("the licence server is away"));
}

TEST(ActionLoaderTest, RefusesALibraryThatWasBuiltWithOtherHeaders) {
  EXPECT_THAT(WhyNot({PathOf("other_headers")}), HasSubstr("built with other headers"));
}

}  // namespace
}  // namespace hires::skills::action_loader_test
