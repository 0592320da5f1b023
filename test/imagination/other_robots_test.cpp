// Robots that are no PR2: two driven wheels, parallel fingers, one arm.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <thread>

#include "hires/imagination/evidence.h"
#include "hires/imagination/rollout_recording.h"
#include "hires/robot/load_robot.h"
#include "imagination/restaurant_rollouts.h"
#include "imagination/room_rollouts.h"
#include "support/rounds.h"

namespace hires::imagination::other_robots_test {
namespace {

using hires::test_support::Room;
using hires::test_support::RoomRollouts;
using hires::test_support::SomeUncertainty;

const std::string kRobots = std::string(HIRES_SOURCE_DIR) + "/config/robots/";

// ------------------------------------------------------------------------------- two driven wheels

TEST(DifferentialRobotTest, ItNeverMovesSideways) {
  const RolloutSetup setup =
      RoomRollouts(Room(), "mill", SomeUncertainty(), robot::LoadAnyRobot(kRobots + "cart.yaml"));
  int num_samples = 0, num_turning = 0, num_arrived = 0;
  for (int index = 0; index < HIRES_NUM_ROLLOUTS; ++index) {
    const auto recording = RecordRollout(setup, {"move_base_param", {"east", "fast"}}, index, {});
    ASSERT_TRUE(recording);
    num_arrived += recording->result.action_finished ? 1 : 0;
    for (const RolloutSample& sample : recording->samples) {
      ASSERT_EQ(sample.V_B.vy, 0.0) << "rollout " << index << " at " << sample.time << " s";
      ++num_samples;
      num_turning += std::abs(sample.V_B.wz) > 0.1 ? 1 : 0;
    }
  }
  EXPECT_GT(num_samples, 50 * HIRES_NUM_ROLLOUTS);
  EXPECT_GT(num_turning, HIRES_NUM_ROLLOUTS / 2) << "it has to steer by turning";
  EXPECT_GT(num_arrived, HIRES_NUM_ROLLOUTS * 95 / 100);
}

// The tutorial's robot, to whose goal it has to turn: as it turns, its believed place moves.
TEST(DifferentialRobotTest, NoDriveOfTheOwnRobotDithersAtItsGoal) {
  HIRES_LONG_CASE();
  ASSERT_EQ(setenv("ROS_PACKAGE_PATH", HIRES_SOURCE_DIR, 1), 0);  // of model://sun
  const std::string own = std::string(HIRES_SOURCE_DIR) + "/examples/own_robot/";
  SetupConfig config = ReadSetupConfig(std::string(HIRES_SOURCE_DIR) + "/config/scene.yaml");
  config.world = own + "hall.world";
  config.robot = own + "courier.yaml";
  config.objects = own + "objects.yaml";
  const ImaginationSetup hall = LoadImaginationSetup(config);
  const StartState start = MakeStartState(hall, {{"RobotAt", {"kitchenDoor"}}});
  const RolloutSetup setup = MakeRolloutSetup(hall, start, 1);
  for (const char* motion_set : {"slow", "fast"}) {
    std::vector<double> durations;
    for (int index = 0; index < 64; ++index) {
      const auto result =
          PlayRollout(setup, {"move_base_param", {"atRoundTable", motion_set}}, index);
      EXPECT_FALSE(FailureOf(*result)) << motion_set << " " << index;
      durations.push_back(result->duration);
    }
    std::sort(durations.begin(), durations.end());
    EXPECT_LT(durations.back(), 2.0 * durations[32]) << motion_set;
  }
}

// ------------------------------------------------------------------------- steered like a car

constexpr double kRadius = 0.6;
constexpr int kNumDrives = HIRES_NUM_ROLLOUTS / 5;

RolloutSetup CarRollouts() {
  robot::Robot car = hires::test_support::TrayRobot();
  car.profile.base_controller.drive = robot::Drive::kCarLike;
  car.profile.base_controller.min_turning_radius = kRadius;
  car.profile.base_controller.command_lag = 0.05;
  car.profile.base_controller.loop_frequency = 20.0;
  car.profile.base_controller.loop_damping = 0.8;
  return RoomRollouts(Room(), "mill", SomeUncertainty(), car);
}

TEST(CarLikeRobotTest, ItCarriesItsLoadOnArcsThatItCanSteer) {
  const RolloutSetup setup = CarRollouts();
  for (const char* area : {"east", "corner"}) {
    int num_arrived = 0, num_hard_over = 0;
    for (int index = 0; index < kNumDrives; ++index) {
      const auto recording = RecordRollout(setup, {"move_base_param", {area, "slow"}}, index, {});
      ASSERT_TRUE(recording);
      num_arrived += FailureOf(recording->result) ? 0 : 1;
      for (const RolloutSample& sample : recording->samples) {
        ASSERT_EQ(sample.V_B.vy, 0.0) << "rollout " << index << " at " << sample.time << " s";
        const double sharpest = std::abs(sample.V_B.vx) / kRadius;
        ASSERT_LE(std::abs(sample.V_B.wz), sharpest + 1e-9)
            << "rollout " << index << " at " << sample.time << " s";
        num_hard_over += std::abs(sample.V_B.wz) > 0.8 * sharpest && sharpest > 0.1 ? 1 : 0;
      }
    }
    EXPECT_GE(num_arrived, kNumDrives * 95 / 100) << area;
    EXPECT_GT(num_hard_over, kNumDrives) << area << ": it has to steer";
  }
}

TEST(CarLikeRobotTest, ProfileAndBareUrdfAreDrivenBothWays) {
  for (const char* path : {"/config/robots/car.yaml", "/urdf/car.urdf"}) {
    const RolloutSetup setup =
        RoomRollouts(Room(), "", "none", robot::LoadAnyRobot(HIRES_SOURCE_DIR + std::string(path)));
    for (const char* speed : {"fast", "slow"}) {
      const auto result = PlayRollout(setup, {"move_base_param", {"corner", speed}}, 0);
      EXPECT_TRUE(result->action_finished) << path << " " << speed;
      EXPECT_FALSE(FailureOf(*result)) << path << " " << speed;
    }
    EXPECT_TRUE(PlayRollout(setup, {"move_base_blind", {"corner"}}, 0)->action_finished) << path;
  }
}

TEST(CarLikeRobotTest, WorkersPlayTheSameBits) {
  const RolloutSetup setup = CarRollouts();
  const base::ActionCall drive{"move_base_param", {"corner", "fast"}};
  constexpr int kNumPlayed = 6;
  std::vector<RolloutResult> alone(kNumPlayed), beside(kNumPlayed);
  for (int i = 0; i < kNumPlayed; ++i) alone[i] = *PlayRollout(setup, drive, i);
  const auto play = [&](int first) {
    for (int i = first; i < kNumPlayed; i += 2) beside[i] = *PlayRollout(setup, drive, i);
  };
  std::thread other(play, 1);
  play(0);
  other.join();
  for (int i = 0; i < kNumPlayed; ++i) {
    EXPECT_TRUE(SameOutcome(alone[i], beside[i])) << i;
    EXPECT_EQ(alone[i].duration, beside[i].duration) << i;
    EXPECT_EQ(alone[i].final_robot.X_MB.x, beside[i].final_robot.X_MB.x) << i;
    EXPECT_EQ(alone[i].final_robot.X_MB.yaw, beside[i].final_robot.X_MB.yaw) << i;
  }
}

// ---------------------------------------------------------------------------- an arm that is no
// PR2's

/// The restaurant with a Fetch in it.
const ImaginationSetup& FetchInRestaurant() {
  static const ImaginationSetup setup = [] {
    SetupConfig config = ReadSetupConfig(std::string(HIRES_SOURCE_DIR) + "/config/scene.yaml");
    config.robot = kRobots + "fetch.yaml";
    return LoadImaginationSetup(config);
  }();
  return setup;
}

/// With everything uncertain that the package knows about.
std::vector<RolloutResult> Play(const std::vector<base::Atom>& atoms,
                                const base::ActionCall& action) {
  const StartState start = MakeStartState(FetchInRestaurant(), atoms);
  const RolloutSetup setup = MakeRolloutSetup(FetchInRestaurant(), start, 3);
  std::vector<RolloutResult> results;
  for (int index = 0; index < 10; ++index) results.push_back(*PlayRollout(setup, action, index));
  return results;
}

std::string Text(const Evidence& evidence) {
  std::string text;
  for (const auto& [failure, count] : evidence.failures) {
    text += base::ToString(failure) + " " + std::to_string(count) + "\n";
  }
  return text;
}

TEST(FetchTest, ItPicksUpAMug) {
  const std::vector<base::Atom> atoms{{"RobotAt", {"manipulationAreaEastCounter1"}},
                                      {"HasArmPosture", {"rightArm1", "ArmToSidePosture"}},
                                      {"On", {"mug1", "placingAreaEastRightCounter1"}}};
  const auto results = Play(atoms, {"pick_up_object", {"mug1", "rightArm1"}});
  const Evidence evidence = SumUp(results);
  EXPECT_GE(evidence.success.share, 0.7) << Text(evidence);
  for (const RolloutResult& result : results) {
    if (FailureOf(result)) continue;
    EXPECT_EQ(result.final_world.Find("mug1")->attached_to, "gripper_link");
    const Eigen::Vector3d stood{5.47, 10.16, 0.75};  // the placing area
    EXPECT_GT((result.final_world.Find("mug1")->X_MO.translation - stood).norm(), 0.3);
  }
}

TEST(FetchTest, ItPutsAMugDown) {
  const std::vector<base::Atom> atoms{{"RobotAt", {"manipulationAreaEastCounter1"}},
                                      {"HasArmPosture", {"rightArm1", "ArmToSidePosture"}},
                                      {"Holding", {"rightArm1", "mug1"}}};
  const auto results =
      Play(atoms, {"place_object", {"mug1", "rightArm1", "placingAreaEastRightCounter1"}});
  const Evidence evidence = SumUp(results);
  EXPECT_GE(evidence.success.share, 0.7) << Text(evidence);
  for (const RolloutResult& result : results) {
    if (FailureOf(result)) continue;
    const world::ObjectState& mug = *result.final_world.Find("mug1");
    EXPECT_EQ(mug.attached_to, "");
    EXPECT_NEAR(mug.X_MO.translation.z(), 0.75, 0.01);
  }
}

TEST(FetchTest, ItDrivesWithAMugInItsHand) {
  const std::vector<base::Atom> atoms{{"RobotAt", {"preManipulationAreaEastCounter1"}},
                                      {"HasArmPosture", {"rightArm1", "ArmCarryPosture"}},
                                      {"Holding", {"rightArm1", "mug1"}}};
  const auto results = Play(atoms, {"move_base_param", {"preManipulationAreaSouthTable1", "fast"}});
  const Evidence evidence = SumUp(results);
  EXPECT_GE(evidence.success.share, 0.9) << Text(evidence);
  for (const RolloutResult& result : results) {
    EXPECT_EQ(result.final_world.Find("mug1")->attached_to, "gripper_link");
  }
}

}  // namespace
}  // namespace hires::imagination::other_robots_test
