#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/world/world.h"
#include "lab/src/experiment/experiment.h"
#include "support/temporary_folder.h"

namespace hires::lab::experiment_config_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kFolder = std::string(HIRES_SOURCE_DIR) + "/lab/config/experiments/";
const std::string kShared = HIRES_SHARED_DATA;

/// A file with `was` replaced by `is`, read.
std::string ErrorAfter(const std::string& name, const std::string& was, const std::string& is) {
  std::string yaml = base::ReadTextFile(kFolder + name);
  const std::size_t at = yaml.find(was);
  if (at == std::string::npos) return "'" + was + "' does not stand in " + name;
  yaml.replace(at, was.size(), is);
  const std::string path = testing::TempDir() + "changed_experiment.yaml";
  std::ofstream(path) << yaml;
  try {
    ReadExperiment(path);
  } catch (const base::ConfigError& error) {
    return error.what();
  }
  return "no error";
}

using Rows = std::vector<std::map<std::string, std::string>>;
Rows ReadCsv(const std::string& path) {
  Rows rows;
  std::vector<std::string> heads;
  for (const std::string& line : base::Split(base::ReadTextFile(path), '\n')) {
    const std::vector<std::string> fields = base::Split(line, ',');
    if (heads.empty()) {
      heads = fields;
    } else if (fields.size() == heads.size()) {
      rows.emplace_back();
      for (std::size_t i = 0; i < heads.size(); ++i) rows.back()[heads[i]] = fields[i];
    }
  }
  return rows;
}

TEST(ExperimentConfigTest, EveryFileOfThePackageIsSound) {
  int num_files = 0;
  for (const auto& entry : fs::directory_iterator(kFolder)) {
    ExperimentOverrides overrides;
    overrides.map = "some_map.yaml";  // two of them want one
    const ExperimentConfig config = ReadExperiment(entry.path().string(), overrides);
    EXPECT_FALSE(config.expect.empty()) << config.name << " expects nothing";
    EXPECT_NO_THROW(imagination::ReadSetupConfig(config.scene)) << config.name;
    ++num_files;
  }
  EXPECT_GE(num_files, 7);
}

TEST(ExperimentConfigTest, GoalsAreTheAreasOfTheRestaurant) {
  const std::map<std::string, std::string> areas{
      {"EC1", "preManipulationAreaEastCounter1"}, {"NT1", "preManipulationAreaNorthTable1"},
      {"ST1", "preManipulationAreaSouthTable1"},  {"WT2", "preManipulationAreaWestTable2"},
      {"ET2", "preManipulationAreaEastTable2"},   {"home", "home"}};
  const world::World world =
      world::LoadWorld(std::string(HIRES_SOURCE_DIR) + "/worlds/restaurant.world");
  for (const char* name :
       {"legs_world", "legs_world_noise", "paired", "topple_loop", "durations"}) {
    for (const Goal& goal : ReadExperiment(kFolder + name + ".yaml").goals) {
      const geometry::Pose2 X_MF = geometry::Flatten(*world.FindFrame(areas.at(goal.name)));
      EXPECT_DOUBLE_EQ(goal.X_MG.x, X_MF.x) << name << ' ' << goal.name;
      EXPECT_DOUBLE_EQ(goal.X_MG.y, X_MF.y) << name << ' ' << goal.name;
      EXPECT_NEAR(goal.X_MG.yaw, X_MF.yaw, 1e-12) << name << ' ' << goal.name;
    }
  }
}

/// As the tables shorten it.
std::string Short(const std::string& name) {
  const std::map<std::string, std::string> names{{"TorsoUpPosture", "up"},
                                                 {"TorsoDownPosture", "down"},
                                                 {"ArmTuckedPosture", "tucked"},
                                                 {"ArmUnTuckedPosture", "untucked"}};
  const auto found = names.find(name);
  return found == names.end() ? name : found->second;
}

TEST(ExperimentConfigTest, DurationsAreThoseOfThePublishedTables) {
  if (!fs::exists(kShared + "/table_6_1_sim.csv")) GTEST_SKIP() << "no tables in " << kShared;
  const auto config = ReadExperiment(kFolder + "durations.yaml");
  const auto& rows = std::get<DurationsConfig>(config.kind).rows;
  const auto compare = [&](const std::string& file, auto reference) {
    std::size_t next = 0;
    for (const auto& published : ReadCsv(kShared + file)) {
      ASSERT_LT(next, rows.size());
      const DurationsConfig::Row& row = rows[next++];
      EXPECT_EQ(row.action, published.at("action"));
      EXPECT_EQ(row.motion_set, published.at("parameter"));
      EXPECT_EQ(Short(row.from), published.at("from"));
      EXPECT_EQ(Short(row.to), published.at("to"));
      EXPECT_EQ(reference(row).mean, std::stod(published.at("mean_s")));
      EXPECT_EQ(reference(row).sigma, std::stod(published.at("sigma_s")));
    }
    EXPECT_EQ(next, 12u);
    EXPECT_EQ(next, rows.size());
  };
  compare("/table_6_1_sim.csv", [](const auto& row) { return row.simulated; });
  compare("/table_6_2_real.csv", [](const auto& row) { return row.real; });
}

