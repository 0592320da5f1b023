#include "nodes/hires/drive_bag.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/MultiEchoLaserScan.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>
#include <topic_tools/shape_shifter.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <utility>

#include "cli/command_run.h"
#include "hires/base/text.h"
#include "hires/localisation/log_file.h"
#include "support/messages.h"
#include "support/simulated_drive.h"
#include "support/temporary_folder.h"

namespace hires_ros::drive_bag_test {
namespace {

namespace cli = hires::cli;
using hires::geometry::Pose2;
using hires::geometry::Pose3;
using hires::localisation::RobotLog;
using hires::sensing::DriveSource;
using hires::test_support::ConfigErrorOf;
using hires::test_support::Ended;
using hires::test_support::RoomsWithShelf;
using hires::test_support::RunHires;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double kBegin = 100.0;  // [s] of the stamps
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// ---------------------------------------------------------------- messages

geometry_msgs::Quaternion Turn(const Eigen::Quaterniond& rotation) {
  geometry_msgs::Quaternion q;
  q.x = rotation.x();
  q.y = rotation.y();
  q.z = rotation.z();
  q.w = rotation.w();
  return q;
}

template <typename Message>
Message ScanHead(const RobotLog::Scan& scan) {
  Message msg;
  msg.header.stamp = ros::Time(scan.time);
  msg.header.frame_id = "laser";
  msg.angle_min = static_cast<float>(scan.reading.angle_min);
  msg.angle_increment = static_cast<float>(scan.reading.angle_increment);
  msg.range_min = static_cast<float>(scan.reading.range_min);
  msg.range_max = static_cast<float>(scan.reading.range_max);
  return msg;
}

sensor_msgs::LaserScan ScanOf(const RobotLog::Scan& scan) {
  auto msg = ScanHead<sensor_msgs::LaserScan>(scan);
  msg.ranges = scan.reading.ranges;
  return msg;
}

/// With something farther behind each beam, told first, and what is too near.
sensor_msgs::MultiEchoLaserScan EchoesOf(const RobotLog::Scan& scan) {
  auto msg = ScanHead<sensor_msgs::MultiEchoLaserScan>(scan);
  for (const float range : scan.reading.ranges) {
    sensor_msgs::LaserEcho beam;
    beam.echoes = {range + 1.0F, range, 0.001F, kNan};
    msg.ranges.push_back(beam);
  }
  return msg;
}

nav_msgs::Odometry OdometryOf(double time, const Pose2& X_OB) {
  nav_msgs::Odometry msg;
  msg.header.stamp = ros::Time(time);
  msg.header.frame_id = "odom";
  msg.child_frame_id = "base_link";
  msg.pose.pose.position.x = X_OB.x;
  msg.pose.pose.position.y = X_OB.y;
  msg.pose.pose.orientation = Turn(hires::geometry::RotationFromRpy(0.0, 0.0, X_OB.yaw));
  return msg;
}

tf2_msgs::TFMessage LinkOf(const std::string& parent, const std::string& child, double time,
                           const Pose3& X_PC) {
  geometry_msgs::TransformStamped link;
  link.header.stamp = ros::Time(time);
  link.header.frame_id = parent;
  link.child_frame_id = child;
  link.transform.translation.x = X_PC.translation.x();
  link.transform.translation.y = X_PC.translation.y();
  link.transform.translation.z = X_PC.translation.z();
  link.transform.rotation = Turn(X_PC.rotation);
  tf2_msgs::TFMessage msg;
  msg.transforms = {link};
  return msg;
}

/// Of a unit that tells its rate alone.
sensor_msgs::Imu RateOf(double time, double rate, const std::string& frame = "base_link") {
  sensor_msgs::Imu msg;
  msg.header.stamp = ros::Time(time);
  msg.header.frame_id = frame;
  msg.orientation_covariance[0] = -1.0;
  msg.angular_velocity.z = rate;
  return msg;
}

/// A drive's stamps as whole milliseconds after kBegin, and numbers as messages have them.
RobotLog AsMessagesHaveIt(RobotLog log) {
  const auto stamp = [](double time) { return kBegin + std::round(time * 1e3) / 1e3; };
  for (RobotLog::Odometry& odometry : log.odometry) odometry.time = stamp(odometry.time);
  for (RobotLog::Inertia& inertia : log.inertia) inertia.time = stamp(inertia.time);
  for (RobotLog::Scan& scan : log.scans) {
    scan.time = stamp(scan.time);
    scan.reading.angle_min = static_cast<float>(scan.reading.angle_min);
    scan.reading.angle_increment = static_cast<float>(scan.reading.angle_increment);
    scan.reading.range_min = static_cast<float>(scan.reading.range_min);
  }
  return log;
}

RobotLog SimulatedLog() {
  return AsMessagesHaveIt(hires::test_support::DriveThrough(
                              RoomsWithShelf(), {{2.0, 2.0}, {2.0, 6.0}, {8.0, 6.5}, {8.0, 1.5}},
                              {}, hires::base::Rng(3))
                              .log);
}

/// Numbers with all their digits.
std::string CarmenText(const RobotLog& log) {
  const auto words = [](const Pose2& X) { return fmt::format(" {} {} {}", X.x, X.y, X.yaw); };
  std::string text;
  std::size_t next = 0;
  for (const RobotLog::Scan& scan : log.scans) {
    Pose2 X_OB;
    for (; next < log.odometry.size() && log.odometry[next].time <= scan.time; ++next) {
      X_OB = log.odometry[next].reading.X_OB;
      text += fmt::format("ODOM{} 0 0 0 {:.3f} nohost 0\n", words(X_OB), log.odometry[next].time);
    }
    const std::size_t n = scan.reading.ranges.size();
    text += fmt::format("ROBOTLASER1 0 {} 3 {} {} 0.01 0 {}", scan.reading.angle_min,
                        scan.reading.angle_increment, scan.reading.range_max, n);
    for (const float range : scan.reading.ranges) text += fmt::format(" {}", range);
    text += fmt::format(" 0{}{} 0 0 0 0 0 {:.3f} nohost 0\n", words(X_OB * scan.X_BL), words(X_OB),
                        scan.time);
  }
  return text;
}

/// The robot goes ahead by 0.1 m in each of `count` steps of 0.1 s; a wall is 3 m away, aslant:
/// beams that are all alike have met nothing.
RobotLog ShortLog(int count = 10) {
  RobotLog log;
  for (int i = 0; i < count; ++i) {
    const double time = kBegin + 0.1 * i;
    log.odometry.push_back({time, {{0.1 * i, 0.0, 0.0}, {}}});
    log.scans.push_back(
        {time, {0.25, 0.0, 0.0}, {-1.0, 0.5, 0.02, {3.0F, 3.1F, 3.2F, 3.3F, 3.4F}, 30.0}, {}});
  }
  return log;
}

/// What of a log is written, and how.
struct Style {
  std::string scan{"/scan"};
  std::string odometry{"/odom"};    ///< empty: in /tf
  std::string mount{"/tf_static"};  ///< empty: nowhere; /tf: with each scan
  Pose3 X_BL{{0.27, 0.0, 0.4}, Eigen::Quaterniond::Identity()};
  bool has_echoes{false};
};

// ---------------------------------------------------------------- bags

class DriveBagTest : public testing::Test {
 protected:
  DriveBagTest() { hires::world::SaveMap(RoomsWithShelf(), Path("rooms.yaml")); }

  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }

