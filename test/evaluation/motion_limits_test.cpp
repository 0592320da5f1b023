#include "hires/evaluation/motion_limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/physics/closed_forms.h"

namespace hires::evaluation::motion_limits_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kScaleStep = 0.03;  // a limit lies so far below what nothing bears
constexpr double kModel = 0.002;     // by so much the model's numbers are rounded
const physics::UprightCylinder kMill{0.037, 0.274, 0.140};  // peppermill1

imagination::ImaginationSetup SetupWith(
    const std::function<void(robot::BaseControllerParams*)>& change = nullptr,
    const std::string& uncertainty = "none") {
  const std::string folder = std::string(HIRES_SOURCE_DIR) + "/config/";
  imagination::SetupConfig config = imagination::ReadSetupConfig(folder + "scene.yaml");
  config.uncertainty = uncertainty.empty() ? config.uncertainty : uncertainty;
  imagination::ImaginationSetup setup = imagination::LoadImaginationSetup(config);
  if (change) {
    simulation::Scene scene = *setup.scene;
    change(&scene.robot.profile.base_controller);
    setup.scene = simulation::MakeScene(scene.world, scene.robot, scene.memory);
  }
  return setup;
}

/// Follows exactly, so that closed forms speak of it; at its time-out it stops within a step.
void MakeIdeal(robot::BaseControllerParams* controller) {
  controller->loop_frequency = controller->command_lag = controller->sway_compliance = 0.0;
  controller->stops_at_timeout = true;
}

LimitsRequest Mill(double max_fall) {
  LimitsRequest request;
  request.object = "peppermill1";
  request.max_fall = max_fall;
  return request;
}

TEST(MotionLimitsTest, SoManyTruthsWithoutAFallTellEnough) {
  EXPECT_EQ(NumTruths(0.01), 299);
  EXPECT_EQ(NumTruths(0.05), 59);
  EXPECT_EQ(NumTruths(0.5), 5);
  for (const double share : {0.001, 0.0137, 0.2}) {
    const int n = NumTruths(share);
    EXPECT_LE(std::pow(1.0 - share, n), 0.05);
    EXPECT_GT(std::pow(1.0 - share, n - 1), 0.05);
  }
}

TEST(MotionLimitsTest, TheSpeedOfALockedWheelIsTheClosedForms) {
  const auto report = FindLimits(Mill(0.5), SetupWith(MakeIdeal), {});
  ASSERT_TRUE(report);
  const double speed = physics::SuddenStopTopplingSpeed(kMill, 9.81);
  EXPECT_NEAR(report->Of("speed").closed_form, speed, kModel * speed);
  EXPECT_NEAR(report->Of("speed").value, speed, 2.0 * kScaleStep * speed);
  // From that speed no stop overturns it, however hard: the impulse is the hardest.
  EXPECT_EQ(report->Of("deceleration").value, report->Of("deceleration").robots_own);
  const double tips = physics::TippingAcceleration(kMill, 9.81);
  EXPECT_NEAR(report->Of("deceleration").closed_form, tips, kModel * tips);
}

TEST(MotionLimitsTest, AControllersOwnStopOverturnsFromWhereThePulseIsLongEnough) {
  constexpr double kBraking = 4.0;  // [m/s^2]
  const auto setup = SetupWith([](robot::BaseControllerParams* controller) {
    MakeIdeal(controller);
    controller->stops_at_timeout = false;
    controller->limits.max_linear_acceleration = kBraking;
  });
  const auto report = FindLimits(Mill(0.5), setup, {});
  ASSERT_TRUE(report);
  const double speed = kBraking * physics::OverturningPulseDuration(kMill, kBraking, 9.81);
  ASSERT_LT(speed, report->Of("speed").robots_own);
  EXPECT_NEAR(report->Of("speed").value, speed, 2.0 * kScaleStep * speed);
}

