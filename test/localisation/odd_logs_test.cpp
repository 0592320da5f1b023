#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/rng.h"
#include "hires/geometry/angles.h"
#include "hires/localisation/log_file.h"
#include "support/rounds.h"
#include "support/temporary_folder.h"

namespace hires::localisation::odd_logs_test {
namespace {

using geometry::kPi;
using geometry::Pose2;
using hires::test_support::Rounds;
using ::testing::AllOf;
using ::testing::HasSubstr;

struct Moment {
  Pose2 X_OB;
  double time;
};

/// Some metres, turned both on the way and on the spot.
std::vector<Moment> DrawDrive(base::Rng rng) {
  std::vector<Moment> drive;
  Moment moment{{rng.Uniform(-5.0, 5.0), 0.0, rng.Uniform(-kPi, kPi)}, 1.0e9};
  for (int i = 0; i < 120; ++i) {
    const bool is_turn = i % 40 > 25;
    moment.X_OB = moment.X_OB * Pose2{is_turn ? 0.0 : rng.Uniform(0.03, 0.15), 0.0,
                                      is_turn ? rng.Uniform(0.1, 0.3) : rng.Normal(0.0, 0.01)};
    moment.time += rng.Uniform(0.15, 0.25);
    drive.push_back(moment);
  }
  return drive;
}

/// How a drive is written.
struct Form {
  std::string kind{"FLASER"};
  int num_ranges{5};
  double metre{1.0}, radian{1.0}, second{1.0};  // in what the file counts
  std::string head;                             // of the laser's line, before its ranges
  std::string tail;                             // behind its poses
  std::string number{"{:.6f}"};
};

std::vector<std::string> LinesOf(const std::vector<Moment>& drive, const Form& form) {
  const auto number = [&](double value) { return fmt::format(fmt::runtime(form.number), value); };
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    const Pose2& X = drive[i].X_OB;
    const std::string pose = fmt::format("{} {} {}", number(form.metre * X.x),
                                         number(form.metre * X.y), number(form.radian * X.yaw));
    const std::string time = number(form.second * drive[i].time);
    const std::string end = fmt::format(" {} nohost {}", time, time);
    std::string ranges;
    for (int k = 0; k < form.num_ranges; ++k) ranges += " " + number(1.0 + 0.01 * k + 0.003 * i);
    lines.push_back(fmt::format("ODOM {} 0 0 0", pose) + end);
    lines.push_back(fmt::format("{} {}{}{} {} {}{}", form.kind, form.head, form.num_ranges, ranges,
                                form.tail.empty() ? pose : "0 " + pose, pose, form.tail) +
                    end);
  }
  return lines;
}

Form RobotLaser(int num_ranges, double start, double fov, double resolution) {
  Form form;
  form.kind = "ROBOTLASER1";
  form.num_ranges = num_ranges;
  form.head = fmt::format("0 {:.6f} {:.6f} {:.6f} 30 0.01 0 ", start, fov, resolution);
  form.tail = " 0 0 0 0 0";
  return form;
}

std::string TextOf(const std::vector<std::string>& lines, const std::string& end = "\n") {
  std::string text;
  for (const std::string& line : lines) text += line + end;
  return text;
}

class OddLogsTest : public testing::Test {
 protected:
  OddLogsTest() {
    base::SetLogSink([this](base::LogLevel level, const std::string& line) {
      if (level == base::LogLevel::kWarn) warnings_ += line + "\n";
    });
  }
  ~OddLogsTest() override { base::SetLogSink({}); }

