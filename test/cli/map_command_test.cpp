#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "cli/command_run.h"
#include "hires/base/text.h"
#include "hires/world/occupancy_grid.h"
#include "support/temporary_folder.h"

namespace hires::cli::map_command_test {
namespace {

using hires::test_support::Ended;
using hires::test_support::RunHires;
using nlohmann::json;
using ::testing::HasSubstr;

/// A robot drives 2 m ahead in a room from (-2, -2) to (5, 2); its odometry tells 5 % more.
/// @param is_half_spoilt  every second scan shows no walls, but points here and there.
std::string DriveAhead(bool is_half_spoilt = false) {
  std::string text = "# CARMEN log\nPARAM robot_front_laser_max 20 nohost 0\n";
  for (int k = 0; k <= 40; ++k) {
    const double x = 0.05 * k, told = 1.05 * x;
    text += "FLASER 181";
    for (int i = 0; i < 181; ++i) {
      const double angle = (i - 90) * std::acos(-1.0) / 180.0;
      const double ahead = std::cos(angle) > 1e-6 ? (5.0 - x) / std::cos(angle) : 100.0;
      const double beside =
          std::abs(std::sin(angle)) > 1e-6 ? 2.0 / std::abs(std::sin(angle)) : 100.0;
      const bool is_spoilt = is_half_spoilt && k % 2 == 1;
      text += fmt::format(" {:.2f}", is_spoilt ? 1.0 + i % 3 : std::min(ahead, beside));
    }
    text += fmt::format(" {0} 0 0 {0} 0 0 {1:.2f} nohost {1:.2f}\n", told, 100.0 + 0.1 * k);
  }
  return text;
}

class MapCommandTest : public testing::Test {
 protected:
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  Ended Map(const std::vector<std::string>& words) const { return RunHires({"map"}, words); }

