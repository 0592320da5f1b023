#include "lab/src/decision/action_loop.h"

#include <gtest/gtest.h>

namespace hires::lab::action_loop_test {
namespace {

const loop::LoopSetup& TheSetup() {
  static const loop::LoopSetup setup(HIRES_SOURCE_DIR "/config/loop.yaml");
  return setup;
}

imagination::StartState WithACup() {
  return imagination::MakeStartState(TheSetup().world(), "premanipulationareanorthtable1", {"cup"});
}

TEST(ActionLoopTest, TheSameSeedGivesTheSameBits) {
  const sim_robot::Truth truth = TheSetup().ReadTruth("");
  const auto play = [&](std::uint64_t seed) {
    ActionOrder order;
    order.start = WithACup();
    order.action = {"move_base_param", {"premanipulationareasouthtable1", "fast"}};
    order.truth = truth;
    order.seed = seed;
    return *PlayAction(TheSetup(), order);
  };
  const ActionRun run = play(1), again = play(1), other = play(2);
  EXPECT_FALSE(run.failure) << base::ToString(run.failure);
  const auto place = [](const ActionRun& r) { return r.truth.objects.at("cup").X_MO.translation; };
  EXPECT_EQ(place(run), place(again));
  EXPECT_EQ(run.duration, again.duration);
  EXPECT_NE(place(run), place(other));
}

TEST(ActionLoopTest, WhatMakesNoSenseEndsAtOnce) {
  ActionOrder order;
  order.start = WithACup();
  order.action = {"move_base_param", {"nowhere", "fast"}};
  const auto run = PlayAction(TheSetup(), order);
  EXPECT_EQ(run->failure.code, base::FailureCode::kInvalidAction);
  EXPECT_FALSE(PlayAction(TheSetup(), order, [] { return true; }));
}

}  // namespace
}  // namespace hires::lab::action_loop_test
