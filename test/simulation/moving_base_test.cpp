#include "simulation/moving_base.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/scenes.h"

namespace hires::simulation::moving_base_test {
namespace {

using geometry::Pose2;
using test_support::TrayRobot;

constexpr double kTimeStep = 0.001;

MovingBase BaseAt(const Pose2& X_MB, const Variation& variation = {}, std::uint64_t seed = 1,
                  const FloorPlaces* places = nullptr) {
  static const FloorPlaces kEven;
  return MovingBase(TrayRobot().profile, places ? *places : kEven, variation, X_MB, kTimeStep,
                    base::Rng(seed));
}

/// Drives at a constant command, with slip that is drawn every 10 ms.
void Drive(const geometry::Twist2& velocity, int steps, MovingBase* base) {
  for (int i = 0; i < steps; ++i) {
    if (i % 50 == 0) base->Send(velocity, i * kTimeStep);
    if (i % 10 == 0) base->DrawSlip(10 * kTimeStep);
    base->Step(i * kTimeStep, (i + 1) * kTimeStep);
  }
}

TEST(MovingBaseTest, StandsLevelOnAFlatFloor) {
  const MovingBase base = BaseAt({1.0, 2.0, 0.5});
  EXPECT_EQ(base.X_MB().translation, Eigen::Vector3d(1.0, 2.0, 0.0));
  EXPECT_NEAR(geometry::TiltOf(base.X_MB().rotation), 0.0, 1e-12);
}

TEST(MovingBaseTest, AnUnevenFloorLiftsAndTiltsIt) {
  Variation variation;
  variation.floor_roughness = 0.01;
  const MovingBase base = BaseAt({1.0, 2.0, 0.5}, variation);
  EXPECT_NE(base.X_MB().translation.z(), 0.0);
  EXPECT_GT(geometry::TiltOf(base.X_MB().rotation), 0.0);
  EXPECT_EQ(base.motion().X_MB.x, 1.0);
}

TEST(MovingBaseTest, SlippingWheelsGoAnotherWayWithTheSameMean) {
  Variation variation;
  variation.wheel_slip = 0.05;
  MovingBase slipping = BaseAt({}, variation), gripping = BaseAt({});
  Drive({0.5, 0.0, 0.0}, 4000, &slipping);
  Drive({0.5, 0.0, 0.0}, 4000, &gripping);
  EXPECT_NE(slipping.motion().X_MB.x, gripping.motion().X_MB.x);
  // Correlated over 0.1 s, 0.05 leaves sqrt(2 * 0.1 / 4) * 0.05 of the way as deviation: 1.1 %.
  EXPECT_NEAR(slipping.motion().X_MB.x, gripping.motion().X_MB.x, 4 * 0.0112 * 2.0);
}

TEST(MovingBaseTest, WhatMovesAlongOnATurningBaseGoesRoundIt) {
  MovingBase base = BaseAt({1.0, 2.0, M_PI / 2});
  Drive({0.5, 0.0, 1.0}, 2000, &base);
  const geometry::Pose3& X_MB = base.X_MB();
  const Eigen::Vector3d p_MQ = X_MB * Eigen::Vector3d(0.2, 0.0, 0.3);
  const geometry::Twist3 V = base.VelocityAt(p_MQ);
  EXPECT_LT((V.linear - X_MB.rotation * Eigen::Vector3d(0.5, 0.2, 0.0)).norm(), 1e-9);
  EXPECT_NEAR(V.angular.z(), 1.0, 1e-9);
}

TEST(MovingBaseTest, RestoredItGoesOnWithTheSameBits) {
  Variation variation;
  variation.wheel_slip = 0.05;
  variation.floor_roughness = 0.001;
  MovingBase base = BaseAt({}, variation, 3);
  Drive({0.3, 0.1, 0.2}, 500, &base);
  const MovingBase::State saved = base.Save();
  MovingBase other = BaseAt({}, variation, 3);
  other.Restore(saved);
  for (MovingBase* each : {&base, &other}) {
    for (int i = 500; i < 900; ++i) {
      if (i % 10 == 0) each->DrawSlip(10 * kTimeStep);
      each->Step(i * kTimeStep, (i + 1) * kTimeStep);
    }
  }
  EXPECT_EQ(base.X_MB().translation, other.X_MB().translation);
  EXPECT_EQ(base.X_MB().rotation.coeffs(), other.X_MB().rotation.coeffs());
}

TEST(DisturbancesTest, KeepTheLatestTimeOfEach) {
  const robot::MotionSet limits{1.0, 2.0, 2.0, 2.0};
  Disturbances disturbances;
  BaseMotion motion;
  motion.V_B.vx = 0.4;
  motion.A_B.vx = 1.0;  // just half of the largest
  disturbances.Note(motion, limits, 1.0);
  EXPECT_LT(disturbances.accelerating, 0.0);
  motion.A_B.vx = 1.1;
  disturbances.Note(motion, limits, 2.0);
  motion.A_B.vx = -1.1;
  disturbances.Note(motion, limits, 3.0);
  motion.A_B = {0.0, 0.0, -1.1};
  motion.timed_out = true;
  disturbances.Note(motion, limits, 4.0);
  EXPECT_EQ(disturbances.accelerating, 2.0);
  EXPECT_EQ(disturbances.braking, 3.0);
  EXPECT_EQ(disturbances.turning, 4.0);
  EXPECT_EQ(disturbances.late_command, 4.0);
}

TEST(MovingBaseTest, ASillLiftsAndTiltsItWhereItLiesAndNowhereElse) {
  FloorPlaces places;
  places.sills = {{{1.0, -1.0}, {1.0, 1.0}, 0.1, 0.01}};
  const double arm = 0.7 * geometry::InscribedRadius(TrayRobot().profile.footprint);
  const MovingBase before = BaseAt({0.5 - arm, 0.0, 0.0}, {}, 1, &places);
  EXPECT_EQ(before.X_MB().translation.z(), 0.0);
  const MovingBase upon = BaseAt({1.0 - arm, 0.0, 0.0}, {}, 1, &places);  // its front wheels
  EXPECT_NEAR(upon.X_MB().translation.z(), 0.005, 1e-12);
  EXPECT_NEAR(geometry::TiltOf(upon.X_MB().rotation), 0.01 / (2.0 * arm), 1e-9);
  EXPECT_GT((upon.X_MB().rotation * Eigen::Vector3d::UnitX()).z(), 0.0);  // the nose is up
}

TEST(MovingBaseTest, APatchLengthensAStopOnItAlone) {
  FloorPlaces places;
  places.patches = {{{0.0, 0.0}, 3.0, 0.3}};
  const auto stop_from = [&](double x) {
    MovingBase base = BaseAt({x, 0.0, 0.0}, {}, 1, &places);
    for (int i = 0; i < 4000; ++i) {
      if (i % 50 == 0) base.Send({i < 2000 ? 0.3 : 0.0, 0.0, 0.0}, i * kTimeStep);
      base.Step(i * kTimeStep, (i + 1) * kTimeStep);
      if (i == 1999) x = base.motion().X_MB.x;
    }
    return base.motion().X_MB.x - x;
  };
  EXPECT_GT(stop_from(0.0), 1.5 * stop_from(10.0));
}

TEST(FloorPlacesTest, ASillIsSmoothBesideItsTopAndEndsWithItsLine) {
  FloorPlaces places;
  places.sills = {{{0.0, 0.0}, {0.0, 1.0}, 0.02, 0.01}};
  EXPECT_EQ(places.HeightAt({0.01, 0.5}), 0.01);
  EXPECT_NEAR(places.HeightAt({0.035, 0.5}), 0.005, 1e-12);
  EXPECT_EQ(places.HeightAt({0.06, 0.5}), 0.0);
  EXPECT_EQ(places.HeightAt({0.0, 1.1}), 0.0);
}

TEST(FloorPlacesTest, TheMostSlipperyPatchCounts) {
  FloorPlaces places;
  places.patches = {{{0.0, 0.0}, 1.0, 1.2}, {{0.5, 0.0}, 1.0, 0.6}};
  EXPECT_EQ(places.TractionAt({-0.9, 0.0}), 1.2);
  EXPECT_EQ(places.TractionAt({0.2, 0.0}), 0.6);
  EXPECT_EQ(places.TractionAt({0.0, 2.0}), kFullTraction);
}

}  // namespace
}  // namespace hires::simulation::moving_base_test
