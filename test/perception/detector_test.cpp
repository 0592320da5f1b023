#include "hires/perception/detector.h"

#include <gmock/gmock.h>

#include <cmath>

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

}  // namespace
}  // namespace hires::perception::detector_test
