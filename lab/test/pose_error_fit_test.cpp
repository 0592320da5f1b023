#include "lab/src/place/pose_error_fit.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "hires/base/text.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/robot/load_robot.h"
#include "hires/world/object_catalogue.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::lab::pose_error_fit_test {
namespace {

using geometry::Pose2;
using hires::test_support::ConfigErrorOf;
using simulation::PoseErrorParams;
using testing::HasSubstr;

const std::string kConfig = HIRES_SOURCE_DIR "/config";

PoseErrorParams Known() {
  PoseErrorParams params;
  params.kept << 0.85, 0.0, 0.05, 0.0, 0.9, -0.1, 0.0, 0.0, 0.7;
  params.added << 2e-4, 0.0, 0.0, 0.0, 1e-4, 2e-5, 0.0, 2e-5, 4e-5;
  params.start = params.added;
  params.stretch = 0.02;
  params.walk = 0.002;
  params.walk_yaw = 0.003;
  return params;
}

/// Drives of 8 m in wide arcs whose places err in a way that is known.
std::vector<PlaceTrail> Trails(const PoseErrorParams& params, int num_drives) {
  std::vector<PlaceTrail> trails;
  for (int k = 0; k < num_drives; ++k) {
    PlaceTrail& trail = trails.emplace_back();
    Pose2 X_MB{0.1 * k, 0.0, 0.3 * k};
    simulation::PoseErrorWalk walk(params, X_MB, base::Rng(k));
    for (int i = 0; i < 400; ++i) {
      walk.Drive(X_MB);
      trail.push_back({X_MB, walk.X_MBelieved(), walk.X_OB(), false});
      X_MB = X_MB * Pose2{0.02, 0.0, k % 2 == 0 ? 0.01 : -0.01};
    }
  }
  return trails;
}

TEST(PoseErrorFitTest, FindsAgainWhatMadeTheErrors) {
  const PoseErrorParams known = Known();
  const PoseErrorParams fit = FitPoseError(Trails(known, 400), 0.2, 0.5);
  EXPECT_LT((fit.kept - known.kept).cwiseAbs().maxCoeff(), 0.05);
  EXPECT_LT((fit.kept.leftCols<2>() - known.kept.leftCols<2>()).cwiseAbs().maxCoeff(), 0.02);
  EXPECT_LT((fit.added - known.added).cwiseAbs().maxCoeff(), 5e-6);
  EXPECT_NEAR(fit.stretch, known.stretch, 0.002);
  EXPECT_NEAR(fit.walk, known.walk, 0.0001);
  EXPECT_NEAR(fit.walk_yaw, known.walk_yaw, 0.0001);
  EXPECT_EQ(fit.update_turn, 0.5);
}

TEST(PoseErrorFitTest, ItsErrorsAreLikeTheOnesItWasMadeFrom) {
  const std::vector<PlaceTrail> trails = Trails(Known(), 400);
  const PoseErrorParams fit = FitPoseError(Trails(Known(), 400), 0.2, 0.5);
  const PoseErrorFigures found = FiguresOf(trails),
                         played = FiguresOf(PlayPoseError(fit, trails, base::Rng(4)));
  EXPECT_NEAR(played.rms, found.rms, 0.06 * found.rms);
  EXPECT_NEAR(played.most, found.most, 0.06 * found.most);
  EXPECT_NEAR(played.rms_yaw, found.rms_yaw, 0.06 * found.rms_yaw);
  EXPECT_NEAR(played.jump, found.jump, 0.06 * found.jump);
  EXPECT_NEAR(played.alike_after_1m, found.alike_after_1m, 0.06);
  EXPECT_LT(found.alike_after_4m, found.alike_after_1m);
  EXPECT_NEAR(played.alike_after_4m, found.alike_after_4m, 0.1);
}

TEST(PoseErrorFitTest, AFitToOtherErrorsIsNotLikeThem) {
  PoseErrorParams twice = Known();
  twice.added *= 4.0;
  const std::vector<PlaceTrail> trails = Trails(twice, 100);
  const PoseErrorFigures played = FiguresOf(PlayPoseError(Known(), trails, base::Rng(4)));
  EXPECT_LT(played.rms, 0.7 * FiguresOf(trails).rms);
}

TEST(PoseErrorFitTest, TooFewCorrectionsAreRefused) {
  const auto fit = [] { FitPoseError(Trails(Known(), 2), 0.2, 0.5); };
  EXPECT_THAT(ConfigErrorOf(fit), HasSubstr("75 corrections, wanted 100"));
}

ExperimentConfig Drives(const std::string& name, int legs) {
  ExperimentOverrides overrides;
  overrides.runs = legs;
  return ReadExperiment(HIRES_SOURCE_DIR "/lab/config/experiments/" + name, overrides);
}

TEST(PoseErrorExperimentTest, IsOfARobotThatFindsItsPlace) {
  PoseErrorOrder order;
  order.drives = Drives("legs_world.yaml", 2);
  const auto fit = [&] { FitPoseError(order, {}); };
  EXPECT_THAT(ConfigErrorOf(fit), HasSubstr("self_localisation is none"));
  order.drives = Drives("paired.yaml", 2);
  EXPECT_THAT(ConfigErrorOf(fit), HasSubstr("kind is paired, wanted legs"));
}

TEST(PoseErrorExperimentTest, AnyNumberOfThreadsWritesTheSameAndProgressEnds) {
  PoseErrorOrder order;
  order.drives = Drives("legs_world_filter.yaml", 8);
  order.series = order.held_out = 1;
  base::Crew one, three;
  three.threads = 3;
  double last = 0.0;
  one.on_progress = [&](double fraction, double) {
    EXPECT_GE(fraction, last);
    last = fraction;
  };
  const auto a = FitPoseError(order, one), b = FitPoseError(order, three);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(ToYaml(*a), ToYaml(*b));
  EXPECT_NEAR(last, 1.0, 1e-9);
  EXPECT_GT(a->num_corrections, 100);
  EXPECT_EQ(a->num_legs, 8);
  EXPECT_EQ(ToJson(*a)["schema"], "hires/pose_error_fit");
  one.cancelled = [] { return true; };
  EXPECT_FALSE(FitPoseError(order, one));
  hires::test_support::TemporaryFolder folder;
  const auto read = simulation::ReadPoseError(folder.Write("error.yaml", ToYaml(*a)));
  EXPECT_EQ(read.hash, a->fit.hash);
}

TEST(PoseErrorExperimentTest, TheShippedFileIsOfTheShippedWorldAndFilters) {
  const auto scene = imagination::ReadSetupConfig(kConfig + "/scene.yaml");
  const world::World world = world::LoadWorld(scene.world);
  const auto height = robot::LaserHeight(robot::LoadAnyRobot(scene.robot));
  EXPECT_EQ(simulation::ReadPoseError(scene.localisation_error).hash,
            simulation::PlaceHash(scene.self_localisation, world, height.value()))
      << "run hires_lab experiment localisation --output config/localisation_error.yaml";
}

}  // namespace
}  // namespace hires::lab::pose_error_fit_test
