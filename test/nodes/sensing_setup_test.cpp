#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "hires/imagination/imagination_setup.h"
#include "hires/world/object_catalogue.h"
#include "nodes/middle_layer/middle_layer_params.h"
#include "nodes/world_tracker/world_tracker_params.h"
#include "support/restaurant_translation.h"
#include "support/temporary_folder.h"

// One block of the scene says how robot and objects are sensed, to all who ask.

namespace hires_ros::sensing_setup_test {
namespace {

const std::string kConfig = std::string(HIRES_SOURCE_DIR) + "/config/";

/// config/NAME with another scene; paths count from config still.
std::string WithScene(const std::string& name, const std::string& scene,
                      const hires::test_support::TemporaryFolder& folder) {
  YAML::Node root = YAML::LoadFile(kConfig + name);
  root["scene"] = scene;
  if (root["ontology"]) {
    for (YAML::Node file : root["ontology"]) file = kConfig + file.Scalar();
  }
  if (root["guard"]) root["guard"]["config"] = kConfig + root["guard"]["config"].Scalar();
  return folder.Write(name, YAML::Dump(root));
}

TEST(SensingSetupTest, TrackerMiddleLayerAndRolloutsRememberByTheSameNumbers) {
  const hires::test_support::TemporaryFolder folder;
  YAML::Node root = YAML::LoadFile(kConfig + "scene.yaml");
  for (const char* file : {"world", "robot", "objects", "obstacle_layer"}) {
    root[file] = kConfig + root[file].Scalar();
  }
  root["uncertainty"] = "none";
  root["detector"] = "none";
  for (auto entry : root["sensing"]["memory"]) {
    const bool is_count = entry.first.Scalar().find("s_to_") != std::string::npos;
    entry.second = is_count ? "5" : std::to_string(0.9 * entry.second.as<double>());
  }
  root["sensing"]["robot_state"]["stale_after"] = 0.25;
  const std::string scene = folder.Write("scene.yaml", YAML::Dump(root));

  const auto tracker = ReadWorldTrackerParams(WithScene("world_tracker.yaml", scene, folder));
  const auto layer = ReadMiddleLayerParams(WithScene("middle_layer.yaml", scene, folder));
  const auto setup = hires::imagination::LoadImaginationSetup(layer.setup);
  EXPECT_EQ(tracker.sensing.memory.looks_to_vanish, 5);
  EXPECT_EQ(tracker.sensing.robot_state.stale_after, 0.25);
  EXPECT_TRUE(tracker.sensing == layer.setup.sensing);
  EXPECT_TRUE(tracker.sensing == setup.sensing);
  EXPECT_TRUE(tracker.sensing.memory == setup.scene->memory) << "what rollouts play with";
  EXPECT_FALSE(tracker.sensing.memory == hires::sensing::MemoryParams());
}

TEST(WorldTrackerConfigTest, TheFilesThatThePackageComesWithAreRead) {
  EXPECT_NO_THROW(ReadWorldTrackerParams(HIRES_SOURCE_DIR "/config/world_tracker.yaml"));
  const auto models = hires::world::LoadCatalogueModels(HIRES_SOURCE_DIR "/worlds/objects.yaml");
  EXPECT_EQ(models.at("mug1")->concept_name, "Mug");
  for (const auto& [instance, model] : models) {
    if (model->concept_name.empty()) continue;
    EXPECT_NO_THROW(hires::test_support::RestaurantContext().ontology->Require(model->concept_name))
        << instance;
  }
  const auto translator = ReadTranslatorParams(HIRES_SOURCE_DIR "/config/translator.yaml");
  EXPECT_EQ(LoadTranslatorContext(translator).world->hash,
            hires::test_support::RestaurantContext().world->hash);
}

}  // namespace
}  // namespace hires_ros::sensing_setup_test
