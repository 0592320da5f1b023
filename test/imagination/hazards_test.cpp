#include "imagination/hazards.h"

#include <gmock/gmock.h>

#include "imagination/room_rollouts.h"
#include "imagination/same_bits.h"
#include "simulation/floor/robot_balance.h"

namespace hires::imagination::hazards_test {
namespace {

using hires::test_support::AddModel;
using hires::test_support::Block;
using hires::test_support::Mill;
using hires::test_support::Room;
using hires::test_support::RoomRollouts;
using hires::test_support::TrayRobot;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const base::ActionCall kFast{"move_base_param", {"east", "fast"}};
const base::ActionCall kSlow{"move_base_param", {"east", "slow"}};

/// The tray robot with all its mass `height` over the floor. Its footprint reaches 0.3 m back and
/// 0.325 m forward; fast (2 m/s^2 by its controller) accelerates over the rear edge.
robot::Robot Weighted(double height, double mass = 100.0) {
  robot::Robot robot = TrayRobot();
  geometry::MassProperties body;
  body.mass = mass;
  body.p_BBcm.z() = height;
  body.I_BBcm = mass * 0.1 * Eigen::Matrix3d::Identity();
  robot.model.links.front().inertial = body;
  return robot;
}

RolloutSetup LowLoad(const robot::Robot& robot) {
  world::World room = Room();
  AddModel(&room, Mill("block", 0.05, 0.1, 0.1));
  return RoomRollouts(room, "block", "none", robot);
}

RolloutResult Play(const RolloutSetup& setup, const base::ActionCall& action) {
  return *PlayRollout(setup, action, 0);
}

TEST(RobotTipsTest, TallRobotFailsFastAndNotSlow) {
  const RolloutSetup setup = LowLoad(Weighted(8.0));  // g b / c = 0.37 m/s^2
  const RolloutResult fast = Play(setup, kFast);
  EXPECT_EQ(fast.failure.code, base::FailureCode::kRobotTips);
  EXPECT_THAT(fast.failure.detail, AllOf(HasSubstr("rear edge"), HasSubstr("0.37 m/s^2")));
  EXPECT_THAT(HazardsOf(setup, {kFast}),
              Contains(AllOf(HasSubstr("the robot itself may tip over: motion set fast"),
                             HasSubstr("tips from 0.31 m/s^2 (100.1 kg"))));  // over its sides
}

TEST(RobotTipsTest, LowRobotPlaysTheSameBitsAsOneWithoutMasses) {
  const RolloutResult with = Play(LowLoad(Weighted(0.3)), kFast);
  const RolloutResult without = Play(LowLoad(TrayRobot()), kFast);
  EXPECT_TRUE(with.failure.code == base::FailureCode::kNone);
  hires::test_support::ExpectSameBits(with, without);
  EXPECT_THAT(HazardsOf(LowLoad(Weighted(0.3)), {kFast, kSlow}),
              Not(Contains(HasSubstr("may tip over"))));
}

TEST(RobotTipsTest, PulseShorterThanItTakesToOverturnDoesNotCount) {
  // 0.3 m/s are come to in 0.21 s by slow's 1.4 m/s^2: above g b / c, but over too soon.
  const RolloutSetup setup = LowLoad(Weighted(3.0));
  const auto balance =
      simulation::BalanceOf(setup.scene->robot, {}, {}, setup.scene->world.gravity);
  EXPECT_LT(balance->TippingAcceleration(robot::Drive::kDifferential), 1.4);
  EXPECT_EQ(Play(setup, kSlow).failure.code, base::FailureCode::kNone);
}

TEST(RobotTipsTest, HeavyPayloadCountsAsPartOfTheRobot) {
  world::World room = Room();
  AddModel(&room, Mill("load", 0.05, 0.1, 1000.0));
  const RolloutSetup setup = RoomRollouts(room, "load", "none", Weighted(0.3));
  const simulation::RobotSimulator start(setup.scene, {}, setup.world_state, setup.robot_state,
                                         base::Rng(1), setup.physics);
  const auto balance = simulation::BalanceOf(start);
  ASSERT_TRUE(balance);
  EXPECT_NEAR(balance->body_B.mass, 1100.0, 1e-9);
  // 0.2 m before the base's center, 0.375 m high: 100 kg at 0 and 0.3 m, 1000 kg there.
  EXPECT_NEAR(balance->body_B.p_BBcm.x(), 1000.0 * 0.2 / 1100.0, 1e-6);
  EXPECT_NEAR(balance->body_B.p_BBcm.z(), (100.0 * 0.3 + 1000.0 * 0.3752) / 1100.0, 1e-3);
}

TEST(RobotTipsTest, TurningSpeedsPushOutwards) {
  auto balance = simulation::BalanceOf(Weighted(1.0), {}, {}, 9.81);
  simulation::BaseMotion motion;
  motion.V_B = {2.0, 0.0, 2.0};  // 4 m/s^2 to the left; the right edge bears 0.25 g
  for (int i = 0; i < 2000 && !balance->tipped_over; ++i) balance->Step(motion, 0.002);
  ASSERT_TRUE(balance->tipped_over);
  EXPECT_THAT(balance->TippedText(), HasSubstr("right edge"));
}

TEST(RobotTipsTest, ShippedRobotsBearTheAccelerationOfTheirControllers) {
  for (const char* name : {"pr2", "cart", "car"}) {
    const robot::Robot robot =
        robot::LoadRobot(std::string(HIRES_SOURCE_DIR) + "/config/robots/" + name + ".yaml");
    const auto balance = simulation::BalanceOf(robot, robot.profile.joints, {}, 9.81);
    ASSERT_TRUE(balance) << name;
    EXPECT_FALSE(balance->support.is_assumed) << name;
    const robot::BaseControllerParams& controller = robot.profile.base_controller;
    EXPECT_GT(balance->TippingAcceleration(controller.drive),
              controller.limits.max_linear_acceleration)
        << name;
  }
}

TEST(RobotTipsTest, MissingMassesAndSupportAreSaid) {
  EXPECT_THAT(HazardsOf(LowLoad(TrayRobot()), {kFast}),
              Contains(HasSubstr("its URDF gives no masses")));
  EXPECT_THAT(
      HazardsOf(LowLoad(Weighted(0.3)), {kFast}),
      Contains(AllOf(HasSubstr("assumed of the robot, support: 0 of"), HasSubstr("footprint"))));
  robot::Robot leaning = Weighted(0.3);
  leaning.model.links.front().inertial->p_BBcm.x() = 0.4;
  EXPECT_THAT(HazardsOf(LowLoad(leaning), {kFast}), Contains(HasSubstr("it falls at rest")));
}

TEST(LiquidTest, FullVesselWarnsWithItsNumbers) {
  world::World room = Room();
  world::ObjectModel tea = Mill("tea", 0.09, 0.038);
  tea.liquid = world::Liquid{0.036, 0.077, 0.085};
  EXPECT_NEAR(SpillingAcceleration(*tea.liquid, 9.81), 1.09, 1e-9);
  AddModel(&room, tea);
  const std::vector<std::string> texts =
      HazardsOf(RoomRollouts(room, "tea", "none", Weighted(0.3)), {kFast});
  EXPECT_THAT(texts, Contains(AllOf(HasSubstr("the liquid in load may spill"),
                                    HasSubstr("2.00 m/s^2, which raises the surface by 7.3 mm"),
                                    HasSubstr("after a sudden start by 14.7 mm"),
                                    HasSubstr("the rim is 8.0 mm above it, reached from 1.09"))));
  EXPECT_THAT(texts, Not(Contains(HasSubstr("left out: liquids"))));
}

TEST(LiquidTest, VesselThatNothingIsKnownOfKeepsTheNote) {
  world::World room = Room();
  AddModel(&room, Mill("tea", 0.09, 0.038));
  EXPECT_THAT(HazardsOf(RoomRollouts(room, "tea"), {kFast}),
              Contains(AllOf(HasSubstr("left out: liquids that slosh"), HasSubstr("liquid:"))));
  EXPECT_THAT(HazardsOf(RoomRollouts(room, ""), {kFast}), Not(Contains(HasSubstr("liquids"))));
}

RolloutSetup WithSill(double y_size) {
  world::World room = Room();
  room.statics.push_back(Block("sill", {0.06, y_size, 0.025}, {3.0, 2.0, 0.0125}));
  return RoomRollouts(room, "mill", "none", Weighted(0.3));
}

TEST(ThresholdTest, RouteOverASillIsNamedWithItsHeight) {
  EXPECT_THAT(HazardsOf(WithSill(3.9), {kFast}),
              Contains(AllOf(HasSubstr("the route leads over 'sill' (0.025 m high)"),
                             HasSubstr("not simulated"))));
}

TEST(ThresholdTest, SillBesideTheRouteIsNotNamed) {
  world::World room = Room();
  room.statics.push_back(Block("sill", {0.06, 0.5, 0.025}, {3.0, 0.3, 0.0125}));
  EXPECT_THAT(HazardsOf(RoomRollouts(room, "mill"), {kFast}), Not(Contains(HasSubstr("sill"))));
}

TEST(ThresholdTest, MatBelowTheWholeRouteIsFloor) {
  world::World room = Room();
  room.statics.push_back(Block("mat", {6.0, 4.0, 0.004}, {3.0, 2.0, 0.002}));
  EXPECT_THAT(HazardsOf(RoomRollouts(room, "mill"), {kFast}), Not(Contains(HasSubstr("'mat'"))));
}

TEST(HazardsOfTest, ActionsThatDoNotDriveHaveNone) {
  EXPECT_THAT(HazardsOf(LowLoad(TrayRobot()), {}), IsEmpty());
}

}  // namespace
}  // namespace hires::imagination::hazards_test
