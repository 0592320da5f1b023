#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/world/occupancy_grid.h"
#include "support/log_catcher.h"
#include "support/rounds.h"
#include "world/temp_folder.h"

namespace hires::world::map_file_test {
namespace {

using test_support::Rounds;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

const char kYaml[] =
    "image: m.pgm\nresolution: 0.1\norigin: [1.0, 2.0, 0.0]\nnegate: 0\n"
    "occupied_thresh: 0.65\nfree_thresh: 0.196\n";

class MapFileTest : public testing::Test {
 protected:
  MapFileTest() { folder_.Write("m.pgm", "P2 2 2 255 254 0 205 254\n"); }
  OccupancyGrid Load(const std::string& yaml) const {
    return LoadMap(folder_.Write("m.yaml", yaml));
  }
  std::string ErrorWith(const std::string& what, const std::string& by) const {
    std::string yaml = kYaml;
    yaml.replace(yaml.find(what), what.size(), by);
    return MessageOf<base::ConfigError>([&] { Load(yaml); });
  }
  TempFolder folder_;
};

TEST_F(MapFileTest, FirstRowOfTheImageIsTheUppermostOfTheGrid) {
  const OccupancyGrid grid = Load(kYaml);
  EXPECT_EQ(grid.width, 2);
  EXPECT_EQ(grid.height, 2);
  EXPECT_EQ(grid.resolution, 0.1);
  EXPECT_EQ(grid.origin, Eigen::Vector2d(1.0, 2.0));
  EXPECT_THAT(grid.cells, ElementsAre(Cell::kUnknown, Cell::kFree, Cell::kFree, Cell::kOccupied));
}

TEST_F(MapFileTest, ThresholdsAreMapServersTrinaryOnes) {
  folder_.Write("m.pgm", "P2 6 1 255 0 89 90 205 206 255\n");
  EXPECT_THAT(Load(kYaml).cells, ElementsAre(Cell::kOccupied, Cell::kOccupied, Cell::kUnknown,
                                             Cell::kUnknown, Cell::kFree, Cell::kFree));
  std::string negated = kYaml;
  negated.replace(negated.find("negate: 0"), 9, "negate: 1");
  EXPECT_THAT(Load(negated).cells, ElementsAre(Cell::kFree, Cell::kUnknown, Cell::kUnknown,
                                               Cell::kOccupied, Cell::kOccupied, Cell::kOccupied));
}

TEST_F(MapFileTest, GreyThatCountsAsFreeIsWarnedOf) {
  folder_.Write("m.pgm", "P2 4 2 255 254 254 0 205 205 205 220 250\n");
  std::string generous = kYaml;
  generous.replace(generous.find("0.196"), 5, "0.25");
  {
    const test_support::LogCatcher log(base::LogLevel::kWarn);
    const OccupancyGrid free = Load(generous);
    EXPECT_EQ(free.at(3, 1), Cell::kFree) << "the answer stays that of map_server";
    EXPECT_EQ(ExtrudeMap(free, 1.0).notes, log.lines) << "answers have it as a caveat";
    ASSERT_EQ(log.lines.size(), 1u);
    EXPECT_THAT(
        log.lines[0],
        AllOf(HasSubstr("m.yaml: 4 of 8 cells are grey in m.pgm (most of them 205)"),
              HasSubstr("0.196, lies below free_thresh 0.25"), HasSubstr("free_thresh: 0.137")));
  }
  const test_support::LogCatcher log(base::LogLevel::kWarn);
  generous.replace(generous.find("0.25"), 4, "0.137");
  const OccupancyGrid grid = Load(generous);
  EXPECT_TRUE(log.lines.empty());
  EXPECT_TRUE(grid.notes.empty());
  EXPECT_EQ(std::count(grid.cells.begin(), grid.cells.end(), Cell::kUnknown), 4);
}

TEST_F(MapFileTest, ThePictureItselfIsNoMap) {
  for (const char* name : {"flat.png", "flat.PGM"}) {
    EXPECT_THAT([&] { LoadMap(folder_.Write(name, "P2 1 1 255 0")); },
                ThrowsMessage<base::ConfigError>(
                    AllOf(HasSubstr(name), HasSubstr("name the YAML file of map_server"))));
  }
}

TEST_F(MapFileTest, SavedMapsReadBackTheSame) {
  for (int seed = 0; seed < 100; ++seed) {
    base::Rng rng = base::Rng(3).Fork(seed);
    OccupancyGrid grid;
    grid.width = 1 + rng.Index(20);
    grid.height = 1 + rng.Index(20);
    grid.resolution = rng.Uniform(0.01, 1.0);
    grid.origin = {rng.Uniform(-50, 50), rng.Uniform(-50, 50)};
    for (int i = 0; i < grid.width * grid.height; ++i) {
      grid.cells.push_back(static_cast<Cell>(rng.Index(3)));
    }
    SaveMap(grid, folder_.path("saved.yaml"));
    const OccupancyGrid again = LoadMap(folder_.path("saved.yaml"));
    EXPECT_EQ(again.width, grid.width);
    EXPECT_EQ(again.height, grid.height);
    EXPECT_EQ(again.resolution, grid.resolution) << "seed " << seed;
    EXPECT_EQ(again.origin, grid.origin) << "seed " << seed;
    EXPECT_EQ(again.cells, grid.cells) << "seed " << seed;
  }
}

TEST_F(MapFileTest, ThePictureIsNamedWhereLoadingFindsIt) {
  const std::string yaml = folder_.Write("m.yaml", kYaml);
  EXPECT_EQ(PictureOfMap(yaml), folder_.path("m.pgm"));
  EXPECT_EQ(PictureToSave(yaml), folder_.path("m.pgm"));
  std::string elsewhere = kYaml;
  elsewhere.replace(elsewhere.find("m.pgm"), 5, "/none/m.pgm");
  EXPECT_EQ(PictureOfMap(folder_.Write("e.yaml", elsewhere)), folder_.path("m.pgm"));
  for (const char* none : {"image: gone.pgm\n", "a: [\n", "resolution: 0.1\n"}) {
    EXPECT_EQ(PictureOfMap(folder_.Write("none.yaml", none)), "") << none;
  }
  EXPECT_EQ(PictureOfMap(folder_.path("nowhere.yaml")), "");
}

TEST_F(MapFileTest, AYawOfMoreThanAFullTurnIsNoneInRadians) {
  for (const char* degrees : {"90.0", "-90.0", "180", "-45", "10", "7", "6.29", "360"}) {
    EXPECT_THAT(ErrorWith("2.0, 0.0]", fmt::format("2.0, {}]", degrees)),
                AllOf(HasSubstr("m.yaml:3: origin"), HasSubstr("more than a turn"),
                      HasSubstr("wanted radians")))
        << degrees;
  }
  for (const char* radians : {"1.5708", "-3.14159", "6.28", "6.2832", "-6.2831853"}) {
    const test_support::LogCatcher log(base::LogLevel::kWarn);  // of a turned map
    std::string yaml = kYaml;
    yaml.replace(yaml.find("2.0, 0.0]"), 9, fmt::format("2.0, {}]", radians));
    EXPECT_NO_THROW(Load(yaml)) << radians;
  }
}

TEST_F(MapFileTest, RefusesYamlThatIsWrong) {
  EXPECT_THAT(ErrorWith("origin: [1.0, 2.0, 0.0]\n", ""),
              AllOf(HasSubstr("m.yaml: origin is missing"), HasSubstr("origin: [0.0, 0.0, 0.0]")));
  EXPECT_THAT(ErrorWith("2.0, 0.0]", "2.0]"),
              AllOf(HasSubstr("m.yaml:3: origin"), HasSubstr("yaw")));
  EXPECT_THAT(ErrorWith("2.0, 0.0]", "2.0, 180]"), HasSubstr("180 degrees are 3.1416"));
  EXPECT_THAT(ErrorWith("occupied_thresh: 0.65", "occupied_thresh: 65"), HasSubstr("it is 0.65"));
  EXPECT_THAT(ErrorWith("[1.0,", "[1e9,"), HasSubstr("origin"));
  EXPECT_THAT(ErrorWith("[1.0,", "[.nan,"), HasSubstr("origin"));
  EXPECT_THAT(ErrorWith("resolution: 0.1", "resolution: 0"), HasSubstr("resolution"));
  EXPECT_THAT(ErrorWith("negate: 0", "negate: 2"), HasSubstr("negate"));
  EXPECT_THAT(ErrorWith("free_thresh: 0.196", "free_thresh: 0.7"),
              HasSubstr("at most occupied_thresh"));
  EXPECT_THAT(ErrorWith("negate: 0", "negate: 0\nmode: fancy"), HasSubstr("trinary, scale or raw"));
  EXPECT_THAT(ErrorWith("resolution", "reslution"),
              AllOf(HasSubstr("m.yaml:2: key 'reslution'"), HasSubstr("did you mean 'resolution'"),
                    Not(HasSubstr("missing"))));
  EXPECT_THAT(ErrorWith("negate: 0", "negate: 0\nnegat: 1"), HasSubstr("did you mean 'negate'"));
  EXPECT_THAT(ErrorWith("occupied_thresh", "occupied_threshold"), HasSubstr("'occupied_thresh'?"));
  EXPECT_THAT(ErrorWith("negate: 0", "negate: 0\nnegate: 1"), HasSubstr("line 4; keep one"));
  EXPECT_THAT(MessageOf<base::ConfigError>([&] { Load("- 1\n"); }), HasSubstr("a list of 1"));
  EXPECT_THAT(MessageOf<base::ConfigError>([&] { Load("a: [\n"); }), HasSubstr("no valid YAML"));
}

TEST_F(MapFileTest, OtherKindsOfFilesAreNamed) {
  EXPECT_THAT(MessageOf<base::ConfigError>([&] { Load("<?xml version='1.0'?>\n<sdf/>"); }),
              HasSubstr("--world"));
  EXPECT_THAT(MessageOf<base::ConfigError>([&] { Load("<robot name='a'/>"); }),
              HasSubstr("--robot takes it"));
  const std::string parameters = "map_server:\n  ros__parameters:\n    yaml_filename: ";
  for (const std::string before : {"", "amcl:\n  ros__parameters: {alpha1: 0.2}\n"}) {
    EXPECT_THAT(
        MessageOf<base::ConfigError>([&] { Load(before + parameters + "\"hall.yaml\"\n"); }),
        AllOf(HasSubstr(before.empty() ? ":3: " : ":5: "), HasSubstr("parameters of a map_server"),
              HasSubstr("give 'hall.yaml'")));
  }
  EXPECT_THAT(MessageOf<base::ConfigError>([&] { Load(parameters + "''\n"); }),
              HasSubstr("is empty, as a launch file names the map"));
}

TEST_F(MapFileTest, ForeignKeysArePassedOverWithOneWarning) {
  const test_support::LogCatcher log(base::LogLevel::kWarn);
  const OccupancyGrid grid =
      Load(std::string("map_type: occupancy\n") + kYaml + "created: 2024-05-01\nrooms: {a: 1}\n");
  EXPECT_EQ(grid.width, 2);
  EXPECT_THAT(log.lines,
              ElementsAre(AllOf(HasSubstr("'map_type' (line 1)"), HasSubstr("'created' (line 8)"),
                                HasSubstr("'rooms' (line 9)"))));
  EXPECT_TRUE(grid.notes.empty()) << "what they say bears on no answer";
}

TEST_F(MapFileTest, WhatMapServerHasDefaultsForIsTakenAndSaid) {
  const test_support::LogCatcher log(base::LogLevel::kWarn);
  const OccupancyGrid grid = Load("image: m.pgm\nresolution: 0.1\norigin: [1.0, 2.0, 0.0]\n");
  EXPECT_EQ(grid.cells, Load(kYaml).cells);
  EXPECT_THAT(grid.notes,
              ElementsAre(HasSubstr("negate: 0, occupied_thresh: 0.65, free_thresh: 0.196")));
  EXPECT_EQ(log.lines, grid.notes);
}

TEST_F(MapFileTest, ModesAreMapServers) {
  folder_.Write("m.pgm", "P2 7 1 255 0 19 20 65 66 101 255\n");
  EXPECT_THAT(Load(std::string(kYaml) + "mode: scale\n").cells,
              ElementsAre(Cell::kOccupied, Cell::kOccupied, Cell::kOccupied, Cell::kOccupied,
                          Cell::kOccupied, Cell::kUnknown, Cell::kFree));
  EXPECT_THAT(Load(std::string(kYaml) + "mode: raw\n").cells,
              ElementsAre(Cell::kFree, Cell::kFree, Cell::kUnknown, Cell::kUnknown, Cell::kOccupied,
                          Cell::kUnknown, Cell::kUnknown));
}

TEST_F(MapFileTest, AMissingPictureIsToldWithItsLineAndWhatLiesBeside) {
  folder_.Write("floor.PNG", "");
  EXPECT_THAT(ErrorWith("image: m.pgm", "image: floor.png"),
              AllOf(HasSubstr("m.yaml:1: image floor.png is not there"),
                    HasSubstr("floor.PNG, m.pgm are")));
  EXPECT_THAT(ErrorWith("image: m.pgm", "image: .."), HasSubstr("is a folder"));
  EXPECT_THAT(ErrorWith("image: m.pgm", "image: floor.PNG"), HasSubstr("floor.PNG: is empty"));
}

TEST_F(MapFileTest, APictureOfAnotherComputerIsReadFromBeside) {
  for (const char* path : {"/home/user/maps/m.pgm", "'C:\\maps\\m.pgm'", "../other/m.pgm"}) {
    const test_support::LogCatcher log(base::LogLevel::kWarn);
    std::string yaml = kYaml;
    yaml.replace(yaml.find("m.pgm"), 5, path);
    EXPECT_EQ(Load(yaml).width, 2);
    EXPECT_THAT(log.lines, ElementsAre(HasSubstr("but m.pgm lies beside")));
  }
}

TEST_F(MapFileTest, TurnedOriginsPlaceObstaclesWhereRVizDoes) {
  std::string yaml = kYaml;
  yaml.replace(yaml.find("2.0, 0.0]"), 9, "2.0, 1.570796]");
  const OccupancyGrid quarter = Load(yaml);  // the occupied cell is (1, 1) of the picture's
  EXPECT_EQ(quarter.at(0, 1), Cell::kOccupied);
  EXPECT_NEAR(quarter.origin.x(), 0.8, 1e-12);
  EXPECT_TRUE(quarter.notes.empty());
  yaml.replace(yaml.find("1.570796"), 8, "0.5");
  const OccupancyGrid turned = Load(yaml);
  EXPECT_THAT(turned.notes, ElementsAre(HasSubstr("is turned by 0.5 rad")));
  const Eigen::Vector2d p =
      Eigen::Vector2d(1, 2) + Eigen::Rotation2Dd(0.5) * Eigen::Vector2d(0.15, 0.15);
  const Eigen::Vector2d cell = (p - turned.origin) / turned.resolution;
  EXPECT_EQ(turned.at(static_cast<int>(cell.x()), static_cast<int>(cell.y())), Cell::kOccupied);
}

/// One thing that is wrong with a map (or foreign to it), and what tells of it.
struct Defect {
  const char* line;  // of the YAML that it stands for; the first letters name it
  const char* by;
  const char* told;
};
constexpr Defect kErrors[] = {
    {"image", "image: gone.pgm", "gone.pgm is not there"},
    {"image", "image: broken.png", "broken.png: is a broken PNG"},
    {"image", "imge: m.pgm", "did you mean 'image'"},
    {"resolution", "resolution: zero", "resolution is 'zero'"},
    {"resolution", "resolution: -0.1", "resolution is '-0.1'"},
    {"resolution", "", "resolution is missing"},
    {"origin", "origin: [1.0, 2.0]", "origin is a list of 2"},
    {"origin", "origin: [1.0, here, 0.0]", "number 2 is 'here'"},
    {"origin", "", "origin is missing"},
    {"negate", "negate: maybe", "negate is 'maybe'"},
    {"occupied_thresh", "occupied_thresh: 65", "occupied_thresh is '65'"},
    {"free_thresh", "free_tresh: 0.2", "did you mean 'free_thresh'"},
    {"free_thresh", "free_thresh: 0.9", "free_thresh is 0.9"},
    {"mode", "mode: colourful", "mode is 'colourful'"},
};
constexpr Defect kOddities[] = {
    {"image", "image: /home/user/m.pgm", "lies beside the YAML"},
    {"negate", "", "negate: 0"},
    {"free_thresh", "", "free_thresh: 0.196"},
    {"mode", "map_type: occupancy", "'map_type'"},
    {"extra", "created: today", "'created'"},
    {"origin", "origin: [1.0, 2.0, 0.7]", "is turned by 0.7 rad"},
};

TEST_F(MapFileTest, OneToThreeDefectsAreAllNamedAtOnce) {
  folder_.Write("broken.png", "\x89PNG\r\n\x1a\n");
  const std::vector<Defect> errors(std::begin(kErrors), std::end(kErrors));
  std::vector<Defect> all(std::begin(kOddities), std::end(kOddities));
  all.insert(all.end(), errors.begin(), errors.end());
  for (int seed = 0; seed < Rounds(400); ++seed) {
    base::Rng rng = base::Rng(57).Fork(seed);
    std::map<std::string, std::string> lines{{"image", "image: m.pgm"},
                                             {"resolution", "resolution: 0.1"},
                                             {"origin", "origin: [1, 2, 0]"},
                                             {"negate", "negate: 0"},
                                             {"occupied_thresh", "occupied_thresh: 0.65"},
                                             {"free_thresh", "free_thresh: 0.196"},
                                             {"mode", "mode: trinary"},
                                             {"extra", ""}};
    std::map<std::string, std::string> told;
    bool is_wrong = false;
    for (int i = 1 + rng.Index(3); i > 0; --i) {
      const int pick = rng.Index(static_cast<int>(all.size()));
      const Defect& defect = all[static_cast<std::size_t>(pick)];
      if (told.count(defect.line) > 0) continue;
      told[defect.line] = defect.told;
      lines[defect.line] = defect.by;
      is_wrong |= pick >= static_cast<int>(std::size(kOddities));
    }
    std::string yaml;
    for (const auto& [key, line] : lines) yaml += line + "\n";
    const test_support::LogCatcher log(base::LogLevel::kWarn);
    std::string heard;
    if (is_wrong) {
      heard = MessageOf<base::ConfigError>([&] { Load(yaml); });
    } else {
      Load(yaml);
    }
    for (const std::string& line : log.lines) heard += "\n" + line;
    for (const auto& [key, text] : told) {
      // What has the picture's size needs the picture, and its place needs a place.
      if (is_wrong && text.find("is turned") == 0) continue;
      EXPECT_THAT(heard, HasSubstr(text)) << "seed " << seed << "\n" << yaml;
    }
  }
}

TEST_F(MapFileTest, RefusesToWriteWhereNothingCanBe) {
  OccupancyGrid grid{0.05, 1, 1, {0, 0}, {Cell::kFree}};
  EXPECT_THAT(
      MessageOf<base::ConfigError>([&] { SaveMap(grid, folder_.path("no/folder/m.yaml")); }),
      HasSubstr("cannot be written"));
}

TEST(OriginalMapTest, HasTheSizeAndTheMissingOriginOfTheOriginal) {
  const std::string data = HIRES_SHARED_DATA;
  if (!std::filesystem::exists(data + "/map_pr2.yaml")) GTEST_SKIP() << "no maps in " << data;
  const OccupancyGrid floor = LoadMap(data + "/map_pr2_origin.yaml");
  EXPECT_EQ(floor.width, 898);
  EXPECT_EQ(floor.height, 342);
  EXPECT_THAT(MessageOf<base::ConfigError>([&] { LoadMap(data + "/map_pr2.yaml"); }),
              HasSubstr("origin is missing"));
}

}  // namespace
}  // namespace hires::world::map_file_test
