#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "hires/geometry/angles.h"
#include "lab/src/experience/experience_report.h"
#include "lab/src/experience/experience_runs.h"
#include "lab/src/experience/filters.h"
#include "lab/src/experience/separation.h"
#include "reports/experience/topple_monitor.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::lab::experience_test {
namespace {

using geometry::Pose2;
using geometry::Pose3;
using knowledge::ToppleEpisodePart;
using knowledge::ToppleState;
using ::testing::DoubleNear;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Pose3 Leaning(const Pose2& X_MB, double tilt) {
  Pose3 X_MO = geometry::Lift(X_MB);
  X_MO.rotation = Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX());
  return X_MO;
}

reports::ToppleSample SampleAt(double time, const Pose2& X_MB, double tilt = 0.0) {
  const Pose3 X_MO = Leaning(X_MB, tilt);
  return {time, X_MB, X_MO, geometry::Lift(X_MB).Inverse() * X_MO};
}

TEST(ToppleMonitorTest, ConstantJerkIsFoundToTheDigit) {
  // x = t^3 / 6: v = t^2 / 2, a = t, j = 1; likewise the yaw.
  reports::ToppleMonitor monitor({});
  for (int i = 0; i < 40; ++i) {
    const double t = 1.0 + 0.05 * i, s = t * t * t / 6.0;
    const auto part = monitor.Add(SampleAt(t, {s, 0.0, s}));
    if (i < 3) {
      EXPECT_FALSE(part) << "too few samples for a jerk";
      continue;
    }
    ASSERT_TRUE(part);
    const double middle = t - 0.075;
    EXPECT_NEAR(part->base.v, middle * middle / 2.0 + 0.05 * 0.05 / 24.0, 1e-9);
    EXPECT_NEAR(part->base.a, middle, 1e-9);
    EXPECT_NEAR(part->base.j, 1.0, 1e-6);
    EXPECT_NEAR(part->base.angular_a, middle, 1e-9);
    EXPECT_NEAR(part->object.v, part->base.v, 1e-12) << "it stands on the base";
  }
}

TEST(ToppleMonitorTest, AnEpisodeEndsWithEachFall) {
  reports::ToppleMonitor monitor({});
  std::vector<std::uint32_t> episodes;
  std::vector<ToppleState> states;
  const std::vector<double> tilts{0.0, 0.0, 0.0, 0.0, 0.02, 0.6, 1.5,
                                  0.0, 0.0, 0.0, 0.0, 0.02, 0.7};
  for (std::size_t i = 0; i < tilts.size(); ++i) {
    const auto part = monitor.Add(SampleAt(0.05 * static_cast<double>(i), {}, tilts[i]));
    if (!part) continue;
    episodes.push_back(part->episode);
    states.push_back(part->state);
  }
  using State = ToppleState;
  EXPECT_THAT(episodes, ElementsAre(0, 0, 0, 0, 1, 1, 1)) << "none while samples are gathered";
  EXPECT_THAT(states, ElementsAre(State::kNoTopple, State::kShaking, State::kTopple, State::kTopple,
                                  State::kNoTopple, State::kShaking, State::kTopple));
}

TEST(ToppleMonitorTest, NothingIsDifferencedAcrossTwoLegs) {
  reports::ToppleMonitor monitor({});
  for (int i = 0; i < 4; ++i) monitor.Add(SampleAt(0.05 * i, {}));
  monitor.Begin();
  for (int i = 4; i < 8; ++i) {
    const auto part = monitor.Add(SampleAt(0.05 * i, {100.0, 0.0, 0.0}));
    EXPECT_EQ(part.has_value(), i == 7);
    if (part) {
      EXPECT_EQ(part->base.v, 0.0);
    }
  }
}

TEST(FiltersTest, ButterworthHasTheCoefficientsOfScipy) {
  // scipy.signal.butter(2, 2.0, fs=20.0) of SciPy 1.10.1.
  const SecondOrderSection s = ButterworthLowPass(2.0, 20.0);
  EXPECT_NEAR(s.b0, 0.06745527388907191, 1e-12);
  EXPECT_NEAR(s.b1, 0.13491054777814382, 1e-12);
  EXPECT_NEAR(s.b2, 0.06745527388907191, 1e-12);
  EXPECT_NEAR(s.a1, -1.142980502539901, 1e-12);
  EXPECT_NEAR(s.a2, 0.41280159809618866, 1e-12);
}

