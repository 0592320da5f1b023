#include "imagination/purpose.h"

#include <gtest/gtest.h>

namespace hires::imagination::purpose_test {
namespace {

TEST(PurposeTest, KnowsWhatIsTakenAndWhatIsPutDown) {
  const Purpose pick = PurposeOf(actions::OwnActions(), {"pick_up_object", {"Mug1", "rightArm1"}});
  EXPECT_EQ(pick.kind, Purpose::Kind::kTake);
  EXPECT_EQ(pick.object, "mug1");
  EXPECT_EQ(pick.arm, "rightarm1");
  const Purpose from_tray =
      PurposeOf(actions::OwnActions(), {"pick_up_from_tray", {"rightArm1", "mug1"}});
  EXPECT_EQ(from_tray.kind, Purpose::Kind::kTake);
  EXPECT_EQ(from_tray.object, "mug1");
  EXPECT_EQ(from_tray.arm, "rightarm1");
  const Purpose place =
      PurposeOf(actions::OwnActions(), {"Place_Object", {"mug1", "leftArm1", "Table"}});
  EXPECT_EQ(place.kind, Purpose::Kind::kPutOnArea);
  EXPECT_EQ(place.object, "mug1");
  EXPECT_EQ(place.area, "table");
  const Purpose on_tray = PurposeOf(actions::OwnActions(), {"place_on_tray", {"leftArm1", "mug1"}});
  EXPECT_EQ(on_tray.kind, Purpose::Kind::kPutOnTray);
  EXPECT_EQ(on_tray.object, "mug1");
}

TEST(PurposeTest, MovingAloneHasNone) {
  for (const base::ActionCall& action :
       {base::ActionCall{"move_base", {"table"}}, base::ActionCall{"tuck_arms", {"a", "b"}},
        base::ActionCall{"pick_up_object", {"mug1"}}, base::ActionCall{"", {}}}) {
    EXPECT_EQ(PurposeOf(actions::OwnActions(), action).kind, Purpose::Kind::kNone);
    EXPECT_EQ(PurposeOf(actions::OwnActions(), action).object, "");
  }
}

}  // namespace
}  // namespace hires::imagination::purpose_test