  using Change = std::function<void(rosbag::Bag*)>;

  /// In the order in which a robot would have recorded it.
  void Write(const RobotLog& log, const Style& style, const Change& add = {}) const {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    const auto write_mount = [&](double time) {
      bag.write(style.mount, ros::Time(time), LinkOf("base_link", "laser", time, style.X_BL));
    };
    if (style.mount == "/tf_static") write_mount(kBegin);
    std::size_t next = 0;
    for (const RobotLog::Scan& scan : log.scans) {
      for (; next < log.odometry.size() && log.odometry[next].time <= scan.time; ++next)
        WriteOdometry(log.odometry[next], style, &bag);
      if (style.mount == "/tf") write_mount(scan.time);
      const ros::Time now(scan.time);
      if (style.has_echoes) bag.write(style.scan, now, EchoesOf(scan));
      if (!style.has_echoes) bag.write(style.scan, now, ScanOf(scan));
    }
    for (; next < log.odometry.size(); ++next) WriteOdometry(log.odometry[next], style, &bag);
    if (add) add(&bag);
  }

  static void WriteOdometry(const RobotLog::Odometry& odometry, const Style& style,
                            rosbag::Bag* bag) {
    const double time = odometry.time;
    const Pose2& X_OB = odometry.reading.X_OB;
    if (style.odometry.empty()) {
      bag->write("/tf", ros::Time(time),
                 LinkOf("odom", "base_link", time, hires::geometry::Lift(X_OB)));
    } else {
      bag->write(style.odometry, ros::Time(time), OdometryOf(time, X_OB));
    }
  }

  /// A bag with these messages alone.
  void WriteOnly(const Change& write) const {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    write(&bag);
  }

  Ended Run(const std::vector<std::string>& words) const {
    cli::Backends backends;
    backends.read_drive_bag = ReadDriveBag;
    return RunHires({}, words, backends);
  }
  Ended Localise(const std::string& log, const std::string& trajectory,
                 const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"localise",  log,          "--map",        Path("rooms.yaml"),
                                   "--initial", "2 2 1.5708", "--trajectory", Path(trajectory)};
    words.insert(words.end(), more.begin(), more.end());
    return Run(words);
  }
  std::vector<double> Numbers(const std::string& name) const {
    std::ifstream file(Path(name));
    return {std::istream_iterator<double>(file), {}};
  }
  /// Trajectories have six digits behind the point.
  void ExpectSamePath(const std::string& first, const std::string& second) const {
    const std::vector<double> a = Numbers(first), b = Numbers(second);
    ASSERT_EQ(a.size(), b.size());
    ASSERT_GT(a.size(), 8u * 50);
    for (std::size_t i = 0; i < a.size(); ++i)
      ASSERT_NEAR(a[i], b[i], 2e-6) << "number " << i % 8 << " of line " << i / 8;
  }