TEST(FiltersTest, AConstantPassesAndTheCutoffIsHalved) {
  const SecondOrderSection section = ButterworthLowPass(2.0, 20.0);
  EXPECT_THAT(Filtered(std::vector<double>(50, 3.0), section, true), Each(DoubleNear(3.0, 1e-12)));
  std::vector<double> wave(4000);
  for (std::size_t i = 0; i < wave.size(); ++i) {
    wave[i] = std::sin(2.0 * geometry::kPi * 2.0 * 0.05 * static_cast<double>(i));
  }
  const std::vector<double> once = Filtered(wave, section, true),
                            twice = Filtered(wave, section, false);
  double squares = 0.0, squares_once = 0.0, squares_twice = 0.0;
  for (std::size_t i = 1000; i < 3000; ++i) {  // whole periods, far from the ends
    squares += wave[i] * wave[i];
    squares_once += once[i] * once[i];
    squares_twice += twice[i] * twice[i];
  }
  EXPECT_NEAR(squares_once / squares, 0.5, 1e-6) << "-3 dB";
  EXPECT_NEAR(squares_twice / squares, 0.25, 1e-6);
}

TEST(FiltersTest, WindowsAverageAndPickTheMiddle) {
  const std::vector<double> signal{0.0, 0.0, 9.0, 0.0, 3.0};
  EXPECT_THAT(MovingAverage(signal, 3, false), ElementsAre(0.0, 3.0, 3.0, 4.0, 2.0));
  EXPECT_THAT(MovingAverage(signal, 3, true), ElementsAre(0.0, 0.0, 3.0, 3.0, 4.0));
  EXPECT_THAT(MovingMedian(signal, 3, false), ElementsAre(0.0, 0.0, 0.0, 3.0, 3.0));
  EXPECT_EQ(DelayOf(signal, {0.0, 0.0, 0.0, 0.0, 9.0}, 4), 2u);
  EXPECT_THAT(CentralDifferences({0.0, 1.0, 4.0, 9.0}, 0.5), ElementsAre(2.0, 4.0, 8.0, 10.0));
}

TEST(FiltersTest, AnAlternatingSignalIsItsOwnOpposite) {
  std::vector<double> signal;
  for (int i = 0; i < 1000; ++i) signal.push_back(i % 2 == 0 ? 1.0 : -1.0);
  const std::vector<double> correlation = Autocorrelation(signal, 2);
  EXPECT_NEAR(correlation[0], 1.0, 1e-12);
  EXPECT_NEAR(correlation[1], -0.999, 1e-9);
  EXPECT_NEAR(correlation[2], 0.998, 1e-9);
}

TEST(SeparationTest, TheAreaIsTheShareOfPairsInOrder) {
  // Of nine pairs five are in order, one is tied.
  const std::vector<RunScores> runs{{{3.0, 1.0}, {0.0, 2.0}}, {{2.0}, {5.0}}};
  EXPECT_DOUBLE_EQ(AreaUnderCurve(runs), 4.5 / 9.0);
  EXPECT_DOUBLE_EQ(AreaUnderCurve({{{2.0, 3.0}, {0.0, 1.0}}}), 1.0);
  EXPECT_TRUE(std::isnan(AreaUnderCurve({{{2.0}, {}}})));
}

TEST(SeparationTest, NormalDistributionsHaveTheAreaOfTheBinormalModel) {
  // Phi(d / sqrt 2) for means that differ by d deviations: 0.7602 for d = 1 [Green, Swets 1966].
  base::Rng rng(3);
  std::vector<RunScores> runs(20);
  for (RunScores& run : runs) {
    for (int i = 0; i < 500; ++i) {
      run.positive.push_back(rng.Normal(1.0, 1.0));
      run.negative.push_back(rng.Normal(0.0, 1.0));
    }
  }
  const Interval area = AreaInterval({runs}, base::Rng(4));
  EXPECT_NEAR(area.estimate, 0.7602, 0.01);
  EXPECT_LT(area.lower, area.estimate);
  EXPECT_GT(area.upper, area.estimate);
  EXPECT_LT(area.upper - area.lower, 0.03);
  EXPECT_NEAR(BestThreshold(runs).threshold, 0.5, 0.15) << "where the densities cross";
  const RocPoint judged = JudgedAt(runs, 0.5);
  EXPECT_NEAR(judged.hits, 0.6915, 0.02);
  EXPECT_NEAR(judged.false_alarms, 0.3085, 0.02);
}

