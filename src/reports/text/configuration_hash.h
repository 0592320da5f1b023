#pragma once

#include <string>
#include <vector>

namespace hires::reports {

/// Of what a series of runs reads: all below config/, worlds/ and urdf/, by name and content. A
/// printed result is stale where it carries another one. Comments and white space of YAML files
/// count for nothing; nor does what says only how things are shown or started: .rviz and .launch
/// files.
/// @return 16 hexadecimal digits.
/// @throws base::ConfigError naming a file that cannot be read or is no YAML.
std::string ConfigurationHash(const std::string& package_folder);

/// The same of one file or folder of the package: "config", "worlds".
/// @param without  names below the package that begin so count for nothing either.
std::string InputHash(const std::string& package_folder, const std::string& input,
                      const std::vector<std::string>& without = {});

}  // namespace hires::reports
