#include "hires/control/drive_permit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hires::control::drive_permit_test {
namespace {

using Code = base::FailureCode;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::uint64_t kNow = 1'700'000'000'000'000'000;  // [ns]

class DrivePermitTest : public ::testing::Test {
 protected:
  std::vector<DriveRequest> sent_;
  std::vector<std::string> stops_;
  DrivePermit permit_{0.03,
                      {[this](const DriveRequest& request) { sent_.push_back(request); },
                       [this](const base::Failure& why) { stops_.push_back(ToString(why)); }}};
  const DriveLimits slow_{"slow", {0.30, 1.0, 1.4, 2.0}, 0.8, 3.0};
};

TEST_F(DrivePermitTest, NothingIsAskedWhileNoActionDrives) {
  permit_.Tick(0.0);
  EXPECT_THAT(sent_, IsEmpty());
  EXPECT_EQ(permit_.id(), 0u);
}

TEST_F(DrivePermitTest, ARequestSaysHowFastAndHowHardToBrake) {
  permit_.Begin(1, slow_, kNow);
  permit_.Tick(0.0);
  ASSERT_THAT(sent_, SizeIs(1));
  EXPECT_EQ(sent_[0].id, kNow);
  EXPECT_EQ(sent_[0].limits.set_name, "slow");
  EXPECT_EQ(sent_[0].limits.limits.max_linear_velocity, 0.30);
  EXPECT_EQ(sent_[0].limits.limits.max_angular_velocity, 1.0);
  EXPECT_EQ(sent_[0].limits.limits.max_linear_acceleration, 1.4);
  EXPECT_EQ(sent_[0].limits.limits.max_angular_acceleration, 2.0);
  EXPECT_EQ(sent_[0].limits.max_braking, 0.8);
  EXPECT_EQ(sent_[0].limits.max_braking_jerk, 3.0);
}

TEST_F(DrivePermitTest, ItIsRepeatedAtItsPeriodAsLongAsTheActionLasts) {
  permit_.Begin(1, slow_, kNow);
  for (int i = 0; i <= 100; ++i) permit_.Tick(0.01 * i);
  EXPECT_THAT(sent_, SizeIs(::testing::Ge(20u)));
  EXPECT_THAT(sent_, SizeIs(::testing::Le(35u)));
  for (const auto& request : sent_) EXPECT_EQ(request.id, kNow);
  permit_.End(7);  // another action, which had no base
  permit_.Tick(2.0);
  EXPECT_EQ(sent_.back().id, kNow);
  permit_.End(1);
  EXPECT_EQ(sent_.back().id, 0u);
  const std::size_t num_sent = sent_.size();
  permit_.Tick(3.0);
  EXPECT_THAT(sent_, SizeIs(num_sent));
}

TEST_F(DrivePermitTest, EachActionHasANewIdAlsoWhenTheWallsClockGoesBack) {
  permit_.Begin(1, slow_, kNow);
  permit_.End(1);
  permit_.Begin(2, slow_, kNow - 5'000'000'000);
  EXPECT_EQ(permit_.id(), kNow + 1);
}

TEST_F(DrivePermitTest, AStopIsToldOnceAndOnlyForItsRequest) {
  permit_.OnAnswer({0, false, Code::kNoRequest});
  permit_.Begin(1, slow_, kNow);
  permit_.OnAnswer({kNow - 1, false, Code::kStaleScan});
  permit_.OnAnswer({kNow, true, {}});
  EXPECT_THAT(stops_, IsEmpty());
  permit_.OnAnswer({kNow, false, Code::kMotorsHalted});
  permit_.OnAnswer({kNow, false, Code::kMotorsHalted});
  EXPECT_THAT(stops_, ElementsAre("motors_halted"));
  permit_.End(1);
  permit_.Begin(2, slow_, kNow);
  permit_.OnAnswer({kNow + 1, false, Code::kMotorsHalted});
  EXPECT_THAT(stops_, ElementsAre("motors_halted", "motors_halted"));
}

TEST_F(DrivePermitTest, AGuardThatWasRestartedEndsTheDrive) {
  permit_.Begin(1, slow_, kNow);
  permit_.OnAnswer({0, false, Code::kNoRequest});  // from before the request
  EXPECT_THAT(stops_, IsEmpty());
  permit_.OnAnswer({kNow, true, {}});
  permit_.OnAnswer({0, false, Code::kNoRequest});
  permit_.OnAnswer({kNow, true, {}});
  EXPECT_THAT(stops_, ElementsAre("guard_restarted"));
  EXPECT_FALSE(*permit_.granted());
}

TEST_F(DrivePermitTest, VelocitiesPassWhileTheGuardSaysSo) {
  const auto granted = permit_.granted();
  permit_.Begin(1, slow_, kNow);
  EXPECT_FALSE(*granted);
  permit_.OnAnswer({kNow - 1, true, {}});
  EXPECT_FALSE(*granted);
  permit_.OnAnswer({kNow, true, {}});
  EXPECT_TRUE(*granted);
  permit_.End(1);
  EXPECT_FALSE(*granted);
}

TEST_F(DrivePermitTest, WhatStandsOnTheTrayMayChange) {
  permit_.Begin(1, slow_, kNow);
  permit_.SetBraking(0.5, 2.0);
  permit_.Tick(0.0);
  EXPECT_EQ(sent_.back().limits.max_braking, 0.5);
  EXPECT_EQ(sent_.back().limits.max_braking_jerk, 2.0);
}

class LimitsForTest : public ::testing::Test {
 protected:
  LimitsForTest() {
    skills_.motion_sets = {{"fast", {0.55, 1.0, 2.5, 3.2}}, {"slow", {0.30, 1.0, 1.4, 2.0}}};
    skills_.default_motion_set = "fast";
  }
  skills::SkillSet skills_;
};

TEST_F(LimitsForTest, TheActionsOwnSetIsInForce) {
  EXPECT_EQ(LimitsFor(skills_, {"Move_Base_Param", {"home", "Slow"}}).set_name, "slow");
  EXPECT_EQ(LimitsFor(skills_, {"move_base_param", {"home", "slow"}}).limits.max_linear_velocity,
            0.30);
}

TEST_F(LimitsForTest, OthersHaveTheRobotsDefault) {
  EXPECT_EQ(LimitsFor(skills_, {"move_base", {"home"}}).set_name, "fast");
  EXPECT_EQ(LimitsFor(skills_, {"pick_up_object", {"mug1", "leftArm1"}}).set_name, "fast");
}

TEST_F(LimitsForTest, AStraightApproachIsSlowerThanItsSet) {
  const DriveLimits limits = LimitsFor(skills_, {"move_base_blind", {"home"}});
  EXPECT_EQ(limits.limits.max_linear_velocity, 0.3);
  EXPECT_EQ(limits.limits.max_angular_velocity, 0.5);
  EXPECT_EQ(limits.limits.max_linear_acceleration, 2.5);
}

}  // namespace
}  // namespace hires::control::drive_permit_test
