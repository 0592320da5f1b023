#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/command_run.h"
#include "hires/actions/catalogue.h"
#include "hires/base/text.h"
#include "hires/imagination/uncertainty.h"
#include "support/temporary_folder.h"

namespace hires::cli::list_command_test {
namespace {

using hires::test_support::Ended;
using hires::test_support::RunHires;
using hires::test_support::TemporaryFolder;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Ended List(const std::vector<std::string>& words) { return RunHires({"list"}, words); }

nlohmann::json Listed(std::vector<std::string> words) {
  words.insert(words.end(), {"--json", "-"});
  const Ended ended = List(words);
  EXPECT_EQ(ended.code, 0) << ended.err;
  return nlohmann::json::parse(ended.out);
}

nlohmann::json RowOf(const nlohmann::json& rows, const std::string& column,
                     const std::string& value) {
  for (const auto& row : rows) {
    if (row.at(column) == value) return row;
  }
  ADD_FAILURE() << "no " << column << " is " << value;
  return {};
}

std::vector<std::string> ColumnOf(const nlohmann::json& rows, const std::string& column) {
  std::vector<std::string> values;
  for (const auto& row : rows) values.push_back(row.at(column));
  return values;
}

TEST(ListCommandTest, AreasComeWithWhatTheyAreForAndWhereTheyAre) {
  const auto rows = Listed({"areas"});
  const auto row = RowOf(rows, "area", "preManipulationAreaNorthTable1");
  EXPECT_EQ(row["for"], "standing");
  EXPECT_EQ(row["frame"], "map");
  EXPECT_EQ(RowOf(rows, "area", "placingAreaWestLeftTable1")["for"], "placing");
  EXPECT_EQ(RowOf(rows, "area", "trayArea1")["for"], "tray");
  const auto workshop = Listed({"areas", "--world", HIRES_SOURCE_DIR "/worlds/workshop.world"});
  EXPECT_EQ(RowOf(workshop, "area", "atBench")["y"], 3.6);  // as the file says
  EXPECT_EQ(RowOf(workshop, "area", "atBench")["yaw"], 1.5708);
}

TEST(ListCommandTest, AreasOfAMapComeWithWhatItShowsThereAndItsExtent) {
  const TemporaryFolder folder;
  folder.Write("m.pgm", "P2 4 2 255 254 254 205 205 254 0 205 205\n");
  const std::string map = folder.Write(
      "m.yaml",
      "image: m.pgm\nresolution: 0.5\norigin: [1, 2, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
      "free_thresh: 0.196\n");
  const std::string goals = folder.Write("goals.yaml", "a: [1.2, 2.2, 0.5]\nb: [1.7, 2.2, 0]\n");
  const auto rows = Listed({"areas", "--map", map, "--area", goals, "--area", "c:2.7,2.7,0",
                            "--area", "d:9,9,0", "--robot", HIRES_SOURCE_DIR "/urdf/cart.urdf"});
  EXPECT_EQ(RowOf(rows, "area", "a")["on the map"], "free");
  EXPECT_EQ(RowOf(rows, "area", "b")["on the map"], "occupied");
  EXPECT_EQ(RowOf(rows, "area", "c")["on the map"], "unknown");
  EXPECT_EQ(RowOf(rows, "area", "d")["on the map"], "outside");
  EXPECT_EQ(RowOf(rows, "area", "(upper right corner)")["x"], 3.0);
  EXPECT_EQ(RowOf(rows, "area", "(lower left corner)")["y"], 2.0);
  EXPECT_THAT(List({"areas", "--map", map, "--world", "w.world"}).err, HasSubstr("excludes"));
}

TEST(ListCommandTest, QuantitiesComeWithWhatTheyAreAndHowTheyAreDrawn) {
  const auto drawn = [](const std::vector<std::string>& words, const std::string& quantity) {
    std::vector<std::string> all{"uncertainty"};
    all.insert(all.end(), words.begin(), words.end());
    return RowOf(Listed(all), "quantity", quantity)["drawn"];
  };
  const auto rows = Listed({"uncertainty"});
  EXPECT_EQ(ColumnOf(rows, "quantity"), imagination::QuantityNames());
  for (const std::string& words : ColumnOf(rows, "what it is")) EXPECT_FALSE(words.empty());
  EXPECT_EQ(RowOf(rows, "quantity", "scan_noise")["unit"], "m");
  EXPECT_EQ(drawn({}, "object_mass"), "0.8 .. 1.2");
  EXPECT_EQ(drawn({}, "localisation_x"), "normal 0, sd 0.03");
  const TemporaryFolder folder;
  const std::string over = folder.Write(
      "over.yaml", "object_mass: {distribution: fixed, value: 2, unit: factor, source: weighed}\n");
  EXPECT_EQ(drawn({"--uncertainty", over}, "object_mass"), "2");
  EXPECT_EQ(drawn({"--uncertainty", over}, "localisation_x"), "normal 0, sd 0.03") << "stays";
  EXPECT_EQ(drawn({"--uncertainty", "none"}, "object_mass"), "certain");
}

TEST(ListCommandTest, ObjectsComeWithMassAndSize) {
  const auto mill = RowOf(Listed({"objects"}), "object", "peppermill1");
  EXPECT_EQ(mill["model"], "peppermill_thesis");
  EXPECT_EQ(mill["mass"], 0.14);  // objects.md
  EXPECT_EQ(mill["height"], 0.274);
}

TEST(ListCommandTest, ObjectsOfOnesOwnWorldAreThere) {
  const TemporaryFolder folder;
  const std::string world = folder.Write("w.world", R"(<?xml version="1.0"?><sdf version="1.7">
    <world name="w"><model name="crate"><pose>1 0 0.1 0 0 0</pose><link name="l">
    <inertial><mass>2</mass><inertia><ixx>0.02</ixx><iyy>0.02</iyy><izz>0.02</izz></inertia>
    </inertial><collision name="c"><geometry><box><size>0.3 0.2 0.2</size></box></geometry>
    </collision></link></model></world></sdf>)");
  const auto crate = RowOf(Listed({"objects", "--world", world}), "object", "crate");
  EXPECT_EQ(crate["from"], "world");
  EXPECT_EQ(crate["mass"], 2.0);
  EXPECT_EQ(crate["depth"], 0.3);
}

TEST(ListCommandTest, ActionsAreThoseOfTheCatalogue) {
  const auto rows = Listed({"actions"});
  EXPECT_EQ(rows.size(), actions::OwnActions().specs().size());
  EXPECT_THAT(RowOf(rows, "action", "move_base_param")["arguments"],
              ElementsAre("area", "motion_set"));
}

TEST(ListCommandTest, MotionSetsAndPosturesAreTheRobots) {
  const auto sets = Listed({"motion_sets"});
  EXPECT_EQ(RowOf(sets, "motion set", "fast")["m/s"], 0.55);  // Table 5.1
  EXPECT_EQ(RowOf(sets, "motion set", "fast")["default"], true);
  const auto cart = Listed({"motion_sets", "--robot", HIRES_SOURCE_DIR "/config/robots/cart.yaml"});
  EXPECT_EQ(RowOf(cart, "motion set", "slow")["default"], true);
  EXPECT_THAT(ColumnOf(Listed({"postures"}), "posture"),
              AllOf(Contains("TorsoUpPosture"), Contains("ArmTuckedPosture")));
  EXPECT_EQ(RowOf(Listed({"postures"}), "posture", "ArmCarryPosture")["of"], "leftArm1");
  EXPECT_THAT(List({"postures", "--robot", HIRES_SOURCE_DIR "/config/robots/cart.yaml"}).out,
              HasSubstr("no postures"));
}

TEST(ListCommandTest, FilesOfThePackageAreFound) {
  const std::string robots = HIRES_SOURCE_DIR "/config/robots/",
                    worlds = HIRES_SOURCE_DIR "/worlds/";
  EXPECT_THAT(ColumnOf(Listed({"robots"}), "robot"),
              ElementsAre(robots + "car.yaml", robots + "cart.yaml", robots + "fetch.yaml",
                          robots + "pr2.yaml"));
  EXPECT_THAT(ColumnOf(Listed({"worlds"}), "world"),
              ElementsAre(worlds + "corridor.world", worlds + "restaurant.world",
                          worlds + "workshop.world"));
  EXPECT_THAT(ColumnOf(Listed({"scenarios"}), "scenario"),
              ElementsAre("coffee_spots", "hot_coffee", "serve_coffee", "topple"));
  EXPECT_THAT(ColumnOf(Listed({"truths"}), "truth"),
              ElementsAre("filter", "foreign", "harsh", "ideal", "same"));
}

TEST(ListCommandTest, WhatItListsIsTaken) {
  const std::string robot = Listed({"robots"}).front()["robot"];
  EXPECT_EQ(List({"motion_sets", "--robot", robot}).code, 0);
  const std::string world = Listed({"worlds"}).front()["world"];
  EXPECT_EQ(List({"areas", "--world", world}).code, 0);
}

TEST(ListCommandTest, NamesAreSpeltAsInTheRobotsFile) {
  const TemporaryFolder folder;
  const std::string robot =
      folder.Write("my.yaml", "urdf: " HIRES_SOURCE_DIR
                              "/urdf/cart.urdf\n"
                              "motion_sets:\n"
                              "  veryFast: {max_linear_velocity: 1.0, max_angular_velocity: 1.0,\n"
                              "    max_linear_acceleration: 1.0, max_angular_acceleration: 1.0}\n");
  EXPECT_THAT(ColumnOf(Listed({"motion_sets", "--robot", robot}), "motion set"),
              ElementsAre("veryFast"));
}

TEST(ListCommandTest, WholeTasksComeBeforeTheirParts) {
  const auto rows = Listed({"tasks"});
  EXPECT_THAT(RowOf(rows, "task", "serve_coffee_to_guest")["part of"], IsEmpty());
  EXPECT_THAT(RowOf(rows, "task", "load_tray")["part of"], Contains("carry_object_on_tray"));
  EXPECT_EQ(rows.front()["task"], "serve_coffee_to_guest");
  EXPECT_EQ(rows.front()["arguments"], "?guest");
}

TEST(ListCommandTest, ATableForPeopleAndAFileForMachines) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "areas.json").string();
  const Ended ended = List({"scenarios", "--json", path});
  EXPECT_THAT(ended.out, AllOf(HasSubstr("scenario"), HasSubstr("serve_coffee_to_guest guest1"),
                               Not(HasSubstr("{"))));
  EXPECT_EQ(nlohmann::json::parse(base::ReadTextFile(path)).size(), 4u);
}

TEST(ListCommandTest, WhatItCannotListIsRefused) {
  const auto expect = [](const std::vector<std::string>& words, const std::string& text) {
    const Ended ended = List(words);
    EXPECT_EQ(ended.code, kExitBadInput);
    EXPECT_EQ(ended.out, "");
    EXPECT_THAT(ended.err, HasSubstr(text));
  };
  expect({"area"}, "list 'area' is unknown; did you mean 'areas'");
  expect({}, "list: nothing came, wanted one of 'actions', 'areas', 'motion_sets', ");
  expect({"areas", "--world", "/nowhere.world"}, "/nowhere.world");
  expect({"tasks", "--domain", "/nowhere.lisp"}, "/nowhere.lisp: no such file");
  expect({"areas", "--json", "/nowhere/areas.json"}, "/nowhere");
}

}  // namespace
}  // namespace hires::cli::list_command_test
