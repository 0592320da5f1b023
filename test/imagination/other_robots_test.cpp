// Robots that are no PR2: two driven wheels, parallel fingers, one arm.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hires/imagination/evidence.h"
#include "hires/imagination/rollout_recording.h"
#include "hires/robot/load_robot.h"
#include "imagination/restaurant_rollouts.h"
#include "imagination/room_rollouts.h"

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
