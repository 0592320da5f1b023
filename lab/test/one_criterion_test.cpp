// "A fall is 0.4 rad held for 0.2 s" is one line of one file. It changes everything that judges
// falls alike: what leans by 0.45 rad stands by the one line and has fallen by the other. What
// leans too far, but for less than the hold time, has not fallen. Markers are looked at in
// test/ros/trace_markers_test.cpp, skills in test/skills/object_skills_test.cpp, too.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hires/imagination/rollout.h"
#include "hires/simulation/truth_record.h"
#include "hires/translation/classification.h"
#include "lab/src/experiment/braking.h"
#include "lab/src/experiment/chain.h"
#include "lab/src/experiment/experiment.h"
#include "support/scene_copy.h"

namespace hires::lab::one_criterion_test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::Not;

constexpr double kLean = 0.45;  // [rad] of the stool, once it has tipped
constexpr char kHome[] = "west";

/// Everything that is read from a scene file.
struct Judges {
  explicit Judges(const std::string& scene, std::string its_load = "stool1")
      : load(std::move(its_load)) {
    config = ReadExperiment(std::string(HIRES_SOURCE_DIR) + "/lab/config/experiments/braking.yaml");
    config.scene = scene;
    config.uncertainty = "none";
    config.objects = {load};
    stage = std::make_shared<const Stage>(MakeStage(config));
  }
  const imagination::ImaginationSetup& setup() const { return stage->setup; }

  std::string load;
  ExperimentConfig config;
  std::shared_ptr<const Stage> stage;
};

class OneCriterionTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    as_it_is_ = new Judges(hires::test_support::SceneCopy().path());
    changed_ = new Judges(hires::test_support::SceneCopy(hires::test_support::kStandingLine,
                                                         hires::test_support::kOtherStandingLine)
                              .path());
  }
  static void TearDownTestSuite() {
    delete as_it_is_;
    delete changed_;
  }
  static const Judges *as_it_is_, *changed_;
};
const Judges* OneCriterionTest::as_it_is_ = nullptr;
const Judges* OneCriterionTest::changed_ = nullptr;

imagination::RolloutResult Drive(const Judges& judges) {
  const imagination::RolloutSetup setup = SetupAt(*judges.stage, kHome, 1);
  return imagination::PlayRollout(setup, DriveTo("nearStartArea1", "fast"), 0).value();
}

TEST_F(OneCriterionTest, RolloutsAreJudgedByIt) {
  const auto before = Drive(*as_it_is_), after = Drive(*changed_);
  EXPECT_NEAR(before.max_tilt, kLean, 0.05) << "it was to tip, and to lean on its rim";
  EXPECT_EQ(before.falls, 0);
  EXPECT_EQ(before.outcome, imagination::Outcome::kSucceeded);
  EXPECT_EQ(after.falls, 1);
  EXPECT_EQ(after.outcome, imagination::Outcome::kFailed);
  EXPECT_EQ(before.counts.topple, after.counts.topple) << "samples of Eq. 5.1 are something else";
}

Leg FirstLeg(const Judges& judges) {
  Chain::Options options;
  options.motion_set = "fast";
  return *Chain(judges.stage, kHome, options).Drive("nearStartArea1", [] { return false; });
}

TEST_F(OneCriterionTest, ChainsPutBackByIt) {
  EXPECT_FALSE(FirstLeg(*as_it_is_).was_put_back);
  EXPECT_TRUE(FirstLeg(*changed_).was_put_back);
}

/// The load tips at that speed [m/s] with the wheels locked at once.
BrakingStop StopAtOnce(const Judges& judges, double speed) {
  BrakingConfig braking = std::get<BrakingConfig>(judges.config.kind);
  braking.rollouts = 1;
  braking.loads = {judges.load};
  braking.motions = {{speed, 0.0}};
  braking.ways = {{BrakingWay::Kind::kAtOnce, 0.0, "at_once"}};
  return PlayBraking(braking, judges.config, *judges.stage, {})->front().stops.front();
}

TEST_F(OneCriterionTest, StopsAreJudgedByIt) {
  // It tips, with little to spare: no swing over its rim.
  const auto stop = [](const Judges& judges) { return StopAtOnce(judges, 0.12); };
  EXPECT_NEAR(stop(*as_it_is_).max_tilt, kLean, 0.05);
  EXPECT_FALSE(stop(*as_it_is_).fell);
  EXPECT_TRUE(stop(*changed_).fell);
}