  RobotLog Read(const DriveSource& source = {}) {
    testing::internal::CaptureStderr();
    RobotLog log = ReadDriveBag(path_, source);
    told_ = testing::internal::GetCapturedStderr();
    return log;
  }
  std::string Bytes() const {
    std::ifstream in(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::string Error(const DriveSource& source = {}) const {
    return ConfigErrorOf([&] { ReadDriveBag(path_, source); });
  }

  const hires::test_support::TemporaryFolder folder_;
  const std::string path_{(folder_.path() / "drive.bag").string()};
  std::string told_;  // on standard error by Read
};

// ---------------------------------------------------------------- as a CARMEN log

TEST_F(DriveBagTest, TrajectoryIsThatOfTheCarmenLogOfTheSameDrive) {
  const RobotLog log = SimulatedLog();
  const std::string carmen = folder_.Write("drive.log", CarmenText(log));
  ASSERT_EQ(Localise(carmen, "carmen.tum").code, cli::kExitRecommended);
  std::vector<std::pair<std::string, Style>> styles(5);
  styles[0].first = "odometry and fixed transform";
  styles[1] = {"odometry and transform with each scan", {}};
  styles[1].second.mount = "/tf";
  styles[2] = {"transforms alone", {}};
  styles[2].second.odometry = "";
  styles[3] = {"laser told by hand", {}};
  styles[3].second.mount = "";
  styles[4] = {"several echoes", {}};
  styles[4].second.has_echoes = true;
  for (const auto& [name, style] : styles) {
    SCOPED_TRACE(name);
    Write(log, style);
    const std::vector<std::string> laser = style.mount.empty()
                                               ? std::vector<std::string>{"--laser", "0.27 0 0"}
                                               : std::vector<std::string>{};
    const Ended ended = Localise(path_, "bag.tum", laser);
    ASSERT_EQ(ended.code, cli::kExitRecommended) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("status      good"));
    EXPECT_THAT(ended.err, Not(HasSubstr("left out")));
    ExpectSamePath("bag.tum", "carmen.tum");
  }
}

TEST_F(DriveBagTest, MapIsThatOfTheCarmenLogOfTheSameDrive) {
  const RobotLog log = SimulatedLog();
  Write(log, {});
  for (const std::string& drive : {folder_.Write("drive.log", CarmenText(log)), path_}) {
    const std::string name = drive == path_ ? "bag" : "carmen";
    const Ended ended =
        Run({"map", drive, "--output", Path(name + ".yaml"), "--trajectory", Path(name + ".tum")});
    ASSERT_EQ(ended.code, cli::kExitRecommended) << ended.err;
  }
  ExpectSamePath("bag.tum", "carmen.tum");
  EXPECT_EQ(hires::base::ReadTextFile(Path("bag.pgm")),
            hires::base::ReadTextFile(Path("carmen.pgm")));
}

TEST_F(DriveBagTest, SameSeedGivesTheSameBytes) {
  Write(SimulatedLog(), {});
  ASSERT_EQ(Localise(path_, "one.tum", {"--seed", "5"}).code, cli::kExitRecommended);
  ASSERT_EQ(Localise(path_, "two.tum", {"--seed", "5"}).code, cli::kExitRecommended);
  EXPECT_EQ(hires::base::ReadTextFile(Path("one.tum")), hires::base::ReadTextFile(Path("two.tum")));
}

TEST_F(DriveBagTest, OdometryAtOtherTimesIsInterpolated) {
  RobotLog log = SimulatedLog();
  const Style style;
  std::vector<RobotLog::Odometry> rare{log.odometry.front()};
  for (std::size_t i = 2; i < log.odometry.size(); i += 7) rare.push_back(log.odometry[i]);
  rare.push_back(log.odometry.back());
  const std::vector<RobotLog::Odometry> all = std::exchange(log.odometry, rare);
  Write(log, style);
  ASSERT_EQ(Localise(path_, "rare.tum").code, cli::kExitRecommended);
  log.odometry = all;
  Write(log, style);
  ASSERT_EQ(Localise(path_, "all.tum").code, cli::kExitRecommended);
  const std::vector<double> a = Numbers("rare.tum"), b = Numbers("all.tum");
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); i += 8)
    EXPECT_LT(std::hypot(a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]), 0.25) << "at " << a[i];
}

TEST_F(DriveBagTest, LaserUpsideDownIsTurnedOver) {
  RobotLog log = ShortLog();
  for (RobotLog::Scan& scan : log.scans) scan.reading.ranges = {1, 2, 3, 4, 5};
  Style style;
  style.X_BL = {{0.3, 0.1, 0.5}, hires::geometry::RotationFromRpy(M_PI, 0.0, 0.2)};
  Write(log, style);
  const RobotLog read = Read();
  ASSERT_EQ(read.scans.size(), log.scans.size());
  EXPECT_EQ(read.scans[0].reading.angle_min, 1.0) << "what the laser calls right is left";
  EXPECT_EQ(read.scans[0].reading.angle_increment, -0.5);
  EXPECT_NEAR(read.scans[0].X_BL.x, 0.3, 1e-9);
  EXPECT_NEAR(read.scans[0].X_BL.y, 0.1, 1e-9);
  EXPECT_NEAR(read.scans[0].X_BL.yaw, 0.2, 1e-9);
}

TEST_F(DriveBagTest, LaserSaidByHandGoesBeforeTheTransforms) {
  Write(ShortLog(), {});
  DriveSource source;
  source.X_BL = Pose2{0.1, 0.2, 0.3};
  EXPECT_EQ(Read(source).scans[0].X_BL.y, 0.2);
}

// ---------------------------------------------------------------- inertial units