TEST(ExperimentConfigTest, TopplingCountsAreThePublishedOnes) {
  if (!fs::exists(kShared + "/toppling_6_5.csv")) GTEST_SKIP() << "no table in " << kShared;
  const auto config = ReadExperiment(kFolder + "topple_loop.yaml");
  const auto& references = std::get<ToppleLoopConfig>(config.kind).references;
  for (const auto& published : ReadCsv(kShared + "/toppling_6_5.csv")) {
    for (const char* set : {"fast", "slow"}) {
      const imagination::OutcomeCounts& counts = references.at(set).counts;
      const std::map<std::string, int> ours{{"all", counts.total()},
                                            {"notopple", counts.notopple},
                                            {"shaking", counts.shaking},
                                            {"topple", counts.topple}};
      const int count = std::stoi(published.at(std::string(set) + "_count"));
      if (published.at("event") == "duration_s") {
        EXPECT_EQ(references.at(set).duration, count);
      } else {
        EXPECT_EQ(ours.at(published.at("event")), count) << set << ' ' << published.at("event");
      }
    }
  }
}

TEST(ExperimentConfigTest, OverridesReplaceSeedRunsAndMap) {
  const ExperimentConfig legs = ReadExperiment(kFolder + "legs_map_sim.yaml", {9, 12, "m.yaml"});
  EXPECT_EQ(legs.seed, 9u);
  EXPECT_EQ(legs.map, "m.yaml");
  EXPECT_EQ(std::get<LegsConfig>(legs.kind).legs, 12);
  const ExperimentConfig loop = ReadExperiment(kFolder + "topple_loop.yaml", {{}, 2, ""});
  EXPECT_EQ(std::get<ToppleLoopConfig>(loop.kind).chains, 2);
  EXPECT_DOUBLE_EQ(std::get<ToppleLoopConfig>(loop.kind).duration, 3600.0);
  EXPECT_NE(loop.hash, ReadExperiment(kFolder + "topple_loop.yaml").hash);
  EXPECT_THROW(ReadExperiment(kFolder + "topple_loop.yaml", {{}, 0, ""}), base::ConfigError);
}

TEST(ExperimentConfigTest, AMapThatIsToBeGivenIsAskedFor) {
  EXPECT_THAT(ErrorAfter("legs_map_sim.yaml", "seed: 1", "seed: 1"), HasSubstr("--map FILE"));
}

TEST(ExperimentConfigTest, AFileThatIsMissingIsNamed) {
  try {
    ReadExperiment("/no/such/experiment.yaml");
    FAIL() << "accepted";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/no/such/experiment.yaml"));
  }
}

TEST(ExperimentConfigTest, TheObstacleLayerIsTheScenesNoneOrAFile) {
  const hires::test_support::TemporaryFolder folder;
  std::string legs = base::ReadTextFile(kFolder + "legs_world.yaml");
  const std::string scene = "../../../config/scene.yaml";
  legs.replace(legs.find(scene), scene.size(), fs::path(kFolder + scene).lexically_normal());
  const auto layer_of = [&](const std::string& more) {
    return ReadExperiment(folder.Write("legs.yaml", legs + more)).obstacle_layer;
  };
  EXPECT_EQ(layer_of(""), "scene");
  EXPECT_EQ(layer_of("obstacle_layer: scene\n"), "scene");
  EXPECT_EQ(layer_of("obstacle_layer: none\n"), "none");
  EXPECT_EQ(layer_of("obstacle_layer: mine.yaml\n"), (folder.path() / "mine.yaml").string());
}

TEST(ExperimentConfigTest, MistakesAreNamedWithTheirPlace) {
  const auto legs = [](const char* was, const char* is) {
    return ErrorAfter("legs_world.yaml", was, is);
  };
  EXPECT_THAT(legs("kind: legs", "kind: legs"), HasSubstr("counts from this file's folder"));
  EXPECT_THAT(legs("kind: legs", "kind: lags"), HasSubstr("kind is 'lags', wanted one of 'legs'"));
  EXPECT_THAT(legs("legs: 100", "legs: 0"), HasSubstr("legs.legs is '0'"));
  EXPECT_THAT(legs("chains: 1", "chain: 1"),
              HasSubstr("'legs.chain' is unknown; did you mean 'legs.chains'"));
  EXPECT_THAT(legs("seed: 1", "seed: 1\nsead: 1"), HasSubstr("key 'sead' is unknown"));
  EXPECT_THAT(legs("seed: 1", "seed: -1"), HasSubstr("seed is '-1'"));
  EXPECT_THAT(legs("name: NT1", "name: HOME"), HasSubstr("wanted every name once"));
  EXPECT_THAT(legs("name: NT1", "name: ''"), HasSubstr("wanted some text"));
  EXPECT_THAT(legs("pose: [7.81, 12.79, -1.57]", "pose: [7.81, 12.79]"),
              HasSubstr("wanted a list of 3 numbers"));
  EXPECT_THAT(legs("pose: [7.81, 12.79, -1.57]", "pose: [7.81, 12.79, -90]"),
              HasSubstr("yaw within 6.3 rad"));
  EXPECT_THAT(legs("pose: [7.81, 12.79, -1.57]", "pose: [.nan, 12.79, 0]"),
              HasSubstr("wanted a finite number"));
  EXPECT_THAT(legs("uncertainty_changes: {}", "uncertainty_changes: {a: 1}"),
              HasSubstr("uncertainty_changes.a is '1', wanted a map of keys"));
}

