#include <gmock/gmock.h>

#include "hires/perception/camera_view.h"
#include "loop/loop_parts.h"
#include "loop/task_loop.h"
#include "loop/tracker.h"
#include "sim_robot/sim_robot_sensors.h"

namespace hires::loop::tracker_tray_test {
namespace {

using geometry::Pose3;
using sim_robot::SimRobotWorld;

const std::string kMill = "peppermill1";

const LoopSetup::Parts& Parts() {
  static const LoopSetup setup(HIRES_SOURCE_DIR "/config/loop.yaml");
  return setup.parts();
}

imagination::StartState MillOnTray() {
  imagination::StartState start =
      sim_robot::StartOf(Parts().world, HIRES_SOURCE_DIR "/config/scenarios/topple.yaml", "");
  start.world.objects.at(0).X_MO = geometry::Lift(start.robot.X_MB) * Parts().world.scene->X_BO;
  return start;
}

/// The robot stands with a mill on its tray, at which its camera looks once, in the beginning. What
/// is sensed goes to a tracker, ten times a second a scan of the tray with it.
class TrackerTrayTest : public testing::Test {
 protected:
  TrackerTrayTest() {
    blackboard_.Load({HIRES_SOURCE_DIR "/config/knowledge/restaurant.yaml"}, 1);
    Play(0.5);
    perception::Detection mill{kMill, Truth().model, {}, 1.0};
    const robot::Robot& robot = world_.scene()->robot;
    const auto view = perception::ViewFrom(
        robot, world_.simulator().X_MLink(robot.profile.upper_body->camera_link));
    mill.X_CO = view.X_MC.Inverse() * Truth().X_MO;
    tracker_.See(clock_.now(), {{mill}, {}});
    Play(1.0);
  }

  world::ObjectState Truth() const { return *world_.simulator().GetWorldState().Find(kMill); }

  void Play(double duration) {
    const double end = clock_.now() + duration;
    while (clock_.now() < end - 1e-6) {
      clock_.At(1.0 + 0.001 * static_cast<double>(world_.milliseconds()), [this] { Sense(); });
      while (clock_.Step()) continue;
      world_.Advance(sim_robot::kSensorTick);
    }
  }

  void Sense() {
    SensorNews news;
    news.stamp = clock_.now();
    news.readings = world_.Sense();
    news.is_tick = true;
    if (has_laser_) {
      const auto& lasers = sensors_.lasers();
      news.tray = TrayScan{lasers.tray().link, ReadingOf(lasers.TrayScan(world_), lasers.tray())};
    }
    tracker_.Hear(news, sensors_.laser());
  }

  /// What the Blackboard says; empty: nothing.
  std::string AreaOf(const std::string& object) const {
    const knowledge::Fluent* on = blackboard_.view().Find("on" + object);
    if (on == nullptr) return "";
    for (const knowledge::Property& property : on->properties) {
      if (property.role == "hasArea") return std::get<std::string>(property.filler);
    }
    return "";
  }

  VirtualClock clock_{1.0};
  Blackboard blackboard_{Parts().ontology};
  SimRobotWorld world_{Parts().world, MillOnTray(), 1, Parts().ReadTruth("same")};
  sim_robot::SimRobotSensors sensors_{Parts().SensorsUnder(Parts().ReadTruth("same")), 1,
                                      world_.scene()};
  Tracker tracker_{Parts().world,
                   Parts().context,
                   FramesOf(world_.scene()->robot),
                   Parts().config.tracker,
                   &clock_,
                   &blackboard_,
                   {[](double, const world::WorldState&) {}, [](const robot::JointTrajectory&) {},
                    [](double) {}}};
  bool has_laser_{true};
};

TEST_F(TrackerTrayTest, WhatStandsOnTheTrayIsKnownToStandThere) {
  Play(5.0);
  EXPECT_THAT(AreaOf(kMill), testing::HasSubstr("rayArea")) << "of the robot";
}

TEST_F(TrackerTrayTest, WhatIsKnockedOffTheTrayIsKnownToBeGoneWithoutALookOfTheCamera) {
  ASSERT_NE(AreaOf(kMill), "");
  ASSERT_EQ(world_.Drop(kMill), "");
  Play(1.0);
  EXPECT_EQ(AreaOf(kMill), "");
}

TEST_F(TrackerTrayTest, WithoutTheTraysLaserNobodyKnows) {
  has_laser_ = false;
  ASSERT_EQ(world_.Drop(kMill), "");
  Play(5.0);
  EXPECT_NE(AreaOf(kMill), "");
}

TEST_F(TrackerTrayTest, WhatSomebodyPutsOnTheTrayIsThereThoughNobodyKnowsWhatItIs) {
  Pose3 X_MO = Truth().X_MO;
  X_MO.translation += X_MO.rotation * Eigen::Vector3d(0.0, 0.15, 0.001);
  ASSERT_EQ(world_.Place("guest1", "coffee_cup", X_MO), "");
  Play(4.0);
  EXPECT_NE(AreaOf("unknown1"), "");
  EXPECT_NE(AreaOf(kMill), "");
}

}  // namespace
}  // namespace hires::loop::tracker_tray_test