TEST_F(DriveBagTest, InertialUnitIsReadWhereItIsNamed) {
  Write(ShortLog(), {}, [](rosbag::Bag* bag) {
    const Pose3 X_BI{{0.0, 0.0, 0.2}, hires::geometry::RotationFromRpy(M_PI, 0.0, 0.0)};
    bag->write("/tf_static", ros::Time(kBegin), LinkOf("base_link", "imu_link", kBegin, X_BI));
    for (int i = 0; i < 50; ++i) {
      const double time = kBegin + 0.02 * i;
      bag->write("/imu", ros::Time(time), RateOf(time, -0.3, "imu_link"));
    }
    sensor_msgs::Imu msg = RateOf(kBegin + 0.985, 0.0);
    msg.orientation_covariance[0] = 0.0;
    msg.orientation = Turn(hires::geometry::RotationFromRpy(0.0, 0.0, 0.7));
    bag->write("/imu", msg.header.stamp, msg);
  });
  EXPECT_THAT(Read().inertia, IsEmpty());
  DriveSource source;
  source.imu = "imu";
  const RobotLog log = Read(source);
  EXPECT_THAT(told_, IsEmpty());
  ASSERT_EQ(log.inertia.size(), 51u);
  EXPECT_NEAR(log.inertia[3].yaw_rate, 0.3, 1e-6) << "it hangs upside down";
  EXPECT_FALSE(log.inertia[3].yaw);
  EXPECT_NEAR(log.inertia[50].yaw.value(), 0.7, 1e-6);
  source.imu = "/imuu";
  EXPECT_THAT(Error(source), HasSubstr("--imu: topic '/imuu' is unknown"));
  source.imu = "/odom";
  EXPECT_THAT(Error(source), HasSubstr("--imu /odom: has type nav_msgs/Odometry and 10 messages; "
                                       "wanted sensor_msgs/Imu"));
}

TEST_F(DriveBagTest, InertialUnitMayAccompanyOdometryOfTransforms) {
  Style style;
  style.odometry = "";
  Write(ShortLog(), style, [](rosbag::Bag* bag) {
    bag->write("/imu", ros::Time(kBegin + 0.5), RateOf(kBegin + 0.5, 0.3));
  });
  DriveSource source;
  source.imu = "/imu";
  EXPECT_EQ(Read(source).inertia.size(), 1u);
}

TEST_F(DriveBagTest, BrokenReadingsOfTheInertialUnitAreLeftOutAndCounted) {
  Write(ShortLog(), {}, [](rosbag::Bag* bag) {
    const ros::Time now(kBegin + 0.5);
    const auto write = [&](const sensor_msgs::Imu& msg) { bag->write("/imu", now, msg); };
    write(RateOf(kBegin + 0.5, 0.1));
    write(RateOf(0.0, 0.1));
    write(RateOf(kBegin + 0.51, kNan));
    sensor_msgs::Imu msg = RateOf(kBegin + 0.52, 0.1);
    msg.angular_velocity_covariance[0] = -1.0;
    write(msg);
    msg = RateOf(kBegin + 0.53, 0.1);
    msg.orientation_covariance[0] = 0.0;
    write(msg);
    msg.orientation.w = kNan;
    write(msg);
    write(RateOf(kBegin + 0.54, 0.1, "imu_link"));
    write(RateOf(kBegin + 0.5, 0.2));
  });
  DriveSource source;
  source.imu = "/imu";
  const RobotLog log = Read(source);
  ASSERT_EQ(log.inertia.size(), 1u);
  EXPECT_NEAR(log.inertia[0].yaw_rate, 0.1, 1e-9);
  for (const char* said :
       {"left out 1 readings of the inertial unit whose header.stamp is zero",
        "left out 1 readings of the inertial unit that are no numbers within 100 rad/s",
        "left out 1 readings of the inertial unit without orientation and rate",
        "left out 2 readings of the inertial unit whose quaternion turns nothing",
        "left out 1 readings of an inertial unit whose place in the base is not known",
        "left out 1 readings with the stamp of another one"})
    EXPECT_THAT(told_, HasSubstr(said));
}

TEST_F(DriveBagTest, TimeOfTheInertialUnitThatJumpsBackIsRefused) {
  Write(ShortLog(), {}, [](rosbag::Bag* bag) {
    bag->write("/imu", ros::Time(kBegin + 2.0), RateOf(kBegin + 2.0, 0.1));
    bag->write("/imu", ros::Time(kBegin + 3.0), RateOf(kBegin - 5.0, 0.1));
  });
  EXPECT_NO_THROW(Read()) << "nobody asked for the unit";
  DriveSource source;
  source.imu = "/imu";
  EXPECT_THAT(Error(source), HasSubstr("header.stamp 95.000000 of the inertial unit is 7.000 s"));
}

/// Odometry turns too far by a tenth where the laser sees nothing.
TEST_F(DriveBagTest, InertialUnitMakesTrajectoriesTruer) {
  hires::test_support::SimulatedDriveParams params = hires::test_support::ExactOdometry();
  params.range_max = 5.0;
  const hires::world::OccupancyGrid hall = hires::test_support::LargeHall();
  hires::test_support::SimulatedDrive drive = hires::test_support::DriveThrough(
      hall, hires::test_support::CourseThroughLargeHall(), params, hires::base::Rng(1));
  drive.log.inertia = hires::test_support::RatesOf(drive.log, 0.01, {}, hires::base::Rng(1));
  hires::test_support::ScaleTurns(1.1, &drive.log);
  const RobotLog log = AsMessagesHaveIt(drive.log);
  Write(log, {}, [&](rosbag::Bag* bag) {
    for (const RobotLog::Inertia& inertia : log.inertia)
      bag->write("/imu", ros::Time(inertia.time), RateOf(inertia.time, inertia.yaw_rate));
  });
  const auto error_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"map",          path_,           "--output",    Path("map.yaml"),
                                   "--trajectory", Path("map.tum"), "--max-range", "5"};
    words.insert(words.end(), more.begin(), more.end());
    const Ended ended = Run(words);
    EXPECT_EQ(ended.code, cli::kExitRecommended) << ended.err;
    EXPECT_THAT(ended.err, Not(HasSubstr("left out")));
    const std::vector<double> numbers = Numbers("map.tum");
    hires::localisation::TimedPath path;
    for (std::size_t i = 0; i + 7 < numbers.size(); i += 8)
      path.push_back({numbers[i], {numbers[i + 1], numbers[i + 2], 0.0}});
    return hires::test_support::TrajectoryRms(path, drive.truth);
  };
  EXPECT_GT(error_of({}), 0.4);
  EXPECT_LT(error_of({"--imu", "/imu"}), 0.15);
}

