#include "hires/translation/load_context.h"

#include <gtest/gtest.h>

#include "hires/base/error.h"
#include "support/restaurant_translation.h"

namespace hires::translation::load_context_test {
namespace {

const std::string kRoot = HIRES_SOURCE_DIR;

ContextFiles RestaurantFiles() {
  ContextFiles files;
  files.world = kRoot + "/worlds/restaurant.world";
  files.robot = kRoot + "/config/robots/pr2.yaml";
  files.objects = kRoot + "/worlds/objects.yaml";
  files.ontology = {kRoot + "/config/ontology/upper.ttl", kRoot + "/config/ontology/race.ttl"};
  files.standing.tilt = 0.3;
  return files;
}

TEST(LoadContextTest, TheFilesBecomeOneContext) {
  const TranslatorContext context = LoadContext(RestaurantFiles());
  const TranslatorContext& expected = test_support::RestaurantContext();
  EXPECT_EQ(context.world->hash, expected.world->hash);
  EXPECT_EQ(context.robot->profile.base_link, expected.robot->profile.base_link);
  EXPECT_EQ(context.object_models, expected.object_models);
  EXPECT_EQ(context.standing.tilt, 0.3);
  EXPECT_NO_THROW(context.ontology->Require("Mug"));
}

TEST(LoadContextTest, AFileThatIsMissingIsNamed) {
  ContextFiles files = RestaurantFiles();
  files.objects = kRoot + "/worlds/nothing.yaml";
  EXPECT_THROW(LoadContext(files), base::ConfigError);
}

}  // namespace
}  // namespace hires::translation::load_context_test
