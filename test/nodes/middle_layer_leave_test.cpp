#include "nodes/middle_layer/middle_layer_leave.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hires/ros/conversions.h"

namespace hires_ros {
namespace {

using hires::BaseGuardState;
using Code = hires::base::FailureCode;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::uint64_t kNow = 1'700'000'000'000'000'000;  // [ns]

class BaseLeaveTest : public ::testing::Test {
 protected:
  static BaseGuardState State(std::uint8_t state, std::uint64_t request,
                              const hires::base::Failure& failure) {
    BaseGuardState msg;
    msg.state = state;
    msg.request = request;
    msg.failure = ToMsg(failure);
    return msg;
  }

  std::vector<hires::BaseRequest> sent_;
  std::vector<std::string> stops_;
  BaseLeave leave_{0.03,
                   {[this](const hires::BaseRequest& request) { sent_.push_back(request); },
                    [this](const hires::base::Failure& why) { stops_.push_back(ToString(why)); }}};
  const DriveLimits slow_{"slow", {0.30, 1.0, 1.4, 2.0}, 0.8, 3.0};
};

TEST_F(BaseLeaveTest, NothingIsAskedWhileNobodyDrives) {
  leave_.Tick(0.0);
  EXPECT_THAT(sent_, IsEmpty());
  EXPECT_EQ(leave_.id(), 0u);
}

TEST_F(BaseLeaveTest, ARequestSaysHowFastAndHowHardToBrake) {
  leave_.Begin(1, slow_, kNow);
  leave_.Tick(0.0);
  ASSERT_THAT(sent_, SizeIs(1));
  EXPECT_EQ(sent_[0].id, kNow);
  EXPECT_EQ(sent_[0].set_name, "slow");
  EXPECT_EQ(sent_[0].max_linear_velocity, 0.30);
  EXPECT_EQ(sent_[0].max_angular_velocity, 1.0);
  EXPECT_EQ(sent_[0].max_linear_acceleration, 1.4);
  EXPECT_EQ(sent_[0].max_angular_acceleration, 2.0);
  EXPECT_EQ(sent_[0].max_braking, 0.8);
  EXPECT_EQ(sent_[0].max_braking_jerk, 3.0);
}

TEST_F(BaseLeaveTest, ItIsRepeatedAtItsPeriodAsLongAsTheActionLasts) {
  leave_.Begin(1, slow_, kNow);
  for (int i = 0; i <= 100; ++i) leave_.Tick(0.01 * i);
  EXPECT_THAT(sent_, SizeIs(::testing::Ge(20u)));
  EXPECT_THAT(sent_, SizeIs(::testing::Le(35u)));
  for (const auto& request : sent_) EXPECT_EQ(request.id, kNow);
  leave_.End(7);  // another action, which had no base
  leave_.Tick(2.0);
  EXPECT_EQ(sent_.back().id, kNow);
  leave_.End(1);
  EXPECT_EQ(sent_.back().id, 0u);
  const std::size_t num_sent = sent_.size();
  leave_.Tick(3.0);
  EXPECT_THAT(sent_, SizeIs(num_sent));
}

TEST_F(BaseLeaveTest, EachActionHasANewIdAlsoWhenTheWallsClockGoesBack) {
  leave_.Begin(1, slow_, kNow);
  leave_.End(1);
  leave_.Begin(2, slow_, kNow - 5'000'000'000);
  EXPECT_EQ(leave_.id(), kNow + 1);
}

TEST_F(BaseLeaveTest, AStopIsToldOnceAndOnlyToWhomItConcerns) {
  leave_.OnState(State(BaseGuardState::STANDING, 0, Code::kNoRequest));
  leave_.Begin(1, slow_, kNow);
  leave_.OnState(State(BaseGuardState::STANDING, kNow - 1, Code::kStaleScan));
  leave_.OnState(State(BaseGuardState::PASSING, kNow, {}));
  EXPECT_THAT(stops_, IsEmpty());
  leave_.OnState(State(BaseGuardState::BRAKING, kNow, Code::kMotorsHalted));
  leave_.OnState(State(BaseGuardState::STANDING, kNow, Code::kMotorsHalted));
  EXPECT_THAT(stops_, ElementsAre("motors_halted"));
  leave_.End(1);
  leave_.Begin(2, slow_, kNow);
  leave_.OnState(State(BaseGuardState::STANDING, kNow + 1, Code::kMotorsHalted));
  EXPECT_THAT(stops_, ElementsAre("motors_halted", "motors_halted"));
}

TEST_F(BaseLeaveTest, AGuardThatWasStartedAnewEndsTheDrive) {
  leave_.Begin(1, slow_, kNow);
  leave_.OnState(State(BaseGuardState::STANDING, 0, Code::kNoRequest));  // from before the request
  EXPECT_THAT(stops_, IsEmpty());
  leave_.OnState(State(BaseGuardState::PASSING, kNow, {}));
  leave_.OnState(State(BaseGuardState::STANDING, 0, Code::kNoRequest));
  leave_.OnState(State(BaseGuardState::PASSING, kNow, {}));
  EXPECT_THAT(stops_, ElementsAre("guard_restarted"));
  EXPECT_FALSE(*leave_.granted());
}

TEST_F(BaseLeaveTest, WhatStandsOnTheTrayMayChange) {
  leave_.Begin(1, slow_, kNow);
  leave_.SetBraking(0.5, 2.0);
  leave_.Tick(0.0);
  EXPECT_EQ(sent_.back().max_braking, 0.5);
  EXPECT_EQ(sent_.back().max_braking_jerk, 2.0);
}

class LimitsForTest : public ::testing::Test {
 protected:
  LimitsForTest() {
    skills_.motion_sets = {{"fast", {0.55, 1.0, 2.5, 3.2}}, {"slow", {0.30, 1.0, 1.4, 2.0}}};
    skills_.default_motion_set = "fast";
  }
  hires::skills::SkillSet skills_;
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
}  // namespace hires_ros
