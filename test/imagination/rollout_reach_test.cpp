#include <fmt/format.h>
#include <gtest/gtest.h>

#include "hires/base/error.h"
#include "hires/imagination/kept_rollouts.h"
#include "imagination/room_rollouts.h"
#include "imagination/same_bits.h"
#include "skills/laser_robot.h"
#include "support/rounds.h"

namespace hires::imagination::rollout_reach_test {
namespace {

using hires::test_support::ExpectSameBits;
using hires::test_support::OnTray;
using hires::test_support::Room;
using hires::test_support::RoomRollouts;
using hires::test_support::SomeUncertainty;
using world::ObjectState;

const base::ActionCall kFast{"move_base_param", {"east", "fast"}};

ObjectState OnFloor(const std::string& name, double x, double y) {
  ObjectState object;
  object.name = name;
  object.model = "mill";
  object.X_MO = geometry::Lift({x, y, 0.0}, 0.0002);
  return object;
}

/// A drive from (1, 2) to (4.5, 2) with a load that falls now and then.
RolloutSetup Start(const std::vector<ObjectState>& about = {}) {
  static const RolloutSetup empty = RoomRollouts(Room(), "tower", SomeUncertainty());
  RolloutSetup setup = empty;
  auto& objects = setup.world_state.objects;
  objects.insert(objects.end(), about.begin(), about.end());
  return setup;
}

RolloutSetup Reseeded(RolloutSetup setup) {
  ++setup.seed;
  return setup;
}

RolloutResult Play(const RolloutSetup& setup, int index = 0) {
  return PlayRollout(setup, kFast, index).value();
}

bool Stays(const RolloutSetup& before, const RolloutSetup& after) {
  return ResultFrom(before, Play(before), kFast, after).has_value();
}

bool CanBe(const RolloutSetup& setup) {
  try {
    CheckSetup(setup, kFast);
    return true;
  } catch (const base::ConfigError&) {
    return false;
  }
}

/// Mostly beside a wall, where it stays left out unless a load rolls there.
ObjectState Anywhere(const std::string& name, base::Rng* rng) {
  const double x = rng->Uniform(0.2, 5.8), y = rng->Uniform(0.2, 0.6);
  const int where = rng->Index(5);
  return OnFloor(name, x, where == 0 ? rng->Uniform(0.2, 3.8) : where < 3 ? y : 4.0 - y);
}

/// One thing is moved, gone or new; the load is moved by a millimetre.
RolloutSetup Changed(RolloutSetup setup, base::Rng* rng) {
  auto& objects = setup.world_state.objects;
  switch (rng->Index(10)) {
    case 0:
      objects[0].X_MO.translation.x() += 0.001;
      break;
    case 1:
    case 2:
      objects.erase(objects.begin() + 1 + rng->Index(static_cast<int>(objects.size()) - 1));
      break;
    case 3:
    case 4:
      objects.insert(objects.begin() + rng->Index(static_cast<int>(objects.size()) + 1),
                     Anywhere("new", rng));
      break;
    default:
      ObjectState& moved = objects[1 + rng->Index(static_cast<int>(objects.size()) - 1)];
      moved = Anywhere(moved.name, rng);
  }
  return setup;
}

template <typename Draw>
RolloutSetup Possible(const Draw& draw) {
  RolloutSetup setup = draw();
  while (!CanBe(setup)) setup = draw();
  return setup;
}

TEST(RolloutReachTest, WhatStaysIsWhatPlayingAgainGives) {
  const base::Rng seeds(14);
  int num_kept = 0, num_refused = 0;
  for (int round = 0; round < 20; ++round) {
    base::Rng rng = seeds.Fork(static_cast<std::uint64_t>(round));
    const RolloutSetup before = Possible([&] {
      return Start({Anywhere("a", &rng), Anywhere("b", &rng), Anywhere("c", &rng)});
    });
    const RolloutSetup after = Possible([&] { return Changed(before, &rng); });
    const auto kept = ResultFrom(before, Play(before, round % 4), kFast, after);
    (kept ? num_kept : num_refused) += 1;
    if (!kept) continue;
    SCOPED_TRACE(round);
    ExpectSameBits(*kept, Play(after, round % 4));
  }
  EXPECT_GE(num_kept, 4);
  EXPECT_GE(num_refused, 4);
}

TEST(RolloutReachTest, WhoWatchesIsToldWhenARolloutBeginsAndBeginsAgain) {
  const auto begins_of = [](const RolloutSetup& setup) {
    int num_begins = 0;
    double last = 0.0;
    RolloutHooks hooks;
    hooks.on_begin = [&](const simulation::RobotSimulator& simulator) {
      EXPECT_NEAR(simulator.time(), setup.params.settling_time, 1e-9);
      last = simulator.time();
      ++num_begins;
    };
    const auto goes_on = [&](const simulation::RobotSimulator& simulator) {
      EXPECT_GE(num_begins, 1);
      EXPECT_GE(simulator.time(), last) << "nobody was told that it began again";
      last = simulator.time();
    };
    hooks.on_look = goes_on;
    hooks.on_sample = [&](const simulation::RobotSimulator& simulator, double) {
      goes_on(simulator);
    };
    hooks.on_late_cycle = hooks.on_sample;
    EXPECT_TRUE(PlayRollout(setup, kFast, 0, hooks));
    return num_begins;
  };
  EXPECT_EQ(begins_of(Start()), 1);
  EXPECT_EQ(begins_of(Start({OnFloor("far", 2.7, 0.3)})), 1);
  EXPECT_EQ(begins_of(Start({OnFloor("near", 3.0, 2.3)})), 2);
}

TEST(RolloutReachTest, WhatIsFarAwayMayChange) {
  const RolloutSetup before = Start({OnFloor("far", 2.7, 0.3)});
  EXPECT_TRUE(Stays(before, before));
  EXPECT_TRUE(Stays(before, Start()));
  EXPECT_TRUE(Stays(before, Start({OnFloor("far", 2.5, 3.7)})));
  EXPECT_TRUE(Stays(Start(), before));
}

TEST(RolloutReachTest, NothingStaysThatTheChangeMayTouch) {
  const RolloutSetup before = Start({OnFloor("far", 2.7, 0.3)});
  EXPECT_FALSE(Stays(before, Start({OnFloor("far", 2.7, 2.0)}))) << "moved into the way";
  EXPECT_FALSE(Stays(Start({OnFloor("far", 2.7, 2.0)}), before)) << "out of the way";
  EXPECT_FALSE(Stays(before, Start({OnFloor("far", 2.7, 0.3), OnFloor("new", 3.0, 2.3)})));
  EXPECT_FALSE(Stays(before, Reseeded(before)));
  RolloutSetup other = before;
  other.world_state.objects[0].X_MO.translation.y() += 1e-12;
  EXPECT_FALSE(Stays(before, other)) << "the load itself";
  other = before;
  other.world_state.objects[0].model = "mill";
  EXPECT_FALSE(Stays(before, other));
  other = before;
  other.robot_state.X_MB.yaw += 1e-12;
  EXPECT_FALSE(Stays(before, other));
  other = before;
  other.world_state.objects[1].V_MO.linear.x() = 0.1;
  EXPECT_FALSE(Stays(before, other)) << "it rolls, and may come near";
}

TEST(RolloutReachTest, WhatMayDependOnAnythingStaysOnlyForTheSameStart) {
  const RolloutSetup before = Start({OnFloor("far", 2.7, 0.3)});
  RolloutResult rollout = Play(before);
  rollout.reach = {};
  EXPECT_TRUE(ResultFrom(before, rollout, kFast, before).has_value());
  EXPECT_FALSE(ResultFrom(before, rollout, kFast, Start()).has_value());
}

/// All that stands about is in physics from the beginning: it is not at rest, although so slow that
/// it moves by less than the last bit of its place.
RolloutSetup Stirred(RolloutSetup setup) {
  for (ObjectState& object : setup.world_state.objects) {
    if (object.attached_to.empty()) object.V_MO.linear.z() = 1e-30;
  }
  return setup;
}

TEST(RolloutReachTest, WhatIsFarAwayIsLeftOutAndStandsAsItDid) {
  const RolloutSetup setup = Start({OnFloor("far", 2.7, 0.3)});
  const auto far_of = [](const RolloutResult& result) {
    return result.final_world.objects[1].X_MO.translation;
  };
  const RolloutResult result = Play(setup), with_all = Play(Stirred(setup));
  EXPECT_FALSE(result.reach.is_everything);
  EXPECT_EQ(far_of(result), setup.world_state.objects[1].X_MO.translation);
  EXPECT_NE(far_of(with_all).z(), far_of(result).z()) << "in physics it settles";
  for (int index = 0; index < 3; ++index) {
    EXPECT_TRUE(SameOutcome(Play(setup, index), Play(Stirred(setup), index)));
    EXPECT_TRUE(SameOutcome(Play(setup, index), Play(Start(), index)));
  }
}

TEST(RolloutReachTest, WhereSomethingMovesAtTheStartAllIsInPhysics) {
  RolloutSetup setup = Start({OnFloor("thrown", 0.6, 0.3), OnFloor("far", 2.7, 0.3)});
  EXPECT_FALSE(Play(setup).reach.is_everything);
  setup.world_state.objects[1].V_MO.linear.x() = 8.0;
  const RolloutResult result = Play(setup);
  EXPECT_TRUE(result.reach.is_everything);
  EXPECT_TRUE(result.reach.discs.empty());
  setup.world_state.objects.pop_back();
  EXPECT_FALSE(ResultFrom(setup, result, kFast, Start()).has_value());
}

TEST(RolloutReachTest, WhatIsInTheWayIsInPhysics) {
  const RolloutSetup setup = Start({OnFloor("far", 0.3, 3.7), OnFloor("hit", 2.75, 2.0)});
  const RolloutResult with_all = Play(Stirred(setup));
  const RolloutResult result = Play(setup);
  EXPECT_EQ(ToString(result.failure), ToString(with_all.failure));
  EXPECT_EQ(result.duration, with_all.duration);
  EXPECT_EQ(result.final_world.objects[1].X_MO.translation,
            setup.world_state.objects[1].X_MO.translation);
  EXPECT_GT((result.final_world.objects[2].X_MO.translation -
             setup.world_state.objects[2].X_MO.translation)
                .norm(),
            0.1);
}

/// A hall without walls, a robot whose laser looks in a plane that mills cross, and a way of 8 m.
RolloutSetup Hall(const std::vector<ObjectState>& about) {
  static const RolloutSetup empty = [] {
    world::World hall;
    hall.name = "hall";
    hires::test_support::AddArea(&hall, "West", geometry::Lift({1.0, 2.0, 0.0}));
    hires::test_support::AddArea(&hall, "East", geometry::Lift({9.0, 2.0, 0.0}));
    hires::test_support::AddModel(&hall, hires::test_support::Mill());
    hires::test_support::AddModel(&hall, hires::test_support::Mill("tower", 0.548));
    hall.hash = hall.ComputeHash();
    const robot::Robot robot = skills::test_support::RobotWithLaser({0.25, 0.0, 0.0});
    RolloutSetup setup = RoomRollouts(hall, "mill", SomeUncertainty(), robot);
    simulation::Sight sight;
    sight.scans.emplace();
    sight.scans->laser.num_beams = 90;
    sight.scans->laser.range_max = 20.0;
    sight.scans->period = 0.4;
    setup.scene = simulation::MakeScene(hall, robot, {}, sight);
    skills::MoveBaseParams driving;
    driving.obstacle_layer.emplace();
    setup.skills =
        std::make_shared<const skills::SkillSet>(skills::MakeSkillSet(hall, robot, driving, {}));
    return setup;
  }();
  RolloutSetup setup = empty;
  auto& objects = setup.world_state.objects;
  objects.insert(objects.end(), about.begin(), about.end());
  return setup;
}

TEST(RolloutReachTest, WhatTheLaserSeesOnlyFromAfarIsLeftOut) {
  std::vector<ObjectState> far;
  for (int i = 0; i < 40; ++i) far.push_back(OnFloor(fmt::format("m{}", i), 1.0 + 0.2 * i, 12.0));
  const RolloutSetup setup = Hall(far);
  const RolloutResult result = Play(setup);
  for (std::size_t i = 1; i < setup.world_state.objects.size(); ++i) {
    EXPECT_EQ(result.final_world.objects[i].X_MO.translation,
              setup.world_state.objects[i].X_MO.translation)
        << "it would have settled in physics";
  }
  EXPECT_TRUE(SameOutcome(result, Play(Hall({}))));
}

TEST(RolloutReachTest, WhatTheLaserSeesChangesNoBitWhereverItIsLeftOut) {
  const base::Rng seeds(34);
  int num_left_out = 0, num_in = 0;
  for (int round = 0; round < hires::test_support::Rounds(24); ++round) {
    base::Rng rng = seeds.Fork(static_cast<std::uint64_t>(round));
    const RolloutSetup setup = Possible([&] {
      std::vector<ObjectState> about;
      for (int i = 1 + rng.Index(8); i > 0; --i) {
        about.push_back(
            OnFloor(fmt::format("m{}", i), rng.Uniform(-4.0, 14.0), rng.Uniform(-7.0, 11.0)));
      }
      return Hall(about);
    });
    const RolloutResult narrow = Play(setup, round), wide = Play(Stirred(setup), round);
    SCOPED_TRACE(round);
    EXPECT_TRUE(SameOutcome(narrow, wide));
    EXPECT_EQ(narrow.simulated, wide.simulated);
    EXPECT_TRUE(narrow.final_robot == wide.final_robot);
    for (std::size_t i = 1; i < setup.world_state.objects.size(); ++i) {
      const bool is_in = narrow.final_world.objects[i].X_MO.translation !=
                         setup.world_state.objects[i].X_MO.translation;
      ++(is_in ? num_in : num_left_out);
    }
  }
  EXPECT_GT(num_left_out, 5);
  EXPECT_GT(num_in, 5);
}

TEST(RolloutReachTest, CancelledItGivesUp) {
  EXPECT_FALSE(PlayRollout(Start(), kFast, 0, {[] { return true; }, {}}).has_value());
  int num_asked = 0;  // while the load settles already
  EXPECT_FALSE(PlayRollout(Start(), kFast, 0, {[&] { return ++num_asked > 3; }, {}}).has_value());
  EXPECT_EQ(num_asked, 4);
}

}  // namespace
}  // namespace hires::imagination::rollout_reach_test
