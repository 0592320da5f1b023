#include "hires/perception/detector.h"

#include <gmock/gmock.h>

#include <cmath>
#include <optional>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/geometry/angles.h"
#include "support/sight_scenes.h"

namespace hires::perception::detector_test {
namespace {

using test_support::At;
using test_support::LookingFrom;
using test_support::Thing;

class DetectorTest : public testing::Test {
 protected:
  std::vector<Detection> Look(const CameraView& view, base::Rng* rng) const {
    return Detect(LineOfSight(surroundings_, objects_), view, objects_, params_, rng);
  }

  std::shared_ptr<const Surroundings> surroundings_ =
      std::make_shared<Surroundings>(test_support::SightWorld());
  std::vector<world::ObjectState> objects_ = {Thing("mug1", "mug", At(1.5, 0.0, 0.95)),
                                              Thing("mug2", "mug", At(2.2, 0.0, 0.95)),
                                              Thing("jug1", "jug", At(1.5, 0.4, 0.9))};
  DetectorParams params_;
  const CameraView view_ = LookingFrom({0.0, 0.0, 1.0});
};

TEST_F(DetectorTest, NamesWhatIsSeenAndNotWhatIsHidden) {
  base::Rng rng(1);
  const auto seen = Look(view_, &rng);
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].instance, "mug1");
  EXPECT_EQ(seen[0].label, "mug");
  EXPECT_EQ(seen[0].visible_share, 1.0);
  EXPECT_EQ(seen[1].instance, "jug1");
}

TEST_F(DetectorTest, WithoutNoiseThePosesAreTheTrueOnesInTheCamerasFrame) {
  params_.position_noise = params_.yaw_noise = 0.0;
  base::Rng rng(1);
  const CameraView view = LookingFrom({0.3, -0.1, 1.2}, 0.1, 0.2);
  const auto seen = Look(view, &rng);
  ASSERT_FALSE(seen.empty());
  const geometry::Pose3 X_MO = view.X_MC * seen[0].X_CO;
  EXPECT_LT((X_MO.translation - objects_[0].X_MO.translation).norm(), 1e-12);
  EXPECT_LT(X_MO.rotation.angularDistance(objects_[0].X_MO.rotation), 1e-7);
}

TEST_F(DetectorTest, NoiseHasTheSpreadThatWasAskedForAndKeepsObjectsUpright) {
  params_.position_noise = 0.01;
  params_.yaw_noise = 0.05;
  base::Rng rng(5);
  constexpr int kLooks = 2000;
  Eigen::Array3d sum = Eigen::Array3d::Zero();
  double yaw_sum = 0.0;
  for (int i = 0; i < kLooks; ++i) {
    const geometry::Pose3 X_MO = view_.X_MC * Look(view_, &rng)[0].X_CO;
    sum += (X_MO.translation - objects_[0].X_MO.translation).array().square();
    yaw_sum += std::pow(geometry::YawOf(X_MO.rotation), 2);
    EXPECT_LT(geometry::TiltOf(X_MO.rotation), 1e-6);
  }
  // The spread of a variance from n draws is sqrt(2 / n): 3 %; five times that is 16 %.
  EXPECT_THAT(std::vector<double>({sum[0], sum[1], sum[2]}),
              testing::Each(testing::DoubleNear(kLooks * 1e-4, 0.16 * kLooks * 1e-4)));
  EXPECT_NEAR(yaw_sum / kLooks, 0.0025, 0.16 * 0.0025);
}

TEST_F(DetectorTest, WhatHidesOneObjectLeavesTheNoiseOfOthersAlone) {
  base::Rng rng(7), same(7);
  const Detection jug = Look(view_, &rng)[1];
  objects_[0].X_MO.translation.y() = -3.0;  // out of view: now mug2 is seen
  const auto seen = Look(view_, &same);
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].instance, "mug2");
  EXPECT_EQ(seen[1].X_CO.translation, jug.X_CO.translation);
}

TEST_F(DetectorTest, AnObjectOfWhichTooLittleIsSeenIsMissed) {
  objects_.push_back(Thing("screen1", "screen", At(1.0, 0.5, 0.7)));  // half of mug1, all of jug1
  base::Rng rng(1);
  params_.min_visible_share = 0.3;
  EXPECT_THAT(Look(view_, &rng), testing::Contains(testing::Field(&Detection::instance, "mug1")));
  params_.min_visible_share = 0.8;
  EXPECT_THAT(Look(view_, &rng),
              testing::Not(testing::Contains(testing::Field(&Detection::instance, "mug1"))));
}

