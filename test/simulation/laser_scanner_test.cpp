#include "hires/simulation/laser_scanner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "arm_scene.h"
#include "hires/base/error.h"
#include "hires/geometry/angles.h"

namespace hires::simulation::laser_scanner_test {
namespace {

using test_arm::Pr2;

/// The PR2 in the middle of a closed room of 6 x 4 m, at (3, 2).
std::unique_ptr<RobotSimulator> InTheRoom(std::vector<world::ObjectState> objects, double yaw = 0) {
  static const auto scene = MakeScene(test_support::Room(), Pr2());
  return std::make_unique<RobotSimulator>(scene, Variation(), world::WorldState{std::move(objects)},
                                          test_support::StandingAt({3.0, 2.0, yaw}), base::Rng(1));
}

/// Distance from a point in the room to its walls, in a direction.
double ToWall(const Eigen::Vector2d& p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const double along_x = c > 0.0 ? (6.0 - p.x()) / c : c < 0.0 ? -p.x() / c : INFINITY;
  const double along_y = s > 0.0 ? (4.0 - p.y()) / s : s < 0.0 ? -p.y() / s : INFINITY;
  return std::min(along_x, along_y);
}

TEST(LaserScannerTest, SeesTheWallsOfARoomByClosedForm) {
  LaserParams params;
  params.noise = 0.0;
  for (const double yaw : {0.0, 0.7, -2.0}) {
    const auto simulator = InTheRoom({}, yaw);
    base::Rng rng(1);
    const std::vector<double> ranges = ScanLaser(*simulator, params, &rng);
    ASSERT_EQ(ranges.size(), 640u);
    const Eigen::Vector2d p = geometry::Pose2{3.0, 2.0, yaw} * Eigen::Vector2d(0.275, 0.0);
    for (int i = 0; i < 640; ++i) {
      const double angle = yaw - 2.2689 + i * 2.0 * 2.2689 / 639;
      ASSERT_NEAR(ranges[i], ToWall(p, angle), 1e-5) << i;
    }
  }
}

TEST(LaserScannerTest, SeesLooseObjectsAndFarAwayNothing) {
  LaserParams params;
  params.noise = 0.0;
  params.range_max = 1.5;
  world::ObjectState tower;
  tower.name = "tower1";
  tower.model = "tower";
  tower.X_MO.translation = {4.275, 2.0, 0.0002};
  base::Rng rng(1);
  const std::vector<double> ranges = ScanLaser(*InTheRoom({tower}), params, &rng);
  EXPECT_NEAR(std::min(ranges[319], ranges[320]), 1.0 - 0.037, 1e-3);
  EXPECT_TRUE(std::isinf(ranges[280]));
}

TEST(LaserScannerTest, NoiseHasItsDeviation) {
  const auto simulator = InTheRoom({});
  LaserParams params;
  base::Rng rng(3);
  const std::vector<double> noisy = ScanLaser(*simulator, params, &rng);
  params.noise = 0.0;
  const std::vector<double> exact = ScanLaser(*simulator, params, &rng);
  double squares = 0.0;
  for (int i = 0; i < 640; ++i) squares += (noisy[i] - exact[i]) * (noisy[i] - exact[i]);
  EXPECT_NEAR(std::sqrt(squares / 640), 0.005, 4.0 * 0.005 / std::sqrt(2.0 * 640));
}

/// Who plays skills with scans in a room.
class SkillsScanTest : public testing::Test {
 protected:
  static std::shared_ptr<const Scene> SceneWithScans() {
    Sight sight;
    sight.scans.emplace();
    sight.scans->laser.num_beams = 60;
    sight.scans->laser.noise = 0.01;
    sight.scans->period = 0.2;
    return MakeScene(test_support::Room(), Pr2(), {}, sight);
  }
  std::unique_ptr<RobotSimulator> Begin() const {
    return std::make_unique<RobotSimulator>(scene_, Variation(), world::WorldState{},
                                            test_support::StandingAt({3.0, 2.0, 0.5}),
                                            base::Rng(1));
  }
  static std::shared_ptr<const robot::PlacedScan> ScanAfter(RobotSimulator* simulator, int steps) {
    for (int i = 0; i < steps; ++i) simulator->Step();
    return simulator->Observe(0.0).scan;
  }

