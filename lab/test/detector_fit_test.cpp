#include "lab/src/recognition/detector_fit.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/robot/load_robot.h"
#include "lab/src/recognition/regression.h"

namespace hires::lab::detector_fit_test {
namespace {

using perception::DetectorErrors;
using perception::ThingInView;
using perception::ThingVerdict;
using testing::HasSubstr;
using testing::Not;

const std::string kSource = HIRES_SOURCE_DIR;

const perception::RecogniserConfig& TheRecogniser() {
  static const auto config = perception::ReadRecogniserConfig(kSource + "/config/recogniser.yaml");
  return config;
}

/// Two looks at things that are as the errors say.
std::vector<TwoLooks> Play(const DetectorErrors& errors, int num_things) {
  base::Rng rng(3);
  std::vector<TwoLooks> things;
  for (int i = 0; i < num_things; ++i) {
    ThingVerdict look;
    look.kind = "fork";
    ThingInView& view = look.view;
    view.part = {rng.Uniform(0.3, 1.0), 0.0012 * std::pow(10.0, rng.Uniform(-1.0, 1.0))};
    view.distance = rng.Uniform(1.0, 3.0);
    view.elevation = rng.Uniform(0.2, 1.0);
    view.box.z() = rng.Uniform(0.01, 0.3);
    view.gap = rng.Uniform(0.0, 0.1);
    TwoLooks both{look, look};
    const auto id = static_cast<std::uint64_t>(i);
    for (int k = 0; k < 2; ++k) {
      ThingVerdict& one = k == 0 ? both.first : both.second;
      const auto wrong = perception::Misjudge(errors, look.kind, view, 1.0,
                                              base::Rng(10 + k).Fork(id), base::Rng(9).Fork(id));
      if (wrong.is_missed) continue;
      one.called = wrong.called.empty() ? look.kind : wrong.called;
      if (!one.is_right()) {
        one.confidence = 0.6;
        one.doubt = 0.3;
        continue;
      }
      one.offset = wrong.offset;
      one.error = wrong.offset.norm();
      one.turned_by = std::abs(wrong.turn);
    }
    things.push_back(both);
  }
  return things;
}

DetectorErrors SomeErrors() {
  DetectorErrors errors;
  errors.found.weight << 3.0, 1.5, -2.0, -0.5, 0.3, 0.4, -1.0;
  errors.found.repeats = 0.7;
  errors.named.weight << 2.0, 1.0, -1.0, -0.3, 0.0, 1.5, -0.5;
  errors.named.repeats = 0.5;
  errors.called["fork"] = {{"knife", 3}, {"unknown", 1}};
  errors.position.log.weight << -7.0, -0.4, 1.0, 0.5, 0.0, 0.2, 0.3;
  errors.position.spread = 0.6;
  errors.position.log.repeats = 0.6;
  errors.direction = {0.5, 0.4, 0.1};
  errors.turn.log.weight << -5.0, -0.3, 0.8, 0.4, 0.0, 0.0, 0.0;
  errors.turn.spread = 0.8;
  errors.turn.log.repeats = 0.4;
  return errors;
}

TEST(RegressionTest, OfOneConstantTheyAreShareMeanAndDeviation) {
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(1000, 1);
  Eigen::VectorXd hits = Eigen::VectorXd::Zero(1000);
  hits.head(200).setOnes();
  const FittedRegression share = FitLogistic(ones, hits);
  EXPECT_NEAR(share.weight[0], std::log(0.25), 1e-3);
  EXPECT_NEAR(share.error[0], 1.0 / std::sqrt(1000 * 0.2 * 0.8), 1e-3);
  EXPECT_NEAR(share.log_likelihood, 200 * std::log(0.2) + 800 * std::log(0.8), 1e-3);
  const FittedRegression mean = FitLinear(ones, 3.0 * hits);
  EXPECT_NEAR(mean.weight[0], 0.6, 1e-3);
  EXPECT_NEAR(mean.spread, 1.2, 1e-3);
  EXPECT_NEAR(mean.error[0], 1.2 / std::sqrt(1000.0), 1e-3);
}

TEST(RegressionTest, WhatIsAlwaysRightStaysFinite) {
  Eigen::MatrixXd x(100, 2);
  x.col(0).setOnes();
  x.col(1) = Eigen::VectorXd::LinSpaced(100, -1.0, 1.0);
  const FittedRegression fit = FitLogistic(x, Eigen::VectorXd::Ones(100));
  EXPECT_TRUE(fit.weight.allFinite() && fit.error.allFinite());
  EXPECT_GT(fit.weight[0], 5.0);
  const FittedRegression split = FitLogistic(x, (x.col(1).array() > 0.0).cast<double>());
  EXPECT_TRUE(split.weight.allFinite());
  EXPECT_GT(split.weight[1], 3.0);
  EXPECT_THROW(FitLogistic(Eigen::MatrixXd(0, 2), Eigen::VectorXd(0)), base::ConfigError);
}

TEST(DetectorFitTest, ErrorsThatWereDrawnAreFoundAgain) {
  const DetectorErrors errors = SomeErrors();
  const perception::RecognitionScore kinds(TheRecogniser().catalogue);
  const DetectorErrors fit = FitDetector(Play(errors, 40000), kinds);
  const auto expect_near = [](const perception::Regression& one,
                              const perception::Regression& other, const char* what) {
    for (Eigen::Index i = 0; i < one.weight.size(); ++i) {
      EXPECT_NEAR(one.weight[i], other.weight[i], 5.0 * one.error[i]) << what << ' ' << i;
      EXPECT_LT(one.error[i], 0.15) << what << ' ' << i;
    }
    EXPECT_NEAR(one.repeats, other.repeats, 0.05) << what;
  };
  expect_near(fit.found, errors.found, "found");
  expect_near(fit.named, errors.named, "named");
  expect_near(fit.position.log, errors.position.log, "position");
  expect_near(fit.turn.log, errors.turn.log, "turn");
  EXPECT_NEAR(fit.position.spread, errors.position.spread, 0.02);
  EXPECT_NEAR(fit.turn.spread, errors.turn.spread, 0.02);
  EXPECT_LT((fit.direction - errors.direction).cwiseAbs().maxCoeff(), 0.05);
  const auto& called = fit.called.at("fork");
  EXPECT_NEAR(called.at("knife") / (1.0 * called.at("knife") + called.at("unknown")), 0.75, 0.02);
  EXPECT_NEAR(fit.confidence, 0.6, 1e-9);
  EXPECT_NEAR(fit.doubt, 0.3, 1e-9);
}

TEST(DetectorFitTest, NothingRecognisedFitsNothing) {
  const perception::RecognitionScore kinds(TheRecogniser().catalogue);
  try {
    FitDetector(std::vector<TwoLooks>(3), kinds);
    FAIL() << "was fitted";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("nothing was recognised rightly, of 3 things"));
  }
}

TEST(DetectorFitTest, WhatNoLookTellsIsNotGivenAsANumber) {
  DetectorFitReport report;
  report.held_out = 1;
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  FitCheck far;
  far.part = "far";
  far.num_looks = 3;
  far.median_error = far.expected = far.beyond = kNothing;
  report.checks.push_back(far);
  EXPECT_THAT(ToYaml(report),
              HasSubstr("far: 3 looks, found 0.0 % (fit 0.0), named - % (fit -), median - mm (fit "
                        "-)"));
  EXPECT_TRUE(ToJson(report).at("checks").at(0).at("median_error").is_null());
}

TEST(DetectorFitTest, RowsThatTheTableLacksAreNamedBelowIt) {
  DetectorFitReport report;
  EXPECT_THAT(ReportText(report), Not(HasSubstr("left out")));
  report.empty_parts = {"nearer than 1.5 m", "2.5 m and farther"};
  EXPECT_THAT(ReportText(report),
              HasSubstr("left out, as no look was so: nearer than 1.5 m, 2.5 m and farther\n"));
  EXPECT_THAT(ReportText(report), HasSubstr("base stands up to 2.6 m before the table's middle"));
}

DetectorFitOrder SmallOrder() {
  DetectorFitOrder order;
  order.tables = 4;
  order.held_out = 2;
  order.robot = robot::LoadRobot(kSource + "/config/robots/pr2.yaml");
  order.recogniser = TheRecogniser();
  return order;
}

TEST(DetectorFitTest, AnyNumberOfThreadsFitsTheSameAndItsFileIsRead) {
  const auto one = FitDetector(SmallOrder(), base::Crew{1, {}, {}});
  const auto two = FitDetector(SmallOrder(), base::Crew{2, {}, {}});
  ASSERT_TRUE(one && two);
  EXPECT_EQ(ToYaml(*one), ToYaml(*two));
  EXPECT_EQ(ToJson(*one), ToJson(*two));
  EXPECT_GT(one->num_found, 10);
  EXPECT_LE(one->num_named, one->num_found);
  const std::string path = testing::TempDir() + "detector_fit.yaml";
  base::ReplaceTextFile(path, ToYaml(*one));
  EXPECT_EQ(perception::ToYaml(perception::ReadDetectorErrors(path)),
            perception::ToYaml(one->errors));
  EXPECT_THAT(ReportText(*one), HasSubstr("2 other tables:"));
}

TEST(DetectorFitTest, TheShippedFitIsOfWhatIsShipped) {
  const std::string hash = FitHashOf(SmallOrder());
  EXPECT_THAT(base::ReadTextFile(kSource + "/config/detector.yaml", 1u << 20), HasSubstr(hash))
      << "fit it anew: hires_lab experiment detector --output config/detector.yaml";
}

TEST(DetectorFitTest, AnyChangeOfWhatAFitDependsOnIsSeenInItsHash) {
  const DetectorFitOrder order = SmallOrder();
  const std::string hash = FitHashOf(order);
  EXPECT_EQ(FitHashOf(SmallOrder()), hash);
  DetectorFitOrder other = order;
  other.recogniser.params.min_quality += 0.01;
  EXPECT_NE(FitHashOf(other), hash) << "of the recogniser's parameters";
  other = order;
  other.recogniser.params.segmentation.joining.min_gap += 0.001;
  EXPECT_NE(FitHashOf(other), hash) << "of the segmentation's";
  other = order;
  world::ObjectModel model = *other.recogniser.catalogue.front().model;
  model.collisions.front().X_BS.translation.z() += 0.001;
  other.recogniser.catalogue.front().model = std::make_shared<const world::ObjectModel>(model);
  EXPECT_NE(FitHashOf(other), hash) << "of a model's shape";
  other = order;
  other.robot.profile.upper_body->camera_max_range -= 0.1;
  EXPECT_NE(FitHashOf(other), hash) << "of the robot's profile";
}

TEST(DetectorFitTest, ItIsCancelled) {
  EXPECT_FALSE(FitDetector(SmallOrder(), base::Crew{1, [] { return true; }, {}}));
}

}  // namespace
}  // namespace hires::lab::detector_fit_test
