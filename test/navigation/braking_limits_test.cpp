#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "hires/base/error.h"
#include "hires/navigation/base_guard.h"
#include "hires/navigation/braking.h"
#include "hires/navigation/standing_load.h"
#include "hires/world/object_catalogue.h"

namespace hires::navigation::braking_limits_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kConfig = std::string(HIRES_SOURCE_DIR) + "/config/base_guard.yaml";
const std::string kCatalogue = std::string(HIRES_SOURCE_DIR) + "/worlds/objects.yaml";

StandingLoad Load(const std::string& name) {
  return LoadOf(world::FindObjectModel(name, kCatalogue));
}

CarryingBase Pr2() {
  CarryingBase base;
  base.controller = robot::LoadRobot(std::string(HIRES_SOURCE_DIR) + "/config/robots/pr2.yaml")
                        .profile.base_controller;
  return base;
}

world::ObjectModel Brick(double com_x) {
  world::ObjectModel model;
  model.name = "brick";
  model.mass_properties.p_BBcm = {com_x, 0.0, 0.2};
  model.collisions.push_back({"body", geometry::Box{{0.1, 0.06, 0.4}}, {{0.0, 0.0, 0.2}, {}}, 0.5});
  return model;
}

std::string MessageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(StandingLoadTest, TheMillTipsWhereTheDissertationSays) {
  const StandingLoad mill = Load("peppermill1");
  EXPECT_NEAR(mill.support, 0.037, 1e-6);
  EXPECT_NEAR(mill.com_height, 0.137, 1e-9);
  EXPECT_NEAR(TippingAcceleration(mill, 9.81), 2.65, 0.005);  // r 0.037, h 0.274: g r / (h / 2)
  EXPECT_NEAR(TippingAcceleration(Load("race_peppermill"), 9.81), 9.81 * 0.035 / 0.15, 1e-6);
}

TEST(StandingLoadTest, ABoxTipsOverItsShortSide) {
  const StandingLoad brick = LoadOf(Brick(0.0));
  EXPECT_NEAR(brick.support, 0.03, 1e-9);
  EXPECT_NEAR(brick.com_height, 0.2, 1e-9);
  EXPECT_EQ(brick.friction, 0.5);
  EXPECT_NEAR(SlidingAcceleration(brick, 9.81), 4.905, 1e-9);
  EXPECT_NEAR(LoadOf(Brick(0.04)).support, 0.01, 1e-9);  // the mass is off its middle
}

TEST(StandingLoadTest, WhatCannotStandIsRefused) {
  EXPECT_THAT(MessageOf([] { LoadOf(Brick(0.06)); }),
              AllOf(HasSubstr("brick"), HasSubstr("0.060"), HasSubstr("centre of mass")));
}

TEST(StandingLoadTest, EverythingInTheCatalogueStands) {
  for (const auto& [name, model] : world::LoadCatalogueModels(kCatalogue)) {
    const StandingLoad load = LoadOf(*model);
    EXPECT_GT(load.support, 0.0) << name;
    EXPECT_GT(load.com_height, 0.0) << name;
  }
}

TEST(BrakingLimitsTest, TheMillsLimitIsWorkedByHand) {
  const BrakingParams params = ReadBaseGuardParams(kConfig).braking;
  const BrakingLimits limits = LimitsFor({Load("peppermill1")}, Pr2(), params);
  const double worst = 9.81 * (0.9 * 0.037 - 0.003) / (1.1 * 0.137);  // 1.972
  const double rise = 2.0 * M_PI / 17.0;                              // 0.370
  const double lean = 1.3 * 0.0049;
  const double body = 1.0 + 9.81 * lean * (1.0 + 1.0 / M_PI) + lean * 0.487 * 17.0 / rise;
  // Wheels on casters do not overshoot.
  EXPECT_NEAR(limits.max_deceleration, 0.8 * worst / body, 1e-6);
  EXPECT_NEAR(limits.max_jerk, limits.max_deceleration / rise, 1e-9);
  EXPECT_LT(limits.max_deceleration, 0.5 * TippingAcceleration(Load("peppermill1"), 9.81));
}

