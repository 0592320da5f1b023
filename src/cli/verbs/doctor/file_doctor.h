#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cli/verbs/doctor/finding.h"

namespace hires::cli {

/// `hires doctor --world W --robot R --map M`.
struct FileDoctorOptions {
  std::string world, map, robot;   ///< files; empty: not given
  std::vector<std::string> areas;  ///< NAME:x,y,yaw
  std::string png;                 ///< picture from above; empty: none

  bool is_asked() const { return !world.empty() || !map.empty(); }
};

/// Reads what is given, whole, and says all that was assumed, left out or is suspected; draws it
/// from above, and plays one drive between the two areas that are farthest apart. What is not given
/// is that of config/imagination_client.yaml; of a world and a map the drive is in the world.
/// @param say  told each finding as it comes.
/// @throws base::ConfigError for a picture that cannot be written, and areas that are none.
void ExamineFiles(const FileDoctorOptions& options, const std::string& package_folder,
                  const std::function<void(const Finding&)>& say);

}  // namespace hires::cli
