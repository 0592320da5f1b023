#include "cli/drive_log.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "cli/radians.h"
#include "hires/base/error.h"
#include "hires/base/log.h"
#include "hires/base/text.h"
#include "hires/localisation/filtered_log.h"
#include "hires/localisation/log_file.h"

namespace hires::cli {
namespace {

constexpr double kFarthestLaser = 10.0;  // [m] from the base

bool IsBag(const std::string& log) {
  if (base::ToLower(std::filesystem::path(log).extension().string()) == ".bag") return true;
  constexpr char kBegin[] = "#ROSBAG";
  std::string begin(sizeof(kBegin) - 1, '\0');
  std::ifstream file(log, std::ios::binary);
  return file.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == kBegin;
}

/// @throws base::ConfigError naming the first option that is of bags alone.
void RefuseBagOptions(const DriveOptions& options) {
  const sensing::DriveSource& source = options.source;
  const std::pair<const char*, const std::string&> of_bags[] = {
      {"--scan", source.scan},
      {"--odometry", source.odometry},
      {"--imu", source.imu},
      {"--odometry-frame", source.odometry_frame},
      {"--base-frame", source.base_frame},
      {"--laser", options.laser}};
  for (const auto& [name, value] : of_bags) {
    if (value.empty()) continue;
    throw base::ConfigError(
        fmt::format("{}: is for bags, and {} is none; a CARMEN log says itself what that option "
                    "says of a bag: leave it out",
                    name, options.log));
  }
}

sensing::DriveSource SourceOf(const DriveOptions& options) {
  sensing::DriveSource source = options.source;
  if (options.laser.empty()) return source;
  source.X_BL = PoseIn(options.laser, "--laser", "of the laser in the base");
  if (source.X_BL->position().norm() > kFarthestLaser) {
    throw base::ConfigError(fmt::format(
        "--laser '{}': is {:.1f} m from the base, wanted {:g} at most; numbers are in metres",
        options.laser, source.X_BL->position().norm(), kFarthestLaser));
  }
  return source;
}

/// The drive with its odometry corrected by its inertial unit, if it has one.
localisation::RobotLog WithInertia(localisation::RobotLog drive, const std::string& log,
                                   const std::string& package_folder) {
  if (drive.inertia.empty()) return drive;
  const auto config = localisation::ReadOdometryFilterConfig(
      base::ParamReader::FromFile(package_folder + "/config/odometry_filter.yaml"));
  const int num_resets = localisation::FilterOdometry(config.filter, &drive);
  if (num_resets > 0) {
    base::Log(
        base::LogLevel::kWarn,
        fmt::format("{}: odometry was reset {} times, which counts as no motion", log, num_resets));
  }
  return drive;
}

/// A recording that stood still, or two in one file.
void WarnOfGaps(const localisation::RobotLog& drive, const std::string& log) {
  constexpr double kLongest = 5.0;  // [s]
  int count = 0;
  double longest = 0.0, at = 0.0;
  for (std::size_t i = 1; i < drive.scans.size(); ++i) {
    const double gap = drive.scans[i].time - drive.scans[i - 1].time;
    if (gap > kLongest) ++count;
    if (gap <= longest) continue;
    longest = gap;
    at = drive.scans[i - 1].time - drive.scans.front().time;
  }
  if (count == 0) return;
  base::Log(
      base::LogLevel::kWarn,
      fmt::format("{}: no scan for more than {:g} s, {} times, the longest {:.1f} s, {:.1f} s "
                  "after the first: the odometry alone tells how the robot moved meanwhile{}",
                  log, kLongest, count, longest, at,
                  2 * static_cast<std::size_t>(count) > drive.scans.size()
                      ? ". Are its times in milliseconds? Divide them by 1000"
                      : ""));
}

}  // namespace

void AddDriveOptions(CLI::App* verb, DriveOptions* o) {
  verb->add_option("log", o->log,
                   "CARMEN log: lines FLASER and ODOM, or ROBOTLASER1; or a ROS bag: LaserScan or "
                   "MultiEchoLaserScan, and Odometry or /tf")
      ->required();
  verb->add_option("--scan", o->source.scan,
                   "topic of the laser in a bag; needed where several have scans");
  verb->add_option("--odometry", o->source.odometry,
                   "topic of nav_msgs/Odometry in a bag, or /tf; needed where there are several; "
                   "/tf where there is none");
  verb->add_option("--imu", o->source.imu,
                   "topic of sensor_msgs/Imu in a bag, whose heading then corrects the odometry's; "
                   "without it, none is used");
  verb->add_option("--odometry-frame", o->source.odometry_frame,
                   "with /tf: frame in which the base moves smoothly; default: odom or "
                   "odom_combined");
  verb->add_option("--base-frame", o->source.base_frame,
                   "the base, with /tf, or where odometry does not name it; default: "
                   "base_footprint or base_link");
  verb->add_option("--laser", o->laser,
                   "\"x y yaw\" [m, m, rad] of the laser in the base, for a bag whose /tf and "
                   "/tf_static do not tell it; goes before what they tell");
}

geometry::Pose2 PoseIn(const std::string& text, const std::string& option,
                       const std::string& what) {
  const std::string wanted =
      fmt::format("wanted three numbers in quotes, \"x y yaw\" [m, m, rad] {}", what);
  std::string spaced = text;
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  std::istringstream words(spaced);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    double number = 0.0;
    if (!CLI::detail::lexical_cast(word, number) || !std::isfinite(number)) {
      throw base::ConfigError(
          fmt::format("{} '{}': '{}' is no number; {}", option, text, word, wanted));
    }
    numbers.push_back(number);
  }
  if (numbers.size() != 3) {
    throw base::ConfigError(
        fmt::format("{} '{}': has {} numbers; {}", option, text, numbers.size(), wanted));
  }
  RefuseDegrees(option, text, numbers[2]);
  return {numbers[0], numbers[1], numbers[2]};
}

localisation::RobotLog ReadDrive(const DriveOptions& options, const std::string& package_folder,
                                 const ReadDriveBag& read_bag) {
  const std::string& log = options.log;
  if (IsBag(log)) {
    if (read_bag) return WithInertia(read_bag(log, SourceOf(options)), log, package_folder);
    throw base::ConfigError(
        fmt::format("{}: is a bag, which this program does not read because it was built without "
                    "ROS; take `hires` of a build with ROS, or a CARMEN log (lines FLASER and "
                    "ODOM, or ROBOTLASER1)",
                    log));
  }
  RefuseBagOptions(options);
  localisation::RobotLog drive = localisation::ReadCarmenLog(log);
  if (drive.scans.empty()) {
    throw base::ConfigError(
        fmt::format("{}: has no scan; wanted lines FLASER or ROBOTLASER1", log));
  }
  WarnOfGaps(drive, log);
  return drive;
}

}  // namespace hires::cli
