#include "cli/verbs/limits/limits_command.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "cli/command_run.h"
#include "hires/base/text.h"
#include "support/temporary_folder.h"

namespace hires::cli::limits_command_test {
namespace {

using hires::test_support::Ended;
using hires::test_support::RunHires;
using hires::test_support::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Five truths, exactly nominal: quick.
Ended Limits(std::vector<std::string> words) {
  words.insert(words.end(), {"--max-fall", "0.5", "--uncertainty", "none"});
  return RunHires({"limits"}, words);
}

/// Standard output of its scope, as far as it was flushed.
class FlushedOutput : private std::stringbuf {
 public:
  FlushedOutput() : before_(std::cout.rdbuf(this)) {}
  ~FlushedOutput() override { std::cout.rdbuf(before_); }
  FlushedOutput(const FlushedOutput&) = delete;
  FlushedOutput& operator=(const FlushedOutput&) = delete;
  const std::string& text() const { return text_; }

 private:
  int sync() override {
    text_ = str();
    return 0;
  }
  std::streambuf* before_;
  std::string text_;
};

TEST(LimitsCommandTest, ClosedFormsAreShownBeforeTheFirstDrive) {
  LimitsOptions options;
  options.payloads = {"peppermill1"};
  options.threads = 1;
  options.quiet = true;
  const FlushedOutput output;
  std::optional<std::string> shown;  // when the first drive is about to begin
  const auto cancelled = [&] {
    if (!shown) shown = output.text();
    return true;
  };
  EXPECT_EQ(RunLimitsVerb(options, HIRES_SOURCE_DIR, cancelled), kExitCancelled);
  ASSERT_TRUE(shown);
  EXPECT_THAT(*shown, AllOf(HasSubstr("speed                       0.370 m/s"),
                            HasSubstr("acceleration              2.646 m/s^2"),
                            HasSubstr("deceleration              2.646 m/s^2"),
                            HasSubstr("turning                   1.322 rad/s"),
                            Not(HasSubstr("simulated"))));
}

TEST(LimitsCommandTest, PrintsATableAndWhatMoveBaseTakes) {
  const TemporaryFolder folder;
  const std::string json = (folder.path() / "limits.json").string(),
                    yaml = (folder.path() / "dwa.yaml").string();
  const Ended ended = Limits({"--object", "peppermill1", "--json", json, "--yaml", yaml});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out,
              AllOf(HasSubstr("speed"), HasSubstr("2.646 m/s^2"), HasSubstr("robot's own"),
                    HasSubstr("DWAPlannerROS:"), HasSubstr("none of 5 simulated truths")));
  const auto numbers = nlohmann::json::parse(base::ReadTextFile(json));
  EXPECT_EQ(numbers["object"], "peppermill1");
  EXPECT_EQ(numbers["uncertainty"], "none");
  EXPECT_EQ(numbers["limits"].size(), 5u);
  EXPECT_THAT(ended.out, HasSubstr(base::ReadTextFile(yaml)));
}

TEST(LimitsCommandTest, TakesAThingThatAYamlFileDescribes) {
  const TemporaryFolder folder;
  const std::string file = folder.Write(
      "my_bottle.yaml", "{shape: cylinder, radius: 0.04, height: 0.2, mass: 0.5, friction: 0.2}");
  const Ended ended =
      Limits({"--object", file, "--robot", HIRES_SOURCE_DIR "/config/robots/cart.yaml"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, AllOf(HasSubstr("1.960 m/s^2  2.000 m/s^2  slides"),
                               HasSubstr("# my_bottle on the tray of cart")));
}

TEST(LimitsCommandTest, AFileOfThisFolderIsTaken) {
  const TemporaryFolder folder;
  folder.Write("my_bottle.yaml", "{shape: cylinder, radius: 0.04, height: 0.2, mass: 0.5}");
  folder.Write("coffee_cup.yaml", "{shape: cylinder, radius: 0.04, height: 0.2, mass: 0.5}");
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  const Ended ended =
      Limits({"--object", "my_bottle.yaml", "--robot", HIRES_SOURCE_DIR "/urdf/cart.urdf"});
  const Ended taken = Limits({"--object", "coffee_cup.yaml"});
  std::filesystem::current_path(before);
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("ASSUMED"));  // a URDF says nothing of the controller
  EXPECT_THAT(taken.err, AllOf(HasSubstr("coffee_cup.yaml"), HasSubstr("rename it")));
}

/// A box with a tray of 0.5 x 0.5 m, and a scanner of that radius on its middle.
std::string Waiter(double radius) {
  return fmt::format(
      "<robot name='waiter'><link name='base'><collision><origin xyz='0 0 0.25'/><geometry><box "
      "size='0.5 0.5 0.48'/></geometry></collision></link><link name='tray'><collision><geometry>"
      "<box size='0.5 0.5 0.02'/></geometry></collision></link><joint name='t' "
      "type='fixed'><origin "
      "xyz='0 0 0.5'/><parent link='base'/><child link='tray'/></joint><link name='lidar'>"
      "<collision><geometry><cylinder radius='{}' length='0.06'/></geometry></collision></link>"
      "<joint name='l' type='fixed'><origin xyz='0 0 0.04'/><parent link='tray'/><child "
      "link='lidar'/></joint></robot>",
      radius);
}

TEST(LimitsCommandTest, ATrayWhoseMiddleIsTakenCarriesBesideIt) {
  const TemporaryFolder folder;
  folder.Write("waiter.urdf", Waiter(0.06));
  const std::string json = (folder.path() / "limits.json").string(),
                    bare = (folder.path() / "waiter.urdf").string(),
                    profile = folder.Write("bare.yaml", "urdf: waiter.urdf\n");
  for (const std::string& robot : {bare, profile}) {
    const Ended ended = Limits({"--object", "coffee_cup", "--robot", robot, "--json", json});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out,
                AllOf(HasSubstr("as 'lidar' takes the middle"), HasSubstr("robot's own, ASSUMED"),
                      HasSubstr("left out: "), HasSubstr("# The base's controller is ASSUMED")));
    const auto numbers = nlohmann::json::parse(base::ReadTextFile(json));
    EXPECT_EQ(numbers["controller_assumed"], true);
    EXPECT_EQ(numbers["left_out"].size(), 3u);
    EXPECT_FALSE(numbers["assumed"].empty());
  }
  folder.Write("waiter.urdf", Waiter(0.4));
  EXPECT_THAT(
      Limits({"--object", "coffee_cup", "--robot", bare}).err,
      AllOf(HasSubstr("deep in 'lidar'"), HasSubstr("object_on_tray"), HasSubstr("m of 'tray'")));
}

