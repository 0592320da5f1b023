#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "lab/src/decision/decision.h"
#include "lab/src/experiment/experiment.h"
#include "lab/src/experiment/hypothesis.h"
#include "lab/src/publish/publish_catalogue.h"
#include "lab/src/reproduce/catalogue.h"
#include "lab/src/series/scenario_series.h"

namespace hires::lab::configuration_files_test {
namespace {

namespace fs = std::filesystem;

using Reader = std::function<void(const std::string&)>;

/// By path below lab/config/; folders stand for all files in them.
const std::map<std::string, Reader>& Readers() {
  static const std::map<std::string, Reader> readers{
      {"decision.yaml", [](const std::string& path) { ReadDecisionConfig(path); }},
      {"faults.txt", [](const std::string&) {}},  // lab/scripts/faults reads it: faults_test.py
      {"publish.yaml", [](const std::string& path) { ReadPublishCatalogue(path); }},
      {"reproduce.yaml", [](const std::string& path) { ReadCatalogue(path); }},
      {"series", [](const std::string& path) { ReadScenarioSeries(path); }},
      {"experiments",
       [](const std::string& path) {
         ExperimentOverrides overrides;
         overrides.map = "given.yaml";  // some want one; it is opened when it is played
         ReadExperiment(path, overrides);
       }},
      {"hypothesis.yaml", [](const std::string& path) {
         for (const char* scenario : {"topple", "serve_coffee"}) ReadHypothesisGoal(path, scenario);
       }}};
  return readers;
}

TEST(LabConfigurationFilesTest, EveryFileIsRead) {
  const fs::path root = HIRES_SOURCE_DIR "/lab/config";
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (!entry.is_regular_file()) continue;
    const fs::path name = fs::relative(entry.path(), root);
    const auto reader = Readers().find(name.begin()->string());
    ASSERT_NE(reader, Readers().end()) << name << " is read by nobody";
    EXPECT_NO_THROW(reader->second(entry.path().string())) << name;
  }
}

}  // namespace
}  // namespace hires::lab::configuration_files_test
