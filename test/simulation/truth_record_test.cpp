#include "hires/simulation/truth_record.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/scenes.h"

namespace hires::simulation::truth_record_test {
namespace {

using test_support::OnTray;
using test_support::RoomScene;
using test_support::StandingAt;

const geometry::Pose2 kStart{2.0, 2.0, 0.0};

/// A simulator and what is recorded of it, every 5 ms.
struct Recorded {
  explicit Recorded(const world::WorldState& objects, const world::StandingCriterion& standing = {},
                    const Variation& variation = {})
      : simulator(RoomScene(), variation, objects, StandingAt(kStart), base::Rng(1)),
        record(standing) {}

  void Drive(double vx, double vy, double duration) {
    for (long i = std::lround(duration / 0.005); i > 0; --i) {
      robot::Command command;
      command.base_velocity = geometry::Twist2{vx, vy, 0.0};
      simulator.Send(command);
      for (int step = 0; step < 5; ++step) simulator.Step();
      record.Look(simulator);
    }
  }
  const ObjectFate& fate(const std::string& name) const { return record.objects().at(name); }

  RobotSimulator simulator;
  TruthRecord record;
};

world::WorldState OnFloor(const std::string& name, const std::string& model, double x,
                          double z = 0.0002) {
  world::ObjectState object;
  object.name = name;
  object.model = model;
  object.X_MO.translation = {kStart.x + x, kStart.y, z};
  return {{object}};
}

TEST(TruthRecordTest, WhatRidesOnTheTrayStandsWhereverItIsDriven) {
  Recorded recorded({{OnTray("Mill1", "mill", kStart)}});
  recorded.Drive(0.3, 0.0, 2.0);
  EXPECT_TRUE(recorded.fate("mill1").stands);
  EXPECT_EQ(recorded.record.falls(), 0);
  EXPECT_GT(recorded.fate("mill1").X_MO.translation.x(), 2.5);
  EXPECT_GT(recorded.record.distance(), 0.3);
}

TEST(TruthRecordTest, AFallFromTheTrayIsCountedOnce) {
  Recorded recorded({{OnTray("tower1", "tower", kStart)}});
  recorded.Drive(0.0, 0.9, 0.6);
  recorded.Drive(0.0, 0.0, 1.5);
  EXPECT_EQ(recorded.fate("tower1").falls, 1);
  EXPECT_EQ(recorded.fate("tower1").first_fall, world::Fall::kToppled);
  EXPECT_FALSE(recorded.fate("tower1").stands);
  EXPECT_GT(recorded.fate("tower1").max_tilt, 1.0);
}

TEST(TruthRecordTest, WhatSlidesFarOnTheTrayFellThoughItStandsUpright) {
  world::StandingCriterion strict;
  strict.slide = 0.02;
  Variation slippery;
  slippery.friction_factor = 0.1;
  Recorded recorded({{OnTray("mill1", "mill", kStart)}}, strict, slippery);
  recorded.Drive(0.0, 0.9, 0.4);
  EXPECT_EQ(recorded.fate("mill1").falls, 1);
  EXPECT_EQ(recorded.fate("mill1").first_fall, world::Fall::kSlid);
  EXPECT_LT(recorded.fate("mill1").max_tilt, 0.1);
}

TEST(TruthRecordTest, AThingThatDropsUprightFell) {
  world::StandingCriterion lax;
  lax.tilt = 3.0;
  Recorded recorded(OnFloor("mill1", "mill", 1.5, 0.2), lax);
  recorded.Drive(0.0, 0.0, 0.5);
  EXPECT_EQ(recorded.fate("mill1").falls, 1);
  EXPECT_EQ(recorded.fate("mill1").first_fall, world::Fall::kDropped);
}

TEST(TruthRecordTest, ABystanderThatIsRunOverFell) {
  Recorded recorded(OnFloor("tower1", "tower", 0.6));
  recorded.Drive(0.8, 0.0, 0.8);
  recorded.Drive(0.0, 0.0, 1.5);
  EXPECT_EQ(recorded.fate("tower1").falls, 1);
}

TEST(TruthRecordTest, WhatSomebodyElsePutsElsewhereDidNotFall) {
  Recorded before(OnFloor("mill1", "mill", 1.0)), after(OnFloor("mill1", "mill", 2.0));
  TruthRecord told{{}}, untold{{}};
  for (TruthRecord* record : {&told, &untold}) record->Look(before.simulator);
  told.ForgetPlaceOf("Mill1");
  for (TruthRecord* record : {&told, &untold}) record->Look(after.simulator);
  EXPECT_EQ(told.falls(), 0);
  EXPECT_TRUE(told.objects().at("mill1").stands);
  EXPECT_EQ(untold.falls(), 1);
}

TEST(TruthRecordTest, WhatIsThereNoMoreDoesNotStand) {
  Recorded with(OnFloor("mill1", "mill", 1.0)), without(world::WorldState{});
  TruthRecord record{{}};
  record.Look(with.simulator);
  EXPECT_TRUE(record.objects().at("mill1").stands);
  record.Look(without.simulator);
  EXPECT_FALSE(record.objects().at("mill1").stands);
  EXPECT_EQ(record.falls(), 0);
}

}  // namespace
}  // namespace hires::simulation::truth_record_test
