// Every file in config/ is read by the reader that a program uses for it.

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include "hires/execution/monitor_config.h"
#include "hires/imagination/client_config.h"
#include "hires/imagination/imagination_setup.h"
#include "hires/imagination/prices.h"
#include "hires/imagination/validated.h"
#include "hires/knowledge/blackboard_config.h"
#include "hires/knowledge/fluent_yaml.h"
#include "hires/knowledge/loading.h"
#include "hires/knowledge/store.h"
#include "hires/localisation/monte_carlo_params.h"
#include "hires/localisation/odometry_filter.h"
#include "hires/mapping/mapping_config.h"
#include "hires/navigation/base_guard.h"
#include "hires/perception/recogniser_config.h"
#include "hires/perception/warm_objects.h"
#include "hires/planning/operator_data.h"
#include "hires/planning/planner_config.h"
#include "hires/planning/planning_files.h"
#include "hires/relay/relay_params.h"
#include "hires/robot/robot_profile.h"
#include "hires/simulation/pose_error.h"
#include "hires/simulation/self_localisation.h"
#include "hires/world/object_catalogue.h"
#include "reports/episode/episode_topics.h"
#include "reports/experience/load_follower.h"
#include "sim_robot/scenario.h"
#include "sim_robot/truth.h"

namespace hires::configuration_files_test {
namespace {

namespace fs = std::filesystem;

const fs::path& Root() {
  static const fs::path root = HIRES_SOURCE_DIR;
  return root;
}

using Reader = std::function<void(const std::string&)>;

/// By path below config/; folders stand for all files in them.
const std::map<std::string, Reader>& Readers() {
  static const std::map<std::string, Reader> readers{
      {"imagination_client.yaml",
       [](const std::string& path) { imagination::ReadClientConfig(path); }},
      {"scene.yaml", [](const std::string& path) { imagination::ReadSetupConfig(path); }},
      {"prices.yaml",
       [](const std::string& path) { imagination::ReadPrices(base::ParamReader::FromFile(path)); }},
      {"validated.yaml",
       [](const std::string& path) {
         imagination::ReadValidated(base::ParamReader::FromFile(path));
       }},
      {"truths", [](const std::string& path) { sim_robot::ReadTruth(path); }},
      {"uncertainty.yaml", [](const std::string& path) { imagination::LoadUncertainty(path); }},
      {"detector.yaml", [](const std::string& path) { perception::ReadDetectorErrors(path); }},
      {"planner.yaml",
       [](const std::string& path) {
         planning::LoadPlanningKnowledge(planning::ReadPlannerConfig(path));
       }},
      {"blackboard.yaml", [](const std::string& path) { knowledge::ReadBlackboardConfig(path); }},
      {"execution_monitor.yaml",
       [](const std::string& path) {
         const auto config = execution::ReadMonitorConfig(path);
         const auto domain = planning::LoadDomain(config.domain);
         planning::LoadOperatorData(config.operators, domain);
         knowledge::Ontology::FromFiles(config.ontology);
       }},
      {"base_guard.yaml", [](const std::string& path) { navigation::ReadBaseGuardParams(path); }},
      {"scenarios", [](const std::string& path) { sim_robot::ReadScenario(path); }},
      {"episode.yaml", [](const std::string& path) { reports::ReadEpisodeConfig(path); }},
      {"recogniser.yaml", [](const std::string& path) { perception::ReadRecogniserConfig(path); }},
      {"heat_reader.yaml",
       [](const std::string& path) {
         perception::ReadWarmParams(base::ParamReader::FromFile(path));
       }},
      {"topple_monitor.yaml",
       [](const std::string& path) {
         reports::ReadToppleMonitorConfig(base::ParamReader::FromFile(path));
       }},
      {"localisation.yaml",
       [](const std::string& path) {
         localisation::ReadLocalisationConfig(base::ParamReader::FromFile(path));
       }},
      {"mapping.yaml",
       [](const std::string& path) {
         mapping::ReadMappingConfig(base::ParamReader::FromFile(path));
       }},
      {"odometry_filter.yaml",
       [](const std::string& path) {
         localisation::ReadOdometryFilterConfig(base::ParamReader::FromFile(path));
       }},
      {"robots", [](const std::string& path) { robot::LoadRobot(path); }},
      {"self_localisation.yaml",
       [](const std::string& path) { simulation::LoadSelfLocalisation(path); }},
      {"localisation_error.yaml", [](const std::string& path) { simulation::ReadPoseError(path); }},
      {"obstacle_layer.yaml",
       [](const std::string& path) {
         imagination::SetupConfig config;
         imagination::SetObstacleLayer(path, &config);
       }},
      {"relay.yaml",
       [](const std::string& path) {
         relay::ReadRelayParams(base::ParamReader::FromFile(path),
                                {"http://127.0.0.1:11412/", "/worker_1"});
       }},
  };
  return readers;
}

/// Read where the layer that knows them is tested, by their path below config/.
const std::set<std::string> kReadElsewhere{
    "domains",            // with execution_monitor.yaml here
    "knowledge",          // with blackboard.yaml here, and test/knowledge
    "loop.yaml",          // test/loop
    "middle_layer.yaml",  // test/ros, by their nodes, as all below
    "names",
    "sim_robot.yaml",
    "sim_worker.yaml",
    "translator.yaml",
    "worker_host.yaml",
    "world_tracker.yaml"};

/// The key of Readers() for a file.
std::string KindOf(const fs::path& file) {
  const fs::path relative = file.lexically_relative(Root() / "config");
  // What a robot calls its topics is read, and tested, where topics are known.
  if (file.stem().string().find("_names") != std::string::npos) return "names";
  return relative.begin()->string();
}

TEST(ConfigurationFilesTest, EachOneLoads) {
  std::set<std::string> read;
  for (const auto& entry : fs::recursive_directory_iterator(Root() / "config")) {
    const std::string kind = KindOf(entry.path());
    const bool is_yaml = entry.is_regular_file() && entry.path().extension() == ".yaml";
    if (!is_yaml || kReadElsewhere.count(kind) > 0) continue;
    const auto reader = Readers().find(kind);
    ASSERT_NE(reader, Readers().end()) << entry.path() << " is read by no test; add its reader";
    EXPECT_NO_THROW(reader->second(entry.path().string())) << entry.path();
    read.insert(kind);
  }
  EXPECT_EQ(read.size(), Readers().size());
}

TEST(ConfigurationFilesTest, TheBlackboardsFilesFitTogether) {
  const auto config = knowledge::ReadBlackboardConfig((Root() / "config/blackboard.yaml").string());
  knowledge::Store store(":memory:", std::make_shared<const knowledge::Ontology>(
                                         knowledge::Ontology::FromFiles(config.ontology)));
  for (const std::string& path : config.knowledge) {
    const auto summary = knowledge::Load(knowledge::LoadKnowledge(path), base::Rng(1),
                                         {knowledge::Source::kKnowledge, 0, 0.0}, &store);
    EXPECT_FALSE(summary.concepts.empty()) << path;
  }
  for (const std::string& path : config.topics) {
    EXPECT_FALSE(knowledge::LoadKnowledge(path).topics.empty()) << path;
  }
}

TEST(ConfigurationFilesTest, TheClientsSceneIsComplete) {
  const auto client =
      imagination::ReadClientConfig((Root() / "config/imagination_client.yaml").string());
  const auto setup = imagination::LoadImaginationSetup(imagination::ReadSetupConfig(client.scene));
  EXPECT_FALSE(setup.scene->world.frames.empty());
  EXPECT_FALSE(setup.object_models.empty());
  EXPECT_FALSE(setup.scene->robot.profile.tray_link.empty());
}

TEST(ConfigurationFilesTest, NothingTouchesAtTheAreasWhereTheRobotWaits) {
  const auto setup = imagination::LoadImaginationSetup(
      imagination::ReadSetupConfig((Root() / "config/scene.yaml").string()));
  int count = 0;
  for (const auto& [name, X_MF] : setup.scene->world.frames) {
    if (name.rfind("premanipulationarea", 0) != 0 && name != "home") continue;
    const auto start = imagination::MakeStartState(setup, name, {"peppermill1"});
    EXPECT_NO_THROW(imagination::CheckSetup(imagination::MakeRolloutSetup(setup, start, 1),
                                            {"move_base", {name}}))
        << name;
    ++count;
  }
  EXPECT_GE(count, 6);
}

}  // namespace
}  // namespace hires::configuration_files_test
