#pragma once

#include <string>

namespace hires::cli {

/// Where config/, worlds/ and urdf/ lie for a program without ROS: as HIRES_PACKAGE_FOLDER says,
/// beside the installed program, or in the source tree.
std::string LocalPackageFolder(const std::string& source_folder);

}  // namespace hires::cli
