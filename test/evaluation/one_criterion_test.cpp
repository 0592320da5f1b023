// "A fall is 0.4 rad held for 0.2 s" is one line of one file. It changes everything that judges
// falls alike: what leans by 0.45 rad stands by the one line and has fallen by the other. Markers
// are looked at in test/ros/trace_markers_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/experiment_chain.h"
#include "hires/evaluation/experiment.h"
#include "hires/evaluation/experiment_braking.h"
#include "hires/imagination/rollout.h"
#include "hires/simulation/truth_record.h"
#include "hires/translation/classification.h"
#include "support/scene_copy.h"

namespace hires::evaluation::one_criterion_test {
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
  explicit Judges(const std::string& scene) {
    config = ReadExperiment(std::string(HIRES_SOURCE_DIR) + "/config/experiments/braking.yaml");
    config.scene = scene;
    config.uncertainty = "none";
    config.objects = {"stool1"};
    stage = std::make_shared<const Stage>(MakeStage(config));
  }
  const imagination::ImaginationSetup& setup() const { return stage->setup; }

  ExperimentConfig config;
  std::shared_ptr<const Stage> stage;
};

class OneCriterionTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    as_it_is_ = new Judges(hires::test_support::SceneCopy().path());
    changed_ = new Judges(
        hires::test_support::SceneCopy(hires::test_support::kStandingLine, hires::test_support::kOtherStandingLine)
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

TEST_F(OneCriterionTest, ChainsPutBackByIt) {
  const auto was_put_back = [](const Judges& judges) {
    Chain::Options options;
    options.motion_set = "fast";
    Chain chain(judges.stage, kHome, options);
    return chain.Drive("nearStartArea1", [] { return false; })->was_put_back;
  };
  EXPECT_FALSE(was_put_back(*as_it_is_));
  EXPECT_TRUE(was_put_back(*changed_));
}

TEST_F(OneCriterionTest, StopsAreJudgedByIt) {
  const auto stop = [](const Judges& judges) {
    BrakingConfig braking = std::get<BrakingConfig>(judges.config.kind);
    braking.rollouts = 1;
    braking.loads = {"stool1"};
    braking.motions = {{0.12, 0.0}};  // it tips, with little to spare: no swing over its rim
    braking.ways = {{BrakingWay::Kind::kAtOnce, 0.0, "at_once"}};
    return PlayBraking(braking, judges.config, *judges.stage, {})->front().stops.front();
  };
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
}  // namespace hires::evaluation::one_criterion_test