TEST(MotionLimitsTest, WhoAllowsMoreFallsMayGoFurther) {
  const auto setup = SetupWith(nullptr, "");
  const auto strict = FindLimits(Mill(0.1), setup, {2, {}, {}});
  const auto lax = FindLimits(Mill(0.4), setup, {2, {}, {}});
  ASSERT_TRUE(strict && lax);
  EXPECT_LE(strict->Of("speed").value, lax->Of("speed").value);
  EXPECT_LT(lax->Of("speed").value, lax->Of("speed").robots_own);
  EXPECT_EQ(strict->num_truths, 29);
}

TEST(MotionLimitsTest, NewTruthsFallMoreOftenAboveALimit) {
  LimitsRequest request = Mill(0.4);
  request.check_truths = 20;
  const auto report = FindLimits(request, SetupWith(nullptr, ""), {2, {}, {}});
  ASSERT_TRUE(report);
  const LimitCheck& speed = *report->Of("speed").check;
  EXPECT_LE(speed.falls_at, 8);
  ASSERT_TRUE(speed.falls_above);
  EXPECT_GE(*speed.falls_above, speed.falls_at);
  EXPECT_THAT(LimitsText(*report), HasSubstr("of 20 new"));
}

TEST(MotionLimitsTest, AnyNumberOfThreadsFindsTheSame) {
  const auto setup = SetupWith(nullptr, "");
  const auto one = FindLimits(Mill(0.3), setup, {1, {}, {}});
  const auto three = FindLimits(Mill(0.3), setup, {3, {}, {}});
  ASSERT_TRUE(one && three);
  EXPECT_EQ(ToJson(*one).dump(), ToJson(*three).dump());
}

TEST(MotionLimitsTest, WhatIsPastedIsNoMoreThanWhatHoldsTogether) {
  const auto report = FindLimits(Mill(0.4), SetupWith(nullptr, ""), {2, {}, {}});
  ASSERT_TRUE(report);
  const std::string yaml = LimitsYaml(*report);
  base::ParamReader pasted = base::ParamReader::FromString(yaml, "pasted").Sub("DWAPlannerROS");
  const double share = report->Of("together").value;
  const auto number = [&](const std::string& key) { return pasted.Get(key, base::Positive()); };
  EXPECT_LE(number("max_vel_x"), share * report->Of("speed").value);
  EXPECT_GT(number("max_vel_x"), share * report->Of("speed").value - 0.0011);
  EXPECT_LE(number("acc_lim_x"), share * report->Of("deceleration").value);
  EXPECT_LE(number("max_vel_theta"), share * report->Of("turning").value);
  EXPECT_EQ(number("max_vel_y"), number("max_vel_x"));
  const auto wheels =
      SetupWith([](auto* controller) { controller->drive = robot::Drive::kDifferential; });
  const auto two_wheels = FindLimits(Mill(0.5), wheels, {});
  ASSERT_TRUE(two_wheels);
  EXPECT_THAT(LimitsYaml(*two_wheels), testing::Not(HasSubstr("vel_y")));
}

TEST(MotionLimitsTest, EndsWhenItIsCancelled) {
  EXPECT_FALSE(FindLimits(Mill(0.3), SetupWith(nullptr, ""), {2, [] { return true; }, {}}));
}

TEST(MotionLimitsTest, SaysWhatCannotBeCarried) {
  const auto error_of = [](const std::string& object, const imagination::ImaginationSetup& setup) {
    LimitsRequest request = Mill(0.5);
    request.object = object;
    try {
      FindLimits(request, setup, {});
    } catch (const base::ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(error_of("pepermill1", SetupWith()), HasSubstr("peppermill1"));
  const auto hasty = SetupWith([](robot::BaseControllerParams* controller) {
    MakeIdeal(controller);
    controller->limits.max_linear_velocity = 12.0;
  });
  EXPECT_THAT(error_of("peppermill1", hasty),
              AllOf(HasSubstr("peppermill1"), HasSubstr("speed"), HasSubstr("--max-fall")));
}

}  // namespace
}  // namespace hires::evaluation::motion_limits_test
