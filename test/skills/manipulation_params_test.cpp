#include "hires/skills/manipulation_params.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hires/base/text.h"
#include "support/messages.h"

namespace hires::skills::manipulation_params_test {
namespace {

using hires::test_support::ConfigErrorOf;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string SceneText() {
  return base::ReadTextFile(std::string(HIRES_SOURCE_DIR) + "/config/scene.yaml");
}

ManipulationParams Read(const std::string& text) {
  base::ParamReader in = base::ParamReader::FromString(text, "scene.yaml");
  base::ParamReader section = in.Sub("manipulation");
  const ManipulationParams params = ReadManipulationParams(section);
  section.RejectUnknownKeys();
  return params;
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ManipulationParamsTest, TheFilesNumbersAreTheDefaults) {
  const ManipulationParams read = Read(SceneText()), defaults;
  EXPECT_EQ(read.period, defaults.period);
  EXPECT_EQ(read.seed, defaults.seed);
  EXPECT_EQ(read.straight_speed, defaults.straight_speed);
  EXPECT_EQ(read.goal.arm_tolerance, defaults.goal.arm_tolerance);
  EXPECT_EQ(read.goal.torso_tolerance, defaults.goal.torso_tolerance);
  EXPECT_EQ(read.gripper.min_held_gap, defaults.gripper.min_held_gap);
  EXPECT_EQ(read.look.sightings, defaults.look.sightings);
  EXPECT_EQ(read.pick.max_grasps, defaults.pick.max_grasps);
  EXPECT_EQ(read.place.area_edge, defaults.place.area_edge);
  EXPECT_EQ(read.place.clearance, defaults.place.clearance);
  EXPECT_EQ(read.path.max_iterations, defaults.path.max_iterations);
  EXPECT_EQ(read.path.max_held_tilt, defaults.path.max_held_tilt);
  EXPECT_EQ(read.inverse.max_tries, defaults.inverse.max_tries);
  EXPECT_EQ(read.collision.padding, defaults.collision.padding);
}

TEST(ManipulationParamsTest, NumbersOutOfRangeAreRefusedByName) {
  EXPECT_THAT(ConfigErrorOf(
                  [] { Read(Replaced(SceneText(), "arm_tolerance: 0.02", "arm_tolerance: -1")); }),
              AllOf(HasSubstr("scene.yaml"), HasSubstr("manipulation.goal.arm_tolerance"),
                    HasSubstr("-1"), HasSubstr("between")));
  EXPECT_THAT(ConfigErrorOf([] { Read(Replaced(SceneText(), "max_grasps: 24", "max_grasps: 0")); }),
              HasSubstr("manipulation.pick.max_grasps"));
  EXPECT_THAT(ConfigErrorOf([] { Read(Replaced(SceneText(), "padding: 0.01", "padding: a lot")); }),
              AllOf(HasSubstr("manipulation.collision.padding"), HasSubstr("a lot")));
}

TEST(ManipulationParamsTest, MissingAndMisspelledKeysAreRefused) {
  EXPECT_THAT(
      ConfigErrorOf([] { Read(Replaced(SceneText(), "    sightings: 6", "    sightigns: 6")); }),
      HasSubstr("sightings"));
  EXPECT_THAT(ConfigErrorOf([] {
                Read(Replaced(SceneText(), "    dwell: 0.5", "    dwell: 0.5\n    nod: 1"));
              }),
              HasSubstr("nod"));
}

}  // namespace
}  // namespace hires::skills::manipulation_params_test