  std::shared_ptr<const Scene> scene_ = SceneWithScans();
};

TEST_F(SkillsScanTest, ScansComeAtTheirPeriod) {
  const auto simulator = Begin();
  const auto first = ScanAfter(simulator.get(), 0);
  ASSERT_TRUE(first);
  ASSERT_EQ(first->reading.ranges.size(), 60u);
  EXPECT_NEAR(first->X_BL.x, 0.275, 1e-3);
  const Eigen::Vector2d p = geometry::Pose2{3.0, 2.0, 0.5} * first->X_BL.position();
  EXPECT_NEAR(first->reading.ranges[0], ToWall(p, 0.5 - 2.2689), 0.05);
  EXPECT_EQ(ScanAfter(simulator.get(), 100), first) << "0.1 s later it is still the last";
  EXPECT_NE(ScanAfter(simulator.get(), 100), first);
  EXPECT_FALSE(InTheRoom({})->Observe(0.0).scan) << "a scene without scans has none";
}

/// The PR2 with its base laser mounted otherwise.
robot::Robot Pr2WithLaserAt(double roll, double pitch) {
  robot::Robot robot = Pr2();
  const auto laser = robot.model.FindLink(robot.profile.laser_link);
  robot.model.links[*laser].joint->X_PJ.rotation = geometry::RotationFromRpy(roll, pitch, 0.0);
  return robot;
}

TEST_F(SkillsScanTest, ALaserThatHangsUpsideDownIsTurnedOver) {
  Sight sight = scene_->sight;
  const auto scene = MakeScene(test_support::Room(), Pr2WithLaserAt(geometry::kPi, 0.0), {}, sight);
  RobotSimulator hanging(scene, Variation(), {}, test_support::StandingAt({3.0, 2.0, 0.5}),
                         base::Rng(1));
  const auto scan = ScanAfter(&hanging, 0);
  const geometry::Pose2 X_ML = geometry::Pose2{3.0, 2.0, 0.5} * scan->X_BL;
  const robot::ScanReading& reading = scan->reading;
  for (std::size_t i = 0; i < reading.ranges.size(); ++i) {
    const double angle = X_ML.yaw + reading.angle_min + i * reading.angle_increment;
    EXPECT_NEAR(reading.ranges[i], ToWall(X_ML.position(), angle), 0.05) << i;
  }
}

TEST_F(SkillsScanTest, ALaserThatIsTiltedIsRefused) {
  const auto message = [](const robot::Robot& robot, const Sight& sight) -> std::string {
    try {
      MakeScene(test_support::Room(), robot, {}, sight);
    } catch (const base::ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message(Pr2WithLaserAt(0.0, 0.3), scene_->sight)
                .find("its base laser 'base_laser_link' is tilted by 0.30 rad"),
            std::string::npos);
  EXPECT_EQ(message(Pr2WithLaserAt(0.0, 0.3), {}), "") << "nothing goes by its scans";
}

TEST_F(SkillsScanTest, ARestoredSimulatorScansTheSame) {
  const auto simulator = Begin();
  ScanAfter(simulator.get(), 100);
  const auto saved = simulator->Save();
  const auto before = ScanAfter(simulator.get(), 100);
  const auto other = Begin();
  other->Restore(*saved);
  EXPECT_EQ(ScanAfter(other.get(), 100)->reading.ranges, before->reading.ranges);
}

/// A tower of radius 0.037 m, its axis 1 m before the laser, whose left edge the first beam meets
/// with one half; the wall is 2.725 m ahead.
std::vector<double> ScanOfAnEdge(LaserParams params) {
  world::ObjectState tower;
  tower.name = "tower1";
  tower.model = "tower";
  tower.X_MO.translation = {4.275, 2.0, 0.0002};
  params.noise = 0.0;
  params.num_beams = 2;
  params.angle_min = std::asin(0.037);
  params.angle_max = 0.2;
  params.beam_width = 0.0133;
  base::Rng rng(1);
  return ScanLaser(*InTheRoom({tower}), params, &rng);
}

TEST(LaserScannerTest, ABeamOverAnEdgeMeasuresInBetween) {
  LaserParams params;
  params.mixing_depth = 3.0;
  const double near = std::sqrt(1.0 - 0.037 * 0.037), far = 2.725 / std::cos(std::asin(0.037));
  const std::vector<double> ranges = ScanOfAnEdge(params);
  EXPECT_NEAR(ranges[0], 0.5 * (near + far), 0.02);
  EXPECT_NEAR(ranges[1], 2.725 / std::cos(0.2), 0.002) << "beside the edge nothing is mixed";
}

TEST(LaserScannerTest, EchoesThatAreFarApartAreNotMixed) {
  const double near = std::sqrt(1.0 - 0.037 * 0.037), far = 2.725 / std::cos(std::asin(0.037));
  const double range = ScanOfAnEdge({})[0];
  EXPECT_LT(std::min(std::abs(range - near), std::abs(range - far)), 0.02) << range;
}

TEST(LaserScannerTest, SeesTheRobotOnlyWhereItIsTold) {
  LaserParams params;  // on the tray, looking around itself: torso behind it
  params.link = "base_tray_laser_link";
  params.noise = 0.0;
  params.angle_min = -3.1415;
  params.angle_max = 3.1415;
  const auto simulator = InTheRoom({});
  base::Rng rng(1);
  const auto nearest = [&] {
    const std::vector<double> ranges = ScanLaser(*simulator, params, &rng);
    return *std::min_element(ranges.begin(), ranges.end());
  };
  EXPECT_GT(nearest(), 1.0);
  params.sees_robot = true;
  EXPECT_LT(nearest(), 0.6);
}

TEST(LaserScannerTest, RefusesARobotWithoutSurroundings) {
  RobotSimulator simulator(test_support::RoomScene(), {}, {},
                           test_support::StandingAt({3.0, 2.0, 0.0}), base::Rng(1));
  base::Rng rng(1);
  EXPECT_THROW(ScanLaser(simulator, {}, &rng), std::logic_error);
}

}  // namespace
}  // namespace hires::simulation::laser_scanner_test