TEST_F(DetectorTest, NothingIsDetectedWhereNothingIs) {
  objects_.clear();
  base::Rng rng(1);
  EXPECT_TRUE(Look(view_, &rng).empty());
}

TEST_F(DetectorTest, TheSameSeedSeesTheSame) {
  base::Rng rng(3), again(3);
  const auto one = Look(view_, &rng), two = Look(view_, &again);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].X_CO.translation, two[i].X_CO.translation);
    EXPECT_EQ(one[i].X_CO.rotation.coeffs(), two[i].X_CO.rotation.coeffs());
  }
}

class ErringDetectorTest : public DetectorTest {
 protected:
  ErringDetectorTest() {
    params_.position_noise = params_.yaw_noise = 0.0;
    errors_.found.weight[0] = 50.0;
    errors_.named.weight[0] = 50.0;
    errors_.position.log.weight[0] = -50.0;
    errors_.turn.log.weight[0] = -50.0;
  }
  /// What becomes of mug1 in many looks of one robot.
  std::vector<std::optional<Detection>> LookOften(int num_looks, std::uint64_t robot = 1) {
    params_.errors = std::make_shared<const DetectorErrors>(errors_);
    params_.errors_seed = robot;
    base::Rng rng(100 + robot);
    std::vector<std::optional<Detection>> looks;
    for (int i = 0; i < num_looks; ++i) {
      looks.emplace_back();
      for (const Detection& one : Look(view_, &rng))
        if ((one.X_CO.translation - view_.X_MC.Inverse() * objects_[0].X_MO.translation).norm() <
            0.1)
          looks.back() = one;
    }
    return looks;
  }
  static double Odds(double share) { return std::log(share / (1.0 - share)); }

  DetectorErrors errors_;
};

TEST_F(ErringDetectorTest, ItMissesAndMistakesAsOftenAsItIsTold) {
  errors_.found.weight[0] = Odds(0.8);
  errors_.named.weight[0] = Odds(0.7);
  errors_.called["mug"] = {{"jug", 3}, {"no_model", 1}};
  int num_found = 0, num_right = 0, num_jugs = 0;
  for (const auto& look : LookOften(2000)) {
    if (!look) continue;
    ++num_found;
    num_right += look->instance.has_value() ? 1 : 0;
    num_jugs += look->label == "jug" ? 1 : 0;
    EXPECT_TRUE(look->instance || look->label == "jug" || look->label == kUnknownLabel);
  }
  // Four deviations of a share: 4 sqrt(0.2 0.8 / 2000) = 0.036, and more of fewer.
  EXPECT_NEAR(num_found / 2000.0, 0.8, 0.036);
  EXPECT_NEAR(num_right / (1.0 * num_found), 0.7, 0.046);
  EXPECT_NEAR(num_jugs / (1.0 * (num_found - num_right)), 0.75, 0.08);
}

TEST_F(ErringDetectorTest, WhatIsMistakenHasNoNameOfItsOwnAndSaysHowSureItIs) {
  errors_.named.weight[0] = -50.0;
  errors_.called["mug"] = {{"jug", 1}};
  errors_.confidence = 0.6;
  errors_.doubt = 0.25;
  const Detection wrong = *LookOften(1).front();
  EXPECT_EQ(wrong.instance, std::nullopt);
  EXPECT_EQ(wrong.label, "jug");
  EXPECT_EQ(wrong.confidence, 0.6);
  ASSERT_EQ(wrong.alternatives.size(), 1u);
  EXPECT_EQ(wrong.alternatives[0].label, "mug");
  EXPECT_EQ(wrong.alternatives[0].confidence, 0.25);
  EXPECT_NEAR(wrong.size.z(), 0.1, 1e-9);
}

TEST_F(ErringDetectorTest, OneThatAlwaysRepeatsItselfErrsAlikeForOneRobot) {
  errors_.named.weight[0] = 0.0;
  errors_.named.repeats = 1.0;
  errors_.position.log.weight[0] = std::log(0.01);
  errors_.position.log.repeats = 1.0;
  int num_right = 0;
  for (std::uint64_t robot = 0; robot < 200; ++robot) {
    const auto looks = LookOften(2, robot);
    EXPECT_EQ(looks[0]->instance, looks[1]->instance);
    EXPECT_EQ(looks[0]->X_CO.translation, looks[1]->X_CO.translation);
    num_right += looks[0]->instance ? 1 : 0;
  }
  EXPECT_NEAR(num_right / 200.0, 0.5, 4.0 * std::sqrt(0.25 / 200));
}