// ---------------------------------------------------------------- which topics

TEST_F(DriveBagTest, TopicsAreChosenByNameWhereSeveralCouldBeMeant) {
  Write(ShortLog(), {}, [](rosbag::Bag* bag) {
    bag->write("/rear", ros::Time(kBegin), ScanOf(ShortLog(1).scans[0]));
    bag->write("/visual", ros::Time(kBegin), OdometryOf(kBegin, {}));
  });
  EXPECT_THAT(Error(),
              AllOf(HasSubstr("drive.bag: 2 topics could be meant; choose one with --scan"),
                    HasSubstr("/rear (sensor_msgs/LaserScan, 1 messages)"),
                    HasSubstr("/scan (sensor_msgs/LaserScan, 10 messages)")));
  DriveSource source;
  source.scan = "scan";
  EXPECT_THAT(Error(source),
              AllOf(HasSubstr("choose one with --odometry"),
                    HasSubstr("/visual (nav_msgs/Odometry, 1 messages)"), HasSubstr("/odom (")));
  source.odometry = "/odom";
  EXPECT_EQ(Read(source).scans.size(), 10u);
  EXPECT_THAT(told_, IsEmpty());
  source.scan = "/scann";
  EXPECT_THAT(Error(source), AllOf(HasSubstr("--scan: topic '/scann' is unknown"),
                                   HasSubstr("/tf_static (tf2_msgs/TFMessage)")));
  source.scan = "/odom";
  EXPECT_THAT(Error(source), HasSubstr("--scan /odom: has type nav_msgs/Odometry and 10 messages; "
                                       "wanted sensor_msgs/LaserScan or sensor_msgs/MultiEcho"));
  source.scan = "/scan";
  source.odometry = "/scan";
  EXPECT_THAT(Error(source), HasSubstr("--odometry /scan: has type sensor_msgs/LaserScan"));
}

TEST_F(DriveBagTest, BagsThatLackATopicAreRefused) {
  WriteOnly([](rosbag::Bag*) {});
  EXPECT_THAT(Error(), HasSubstr("drive.bag: has no scan: no topic of sensor_msgs/LaserScan or "
                                 "sensor_msgs/MultiEchoLaserScan with messages; it is empty"));
  WriteOnly([](rosbag::Bag* bag) { bag->write("/chat", ros::Time(1.0), std_msgs::String()); });
  EXPECT_THAT(Error(), AllOf(HasSubstr("has no scan"), HasSubstr("/chat (std_msgs/String)")));
  WriteOnly(
      [](rosbag::Bag* bag) { bag->write("/scan", ros::Time(1.0), ScanOf(ShortLog(1).scans[0])); });
  EXPECT_THAT(Error(), HasSubstr("has no odometry: neither a topic of nav_msgs/Odometry nor /tf"));
  DriveSource source;
  source.odometry = "/tf";
  EXPECT_THAT(Error(source), HasSubstr("has no odometry: no topic /tf of tf2_msgs/TFMessage"));
  WriteOnly([](rosbag::Bag* bag) {
    bag->write("/scan", ros::Time(1.0), ScanOf(ShortLog(1).scans[0]));
    bag->write("/tf", ros::Time(1.0), std_msgs::String());
  });
  EXPECT_THAT(Error(), HasSubstr("has no odometry"));
}

// ---------------------------------------------------------------- frames

TEST_F(DriveBagTest, LaserWhosePlaceNobodySaysIsNamed) {
  Style style;
  style.mount = "";
  Write(ShortLog(), style);
  EXPECT_THAT(Error(), AllOf(HasSubstr("its /tf and /tf_static do not tell where the laser's frame "
                                       "'laser' is in the base 'base_link' (they tell of no "
                                       "frame)"),
                             HasSubstr("--laser \"x y yaw\" [m, m, rad]")));
  Write(ShortLog(), style, [](rosbag::Bag* bag) {
    const Pose3 X_BL{{0.2, 0.0, 0.5}, Eigen::Quaterniond::Identity()};
    bag->write("/tf_static", ros::Time(kBegin), LinkOf("base_link", "base_scan", kBegin, X_BL));
  });
  EXPECT_THAT(Error(), HasSubstr("(they tell of base_link, base_scan); record both topics too"));
}

