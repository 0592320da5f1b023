#pragma once

#include <functional>
#include <string>

#include "hires/geometry/pose.h"
#include "hires/localisation/robot_log.h"
#include "hires/sensing/drive_builder.h"

namespace CLI {
class App;
}

namespace hires::cli {

/// Reads a drive from a bag.  @throws base::ConfigError naming the bag and what is wrong with it.
using ReadDriveBag = std::function<localisation::RobotLog(const std::string& path,
                                                          const sensing::DriveSource& source)>;

/// What was typed of the drive that a verb works on.
struct DriveOptions {
  std::string log;              ///< a CARMEN log or a bag
  sensing::DriveSource source;  ///< of a bag
  std::string laser;            ///< "x y yaw", in place of the bag's transforms
};

/// Adds them to a verb.  @pre `options` outlives `verb`.
void AddDriveOptions(CLI::App* verb, DriveOptions* options);

/// Of "x y yaw" [m, m, rad], or with commas.
/// @param option  that it is of: "--initial".
/// @param what    the numbers are: "of the base in the map".
/// @throws base::ConfigError for other text, and for a yaw that must be in degrees.
geometry::Pose2 PoseIn(const std::string& text, const std::string& option, const std::string& what);

/// A CARMEN log or a bag with at least one scan. A bag is what is called .bag, or begins as one.
/// Its odometry is corrected by its inertial unit, where the options name one that can be used.
/// @param package_folder  in whose config/odometry_filter.yaml stands how.
/// @param read_bag        may be empty; then bags are refused.
/// @throws base::ConfigError as localisation::ReadCarmenLog and `read_bag`, for options of bags
/// with a CARMEN log, and for logs without scans.
localisation::RobotLog ReadDrive(const DriveOptions& options, const std::string& package_folder,
                                 const ReadDriveBag& read_bag);

}  // namespace hires::cli
