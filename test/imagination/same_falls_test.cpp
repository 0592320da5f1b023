// Imagined and true falls are judged by the same detector: whatever happens to things, the monitor
// of a rollout and the record of truth say the same of it.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "hires/imagination/rollout.h"
#include "hires/simulation/truth_record.h"
#include "hires/world/fall_code.h"
#include "imagination/rollout/load_monitor.h"
#include "support/scenes.h"

namespace hires::imagination::same_falls_test {
namespace {

using hires::test_support::OnTray;
using hires::test_support::RoomScene;
using hires::test_support::StandingAt;

const geometry::Pose2 kStart{1.5, 2.0, 0.0};

/// Two things on the tray, two that stand in the way.
world::WorldState Things() {
  world::WorldState things{{OnTray("tower1", "tower", kStart, {0.0, 0.1}),
                            OnTray("mill1", "mill", kStart, {0.0, -0.1})}};
  for (const double x : {0.8, 1.4}) {
    world::ObjectState object;
    object.name = "bystander" + std::to_string(things.objects.size());
    object.model = "tower";
    object.X_MO.translation = {kStart.x + x, kStart.y, 0.0002};
    things.objects.push_back(object);
  }
  return things;
}

/// What becomes of things on one drive that chance chooses.
struct Drive {
  int falls{0};         // of all things, as imagination counts
  double seconds{0.0};  // that something was down
};

Drive PlayBoth(const world::StandingCriterion& standing, base::Rng rng) {
  simulation::Variation variation;
  variation.friction_factor = rng.Uniform(0.1, 1.0);
  simulation::RobotSimulator simulator(RoomScene(), variation, Things(), StandingAt(kStart),
                                       base::Rng(1));
  const RolloutParams params;
  LoadMonitor imagined(&simulator, params, standing);
  simulation::TruthRecord truth(standing);
  Drive drive;
  geometry::Twist2 V;
  for (int tick = 0; tick < 300; ++tick) {
    if (tick % 60 == 0) V = {rng.Uniform(-0.5, 1.0), rng.Uniform(-0.5, 0.5), 0.0};
    robot::Command command;
    command.base_velocity = V;
    simulator.Send(command);
    for (int step = 0; step < 10; ++step) simulator.Step();
    imagined.Look();
    truth.Look(simulator);
    drive.falls = imagined.falls() + static_cast<int>(imagined.KnockedOver().size());
    EXPECT_EQ(drive.falls, truth.falls()) << "tick " << tick;
    drive.seconds += drive.falls > 0 ? 0.01 : 0.0;
  }
  return drive;
}

TEST(SameFallsTest, ImaginationAndTruthCountTheSameAtEveryMoment) {
  const world::StandingCriterion criteria[] = {
      {}, {0.4, 0.2, 0.05, 0.10}, {0.2, 0.0, 0.02, 0.03}, {1.2, 0.5, 0.30, 0.40}};
  for (const world::StandingCriterion& standing : criteria) {
    int falls = 0;
    for (int seed = 0; seed < 10; ++seed)
      falls += PlayBoth(standing, base::Rng(7).Fork(seed)).falls;
    EXPECT_GT(falls, 5) << "drives in which nothing falls show nothing";
  }
}

/// The codes by which both sides call what became of one load on a jerky drive.
struct Named {
  base::FailureCode imagined, real;
  bool fell_later{false};  // after it had slid
};

Named NameBoth(const world::StandingCriterion& standing, base::Rng rng) {
  simulation::Variation variation;
  variation.friction_factor = rng.Uniform(0.05, 1.0);
  simulation::RobotSimulator simulator(RoomScene(), variation, {{OnTray("mill1", "mill", kStart)}},
                                       StandingAt(kStart), base::Rng(1));
  const RolloutParams params;
  LoadMonitor imagined(&simulator, params, standing);
  simulation::TruthRecord truth(standing);
  geometry::Twist2 V;
  bool has_slid = false;
  for (int look = 0; look < 500; ++look) {
    if (look % 100 == 0) V = {rng.Uniform(-0.5, 1.0), rng.Uniform(-0.9, 0.9), 0.0};
    robot::Command command;
    command.base_velocity = V;
    simulator.Send(command);
    for (int step = 0; step < 5; ++step) simulator.Step();
    imagined.Look();
    truth.Look(simulator);
    has_slid |= truth.objects().at("mill1").first_fall == world::Fall::kSlid;
  }
  const world::Fall fall = truth.objects().at("mill1").first_fall;
  return {imagined.WhyNotWell().code, world::CodeOf(fall, world::FallenThing::kLoad),
          has_slid && fall != world::Fall::kSlid};
}

TEST(SameFallsTest, BothCallThemTheSame) {
  const world::StandingCriterion criteria[] = {{}, {0.5, 0.0, 0.05, 0.02}};
  std::set<base::FailureCode> seen;
  int fell_later = 0;
  for (const world::StandingCriterion& standing : criteria) {
    for (int seed = 0; seed < 12; ++seed) {
      const Named named = NameBoth(standing, base::Rng(7).Fork(seed));
      EXPECT_EQ(named.imagined, named.real) << "seed " << seed;
      seen.insert(named.real);
      fell_later += named.fell_later ? 1 : 0;
    }
  }
  EXPECT_EQ(seen.count(base::FailureCode::kObjectFell), 1U);
  EXPECT_EQ(seen.count(base::FailureCode::kObjectSlid), 1U);
  EXPECT_GT(fell_later, 0) << "what slides first and falls then is what they could differ in";
}

// The same trajectories: only the criterion differs.
TEST(SameFallsTest, AHoldTimeIsAskedOfBoth) {
  const Drive at_once = PlayBoth({0.5, 0.0, 10.0, 10.0}, base::Rng(7).Fork(0));
  const Drive held = PlayBoth({0.5, 0.3, 10.0, 10.0}, base::Rng(7).Fork(0));
  ASSERT_GT(at_once.falls, 0);
  EXPECT_EQ(held.falls, at_once.falls);
  EXPECT_NEAR(at_once.seconds - held.seconds, 0.3, 0.011) << "as much later as it must last";
}

/// What becomes of a mill that begins on the tray, leaning by 0.18 rad, and falls back upright.
struct Rocking {
  int imagined_falls{0}, true_falls{0};
  double leaned{0.0};  // [s] by 0.15 rad or more
};

Rocking PlayRocking(double hold_time) {
  world::ObjectState mill = OnTray("mill1", "mill", kStart);
  mill.X_MO.rotation = geometry::RotationFromRpy(0.0, 0.18, 0.0);
  mill.X_MO.translation.z() += 0.037 * std::sin(0.18);  // it stands on the rim of its foot
  simulation::RobotSimulator simulator(RoomScene(), {}, {{mill}}, StandingAt(kStart), base::Rng(1));
  const world::StandingCriterion standing{0.15, hold_time, 0.05, 0.10};
  const RolloutParams params;
  LoadMonitor imagined(&simulator, params, standing);
  simulation::TruthRecord truth(standing);
  Rocking rocking;
  for (int look = 0; look < 600; ++look) {
    for (int step = 0; step < 5; ++step) simulator.Step();
    imagined.Look();
    truth.Look(simulator);
    rocking.leaned += imagined.tilt() >= 0.15 ? 0.005 : 0.0;
  }
  rocking.imagined_falls = imagined.falls();
  rocking.true_falls = truth.falls();
  EXPECT_LT(imagined.tilt(), 0.01) << "it was to stand again";
  return rocking;
}

TEST(SameFallsTest, WhatLeansForLessThanTheHoldTimeDidNotFall) {
  const Rocking at_once = PlayRocking(0.0), held = PlayRocking(0.2);
  EXPECT_NEAR(at_once.leaned, 0.1, 0.05);
  EXPECT_EQ(at_once.imagined_falls, 1);
  EXPECT_EQ(at_once.true_falls, 1);
  EXPECT_EQ(held.leaned, at_once.leaned);
  EXPECT_EQ(held.imagined_falls, 0);
  EXPECT_EQ(held.true_falls, 0);
}

}  // namespace
}  // namespace hires::imagination::same_falls_test
