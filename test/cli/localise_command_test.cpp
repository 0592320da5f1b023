#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "cli/command_run.h"
#include "hires/base/text.h"
#include "support/simulated_drive.h"
#include "support/temporary_folder.h"

namespace hires::cli::localise_command_test {
namespace {

using geometry::Pose2;
using hires::test_support::Ended;
using hires::test_support::RoomsWithShelf;
using hires::test_support::RunHires;
using hires::test_support::SimulatedDrive;
using localisation::RobotLog;
using localisation::TimedPath;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string Words(const Pose2& X) { return fmt::format(" {:.6f} {:.6f} {:.6f}", X.x, X.y, X.yaw); }

/// As a robot would have written it. Odometry is that of the scan's time.
std::string CarmenText(const SimulatedDrive& drive) {
  std::map<double, Pose2> odometry;
  for (const RobotLog::Odometry& reading : drive.log.odometry)
    odometry[reading.time] = reading.reading.X_OB;
  std::string text = "PARAM robot_front_laser_max 30 nohost 0\n";
  for (const RobotLog::Scan& scan : drive.log.scans) {
    const Pose2 X_OB = odometry.at(scan.time);
    const std::string time = fmt::format(" {0:.6f} nohost {0:.6f}\n", scan.time);
    text += "ODOM" + Words(X_OB) + " 0 0 0" + time;
    text += fmt::format("FLASER {}", scan.reading.ranges.size());
    for (float range : scan.reading.ranges) text += fmt::format(" {:.3f}", range);
    text += Words(X_OB * scan.X_BL) + Words(X_OB) + time;
  }
  return text;
}

SimulatedDrive Drive(int seed) {
  return test_support::DriveThrough(RoomsWithShelf(), test_support::CourseThroughTwoRooms(), {},
                                    base::Rng(seed));
}

/// Of a trajectory in a file, by time.
TimedPath ReadTum(const std::string& path) {
  TimedPath poses;
  std::ifstream file(path);
  double time, x, y, z, qx, qy, qz, qw;
  while (file >> time >> x >> y >> z >> qx >> qy >> qz >> qw)
    poses.push_back({time, {x, y, 2.0 * std::atan2(qz, qw)}});
  return poses;
}

struct Errors {
  double rms{0.0}, worst{0.0}, worst_yaw{0.0}, last{0.0};  // [m], [rad]
};

/// Of the poses from `begin` [s] on; each must be of a scan's time.
Errors ErrorsOf(const TimedPath& path, const TimedPath& truth, double begin = 0.0) {
  Errors errors;
  int count = 0;
  for (const localisation::TimedPose& pose : path) {
    const auto same = std::find_if(truth.begin(), truth.end(), [&](const auto& true_pose) {
      return std::abs(true_pose.time - pose.time) < 1e-5;
    });
    if (same == truth.end()) ADD_FAILURE() << "no scan was made at " << pose.time;
    if (same == truth.end() || pose.time < begin) continue;
    errors.last = (pose.X_MB.position() - same->X_MB.position()).norm();
    errors.rms += errors.last * errors.last;
    errors.worst = std::max(errors.worst, errors.last);
    errors.worst_yaw =
        std::max(errors.worst_yaw, std::abs(geometry::WrapToPi(pose.X_MB.yaw - same->X_MB.yaw)));
    ++count;
  }
  errors.rms = std::sqrt(errors.rms / count);
  return errors;
}

class LocaliseCommandTest : public testing::Test {
 protected:
  LocaliseCommandTest() { world::SaveMap(RoomsWithShelf(), Path("rooms.yaml")); }

  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string Log(const SimulatedDrive& drive) const {
    return folder_.Write("drive.log", CarmenText(drive));
  }
  Ended Localise(const std::string& log, std::vector<std::string> words = {}) const {
    words.insert(words.begin(),
                 {log, "--map", Path("rooms.yaml"), "--trajectory", Path("path.tum")});
    return RunHires({"localise"}, words);
  }
  TimedPath Trajectory() const { return ReadTum(Path("path.tum")); }

