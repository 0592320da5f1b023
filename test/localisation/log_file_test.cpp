#include "hires/localisation/log_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <iterator>
#include <vector>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "hires/robot/odometry_jump.h"
#include "support/rounds.h"
#include "support/temporary_folder.h"

namespace hires::localisation::log_file_test {
namespace {

using geometry::kPi;
using geometry::Pose2;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const char* const kTime = " 976052857.337530 nohost 0.009023\n";

/// FLASER of `n` ranges, laser and odometry at the same place.
std::string FrontLaser(int n, const std::string& time = kTime) {
  std::string line = "FLASER " + std::to_string(n);
  for (int i = 0; i < n; ++i) line += " 2.5";
  return line + " 1 2 0.5 1 2 0.5" + time;
}

std::string At(double time) { return " " + std::to_string(time) + " nohost 0.1\n"; }
std::string OdomAt(double time) { return "ODOM 1 2 0 0 0 0" + At(time); }

class LogFileTest : public testing::Test {
 protected:
  LogFileTest() {
    base::SetLogSink([this](base::LogLevel level, const std::string& line) {
      if (level == base::LogLevel::kWarn) warnings_ += line + "\n";
    });
  }
  ~LogFileTest() override { base::SetLogSink({}); }

  RobotLog Read(const std::string& text) const {
    return ReadCarmenLog(folder_.Write("drive.log", text));
  }
  std::string ErrorOf(const std::string& text) const {
    try {
      Read(text);
    } catch (const base::ConfigError& error) {
      return error.what();
    }
    return "";
  }

