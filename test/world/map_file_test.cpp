#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/rng.h"
#include "hires/base/text.h"
#include "hires/world/occupancy_grid.h"
#include "support/log_catcher.h"
#include "world/pgm.h"
#include "world/temp_folder.h"

namespace hires::world::map_file_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
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

TEST_F(MapFileTest, RefusesYamlThatIsWrong) {
  EXPECT_THAT(ErrorWith("origin: [1.0, 2.0, 0.0]\n", ""),
              AllOf(HasSubstr("m.yaml: origin is missing"), HasSubstr("origin: [0.0, 0.0, 0.0]")));
  EXPECT_THAT(ErrorWith("2.0, 0.0]", "2.0, 0.5]"),
              AllOf(HasSubstr("origin"), HasSubstr("of 0 and not 0.5"), HasSubstr("rotated"),
                    HasSubstr("line 3")));
  EXPECT_THAT(ErrorWith("[1.0,", "[1e9,"), HasSubstr("origin"));
  EXPECT_THAT(ErrorWith("[1.0,", "[.nan,"), HasSubstr("origin"));
  EXPECT_THAT(ErrorWith("resolution: 0.1", "resolution: 0"), HasSubstr("resolution"));
  EXPECT_THAT(ErrorWith("negate: 0", "negate: 2"), HasSubstr("negate"));
  EXPECT_THAT(ErrorWith("free_thresh: 0.196", "free_thresh: 0.7"),
              HasSubstr("at most occupied_thresh"));
  EXPECT_THAT(ErrorWith("image: m.pgm", "image: none.pgm"), HasSubstr("none.pgm"));
  EXPECT_THAT(ErrorWith("negate: 0", "negate: 0\nmode: scale"), HasSubstr("trinary"));
  EXPECT_THAT(ErrorWith("negate: 0", "negate: 0\ntypo: 1"), HasSubstr("typo"));
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

// --- images ------------------------------------------------------------------------------------

std::string PgmError(const std::string& bytes) {
  return MessageOf<base::ConfigError>([&] { ParsePgm(bytes, "a.pgm"); });
}

TEST(PgmTest, PlainAndRawGiveTheSamePixels) {
  const std::string raw =
      std::string("P5\n# made by hand\n3 2\n255\n") + std::string("\x00\x01\x0a\x23\xfe\xff", 6);
  const GreyImage image = ParsePgm(raw, "a.pgm");
  EXPECT_EQ(image.width, 3);
  EXPECT_EQ(image.height, 2);
  EXPECT_THAT(image.pixels, ElementsAre(0, 1, 10, 35, 254, 255));
  EXPECT_EQ(ParsePgm("P2 3 #w\n2 255\n0 1 10\n35 # in between\n254 255", "a.pgm").pixels,
            image.pixels);
}

TEST(PgmTest, OtherMaximaAreScaledTo255) {
  EXPECT_THAT(ParsePgm("P2 3 1 15 0 7 15", "a.pgm").pixels, ElementsAre(0, 119, 255));
  const std::string wide = std::string("P5 2 1 65535\n") + std::string("\xff\xff\x80\x00", 4);
  EXPECT_THAT(ParsePgm(wide, "a.pgm").pixels, ElementsAre(255, 128));
}

TEST(PgmTest, FormattedImageReadsBackTheSame) {
  const GreyImage image{2, 3, {'#', '\n', ' ', 0, 255, 7}};
  EXPECT_EQ(ParsePgm(FormatPgm(image), "a.pgm").pixels, image.pixels);
  EXPECT_THROW(FormatPgm({2, 2, {0}}), std::logic_error);
}

TEST(PgmTest, RefusesWhatIsNoImage) {
  EXPECT_THAT(PgmError(""), AllOf(HasSubstr("a.pgm"), HasSubstr("P2, P5")));
  EXPECT_THAT(PgmError("P6 1 1 255 abc"), HasSubstr("P2, P5"));
  EXPECT_THAT(PgmError("P5"), HasSubstr("width"));
  EXPECT_THAT(PgmError("P51 1 255 a"), HasSubstr("width"));
  EXPECT_THAT(PgmError("P5 -1 1 255 a"), HasSubstr("no number where the width belongs"));
  EXPECT_THAT(PgmError("P5 0 1 255 a"), HasSubstr("width 0"));
  EXPECT_THAT(PgmError("P5 1"), HasSubstr("height"));
  EXPECT_THAT(PgmError("P5 1 # only a comment"), HasSubstr("height"));
  EXPECT_THAT(PgmError("P5 1 1 0 a"), HasSubstr("maximum grey value 0"));
  EXPECT_THAT(PgmError("P5 1 1 70000 a"), HasSubstr("70000"));
  EXPECT_THAT(PgmError("P5 99999999999999999999 1 255 a"), HasSubstr("width above"));
}

TEST(PgmTest, RefusesImagesThatAreLargerThanTheirFile) {
  EXPECT_THAT(PgmError("P5 2 2 255\nabc"), HasSubstr("ends before its 4 pixels"));
  EXPECT_THAT(PgmError("P5 2 1 65535\nabc"), HasSubstr("of 2 byte(s)"));
  EXPECT_THAT(PgmError("P2 2 2 255 1 2 3"), HasSubstr("next pixel"));
  EXPECT_THAT(PgmError("P2 9999 9999 255 1"), HasSubstr("ends before"));
  EXPECT_THAT(PgmError("P5 100000 100000 255\nabc"), HasSubstr("scale it down"));
}

TEST(PgmTest, RefusesValuesAboveTheMaximum) {
  EXPECT_THAT(PgmError("P2 1 1 15 16"), HasSubstr("grey value 16, above its maximum 15"));
  EXPECT_THAT(PgmError("P5 1 1 15\n\x10"), HasSubstr("above its maximum"));
  EXPECT_THAT(PgmError("P2 1 1 255 x"), HasSubstr("next pixel"));
}

TEST(PgmTest, SurvivesEveryCutAndEveryChangedByte) {
  const std::string good = "P5\n# c\n3 2\n255\nabcdef";
  for (std::size_t size = 0; size < good.size(); ++size) PgmError(good.substr(0, size));
  base::Rng rng(11);
  for (int i = 0; i < 2000; ++i) {
    std::string changed = good;
    changed[rng.Index(static_cast<int>(good.size()))] = static_cast<char>(rng.Index(256));
    try {
      const GreyImage image = ParsePgm(changed, "a.pgm");
      EXPECT_EQ(image.pixels.size(), static_cast<std::size_t>(image.width) * image.height);
    } catch (const base::ConfigError&) {
    }
  }
}

}  // namespace
}  // namespace hires::world::map_file_test
