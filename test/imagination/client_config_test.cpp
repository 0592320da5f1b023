#include "hires/imagination/client_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <fstream>

#include "support/messages.h"
#include "support/temporary_folder.h"

namespace hires::imagination::client_config_test {
namespace {

using hires::test_support::ConfigErrorOf;
using hires::test_support::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;

YAML::Node Configured() {
  const std::string folder = std::string(HIRES_SOURCE_DIR) + "/config/";
  YAML::Node root = YAML::LoadFile(folder + "imagination_client.yaml");
  for (const char* file : {"prices", "validated"}) root[file] = folder + file + ".yaml";
  return root;
}

std::string WhyRefused(const YAML::Node& root) {
  const TemporaryFolder folder;
  const std::string path = folder.Write("client.yaml", YAML::Dump(root));
  return ConfigErrorOf([&] { ReadClientConfig(path); });
}

TEST(ClientConfigTest, ReadsTheConfiguredFile) {
  const TemporaryFolder folder;
  YAML::Node root = Configured();
  root["scene"] = "other/scene.yaml";
  root["feedback_period"] = 0.7;
  root["kept_rollouts"] = 12;
  root["worker_timeout"] = 3.5;
  root["scheduler"]["rollouts"] = 24;
  const ClientConfig config = ReadClientConfig(folder.Write("client.yaml", YAML::Dump(root)));
  EXPECT_EQ(config.scene, (folder.path() / "other/scene.yaml").string());
  EXPECT_EQ(config.feedback_period, 0.7);
  EXPECT_EQ(config.kept_rollouts, 12);
  EXPECT_EQ(config.worker_timeout, 3.5);
  EXPECT_EQ(config.scheduler.rollouts, 24);
  EXPECT_EQ(config.scheduler.criteria.min_success, 0.5);
  EXPECT_EQ(config.scheduler.criteria.rule, RankingRule::kCost);
  EXPECT_FALSE(config.scheduler.criteria.prices.empty());
  EXPECT_FALSE(config.validated.objects.empty());
}

TEST(ClientConfigTest, PricesThatAreNotNamedAreThoseOfTheSceneElseThoseBeside) {
  const TemporaryFolder folder;
  YAML::Node root = Configured();
  root.remove("prices");
  root["scene"] = std::string(HIRES_SOURCE_DIR) + "/config/scene.yaml";
  const auto price = [&] {
    const ClientConfig config = ReadClientConfig(folder.Write("client.yaml", YAML::Dump(root)));
    return config.scheduler.criteria.prices.of.at(base::FailureCode::kObjectFell);
  };
  EXPECT_EQ(price(), 600.0);
  YAML::Node own = YAML::LoadFile(std::string(HIRES_SOURCE_DIR) + "/config/prices.yaml");
  own["object_fell"] = 7.0;
  folder.Write("prices.yaml", YAML::Dump(own));
  EXPECT_EQ(price(), 600.0);
  root["scene"] = "scene.yaml";
  EXPECT_EQ(price(), 7.0);
  root["prices"] = std::string(HIRES_SOURCE_DIR) + "/config/prices.yaml";
  EXPECT_EQ(price(), 600.0) << "a file that names its prices keeps them";
}

TEST(ClientConfigTest, WithoutAnyPricesTheMissingFileIsNamed) {
  YAML::Node root = Configured();
  root.remove("prices");
  EXPECT_THAT(WhyRefused(root), AllOf(HasSubstr("prices.yaml"), HasSubstr("no such file")));
}

TEST(ClientConfigTest, EveryKeyIsNeeded) {
  for (const char* key :
       {"scene", "scheduler", "validated", "kept_rollouts", "feedback_period", "worker_timeout"}) {
    YAML::Node root = Configured();
    root.remove(key);
    EXPECT_THAT(WhyRefused(root),
                AllOf(HasSubstr("client.yaml"), HasSubstr(std::string(key) + " is missing")));
  }
}

TEST(ClientConfigTest, RefusesTyposAndWhatMakesNoSense) {
  YAML::Node typo = Configured();
  typo["feedback_perod"] = 0.2;
  EXPECT_THAT(WhyRefused(typo), AllOf(HasSubstr("key 'feedback_perod' is unknown"),
                                      HasSubstr("did you mean 'feedback_period'")));
  YAML::Node never = Configured();
  never["worker_timeout"] = -1;
  EXPECT_THAT(WhyRefused(never), HasSubstr("worker_timeout is '-1'"));
  YAML::Node none = Configured();
  none["scheduler"]["rollouts"] = 0;
  EXPECT_THAT(WhyRefused(none), HasSubstr("scheduler.rollouts is '0'"));
  YAML::Node rule = Configured();
  rule["scheduler"]["ranking"] = "hope";
  EXPECT_THAT(WhyRefused(rule), HasSubstr("hope"));
  YAML::Node certain = Configured();
  certain["scheduler"]["min_success"] = 1.0;
  EXPECT_THAT(WhyRefused(certain), HasSubstr("scheduler.min_success is '1'"));
}

TEST(ClientConfigTest, NamesAMissingFile) {
  EXPECT_THAT(ConfigErrorOf([] { ReadClientConfig("/nowhere/client.yaml"); }),
              HasSubstr("/nowhere/client.yaml: no such file"));
}

}  // namespace
}  // namespace hires::imagination::client_config_test