TEST_F(OneCriterionTest, TheRecordOfTruthCountsByIt) {
  const auto fate = [](const Judges& judges) {
    const imagination::RolloutSetup setup = SetupAt(*judges.stage, kHome, 1);
    simulation::RobotSimulator simulator(setup.scene, {}, setup.world_state, setup.robot_state,
                                         base::Rng(1), setup.physics);
    simulation::TruthRecord truth(judges.setup().standing);
    for (int i = 0; i < 1500; ++i) {
      robot::Command command;
      command.base_velocity = geometry::Twist2{i < 500 ? 0.5 : 0.0, 0.0, 0.0};
      simulator.Send(command);
      simulator.Step();
      if (i % 5 == 0) truth.Look(simulator);
    }
    return truth.objects().at("stool1");
  };
  EXPECT_NEAR(fate(*as_it_is_).tilt, kLean, 0.05);
  EXPECT_TRUE(fate(*as_it_is_).stands);
  EXPECT_EQ(fate(*as_it_is_).falls, 0);
  EXPECT_FALSE(fate(*changed_).stands);
  EXPECT_EQ(fate(*changed_).falls, 1);
  const Judges held(hires::test_support::SceneCopy(hires::test_support::kStandingLine,
                                                   hires::test_support::kLongHoldStandingLine)
                        .path());
  EXPECT_EQ(fate(held).falls, 0) << "it leans, but not yet for that long";
}

// ------------------------------------------------------------------------------ held for how long

/// A mill that shakes, where a fall is to lean by that much [rad] for that long [s].
Judges OfMill(double tilt, double hold_time) {
  const std::string line = fmt::format(
      "standing: {{tilt: {}, hold_time: {}, drop: 0.05, slide: 0.10}}", tilt, hold_time);
  return Judges(hires::test_support::SceneCopy(hires::test_support::kStandingLine, line).path(),
                "peppermill1");
}
constexpr double kNearPeak = 0.9;  // of the largest lean: it leans by that much but for a moment
constexpr double kHold = 0.2;      // [s]

TEST_F(OneCriterionTest, ABriefLeanIsNoFallOfARolloutOrChain) {
  const double peak = Drive(OfMill(0.5, 0.0)).max_tilt;
  ASSERT_GT(kNearPeak * peak, 0.01) << "the mill was to shake";
  ASSERT_LT(peak, 0.2) << "and not to tip";
  const Judges at_once = OfMill(kNearPeak * peak, 0.0), held = OfMill(kNearPeak * peak, kHold);
  EXPECT_GE(Drive(at_once).falls, 1);
  EXPECT_EQ(Drive(held).falls, 0);
  EXPECT_EQ(Drive(held).outcome, imagination::Outcome::kSucceeded);
  EXPECT_GE(FirstLeg(at_once).result.falls, 1);
  EXPECT_EQ(FirstLeg(held).result.falls, 0);
  EXPECT_FALSE(FirstLeg(held).was_put_back);
}

TEST_F(OneCriterionTest, ABriefLeanIsNoFallInAStop) {
  const double peak = StopAtOnce(OfMill(0.5, 0.0), 0.2).max_tilt;
  ASSERT_GT(kNearPeak * peak, 0.01) << "the mill was to shake";
  ASSERT_LT(peak, 0.2) << "and not to tip";
  EXPECT_TRUE(StopAtOnce(OfMill(kNearPeak * peak, 0.0), 0.2).fell);
  EXPECT_FALSE(StopAtOnce(OfMill(kNearPeak * peak, kHold), 0.2).fell);
}

/// The stool on the counter, leaning, and the robot before it.
imagination::StartState BeforeLeaningStool(const Judges& judges) {
  geometry::Pose3 X_AO;
  X_AO.rotation = geometry::RotationFromRpy(0.0, kLean, 0.0);
  X_AO.translation.z() = 0.002;  // of the foot's middle over its lower edge: 0.004 sin 0.45
  return imagination::MakeStartState(judges.setup(),
                                     {{"RobotAt", {"manipulationAreaEastCounter1"}},
                                      {"HasTorsoPosture", {"TorsoUpPosture"}},
                                      {"HasArmPosture", {"leftArm1", "ArmToSidePosture"}},
                                      {"HasArmPosture", {"rightArm1", "ArmToSidePosture"}}},
                                     {{"stool1", "placingAreaEastRightCounter1", X_AO}});
}

TEST_F(OneCriterionTest, SkillsTakeWhatStandsByIt) {
  const auto why = [](const Judges& judges) {
    const auto setup = imagination::MakeRolloutSetup(judges.setup(), BeforeLeaningStool(judges), 1);
    return imagination::PlayRollout(setup, {"pick_up_object", {"stool1", "rightarm1"}}, 0)
        ->failure.code;
  };
  EXPECT_NE(why(*as_it_is_), base::FailureCode::kObjectToppled)
      << "it may be too wide, but it stands";
  EXPECT_EQ(why(*changed_), base::FailureCode::kObjectToppled);
}

TEST_F(OneCriterionTest, SymbolsSayWhatStandsByIt) {
  const auto atoms = [](const Judges& judges) {
    const auto start = BeforeLeaningStool(judges);
    return translation::AtomsOf(judges.setup().translator, {start.world, start.robot});
  };
  const auto on =
      AllOf(Field(&base::Atom::predicate, "On"),
            Field(&base::Atom::arguments, ElementsAre("stool1", "placingareaeastrightcounter1")));
  EXPECT_THAT(atoms(*as_it_is_), Contains(on));
  EXPECT_THAT(atoms(*changed_), Not(Contains(on)));
}

}  // namespace
}  // namespace hires::lab::one_criterion_test