  const hires::test_support::TemporaryFolder folder_;
  const std::vector<std::string> at_start_{"--initial", "2 2 1.5708"};
};

TEST_F(LocaliseCommandTest, DriveFromAKnownStartIsFollowed) {
  const SimulatedDrive drive = Drive(3);
  const Ended ended =
      Localise(Log(drive), {"--initial", "2.1 1.9 1.6", "--json", Path("answer.json")});
  ASSERT_EQ(ended.code, kExitRecommended) << ended.err;
  const TimedPath path = Trajectory();
  EXPECT_EQ(path.size(), drive.truth.size()) << "one pose for each scan";
  const Errors errors = ErrorsOf(path, drive.truth, 4.0);
  EXPECT_LT(errors.rms, 0.06);
  EXPECT_LT(errors.worst, 0.2);
  EXPECT_LT(errors.worst_yaw, 0.05);
  const json told = json::parse(std::ifstream(Path("answer.json")));
  EXPECT_EQ(told["schema"], "hires/localisation");
  EXPECT_EQ(told["status"], "good");
  EXPECT_EQ(told["scans"], drive.truth.size());
  EXPECT_EQ(told["poses"], path.size());
  EXPECT_EQ(told["seed"], 1);
  EXPECT_EQ(told["initial"], json({2.1, 1.9, 1.6}));
  EXPECT_EQ(told["relocations"], 0);
  EXPECT_NEAR(told["length"].get<double>(), localisation::LengthOf(drive.truth), 2.0);
  EXPECT_NEAR(told["pose"][0].get<double>(), path.back().X_MB.x, 1e-6);
  EXPECT_GT(told["explained"].get<double>(), 0.9);
  for (const json& sd : told["sd"]) EXPECT_GT(sd.get<double>(), 0.0);
  EXPECT_THAT(ended.out, HasSubstr("status      good"));
  EXPECT_THAT(ended.out, HasSubstr("start       x 2.100 m, y 1.900 m, yaw 1.600 rad"));
}

TEST_F(LocaliseCommandTest, RobotThatMayBeAnywhereIsFound) {
  const SimulatedDrive drive = Drive(3);
  const Ended ended = Localise(Log(drive), {"--json", Path("answer.json")});
  ASSERT_EQ(ended.code, kExitRecommended) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("anywhere on the map: global localisation"));
  const json told = json::parse(std::ifstream(Path("answer.json")));
  EXPECT_TRUE(told["initial"].is_null());
  EXPECT_EQ(told["relocations"], 0);
  const double after = told["localised_after"].get<double>();
  EXPECT_GT(after, 0.0);
  EXPECT_LT(after, 40.0);
  const TimedPath path = Trajectory();
  EXPECT_EQ(path.size(), drive.truth.size()) << "also from before it was found";
  const Errors errors = ErrorsOf(path, drive.truth);
  EXPECT_LT(errors.rms, 0.15);
  EXPECT_LT(errors.worst, 1.0);
  EXPECT_LT(errors.last, 0.15);
}

world::OccupancyGrid Mirrored(world::OccupancyGrid grid) {
  for (int row = 0; row < grid.height; ++row) {
    const auto begin = grid.cells.begin() + static_cast<std::ptrdiff_t>(row) * grid.width;
    std::reverse(begin, begin + grid.width);
  }
  return grid;
}

TEST_F(LocaliseCommandTest, AMirroredMapIsDoubtedForBeamsGoThroughItsObstacles) {
  world::SaveMap(Mirrored(RoomsWithShelf()), Path("rooms.yaml"));
  const std::string log = Log(Drive(3));
  for (const std::vector<std::string>& start :
       {std::vector<std::string>{}, std::vector<std::string>{"--initial", "10 2 1.5708"}}) {
    const Ended ended = Localise(log, start);
    EXPECT_EQ(ended.code, kExitUndecided) << ended.out;
    EXPECT_THAT(ended.out, AllOf(HasSubstr("status      doubtful"),
                                 HasSubstr("is probably not a map of where"),
                                 HasSubstr("% of the beams go through its obstacles")));
    EXPECT_FALSE(std::filesystem::exists(Path("path.tum")));
  }
}

TEST_F(LocaliseCommandTest, WhereElseTheDriveFitsIsTold) {
  world::OccupancyGrid empty = RoomsWithShelf();  // a hall like itself turned by half
  for (int row = 2; row < empty.height - 2; ++row)
    for (int column = 2; column < empty.width - 2; ++column)
      empty.cells[row * empty.width + column] = world::Cell::kFree;
  world::SaveMap(empty, Path("rooms.yaml"));
  const SimulatedDrive drive =
      test_support::DriveThrough(empty, test_support::CourseThroughTwoRooms(), {}, base::Rng(3));
  const std::string log = Log(drive);
  const Ended ended = Localise(log, {"--json", Path("answer.json")});
  EXPECT_EQ(ended.code, kExitUndecided) << ended.out;
  EXPECT_THAT(ended.out,
              AllOf(HasSubstr("status      ambiguous"), HasSubstr("nearly as well elsewhere"),
                    HasSubstr("say where it began with --initial; no trajectory is written")));
  EXPECT_FALSE(std::filesystem::exists(Path("path.tum")));
  const json told = json::parse(std::ifstream(Path("answer.json")));
  EXPECT_NEAR(told["rival"]["pose"][0].get<double>() + told["pose"][0].get<double>(), 12.0, 0.3);
  EXPECT_GE(told["rival"]["explained_here"], told["rival"]["explained"]);
  EXPECT_EQ(Localise(log, at_start_).code, kExitRecommended) << "who is told where it began knows";
}

/// Free and occupied are taken for each other, and edges stay edges.
TEST_F(LocaliseCommandTest, APathThroughWallsIsTold) {
  world::OccupancyGrid turned = RoomsWithShelf();
  for (world::Cell& cell : turned.cells) {
    if (cell == world::Cell::kUnknown) continue;
    cell = cell == world::Cell::kFree ? world::Cell::kOccupied : world::Cell::kFree;
  }
  const std::string log = Log(Drive(101));
  EXPECT_THAT(Localise(log, at_start_).out, Not(HasSubstr("in walls")));
  world::SaveMap(turned, Path("rooms.yaml"));
  const Ended ended = Localise(log, at_start_);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("% of the poses lie in occupied cells"),
                               HasSubstr("`negate` of " + Path("rooms.yaml"))));
}

