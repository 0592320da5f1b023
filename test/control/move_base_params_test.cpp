#include "hires/control/move_base_params.h"

#include <gmock/gmock.h>

#include "hires/base/error.h"

namespace hires::control::move_base_params_test {
namespace {

using base::ConfigError;
using base::ParamReader;
using ::testing::HasSubstr;

constexpr char kGood[] =
    "{by: move_base, start_patience: 7, answer_patience: 3, max_rest: 0.4, max_rest_turn: 0.6}";

MoveBaseDriveParams Read(const std::string& text, std::optional<std::string> by = std::nullopt) {
  ParamReader in = ParamReader::FromString(text, "middle_layer.yaml");
  const MoveBaseDriveParams params = ReadNavigation(in, std::move(by));
  in.RejectUnknownKeys();
  return params;
}

template <typename Function>
std::string Complaint(Function function) {
  try {
    function();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no complaint";
}

TEST(NavigationParamsTest, EachKeyIsRead) {
  const MoveBaseDriveParams params = Read(kGood);
  EXPECT_TRUE(params.is_used);
  EXPECT_EQ(params.start_patience, 7.0);
  EXPECT_EQ(params.answer_patience, 3.0);
  EXPECT_EQ(params.max_rest, 0.4);
  EXPECT_EQ(params.max_rest_turn, 0.6);
}

TEST(NavigationParamsTest, TheParameterWinsOverTheFile) {
  EXPECT_FALSE(Read(kGood, "own").is_used);
  EXPECT_TRUE(Read(kGood, "move_base").is_used);
  EXPECT_THAT(Complaint([] { Read(kGood, "pr2_move_base"); }),
              HasSubstr("~navigation is 'pr2_move_base', wanted own or move_base"));
}

TEST(NavigationParamsTest, WhatMakesNoSenseIsNamed) {
  EXPECT_THAT(Complaint([] { Read("{by: nobody}"); }), HasSubstr("nobody"));
  EXPECT_THAT(Complaint([] { Read("{by: own}"); }), HasSubstr("start_patience"));
  EXPECT_THAT(Complaint([] {
                Read(
                    "{by: own, start_patience: 7, answer_patience: 3, max_rest: 20, "
                    "max_rest_turn: 0.6}");
              }),
              HasSubstr("max_rest is '20'"));
}

TEST(NavigationParamsTest, MoveBaseWantsItsNameAndAGuard) {
  MoveBaseDriveParams navigation;
  RobotNames names;
  EXPECT_NO_THROW(RequireMeansFor(navigation, names, false));
  navigation.is_used = true;
  EXPECT_THAT(Complaint([&] { RequireMeansFor(navigation, names, true); }),
              HasSubstr("move_base.action"));
  names.move_base.action = "move_base";
  EXPECT_NO_THROW(RequireMeansFor(navigation, names, true));
  EXPECT_THAT(Complaint([&] { RequireMeansFor(navigation, names, false); }), HasSubstr("~guard"));
}

}  // namespace
}  // namespace hires::control::move_base_params_test