  const hires::test_support::TemporaryFolder folder_;
};

TEST_F(MapCommandTest, MapAndTrajectoryAreWritten) {
  const std::string log = folder_.Write("drive.log", DriveAhead());
  const Ended ended = Map({log, "--output", Path("room.yaml"), "--trajectory", Path("path.tum"),
                           "--json", Path("map.json")});
  ASSERT_EQ(ended.code, kExitRecommended) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("41 scans over 2.0"));
  const world::OccupancyGrid grid = world::LoadMap(Path("room.yaml"));
  const auto at = [&](double x, double y) {
    return grid.at(static_cast<int>((x - grid.origin.x()) / grid.resolution),
                   static_cast<int>((y - grid.origin.y()) / grid.resolution));
  };
  EXPECT_EQ(at(1.0, 0.5), world::Cell::kFree);
  EXPECT_GE(grid.origin.x(), -0.6) << "what is behind was not seen";
  const json told = json::parse(std::ifstream(Path("map.json")));
  EXPECT_EQ(told["schema"], "hires/map");
  EXPECT_EQ(told["scans"], 41);
  EXPECT_EQ(told["doubt"], "");
  EXPECT_NEAR(told["length"].get<double>(), 2.0, 0.03) << "not 2.1, as odometry says";
  std::ifstream path(Path("path.tum"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(path, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 41u);
  EXPECT_EQ(lines[0], "100.000000 0.000000 0.000000 0 0 0 0.000000000 1.000000000");
}

TEST_F(MapCommandTest, DoubtfulMapIsWrittenAndCalledSo) {
  const std::string log = folder_.Write("drive.log", DriveAhead(true));
  const Ended ended = Map({log, "--output", Path("room.yaml"), "--json", Path("map.json")});
  EXPECT_EQ(ended.code, kExitDoubtful) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("\n" + Path("room.yaml") + " is doubtful: "));
  EXPECT_THAT(ended.out, HasSubstr("20 of 41 scans fitted nothing"));
  EXPECT_THAT(ended.out, HasSubstr("; to do: "));
  EXPECT_THAT(json::parse(std::ifstream(Path("map.json")))["doubt"].get<std::string>(),
              HasSubstr("20 of 41 scans"));
  EXPECT_NO_THROW(world::LoadMap(Path("room.yaml")));
  EXPECT_EQ(Map({log, "--output", Path("room.yaml"), "--json", "-"}).code, kExitDoubtful);
}

TEST_F(MapCommandTest, CellsAreAsLargeAsAsked) {
  const std::string log = folder_.Write("drive.log", DriveAhead());
  const Ended ended = Map(
      {log, "--output", Path("room"), "--resolution", "0.1", "--max-range", "3", "--json", "-"});
  ASSERT_EQ(ended.code, kExitRecommended) << ended.err;
  EXPECT_EQ(world::LoadMap(Path("room.yaml")).resolution, 0.1);
  EXPECT_EQ(json::parse(ended.out)["map"], Path("room.yaml"));
}

TEST_F(MapCommandTest, BadInputIsRefused) {
  const auto refused = [&](const std::vector<std::string>& words, const std::string& said) {
    const Ended ended = Map(words);
    EXPECT_EQ(ended.code, kExitBadInput) << said;
    EXPECT_THAT(ended.err, HasSubstr(said));
    EXPECT_EQ(ended.out, "");
  };
  const std::string out = Path("room.yaml");
  const std::string log = folder_.Write("drive.log", DriveAhead());
  refused({}, "--output");
  refused({"--output", out}, "no log; wanted LOG, a recorded drive, or --drive");
  refused({log}, "--output");
  refused({Path("none.log"), "--output", out}, "none.log: no such file");
  refused({Path("drive.bag"), "--output", out}, "drive.bag: is a bag, which this program does not");
  refused({log, "--output", out, "--odometry", "/odom"}, "--odometry: is for bags");
  refused({log, "--output", out, "--imu", "/imu"}, "--imu: is for bags");
  refused({log, "--output", Path("room.pgm")}, "room.pgm: is the name of a picture");
  refused({log, "--output", Path("none/room.yaml")}, "none");
  refused({log, "--output", out, "--trajectory", Path("none/path")}, "none");
  refused({log, "--output", out, "--json", Path("none/map.json")}, "none");
  refused({log, "--output", out, "--resolution", "0"}, "--resolution");
  refused({log, "--output", out, "--resolution", "fine"}, "--resolution");
  refused({log, "--output", out, "--max-range", "-1"}, "--max-range");
  refused({folder_.Write("odom.log", "ODOM 0 0 0 0 0 0 1 nohost 1\n"), "--output", out},
          "odom.log: has no scan; wanted lines FLASER");
  refused({folder_.Write("blind.log", "FLASER 2 nan 0 0 0 0 0 0 0 1 nohost 1\n"), "--output", out},
          "no scan of the log measured anything");
  refused({folder_.Write("cut.log", "FLASER 2 1 1 0 0 0 0\n"), "--output", out},
          "cut.log: line 1: FLASER has 8 words; wanted 13");
  refused({folder_.Write("page.log", "<html>\n"), "--output", out}, "page.log: line 1: '<html>'");
  refused({log, "--output", out, "--trajectry", "x"}, "--trajectory");
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(MapCommandTest, LineThatIsCutOffIsNoReasonToRefuseALog) {
  const std::string log = DriveAhead();
  const Ended ended = Map({folder_.Write("drive.log", log.substr(0, log.size() - 200)), "--output",
                           Path("room.yaml"), "--json", "-"});
  ASSERT_EQ(ended.code, kExitRecommended) << ended.err;
  EXPECT_EQ(json::parse(ended.out)["scans"], 40);
}

std::string Workshop() { return std::string(HIRES_SOURCE_DIR) + "/worlds/workshop.world"; }

/// Of a drive through the workshop: every file that can be written.
class DrivenMap {
 public:
  explicit DrivenMap(const std::string& seed) {
    const auto path = [&](const char* name) { return (folder_.path() / name).string(); };
    ended_ = RunHires(
        {"map"}, {"--drive", "--world", Workshop(), "--seed", seed, "--output", path("map.yaml"),
                  "--trajectory", path("path.tum"), "--truth", path("truth.tum"), "--log",
                  path("drive.log"), "--json", path("map.json")});
  }
  const Ended& ended() const { return ended_; }
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string Text(const std::string& name) const { return base::ReadTextFile(Path(name)); }

 private:
  const hires::test_support::TemporaryFolder folder_;
  Ended ended_;
};

TEST_F(MapCommandTest, SimulatedWorldIsDrivenThroughMappedAndJudged) {
  const DrivenMap driven("3");
  ASSERT_EQ(driven.ended().code, kExitRecommended) << driven.ended().err;
  EXPECT_THAT(driven.ended().out, HasSubstr("walls of the world to walls of the map"));
  const json told = json::parse(driven.Text("map.json")), &judged = told["judgement"];
  EXPECT_EQ(judged["visited"], json({"atbench", "farcorner", "dock", "atbench"}));
  EXPECT_TRUE(judged["missed"].empty());
  EXPECT_LE(judged["trajectory"]["rms"], 0.05);
  EXPECT_GE(judged["trajectory"]["max"], judged["trajectory"]["rms"]);
  EXPECT_GT(judged["trajectory"]["odometry_rms"], judged["trajectory"]["rms"]);
  for (const char* way : {"walls_to_world", "world_to_walls"}) {
    EXPECT_LE(judged[way]["median"], 0.03) << way;
    EXPECT_GT(judged[way]["count"], 300) << way;
  }
  const world::OccupancyGrid map = world::LoadMap(driven.Path("map.yaml"));
  const auto at = [&](double x, double y) {
    return map.at(static_cast<int>((x - map.origin.x()) / map.resolution),
                  static_cast<int>((y - map.origin.y()) / map.resolution));
  };
  EXPECT_EQ(at(3.0, 1.5), world::Cell::kFree) << "in the frame of the world";
  EXPECT_EQ(at(3.0, 2.3), world::Cell::kUnknown) << "within the post";

  const Ended again = Map({driven.Path("drive.log"), "--output", Path("again"), "--json", "-"});
  ASSERT_EQ(again.code, kExitRecommended) << again.err;
  EXPECT_EQ(json::parse(again.out)["scans"], told["scans"]) << "of the log that was written";
  EXPECT_NEAR(json::parse(again.out)["length"].get<double>(), told["length"].get<double>(), 0.1);
}

TEST_F(MapCommandTest, SameSeedGivesTheSameBytes) {
  const DrivenMap one("3"), same("3"), other("4");
  for (const char* file : {"map.pgm", "path.tum", "truth.tum", "drive.log"})
    EXPECT_EQ(one.Text(file), same.Text(file)) << file;
  EXPECT_EQ(one.Text("truth.tum"), other.Text("truth.tum")) << "it drives by what is so";
  EXPECT_NE(one.Text("drive.log"), other.Text("drive.log"));
  EXPECT_NE(one.Text("path.tum"), other.Text("path.tum"));
}

TEST_F(MapCommandTest, BadDrivesAreRefused) {
  const std::string out = Path("room.yaml"), log = folder_.Write("drive.log", DriveAhead());
  const auto refused = [&](std::vector<std::string> words, const std::string& said) {
    words.insert(words.end(), {"--output", out});
    const Ended ended = Map(words);
    EXPECT_EQ(ended.code, kExitBadInput) << said;
    EXPECT_THAT(ended.err, HasSubstr(said));
    EXPECT_EQ(ended.out, "");
  };
  refused({log, "--drive"}, "log");
  refused({"--drive", "--imu", "/imu"}, "--imu");
  refused({log, "--world", Workshop()}, "--drive");
  refused({log, "--seed", "2"}, "--drive");
  refused({"--drive", "--seed", "-1"}, "--seed");
  refused({"--drive", "--world", Path("none.world")}, "none.world");
  refused({"--drive", "--robot", Path("none.yaml")}, "none.yaml");
  refused({"--drive", "--scene", Path("none.yaml")}, "none.yaml");
  refused({"--drive", "--world", Workshop(), "--motion-set", "fsat"}, "fsat");
  refused({"--drive", "--world", Workshop(), "--log", Path("none/drive.log")}, "none");
  refused({"--drive", "--world", Workshop(), "--truth", Path("none/truth.tum")}, "none");
  refused({"--drive", "--world", Workshop(), "--robot",
           std::string(HIRES_SOURCE_DIR) + "/urdf/cart.urdf"},
          "base laser");
  refused({"--drive", "--world",
           folder_.Write("bare.world", R"(<sdf version="1.7"><world name="bare"><model name="box">
             <static>true</static><pose>3 0 0.5 0 0 0</pose><link name="link"><collision name="c">
             <geometry><box><size>1 1 1</size></box></geometry></collision></link></model>
             </world></sdf>)")},
          "wanted two at least at which the robot can stand");
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace hires::cli::map_command_test
