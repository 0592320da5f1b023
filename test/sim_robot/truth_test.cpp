#include "sim_robot/truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "hires/base/text.h"
#include "hires/imagination/imagination_setup.h"
#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::sim_robot::truth_test {
namespace {

using hires::test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kTruths = HIRES_SOURCE_DIR "/config/truths";

TEST(TruthPathTest, ANameIsAFileOfTheFolderAndAPathItself) {
  EXPECT_EQ(TruthPath("", kTruths), kTruths + "/same.yaml");
  EXPECT_EQ(TruthPath("same", kTruths), kTruths + "/same.yaml");
  EXPECT_EQ(TruthPath("here/own.yaml", kTruths), "here/own.yaml");
}

TEST(TruthPathTest, AnUnknownNameIsRefusedWithNamesLikeIt) {
  EXPECT_THAT(ConfigErrorOf([] { TruthPath("sane", kTruths); }),
              AllOf(HasSubstr(kTruths), HasSubstr("'sane'"), HasSubstr("'same'")));
}

TEST(FindTruthTest, AFileOfOnesOwnDoesNotPassForAShippedOne) {
  const hires::test_support::TemporaryFolder folder;
  const std::string text = base::ReadTextFile(kTruths + "/same.yaml");
  const std::string own = FindTruth(folder.Write("same.yaml", text), kTruths).name;
  EXPECT_THAT(own, HasSubstr((folder.path() / "same.yaml#").string()));
  EXPECT_EQ(TruthNote(own), own);  // and not imagination's own model
  EXPECT_NE(FindTruth(folder.Write("same.yaml", text + "# more"), kTruths).name, own);
  EXPECT_EQ(FindTruth("same", kTruths).name, "same");
  EXPECT_EQ(FindTruth(kTruths + "/../truths/foreign.yaml", kTruths).name, "foreign");
}

/// What is said of the file of `same` with one text in another's place.
class TruthFileTest : public ::testing::Test {
 protected:
  std::string ErrorAfter(const std::string& from, const std::string& to) {
    std::string text = base::ReadTextFile(kTruths + "/same.yaml");
    const std::size_t at = text.find(from);
    if (at == std::string::npos) return "same.yaml has no " + from;
    const std::string path = folder_.Write("truth.yaml", text.replace(at, from.size(), to));
    return ConfigErrorOf([&] { ReadTruth(path); });
  }
  hires::test_support::TemporaryFolder folder_;
};

TEST_F(TruthFileTest, AnEngineThatDoesNotExistIsRefusedWithThoseThatDo) {
  EXPECT_THAT(ErrorAfter("engine: ode", "engine: bullet"),
              AllOf(HasSubstr("truth.yaml: engine is 'bullet'"), HasSubstr("ode")));
}

TEST_F(TruthFileTest, ABadKeyIsNamed) {
  EXPECT_THAT(ErrorAfter("sensing: fitted", "sensing: clouds"),
              AllOf(HasSubstr("sensing is 'clouds'"), HasSubstr("pictures")));
  EXPECT_THAT(ErrorAfter("localisation:", "lokalisation:"), HasSubstr("localisation"));
  EXPECT_THAT(ErrorAfter("changes: {}", "changes: {object_mas: {}}"),
              AllOf(HasSubstr("uncertainty.changes"), HasSubstr("'object_mass'")));
}

TEST_F(TruthFileTest, SensingIsReadAsItsWord) {
  const auto sensing = [this](const std::string& word) {
    std::string text = base::ReadTextFile(kTruths + "/same.yaml");
    text.replace(text.find("sensing: fitted"), 15, "sensing: " + word);
    return ReadTruth(folder_.Write("truth.yaml", text)).sensing;
  };
  EXPECT_EQ(sensing("fitted"), Sensing::kFitted);
  EXPECT_EQ(sensing("ideal"), Sensing::kIdeal);
  EXPECT_EQ(sensing("pictures"), Sensing::kPictures);
}

TEST_F(TruthFileTest, EachBadEventIsNamed) {
  const auto with = [this](const std::string& events) {
    return ErrorAfter("events: {}", "events: {" + events + "}");
  };
  EXPECT_THAT(with("earthquakes: {}"), HasSubstr("events.earthquakes"));
  EXPECT_THAT(with("sills: [{from: [0, 0], to: [0, 0], width: 0.1, height: 0.01, source: x}]"),
              HasSubstr("wanted at least 0.01 m from `from`"));
  EXPECT_THAT(with("sills: [{from: [0, 0], to: [0, 1], width: 0.1, height: 0.2, source: x}]"),
              HasSubstr("height is '0.2'"));
  EXPECT_THAT(with("sills: [{from: [0, 0], to: [0, 1], width: 0.1, height: 0.01}]"),
              HasSubstr("source is missing"));
  EXPECT_THAT(with("patches: [{center: [0, 0], radius: 1, traction: 0, source: x}]"),
              HasSubstr("traction is '0'"));
  EXPECT_THAT(with("bumps: {mean_interval: 60, speed: [0.2, 0.1], duration: 0.2, source: x}"),
              HasSubstr("the least and the greatest"));
  EXPECT_THAT(with("moved: [{body: chair4, by: [0, 0, 7], probability: 1, source: x}]"),
              HasSubstr("yaw within 6.3 rad"));
}

TEST_F(TruthFileTest, ABadControllerAndBadDrawsAreNamed) {
  const auto controller = [this](const std::string& changes) {
    return ErrorAfter("controller: {}", "controller: {" + changes + "}");
  };
  EXPECT_THAT(controller("at_timeout: {value: halt, source: x}"), HasSubstr("'halt'"));
  EXPECT_THAT(controller("command_lagg: {value: 0, source: x}"), HasSubstr("'command_lag'"));
  EXPECT_THAT(ErrorAfter("correlations: []",
                         "correlations: [{between: [object_mass, sway], coefficient: 0.5, "
                         "source: x}]"),
              HasSubstr("'object_mass' is not in `changes`"));
  EXPECT_THAT(ErrorAfter("file: same", "file: nowhere.yaml"), HasSubstr("nowhere.yaml"));
}

TEST(TruthTest, SameChangesNothing) {
  imagination::ImaginationSetup imagined;
  imagined.uncertainty =
      std::make_shared<const imagination::Uncertainty>(imagination::NoUncertainty());
  const auto setup = SetupOf(ReadTruth(kTruths + "/same.yaml"), imagined, {}, base::Rng(1));
  EXPECT_EQ(setup.uncertainty, imagined.uncertainty);
  EXPECT_EQ(setup.scene, imagined.scene);
}

/// A truth that said by itself what happens at a time-out would win over the guard.
TEST(TruthTest, EveryTruthStopsAtATimeoutExceptWhereTheGuardStandsBeforeTheBase) {
  auto config = imagination::ReadSetupConfig(HIRES_SOURCE_DIR "/config/scene.yaml");
  for (const bool is_guarded : {false, true}) {
    config.has_base_guard = is_guarded;
    const auto imagined = imagination::LoadImaginationSetup(config);
    for (const char* name : {"same", "foreign", "harsh"}) {
      const auto setup = SetupOf(ReadTruth(TruthPath(name, kTruths)), imagined, {}, base::Rng(1));
      const auto& base = setup.scene->robot.profile.base_controller;
      EXPECT_EQ(base.stops_at_timeout, !is_guarded) << name;
    }
  }
}

/// 400 draws of a truth from nothing but its own changes.
std::vector<simulation::Variation> Drawn(const std::string& name) {
  const Truth truth = ReadTruth(TruthPath(name, kTruths));
  imagination::ImaginationSetup imagined;
  imagined.uncertainty = std::make_shared<const imagination::Uncertainty>(
      imagination::LoadUncertainty(HIRES_SOURCE_DIR "/config/uncertainty.yaml"));
  imagination::Uncertainty drawn = *imagined.uncertainty;
  for (const auto& [quantity, distribution] : truth.changes) {
    drawn.quantities[quantity] = distribution;
  }
  std::vector<simulation::Variation> draws;
  for (std::uint64_t i = 0; i < 400; ++i) {
    draws.push_back(DrawVariation(truth, drawn, base::Rng(7).Fork(i)));
  }
  return draws;
}

template <typename Get>
double Mean(const std::vector<simulation::Variation>& draws, Get get) {
  double sum = 0.0;
  for (const auto& draw : draws) sum += get(draw);
  return sum / static_cast<double>(draws.size());
}

TEST(TruthTest, ForeignAndHarshAreOtherDistributionsAndNotJustOtherSeeds) {
  const auto mass = [](const simulation::Variation& v) { return v.mass_factor; };
  const auto radius = [](const simulation::Variation& v) { return v.radius_factor; };
  const double same = Mean(Drawn("same"), mass), foreign = Mean(Drawn("foreign"), mass);
  EXPECT_NEAR(same, 1.0, 0.03);  // uniform 0.8 .. 1.2: sd of the mean 0.006
  EXPECT_NEAR(foreign, 1.29, 0.06);
  EXPECT_GT(Mean(Drawn("harsh"), mass), foreign + 0.1);
  EXPECT_LT(Mean(Drawn("foreign"), radius), Mean(Drawn("same"), radius) - 0.02);
  EXPECT_LT(Mean(Drawn("harsh"), radius), Mean(Drawn("foreign"), radius) - 0.02);
}

TEST(TruthTest, CorrelatedQuantitiesComeTogetherAndOthersAreAsDrawnAlone) {
  const auto draws = Drawn("foreign");
  const auto log_mass = [](const simulation::Variation& v) { return std::log(v.mass_factor); };
  const auto height = [](const simulation::Variation& v) { return v.com_height_factor; };
  const double m = Mean(draws, log_mass), h = Mean(draws, height);
  const auto mean_of = [&](auto get) { return Mean(draws, get); };
  const double mh = mean_of([&](const auto& v) { return (log_mass(v) - m) * (height(v) - h); });
  const double mm = mean_of([&](const auto& v) { return std::pow(log_mass(v) - m, 2); });
  const double hh = mean_of([&](const auto& v) { return std::pow(height(v) - h, 2); });
  EXPECT_NEAR(mh / std::sqrt(mm * hh), -0.6, 0.1);
  EXPECT_EQ(draws.front().sway_factor, Drawn("same").front().sway_factor);  // nobody changed it
}

}  // namespace
}  // namespace hires::sim_robot::truth_test
