#include "hires/base/action.h"

#include <gmock/gmock.h>

#include "hires/base/atoms.h"
#include "hires/base/error.h"

namespace hires::base::action_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(ActionCallTest, NamesCompareWithoutCaseAndWithoutThePlannersMark) {
  const ActionCall call{"!Move_Base", {"Area1", "slow"}};
  EXPECT_TRUE(call == (ActionCall{"move_base", {"area1", "SLOW"}}));
  EXPECT_FALSE(call == (ActionCall{"move_arm", {"area1", "slow"}}));
  EXPECT_FALSE(call == (ActionCall{"move_base", {"area1", "fast"}}));
  EXPECT_FALSE(call == (ActionCall{"move_base", {"area1"}}));
  EXPECT_FALSE((ActionCall{"move_base", {"area1"}}) == call);
}

TEST(ActionCallTest, TheMarkCountsOnlyAtTheBeginning) {
  EXPECT_FALSE((ActionCall{"go!", {}}) == (ActionCall{"go", {}}));
}

TEST(ToStringTest, ReadsLikeACall) {
  EXPECT_EQ(ToString(ActionCall{"move_base_param", {"area1", "slow"}}),
            "move_base_param(area1, slow)");
  EXPECT_EQ(ToString(ActionCall{"tuck_arms", {}}), "tuck_arms()");
}

TEST(ToStringTest, ReadsLikeAStatement) {
  EXPECT_EQ(ToString(Atom{"RobotAt", {"area1"}}), "RobotAt(area1)");
  EXPECT_EQ(ToString(Atom{"HandEmpty", {}}), "HandEmpty()");
}

TEST(CombinationsTest, TheLastArgumentVariesFastest) {
  EXPECT_THAT(Combinations({"!Go", {{"a", "b"}, {"Slow", "fast"}}}),
              ElementsAre(ActionCall{"go", {"a", "slow"}}, ActionCall{"go", {"a", "fast"}},
                          ActionCall{"go", {"b", "slow"}}, ActionCall{"go", {"b", "fast"}}));
}

TEST(CombinationsTest, NamesComeBackInTheirPlainForm) {
  const std::vector<ActionCall> calls = Combinations({"!Go", {{"Area1"}}});
  ASSERT_EQ(calls.size(), 1u);
  EXPECT_EQ(calls[0].name, "go");
  EXPECT_THAT(calls[0].arguments, ElementsAre("area1"));
}

TEST(CombinationsTest, AnActionWithoutArgumentsIsOneCall) {
  EXPECT_THAT(Combinations({"tuck_arms", {}}), ElementsAre(ActionCall{"tuck_arms", {}}));
}

TEST(CombinationsTest, RepeatedAlternativesCountOnce) {
  EXPECT_THAT(Combinations({"go", {{"slow", "SLOW", "fast", "slow"}}}),
              ElementsAre(ActionCall{"go", {"slow"}}, ActionCall{"go", {"fast"}}));
}

TEST(CombinationsTest, AnEmptyListIsRefusedWithItsPlace) {
  EXPECT_THAT(
      [] {
        Combinations({"go", {{"a"}, {}}});
      },
      ThrowsMessage<ConfigError>(
          AllOf(HasSubstr("action 'go'"), HasSubstr("argument 2"), HasSubstr("name a value"))));
}

TEST(CombinationsTest, TheLimitItselfIsAllowedAndOneMoreIsNot) {
  const ActionTemplate six{"go", {{"a", "b"}, {"1", "2", "3"}}};
  EXPECT_EQ(Combinations(six, 6).size(), 6u);
  EXPECT_THAT([&] { Combinations(six, 5); },
              ThrowsMessage<ConfigError>(
                  AllOf(HasSubstr("more than 5 combinations"), HasSubstr("smaller parts"))));
}

TEST(CombinationsTest, ManyArgumentsAreRefusedBeforeTheyFillTheMemory) {
  const ActionTemplate huge{"go", std::vector<std::vector<std::string>>(64, {"a", "b"})};
  EXPECT_THROW(Combinations(huge), ConfigError);
}

TEST(SameAtomsTest, OrderLettersAndArgumentsCount) {
  const std::vector<Atom> atoms{{"On", {"mug1", "table1"}}, {"RobotAt", {"area1"}}};
  EXPECT_TRUE(SameAtoms(atoms, atoms));
  EXPECT_TRUE(SameAtoms({}, {}));
  EXPECT_FALSE(SameAtoms(atoms, {atoms[1], atoms[0]}));
  EXPECT_FALSE(SameAtoms(atoms, {atoms[0]}));
  EXPECT_FALSE(SameAtoms({{"On", {"mug1"}}}, {{"On", {"Mug1"}}}));
  EXPECT_FALSE(SameAtoms({{"On", {"mug1"}}}, {{"At", {"mug1"}}}));
}

TEST(IsAmongTest, CallsAreAmongTheCombinationsAndOthersAreNot) {
  const ActionTemplate drive{"!Move_Base", {{"Area1", "area2"}, {"slow"}}};
  for (const ActionCall& call : Combinations(drive)) EXPECT_TRUE(IsAmong(call, drive));
  EXPECT_TRUE(IsAmong({"move_base", {"AREA2", "Slow"}}, drive));
  EXPECT_FALSE(IsAmong({"move_base", {"area2", "fast"}}, drive));
  EXPECT_FALSE(IsAmong({"move_base", {"area2"}}, drive)) << "too few arguments";
  EXPECT_FALSE(IsAmong({"move_base", {"area2", "slow", "slow"}}, drive));
  EXPECT_FALSE(IsAmong({"move_torso", {"area1", "slow"}}, drive));
}

}  // namespace
}  // namespace hires::base::action_test
