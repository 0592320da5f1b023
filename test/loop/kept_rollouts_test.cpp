#include "loop/kept_rollouts.h"

#include <gtest/gtest.h>

#include "imagination/room_rollouts.h"

namespace hires::loop::kept_rollouts_test {
namespace {

using hires::test_support::Room;
using hires::test_support::RoomRollouts;
using imagination::RolloutSetup;

const base::ActionCall kSlow{"move_base_param", {"east", "slow"}};
const base::ActionCall kFast{"move_base_param", {"east", "fast"}};

TEST(KeptRolloutsTest, TheOldestStartCountsToo) {
  const auto first = std::make_shared<const RolloutSetup>(RoomRollouts(Room(), "mill"));
  RolloutSetup moved = *first;
  moved.robot_state.X_MB.x -= 0.1;
  moved.world_state.objects.clear();
  const auto second = std::make_shared<const RolloutSetup>(moved);
  KeptRollouts kept;
  for (const auto& setup : {first, second}) {
    kept.Keep(setup, kFast, 3, imagination::PlayWithReach(*setup, kFast, 3).value());
  }
  const RolloutSetup again = *first;
  const auto found = kept.Find(again, kFast, 3);
  ASSERT_TRUE(found.has_value());
  EXPECT_TRUE(SameOutcome(found->result, PlayRollout(again, kFast, 3).value()));
  EXPECT_FALSE(kept.Find(again, kFast, 2).has_value());
  EXPECT_FALSE(kept.Find(again, kSlow, 3).has_value());
  moved.robot_state.X_MB.x -= 0.1;
  EXPECT_FALSE(kept.Find(moved, kFast, 3).has_value());
}

}  // namespace
}  // namespace hires::loop::kept_rollouts_test