TEST_F(DriveBagTest, AnglesAreToldByTheirSpanWhereTheIncrementIsZero) {
  RobotLog log = ShortLog();  // five beams from -1 to 1 rad
  const RobotLog whole = log;
  for (RobotLog::Scan& scan : log.scans) scan.reading.angle_increment = 0.0;
  Write(log, {});
  EXPECT_THAT(Error(), HasSubstr("left out: 10 scans whose angles are no numbers"))
      << "angle_max is 0, too";
  WriteOnly([&](rosbag::Bag* bag) {
    bag->write("/tf_static", ros::Time(kBegin), LinkOf("base_link", "laser", kBegin, {}));
    for (std::size_t i = 0; i < log.scans.size(); ++i) {
      sensor_msgs::LaserScan msg = ScanOf(log.scans[i]);
      msg.angle_max = 1.0F;
      bag->write("/odom", msg.header.stamp,
                 OdometryOf(log.scans[i].time, log.odometry[i].reading.X_OB));
      bag->write("/scan", msg.header.stamp, msg);
    }
  });
  const RobotLog read = Read();
  EXPECT_THAT(told_, HasSubstr("angle_increment of scans is 0"));
  ASSERT_EQ(read.scans.size(), 10u);
  for (const RobotLog::Scan& scan : read.scans)
    EXPECT_EQ(scan.reading.angle_increment, whole.scans[0].reading.angle_increment);
}

TEST_F(DriveBagTest, LaserMayHangOnAChainOfFixedAndMovingFrames) {
  Style style;
  style.mount = "";
  const RobotLog log = ShortLog();
  Write(log, style, [&](rosbag::Bag* bag) {
    const Pose3 X_BT{{0.2, 0.0, 0.5}, hires::geometry::RotationFromRpy(0.0, 0.0, M_PI / 2.0)};
    bag->write("/tf_static", ros::Time(kBegin), LinkOf("base_link", "torso", kBegin, X_BT));
    for (const double time : {kBegin, kBegin + 0.5}) {
      const double along = time - kBegin;  // [m] the torso's x, which is y of the base
      bag->write(
          "/tf", ros::Time(time),
          LinkOf("torso", "laser", time, {{along, 0.0, 0.0}, Eigen::Quaterniond::Identity()}));
    }
  });
  const RobotLog read = Read();
  ASSERT_EQ(read.scans.size(), 10u);
  EXPECT_NEAR(read.scans[2].X_BL.x, 0.2, 1e-6);
  EXPECT_NEAR(read.scans[2].X_BL.y, 0.2, 1e-6) << "between two moments that are known";
  EXPECT_NEAR(read.scans[2].X_BL.yaw, M_PI / 2.0, 1e-6);
  EXPECT_NEAR(read.scans[9].X_BL.y, 0.5, 1e-6) << "the newest at the end";
  EXPECT_THAT(told_, IsEmpty());
}

TEST_F(DriveBagTest, TiltedLaserIsRefused) {
  Style style;
  style.X_BL.rotation = hires::geometry::RotationFromRpy(0.0, 0.5, 0.0);
  Write(ShortLog(), style);
  EXPECT_THAT(Error(), HasSubstr("none of its 10 scans can be used; left out: 10 scans of a laser "
                                 "that is tilted by more than 0.1 rad"));
}

TEST_F(DriveBagTest, FramesOfTransformsMayBeNamed) {
  RobotLog log = ShortLog();
  const std::vector<RobotLog::Odometry> odometry = std::exchange(log.odometry, {});
  Style style;
  style.odometry = "";
  Write(log, style, [&](rosbag::Bag* bag) {
    for (const RobotLog::Odometry& reading : odometry) {
      bag->write("/tf", ros::Time(reading.time),
                 LinkOf("/world", "/base_link", reading.time, Lift(reading.reading.X_OB)));
    }
  });
  EXPECT_THAT(Error(), AllOf(HasSubstr("its transforms do not tell how base 'base_footprint' or "
                                       "'base_link' moves in 'odom' or 'odom_combined'"),
                             HasSubstr("--odometry-frame and --base-frame")));
  DriveSource source;
  source.odometry_frame = "world";
  const RobotLog read = Read(source);
  EXPECT_EQ(read.odometry.size(), 10u);
  EXPECT_EQ(read.scans.size(), 10u);
  source.base_frame = "trunk";
  EXPECT_THAT(Error(source), HasSubstr("how base 'trunk' moves in 'world'"));
}

TEST_F(DriveBagTest, OdometryOfAnotherFrameThanTheNamedBaseIsRefused) {
  Write(ShortLog(), {});
  DriveSource source;
  source.base_frame = "base_footprint";
  EXPECT_THAT(Error(source), HasSubstr("--base-frame base_footprint: the odometry of"));
  source.base_frame = "/base_link";
  EXPECT_EQ(Read(source).scans.size(), 10u);
}

TEST_F(DriveBagTest, OdometryThatNamesNoFrameNeedsANameOrALaser) {
  RobotLog log = ShortLog();
  const std::vector<RobotLog::Odometry> odometry = std::exchange(log.odometry, {});
  Write(log, {}, [&](rosbag::Bag* bag) {
    for (const RobotLog::Odometry& reading : odometry) {
      nav_msgs::Odometry msg = OdometryOf(reading.time, reading.reading.X_OB);
      msg.child_frame_id = "";
      bag->write("/odom", msg.header.stamp, msg);
    }
  });
  EXPECT_THAT(Error(), AllOf(HasSubstr("has no child_frame_id (--base-frame names it)"),
                             HasSubstr("--laser")));
  DriveSource source;
  source.base_frame = "base_link";
  EXPECT_EQ(Read(source).scans.size(), 10u);
}

// ---------------------------------------------------------------- times and numbers

