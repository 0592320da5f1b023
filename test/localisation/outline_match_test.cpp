#include "hires/localisation/outline_match.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "support/planar_rays.h"

namespace hires::localisation::outline_match_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Polygon;
using geometry::Pose2;
using test_support::RangeTo;

const Vector2d kLaser_B{0.27, 0.0};
constexpr double kView = 4.5;  // [rad]

Polygon Box(double x, double y, double width, double depth) {
  return {{x - width / 2, y - depth / 2},
          {x + width / 2, y - depth / 2},
          {x + width / 2, y + depth / 2},
          {x - width / 2, y + depth / 2}};
}

/// The four legs of a table 1 m ahead, and a wall to the left.
std::vector<Polygon> TableAndWall() {
  return {Box(0.9, 0.35, 0.06, 0.06), Box(0.9, -0.35, 0.06, 0.06), Box(1.6, 0.35, 0.06, 0.06),
          Box(1.6, -0.35, 0.06, 0.06), Box(1.0, 1.6, 4.0, 0.1)};
}

struct View {
  std::vector<Vector2d> echoes_B;
  double increment;
};

View Seen(const std::vector<Polygon>& outlines_M, const Pose2& X_MB, int num_beams,
          base::Rng* rng = nullptr, double noise = 0.01) {
  View view{{}, kView / num_beams};
  for (int i = 0; i < num_beams; ++i) {
    const double angle = -kView / 2 + i * view.increment;
    double range = RangeTo(outlines_M, X_MB * kLaser_B, X_MB.yaw + angle);
    if (!std::isfinite(range)) continue;
    if (rng != nullptr) range += rng->Normal(0.0, noise);
    view.echoes_B.push_back(kLaser_B + range * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return view;
}

PlaceBelief Told(const Pose2& X_MB, double sd = 0.03, double yaw_sd = 0.02) {
  return {X_MB, Vector3d(sd * sd, sd * sd, yaw_sd * yaw_sd).asDiagonal()};
}

using Verdict = Correction::Verdict;

Correction Corrected(const std::vector<Polygon>& outlines, const PlaceBelief& prior,
                     const View& view) {
  return OutlineMatch(outlines, {}).Correct(prior, view.echoes_B, kLaser_B, view.increment);
}

std::optional<PlaceBelief> Correct(const std::vector<Polygon>& outlines, const PlaceBelief& prior,
                                   const View& view) {
  const Correction correction = Corrected(outlines, prior, view);
  if (correction.verdict == Verdict::kCorrected) return correction.belief;
  return std::nullopt;
}

double OffOf(const PlaceBelief& belief, const Pose2& X_MB) {
  return (belief.X_MB.position() - X_MB.position()).norm();
}

TEST(OutlineMatchTest, APlaceThatIsRightStays) {
  const Pose2 truth{0.1, 0.05, 0.02};
  const auto found = Correct(TableAndWall(), Told(truth), Seen(TableAndWall(), truth, 240));
  ASSERT_TRUE(found);
  EXPECT_LT(OffOf(*found, truth), 1e-6);
  EXPECT_LT(std::abs(found->X_MB.yaw - truth.yaw), 1e-6);
  EXPECT_LT(found->covariance(0, 0), 0.01 * 0.01) << "and is surer";
}

/// Told off by no more than the gate: with more, legs are taken for their neighbours' sides.
TEST(OutlineMatchTest, AToldPlaceThatErrsIsCorrectedToMillimetres) {
  base::Rng rng(3);
  double worst = 0.0, squares = 0.0;
  constexpr int kTimes = 200;
  for (int i = 0; i < kTimes; ++i) {
    const Pose2 truth{rng.Uniform(-0.2, 0.2), rng.Uniform(-0.2, 0.2), rng.Uniform(-0.3, 0.3)};
    const Pose2 off{truth.x + rng.Uniform(-0.055, 0.055), truth.y + rng.Uniform(-0.055, 0.055),
                    truth.yaw + rng.Uniform(-0.04, 0.04)};
    const auto found = Correct(TableAndWall(), Told(off), Seen(TableAndWall(), truth, 120, &rng));
    ASSERT_TRUE(found) << i;
    worst = std::max(worst, OffOf(*found, truth));
    squares += OffOf(*found, truth) * OffOf(*found, truth);
  }
  EXPECT_LT(std::sqrt(squares / kTimes), 0.008) << "told: 0.045";
  EXPECT_LT(worst, 0.025);
}

/// Errors against what the covariance says: in the mean of chi^2 with 3 degrees of freedom.
TEST(OutlineMatchTest, TheCovarianceCoversTheError) {
  base::Rng rng(5);
  double sum = 0.0;
  int num = 0;
  for (int i = 0; i < 300; ++i) {
    const Pose2 truth{rng.Uniform(-0.2, 0.2), rng.Uniform(-0.2, 0.2), rng.Uniform(-0.3, 0.3)};
    const Pose2 off{truth.x + rng.Normal(0.0, 0.02), truth.y + rng.Normal(0.0, 0.02),
                    truth.yaw + rng.Normal(0.0, 0.01)};
    // Beams as far apart as they are independent, and as noisy as they are said to be.
    const int num_beams = static_cast<int>(kView / OutlineMatchParams().independent);
    const auto found =
        Correct(TableAndWall(), Told(off, 0.02, 0.01),
                Seen(TableAndWall(), truth, num_beams, &rng, OutlineMatchParams().noise));
    if (!found) continue;
    const Vector3d error(found->X_MB.x - truth.x, found->X_MB.y - truth.y,
                         geometry::WrapToPi(found->X_MB.yaw - truth.yaw));
    sum += error.dot(found->covariance.inverse() * error);
    ++num;
  }
  ASSERT_GT(num, 280);
  EXPECT_GT(sum / num, 1.5);
  EXPECT_LT(sum / num, 4.5) << "3 in the mean, if all were linear and each echo of its own face";
}

TEST(OutlineMatchTest, HowManyBeamsALaserHasChangesLittle) {
  const Pose2 truth{0.05, -0.05, 0.1}, off{0.08, -0.07, 0.11};
  const auto few = Correct(TableAndWall(), Told(off), Seen(TableAndWall(), truth, 120));
  const auto many = Correct(TableAndWall(), Told(off), Seen(TableAndWall(), truth, 960));
  ASSERT_TRUE(few && many);
  EXPECT_LT(OffOf(*few, many->X_MB), 0.003);
  for (int i = 0; i < 3; ++i) {
    const double ratio = few->covariance(i, i) / many->covariance(i, i);
    EXPECT_GT(ratio, 0.6) << i;
    EXPECT_LT(ratio, 1.7) << i;
  }
}

TEST(OutlineMatchTest, AlongAWallOnlyTheDistanceFromItIsLearned) {
  const std::vector<Polygon> wall{Box(0.0, 1.0, 20.0, 0.1)};
  const auto found = Correct(wall, Told({0.04, 0.03, 0.0}), Seen(wall, {0.0, 0.0, 0.0}, 240));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->X_MB.y, 0.0, 0.005);
  EXPECT_NEAR(found->X_MB.x, 0.04, 0.005) << "as told";
  EXPECT_NEAR(std::sqrt(found->covariance(0, 0)), 0.03, 0.001) << "as told";
}

TEST(OutlineMatchTest, OutlinesMayTurnEitherWay) {
  std::vector<Polygon> turned = TableAndWall();
  for (Polygon& outline : turned) std::reverse(outline.begin(), outline.end());
  const Pose2 truth{0.1, 0.05, 0.02}, off{0.12, 0.03, 0.03};
  const View view = Seen(TableAndWall(), truth, 240);
  const auto one = Correct(TableAndWall(), Told(off), view),
             other = Correct(turned, Told(off), view);
  ASSERT_TRUE(one && other);
  EXPECT_LT(OffOf(*one, other->X_MB), 1e-9);
}

TEST(OutlineMatchTest, WhereTooLittleIsSeenItSaysNothing) {
  const Pose2 place{0.0, 0.0, 0.0};
  EXPECT_FALSE(Correct({}, Told(place), Seen(TableAndWall(), place, 240))) << "nothing is known";
  EXPECT_FALSE(Correct(TableAndWall(), Told(place), {{}, 0.02})) << "nothing is seen";
  const std::vector<Polygon> leg{Box(0.9, 0.35, 0.04, 0.04)};  // fills 0.08 rad
  EXPECT_FALSE(Correct(leg, Told(place), Seen(leg, place, 240)));
}

TEST(OutlineMatchTest, WhatIsNotOfTheWorldMovesNothing) {
  const Pose2 truth{0.0, 0.0, 0.0};
  std::vector<Polygon> with_chair = TableAndWall();
  with_chair.push_back(Box(1.2, -1.0, 0.4, 0.4));
  const auto found = Correct(TableAndWall(), Told({0.02, 0.02, 0.0}), Seen(with_chair, truth, 240));
  ASSERT_TRUE(found);
  EXPECT_LT(OffOf(*found, truth), 0.01);
}

TEST(OutlineMatchTest, WhatFitsNowhereThatTheBeliefAllowsContradictsIt) {
  const PlaceBelief belief = Told({0.03, 0.03, 0.0}, 0.004, 0.004);
  const Correction correction =
      Corrected(TableAndWall(), belief, Seen(TableAndWall(), {0.0, 0.0, 0.0}, 240));
  EXPECT_EQ(correction.verdict, Verdict::kContradicts);
  EXPECT_EQ(correction.belief.X_MB.x, belief.X_MB.x) << "which stays";
}

/// With half the gate legs are told apart, with more of it nobody would know.
TEST(OutlineMatchTest, ABeliefThatIsTooWideIsNotCorrected) {
  const View view = Seen(TableAndWall(), {}, 240);
  for (const PlaceBelief& wide :
       {Told({}, 0.041), Told({}, 0.15), Told({}, 0.02, 0.05), Told({}, std::nan("")),
        Told({}, std::numeric_limits<double>::infinity())}) {
    EXPECT_EQ(Corrected(TableAndWall(), wide, view).verdict, Verdict::kSilent)
        << wide.covariance(0, 0);
  }
  EXPECT_EQ(Corrected(TableAndWall(), Told({}, 0.039), view).verdict, Verdict::kCorrected);
}

/// Through a gap of 0.12 m: whichever side an echo is taken for, the search ends.
TEST(OutlineMatchTest, WhatLiesBetweenTwoOutlinesIsSettled) {
  const std::vector<Polygon> gap{Box(1.0, 0.16, 0.1, 0.2), Box(1.0, -0.16, 0.1, 0.2),
                                 Box(1.6, 0.0, 0.1, 2.0)};
  int num_settled = 0;
  for (int k = -20; k <= 20; ++k) {
    View view = Seen(gap, {}, 240);
    for (Vector2d& echo : view.echoes_B) echo.y() += 0.0025 * k;
    num_settled += Corrected(gap, Told({}), view).verdict == Verdict::kCorrected ? 1 : 0;
  }
  EXPECT_EQ(num_settled, 41);
}

}  // namespace
}  // namespace hires::localisation::outline_match_test
