#include "hires/sensing/sensing_params.h"

#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include "hires/base/param_reader.h"
#include "support/messages.h"

namespace hires::sensing::sensing_params_test {
namespace {

using test_support::ConfigErrorOf;
using testing::HasSubstr;

YAML::Node Configured() { return YAML::LoadFile(HIRES_SOURCE_DIR "/config/scene.yaml")["sensing"]; }

SensingParams Read(const YAML::Node& node) {
  auto in = base::ParamReader::FromString(YAML::Dump(node), "scene.yaml");
  const SensingParams params = ReadSensingParams(in);
  return params;
}

TEST(SensingParamsTest, WhatIsConfiguredIsWhatTestsWithoutAFileHave) {
  EXPECT_TRUE(Read(Configured()) == SensingParams());
}

TEST(SensingParamsTest, EachNumberMattersAndIsNamedWhenItIsBad) {
  int count = 0;
  for (const char* block : {"robot_state", "memory", "ground"}) {
    for (const auto& entry : Configured()[block]) {
      const std::string key = entry.first.Scalar();
      if (key == "enabled" || key == "eye") continue;
      YAML::Node changed = Configured();
      const bool is_whole = entry.second.Scalar().find('.') == std::string::npos;
      changed[block][key] = is_whole ? "7" : std::to_string(0.99 * entry.second.as<double>());
      EXPECT_FALSE(Read(changed) == SensingParams()) << key;
      changed[block][key] = "-1";
      EXPECT_THAT(ConfigErrorOf([&] { Read(changed); }), HasSubstr(std::string(block) + "." + key));
      ++count;
    }
  }
  EXPECT_EQ(count, 38);
}

}  // namespace
}  // namespace hires::sensing::sensing_params_test