TEST_F(LocaliseCommandTest, AGapWithoutScansIsTold) {
  SimulatedDrive drive = Drive(101);
  const auto first = drive.log.scans.begin();
  drive.log.scans.erase(first + 100, first + 200);
  EXPECT_THAT(Localise(Log(drive), at_start_).err,
              HasSubstr("no scan for more than 5 s, 1 times, the longest 20.2 s, 19.8 s after"));
}

TEST_F(LocaliseCommandTest, SameSeedGivesTheSameBytesAndAnotherOneOthers) {
  const std::string log = Log(Drive(3));
  std::vector<std::string> texts;
  for (const char* seed : {"5", "5", "6"}) {
    ASSERT_EQ(Localise(log, {"--initial", "2 2 1.57", "--seed", seed}).code, kExitRecommended);
    texts.push_back(base::ReadTextFile(Path("path.tum")));
  }
  EXPECT_EQ(texts[0], texts[1]);
  EXPECT_NE(texts[0], texts[2]);
}

TEST_F(LocaliseCommandTest, RobotThatStandsStaysWhereItWasPut) {
  SimulatedDrive drive = Drive(3);
  for (std::size_t i = 0; i < drive.truth.size(); ++i) {
    drive.log.scans[i].reading = drive.log.scans[0].reading;
    drive.truth[i].X_MB = drive.truth[0].X_MB;
  }
  for (RobotLog::Odometry& odometry : drive.log.odometry) odometry.reading.X_OB = {};
  const std::string log = Log(drive);
  const Ended ended = Localise(log, at_start_);
  ASSERT_EQ(ended.code, kExitRecommended) << ended.err;
  EXPECT_EQ(Trajectory().size(), drive.truth.size());
  EXPECT_LT(ErrorsOf(Trajectory(), drive.truth).worst, 0.3);
}

TEST_F(LocaliseCommandTest, RobotThatStandsAndMayBeAnywhereIsNotFound) {
  SimulatedDrive drive = Drive(3);
  drive.log.scans.resize(1);
  const Ended ended = Localise(Log(drive));
  EXPECT_EQ(ended.code, kExitUndecided) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("never: no trajectory is written"));
  EXPECT_THAT(ended.out, Not(HasSubstr("status      good")));
  EXPECT_FALSE(std::filesystem::exists(Path("path.tum")));
}

