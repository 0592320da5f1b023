#include "imagination/physics_hash.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <vector>

namespace hires::imagination::physics_hash_test {
namespace {

struct All {
  physics::PhysicsParams physics;
  RolloutParams rollout;
  world::StandingCriterion standing;

  std::uint64_t Hash() const { return PhysicsHash(physics, rollout, standing); }
};

TEST(PhysicsHashTest, TheSameNumbersHaveTheSameHash) { EXPECT_EQ(All().Hash(), All().Hash()); }

TEST(PhysicsHashTest, EveryNumberChangesIt) {
  const std::vector<std::function<void(All*)>> changes{
      [](All* a) { a->physics.time_step *= 2; },
      [](All* a) { a->physics.gravity *= 2; },
      [](All* a) { a->physics.erp *= 2; },
      [](All* a) { a->physics.cfm *= 2; },
      [](All* a) { a->physics.surface_layer *= 2; },
      [](All* a) { a->physics.max_correcting_velocity *= 2; },
      [](All* a) { a->physics.restitution_threshold *= 2; },
      [](All* a) { a->rollout.settling_time *= 2; },
      [](All* a) { a->rollout.time_limit *= 2; },
      [](All* a) { a->rollout.sample_period *= 2; },
      [](All* a) { a->rollout.shaking_tilt *= 2; },
      [](All* a) { a->rollout.topple_tilt *= 2; },
      [](All* a) { a->rollout.aftermath *= 2; },
      [](All* a) { a->rollout.put_back = true; },
      [](All* a) { a->rollout.put_back_tilt *= 2; },
      [](All* a) { a->standing.tilt = 0.4; },
      [](All* a) { a->standing.hold_time = 0.2; },
      [](All* a) { a->standing.drop *= 2; },
      [](All* a) { a->standing.slide *= 2; },
  };
  std::set<std::uint64_t> hashes{All().Hash()};
  for (const auto& change : changes) {
    All changed;
    change(&changed);
    hashes.insert(changed.Hash());
  }
  EXPECT_EQ(hashes.size(), changes.size() + 1);
}

}  // namespace
}  // namespace hires::imagination::physics_hash_test
