// Rollouts of a robot that does not know exactly where it is: its place errs as drawn, as a
// filter's was found to, or as the filter's own.
#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "hires/imagination/rollout.h"
#include "imagination/restaurant_rollouts.h"
#include "imagination/same_bits.h"

namespace hires::imagination::place_rollout_test {
namespace {

using hires::test_support::ExpectSameBits;

const base::ActionCall kDrive{"move_base_param", {"preManipulationAreaSouthTable1", "fast"}};
const base::ActionCall kPick{"pick_up_object", {"mug1", "rightArm1"}};

const ImaginationSetup& RestaurantWith(const std::string& localisation) {
  static std::map<std::string, ImaginationSetup> setups;
  const auto known = setups.find(localisation);
  if (known != setups.end()) return known->second;
  SetupConfig config = ReadSetupConfig(std::string(HIRES_SOURCE_DIR) + "/config/scene.yaml");
  config.localisation = localisation;
  return setups.emplace(localisation, LoadImaginationSetup(config)).first->second;
}

RolloutSetup DriveBy(const std::string& localisation) {
  const ImaginationSetup& setup = RestaurantWith(localisation);
  RolloutSetup rollouts =
      MakeRolloutSetup(setup, MakeStartState(setup, "preManipulationAreaEastCounter1", {}), 3);
  rollouts.uncertainty = std::make_shared<const Uncertainty>(UncertaintyFromText("none", "test"));
  return rollouts;
}

/// Of the belief at 20 Hz.
std::vector<double> Errors(const RolloutSetup& setup, int index, RolloutResult* result) {
  std::vector<double> errors;
  const auto look = [&](const simulation::RobotSimulator& simulator, double) {
    const auto error = simulator.place_error();
    errors.push_back(error ? error->position().norm() : 0.0);
  };
  *result = PlayRollout(setup, kDrive, index, {{}, look, {}}).value();
  return errors;
}

class PlaceRolloutTest : public testing::TestWithParam<const char*> {};

TEST_P(PlaceRolloutTest, ADriveArrivesWhereTheRobotIsNotQuiteWhereItBelieves) {
  const RolloutSetup setup = DriveBy(GetParam());
  double squares = 0.0, n = 0.0;
  for (int index = 0; index < 4; ++index) {
    RolloutResult result;
    for (const double error : Errors(setup, index, &result)) {
      squares += error * error;
      ++n;
    }
    EXPECT_EQ(result.outcome, Outcome::kSucceeded) << ToString(result.failure);
  }
  EXPECT_GT(std::sqrt(squares / n), 0.005);  // [m] 0.02 of many drives
  EXPECT_LT(std::sqrt(squares / n), 0.06);
}

TEST_P(PlaceRolloutTest, TheSameSeedGivesTheSameBits) {
  const RolloutSetup setup = DriveBy(GetParam());
  RolloutResult first, again, other;
  const std::vector<double> errors = Errors(setup, 0, &first);
  EXPECT_EQ(Errors(setup, 0, &again), errors);
  ExpectSameBits(first, again);
  EXPECT_NE(Errors(setup, 1, &other), errors);
}

/// The camera tells where the mug is by where the robot takes itself to be, and the hand goes there
/// by the same error.
TEST_P(PlaceRolloutTest, AMugIsPickedUpAllTheSame) {
  const ImaginationSetup& setup = RestaurantWith(GetParam());
  std::vector<base::Atom> atoms = test_support::ReadyAt("manipulationAreaEastCounter1");
  atoms.push_back({"On", {"mug1", "placingAreaEastRightCounter1"}});
  const RolloutSetup rollouts = MakeRolloutSetup(setup, MakeStartState(setup, atoms), 7);
  int num_held = 0;
  for (int index = 0; index < 6; ++index) {
    const auto result = PlayRollout(rollouts, kPick, index).value();
    num_held += result.outcome == Outcome::kSucceeded;
  }
  EXPECT_GE(num_held, 5);
}

INSTANTIATE_TEST_SUITE_P(Places, PlaceRolloutTest, testing::Values("fitted", "filter"));

}  // namespace
}  // namespace hires::imagination::place_rollout_test
