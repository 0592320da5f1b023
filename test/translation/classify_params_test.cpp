#include "hires/translation/classify_params.h"

#include <gmock/gmock.h>

#include "hires/base/error.h"
#include "hires/base/param_reader.h"
#include "hires/translation/classification.h"
#include "support/restaurant_translation.h"

namespace hires::translation::classify_params_test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

ClassifyParams Shipped() {
  return ReadClassifyParams(
      base::ParamReader::FromFile(HIRES_SOURCE_DIR "/config/scene.yaml").Sub("classify"));
}

TEST(ClassifyParamsTest, WhatHoldsWhereIsOneLineOfTheScene) {
  TranslatorContext context = test_support::RestaurantContext();
  GeometricState state;
  state.robot.X_MB = {12.5, 12.1, 3.14};  // 0.3 m from the area
  state.robot.joints = context.robot->profile.joints;
  context.classify = Shipped();
  EXPECT_THAT(test_support::Texts(AtomsOf(context, state)),
              Not(Contains("RobotAt(nearstartarea1)")));
  context.classify.area_distance = 0.35;
  EXPECT_THAT(test_support::Texts(AtomsOf(context, state)), Contains("RobotAt(nearstartarea1)"));
}

TEST(ClassifyParamsTest, ANumberThatMakesNoSenseIsNamed) {
  base::ParamReader in =
      base::ParamReader::FromString("classify: {area_distance: -1.0}", "scene.yaml");
  try {
    ReadClassifyParams(in.Sub("classify"));
    FAIL() << "nothing was wrong";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("scene.yaml"));
    EXPECT_THAT(error.what(), HasSubstr("classify.area_distance"));
  }
}

}  // namespace
}  // namespace hires::translation::classify_params_test
