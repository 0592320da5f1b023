#include "hires/control/tray_load.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scenes.h"

namespace hires::control::tray_load_test {
namespace {

using geometry::Pose2;
using robot::Observation;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;

const Pose2 kX_MB{3.0, 2.0, 1.2};

robot::SeenObject Seen(const world::ObjectState& object) {
  return {object.name, object.model, object.X_MO, 1.0, object.attached_to};
}

class LoadTest : public ::testing::Test {
 protected:
  LoadTest() {
    seen_.X_MB = kX_MB;
    auto tall = hires::test_support::Mill("tall", 0.40, 0.03);
    hires::test_support::AddModel(&world_, std::move(tall));
  }
  /// @param p_TO  from the tray's middle [m]
  void Put(const std::string& name, const std::string& model, const Eigen::Vector2d& p_TO) {
    seen_.objects.push_back(Seen(hires::test_support::OnTray(name, model, kX_MB, p_TO)));
  }
  std::optional<navigation::BrakingLimits> Braking(bool has_eyes = true) const {
    return BrakingFor(robot_, world_, seen_, has_eyes, params_);
  }

  world::World world_ = hires::test_support::Room();
  robot::Robot robot_ = hires::test_support::TrayRobot();
  navigation::BrakingParams params_;
  Observation seen_;
};

TEST_F(LoadTest, WhatStandsOverThePlateIsOnTheTray) {
  Put("mill1", "mill", {0.0, 0.0});
  Put("mill2", "mill", {0.05, 0.2});
  Put("mill3", "mill", {0.5, 0.0});   // before the robot
  Put("mill4", "mill", {0.0, -0.4});  // beside it
  Put("mill5", "mill", {0.0, 0.1});
  seen_.objects.back().X_MO.translation.z() = 0.0;  // on the floor below
  Put("mill6", "mill", {0.0, 0.1});
  seen_.objects.back().attached_to = "palm";
  const auto name = [](const char* is) { return Field(&robot::SeenObject::name, std::string(is)); };
  EXPECT_THAT(OnTray(robot_, seen_), ElementsAre(name("mill1"), name("mill2")));
}

TEST_F(LoadTest, ARobotWithoutATrayCarriesNothingLoose) {
  Put("mill1", "mill", {0.0, 0.0});
  robot_.profile.tray_link.clear();
  EXPECT_THAT(OnTray(robot_, seen_), IsEmpty());
  EXPECT_EQ(Braking()->max_deceleration, params_.hardest.max_deceleration);
}

TEST_F(LoadTest, AnEmptyTrayLetsTheBaseBrakeItsHardest) {
  ASSERT_TRUE(Braking());
  EXPECT_EQ(Braking()->max_deceleration, params_.hardest.max_deceleration);
}

TEST_F(LoadTest, TheWeakestLoadSaysHowHardTheBaseMayBrake) {
  Put("mill1", "mill", {0.0, 0.0});
  const auto mill = Braking();
  Put("tall1", "tall", {0.0, 0.1});
  const auto both = Braking();
  ASSERT_TRUE(mill && both);
  EXPECT_LT(both->max_deceleration, mill->max_deceleration);
  EXPECT_LT(mill->max_deceleration, 9.81 * 0.037 / 0.137) << "g r / h: it would tip";
  seen_.objects.erase(seen_.objects.begin());
  EXPECT_EQ(Braking()->max_deceleration, both->max_deceleration);
}

TEST_F(LoadTest, WhatNobodyKnowsIsNotGuessed) {
  EXPECT_FALSE(Braking(false)) << "nobody looks";
  Put("vase1", "vase", {0.0, 0.0});
  EXPECT_FALSE(Braking()) << "no such model";
  seen_.objects.clear();
  Put("vase1", "vase", {1.0, 0.0});
  EXPECT_TRUE(Braking()) << "it is not on the tray";
}

TEST_F(LoadTest, WhatCannotStandIsNotGuessedEither) {
  auto leaning = hires::test_support::Mill("leaning");
  leaning.mass_properties.p_BBcm.x() = 0.1;
  hires::test_support::AddModel(&world_, std::move(leaning));
  Put("leaning1", "leaning", {0.0, 0.0});
  EXPECT_FALSE(Braking());
}

}  // namespace
}  // namespace hires::control::tray_load_test