TEST(SeparationTest, WhatKnowsTheStratumAloneTellsNothingWithin) {
  // Nearly all positives are of the stratum with the larger numbers, which know nothing else.
  base::Rng rng(5);
  std::vector<std::vector<RunScores>> strata(2, std::vector<RunScores>(10));
  std::vector<RunScores> all;
  for (int stratum = 0; stratum < 2; ++stratum) {
    for (RunScores& run : strata[stratum]) {
      for (int i = 0; i < 400; ++i) {
        if (i < (stratum == 1 ? 95 : 5)) run.positive.push_back(rng.Normal(3.0 * stratum, 1.0));
        run.negative.push_back(rng.Normal(3.0 * stratum, 1.0));
      }
      all.push_back(run);
    }
  }
  EXPECT_GT(AreaInterval({all}, base::Rng(4)).lower, 0.6);
  const Interval within = AreaIntervalWithin(strata, base::Rng(4));
  EXPECT_NEAR(within.estimate, 0.5, 0.03);
  EXPECT_LT(within.lower, 0.5);
  EXPECT_GT(within.upper, 0.5);
  // A stratum without positives says nothing; with one stratum it is the area itself.
  for (RunScores& run : strata[0]) run.positive.clear();
  EXPECT_DOUBLE_EQ(AreaIntervalWithin(strata, base::Rng(4)).estimate, AreaUnderCurve(strata[1]));
  EXPECT_TRUE(std::isnan(AreaIntervalWithin({strata[0]}, base::Rng(4)).estimate));
}

TEST(SeparationTest, ResamplingKeepsHowManyRunsOfEachKindThereAre) {
  // Runs of one kind are all alike: only the mixture of kinds could move the area.
  const RunScores fast{{2.0, 3.0, 3.0, 3.0}, {1.0, 2.0}}, slow{{1.0}, {0.0, 1.0, 1.0, 3.0}};
  std::vector<RunScores> runs;
  std::vector<std::string> kinds;
  for (int i = 0; i < 10; ++i) {
    runs.push_back(fast);
    kinds.push_back("fast");
    runs.push_back(slow);
    kinds.push_back("slow");
  }
  const Interval mixed = AreaInterval({runs}, base::Rng(4));
  EXPECT_GT(mixed.upper - mixed.lower, 0.02);
  const Interval area = AreaInterval(StrataOf(runs, kinds), base::Rng(4));
  EXPECT_DOUBLE_EQ(area.estimate, mixed.estimate);
  EXPECT_DOUBLE_EQ(area.lower, area.estimate);
  EXPECT_DOUBLE_EQ(area.upper, area.estimate);
}

TEST(SeparationTest, RunsAloneOfTheirKindAreResampledTogether) {
  const std::vector<RunScores> runs{{{1.0}, {}}, {{2.0}, {}}, {{3.0}, {}}, {{4.0}, {}}};
  const auto sizes = [&](const std::vector<std::string>& kinds) {
    std::vector<std::size_t> sizes;
    for (const auto& stratum : StrataOf(runs, kinds)) sizes.push_back(stratum.size());
    return sizes;
  };
  EXPECT_THAT(sizes({"a", "a", "a", "a"}), ElementsAre(4));
  EXPECT_THAT(sizes({"a", "b", "a", "b"}), ElementsAre(2, 2));
  EXPECT_THAT(sizes({"a", "b", "c", "b"}), ElementsAre(2, 2)) << "b, and the others";
  EXPECT_THROW(StrataOf(runs, {"a"}), std::logic_error);
}

TEST(ExperienceRunsTest, ARunIsOfTheKindOfItsMotionSets) {
  EXPECT_EQ(MotionSetOf("move_base_param(NT1, fast)"), "fast");
  EXPECT_EQ(MotionSetOf("move_base(home)"), "home");
  EXPECT_EQ(MotionSetOf("wait"), "wait");
  EXPECT_THAT(MotionSetsOf({{"0", {"drive(a, slow)", "drive(b, slow)"}, {}},
                            {"1", {"drive(a, slow)", "drive(a, fast)"}, {}}}),
              ElementsAre("slow", "fast, slow"));
}

class ExperienceReportTest : public ::testing::Test {
 protected:
  knowledge::ExperienceStore Store(int legs) {
    const std::string path = (folder_.path() / "e.db").string();
    knowledge::ExperienceStore store(path, knowledge::ExperienceStore::Mode::kWrite);
    for (int run = 0; run < 4; ++run) {
      for (int leg = 0; leg < legs; ++leg) store.Write(LegOf(run, leg));
    }
    return store;
  }