  RobotLog Read(const std::string& text) {
    warnings_.clear();
    return ReadCarmenLog(folder_.Write("drive.log", text));
  }
  std::string ErrorOf(const std::string& text) {
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

void ExpectSame(const RobotLog& log, const RobotLog& plain) {
  ASSERT_EQ(log.odometry.size(), plain.odometry.size());
  ASSERT_EQ(log.scans.size(), plain.scans.size());
  for (std::size_t i = 0; i < log.odometry.size(); ++i) {
    EXPECT_EQ(log.odometry[i].time, plain.odometry[i].time);
    EXPECT_EQ(log.odometry[i].reading.X_OB.x, plain.odometry[i].reading.X_OB.x);
  }
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    EXPECT_EQ(log.scans[i].reading.ranges, plain.scans[i].reading.ranges);
    EXPECT_TRUE(log.scans[i].X_OB);
  }
}

TEST_F(OddLogsTest, FormsOfTheSameDriveAreReadAlike) {
  for (int seed = 1; seed <= Rounds(12); ++seed) {
    const std::vector<Moment> drive = DrawDrive(base::Rng(seed));
    const std::vector<std::string> lines = LinesOf(drive, {});
    const RobotLog plain = Read(TextOf(lines));
    EXPECT_EQ(warnings_, "");
    ExpectSame(Read(TextOf(lines, "\r")), plain);  // an old Mac's ends of lines
    EXPECT_EQ(warnings_, "");
    Form signs;
    signs.number = "{:+.6f}";
    ExpectSame(Read(TextOf(LinesOf(drive, signs))), plain);
    EXPECT_EQ(warnings_, "");
    std::vector<std::string> by_kind = lines;
    std::stable_partition(by_kind.begin(), by_kind.end(),
                          [](const std::string& line) { return line[0] == 'O'; });
    ExpectSame(Read(TextOf(by_kind)), plain);
    EXPECT_EQ(warnings_, "");
    std::vector<std::string> twice;
    for (std::size_t i = 0; i < lines.size(); ++i) twice.insert(twice.end(), 2 + i % 2, lines[i]);
    ExpectSame(Read(TextOf(twice)), plain);
    EXPECT_THAT(warnings_, HasSubstr("360 lines are equal to the one before"));
    EXPECT_EQ(warnings_.find("do not advance"), std::string::npos);
  }
}

TEST_F(OddLogsTest, OdometryInAnotherUnitIsAskedAbout) {
  for (int seed = 1; seed <= Rounds(12); ++seed) {
    const std::vector<Moment> drive = DrawDrive(base::Rng(seed));
    for (const std::string kind : {"both", "scans"}) {
      const auto warned = [&](const Form& form) {
        std::vector<std::string> lines = LinesOf(drive, form);
        if (kind == "scans") {
          lines.erase(std::remove_if(lines.begin(), lines.end(),
                                     [](const std::string& line) { return line[0] == 'O'; }),
                      lines.end());
        }
        Read(TextOf(lines));
        return warnings_;
      };
      Form form;
      EXPECT_EQ(warned(form), "");
      form.metre = 1000.0;
      EXPECT_THAT(warned(form), HasSubstr("is it in millimetres? Divide x and y by 1000"));
      form.metre = 100.0;
      EXPECT_THAT(warned(form), HasSubstr("is it in centimetres? Divide x and y by 100\n"));
      form.metre = 1.0;
      form.radian = 180.0 / kPi;
      EXPECT_THAT(warned(form), HasSubstr("is theta in degrees? Multiply it by 0.0174533"));
    }
  }
}

/// A turn whose lines are written at its end, and stamped then, is fast by its stamps alone.
TEST_F(OddLogsTest, BurstsAreNoOtherUnit) {
  for (int seed = 1; seed <= Rounds(12); ++seed) {
    std::vector<Moment> drive = DrawDrive(base::Rng(seed));
    for (std::size_t first = 25; first + 14 < drive.size(); first += 40) {
      for (std::size_t i = first + 1; i < first + 14; ++i)
        drive[i].time = drive[first + 14].time - 0.001 * static_cast<double>(first + 14 - i);
    }
    Read(TextOf(LinesOf(drive, {})));
    EXPECT_EQ(warnings_, "") << seed;
  }
}

TEST_F(OddLogsTest, TimesInAnotherUnitAreAskedAbout) {
  const std::vector<Moment> drive = DrawDrive(base::Rng(1));
  for (const auto& [factor, unit] :
       {std::pair<double, const char*>{1e3, "milliseconds? Divide it by 1e3"},
        {1e6, "microseconds? Divide it by 1e6"},
        {1e9, "nanoseconds? Divide it by 1e9"}}) {
    Form form;
    form.second = factor;
    form.number = "{:.3f}";
    EXPECT_THAT(ErrorOf(TextOf(LinesOf(drive, form))), HasSubstr(unit));
  }
}

TEST_F(OddLogsTest, AnglesThatDisagreeAreTakenByWhatGoesWithTheFirstBeam) {
  for (int seed = 1; seed <= Rounds(24); ++seed) {
    base::Rng rng(seed);
    const std::vector<Moment> drive = DrawDrive(rng);
    const double fov = rng.Uniform(1.0, 5.0);
    const int n = 20 + seed;
    const double step = fov / (n - 1);
    const auto increment = [&](const Form& form) {
      return Read(TextOf(LinesOf(drive, form))).scans.front().reading.angle_increment;
    };
    EXPECT_NEAR(increment(RobotLaser(n, -fov / 2, fov, step)), step, 1e-5);
    EXPECT_NEAR(increment(RobotLaser(n, -fov / 2, fov + step, step)), step, 1e-5);
    EXPECT_NEAR(increment(RobotLaser(n, fov / 2, fov, -step)), -step, 1e-5);
    EXPECT_NEAR(increment(RobotLaser(n, -fov / 2, 0.0, step)), step, 1e-5);
    EXPECT_EQ(warnings_, "");
    EXPECT_NEAR(increment(RobotLaser(n, -fov / 2, fov, 0.0)), step, 1e-5);
    EXPECT_THAT(warnings_, HasSubstr("taken is the fov"));
    const double other = step * (seed % 2 ? 2.0 : 0.5);
    EXPECT_NEAR(increment(RobotLaser(n, -fov / 2, fov, other)), step, 1e-5);
    EXPECT_THAT(warnings_, AllOf(HasSubstr("line 2: ROBOTLASER1"), HasSubstr("taken is the fov")));
    EXPECT_NEAR(increment(RobotLaser(n, -fov / 2, 0.5 * fov, step)), step, 1e-5);
    EXPECT_THAT(warnings_, HasSubstr("taken is the resolution"));
  }
  EXPECT_THAT(ErrorOf(TextOf(LinesOf(DrawDrive(base::Rng(1)), RobotLaser(9, -90, 180, 22.5)))),
              HasSubstr("line 2: start_angle is '-90.000000'; wanted radians, a number from "
                        "-6.28319 to 6.28319: are the angles in degrees?"));
}

TEST_F(OddLogsTest, FrontLasersOfUnusualNumbersAreSaidToBeTakenAsHalfACircle) {
  const std::vector<Moment> drive = DrawDrive(base::Rng(1));
  Form form;
  for (const int usual : {90, 91, 180, 181, 360, 361, 720, 721}) {
    form.num_ranges = usual;
    Read(TextOf(LinesOf(drive, form)));
    EXPECT_EQ(warnings_, "");
  }
  for (const int unusual : {401, 541, 682, 683, 769, 1081}) {
    form.num_ranges = unusual;
    Read(TextOf(LinesOf(drive, form)));
    EXPECT_THAT(warnings_,
                HasSubstr(fmt::format("line 2: FLASER of {} ranges says no angles; taken "
                                      "are steps of 180 degrees / {}",
                                      unusual, unusual - unusual % 2)));
  }
}

TEST_F(OddLogsTest, LogsOfOtherLasersAloneAreSaidToHaveThem) {
  const std::vector<Moment> drive = DrawDrive(base::Rng(1));
  for (const char* kind : {"RLASER", "ROBOTLASER2", "RAWLASER1"}) {
    Form form;
    form.kind = kind;
    EXPECT_TRUE(Read(TextOf(LinesOf(drive, form))).scans.empty());
    EXPECT_THAT(warnings_, HasSubstr(fmt::format("are not read: 120 {};", kind)));
  }
}

/// Line RAWLASER1 of each moment.
std::vector<std::string> RawLinesOf(const std::vector<Moment>& drive) {
  std::vector<std::string> lines;
  for (const Moment& moment : drive)
    lines.push_back(fmt::format("RAWLASER1 0 -1 2 1 30 0.01 0 3 1.5 2.5 3.5 0 {:.6f} nohost 0",
                                moment.time + 0.05));
  return lines;
}

TEST_F(OddLogsTest, ScansWithoutPosesGetTheOdometryOfTheLinesAroundThem) {
  const std::vector<Moment> drive = DrawDrive(base::Rng(1));
  std::string text = "PARAM robot_frontlaser_offset 0.25 nohost 0\n";
  const std::vector<std::string> both = LinesOf(drive, {}), raw = RawLinesOf(drive);
  for (std::size_t i = 0; i < drive.size(); ++i) text += both[2 * i] + "\n" + raw[i] + "\n";
  const RobotLog log = Read(text);
  EXPECT_THAT(warnings_, HasSubstr("120 lines RAWLASER1 tell no poses"));
  EXPECT_THAT(warnings_, HasSubstr("0.25 m before the base"));
  ASSERT_EQ(log.scans.size(), 120u);
  EXPECT_EQ(log.scans[7].reading.ranges, (std::vector<float>{1.5F, 2.5F, 3.5F}));
  EXPECT_EQ(log.scans[7].reading.angle_min, -1.0);
  EXPECT_EQ(log.scans[7].reading.angle_increment, 1.0);
  EXPECT_EQ(log.scans[7].reading.range_max, 30.0);
  EXPECT_EQ(log.scans[7].X_BL.x, 0.25);
  EXPECT_FALSE(log.scans[7].X_OB);
  const auto X_OB = OdometryOf(log, log.scans[7]);
  ASSERT_TRUE(X_OB);
  EXPECT_GT((X_OB->position() - drive[7].X_OB.position()).norm(), 1e-4) << "between two readings";
  EXPECT_LT((X_OB->position() - drive[7].X_OB.position()).norm(), 0.1);
  EXPECT_THAT(ErrorOf(TextOf(raw)), HasSubstr("120 lines RAWLASER1, which tell no poses"));
}

TEST_F(OddLogsTest, ScansWithoutPosesBesideOthersArePassedOver) {
  const std::vector<Moment> drive = DrawDrive(base::Rng(2));
  const std::vector<std::string> lines = LinesOf(drive, {}), raw = RawLinesOf(drive);
  const RobotLog plain = Read(TextOf(lines));
  std::string text;
  for (std::size_t i = 0; i < drive.size(); ++i)
    text += raw[i] + "\n" + lines[2 * i] + "\n" + lines[2 * i + 1] + "\n";
  ExpectSame(Read(text), plain);
  EXPECT_EQ(warnings_, "");
}

/// A line without its n last words before the last `kept`.
std::string Without(const std::string& line, int n, int kept) {
  std::vector<std::string> words;
  std::istringstream in(line);
  for (std::string word; in >> word;) words.push_back(word);
  words.erase(words.end() - kept - n, words.end() - kept);
  std::string text = words[0];
  for (std::size_t i = 1; i < words.size(); ++i) text += " " + words[i];
  return text;
}

TEST_F(OddLogsTest, LinesMayLackTimesAndAccelerations) {
  for (const Form& form : {Form{}, RobotLaser(9, -1.0, 2.0, 0.25)}) {
    const std::vector<std::string> lines = LinesOf(DrawDrive(base::Rng(3)), form);
    const RobotLog plain = Read(TextOf(lines));
    std::vector<std::string> no_accel = lines, no_time = lines, neither = lines;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      no_time[i] = Without(lines[i], 3, 0);
      neither[i] = no_time[i];
      if (lines[i][0] != 'O') continue;
      no_accel[i] = Without(lines[i], 1, 3);
      neither[i] = Without(lines[i], 4, 0);
    }
    ExpectSame(Read(TextOf(no_accel)), plain);
    EXPECT_EQ(warnings_, "");
    for (const auto& text : {no_time, neither}) {
      const RobotLog log = Read(TextOf(text));
      EXPECT_THAT(warnings_, AllOf(HasSubstr("its lines have no times (ipc_timestamp hostname"),
                                   HasSubstr("times do not advance")));
      ASSERT_EQ(log.odometry.size(), plain.odometry.size());
      ASSERT_EQ(log.scans.size(), plain.scans.size());
      for (std::size_t i = 1; i < log.odometry.size(); ++i) {
        EXPECT_EQ(log.odometry[i].reading.X_OB.x, plain.odometry[i].reading.X_OB.x);
        EXPECT_GT(log.odometry[i].time, log.scans[i - 1].time);
        EXPECT_EQ(log.scans[i].reading.ranges, plain.scans[i].reading.ranges);
      }
    }
    std::vector<std::string> some = lines;  // what single lines lack is no form of the log
    some[0] = Without(lines[0], 3, 0);
    Read(TextOf(some));
    EXPECT_THAT(warnings_, HasSubstr("line 1: ODOM has 7 words; wanted 10"));
  }
}

TEST_F(OddLogsTest, DecimalCommasAreNamed) {
  std::string text = TextOf(LinesOf(DrawDrive(base::Rng(4)), {}));
  std::replace(text.begin(), text.end(), '.', ',');
  EXPECT_THAT(ErrorOf(text), HasSubstr("line 1: x of the odometry is '"));
  EXPECT_THAT(ErrorOf(text), HasSubstr("is that a decimal comma? Write points in the whole log"));
}

TEST_F(OddLogsTest, FilesOfOtherKindsAreNamed) {
  using namespace std::string_literals;
  const std::pair<std::string, const char*> kinds[] = {
      {"\x1f\x8b\x08\0\n"s, "is packed: gunzip it"},
      {"BZh91AY", "is packed: bunzip2 it"},
      {"\xfd\x37zXZ\0"s, "is packed: unxz it"},
      {"\x28\xb5\x2f\xfd"s, "is packed: unzstd it"},
      {"PK\x03\x04", "is packed: unzip it"},
      {"\xff\xfeO\0D\0"s, "is text in UTF-16"},
      {"\xfe\xff\0O\0D"s, "is text in UTF-16"},
      {"SQLite format 3\0"s, "is a ROS 2 bag: convert it"},
      {"\x89MCAP0\r\n"s, "is a ROS 2 bag: convert it"}};
  for (const auto& [begin, said] : kinds) {
    EXPECT_THAT(ErrorOf(begin), HasSubstr("drive.log: "s + said));
    EXPECT_THAT(ErrorOf(begin + "\n\n and more"), HasSubstr(said));
  }
}

}  // namespace
}  // namespace hires::localisation::odd_logs_test