TEST_F(LocaliseCommandTest, JumpOfTheOdometryIsToldAndSurvived) {
  SimulatedDrive drive = Drive(3);
  const std::size_t half = drive.log.odometry.size() / 2;
  for (std::size_t i = half; i < drive.log.odometry.size(); ++i) {
    Pose2& X_OB = drive.log.odometry[i].reading.X_OB;
    X_OB = Pose2{40.0, -7.0, 2.0} * X_OB;
  }
  const Ended ended = Localise(Log(drive), at_start_);
  ASSERT_EQ(ended.code, kExitRecommended) << ended.err;
  EXPECT_THAT(ended.out, HasSubstr("not used    odometry jumped 1"));
  EXPECT_THAT(ended.out, Not(HasSubstr("found elsewhere")));
  EXPECT_LT(ErrorsOf(Trajectory(), drive.truth, 4.0).worst, 0.25);
}

TEST_F(LocaliseCommandTest, GapOfTheLaserIsBridgedByOdometry) {
  SimulatedDrive drive = Drive(3);
  const TimedPath truth = drive.truth;
  auto& scans = drive.log.scans;
  scans.erase(scans.begin() + 100, scans.begin() + 150);  // 10 s
  for (std::size_t i = 200; i < 240; ++i) {               // and 8 s in which it saw nothing
    for (float& range : scans[i].reading.ranges) range = 0.0F;
  }
  const Ended ended = Localise(Log(drive), at_start_);
  ASSERT_EQ(ended.code, kExitRecommended) << ended.err << ended.out;
  EXPECT_THAT(ended.out, HasSubstr("not used    nothing measured 40"));
  EXPECT_LT(ErrorsOf(Trajectory(), truth, 4.0).last, 0.15);
  EXPECT_LT(Trajectory().size(), scans.size()) << "after scan_timeout it does not know";
}

