#include "cli/drive_log.h"

#include <fmt/format.h>

#include <filesystem>

#include "hires/base/error.h"
#include "hires/base/text.h"
#include "hires/localisation/log_file.h"

namespace hires::cli {

localisation::RobotLog ReadDrive(const std::string& log) {
  if (base::ToLower(std::filesystem::path(log).extension().string()) == ".bag") {
    throw base::ConfigError(
        fmt::format("{}: is a bag, which this program does not read yet; wanted a CARMEN log "
                    "(lines FLASER and ODOM, or ROBOTLASER1)",
                    log));
  }
  localisation::RobotLog drive = localisation::ReadCarmenLog(log);
  if (drive.scans.empty()) {
    throw base::ConfigError(
        fmt::format("{}: has no scan; wanted lines FLASER or ROBOTLASER1", log));
  }
  return drive;
}

}  // namespace hires::cli
