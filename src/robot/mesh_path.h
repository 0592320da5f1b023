#pragma once

#include <filesystem>
#include <string>

#include "base/files/package_finder.h"

namespace hires::robot {

/// The file that a URDF's mesh URI means: package://<package>/<path> is looked for in the packages
/// on ROS_PACKAGE_PATH, in the folders above the URDF and beside the package that holds it;
/// model://<model>/<path> in the folders of base::ModelFoldersFor, and then as a package of that
/// name; file://<absolute path> and plain paths (relative to `folder`, the URDF's own) are taken as
/// they are.
/// @throws base::ConfigError naming the URI, what is there of its way and what comes nearest where
/// there is no such file, for another scheme, and for a package:// path that leaves its package.
std::string ResolveMesh(const std::string& uri, const std::filesystem::path& folder,
                        const base::PackageFinder& packages);

}  // namespace hires::robot
