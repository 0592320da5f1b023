#pragma once

#include <string>

namespace hires::cli {

/// Where config/, worlds/ and urdf/ lie for a program without ROS: as HIRES_PACKAGE_FOLDER says,
/// beside the installed program, or in the source tree.
std::string LocalPackageFolder(const std::string& source_folder);

/// Adds the folder at the end of ROS_PACKAGE_PATH, which a program that was started by itself
/// lacks: there our own stand-ins for model://sun and the like are looked for. Before threads
/// start.
void NamePackageFolder(const std::string& folder);

}  // namespace hires::cli
