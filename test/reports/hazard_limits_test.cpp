#include <gmock/gmock.h>

#include "reports/limits/motion_limits.h"

namespace hires::reports::hazard_limits_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

imagination::ImaginationSetup ReadSetup() {
  return imagination::LoadImaginationSetup(
      imagination::ReadSetupConfig(HIRES_SOURCE_DIR "/config/scene.yaml"));
}

const MotionBounds* Find(const HazardLimits& hazards, const std::string& name) {
  for (const MotionBounds& limit : hazards.bounds)
    if (limit.motion == name) return &limit;
  return nullptr;
}

TEST(HazardLimitsTest, Pr2BearsMoreThanItsOwnAcceleration) {
  const HazardLimits hazards = FindHazardLimits({"peppermill1"}, ReadSetup());
  for (const char* name : {"robot tips, acceleration", "robot tips, deceleration"}) {
    const MotionBounds* limit = Find(hazards, name);
    ASSERT_NE(limit, nullptr);
    EXPECT_GT(limit->closed_form, limit->robots_own);
    EXPECT_LT(limit->closed_form, 9.81);
  }
  ASSERT_NE(Find(hazards, "robot tips, turning"), nullptr);
  EXPECT_THAT(hazards.left_out, testing::IsEmpty()) << "a pepper mill holds no liquid";
  EXPECT_EQ(hazards.MostAcceleration(), Find(hazards, "robot tips, acceleration")->closed_form);
}

TEST(HazardLimitsTest, LiquidHasARowAndAVesselWithoutOneANote) {
  imagination::ImaginationSetup setup = ReadSetup();
  EXPECT_THAT(FindHazardLimits({"mug1"}, setup).left_out, testing::ElementsAre("liquids that slosh"));
  simulation::Scene scene = *setup.scene;
  world::ObjectModel mug = *scene.world.RequireModel(setup.ModelOf("mug1"));
  mug.liquid = world::Liquid{0.036, 0.077, 0.085};
  scene.world = world::WithModel(scene.world, mug);
  setup.scene = std::make_shared<const simulation::Scene>(scene);
  const HazardLimits hazards = FindHazardLimits({"mug1"}, setup);
  EXPECT_THAT(hazards.left_out, testing::IsEmpty());
  const MotionBounds* limit = Find(hazards, "liquid reaches rim");
  ASSERT_NE(limit, nullptr);
  EXPECT_NEAR(limit->closed_form, setup.scene->world.gravity * 0.008 / (2.0 * 0.036), 1e-9);
  EXPECT_EQ(hazards.MostAcceleration(), limit->closed_form);
  EXPECT_THAT(ClosedFormText({{}, {}, hazards.bounds}, false),
              AllOf(HasSubstr("liquid reaches rim"), HasSubstr("1.088 m/s^2"),
                    HasSubstr("robot tips, turning")));
}

}  // namespace
}  // namespace hires::reports::hazard_limits_test