TEST(ExperimentConfigTest, MistakesOfTheOtherKindsAreNamedToo) {
  EXPECT_THAT(ErrorAfter("paired.yaml", "from: EC1", "from: EC2"),
              HasSubstr("paired.from is 'EC2', wanted one of 'EC1', 'NT1'"));
  EXPECT_THAT(ErrorAfter("paired.yaml", "[fast, slow]", "[fast, fast]"),
              HasSubstr("wanted two different motion sets"));
  EXPECT_THAT(ErrorAfter("topple_loop.yaml", "[NT1, ST1, WT2, ET2, EC1]", "[NT1, ST2]"),
              HasSubstr("goal 'ST2' is unknown"));
  EXPECT_THAT(ErrorAfter("topple_loop.yaml", "[NT1, ST1, WT2, ET2, EC1]", "[NT1]"),
              HasSubstr("wanted at least two goals"));
  EXPECT_THAT(ErrorAfter("topple_loop.yaml", "truth_per: leg", "truth_per: day"),
              HasSubstr("truth_per is 'day', wanted one of 'leg', 'chain'"));
  EXPECT_THAT(ErrorAfter("topple_loop.yaml", "slow: {notopple", "slaw: {notopple"),
              HasSubstr("reference.slow is missing"));
  EXPECT_THAT(ErrorAfter("durations.yaml", "mean: 14.04", "mean: -1"),
              HasSubstr("actions[0].simulated.mean is '-1'"));
  EXPECT_THAT(ErrorAfter("durations.yaml", "runs: 20", "runs: many"),
              HasSubstr("wanted a whole number"));
  EXPECT_THAT(ErrorAfter("durations.yaml", "fast, from: ET2, to: EC1", "fast, from: ET2, to: NT1"),
              HasSubstr("wanted one way back of move_base_param fast from EC1 to ET2"));
  EXPECT_THAT(ErrorAfter("durations.yaml", "[scene, unscaled]", "[scene, scene]"),
              HasSubstr("wanted at least one, and each once"));
  EXPECT_THAT(ErrorAfter("durations.yaml", "[scene, unscaled]", "[dwa]"),
              HasSubstr("planner 'dwa' is unknown"));
  EXPECT_THAT(ErrorAfter("durations.yaml", "postures_at: home", "postures_at: house"),
              HasSubstr("durations.postures_at is 'house', wanted one of 'EC1'"));
}

TEST(ExperimentConfigTest, WhatBefallsARobotIsReadAndRefusedWithItsKey) {
  const ExperimentConfig carried = ReadExperiment(kFolder + "lost_carried.yaml");
  EXPECT_TRUE(carried.is_carried);
  const ExperimentConfig wet = ReadExperiment(kFolder + "lost_wet.yaml");
  ASSERT_EQ(wet.wet.size(), 3U);
  EXPECT_EQ(wet.wet[0].radius, 1.0);
  const ExperimentConfig moved = ReadExperiment(kFolder + "lost_moved.yaml");
  ASSERT_EQ(moved.moved.size(), 6U);
  EXPECT_EQ(moved.moved[0].body, "chair1");
  EXPECT_THAT(ReadExperiment(kFolder + "lost_corridor.yaml").world, HasSubstr("corridor.world"));
  EXPECT_THAT(ErrorAfter("lost_carried.yaml", "self_localisation: ../self_localisation.yaml",
                         "self_localisation: none"),
              HasSubstr("self_localisation"));
  EXPECT_THAT(ErrorAfter("lost_wet.yaml", "radius: 0.8", "radius: 0"), HasSubstr("radius"));
  EXPECT_THAT(ErrorAfter("lost_wet.yaml", "spin: 0.5", "slip: 0.5"), HasSubstr("spin"));
  EXPECT_THAT(ErrorAfter("lost_moved.yaml", "0.5]", "far]"), HasSubstr("moved[0].by"));
}

}  // namespace
}  // namespace hires::lab::experiment_config_test