TEST(BrakingLimitsTest, TheWeakestLoadCounts) {
  const BrakingParams params;
  const StandingLoad mill = Load("peppermill1"), slab{"slab", 0.1, 0.02, 1.0};
  const double alone = LimitsFor({mill}, Pr2(), params).max_deceleration;
  EXPECT_EQ(LimitsFor({mill, slab}, Pr2(), params).max_deceleration, alone);
  EXPECT_EQ(LimitsFor({slab, mill}, Pr2(), params).max_deceleration, alone);
  EXPECT_LT(alone, LimitsFor({slab}, Pr2(), params).max_deceleration);
}

TEST(BrakingLimitsTest, WhatSlidesBeforeItTipsIsHeldByFriction) {
  StandingLoad plate{"plate", 0.1, 0.01, 0.1};
  BrakingParams params;
  params.margins = {1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  CarryingBase stiff;  // neither loop nor sway
  EXPECT_NEAR(LimitsFor({plate}, stiff, params).max_deceleration, 0.981, 1e-9);
}

TEST(BrakingLimitsTest, AnEmptyTrayIsBrakedAsHardAsAllowed) {
  const BrakingParams params;
  const BrakingLimits limits = LimitsFor({}, Pr2(), params);
  EXPECT_EQ(limits.max_deceleration, params.hardest.max_deceleration);
  EXPECT_EQ(limits.max_jerk, params.hardest.max_jerk);
}

TEST(BrakingLimitsTest, UnknownLoadsAreBrakedMoreGentlyThanEveryMill) {
  const BrakingParams params = ReadBaseGuardParams(kConfig).braking;
  for (const char* name : {"peppermill1", "race_peppermill", "race_peppermill1"}) {
    const BrakingLimits limits = LimitsFor({Load(name)}, Pr2(), params);
    EXPECT_LE(params.unknown_load.max_deceleration, limits.max_deceleration) << name;
    EXPECT_LE(params.unknown_load.max_jerk, limits.max_jerk) << name;
  }
}

TEST(BrakingLimitsTest, ALoadThatTheMarginsLetFallIsRefusedByName) {
  const StandingLoad needle{"needle", 0.003, 0.2, 1.0};
  EXPECT_THAT(MessageOf([&] { LimitsFor({needle}, Pr2(), {}); }),
              AllOf(HasSubstr("needle"), HasSubstr("3.0 mm")));
}

/// The configuration with one piece of text replaced by another.
std::string ConfigWith(const std::string& from, const std::string& to) {
  std::ifstream in(kConfig);
  std::stringstream text;
  text << in.rdbuf();
  std::string yaml = text.str();
  const auto at = yaml.find(from);
  if (at == std::string::npos) throw std::logic_error("no '" + from + "' in the configuration");
  const std::string path = ::testing::TempDir() + "base_guard_" +
                           std::to_string(std::hash<std::string>()(from + to)) + ".yaml";
  std::ofstream(path) << yaml.replace(at, from.size(), to);
  return path;
}

TEST(BaseGuardParamsTest, ReadsTheShippedFile) {
  const BaseGuardParams params = ReadBaseGuardParams(kConfig);
  EXPECT_EQ(params.pose_patience, 0.3);  // what the base's request for safety says
  EXPECT_EQ(params.scan_patience, 0.3);
  EXPECT_LT(params.request_patience, 0.2);  // the base controller's time-out
}

TEST(BaseGuardParamsTest, RefusesBadFilesByNameAndKey) {
  const auto message = [](const char* from, const char* to) {
    return MessageOf([&] { ReadBaseGuardParams(ConfigWith(from, to)); });
  };
  EXPECT_THAT(message("pose_patience: 0.3 ", "pose_patience: 0.0 "),
              AllOf(HasSubstr(".yaml"), HasSubstr("pose_patience"), HasSubstr("0.02")));
  EXPECT_THAT(message("scan_patience:", "scan_patiense:"), HasSubstr("scan_pati"));
  EXPECT_THAT(message("max_jerk: 2.5", "max_jerk: fast"),
              HasSubstr("braking.unknown_load.max_jerk"));
  EXPECT_THAT(message("support_share: 0.9", "support_share: 1.9"),
              HasSubstr("braking.margins.support_share"));
  EXPECT_THAT(message("{max_deceleration: 1.0,", "{max_deceleration: 1.8,"),
              AllOf(HasSubstr("unknown_load"), HasSubstr("hardest")));
  EXPECT_THAT(MessageOf([] { ReadBaseGuardParams("/nowhere/base_guard.yaml"); }),
              HasSubstr("/nowhere/base_guard.yaml"));
}

}  // namespace
}  // namespace hires::navigation::braking_limits_test
