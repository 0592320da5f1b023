#include "hires/imagination/kept_rollouts.h"

#include <gtest/gtest.h>

#include "imagination/room_rollouts.h"

namespace hires::imagination::kept_rollouts_test {
namespace {

using hires::test_support::Room;
using hires::test_support::RoomRollouts;

const base::ActionCall kSlow{"move_base_param", {"east", "slow"}};
const base::ActionCall kFast{"move_base_param", {"east", "fast"}};

TEST(KeptRolloutsTest, TheOldestStartCountsToo) {
  const auto first = std::make_shared<const RolloutSetup>(RoomRollouts(Room(), "mill"));
  RolloutSetup moved = *first;
  moved.robot_state.X_MB.x -= 0.1;
  moved.world_state.objects.clear();
  const auto second = std::make_shared<const RolloutSetup>(moved);
  KeptRollouts kept(100);
  for (const auto& setup : {first, second}) {
    kept.Keep(setup, kFast, 3, PlayRollout(*setup, kFast, 3).value());
  }
  const RolloutSetup again = *first;
  const auto found = kept.Find(again, kFast, 3);
  ASSERT_TRUE(found.has_value());
  EXPECT_TRUE(SameOutcome(*found, PlayRollout(again, kFast, 3).value()));
  EXPECT_FALSE(kept.Find(again, kFast, 2).has_value());
  EXPECT_FALSE(kept.Find(again, kSlow, 3).has_value());
  moved.robot_state.X_MB.x -= 0.1;
  EXPECT_FALSE(kept.Find(moved, kFast, 3).has_value());
}

/// One without physics, that depends on nothing that stands about.
RolloutResult Some(const RolloutSetup& setup, double duration) {
  RolloutResult result;
  result.duration = duration;
  result.final_world = setup.world_state;
  return result;
}

TEST(KeptRolloutsTest, BeyondTheMostTheOldestIsForgotten) {
  const auto setup = std::make_shared<const RolloutSetup>(RoomRollouts(Room(), "mill"));
  KeptRollouts kept(2);
  for (const int index : {5, 6, 6, 7}) kept.Keep(setup, kFast, index, Some(*setup, index));
  EXPECT_FALSE(kept.Find(*setup, kFast, 5).has_value());
  EXPECT_EQ(kept.Find(*setup, kFast, 6).value().duration, 6.0);
  EXPECT_EQ(kept.Find(*setup, kFast, 7).value().duration, 7.0);
  KeptRollouts none(0);
  none.Keep(setup, kFast, 1, Some(*setup, 1));
  EXPECT_FALSE(none.Find(*setup, kFast, 1).has_value());
}

TEST(KeptRolloutsTest, AnEqualUncertaintyReadAnewIsTheSame) {
  const auto setup = std::make_shared<const RolloutSetup>(RoomRollouts(Room(), "mill"));
  RolloutSetup again = *setup, other = *setup;
  again.uncertainty = std::make_shared<const Uncertainty>(*setup->uncertainty);
  auto changed = std::make_shared<Uncertainty>(*setup->uncertainty);
  ++changed->hash;
  other.uncertainty = changed;
  const RolloutResult result = Some(*setup, 1.0);
  EXPECT_TRUE(ResultFrom(*setup, result, kFast, again).has_value());
  EXPECT_FALSE(ResultFrom(*setup, result, kFast, other).has_value());
}

TEST(KeptRolloutsTest, AResultWithoutAnObjectOfItsStartIsNotUsed) {
  const auto setup = std::make_shared<const RolloutSetup>(RoomRollouts(Room(), "mill"));
  RolloutResult result = Some(*setup, 1.0);
  result.final_world.objects.clear();
  EXPECT_FALSE(ResultFrom(*setup, result, kFast, *setup).has_value());
}

TEST(KeptRolloutsTest, AnAssignmentIsShortenedAtBothEnds) {
  const auto setup = std::make_shared<const RolloutSetup>(RoomRollouts(Room(), "mill"));
  KeptRollouts kept(100);
  const auto shorten = [&] { return kept.Shorten({1, 2, 3, 10, 4}, *setup, kFast); };
  EXPECT_EQ(shorten().rest.count, 4);
  for (const int index : {10, 12, 13}) kept.Keep(setup, kFast, index, Some(*setup, index));
  auto shortened = shorten();
  EXPECT_EQ(shortened.rest.worker, 1);
  EXPECT_EQ(shortened.rest.assignment, 2);
  EXPECT_EQ(shortened.rest.alternative, 3);
  EXPECT_EQ(shortened.rest.first_index, 11);
  EXPECT_EQ(shortened.rest.count, 1);
  ASSERT_EQ(shortened.known.size(), 3u);
  EXPECT_EQ(shortened.known[1].index, 12);
  EXPECT_EQ(shortened.known[1].result.duration, 12.0);
  EXPECT_EQ(shortened.known[1].assignment, 2);
  kept.Keep(setup, kFast, 11, Some(*setup, 11));
  EXPECT_EQ(shorten().rest.count, 0);
  EXPECT_EQ(shorten().known.size(), 4u);
}

TEST(KeptRolloutsTest, WhatIsPlayedAmidOthersIsNotKnownBeforehand) {
  const auto setup = std::make_shared<const RolloutSetup>(RoomRollouts(Room(), "mill"));
  KeptRollouts kept(100);
  kept.Keep(setup, kFast, 11, Some(*setup, 11));
  const auto shortened = kept.Shorten({1, 2, 3, 10, 4}, *setup, kFast);
  EXPECT_EQ(shortened.rest.count, 4);
  EXPECT_TRUE(shortened.known.empty());
}

}  // namespace
}  // namespace hires::imagination::kept_rollouts_test