TEST(LimitsCommandTest, BadObjectsAreNamedAndTheOthersAnswered) {
  const TemporaryFolder folder;
  const std::string bad = folder.Write("bad.yaml", "{shape: cylinder, radius: -1, height: 0.2}");
  const Ended ended = Limits({"--object", "peppermill1", "--object", "pepermil", "--object", bad,
                              "--object", "PEPPERMILL1"});
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.err,
              AllOf(HasSubstr("pepermil"), HasSubstr("bad.yaml"), HasSubstr("named twice")));
  EXPECT_THAT(ended.out, HasSubstr("At each limit peppermill1 falls in none"));
}

TEST(LimitsCommandTest, GivenLimitsAreAnsweredAsTableAndCsv) {
  const TemporaryFolder folder;
  const std::string given = folder.Write(
      "dwa.yaml",
      "DWAPlannerROS: {max_vel_trans: 0.1, acc_lim_x: 1.0, acc_lim_y: 1.0, sim_time: 2}");
  const std::string csv = (folder.path() / "given.csv").string();
  const Ended ended = Limits({"--object", "peppermill1", "--object", "coffee_cup1", "--given",
                              given, "--csv", csv, "--max-slide", "0.05"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_THAT(ended.out, AllOf(HasSubstr("used: DWAPlannerROS: max_vel_trans, acc_lim_x"),
                               HasSubstr("not used: DWAPlannerROS: sim_time"),
                               HasSubstr("more than 0.05 m is a failure"), HasSubstr("yes")));
  EXPECT_THAT(base::ReadTextFile(csv),
              AllOf(HasSubstr("object,motion,unit,limit,source,closed_form,slide_m,falls"),
                    HasSubstr("peppermill1,speed,m/s,0.1,given"),
                    HasSubstr("coffee_cup1,turning,rad/s,2,robot's own")));
  EXPECT_EQ(Limits({"--object", "peppermill1", "--csv", csv}).code, 1);
}

TEST(LimitsCommandTest, BadInputIsToldBeforeAnythingIsPlayed) {
  EXPECT_THAT(Limits({"--object", "pepermill1"}).err, HasSubstr("peppermill1"));
  EXPECT_THAT(Limits({"--object", "none.yaml"}).err, HasSubstr("none.yaml"));
  EXPECT_THAT(Limits({"--object", "peppermill1", "--json", "/no/folder/a.json"}).err,
              HasSubstr("/no/folder"));
  EXPECT_EQ(Limits({}).code, 1);
  EXPECT_EQ(RunHires({"limits"}, {"--object", "peppermill1", "--max-fall", "0"}).code, 1);
}

}  // namespace
}  // namespace hires::cli::limits_command_test