TEST_F(LocaliseCommandTest, BadInputIsRefused) {
  const auto refused = [&](const Ended& ended, const std::string& said) {
    EXPECT_EQ(ended.code, kExitBadInput) << said;
    EXPECT_THAT(ended.err, HasSubstr(said));
    EXPECT_EQ(ended.out, "");
  };
  const std::string log = Log(Drive(3)), map = Path("rooms.yaml"), out = Path("path.tum");
  const auto run = [&](const std::vector<std::string>& words) {
    return RunHires({"localise"}, words);
  };
  refused(run({}), "log");
  refused(run({log, "--trajectory", out}), "--map");
  refused(run({log, "--map", map}), "--trajectory");
  refused(run({log, "--map", Path("none.yaml"), "--trajectory", out}), "none.yaml");
  refused(run({log, "--map", map, "--trajectory", Path("none/path")}), "none");
  refused(run({log, "--map", map, "--trajectory", folder_.path().string(), "--initial", "2 2 0"}),
          "cannot be written");
  refused(Localise(log, {"--json", Path("none/answer.json")}), "none");
  refused(Localise(log, {"--seed", "-1"}), "--seed");
  refused(Localise(log, {"--config", Path("none.yaml")}), "none.yaml");
  refused(Localise(log, {"--inital", "0 0 0"}), "--initial");
  refused(Localise(Path("none.log")), "none.log: no such file");
  refused(Localise(Path("drive.bag")),
          "drive.bag: is a bag, which this program does not read "
          "because it was built without ROS");
  refused(Localise(folder_.Write("drive.rec", "#ROSBAG V2.0\n")), "drive.rec: is a bag");
  refused(Localise(log, {"--scan", "/scan"}), "--scan: is for bags, and " + log + " is none");
  refused(Localise(log, {"--laser", "0 0 0"}), "--laser: is for bags");

  refused(Localise(log, {"--initial", "2 2"}), "--initial '2 2': has 2 numbers; wanted three");
  refused(Localise(log, {"--initial", "2 2 north"}), "'north' is no number");
  refused(Localise(log, {"--initial", "2 nan 0"}), "'nan' is no number");
  refused(Localise(log, {"--initial", "2 2 90"}), "90 degrees are 1.5708");
  refused(Localise(log, {"--initial", "-2 1 0"}),
          "(-2, 1) lies outside of " + map + ", which reaches from (0, 0) to (12, 8)");
  refused(Localise(log, {"--initial", ""}), "--initial: an empty text came");

  const auto log_of = [&](const std::string& text) { return folder_.Write("bad.log", text); };
  refused(Localise(log_of("ODOM 0 0 0 0 0 0 1 nohost 1\n")), "bad.log: has no scan");
  refused(Localise(log_of("FLASER 2 1 1 0 0 0 1 nohost 1\n")),
          "bad.log: line 1: FLASER has 10 words; wanted 13");
  refused(Localise(log_of("FLASER 2 1 1 0 0 0 0 nan 0 1 nohost 1\n")),
          "bad.log: line 1: y of the odometry is 'nan'; wanted a number");
  refused(Localise(log_of("FLASER 2 nan 0 0 0 0 0 0 0 1 nohost 1\n")),
          "bad.log: no scan could be used (nothing measured 1)");
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(LocaliseCommandTest, WhatIsReadIsNotWrittenOver) {
  const std::string log = Log(Drive(3)), both = Path("both");
  const std::string before = base::ReadTextFile(log);
  const auto run = [&](const std::string& trajectory, const std::string& json) {
    return RunHires({"localise"},
                    {log, "--map", Path("rooms.yaml"), "--trajectory", trajectory, "--json", json});
  };
  const Ended ended = run(log, Path("rooms.yaml"));
  EXPECT_EQ(ended.code, kExitBadInput);
  EXPECT_THAT(ended.err, AllOf(HasSubstr("--trajectory " + log + ": would write over the log"),
                               HasSubstr("rooms.yaml: would write over the map")));
  EXPECT_EQ(base::ReadTextFile(log), before);
  EXPECT_THAT(run(both, both).err,
              HasSubstr("--trajectory and --json: both " + both + "; name two files"));
  EXPECT_THAT(run("-", "-").err, HasSubstr("--trajectory -: is no file"));
  EXPECT_NE(run("/dev/null", "/dev/null").code, kExitBadInput) << "a device takes several";
}

TEST_F(LocaliseCommandTest, MapsThatTellNothingAreRefused) {
  const std::string log = Log(Drive(3));
  world::OccupancyGrid grid = RoomsWithShelf();
  for (const auto& [cell, said] :
       std::map<world::Cell, std::string>{{world::Cell::kUnknown, "has no free cell"},
                                          {world::Cell::kOccupied, "has no free cell"},
                                          {world::Cell::kFree, "has no occupied cell"}}) {
    grid.cells.assign(grid.cells.size(), cell);
    world::SaveMap(grid, Path("rooms.yaml"));
    for (const std::vector<std::string>& start : {std::vector<std::string>{}, at_start_}) {
      const Ended ended = Localise(log, start);
      EXPECT_EQ(ended.code, kExitBadInput);
      EXPECT_THAT(ended.err, HasSubstr("rooms.yaml: " + said));
    }
  }
}

TEST_F(LocaliseCommandTest, ConfigurationIsReadAndItsErrorsAreNamed) {
  const std::string log = Log(Drive(3));
  const std::string text =
      base::ReadTextFile(std::string(HIRES_SOURCE_DIR) + "/config/localisation.yaml");
  const auto with = [&](const std::string& key, const std::string& line) {
    std::string changed = text;
    const std::size_t begin = changed.find("\n" + key + ":") + 1;
    changed.replace(begin, changed.find('\n', begin) - begin, line);
    return folder_.Write("own.yaml", changed);
  };
  const Ended far_too_many =
      Localise(log, {"--config", with("max_particles", "max_particles: 100")});
  EXPECT_EQ(far_too_many.code, kExitBadInput);
  EXPECT_THAT(far_too_many.err, HasSubstr("own.yaml: max_particles"));
  EXPECT_THAT(Localise(log, {"--config", with("kld_err", "kld_eror: 0.05")}).err,
              HasSubstr("kld_err"));
  const Ended sure = Localise(log, {"--initial", "2 2 1.5708", "--json", "-", "--config",
                                    with("scan_timeout", "scan_timeout: 5.0\nbeam_skip: 1")});
  EXPECT_THAT(sure.err, HasSubstr("beam_skip"));
  const Ended never_good = Localise(log, {"--initial", "2 2 1.5708", "--json", "-", "--config",
                                          with("lost_spread", "lost_spread: 0.01")});
  EXPECT_EQ(never_good.code, kExitUndecided) << never_good.err;
  EXPECT_EQ(json::parse(never_good.out)["status"], "spread");
}

}  // namespace
}  // namespace hires::cli::localise_command_test