TEST_F(ErringDetectorTest, ErrorsGrowWithTheFactorAndPointAwayFromTheCamera) {
  errors_.position.log.weight[0] = std::log(0.01);
  errors_.direction = {1.0, 0.0, 0.0};
  params_.errors_factor = 2.0;
  const Eigen::Vector3d p_C = view_.X_MC.Inverse() * objects_[0].X_MO.translation;
  const Eigen::Vector3d offset = LookOften(1).front()->X_CO.translation - p_C;
  EXPECT_NEAR(offset.norm(), 0.02, 1e-9);
  EXPECT_NEAR(std::abs(offset.x()), 0.02, 1e-9) << "the camera is level with the mug";
  params_.errors_factor = 0.0;
  EXPECT_EQ(LookOften(1).front()->X_CO.translation, p_C);
}

TEST_F(ErringDetectorTest, WhatIsSmallHiddenFarFlatAndCrowdedHasLargerRegressors) {
  const LineOfSight sight(surroundings_, objects_);
  const auto of = [&](std::size_t i) {
    return LookAtThing(sight, view_, objects_, i, sight.Visible(view_, objects_[i].name));
  };
  const ThingInView mug = of(0);
  EXPECT_NEAR(mug.distance, std::hypot(1.5, 0.05), 1e-9);
  EXPECT_NEAR(mug.box.z(), 0.1, 1e-9);
  EXPECT_NEAR(mug.gap, 0.4 - 0.04 - 0.06, 1e-9) << "the jug's handle points away";
  // Its outline is a rectangle of 0.08 m x 0.1 m, 1.46 m away where it is nearest.
  EXPECT_NEAR(mug.part.size, 0.008 / (1.48 * 1.48), 0.15 * 0.008 / (1.48 * 1.48));
  const Regressors x = RegressorsOf(mug);
  EXPECT_EQ(x[0], 1.0);
  EXPECT_NEAR(x[1], std::log10(mug.part.size / 0.0012), 1e-12);
  EXPECT_NEAR(x[2], 0.0, 1e-12);
  EXPECT_NEAR(x[3], std::log2(mug.distance / 1.5), 1e-12);
  EXPECT_NEAR(x[5], 0.0, 1e-9);
  EXPECT_EQ(x[6], 0.0);
  objects_[2].X_MO.translation.y() = 0.12;
  const LineOfSight crowd(surroundings_, objects_);
  const auto part = crowd.Visible(view_, "mug1");
  EXPECT_NEAR(RegressorsOf(LookAtThing(crowd, view_, objects_, 0, part))[6], 0.6, 1e-9);
}

TEST(DetectorErrorsTest, FilesThatMakeNoSenseAreRefused) {
  const std::string good = ToYaml(DetectorErrors{});
  const auto why = [](const std::string& text) -> std::string {
    const std::string path = testing::TempDir() + "detector_errors.yaml";
    base::ReplaceTextFile(path, text);
    try {
      ReadDetectorErrors(path);
    } catch (const base::ConfigError& error) {
      return error.what();
    }
    return "";
  };
  const auto with = [&](const std::string& old, const std::string& text) {
    std::string changed = good;
    return changed.replace(changed.find(old), old.size(), text);
  };
  EXPECT_EQ(why(good), "");
  EXPECT_THAT(why(with("size: [0.0000, 0.0000]", "size: [0.0, -1.0]")),
              testing::HasSubstr(
                  "found.size is a list, namely [0, -1], wanted a weight and its standard error"));
  EXPECT_THAT(why(with("size: [0.0000, 0.0000]", "size: [1.0]")),
              testing::HasSubstr("found.size is a list, wanted a list of 2 numbers"));
  EXPECT_THAT(why(with("size: [0.0000, 0.0000]", "size: [.nan, 0]")),
              testing::HasSubstr("wanted a finite number"));
  EXPECT_THAT(why(with("repeats: 0.0000", "repeats: 1.5")), testing::HasSubstr("found.repeats"));
  EXPECT_THAT(why(with("called: {}", "called: {fork: {knife: 0}}")),
              testing::HasSubstr("called.fork.knife"));
  EXPECT_THAT(why(with("direction: [0.3333", "direction: [0.9")),
              testing::HasSubstr("wanted three shares with the sum 1"));
  EXPECT_THAT(why(with("spread: 0.0000", "spred: 0.0000")), testing::HasSubstr("spread"));
  EXPECT_THAT(why(good + "more: 1\n"), testing::HasSubstr("more"));
  EXPECT_THAT(why(""), testing::HasSubstr("found"));
}

}  // namespace
}  // namespace hires::perception::detector_test