  /// A drive of 20 s; every third load falls after a jerk half a second before.
  static knowledge::ExperienceBatch LegOf(int run, int leg, const std::string& set = "fast") {
    knowledge::ExperienceBatch batch{set + "/" + std::to_string(run), "drive(a, " + set + ")", {}};
    const bool falls = leg % 3 == 0;
    for (int i = 0; i < 400; ++i) {
      ToppleEpisodePart part;
      part.time = 1000.0 * leg + 0.05 * i;
      part.x = 0.02 * i;
      part.base.v = 0.4;
      part.base.j = falls && i > 180 && i < 190 ? 20.0 : std::sin(0.7 * i);
      part.alpha = falls && i >= 200 && i < 210 ? 1.0 : i % 50 == 0 ? 0.02 : 0.001;
      part.state = part.alpha > 0.5    ? ToppleState::kTopple
                   : part.alpha > 0.01 ? ToppleState::kShaking
                                       : ToppleState::kNoTopple;
      batch.parts.push_back(part);
    }
    return batch;
  }

  const hires::test_support::TemporaryFolder folder_;
};

TEST_F(ExperienceReportTest, StatsCountWhatIsThere) {
  std::string text;
  const nlohmann::ordered_json stats = StatsOf(Store(3), &text);
  EXPECT_EQ(stats.at("parts"), 4800);
  EXPECT_EQ(stats.at("runs"), 4);
  const nlohmann::ordered_json& action = stats.at("actions").at(0);
  EXPECT_EQ(action.at("falls"), 4);
  EXPECT_EQ(action.at("topple"), 40);
  EXPECT_NEAR(action.at("time").get<double>(), 240.0, 1e-9);
  EXPECT_NEAR(stats.at("samples_per_second").get<double>(), 20.0, 1e-9);
  EXPECT_THAT(text, HasSubstr("drive(a, fast)"));
}

TEST_F(ExperienceReportTest, TheFeatureThatForetellsFallsIsFound) {
  std::string text;
  const nlohmann::ordered_json analysis = AnalysisOf(Store(6), 1, &text);
  const nlohmann::ordered_json& prediction = analysis.at("prediction");
  EXPECT_EQ(prediction.at("falls"), 8);
  for (const nlohmann::ordered_json& feature : prediction.at("features")) {
    const double area = feature.at("area").at("estimate");
    if (feature.at("feature") == "base |j|") {
      EXPECT_DOUBLE_EQ(area, 1.0);
    }
    if (feature.at("feature") == "base |v|") {
      EXPECT_DOUBLE_EQ(area, 0.5) << "it is always the same";
    }
  }
  EXPECT_EQ(analysis.at("pictures").at("falls").at("x").size(), 8u);
  std::string again;
  EXPECT_EQ(AnalysisOf(Store(0), 1, &again), analysis) << "equal seeds, equal bits";
}

TEST_F(ExperienceReportTest, FallsAndWindowsAreCountedByMotionSet) {
  knowledge::ExperienceStore store = Store(6);
  for (int run = 0; run < 2; ++run) {
    for (int leg = 0; leg < 3; ++leg) store.Write(LegOf(run, leg, "slow"));
  }
  std::string text;
  const nlohmann::ordered_json prediction = AnalysisOf(store, 1, &text).at("prediction");
  // Ten windows in a drive, three of which are too near to a fall.
  EXPECT_EQ(prediction.at("motion_sets"),
            nlohmann::ordered_json::parse(
                R"([{"motion_set": "fast", "runs": 4, "falls": 8, "calm_windows": 216},
                    {"motion_set": "slow", "runs": 2, "falls": 2, "calm_windows": 54}])"));
  EXPECT_EQ(prediction.at("falls"), 10);
  EXPECT_EQ(prediction.at("calm_windows"), 270);
  EXPECT_EQ(prediction.at("resamples"), 2000);
  EXPECT_THAT(text, HasSubstr("motion set  runs  falls  windows without"));
}

TEST_F(ExperienceReportTest, RunsAreResampledWithinTheirMotionSet) {
  // Each run is like the others of its motion set, and only fast ones have falls.
  knowledge::ExperienceStore store = Store(3);
  for (int run = 0; run < 4; ++run) store.Write(LegOf(run, 1, "slow"));
  std::string text;
  const nlohmann::ordered_json analysis = AnalysisOf(store, 1, &text);
  for (const nlohmann::ordered_json& feature : analysis.at("prediction").at("features")) {
    const nlohmann::ordered_json& area = feature.at("area");
    EXPECT_EQ(area.at("lower"), area.at("upper")) << feature.at("feature");
  }
}

TEST_F(ExperienceReportTest, TooLittleIsSaid) {
  knowledge::ExperienceStore store = Store(0);
  store.Write(LegOf(0, 0));
  std::string text;
  EXPECT_THAT(hires::test_support::ConfigErrorOf([&] { AnalysisOf(store, 1, &text); }),
              HasSubstr("has 400 parts; wanted at least 1000"));
}

}  // namespace
}  // namespace hires::lab::experience_test
