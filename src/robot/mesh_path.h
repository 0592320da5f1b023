#pragma once

#include <filesystem>
#include <string>

namespace hires::robot {

/// The file that a URDF's mesh URI means: package://<package>/<path> is looked for in the packages
/// on ROS_PACKAGE_PATH and in the folders above the URDF; file://<absolute path> and plain paths
/// (relative to `folder`, the URDF's own) are taken as they are.
/// @throws base::ConfigError naming the URI and every place that was looked at when there is no
/// such file, for another scheme, and for a package:// path that leaves its package.
std::string ResolveMesh(const std::string& uri, const std::filesystem::path& folder);

}  // namespace hires::robot