TEST_F(DriveBagTest, ScansBeyondTheOdometryAndInItsGapsAreLeftOut) {
  RobotLog log = ShortLog(60);
  log.odometry.erase(log.odometry.begin(), log.odometry.begin() + 3);
  log.odometry.erase(log.odometry.begin() + 10, log.odometry.begin() + 40);  // 3.1 s
  log.odometry.pop_back();
  Write(log, {});
  EXPECT_EQ(Read().scans.size(), 60u - 3 - 30 - 1);
  EXPECT_THAT(told_, AllOf(HasSubstr("left out 4 scans from before the first or after the last "
                                     "odometry"),
                           HasSubstr("left out 30 scans within a gap of the odometry of more than "
                                     "2 s")));
}

TEST_F(DriveBagTest, ReadingsThatComeLateArePutInOrder) {
  RobotLog log = ShortLog();
  Style style;
  Write(log, style, [](rosbag::Bag* bag) {
    bag->write("/odom", ros::Time(kBegin + 2.0), OdometryOf(kBegin + 0.25, {0.25, 0.0, 0.0}));
    bag->write("/odom", ros::Time(kBegin + 2.0), OdometryOf(kBegin + 0.3, {7.0, 0.0, 0.0}));
  });
  const RobotLog read = Read();
  ASSERT_EQ(read.odometry.size(), 11u);
  for (std::size_t i = 1; i < read.odometry.size(); ++i)
    EXPECT_LT(read.odometry[i - 1].time, read.odometry[i].time);
  EXPECT_NEAR(read.odometry[4].reading.X_OB.x, 0.3, 1e-9) << "the first one stays";
  EXPECT_THAT(told_, AllOf(HasSubstr("2 readings came late; put in order"),
                           HasSubstr("left out 1 readings with the stamp of another one")));
}

TEST_F(DriveBagTest, TimeThatJumpsBackIsRefused) {
  Write(ShortLog(), {}, [](rosbag::Bag* bag) {
    bag->write("/odom", ros::Time(kBegin + 2.0), OdometryOf(kBegin - 5.0, {}));
  });
  EXPECT_THAT(Error(), AllOf(HasSubstr("header.stamp 95.000000 of odometry is 5.900 s before"),
                             HasSubstr("cut it there")));
  Write(ShortLog(), {}, [](rosbag::Bag* bag) {
    RobotLog::Scan scan = ShortLog(1).scans[0];
    scan.time = 5.0;
    bag->write("/scan", ros::Time(kBegin + 2.0), ScanOf(scan));
  });
  EXPECT_THAT(Error(), HasSubstr("header.stamp 5.000000 of a scan is 95.900 s before"));
}

TEST_F(DriveBagTest, BrokenReadingsAreLeftOutAndCounted) {
  Write(ShortLog(), {}, [](rosbag::Bag* bag) {
    const ros::Time now(kBegin + 0.5);
    sensor_msgs::LaserScan scan = ScanOf(ShortLog(1).scans[0]);
    scan.header.stamp = {};
    bag->write("/scan", now, scan);
    scan.header.stamp = now;
    scan.angle_increment = kNan;
    bag->write("/scan", now, scan);
    nav_msgs::Odometry odometry = OdometryOf(kBegin + 0.55, {});
    odometry.pose.pose.position.x = kNan;
    bag->write("/odom", now, odometry);
    bag->write("/odom", now, OdometryOf(0.0, {}));
    odometry = OdometryOf(kBegin + 0.55, {});
    odometry.pose.pose.orientation = {};
    bag->write("/odom", now, odometry);
    bag->write(
        "/tf", now,
        LinkOf("base_link", "laser", kBegin, {{NAN, 0.0, 0.0}, Eigen::Quaterniond::Identity()}));
  });
  EXPECT_EQ(Read().scans.size(), 10u);
  for (const char* said : {"left out 1 scans whose header.stamp is zero",
                           "left out 1 scans whose angles are no numbers",
                           "left out 1 readings of the odometry that are no numbers within 1e6 m",
                           "left out 1 readings of the odometry whose header.stamp is zero",
                           "left out 1 readings of the odometry whose quaternion turns nothing",
                           "left out 1 transforms without frames, or with numbers that are none"})
    EXPECT_THAT(told_, HasSubstr(said));
}

TEST_F(DriveBagTest, ScansThatMeasureNothingAreToldByTheVerb) {
  RobotLog log = ShortLog();
  for (RobotLog::Scan& scan : log.scans) scan.reading.ranges = {kNan, 0, -1, 0, kNan};
  Write(log, {});
  const Ended ended = Localise(path_, "path.tum");
  EXPECT_EQ(ended.code, cli::kExitBadInput);
  EXPECT_THAT(ended.err, HasSubstr("drive.bag: no scan could be used (nothing measured 10)"));
}

// ---------------------------------------------------------------- broken bags

TEST_F(DriveBagTest, BrokenBagsAreRefused) {
  EXPECT_THAT(Error(), HasSubstr("drive.bag: no such bag"));
  folder_.Write("drive.bag", "FLASER 0\n");
  EXPECT_THAT(Error(), HasSubstr("is no ROS bag"));
  Write(ShortLog(), {});
  const std::string bytes = Bytes();
  for (const std::size_t kept : {std::size_t{4200}, std::size_t{100}, std::size_t{13}}) {
    folder_.Write("drive.bag", bytes.substr(0, kept));
    EXPECT_THAT(Error(), HasSubstr("no whole message is in it")) << kept << " bytes";
  }
}