  const test_support::TemporaryFolder folder_;
  std::string warnings_;
};

TEST_F(LogFileTest, OdometryAndScansAreReadWithTheirTimes) {
  const RobotLog log = Read(
      "# message_name [message contents] ipc_timestamp ipc_hostname logger_timestamp\n"
      "PARAM robot_frontlaser_offset 0.0 nohost 0\nSYNC begin 1 nohost 1\n\n"
      "ODOM 1.5 -2 0.25 0.4 -0.1 0 10.5 nohost 0.1\r\n"
      "RLASER 1 2 0 0 0 0 0 0 10.55 nohost 0.15\n"
      "FLASER 3 1.0 2.0 3.0 1.7 -2 0 1.5 -2 0 10.6 nohost 0.2\n");
  ASSERT_EQ(log.odometry.size(), 1u);
  EXPECT_EQ(log.odometry[0].time, 10.5);
  EXPECT_EQ(log.odometry[0].reading.X_OB.y, -2.0);
  EXPECT_EQ(log.odometry[0].reading.X_OB.yaw, 0.25);
  EXPECT_EQ(log.odometry[0].reading.V_B.vx, 0.4);
  EXPECT_EQ(log.odometry[0].reading.V_B.wz, -0.1);
  ASSERT_EQ(log.scans.size(), 1u);
  EXPECT_EQ(log.scans[0].time, 10.6);
  EXPECT_EQ(log.scans[0].reading.ranges, (std::vector<float>{1.0F, 2.0F, 3.0F}));
  EXPECT_NEAR(log.scans[0].X_BL.x, 0.2, 1e-12);
  EXPECT_NEAR(log.scans[0].X_BL.y, 0.0, 1e-12);
  EXPECT_EQ(log.scans[0].X_OB->x, 1.5);
  EXPECT_EQ(log.scans[0].reading.range_max, 80.0);
  EXPECT_EQ(warnings_, "");
}

TEST_F(LogFileTest, MountingIsInTheFrameOfTheBase) {
  const RobotLog log = Read("FLASER 1 1 10 20.3 3.0 10 20 1.5707963267948966 5 nohost 1\n");
  EXPECT_NEAR(log.scans.at(0).X_BL.x, 0.3, 1e-9);
  EXPECT_NEAR(log.scans[0].X_BL.y, 0.0, 1e-9);
  EXPECT_NEAR(log.scans[0].X_BL.yaw, 3.0 - kPi / 2, 1e-9);
}

TEST_F(LogFileTest, FrontLaserSeesHalfACircleInWholeSteps) {
  const auto scan = [&](int n) { return Read(FrontLaser(n)).scans.at(0).reading; };
  for (const int n : {180, 181}) {
    EXPECT_EQ(scan(n).angle_min, -kPi / 2) << n;
    EXPECT_NEAR(scan(n).angle_increment, kPi / 180, 1e-15) << n;
  }
  for (const int n : {360, 361}) EXPECT_NEAR(scan(n).angle_increment, kPi / 360, 1e-15) << n;
  EXPECT_NEAR(scan(5).angle_increment, kPi / 4, 1e-15);
  EXPECT_EQ(scan(1).angle_increment, 0.0);
  EXPECT_TRUE(scan(0).ranges.empty());
}

TEST_F(LogFileTest, ItsFieldIsAssumedWhereNoLaserOfHalfACircleHasSuchSteps) {
  const auto is_assumed = [&](int n) { return Read(FrontLaser(n)).scans.at(0).is_field_assumed; };
  for (const int n : {1, 2, 5, 180, 181, 360, 361, 720, 721}) EXPECT_FALSE(is_assumed(n)) << n;
  for (const int n : {342, 682, 1080, 1081}) EXPECT_TRUE(is_assumed(n)) << n;
  EXPECT_FALSE(
      Read("ROBOTLASER1 4 -1.57 3.14 0.0092 30 0.01 0 2 1 2 0 1 0 0 1 0 0 0 0 1 1 9" + At(1))
          .scans.at(0)
          .is_field_assumed);
}

TEST_F(LogFileTest, RobotLaserTellsItsAnglesItself) {
  const RobotLog log =
      Read("ROBOTLASER1 4 -2.35 4.7 2.35 30 0.01 0 3 1 2 3 2 7 8 1.1 0 0 1 0 0 0.5 0.1 1 1 9" +
           At(12.5));
  ASSERT_EQ(log.scans.size(), 1u);
  const robot::ScanReading& scan = log.scans[0].reading;
  EXPECT_EQ(scan.angle_min, -2.35);
  EXPECT_EQ(scan.angle_increment, 2.35);
  EXPECT_EQ(scan.range_max, 30.0);
  EXPECT_EQ(scan.ranges, (std::vector<float>{1.0F, 2.0F, 3.0F}));
  EXPECT_NEAR(log.scans[0].X_BL.x, 0.1, 1e-12);
  EXPECT_EQ(log.scans[0].time, 12.5);
}

TEST_F(LogFileTest, WhatIsNoMeasurementIsKeptAsSuch) {
  const RobotLog log = Read("FLASER 7 nan -1 0 -nan inf 81.91 1e60 0 0 0 0 0 0" + At(1.0));
  const std::vector<float>& ranges = log.scans.at(0).reading.ranges;
  ASSERT_EQ(ranges.size(), 7u);
  for (const int i : {0, 1, 2, 3, 6}) EXPECT_TRUE(std::isnan(ranges[i])) << i;
  EXPECT_TRUE(std::isinf(ranges[4])) << "nothing was met";
  EXPECT_EQ(ranges[5], 81.91F);
}

TEST_F(LogFileTest, LongestRangeIsTheOneTheLogTells) {
  const RobotLog log = Read("PARAM robot_front_laser_max 8.1 nohost 0\n" + FrontLaser(2));
  EXPECT_EQ(log.scans.at(0).reading.range_max, 8.1);
}

TEST_F(LogFileTest, ScansBringTheOdometryWhereNobodyElseDoes) {
  const RobotLog log = Read("FLASER 1 1 0 0 0 0 0 0" + At(1.0) + "FLASER 1 1 0.5 0 0 0.5 0 0" +
                            At(2.0) + "FLASER 1 1 0.5 0 0.2 0.5 0 0.2" + At(2.0));
  ASSERT_EQ(log.odometry.size(), 3u);
  EXPECT_EQ(log.odometry[0].reading.V_B.vx, 0.0);
  EXPECT_EQ(log.odometry[1].reading.V_B.vx, 0.5);
  EXPECT_EQ(log.odometry[2].reading.V_B.vx, 0.5) << "no time has passed";
  EXPECT_EQ(log.odometry[2].reading.X_OB.yaw, 0.2);
}

TEST_F(LogFileTest, LinesALittleLateAreOrderedAndToldOf) {
  const RobotLog log = Read(OdomAt(5.0) + OdomAt(4.5) + OdomAt(5.0) + FrontLaser(1, At(1.0)));
  ASSERT_EQ(log.odometry.size(), 3u);
  EXPECT_EQ(log.odometry[0].time, 4.5);
  EXPECT_THAT(warnings_, HasSubstr("1 lines are older than one before them, by up to 0.500 s"));
}

TEST_F(LogFileTest, CorrectedLogHasItsLaserWhereAParameterSays) {
  const std::string lines = "FLASER 1 1 0 0 0 0 0 0" + At(1.0) + "FLASER 1 1 5 0 0 4 0 0" + At(2.0);
  const RobotLog log = Read("PARAM robot_frontlaser_offset 0.25 nohost 0\n" + lines);
  EXPECT_THAT(warnings_, HasSubstr("not the same in all lines"));
  for (const RobotLog::Scan& scan : log.scans) {
    EXPECT_EQ(scan.X_BL.x, 0.25);
    EXPECT_EQ(scan.X_BL.yaw, 0.0);
  }
  EXPECT_EQ(log.odometry[1].reading.X_OB.x, 4.0) << "odometry stays as it was";
}

/// Line i of a robot that goes ahead, by the laser at that place.
std::string ScanFrom(const Pose2& X_BL, int i) {
  const Pose2 X_OB{0.1 * i, 0.05 * i, 0.03 * i}, X_OL = X_OB * X_BL;
  return fmt::format("FLASER 1 1 {:.6f} {:.6f} {:.6f} {:.6f} {:.6f} {:.6f}", X_OL.x, X_OL.y,
                     X_OL.yaw, X_OB.x, X_OB.y, X_OB.yaw) +
         At(0.1 * i);
}

TEST_F(LogFileTest, SeveralLasersOfOneNameKeepTheirPlaces) {
  const std::vector<Pose2> all{
      {0.2, 0.0, 0.0}, {-0.3, 0.1, kPi}, {0.0, 0.25, kPi / 2}, {0.0, -0.25, -kPi / 2}};
  for (std::size_t count = 2; count <= all.size(); ++count) {
    std::string text;
    for (int i = 0; i < 80; ++i) text += ScanFrom(all[i % count], i);
    warnings_.clear();
    const RobotLog log = Read(text);
    EXPECT_THAT(warnings_, HasSubstr("lines FLASER are of several lasers"));
    EXPECT_THAT(warnings_, HasSubstr(" from (-0.300 0.100 "));
    ASSERT_EQ(log.scans.size(), 80u);
    for (std::size_t i = 0; i < log.scans.size(); ++i) {
      EXPECT_NEAR(log.scans[i].X_BL.x, all[i % count].x, 1e-5);
      EXPECT_NEAR(log.scans[i].X_BL.y, all[i % count].y, 1e-5);
    }
  }
}

/// However slowly the corrected pose drifts away, and however rare another place is.
TEST_F(LogFileTest, PlacesThatDriftOrAreRareAreNoLasers) {
  for (const double drift : {0.001, 0.01, 0.03}) {
    std::string text;
    for (int i = 0; i < 80; ++i) text += ScanFrom({0.2 + drift * i, 0.0, 0.0}, i);
    warnings_.clear();
    const RobotLog log = Read("PARAM robot_frontlaser_offset 0.25 nohost 0\n" + text);
    EXPECT_THAT(warnings_, HasSubstr("not the same in all lines")) << drift;
    EXPECT_EQ(log.scans.back().X_BL.x, 0.25) << drift;
  }
  std::string text;
  for (int i = 0; i < 80; ++i) text += ScanFrom({i == 40 ? -0.2 : 0.2, 0.0, 0.0}, i);
  warnings_.clear();
  Read(text);
  EXPECT_THAT(warnings_, HasSubstr("not the same in all lines"));
}

/// A drive as a logger writes it: ODOM and FLASER by turns, each with its time.
struct Drive {
  explicit Drive(base::Rng rng) {
    Pose2 X_OB{rng.Uniform(-5.0, 5.0), 0.0, rng.Uniform(-kPi, kPi)};
    double time = 1.0e9;
    for (int i = 0; i < 60; ++i) {
      X_OB = X_OB * Pose2{rng.Uniform(0.0, 0.2), 0.0, rng.Uniform(-0.2, 0.2)};
      poses.push_back(X_OB);
      times.push_back(time += rng.Uniform(0.1, 0.4));
    }
  }
  /// @param time_text  how a time is written.  @param scan_pose  what a scan says of its own place.
  std::string Text(const std::function<std::string(double)>& time_text,
                   const std::function<Pose2(const Pose2&)>& scan_pose = {},
                   const std::string& behind_scan = "") const {
    std::string text;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Pose2 own = scan_pose ? scan_pose(poses[i]) : poses[i];
      const std::string place = fmt::format("{} {} {}", own.x, own.y, own.yaw);
      const std::string end = fmt::format(" {} nohost 0\n", time_text(times[i]));
      text += fmt::format("ODOM {} {} {} 0 0 0", poses[i].x, poses[i].y, poses[i].yaw) + end;
      text += fmt::format("FLASER 2 1.5 2.5 {} {}", place, place) + end;
      if (!behind_scan.empty()) text += fmt::format(fmt::runtime(behind_scan), place);
    }
    return text;
  }
  std::vector<Pose2> poses;
  std::vector<double> times;
};

std::string Exactly(double time) { return fmt::format("{:.6f}", time); }

TEST_F(LogFileTest, TimesThatDoNotAdvanceAreMadeUpInTheOrderOfLines) {
  const std::function<std::string(double)> kinds[] = {
      [](double) { return std::string("0"); },
      [](double time) { return fmt::format("{:.6g}", time); },
      [](double time) { return fmt::format("{:.0f}", std::floor(time)); },
      [](double time) { return fmt::format("{:.0f}", 10.0 * std::floor(time / 10.0)); }};
  for (int round = 0; round < hires::test_support::Rounds(40); ++round) {
    SCOPED_TRACE(round);
    const Drive drive(base::Rng(5).Fork(round));
    warnings_.clear();
    const RobotLog log = Read(drive.Text(kinds[round % 4]));
    EXPECT_THAT(warnings_, HasSubstr("times do not advance"));
    ASSERT_EQ(log.odometry.size(), drive.poses.size());
    ASSERT_EQ(log.scans.size(), drive.poses.size());
    for (std::size_t i = 0; i < log.odometry.size(); ++i) {
      EXPECT_EQ(log.odometry[i].reading.X_OB.x, drive.poses[i].x) << "in the order of lines";
      EXPECT_GT(log.scans[i].time, log.odometry[i].time);
      if (i == 0) continue;
      const double passed = log.odometry[i].time - log.odometry[i - 1].time;
      EXPECT_GT(log.odometry[i].time, log.scans[i - 1].time);
      EXPECT_FALSE(robot::IsOdometryJump(drive.poses[i - 1].Inverse() * drive.poses[i], passed,
                                         robot::kFastestDrive, robot::kFastestTurn));
    }
  }
}

TEST_F(LogFileTest, TimesThatAdvanceStayAsTheyAre) {
  const Drive drive(base::Rng(6));
  const RobotLog log = Read(drive.Text(Exactly));
  EXPECT_EQ(warnings_, "");
  for (std::size_t i = 0; i < log.scans.size(); ++i)
    EXPECT_NEAR(log.scans[i].time, drive.times[i], 1e-6);
}

TEST_F(LogFileTest, PosesOfScansThatContradictTheOdometryAreLeftOut) {
  const std::function<Pose2(const Pose2&)> kinds[] = {
      [](const Pose2&) { return Pose2{}; },
      [](const Pose2& X_OB) {
        return Pose2{3.0 * X_OB.x, 3.0 * X_OB.y, X_OB.yaw};
      }};
  const Drive drive(base::Rng(7));
  for (const auto& own : kinds) {
    warnings_.clear();
    const RobotLog log = Read(drive.Text(Exactly, own));
    EXPECT_THAT(warnings_, HasSubstr("odometry is that of the lines ODOM"));
    for (const RobotLog::Scan& scan : log.scans) EXPECT_FALSE(scan.X_OB);
  }
  warnings_.clear();
  const Pose2 elsewhere{7.0, -3.0, 2.0};  // another frame is no contradiction
  const RobotLog log = Read(drive.Text(Exactly, [&](const Pose2& X) { return elsewhere * X; }));
  EXPECT_EQ(warnings_, "");
  for (const RobotLog::Scan& scan : log.scans) EXPECT_TRUE(scan.X_OB);
}

TEST_F(LogFileTest, WhatAMapperWroteBehindEachScanIsPassedOver) {
  const Drive drive(base::Rng(8));
  const RobotLog plain = Read(drive.Text(Exactly));
  const RobotLog log =
      Read(drive.Text(Exactly, {}, "ODOM {} 0 0 0 0 nohost 0\nNEFF 12.5 0 nohost 0\n"));
  EXPECT_THAT(warnings_, HasSubstr("60 lines ODOM of time 0 repeat the pose of the scan"));
  ASSERT_EQ(log.odometry.size(), plain.odometry.size());
  for (std::size_t i = 0; i < log.odometry.size(); ++i)
    EXPECT_EQ(log.odometry[i].time, plain.odometry[i].time);
}

TEST_F(LogFileTest, OneKindOfScansIsTaken) {
  const RobotLog log =
      Read(FrontLaser(2, At(1.0)) + "ROBOTLASER1 0 0 0 0.1 9 0 0 1 5 0 0 0 0 0 0 0 0 0 0 0 0" +
           At(1.0) + "IMU 1 2 3" + At(1.0));
  EXPECT_EQ(log.scans.size(), 1u);
}

TEST_F(LogFileTest, MessagesOfOtherNamesArePassedOverWhateverTheirCase) {
  const RobotLog log = Read("raw_laser_3 1 2\nTruePos 1 2 3" + At(1.0) + "odom 9 9 9\n" +
                            OdomAt(1.0) + "NMEA_GGA $GPGGA,1\n" + OdomAt(2.0));
  EXPECT_EQ(log.odometry.size(), 2u);
  EXPECT_EQ(warnings_, "");
}

TEST_F(LogFileTest, LastLineThatIsCutOffIsPassedOverAndToldOf) {
  const std::string whole = FrontLaser(2, At(1.0)) + OdomAt(1.0);
  const std::string last = "FLASER 2 2.5 2.5 1 2 0.5 1 2 0.5 1.2 nohost 0.3";
  EXPECT_EQ(Read(whole + last).scans.size(), 2u) << "an end of line alone may be missing";
  EXPECT_EQ(warnings_, "");
  for (std::size_t length = std::strlen("FLASER"); length < last.size() - std::strlen(" 0.3");
       ++length) {
    for (const char* end : {"", "\n", "\r\n \n"}) {
      warnings_.clear();
      const RobotLog log = Read(whole + last.substr(0, length) + end);
      EXPECT_EQ(log.scans.size(), 1u) << length;
      EXPECT_EQ(log.odometry.size(), 1u);
      EXPECT_THAT(warnings_, HasSubstr("drive.log: line 3: ")) << length;
      EXPECT_THAT(warnings_, HasSubstr("cut off: passed over")) << length;
    }
  }
  EXPECT_THAT(ErrorOf(last.substr(0, 30)), HasSubstr("drive.log: line 1: FLASER has"))
      << "nothing is left";
}

/// Lines of odometry, the given one after the third.
std::string ManyLines(int count, const std::string& odd) {
  std::string text;
  for (int i = 0; i < count; ++i) text += OdomAt(1.0 + 0.1 * i) + (i == 2 ? odd : "");
  return text;
}

TEST_F(LogFileTest, OddLinesArePassedOverUpToAHundredth) {
  const std::string many = "ODOM 1 2 0 0 0 0 7 1.0 nohost 1\n";
  for (const std::string& odd :
       {many, std::string("ODOM 1 2") + At(1.0), std::string("FLASER 2 1 x 0 0 0 0 0 0") + At(1.0),
        std::string("ROBOTLASER1 4 0 3\n"), std::string("<html>\n"), std::string("\x01\x02\n"),
        OdomAt(0.1)}) {
    warnings_.clear();
    EXPECT_EQ(Read(ManyLines(99, odd)).odometry.size(), 99u) << odd;
    EXPECT_THAT(warnings_, HasSubstr("drive.log: line 4: ")) << odd;
    EXPECT_THAT(warnings_, HasSubstr("passed over, like 0 more lines")) << odd;
    EXPECT_THAT(ErrorOf(ManyLines(98, odd)), HasSubstr("drive.log: line 4: ")) << odd;
  }
  warnings_.clear();
  EXPECT_EQ(Read(ManyLines(198, many + "<html>\n")).odometry.size(), 198u);
  EXPECT_THAT(warnings_, HasSubstr("line 4: ODOM has 11 words; wanted 10"));
  EXPECT_THAT(warnings_, HasSubstr("passed over, like 1 more lines"));
  EXPECT_THAT(ErrorOf(ManyLines(197, many + "<html>\n")),
              HasSubstr("line 4: ODOM has 11 words; wanted 10: ODOM x y theta tv rv accel, "
                        "ipc_timestamp hostname logger_timestamp; 1 more lines cannot be read, "
                        "beside 197 that can: passed over are 1 % at most"));
}

TEST_F(LogFileTest, KindOfScansIsThatOfTheFirstWholeLine) {
  EXPECT_EQ(Read("FLASER 2 1\n" + ManyLines(99,
                                            "ROBOTLASER1 0 0 0 0.1 9 0 0 1 5 0 0 0 0 0 0 0 0 0 "
                                            "0 0 0" +
                                                At(1.0)))
                .scans.size(),
            1u);
}

TEST_F(LogFileTest, WhatIsNoLogAtAllIsRefusedEarly) {
  std::string text = "<html>\n";
  for (int i = 0; i < 2000; ++i) text += "<p>\n";
  const std::string line = OdomAt(1.0);
  for (int i = 0; i < 300000; ++i) text += line;
  EXPECT_THAT(ErrorOf(text), HasSubstr("line 1: '<html>' begins no line"));
}

TEST_F(LogFileTest, BadInputIsRefusedWithItsLine) {
  const auto refused = [&](const std::string& text, const std::string& said) {
    EXPECT_THAT(ErrorOf(text), HasSubstr(said)) << text.substr(0, 100);
  };
  EXPECT_THAT(ErrorOf("\nODOM 1 2" + At(1.0)), HasSubstr("drive.log: line 2: ODOM has 6 words"));
  refused("", "has no line FLASER, ROBOTLASER1 or ODOM");
  refused("# HIRES\n", "has no line FLASER");
  refused("PARAM robot_length 0.7 nohost 0\n", "has no line FLASER");
  refused("HIRES lets a robot imagine\n\nmore\n", "ROBOTLASER1 or ODOM, but HIRES, more; wanted");
  refused("{\"a\": 1}\n", "'{\"a\":' begins no line");
  refused(std::string("\x01\x02\0\n", 4), "line 1: is no text; wanted a CARMEN log: is the file");
  refused("ODOM 1 2 0 0 0 0 10.0 nohost\n", "ODOM has 9 words; wanted 10");
  refused("ODOM 1 2 0 0 0 0 7 10.0 nohost 1\n", "ODOM has 11 words; wanted 10");
  refused("ODOM x 2 0 0 0 0" + At(1.0), "x of the odometry is 'x'; wanted a number");
  refused("ODOM 1 nan 0 0 0 0" + At(1.0), "y of the odometry is 'nan'");
  refused("ODOM 1 2 inf 0 0 0" + At(1.0), "theta of the odometry is 'inf'");
  refused("ODOM 1e9 2 0 0 0 0" + At(1.0), "x of the odometry is '1e9'");
  refused("ODOM 1 2 0 fast 0 0" + At(1.0), "tv is 'fast'");
  refused("ODOM 1 2 0 0 0,5 0" + At(1.0), "rv is '0,5'");
  refused("ODOM 1 2 0 0 0 0 soon nohost 1\n", "ipc_timestamp is 'soon'");
  refused("ODOM 1 2 0 0 0 0 nan nohost 1\n", "ipc_timestamp is 'nan'");
  refused("ODOM 1 2 0 0 0 0 1 nohost late\n", "logger_timestamp is 'late'");
  refused(OdomAt(5.0) + OdomAt(3.9), "line 2: ipc_timestamp 3.900000 is 1.100 s before");
  refused(FrontLaser(2, At(9.0)) + OdomAt(3.0) + FrontLaser(2, At(3.0)), "line 3: ipc_timestamp");
  refused("PARAM robot_frontlaser_offset far nohost 0\n", "robot_frontlaser_offset is 'far'");
  refused("PARAM robot_front_laser_max 0 nohost 0\n", "robot_front_laser_max is '0'");
}

TEST_F(LogFileTest, BadScansAreRefused) {
  const auto refused = [&](const std::string& text, const std::string& said) {
    EXPECT_THAT(ErrorOf(text), HasSubstr(said)) << text.substr(0, 100);
  };
  refused("FLASER\n", "FLASER ends before its number of ranges");
  refused("FLASER many 1\n", "number of ranges is 'many'; wanted a whole number");
  refused("FLASER -1 1\n", "number of ranges is '-1'");
  refused("FLASER 2.5 1\n", "number of ranges is '2.5'");
  refused("FLASER 100001 1\n",
          "number of ranges is '100001'; wanted a whole number from 0 to 1000");
  refused("FLASER 99999999999999999999 1\n", "number of ranges is '9999");
  refused("FLASER 3 1 2 0 0 0 0 0 0" + At(1.0), "FLASER has 13 words; wanted 14");
  refused("FLASER 1 1 2 0 0 0 0 0 0" + At(1.0), "FLASER has 13 words; wanted 12");
  refused("FLASER 1 1m 0 0 0 0 0 0" + At(1.0), "range 1 is '1m'; wanted a number [m]");
  refused("FLASER 1 1 0 0 nan 0 0 0" + At(1.0), "theta of the pose of the laser is 'nan'");
  const std::string poses = " 0 0 0 0 0 0 0 0 0 0 0" + At(1.0);
  refused("ROBOTLASER1 4 0 3\n", "ROBOTLASER1 ends before its number of ranges");
  refused("ROBOTLASER1 4 0 3 1 9 0 0 2 1\n", "ends before its number of remissions");
  refused("ROBOTLASER1 4 x 3 1 9 0 0 2 1 1 0" + poses, "start_angle is 'x'");
  refused("ROBOTLASER1 4 0 0 0 9 0 0 2 1 1 0" + poses, "angular resolution and fov are 0");
  refused("ROBOTLASER1 4 0 3 1 -9 0 0 2 1 1 0" + poses, "max_range is '-9'");
  refused("ROBOTLASER1 4 0 3 1 9 0 0 2 1 1 2" + poses, "ROBOTLASER1 has 26 words; wanted 28");
  EXPECT_EQ(ErrorOf("ROBOTLASER1 4 0 3 1 9 0 0 2 1 1 0" + poses), "");
}

TEST_F(LogFileTest, MissingFilesAreNamed) {
  const std::string none = (folder_.path() / "none.log").string();
  try {
    ReadCarmenLog(none);
    FAIL() << "was read";
  } catch (const base::ConfigError& error) {
    EXPECT_THAT(error.what(), StartsWith(none));
  }
}

TEST_F(LogFileTest, LogsAreReadAsTheyWereWritten) {
  RobotLog log;
  for (int i = 0; i < 3; ++i) {
    const Pose2 X_OB{1.0 + 0.1 * i, -2.0, 0.5};
    log.odometry.push_back({10.0 + i, {X_OB, {0.3, 0.0, -0.2}}});
    if (i == 1) continue;
    RobotLog::Scan scan{10.0 + i, {0.3, 0.1, 0.2}, {}, X_OB};
    scan.reading = {-1.5, 0.75, 0.05, {1.0F, std::nanf(""), INFINITY, 0.01F, 2.5F}, 8.0};
    log.scans.push_back(scan);
  }
  const std::string file = (folder_.path() / "drive.log").string();
  WriteCarmenLog(log, file);
  const RobotLog again = ReadCarmenLog(file);
  EXPECT_EQ(warnings_, "");
  ASSERT_EQ(again.odometry.size(), 3u);
  EXPECT_EQ(again.odometry[2].time, 12.0);
  EXPECT_NEAR(again.odometry[2].reading.X_OB.x, 1.2, 1e-9);
  EXPECT_EQ(again.odometry[2].reading.V_B.wz, -0.2);
  ASSERT_EQ(again.scans.size(), 2u);
  const RobotLog::Scan& scan = again.scans[1];
  EXPECT_EQ(scan.time, 12.0);
  EXPECT_NEAR(scan.X_BL.x, 0.3, 1e-6);
  EXPECT_NEAR(scan.X_BL.yaw, 0.2, 1e-6);
  EXPECT_NEAR(scan.X_OB->x, 1.2, 1e-9);
  EXPECT_EQ(scan.reading.angle_min, -1.5);
  EXPECT_EQ(scan.reading.angle_increment, 0.75);
  EXPECT_EQ(scan.reading.range_max, 8.0);
  ASSERT_EQ(scan.reading.ranges.size(), 5u);
  EXPECT_EQ(scan.reading.ranges[0], 1.0F);
  EXPECT_TRUE(std::isnan(scan.reading.ranges[1]));
  EXPECT_EQ(scan.reading.ranges[2], 8.0F) << "met nothing";
  EXPECT_TRUE(std::isnan(scan.reading.ranges[3])) << "below its range_min";
  EXPECT_EQ(scan.reading.ranges[4], 2.5F);
  log.scans[0].X_OB.reset();
  EXPECT_THROW(WriteCarmenLog(log, file), std::logic_error);
}

TEST_F(LogFileTest, TrajectoriesAreWrittenAsOthersReadThem) {
  const std::string file = (folder_.path() / "path.tum").string();
  WriteTumTrajectory({{976052857.33753, {1.0, -2.0, 0.0}}, {976052858.0, {1.5, 0.0, kPi / 2}}},
                     file);
  std::ifstream in(file);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  EXPECT_EQ(text,
            "976052857.337530 1.000000 -2.000000 0 0 0 0.000000000 1.000000000\n"
            "976052858.000000 1.500000 0.000000 0 0 0 0.707106781 0.707106781\n");
  EXPECT_THROW(WriteTumTrajectory({}, (folder_.path() / "none" / "path.tum").string()),
               base::ConfigError);
  EXPECT_THROW(WriteTumTrajectory({{0.0, {std::nan(""), 0.0, 0.0}}}, file), std::logic_error);
}

}  // namespace
}  // namespace hires::localisation::log_file_test