/// Copies that were cut off, and recordings that were killed: what is whole counts.
TEST_F(DriveBagTest, WholeMessagesOfBagsThatEndEarlyAreRead) {
  Write(ShortLog(), {});
  const std::string bytes = Bytes();
  const std::size_t num_scans = Read().scans.size();
  std::size_t least = num_scans;
  for (int share = 99; share >= 60; share -= 3) {
    folder_.Write("drive.bag", bytes.substr(0, bytes.size() * share / 100));
    const std::size_t num = Read().scans.size();
    EXPECT_LE(num, least) << share;
    EXPECT_GT(num, 0u) << share;
    least = num;
  }
  EXPECT_LT(least, num_scans);
  std::string unindexed = bytes;
  const std::string key = "index_pos=";
  unindexed.replace(unindexed.find(key) + key.size(), 8, std::string(8, '\0'));
  folder_.Write("drive.bag", unindexed);
  EXPECT_EQ(Read().scans.size(), num_scans);
}

/// Recorders of 2010 wrote 20 bytes for each entry as the length, and 12 of data.
TEST_F(DriveBagTest, AnIndexIsAsLongAsItsCountSays) {
  Write(ShortLog(), {});
  const std::string bytes = Bytes();
  const std::size_t num_scans = Read().scans.size();
  std::string old = bytes;
  const auto number_at = [&](std::size_t at) {
    std::uint32_t number = 0;
    std::memcpy(&number, &bytes[at], 4);
    return number;
  };
  int num_changed = 0;
  for (std::size_t at = 13; at < bytes.size();) {
    const std::size_t length_at = at + 4 + number_at(at);
    const std::uint32_t length = number_at(length_at);
    const std::string header = bytes.substr(at + 4, number_at(at));
    if (header.find(std::string("op=") + '\x04') != std::string::npos) {
      const std::uint32_t longer = length / 12 * 20;
      std::memcpy(&old[length_at], &longer, 4);
      ++num_changed;
    }
    at = length_at + 4 + length;
  }
  ASSERT_GT(num_changed, 0);
  folder_.Write("drive.bag", old);
  EXPECT_EQ(Read().scans.size(), num_scans);
}

TEST_F(DriveBagTest, MessagesOfAnotherVersionAreCounted) {
  WriteOnly([](rosbag::Bag* bag) {
    topic_tools::ShapeShifter raw;
    raw.morph(std::string(32, '7'), "sensor_msgs/LaserScan", "", "");
    std::vector<std::uint8_t> bytes{1, 2, 3};
    ros::serialization::IStream stream(bytes.data(), 3);
    raw.read(stream);
    bag->write("/scan", ros::Time(kBegin), raw);
    bag->write("/odom", ros::Time(kBegin), OdometryOf(kBegin, {}));
  });
  EXPECT_THAT(Error(), HasSubstr("none of its 0 scans can be used; left out: 1 scans of another "
                                 "type, or of another version of it"));
}

TEST_F(DriveBagTest, AnyBytesGiveADriveOrAnError) {
  namespace compression = rosbag::compression;
  for (const auto packing : {compression::Uncompressed, compression::BZ2, compression::LZ4}) {
    WriteOnly([&](rosbag::Bag* bag) {
      bag->setCompression(packing);
      bag->write("/tf_static", ros::Time(kBegin), LinkOf("base_link", "laser", kBegin, {}));
      for (const RobotLog::Scan& scan : ShortLog().scans) {
        bag->write("/odom", ros::Time(scan.time), OdometryOf(scan.time, {}));
        bag->write("/imu", ros::Time(scan.time), RateOf(scan.time, 0.1));
        bag->write("/scan", ros::Time(scan.time), ScanOf(scan));
      }
    });
    DriveSource source;
    source.imu = "/imu";
    ASSERT_EQ(Read(source).inertia.size(), 10u);
    const std::string bytes = Bytes();
    hires::base::Rng rng(11);
    testing::internal::CaptureStderr();  // warnings
    for (int run = 0; run < 100; ++run) {
      std::string changed = bytes;
      for (int i = 0; i < 5; ++i) {
        const int place = 13 + rng.Index(static_cast<int>(bytes.size()) - 13);
        changed[place] = static_cast<char>(rng.Index(256));
      }
      folder_.Write("drive.bag", changed);
      SCOPED_TRACE(run);
      EXPECT_NO_THROW(Error(source));
    }
    testing::internal::GetCapturedStderr();
  }
}

// ---------------------------------------------------------------- options

TEST_F(DriveBagTest, OptionsOfBagsAreChecked) {
  Write(ShortLog(), {});
  const auto refused = [&](const std::vector<std::string>& more, const std::string& said) {
    const Ended ended = Localise(path_, "path.tum", more);
    EXPECT_EQ(ended.code, cli::kExitBadInput) << said;
    EXPECT_THAT(ended.err, HasSubstr(said));
  };
  refused({"--laser", "0 0"},
          "--laser '0 0': has 2 numbers; wanted three numbers in quotes, \"x y "
          "yaw\" [m, m, rad] of the laser in the base");
  refused({"--laser", "0 left 0"}, "'left' is no number");
  refused({"--laser", "0 0 180"}, "180 degrees are 3.1416");
  refused({"--laser", "270 0 0"}, "is 270.0 m from the base, wanted 10 at most");
  refused({"--odometry", "/wheels"}, "--odometry: topic '/wheels' is unknown");
  std::filesystem::rename(path_, Path("drive.rec"));
  EXPECT_THAT(Run({"map", Path("drive.rec"), "--output", Path("map.yaml"), "--scan", "/rear"}).err,
              HasSubstr("--scan: topic '/rear' is unknown"))
      << "a bag by any other name";
}

}  // namespace
}  // namespace hires_ros::drive_bag_test
